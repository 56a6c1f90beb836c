#pragma once

#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>
#include <vector>

namespace bench
{
/// How the extinction of a thick medium varies.
enum class ThickMedium
{
  Homogeneous,
  Blocks,   ///< cubes of eight voxels, each a hundred times as thick as the next one or as thin
  LogNormal ///< each voxel by chance, standard deviation of the logarithm 1.5, smoothed over neighbours
};

/// A grey cube of edge 1, of which one face shines evenly, with its arrays. Moves, does not copy.
struct ThickScene
{
  /// @param tau  optical thickness of an edge, in the mean over voxels
  ThickScene(ThickMedium kind, int edge, double tau, double albedo);
  ThickScene(const ThickScene&) = delete;
  ThickScene& operator=(const ThickScene&) = delete;

  std::string name; ///< "homogeneous, tau 20, albedo 0.99"
  tyndall::Medium medium;
  tyndall::Illumination light;

private:
  std::vector<float> SigmaA, SigmaS;
};
}
