#include "LightPropagation/Emission/GlobalStatistics.h"

#include "LightPropagation/Emission/EmissionPeaks.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// Histogram of the voxels' brightness over all ranks: number of voxels and sum of brightness in each bin.
class BrightnessBins
{
public:
  BrightnessBins(const Domain& domain, const Medium& medium)
    : Counts(Bins, 0.0)
    , Sums(Bins, 0.0)
  {
    const std::size_t voxels = medium.emission.values ? medium.grid.VoxelCount() : 0;
    double brightest = 0.0;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      brightest = std::max(brightest, EmissionBrightness(medium.emission, i));
    }
    this->Brightest = domain.Max(brightest);
    for (std::size_t i = 0; i<voxels&& this->Brightest> 0.0; ++i)
    {
      const double brightness = EmissionBrightness(medium.emission, i);
      const std::size_t bin = this->BinOf(brightness);
      this->Counts[bin] += 1.0;
      this->Sums[bin] += brightness;
    }
    this->Counts = domain.Sum(this->Counts);
    this->Sums = domain.Sum(this->Sums);
  }

  /// Whether the excess of the brightest `most` voxels over all others may be half of the power. Conservative: if a
  /// voxel of a bin is among the brightest, all voxels of that bin count.
  bool IsDominatedByFewVoxels(double most) const
  {
    double all = 0.0, bright = 0.0, counted = 0.0, voxels = 0.0;
    std::size_t end = 0; // one past the bin that contains the last of them
    for (std::size_t bin = 0; bin < Bins; ++bin)
    {
      all += this->Sums[bin];
      voxels += this->Counts[bin];
      if (counted < most)
      {
        counted += this->Counts[bin];
        bright += this->Sums[bin];
        end = bin + 1;
      }
    }
    const double limit = std::max(this->LowestOf(end - 1), EmissionOutshines * (all - bright) / voxels);
    double above = 0.0;
    for (std::size_t bin = 0; bin < end; ++bin)
    {
      above += std::max(0.0, this->Sums[bin] - limit * this->Counts[bin]);
    }
    return above > 0.0 && above >= EmissionPartOfAll * all;
  }

private:
  static constexpr std::size_t Bins = 512; ///< each an eighth of an octave wide; the last one holds all darker voxels
  static constexpr double PerOctave = 8.0;

  std::size_t BinOf(double brightness) const
  {
    const double octaves = brightness > 0.0 ? std::log2(this->Brightest / brightness) : 1e9;
    return static_cast<std::size_t>(std::clamp(octaves * PerOctave, 0.0, Bins - 1.0));
  }
  double LowestOf(std::size_t bin) const
  {
    return bin + 1 < Bins ? this->Brightest * std::exp2(-(bin + 1.0) / PerOctave) : 0.0;
  }

  std::vector<double> Counts, Sums;
  double Brightest = 0.0;
};
}

bool MayHaveEmissionPeaks(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  const bool endless = settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
  if (!problem.Traits().emits || settings.emissionError == 0.0 || endless)
  {
    return false;
  }
  const double most = std::floor(static_cast<double>(problem.Whole().VoxelCount()) / EmissionBrightPart);
  return most > 0.0 && BrightnessBins(problem.TheDomain(), problem.TheMedium()).IsDominatedByFewVoxels(most);
}
}
