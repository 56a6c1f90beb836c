#pragma once

#include <string>

/// Scenes that have in common with those of users what kernels are compiled for: the classes of grid sizes, and what
/// untouched filters make of a density.
int PreparedSceneCount();

/// Density to medium, light and picture, by filters with nothing set but the medium's preset.
/// @param number  from 0, the likeliest first
/// @return whether no filter reported an error
bool PrepareScene(int number);

/// Another one whenever the library of filters is.
std::string LibraryVersion();
