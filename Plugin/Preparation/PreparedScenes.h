#pragma once

#include <string>

/// Number of prepared scenes. Kernels are compiled for the same variants as in typical user scenes: classes of grid
/// sizes, and a density field with default filter settings.
int PreparedSceneCount();

/// Runs the default pipeline, from density to medium, light and picture; only the medium's preset and unit of length
/// are set.
/// @param number  number of the scene, from 0, most likely scenes first
/// @return whether no filter reported an error
bool PrepareScene(int number);

/// Identifies the build of the filters' library.
std::string LibraryVersion();
