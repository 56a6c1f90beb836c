#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "LightPropagation/Diffusion/AndersonMixing.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"

#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Rays that cross the voxels' faces in the sweeps' repeated pattern, over those that a face should see: by axis of the
/// face and plane along each other axis (two parts of one sum). Around 1; exactly that only in the mean over planes.
struct CrossingPattern
{
  std::vector<float> values;
  std::array<int, 6> first = {}; ///< [axis][other axes in order]
};
CrossingPattern FindCrossingPattern(const Grid& grid, const DirectionSet& directions, int mapResolution,
  RayStarts starts, const std::array<bool, 3>& periodic);

/// A lamp's light in thick voxels, and the sums over all lamps that it is added to. Arrays as DiffusionSystem::Arrays
/// has them.
struct LampLight
{
  std::size_t stride, firstT, first;
  const Buffer<float>* sigma_t;
  const Buffer<float>* sigma_a;
  const Buffer<float>* sigma_s;
  const Buffer<float>* path;    ///< W length, of the lamp
  const Buffer<float>* moments; ///< of it, as in SweepVolume.h
  const Buffer<float>* passed;  ///< W, added to
  const Buffer<float>* allPath; ///< W length, added to
};

/// How much of a lamp's light passes the faces of voxels at once where it is first scattered: see DiffusionSystem. One
/// lamp at a time, for each has its own depth in a voxel.
void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light);

/// The second, diffusion-like equation that carries light far in one step, where sweeps carry it from voxel to voxel.
///
/// A sweep with fluence `phi` as its source finds the net power F through every face, and the fluence that goes with
/// it. Were the light's angular distribution linear and its course linear from voxel centre to voxel centre, the true
/// power through the face between voxels L and R were D (phi_L - phi_R), D = area / (3 tau), tau the optical length
/// between their centres (tau_a of absorption only); but a sweep whose source is constant in each voxel finds M(phi) =
/// 3 D (s_L + s_R) (phi_L - phi_R), where s = sum mu tau / 2 coth(tau / 2 mu) is the current of such a flat source (1/6
/// for thin voxels, tau / 8 for thick: there F is nearly all error). So
///   sum over faces of [D (x_L - x_R) + w (F - M(m))] + sigma_a V x = emission,   w = 1 / (1 + tau^2 / 4 + 3 tau
///   tau_a),
/// is right for thin voxels, in vacuum and next to walls and borders, where F - M is transport that diffusion does not
/// know, and has the diffusion limit, however thick voxels are. m is the sweep's own fluence in thin voxels (then the
/// solution is the sweep's) and phi in thick ones. Borders of the box: Marshak's condition for D, the same kind of
/// correction. With phi := x iterated this converges in a few sweeps. It conserves energy exactly: what goes out of one
/// voxel goes into the next.
///
/// Kin of coarse-mesh finite differences (Smith 1983) with an additive, linear correction (Cho et al. 2003, `optimally
/// diffusive` there: the larger D of thick voxels; here the excess of the flat source's current is taken out of the
/// correction instead) and of the second-moment method (Lewis and Miller 1976), which takes the correction from second
/// moments instead of face powers. Light that dies away within a voxel (y = half its size in diffusion lengths): D's
/// half voxels conduct 2 y^2 / (2 y - 1 + exp(-2 y)) better at a border between unlike voxels and (y / sinh y)^2 among
/// equals: light that falls off exponentially is then met exactly.
///
/// Light of lamps is not carried by this system until it is scattered for the first time. In thick voxels that happens
/// near the faces that it comes in through, not at the centres: from a depth t (optical) towards face d,
///   part = (1 - 2 t / tau) tau_i / (tau_i + tau_j)                              goes on to the voxel beyond at once,
///   part = 1 - (t + q) / (tau / 2 + 2 / 3), q = H(t) / sqrt(3) - t (Hopf)       leaves the box,
/// as from a source there by diffusion (with absorption: the same for exp(-k t)); it counts as power through the face,
/// so none is lost. t is from the first moment of what lamps' rays lose, see SweepVolume::moments. Slabs of 32 voxels
/// under beams, albedo 1: transmittance to 0.5% from optical thickness 0.01 to 1e6.
///
/// What lies in vacuum sees of a thick voxel the skin, which need not be as bright as its middle: as a sweep's source
/// such a voxel shines so that 4 J+ = fluence at the face + 2 J, J the net flux through it by this system. A slab
/// between clear voxels transmits a beam to 2%, but 6% too little where its voxels are 2 mean free paths.
///
/// With `linear` false, D = area (s_L + s_R) / tau, w = 1, m the sweep's fluence: the solution is the sweep's own, with
/// all the errors of a constant source, only sooner.
class DiffusionSystem
{
public:
  /// The solver's arrays; those of all channels, one after the other, `stride` voxels each.
  struct Arrays
  {
    std::size_t stride, firstT, first;    ///< where this channel begins, in sigma_t and in the others
    const Buffer<float>* sigma_t;         ///< 1/length
    const Buffer<float>* sigma_a;         ///< 1/length
    const Buffer<float>* sigma_s;         ///< 1/length
    const Buffer<float>* given;           ///< emitted, and of lights first scattered, W / (length^3 sr)
    const Buffer<float>* source;          ///< of a sweep, W / (length^3 sr)
    const Buffer<float>* path;            ///< W length, that it found
    const Buffer<float>* partialCurrents; ///< W, [channel][-x, +x, -y, +y, -z, +z][stride], that it found
    /// W, [channel][-x, +x, -y, +y, -z, +z][stride]: lamps' light that passes a face at once where it is scattered
    /// (PassLampLight); null: voxels are thin, or there are no lamps
    const Buffer<float>* passed;
  };

  /// @param incoming  W / length^2 through the box's faces, but that of lights
  DiffusionSystem(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& directions,
    const CrossingPattern& pattern, const Arrays& arrays, const std::array<double, 6>& incoming, bool linear);

  /// What the last correction led to: write it as the next sweep's source.
  void WriteSource();

  /// Solve for the light after a sweep.
  /// @param unit  W of a voxel, about
  /// @return |found - given| / |found|
  double Correct(double unit);

  /// Solve once more, for what the last correction found to more digits.
  void Refine(double unit) { this->Solver.Solve(this->Right, this->Solution, unit, 1e-3, 1e-6); }

  /// W / length^2, what the last correction found.
  std::vector<double> Found() const { return this->Solution.Read(); }
  /// W out of the box through each of its faces, by the last correction; 0 where it is periodic.
  /// @param ofSweep  W that left through each face in the sweep: tells how to share out what leaves at the box's edges
  std::array<double, 6> Outflow(const std::array<double, 6>& ofSweep);

  /// W through each voxel's faces at the box's, of the last Outflow.
  SurfacePowers PowersAtSurface() const;

  /// Add the net flux times the voxel's volume to [channel][x, y, z][stride].
  void AddFlux(const Buffer<float>& flux);

private:
  cl::Kernel Kernel(const char* name) const;
  void Run(cl::Kernel& kernel);
  /// The arguments that the kernels share, then `more`.
  template <class... More>
  void RunOnArrays(const char* kernel, const More&... more);

  Device& TheDevice;
  DiffusionLayout Layout = {};
  Arrays The;
  std::size_t Count;
  MultigridSolver Solver;
  Buffer<float> FlatSource, Pattern, Model;
  AndersonMixing Mixing;
  ExactValues Right, Given, Solution, Borders;
};
}
