#pragma once

#include <string>

/// Number of prepared scenes. Together they compile the kernels of typical scenes of users: clouds in white and in
/// coloured light on several classes of grid sizes, and photons through glass.
int PreparedSceneCount();

/// Runs the pipeline of a prepared scene up to its picture: density, medium and maps, or mesh, octree and photons. Most
/// settings of the filters are the defaults.
/// @param number  number of the scene, from 0, most likely scenes first
/// @return whether the scene was prepared without an error of a filter
bool PrepareScene(int number);

/// Text that identifies the build of the filters' library.
std::string LibraryVersion();
