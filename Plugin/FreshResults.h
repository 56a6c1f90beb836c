#ifndef FreshResults_h
#define FreshResults_h

/// Has sources and filters with the hint <FreshResults/> read the properties that only tell of results
/// (information_only) again whenever their data have been updated, and representations theirs whenever a view has been
/// drawn, so that panels and scripts show those of the last update, those of a server, too, until it ends.
///
/// To be called when the plugin is loaded; serves windows and scripts.
void FollowResults();

#endif
