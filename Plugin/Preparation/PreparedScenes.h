#pragma once

#include <string>

/// Number of prepared scenes. Scenes are such that the kernels of typical user scenes are compiled: several classes of
/// grid sizes, and a density field with default filter settings.
int PreparedSceneCount();

/// Runs the default pipeline on a prepared scene, from density to medium, light and picture. All filters have default
/// settings, except the medium's preset and unit of length.
/// @param number  number of the scene, from 0, most likely scenes first
/// @return whether the scene was prepared without an error of a filter
bool PrepareScene(int number);

/// Identifies the build of the filters' library.
std::string LibraryVersion();
