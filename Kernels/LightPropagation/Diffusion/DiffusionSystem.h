#pragma once

#include "Device/Sizes.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Diffusion/AndersonMixing.h"
#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// @param arrays  has the offsets of a channel and the stride (DiffusionSystem::Arrays, LampLight)
template <class Arrays>
DiffusionLayout LayoutOf(const Grid& grid, const std::array<bool, 3>& periodic, const Arrays& arrays)
{
  DiffusionLayout layout = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    layout.size[axis] = grid.size[axis];
    layout.periodic[axis] = periodic[axis];
    layout.spacing[axis] = static_cast<float>(grid.spacing[axis]);
  }
  layout.stride = static_cast<cl_int>(arrays.stride);
  layout.firstT = static_cast<cl_int>(arrays.firstT);
  layout.first = static_cast<cl_int>(arrays.first);
  return layout;
}

/// Runs a kernel with one work-item per voxel (VOXEL in DiffusionLayout.cl).
inline void RunVoxels(Device& device, cl::Kernel& kernel, const DiffusionLayout& layout)
{
  const cl::NDRange range(RoundUp<std::size_t>(layout.size[0], 32), RoundUp<std::size_t>(layout.size[1], 8),
    static_cast<std::size_t>(layout.size[2]));
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NDRange(32, 8, 1));
}

/// Power of one channel through the cells of the box's faces, W / length^2, without uncollided light of lamps.
struct SurfacePowers
{
  std::vector<double> net;       ///< outgoing minus incoming, by cell (BoxFaces.h)
  std::array<double, 6> in = {}; ///< incident through each face, averaged over its cells
  std::vector<double> back;      ///< reflected power by cell; empty: no face reflects
  const float* lamps = nullptr;  ///< uncollided fluence of lamps by voxel; null: there are none
  /// halfRange of the quadrature of the incident light: isotropic radiance L gives `in` = 4 pi halfRange L
  double halfRange = 0.25;
};

/// The diffusion system of one channel (numerics.md, section 7): a diffusion-like balance of each voxel's power,
/// corrected by the powers that a sweep found through its faces, Eq. (53). Its solution is the fluence of all
/// scattering orders.
///
/// Requires a sweep's path integrals and partial currents for a known source. Alternating with sweeps, each with the
/// solution as its fluence, it converges in a few iterations whatever the thickness and albedo.
///
/// Guarantees: power is conserved exactly, since what leaves one voxel enters the next. In thin voxels, in vacuum and
/// next to boundaries the solution is the sweep's; in optically thick ones it is that of diffusion, without the excess
/// of a source that is constant in each voxel (Eqs. (51), (52)). With `linear` false it is the sweep's own solution,
/// with that excess.
///
/// Related: coarse-mesh finite differences (Smith 1983; Cho, Lee and Park 2003), the second-moment method (Lewis and
/// Miller 1976); numerics.md, section 7.11.
class DiffusionSystem
{
public:
  /// The solver's arrays, for all channels: `stride` voxels for each channel.
  struct Arrays
  {
    std::size_t stride, firstT, first; ///< offset of this channel in sigma_t and in the others
    const Buffer<float>* sigma_t;      ///< transport extinction, 1/length: sigma_a + sigma_s (1 - g)
    const Buffer<float>* swept;        ///< extinction used by the sweeps, 1/length
    const Buffer<float>* sigma_a;      ///< 1/length
    const Buffer<float>* sigma_s;      ///< 1/length
    const Buffer<float>* given;        ///< emission and first-collision source, W / (length^3 sr)
    MomentPlaces moments;              ///< places of the angular moments in `path`
    int channel;                       ///< channel of this system
    /// Net flux of `given` over 4 pi, if there are angular moments, [channel][x, y, z][stride]; null: isotropic.
    const Buffer<float>* givenFlux;
    const Buffer<float>* source; ///< source of the sweep, W / (length^3 sr)
    const Buffer<float>* path;   ///< path integrals of the sweep, W length
    /// Partial currents of the sweep, W, [channel][-x, +x, -y, +y, -z, +z][stride]
    const Buffer<float>* partialCurrents;
    /// Power of lamps' first-scattered light that crosses a face directly (LampPassing.h), W, [channel][-x, +x, -y, +y,
    /// -z, +z][stride]; null: voxels are thin, or there are no lamps.
    const Buffer<float>* passed;
    /// First-collision source of lamps minus `passed`, W / (length^3 sr), [channel][stride]; used with `passed` only.
    const Buffer<float>* ofLamps;
    /// Power by cell of the box's faces, W, [row of DiffusionShared.h][cell of BoxFaces.h]; SumBorders() writes the
    /// last row. Null: no face reflects, and the powers are not wanted.
    const Buffer<float>* faces = nullptr;
    std::array<double, 6> albedo = {}; ///< of the box's faces
  };

