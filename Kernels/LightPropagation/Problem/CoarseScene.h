#pragma once

#include "Lights/Lights.h"
#include "Medium/Coarsening.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A scene averaged to a coarser grid over the same box, with its own arrays. Coefficients are means over the coarse
/// voxels, g weighted by sigma_s. Uncollided light that is given by voxel is averaged so that the power the medium
/// takes from it is conserved.
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
