#pragma once

#include "StressScenes.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;

/// The filters that are put under stress, each as a user would chain them.
namespace bench
{
enum class StressFamily
{
  Maps,
  Ordinates,
  Lattice,
  Steps, ///< LPMPropagate and LPMCollect, one scattering order
  Photons,
  Rebuilt, ///< importance, emitter, marcher, reconstruction
  Octree,  ///< octree, and photons through it
  Emission,
  Importance,
  Mesh, ///< voxelizer
  View  ///< ray caster
};

/// How a row of the matrix runs, and what it is not asked therefore.
enum StressTrait : unsigned
{
  Published = 1u << 0u,     ///< as published: what the paper promises
  ByOrders = 1u << 1u,      ///< conservative, with as many orders whatever is left
  Moments = 1u << 2u,       ///< scattering in angular moments: of media with g alone
  SixLinks = 1u << 3u,      ///< a lattice along axes alone
  Scattered = 1u << 4u,     ///< photons until they are absorbed or have left
  OfPhotons = 1u << 5u,     ///< uncollided light of photons
  Reflecting = 1u << 6u,    ///< between faces that give half of the light back
  Preview = 1u << 7u,       ///< a light of a few percent, without powers
  Warm = 1u << 8u,          ///< from the light of a scene with a sky more
  Bent = 1u << 9u,          ///< views with an index that varies
  Ranks = 1u << 10u,        ///< in blocks on 3 ranks, which are threads
  AsGpu = 1u << 11u,        ///< kernels for GPUs, on a CPU
  Unturned = 1u << 12u,     ///< directions that do not turn with the scene
  OwnTolerance = 1u << 15u, ///< a tolerance that the filter chooses
  Noisy = 1u << 14u,        ///< an index with noise
  ByImportance = 1u << 13u, ///< photons where an importance map sends them
  AtRandom = 1u << 16u      ///< photons whose number that reaches the box is by chance
};

/// A row: a chain of filters with options.
struct StressSolver
{
  std::string name;
  StressFamily family;
  unsigned traits = 0;
  std::function<void(vtkAlgorithm*)> set = {}; ///< the options; called with each filter of the chain
  std::string like = {};                       ///< row whose light is the same

  bool Is(unsigned trait) const { return (this->traits & trait) != 0; }
  bool IsOfMaps() const { return this->family == StressFamily::Maps; }
  bool IsOfLattice() const { return this->family == StressFamily::Lattice; }
  bool IsGrid() const { return this->family <= StressFamily::Lattice; }
  bool EndsByTolerance() const { return this->IsGrid() && !this->Is(Published | ByOrders); }
  bool IsPhotons() const { return this->family >= StressFamily::Photons && this->family <= StressFamily::Octree; }
  bool IsStage() const { return this->family >= StressFamily::Emission && this->family <= StressFamily::Mesh; }
  bool IsView() const { return this->family == StressFamily::View; }
};

/// All rows. A solver with an option is one line of this table.
const std::vector<StressSolver>& StressSolvers();

/// Whether a row has anything to do with a case: photons come from lamps and skies only, a viewer sees no lamps, ...
bool Concerns(const StressSolver& solver, const StressCase& stressCase);

/// The case as a row has it: with what its options change, and without what is not known of its light.
StressCase CaseFor(const StressSolver& solver, StressCase stressCase);

/// A number that must not be above another one.
struct StressCheck
{
  std::string name;
  double value, atMost;
  bool Holds() const { return this->value <= this->atMost; } // not a number does not
};

class StressListener;

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
  std::vector<double> halfRangeFlux; ///< of maps and ordinates; one, or one a channel
  std::vector<double> scattered;     ///< W, of photons
  std::vector<float> directions;     ///< mean directions, 3 a voxel, of photons
  double residual = 0.0;             ///< of grids, what the solver says is left, over its tolerance
  double rawTotal = 0.0;             ///< of reconstructions: the sum of the noisy fluence
  std::vector<float> levels;         ///< of the octree
  double nodes = 0.0;
  std::vector<float> radiance, alpha; ///< of views, 3 and 1 a pixel: in a furnace
  std::vector<float> through;         ///< of views, 3 a pixel: a background of 1 seen through the unlit medium along -z
  std::vector<StressCheck> checks;    ///< of stages, on what they make
};

/// Of maps and lattices: their default, and less where what is compared is not how far iterations went.
constexpr double StressTolerance = 1e-4, StressTightTolerance = 3e-5;

/// @param tolerance  of maps and lattices
StressOutcome RunStress(const StressSolver& solver, const StressScene& scene, double tolerance = StressTolerance);

/// Index of each voxel as the bent view sees it: the scene's own, or that of a soft ball.
std::vector<float> IndexToView(const StressScene& scene);

/// Scattering orders at most, of the maps that are not accelerated; as published they are slow where voxels are 1:1000.
constexpr int StressOrders = 10, StressOrdersPublished = 1, StressOrdersOrdinates = 40, StressStepsLattice = 200;
/// What faces give back in rows of reflecting faces: their sky and faces shine with the rest of the scene's light.
constexpr double StressAlbedo = 0.5;
/// Scatterings of a photon, about, in a scene.
double ScatteringsOf(const StressScene& scene);
/// Photons of a chain: fewer where each is scattered more than some hundred times, as a cell is to take seconds.
std::size_t PhotonsFor(const StressSolver& solver, const StressScene& scene);
constexpr int StressPhotons = 20000;

/// Light of one scattering order, photons, importance map or voxels of a mesh, by filters of their own.
void RunStage(const StressSolver& solver, const StressScene& scene, StressListener* listener, StressOutcome& outcome);
/// Light of a grid solver or of photons on three ranks.
void RunOnRanks(const StressSolver& solver, const StressScene& scene, double tolerance, StressOutcome& outcome);

}