  /// @param solver  of the same voxels; its matrix is written, except for the coarser levels; must outlive this object
  /// @param incoming  incident power through the box's faces without that of lamps, W / length^2
  DiffusionSystem(Device& device, MultigridSolver& solver, const Grid& grid, const std::array<bool, 3>& periodic,
    const DirectionSet& directions, const CrossingPattern& pattern, const Arrays& arrays,
    const std::array<double, 6>& incoming, bool linear);

  /// The last solution: fluence, W / length^2, [voxel]; if there are angular moments, followed by those of degree 1,
  /// [x, y, z][voxel].
  std::vector<double> State() const { return this->Solution.Read(); }
  /// Sets the state, see State(), from which the next sweep's source and the next correction are computed; initially it
  /// is 0.
  void Begin(const std::vector<double>& state)
  {
    this->Next.Write(state);
    this->Solution.Write(state);
  }
  /// Fluence from which the next sweep's source is to be computed, W / length^2: the result of the last correction.
  const ExactValues& NextFluence() const { return this->Next; }
  /// Changes the next sweep's source at the surfaces of optically thick voxels such that the sweep finds the outward
  /// partial current of diffusion.
  void ShapeSource();

  // The steps of a correction (DiffusionSolver.h). The system of a rank's block includes ghost cells, whose `sigma_s`
  // is below 0: they are excluded from sums.

  void FindModel();                                 ///< computes the fluence with which the sweep is compared
  Buffer<float>& TheModel() { return this->Model; } ///< W / length^2, [voxel]
  void Balance(); ///< computes the right-hand side: each voxel's balance, from the model
  /// The solution; ghost voxels included.
  ExactValues& Solved() { return this->Solution; }
  void FindFlux(); ///< computes the moments of degree 1 that belong to the solution, if there are angular moments
  AndersonMixing::Sums SumsOfChange() const; ///< for the mixing of the solution; call after it was found
  void MixBy(const AndersonMixing::Sums& sums);

  /// Sums over cells of the box's faces, from which the escaped power of the last correction follows, W.
  struct BorderSums
  {
    std::array<double, 6> out = {}, seeming = {},
                          came = {}; ///< by face: outgoing power, estimate of it from the sweep, incoming power
    /// Sum over the cells of voxels with several faces, and number of such cells.
    double transportWeight = 0.0, shared = 0.0;
  };
  /// @param counts  whether to count a cell of a face (face; position along the other two axes in order)
  BorderSums SumBorders(const std::function<bool(int face, int u, int v)>& counts);
  /// Power absorbed according to the last correction, W; without ghost voxels.
  double Absorbed() const;

  /// Power through the voxels' faces on the box's surface, W, of the last SumBorders().
  SurfacePowers PowersAtSurface() const;

  /// Replaces the first moments in a sweep's path by those that belong to NextFluence(): the sweep's, plus the
  /// difference of the solution's net flux from that of the model, W length (numerics.md, Eq. (70a)).
  void PutNextFlux(const Buffer<float>& path);

  /// Adds the net flux times the voxel's volume to [channel][x, y, z][stride].
  void AddFlux(const Buffer<float>& flux);

private:
  std::size_t Values() const { return this->HasMoments() ? 4 * this->Count : this->Count; }
  bool HasMoments() const { return this->Inputs.swept != this->Inputs.sigma_t; }
  // Arrays that kernels read only if they exist; else any other.
  const Buffer<float>& GivenFlux() const
  {
    return this->Inputs.givenFlux ? *this->Inputs.givenFlux : *this->Inputs.given;
  }
  const Buffer<float>& Faces() const { return this->Inputs.faces ? *this->Inputs.faces : this->Model; }
  const Buffer<float>& Passed() const { return this->Inputs.passed ? *this->Inputs.passed : this->Model; }
  void FindSkins();
  const Buffer<float>& ExtinctionInRows();
  std::string Options() const;
  cl::Kernel Kernel(const char* name) const;
  cl::Kernel RowsKernel(const char* name) const; ///< kernel that processes rows
  void Run(cl::Kernel& kernel);                  ///< one work-item per voxel
  void RunBorder(cl::Kernel& kernel);            ///< one work-item per cell of the box's faces
  void RunRows(cl::Kernel& kernel) const;
  /// Creates a kernel and sets the arguments that all kernels share, then `more`.
  template <class... More>
  cl::Kernel OnArrays(const char* kernel, const More&... more);

  Device& TheDevice;
  DiffusionLayout Layout = {};
  Arrays Inputs;
  std::size_t Count, BorderCells;
  MultigridSolver& Solver;
  Buffer<float> FlatSource, Pattern, Model;
  Buffer<cl_int> Skins; ///< by row: 1 if it has thick voxels next to thinner ones
  bool AnySkin = false;
  AndersonMixing Mixing;
  ExactValues Borders;
  ExactValues Next, Solution; ///< [voxel]; if there are moments, followed by those of degree 1, [x, y, z][voxel]
};
}
