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
  /// Conservative light propagation maps with the source and the acceleration that suit the scene (the default method).
  LightPropagationMaps,
  /// Conservative light propagation maps with a constant source per voxel and without acceleration.
  ConstantSource,
  Published,           ///< light propagation maps as published, Algorithm 2
  PublishedSequential, ///< light propagation maps as published, Algorithm 1, which is slow
  DiscreteOrdinates,   ///< conservative discrete ordinates, anisotropic scattering by spherical harmonics
  LatticeBoltzmann,    ///< diffusion on lattices of 18 and of 6 directions, solved for its steady state
  PhotonsThenMaps,     ///< uncollided light by photons along bent rays, scattered light by light propagation maps
  Photons,             ///< evenly distributed photons, conservative marching and reconstruction
  AdaptivePhotons,     ///< photons distributed by an importance map, conservative marching and reconstruction
  PublishedPhotons,    ///< photons with marching and Gauss filter as published
  MonteCarlo,          ///< photons scattered until they are absorbed or leave, without a filter: unbiased but noisy
  Voxelizer,           ///< voxelisation of the scene's mesh, then Photons
  Pictures,            ///< pictures of the reference light, cast at each quality
};
const char* NameOf(ComparedMethod method);

/// Quantity that is compared with the reference.
enum class ComparedQuantity
{
  Fluence,
  FluenceDirect, ///< fluence of uncollided light: all that Photons and their variants compute
  Radiance,      ///< pixels of a picture
};
ComparedQuantity QuantityOf(ComparedMethod method);
/// Name of the array in which filters return a quantity.
const char* NameOf(ComparedQuantity quantity);

/// Whether a method traces photons.
bool IsOfPhotons(ComparedMethod method);

/// Conditions under which Monte Carlo photons are the reference of a comparison, if the refractive index is constant.
enum class MonteCarloReference
{
  Never = 0,
  Always = 1, ///< always; scenes that photons cannot simulate are then an error
  /// Only if a forecast shows that the photons' standard error will be far below the error of the finest light
  /// propagation maps that are compared.
  WhereItCanBeat = 2
};

/// Light propagation maps with more than one ray per voxel edge and direction are tried only from this number of
/// directions per face on.
constexpr int FewestForFinerMaps = 25;

/// Settings that a comparison tries, by method:
/// - propagation: all numbers of directions on all grids; map resolutions (rays per voxel edge and direction) above 1
///   on the scene's grid, from 25 directions per face on; limits on the number of scattering orders with the number of
///   directions nearest to 25
/// - photons: all counts with the first of `samplers`; the second largest count with the other samplers, with the
///   integrators and octrees, and with the voxelisations of a mesh
/// - lattices: both lattices, on all grids with cubic voxels; with a varying refractive index on the scene's grid only,
///   with uncollided light from each count of photons
/// - PhotonsThenMaps: each count of photons, with the number of directions nearest to 25
/// - pictures: each quality
struct ComparedSettings
{
  std::vector<int> directionsPerFace = { 4, 9, 25, 64, 100 };
  std::vector<int> mapResolutions = { 1, 2 };
  /// Factors by which the voxel edges of the compared grids exceed those of the scene's grid. A factor is left out if
  /// it does not divide the numbers of voxels of the scene's grid.
  std::vector<int> coarsenings = { 1, 2, 4 };
  /// Limits on the number of scattering orders that are tried. A run without limit is always included.
  std::vector<int> orders = { 1, 3, 10 };
  std::vector<int> photonCounts = { 10000, 100000, 1000000 };
  std::vector<Sampler> samplers = { Sampler::Hammersley };
  /// Numbers of terms of the phase function that discrete ordinates try with the number of directions nearest to 25.
  /// The default number of terms, as far as the quadrature supports it, is always included.
  std::vector<int> terms;
  bool previews = false; ///< whether light propagation maps try their preview
  /// Settings that Photons try along bent rays, in addition to the defaults. Orders and step sizes of the integrator
  /// (MarchSettings): each order is combined with each step size. Tolerances of octrees: the construction of an octree
  /// counts as run time.
  std::vector<int> integratorOrders;
  std::vector<double> stepSizes, octreeTolerances;
  /// Numbers of samples per voxel edge, and widths of the filter that smooths the refractive index, with which a mesh
  /// is voxelised. Each number is combined with each width.
  std::vector<int> supersamplings = { 2, 4, 8 }, filterSizes = { 5, 9, 13 };
  double tolerance = PropagationSettings().tolerance; ///< tolerance of propagation, PropagationSettings::tolerance
  /// Whether the photons that give the reference for a varying refractive index are followed through all collisions.
  /// False: they are followed only up to the first collision, which gives uncollided light.
  bool scattersReference = false;
  /// When Monte Carlo photons are the reference, if the refractive index is constant. This reference does not use any
  /// of the compared propagation solvers.
  MonteCarloReference monteCarloReference = MonteCarloReference::WhereItCanBeat;
};

