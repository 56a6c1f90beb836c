#include "LatticeBoltzmann/DiffusionError.h"

#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int Directions = 9; ///< of the coarse solve by light propagation maps, per cube face
constexpr double Tolerance = 1e-3;

/// Settings of the coarse solve by light propagation maps.
PropagationSettings OfMaps(const LatticeSettings& settings)
{
  PropagationSettings maps;
  maps.directionsPerFace = Directions;
  maps.tolerance = std::max(Tolerance, settings.tolerance);
  maps.periodic = settings.periodic;
  maps.storeMoments = false;
  return maps;
}

/// Sum of the squared differences of two fields on this rank's coarse voxels.
double SumOfSquaredDifferences(const std::vector<float>& one, const std::vector<float>& other)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i)
  {
    const double difference = static_cast<double>(one[i]) - other[i];
    sum += difference * difference;
  }
  return sum;
}

/// Fluence of the lattice on the coarse grid, without refraction.
std::vector<float> OnCoarseLattice(
  Device& device, const SceneBlock& coarse, LatticeSettings settings, const Monitor& monitor)
{
  settings.netFlux = false;
  settings.interleaves = false;
  return SolveLatticeBoltzmann(device, coarse.domain, coarse.medium, {}, coarse.illumination, settings, monitor)
    .fluence;
}
}

void EstimateDiffusionError(Device& device, const SceneBlock& scene, const LatticeSettings& settings, bool ofPhotons,
  const Monitor& monitor, LightField& light)
{
  const Domain& domain = scene.domain;
  Illumination lit = scene.illumination;
  if (ofPhotons && !domain.IsEmpty())
  {
    lit.uncollided.fluence = { light.fluenceDirect.data(), light.channels };
  }
  const CoarseBlocks blocks(domain.Comm(), domain.Partition());
  const CoarseScene coarse(blocks, { domain, scene.medium, lit });
  const bool refracts = domain.Any(!domain.IsEmpty() && scene.index.values != nullptr);
  const bool areCubes = HasCubicVoxels(blocks.Coarse().whole);
  domain.Collective([&] {
    Require(!refracts || areCubes,
      "The error of a lattice with a refractive index is estimated on a grid of half the voxels, "
      "which have to be cubes. Give the medium an even number of voxels along each axis.");
  });
  const SceneBlock solved = coarse.Scene();
  const std::vector<float> maps = SolveConservative(
    device, solved.domain, solved.medium, solved.illumination, OfMaps(settings), OfPart(monitor, 0.0, 0.7))
                                    .fluence;
  std::vector<float> lattice = blocks.Average(light.fluence, light.channels);
  if (areCubes)
  {
    std::vector<float> other = OnCoarseLattice(device, solved, settings, OfPart(monitor, 0.7, 1.0));
    const std::vector<double> sums =
      domain.Sum(std::vector<double>{ SumOfSquaredDifferences(lattice, maps), SumOfSquaredDifferences(other, maps) });
    if (refracts || sums[1] < sums[0])
    {
      lattice = std::move(other);
    }
  }
  // The whole difference between the two solves is the error of diffusion: an infinite order of convergence attributes
  // no part of it to the voxel size.
  WriteErrorEstimate(light, blocks, maps, lattice, 1.0, std::numeric_limits<double>::infinity());
}

void JudgeTarget(double target, LightField& light)
{
  if (target > 0.0 && light.relativeError > target)
  {
    light.doubts.push_back("TargetError " + Text("%g", target) +
      " is not met: the error of fluence is estimated to be " + Text("%.2g", light.relativeError) +
      ", that of the diffusion approximation, which no setting of the lattice reduces. Use Light Propagation Maps or "
      "Discrete Ordinates with this target, or ask for less.");
  }
}
}
