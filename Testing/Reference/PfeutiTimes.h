#pragma once

#include <cstddef>
#include <string>

/// Milliseconds of the passes of one of Pfeuti's pipelines on a GTX 260 (Pfeuti 2009, Tables 4.2 to 4.4); 0: it has no
/// such pass. The pilot's include the importance map, the reconstruction's mipmaps and filter.
struct PfeutiPasses
{
  std::size_t photons;
  double voxelisation, octree, pilot, generation, marching, reconstruction, viewing;
};

/// Data/Reference/pfeuti_pass_times.csv. @throws std::runtime_error where the table does not have it
/// @param scene  ball, cube, armadillo
/// @param pipeline  reference, adaptive
PfeutiPasses PfeutiPassesOf(const std::string& scene, const std::string& pipeline);

/// Milliseconds of marching 122000 photons of a point set on a GTX 260 (Pfeuti 2009, Table 4.1); two numbers where it
/// mattered whether the list of photons had rows or columns first. Data/Reference/pfeuti_sampler_times.csv.
/// @throws std::runtime_error where the table does not have it
std::string PfeutiMarchingTimes(const std::string& sampler);
