#pragma once

#include "StressScenes.h"

#include <string>
#include <vector>

/// The filters that are put under stress, each as a user would chain them.
namespace bench
{
enum class StressSolver
{
  Maps,             ///< light propagation maps, conservative, untouched
  MapsAll,          ///< the same, with nothing left out
  MapsMoments,      ///< the same, scattering in angular moments as the phase function asks for: of media with g alone
  MapsByOrders,     ///< conservative, one scattering order after the other, a constant source
  MapsParallel,     ///< as published, Algorithm 2
  MapsSequential,   ///< as published, Algorithm 1
  Ordinates,        ///< discrete ordinates, conservative
  Lattice,          ///< lattice-Boltzmann lighting, 18 directions, untouched
  LatticeOfSix,     ///< the same along axes alone
  Photons,          ///< emitter and marcher, conservative
  PhotonsScattered, ///< the same, until they are absorbed or have left
  PhotonsPublished, ///< as published
  Rebuilt,          ///< importance, emitter, marcher, reconstruction, conservative
  RebuiltPublished, ///< as published
  Octree,           ///< octree, and photons through it
  View,             ///< ray caster, straight rays
  ViewBent,         ///< ray caster, an index that varies
  Count
};

const char* NameOf(StressSolver solver);
bool IsMaps(StressSolver solver);
bool IsLattice(StressSolver solver);
bool IsGrid(StressSolver solver);          ///< maps, discrete ordinates, or lattices
bool CountsOrders(StressSolver solver);    ///< conservative, with as many orders whatever is left
bool EndsByTolerance(StressSolver solver); ///< others do as many orders whatever it is
bool IsPhotons(StressSolver solver);       ///< photons, reconstructed or not
bool IsView(StressSolver solver);

/// Whether a solver has anything to do with a case: photons come from lamps and skies only, a viewer sees no lamps, ...
bool Concerns(StressSolver solver, const StressCase& stressCase);

/// What a chain of filters gave.
struct StressOutcome
{
  std::vector<std::string> errors, warnings; ///< by VTK's channel
  bool empty = true;                         ///< all outputs of the last filter
  double seconds = 0.0;
  int channels = 1;
  std::vector<float> fluence, fluenceDirect, netFlux, fluenceError;
  std::vector<double> balance;       ///< entered, emitted, absorbed, escaped, left over; `channels` each
  std::vector<double> facePowerOut;  ///< -x, +x, -y, +y, -z, +z; `channels` each
  std::vector<double> halfRangeFlux; ///< one, of maps
  std::vector<double> scattered;     ///< W, of photons
  std::vector<float> directions;     ///< mean directions, 3 a voxel, of photons
  double residual = 0.0;             ///< of grids, what the solver says is left, over its tolerance
  double rawTotal = 0.0;             ///< of reconstructions: the sum of the noisy fluence
  std::vector<float> levels;         ///< of the octree
  double nodes = 0.0;
  std::vector<float> radiance, alpha; ///< of views, 3 and 1 a pixel: in a furnace
  std::vector<float> through;         ///< of views, 3 a pixel: a background of 1 seen through the unlit medium along -z
};

/// Of maps and lattices: their default, and less where what is compared is not how far iterations went.
constexpr double StressTolerance = 1e-4, StressTightTolerance = 3e-5;

/// @param tolerance  of maps and lattices
StressOutcome RunStress(StressSolver solver, const StressScene& scene, double tolerance = StressTolerance);

/// Index of each voxel as the bent view sees it: the scene's own, or that of a soft ball.
std::vector<float> IndexToView(const StressScene& scene);

/// Scattering orders at most, of the maps that are not accelerated; as published they are slow where voxels are 1:1000.
constexpr int StressOrders = 10, StressOrdersPublished = 1, StressOrdersOrdinates = 40;
/// Photons of each chain.
constexpr int StressPhotons = 20000;
}
