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
  LightPropagationMaps, ///< the default: conservative; source and acceleration chosen for the scene
  ConstantSource,       ///< conservative, constant source, no acceleration
  Published,            ///< light propagation maps as published, Algorithm 2
  PublishedSequential,  ///< the same, Algorithm 1: slow
  DiscreteOrdinates,    ///< conservative, anisotropic scattering by spherical harmonics
  LatticeBoltzmann,     ///< diffusion on lattices of 18 and of 6 directions, solved for its steady state
  Photons,              ///< evenly distributed, conservative marching and reconstruction
  AdaptivePhotons,      ///< the same, distributed by an importance map
  PublishedPhotons,     ///< marching and Gauss filter as published
  MonteCarlo,           ///< photons scattered until they end, without a filter: unbiased but noisy
};
const char* NameOf(ComparedMethod method);

/// Whether a method traces photons.
bool IsOfPhotons(ComparedMethod method);

/// Whether a method computes uncollided light only, which is compared with `fluence_direct`.
bool IsDirectOnly(ComparedMethod method);

/// When Monte Carlo photons are used as the reference for a constant refractive index.
enum class MonteCarloReference
{
  Never = 0,
  Always = 1,        ///< raises an error for scenes that photons cannot simulate
  WhereItCanBeat = 2 ///< if their standard error is forecast to be far below the error of the finest maps
};

/// Fewest directions per face with which finer maps are compared.
constexpr int FewestForFinerMaps = 25;

/// Settings to compare. Propagation: all numbers of directions on all grids; finer maps from 25 directions on; limited
/// orders with the number of directions nearest to 25. Photons: all counts with the first sampler, and the second
/// largest with the others. Lattices: both, on all grids with cubic voxels; with a varying refractive index on the
/// scene's own grid, with uncollided light of all counts of photons.
struct ComparedSettings
{
  std::vector<int> directionsPerFace = { 4, 9, 25, 64, 100 };
  std::vector<int> mapResolutions = { 1, 2 };
  std::vector<int> coarsenings = { 1, 2,
    4 };                                  ///< voxels' edges, in the scene's; what does not divide the grid is not tried
  std::vector<int> orders = { 1, 3, 10 }; ///< numbers of scattering orders, in addition to all orders
  std::vector<int> photonCounts = { 10000, 100000, 1000000 };
  std::vector<Sampler> samplers = { Sampler::Hammersley };
  double tolerance = PropagationSettings().tolerance; ///< tolerance of propagation
  bool scattersReference = false; ///< with a varying refractive index, also scatter the photons of the reference
  /// Whether scattered photons are also used as the reference for a constant refractive index; the reference then
  /// shares no solver with the compared methods.
  MonteCarloReference monteCarloReference = MonteCarloReference::WhereItCanBeat;
};

/// One method with one setting, ready to run.
struct ComparedRun
{
  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting; ///< as text
  Grid grid;           ///< grid of the resulting light
  double cost = 1.0;   ///< cost relative to other runs of the method: rays times voxels, or photons
  bool allOrders = true;
  bool estimates = false; ///< whether it can estimate its own error
  /// @param estimate  whether to estimate the error as well
  std::function<LightField(bool estimate, const Monitor& monitor)> solve;
};

/// The runs of a method, cheapest first.
/// @param device, scene  must outlive the runs
std::vector<ComparedRun> RunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);

/// The runs of one family of methods, in any order. Lattices have none if no compared grid has cubic voxels.
std::vector<ComparedRun> LatticeRunsOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings);
std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);

/// Light of `photons` evenly distributed, unfiltered photons, for a reference.
/// @param orders  MarchSettings::maximumOrders: 1, unscattered light; 0, all
LightField MarchEvenly(Device& device, const ComparedScene& scene, std::size_t photons, int orders, std::uint64_t seed,
  const Monitor& monitor);

/// Propagation by the conservative scheme.
LightField Propagate(Device& device, const ComparedScene& scene, PropagationSettings settings, const Monitor& monitor);

/// @throws InvalidInput if a setting is out of its range (names it)
void Check(const ComparedSettings& settings);
}
