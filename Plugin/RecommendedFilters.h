#ifndef RecommendedFilters_h
#define RecommendedFilters_h

/// Creates the filters that a filter recommends when its button is pressed: for the hint <MakesFilters button="B"
/// filters="F"/>, the property B is the button and the information property F the filters, "Filter Property=Value ... |
/// Filter ...". A value is a list of numbers with commas, "#2" for the output of the second of these filters, "@Mesh"
/// for what is connected to the recommending filter's input Mesh, or nothing: nothing is connected. Inputs and
/// properties that are not listed are copied from the recommending filter's of the same name, except EstimateError. The
/// last filter becomes the active source. A trace records the filters as it does those from the menu.
///
/// Installs the observers that follow the buttons. To be called when the plugin is loaded; works in windows and in
/// scripts.
void FollowRecommendations();

#endif
