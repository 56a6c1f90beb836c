#pragma once

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "MediumScene.h"
#include "RectangleSeen.h"

#include <cmath>
#include <cstddef>
#include <vector>

/// Error of the fluence in an empty cube whose face -z has radiance 1, which is the face's solid angle: root mean
/// square over the voxels, relative to that of the fluence.
inline double ErrorInEmptyCube(const std::vector<float>& fluence, const tyndall::Grid& grid)
{
  tyndall::Light face;
  face.position = { 0.5 * grid.Length(0), 0.5 * grid.Length(1), 0.0 };
  face.direction = { 0.0, 0.0, 1.0 };
  face.size = { grid.Length(0), grid.Length(1) };
  const tyndall::RectangleSeen seen(face);
  const glm::dvec3 edge(grid.spacing[0], grid.spacing[1], grid.spacing[2]);
  double errors = 0.0, all = 0.0;
  for (std::size_t i = 0; i < fluence.size(); ++i)
  {
    const std::array<int, 3> at = grid.VoxelAt(i);
    const double exact = seen.Mean(edge * glm::dvec3(at[0], at[1], at[2]), edge, 2);
    errors += (fluence[i] - exact) * (fluence[i] - exact);
    all += exact * exact;
  }
  return std::sqrt(errors / all);
}

/// A scene for discrete ordinates.
struct LitMedium : Scene
{
  tyndall::OrdinatesSettings how;

  using Scene::Scene;

  void ScatterWith(double g) { this->medium.phase = tyndall::PhaseFunction::HenyeyGreenstein(g); }

  tyndall::LightField SolveOrdinates(
    tyndall::Device& device, const tyndall::Monitor& monitor = {}, tyndall::KeptLight* kept = nullptr)
  {
    this->Attach();
    return tyndall::SolveDiscreteOrdinates(
      device, tyndall::Domain(this->medium.grid), this->medium, this->light, this->how, monitor, kept);
  }
};
