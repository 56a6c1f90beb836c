#pragma once

#include "Comparison/ComparedScene.h"
#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Photons/Emission/SampleSequence.h"

#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
enum class ComparedMethod
{
  LightPropagationMaps, ///< the default: conservative, source and acceleration by scene
  ConstantSource,       ///< conservative, constant source, no acceleration
  Published,            ///< light propagation maps as published, Algorithm 2
  PublishedSequential,  ///< the same, Algorithm 1: slow
  DiscreteOrdinates,    ///< conservative, anisotropic scattering by spherical harmonics
  LatticeBoltzmann,     ///< diffusion on lattices of 18 and of 6 directions, solved for its steady state
  Photons,              ///< spread evenly, conservative marching and reconstruction
  AdaptivePhotons,      ///< the same with an importance map
  PublishedPhotons,     ///< marching and Gauss filter as published
  MonteCarlo,           ///< photons that are scattered until they end, without a filter: no bias, but noise
};
const char* NameOf(ComparedMethod method);

/// Whether a method makes photons of lights.
bool IsOfPhotons(ComparedMethod method);

/// Whether a method finds unscattered light only, which is compared with `fluence_direct`.
bool IsDirectOnly(ComparedMethod method);

/// When photons that are scattered until they end make the reference of light that goes straight.
enum class MonteCarloReference
{
  Never = 0,
  Always = 1,        ///< an error in scenes that photons cannot do
  WhereItCanBeat = 2 ///< where their standard error is forecast to be far below what the finest maps are off by
};

/// Directions a face below which finer maps are not tried.
constexpr int FewestForFinerMaps = 25;

/// The settings that are tried: of propagation all directions on all grids; finer maps where there are 25 directions or
/// more; limited orders with the number of directions nearest to 25; of photons all counts by the first sampler, and
/// the largest but one by the others. Both lattices on all grids whose voxels are cubes; where light is bent, on the
/// scene's own with uncollided light of all counts of photons.
struct ComparedSettings
{
  std::vector<int> directionsPerFace = { 4, 9, 25, 64, 100 };
  std::vector<int> mapResolutions = { 1, 2 };
  std::vector<int> coarsenings = { 1, 2,
    4 };                                  ///< voxels' edges, in the scene's; what does not divide the grid is not tried
  std::vector<int> orders = { 1, 3, 10 }; ///< besides all
  std::vector<int> photonCounts = { 10000, 100000, 1000000 };
  std::vector<Sampler> samplers = { Sampler::Hammersley };
  double tolerance = PropagationSettings().tolerance; ///< of propagation
  bool scattersReference = false; ///< where light is bent, photons that make the reference are scattered, too
  /// Whether such photons make the reference also where light goes straight: it shares no solver with methods compared
  /// then.
  MonteCarloReference monteCarloReference = MonteCarloReference::WhereItCanBeat;
};

/// A method with a setting, ready to run.
struct ComparedRun
{
  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting; ///< in words
  Grid grid;           ///< of its light
  double cost = 1.0;   ///< relative to others of the method: rays times voxels, or photons
  bool allOrders = true;
  bool estimates = false; ///< whether it can estimate its error
  /// @param estimate  whether to estimate the error, too
  std::function<LightField(bool estimate, const Monitor& monitor)> solve;
};

/// The runs of a method, cheap ones first.
/// @param device, scene  must stay
std::vector<ComparedRun> RunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);

/// Light of `photons` photons without a filter, for a reference.
/// @param orders  MarchSettings::maximumOrders: 1, unscattered light; 0, all
LightField MarchEvenly(Device& device, const ComparedScene& scene, std::size_t photons, int orders, std::uint64_t seed,
  const Monitor& monitor);

/// Propagation by the conservative scheme.
LightField Propagate(Device& device, const ComparedScene& scene, PropagationSettings settings, const Monitor& monitor);

/// @throws InvalidInput where a setting is out of its range (names it)
void Check(const ComparedSettings& settings);
}
