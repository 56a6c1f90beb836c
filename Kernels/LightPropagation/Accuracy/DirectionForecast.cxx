#include "LightPropagation/Accuracy/DirectionForecast.h"

#include "Light/Quality.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace tyndall
{
namespace
{
/// Up to this number of directions per cube face, rays start in the middle of voxels; with more directions they start
/// at staggered positions
constexpr int LargestUnstaggered = 100;
/// Measured cost of one direction for uncollided light, relative to one direction in a sweep of scattered light.
constexpr double UncollidedWork = 5.0;
constexpr double LeastSweeps = 3.0;
/// Upper bound of the ratio of the angular error on the fine grid to that on the coarse grid; measured ratios are 0.97
/// to 1.3.
constexpr double OnFinerGrid = 1.3;
constexpr int Directions[] = { 9, 16, 25, 36, 49, 64, 100, 196, 256, 400 };
constexpr int UncollidedCounts[] = { 0, 49, 64, 81, 100, 256, 400, 576, 900, 1600 };

/// Measured error of the fluence for a number of directions per cube face, relative to the error with 9 directions.
/// Errors with more than 100 directions were measured with rays that start at staggered positions in their voxels.
struct Fall
{
  double directions, error;
};
constexpr Fall Falls[] = { { 1, 8.0 }, { 4, 2.6 }, { 9, 1.0 }, { 16, 0.8 }, { 25, 0.5 }, { 36, 0.38 }, { 49, 0.34 },
  { 64, 0.28 }, { 100, 0.22 }, { 256, 0.14 }, { 400, 0.12 }, { 900, 0.06 }, { 1600, 0.035 }, { 4096, 0.02 } };

/// Error of the fluence with `directions` per cube face, relative to the error with 9 directions. Interpolates the
/// table Falls linearly in the logarithms of both quantities.
double FallenTo(int directions)
{
  const Fall* above = std::begin(Falls) + 1;
  while (above + 1 != std::end(Falls) && above->directions < directions)
  {
    ++above;
  }
  const Fall& below = *(above - 1);
  const double part = std::log(directions / below.directions) / std::log(above->directions / below.directions);
  return below.error * std::pow(above->error / below.error, part);
}

/// Root mean square over voxels i of part(one, i) - part(other, i), relative to the root mean square of the fluence of
/// `other`.
/// @param part  part(light, i): the part of the fluence that is compared, e.g. the uncollided one
template <class Part>
double Difference(Communicator& communicator, const LightField& one, const LightField& other, const Part& part)
{
  double sum = 0.0, all = 0.0;
  for (std::size_t i = 0; i < one.fluence.size(); ++i)
  {
    const double difference = part(one, i) - part(other, i);
    sum += difference * difference;
    all += static_cast<double>(other.fluence[i]) * other.fluence[i];
  }
  const std::vector<double> sums = communicator.Sum({ sum, all });
  return sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}
}

DirectionForecast::DirectionForecast(
  Communicator& communicator, const LightField& few, int fewDirections, const LightField& more, int moreDirections)
  : Fallen(std::hypot(FallenTo(fewDirections), FallenTo(moreDirections)) / OnFinerGrid)
  , Sweeps(std::max(LeastSweeps, static_cast<double>(more.convergence.size())))
{
  const auto direct = [](
                        const LightField& light, std::size_t i) { return static_cast<double>(light.fluenceDirect[i]); };
  const auto scattered = [&](const LightField& light, std::size_t i) { return light.fluence[i] - direct(light, i); };
  this->OfUncollided = Difference(communicator, few, more, direct) / this->Fallen;
  this->OfScattered = Difference(communicator, few, more, scattered) / this->Fallen;
}

double DirectionForecast::UncollidedPart() const
{
  const double all = std::hypot(this->OfUncollided, this->OfScattered);
  return all > 0.0 ? this->OfUncollided / all : 0.0;
}

void DirectionForecast::Separate(
  Communicator& communicator, const LightField& few, const LightField& between, const LightField& more)
{
  const auto whole = [](const LightField& light, std::size_t i) { return static_cast<double>(light.fluence[i]); };
  this->OfUncollided = Difference(communicator, few, between, whole) / this->Fallen;
  this->OfScattered = Difference(communicator, between, more, whole) / this->Fallen;
  this->Separated = true;
}

double DirectionForecast::Error(const PropagationSettings& settings) const
{
  const int uncollided = settings.uncollidedDirections > 0 ? settings.uncollidedDirections : settings.directionsPerFace;
  return std::hypot(
    this->OfUncollided * FallenTo(uncollided), this->OfScattered * FallenTo(settings.directionsPerFace));
}

double DirectionForecast::PartOfDifference(const PropagationSettings& settings, const PropagationSettings& others) const
{
  const double error = this->Error(settings), difference = std::hypot(error, this->Error(others)) / OnFinerGrid;
  return difference > 0.0 ? error / difference : 0.0;
}

double DirectionForecast::Work(const PropagationSettings& settings) const
{
  return this->Sweeps * settings.directionsPerFace + UncollidedWork * std::max(0, settings.uncollidedDirections);
}

PropagationSettings DirectionForecast::Cheapest(const PropagationSettings& settings, double error, int most) const
{
  const PropagationSettings byDefault;
  PropagationSettings best;
  bool any = false;
  for (const int directions : Directions)
  {
    for (const int uncollided : UncollidedCounts)
    {
      if ((uncollided > 0 && !this->Separated) || (directions > most && directions > Directions[0]))
      {
        continue;
      }
      PropagationSettings tried = settings;
      SetUnlessChosen(tried.directionsPerFace, byDefault.directionsPerFace, directions);
      SetUnlessChosen(tried.uncollidedDirections, byDefault.uncollidedDirections,
        uncollided > tried.directionsPerFace ? uncollided : 0);
      SetUnlessChosen(tried.staggeredRays, byDefault.staggeredRays, tried.directionsPerFace > LargestUnstaggered);
      const double ofTried = this->Error(tried), ofBest = any ? this->Error(best) : 0.0;
      const bool better = ofTried <= error ? ofBest > error || this->Work(tried) < this->Work(best) : ofTried < ofBest;
      if (!any || better)
      {
        best = tried;
        any = true;
      }
    }
  }
  return best;
}

void DirectionForecast::Correct(double factor)
{
  this->OfUncollided *= factor;
  this->OfScattered *= factor;
}
}
