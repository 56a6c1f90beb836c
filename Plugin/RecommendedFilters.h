#ifndef RecommendedFilters_h
#define RecommendedFilters_h

/// Creates the filters that a filter recommends, when its button is pressed. The hint <MakesFilters button="B"
/// filters="F"/> names the button property B and the information property F, which lists the filters: "Filter
/// Property=Value ... | Filter ...". A value is a list of numbers with commas, "#2" for the output of the second listed
/// filter, "@Mesh" for the source at the recommending filter's input Mesh, or empty for no connection. Inputs and
/// properties that are not listed, except EstimateError, are copied from the recommending filter. The last filter
/// becomes the active source. A trace records the filters as it does those from the menu.
///
/// Installs the observers that follow the buttons. To be called when the plugin is loaded; works in windows and in
/// scripts.
void FollowRecommendations();

#endif
