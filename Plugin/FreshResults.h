#ifndef FreshResults_h
#define FreshResults_h

/// Keeps result properties (information_only) current. Results of sources and filters with the hint <FreshResults/> are
/// read again after each update of their data, results of representations (UsedExposure) after each rendering of a view
/// that does not move. Panels and scripts then show the results of the last update, also with a server, until the
/// server ends.
///
/// Installs the observers that read the results. To be called when the plugin is loaded; works in windows and in
/// scripts.
void FollowResults();

#endif