/// One method with one setting, ready to run. Its result is a row of the comparison.
struct ComparedRun
{
  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting; ///< description of the setting, for the user
  /// The filters that repeat the run, in the order of the data: "Filter Property=Value ... | Filter ...". A value is a
  /// list of numbers with commas, "#2" for the output of the second filter, "@Mesh" for the data set at the
  /// comparison's input Mesh, or empty for an input without a data set. All other inputs and properties are those of
  /// the comparison. Empty if filters cannot repeat the run, because it has coarser voxels, or traces photons and
  /// ComparedScene::suitsEmitter is false.
  std::string filters;
  Grid grid;         ///< grid of the resulting light; a picture's pixels
  double cost = 1.0; ///< cost relative to other runs of the method: rays times voxels, or photons
  bool allOrders = true;
  bool estimates = false; ///< whether the method can estimate its own error
  /// Computes the light. For a picture, its radiance is returned as `fluence` of three channels.
  /// @param estimate  whether to estimate the error as well
  std::function<LightField(bool estimate, const Monitor& monitor)> solve;
};

/// The runs of a method with all settings, cheapest first.
/// @param device, scene  must outlive the runs
std::vector<ComparedRun> RunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);

/// The runs of one family of methods (lattices, photons, propagation) with all settings, in any order. There are no
/// runs of lattices if no compared grid has cubic voxels.
std::vector<ComparedRun> LatticeRunsOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings);
std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);

std::vector<ComparedRun> PictureRunsOf(Device& device, const ComparedScene& scene);

/// The number of directions per face nearest to 25. Other settings are tried with this number of directions.
int UsualDirections(const ComparedSettings& settings);

/// Light of `photons` evenly distributed photons without a filter, for a reference.
/// @param orders  MarchSettings::maximumOrders: 1, unscattered light; 0, all orders
LightField MarchEvenly(Device& device, const ComparedScene& scene, std::size_t photons, int orders, std::uint64_t seed,
  const Monitor& monitor);

/// A run in two steps: photons give the uncollided light, and a solver computes the scattered light from it.
/// @param solver  setting, filters, grid and cost of the solver alone
/// @param solve  solves with the given illumination, which has no other light than the photons'
ComparedRun AfterPhotons(int photons, ComparedRun solver, Device& device, const ComparedScene& scene,
  const std::function<LightField(const Illumination&, const Monitor&)>& solve);

/// Reference radiance for pictures, 3 per pixel. Its rays take small steps, and are not ended at a small transmittance.
std::vector<float> ReferencePicture(Device& device, const ComparedScene& scene, const Monitor& monitor);

/// Light by the conservative scheme of light propagation maps.
LightField Propagate(Device& device, const ComparedScene& scene, PropagationSettings settings, const Monitor& monitor);

/// Checks the settings.
/// @throws InvalidInput, which names the setting, if a setting is out of its range
void Check(const ComparedSettings& settings);
}
