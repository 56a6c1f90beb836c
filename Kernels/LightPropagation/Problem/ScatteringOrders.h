#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ThickLines.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What tells how often the light of one channel is scattered.
struct ScatteringOfChannel
{
  ThickLines diffusing; ///< as light diffuses
  ThickLines swept;     ///< as sweeps carry it; not looked at without angular moments
  double albedo = 0.0;  ///< of what is scattered as sweeps carry it, in the mean
};

/// The same of a whole scene.
struct ScatteringOfScene
{
  Grid grid;
  std::array<bool, 3> periodic = {};
  std::array<Rgb, 6> faceAlbedo = {};
  int degree = 0; ///< of angular moments
  bool isSlab = false;
  double thickest = 0.0; ///< extinction of a voxel as sweeps carry light, 1/length, of all channels
  std::vector<ScatteringOfChannel> channels;
};
/// Collective, as all that is asked of a problem here.
ScatteringOfScene ScatteringOf(const PropagationProblem& problem);

/// Scattering orders, as sweeps carry them, until 1e-4 is left, about: those of diffusion in a slab with extrapolated
/// borders (numerics.md, Eq. (86)); thick lines of voxels stand for the slab.
double OrdersNeeded(const ScatteringOfScene& scene);
double OrdersNeeded(const PropagationProblem& problem);

/// So many that adding them up one by one is forecast to take longer than acceleration: both in orders, by what set-up,
/// sweeps and corrections were measured to take (`./run bench thick`).
bool ScatteredManyTimes(const ScatteringOfScene& scene);
bool ScatteredManyTimes(const PropagationProblem& problem);

/// How the fluence of all scattering orders is found.
enum class IterationScheme
{
  SourceIteration, ///< one sweep a scattering order; Conservative/SourceIteration.h
  CoarseMeshDsa,   ///< the same with a diffusion correction on cells of several voxels, for optically thin voxels
  Dsa, ///< diffusion synthetic acceleration on the voxels; Conservative/Acceleration/DiffusionAcceleration.h
};
/// That a serial solve takes. Collective.
IterationScheme FastestScheme(const PropagationProblem& problem);
/// That a solve on the problem's domain takes: the fastest that it has. Collective.
IterationScheme ChooseIterationScheme(const PropagationProblem& problem);
/// Whether settings let it depend on the scene, or ask for acceleration.
bool MayBeAccelerated(const PropagationSettings& settings, bool scatters);

/// Of how many voxels cells are to be along each axis, 2^this, for these to be about a mean free path wide at most
/// where the medium is thickest; all 0: voxels are too thick for cells of several.
std::array<int, 3> CellHalvings(const PropagationProblem& problem);
/// @param thickest  the largest extinction, 1/length
std::array<int, 3> CellHalvings(const Grid& grid, double thickest);
/// Whether cells have several voxels along each axis that the grid has several along.
bool AreThinEnough(const Grid& grid, const std::array<int, 3>& halvings);
}
