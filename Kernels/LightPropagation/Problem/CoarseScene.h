#pragma once

#include "Lights/Lights.h"
#include "Medium/Coarsening.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A scene on a coarser grid over the same box, with arrays of its own: coefficients are means over the coarse voxels,
/// g weighted by sigma_s; of light that is given by voxel the power that the medium takes is kept.
class CoarseScene
{
public:
  CoarseScene(const Medium& medium, const Illumination& illumination, const Coarsening& coarsening);
  CoarseScene(const CoarseScene&) = delete;
  CoarseScene& operator=(const CoarseScene&) = delete;

  const Medium& TheMedium() const { return this->Averaged; }
  const Illumination& Shining() const { return this->Light; }

private:
  void AverageMedium(const Coarsening& coarsening);
  void AverageGivenLight(const Medium& medium, const Coarsening& coarsening);
  void AverageFluence(
    const Field& fluence, const std::vector<float>& extinctions, int channels, const Coarsening& coarsening);
  void AverageDirections(const Field& mean, const Field& fluence, const Coarsening& coarsening);

  Medium Averaged;
  Illumination Light;
  std::array<std::vector<float>, 3> Coefficients;
  std::vector<float> G, Fluence, Directions;
};
}
