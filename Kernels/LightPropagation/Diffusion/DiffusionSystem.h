#pragma once

#include "Device/Sizes.h"
#include "LightPropagation/Diffusion/AndersonMixing.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Diffusion/SweepModel.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Returns a DiffusionLayout in which the geometry and the offsets of the channel are set, and all other members are 0.
/// @param stride, firstT, first  as in DiffusionSystem::Arrays
inline DiffusionLayout LayoutOf(
  const Grid& grid, const std::array<bool, 3>& periodic, std::size_t stride, std::size_t firstT, std::size_t first)
{
  DiffusionLayout layout = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    layout.size[axis] = grid.size[axis];
    layout.periodic[axis] = periodic[axis];
    layout.spacing[axis] = static_cast<float>(grid.spacing[axis]);
  }
  layout.stride = static_cast<cl_int>(stride);
  layout.firstT = static_cast<cl_int>(firstT);
  layout.first = static_cast<cl_int>(first);
  return layout;
}

/// Runs a kernel with one work-item per voxel (VOXEL in BoxBorders.cl).
inline void RunVoxels(Device& device, cl::Kernel& kernel, const DiffusionLayout& layout)
{
  const cl::NDRange range(RoundUp<std::size_t>(layout.size[0], 32), RoundUp<std::size_t>(layout.size[1], 8),
    static_cast<std::size_t>(layout.size[2]));
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NDRange(32, 8, 1));
}

/// Power of one channel through the cells of the box's faces, W / length^2, without uncollided light of lamps.
struct SurfacePowers
{
  std::vector<double> net;       ///< outgoing minus incident power, by cell (BoxFaces.h)
  std::array<double, 6> in = {}; ///< incident power through each face, averaged over its cells
  std::vector<double> back;      ///< reflected power by cell; empty: no face reflects
  const float* lamps = nullptr;  ///< uncollided fluence of lamps by voxel, W / length^2; null: there are no lamps
  /// DiffusionLayout::halfRange of the quadrature of incident light: `in` is 4 pi halfRange L for isotropic radiance L.
  double halfRange = 0.25;
};

/// Diffusion system of one channel (numerics.md, section 7): the power balance of each voxel with diffusive powers
/// through its faces, corrected by the powers that a sweep carried through these faces, Eq. (53). Its solution is the
/// fluence of all scattering orders.
///
/// Requires the path integrals and partial currents of a sweep with a known source. Sweeps and solves alternate: the
/// source of each sweep is computed from the last solution. This iteration converges in a few steps for any optical
/// thickness and albedo.
///
/// Guarantees: power is conserved exactly, since the power that leaves one voxel enters its neighbour. In thin voxels,
/// in vacuum and next to boundaries the solution is that of the sweep; in optically thick voxels it is that of
/// diffusion, without the excess current of a source that is constant in each voxel (Eqs. (51), (52)). With `linear`
/// false it is the solution of the sweeps everywhere, including that excess.
///
/// Related: coarse-mesh finite differences (Smith 1983; Cho, Lee and Park 2003), the second-moment method (Lewis and
/// Miller 1976); numerics.md, section 7.11.
class DiffusionSystem
{
public:
  /// Arrays that the system reads, for all channels: [channel][voxel], `stride` floats per channel, unless stated
  /// otherwise.
  struct Arrays
  {
    /// Floats from one channel to the next; index of this channel's first value in sigma_t and `swept` (firstT), and in
    /// all other arrays (first).
    std::size_t stride, firstT, first;
    const Buffer<float>* sigma_t; ///< transport extinction, 1/length: sigma_a + sigma_s (1 - g)
    const Buffer<float>* swept;   ///< extinction used by the sweeps, 1/length
    const Buffer<float>* sigma_a; ///< absorption coefficient, 1/length
    const Buffer<float>* sigma_s; ///< scattering coefficient, 1/length; below 0 in ghost voxels
    const Buffer<float>* given;   ///< emission and first-collision source, W / (length^3 sr)
    MomentPlaces moments;         ///< memory layout of the angular moments in `path`
    int channel;                  ///< channel of this system
    /// Net flux of `given` divided by 4 pi, if there are angular moments, [channel][x, y, z][voxel]; null: isotropic.
    const Buffer<float>* givenFlux;
    const Buffer<float>* source; ///< source of the sweep, W / (length^3 sr)
    const Buffer<float>* path;   ///< path integrals of the sweep, W length
    /// Partial currents of the sweep, W, [channel][-x, +x, -y, +y, -z, +z][voxel].
    const Buffer<float>* partialCurrents;
    /// Power of lamps' first-scattered light that leaves a voxel through each face without another collision
    /// (LampPassing.cl), W, [channel][-x, +x, -y, +y, -z, +z][voxel]; null: voxels are thin, or there are no lamps.
    const Buffer<float>* passed;
    /// First-collision source of lamps without the light that `passed` counts, W / (length^3 sr), [channel][voxel];
    /// not used if `passed` is null.
    const Buffer<float>* ofLamps;
    /// Power by cell of the box's faces, W, [FaceCame ... FaceLeaves][cell, numbered as in BoxFaces.h]; SumBorders()
    /// writes the row FaceLeaves. Null: no face reflects, and power by cell is not requested.
    const Buffer<float>* faces = nullptr;
    std::array<double, 6> albedo = {}; ///< albedo of the box's faces
  };

  /// @param solver  solver on the same voxels, whose matrix of the finest level the constructor writes; must outlive
  ///   this object
  /// @param incoming  incident power through the box's faces without that of lamps, W / length^2
  DiffusionSystem(Device& device, MultigridSolver& solver, const Grid& grid, const std::array<bool, 3>& periodic,
    const SweepModel& model, const Arrays& arrays, const std::array<double, 6>& incoming, bool linear);

  /// The last solution: fluence, W / length^2, [voxel]; with angular moments, followed by the moments of degree 1,
  /// [x, y, z][voxel].
  std::vector<double> State() const { return this->Solution.Read(); }
  /// Sets the state (fluence and moments, in the layout of State()) from which the next sweep's source and the next
  /// correction are computed. The initial state is 0.
  void Begin(const std::vector<double>& state)
  {
    this->Next.Write(state);
    this->Solution.Write(state);
  }
  /// Fluence from which the next sweep's source is to be computed, W / length^2: the last solution after Anderson
  /// mixing.
  const ExactValues& NextFluence() const { return this->Next; }
  /// Changes the next sweep's source in optically thick voxels next to thinner ones, such that the sweep emits the
  /// outgoing partial current of diffusion there (numerics.md, Eqs. (63), (64)).
  void ShapeSource();
  /// Optical thickness of the thickest voxel that lies next to a thinner one, NoSkin to EndlessSkin.
  int MostOpaqueSkin() const { return this->MostOpaque; }

  // Steps of DiffusionSolver::Correct(), in order. The system of a rank's block includes ghost voxels, which have
  // `sigma_s` below 0 and are excluded from sums.

  /// Computes the fluence m of Eq. (56), from which diffusion's power through each face is computed, to be compared
  /// with the sweep's power.
  void FindModel();
  Buffer<float>& TheModel() { return this->Model; } ///< result of FindModel(), W / length^2, [voxel]
  void Balance(); ///< computes the right-hand side of Eq. (53) from the sweep's powers and the result of FindModel()
  /// The solution, with ghost voxels: input and result of the linear solver.
  ExactValues& Solved() { return this->Solution; }
  void FindFlux(); ///< with angular moments: computes the moments of degree 1 of the solution, Eq. (70a)
  /// This rank's sums for Anderson mixing of the solution.
  /// @param alike  whether voxels that hardly scatter have the same weight in the change as all other voxels
  AndersonMixing::Sums SumsOfChange(bool alike) const;
  void MixBy(const AndersonMixing::Sums& sums) { this->Mixing.Mix(this->Next, this->Solution, sums); }

  /// Sums over cells of the box's faces, W, from which DiffusionSolver::Outflow() computes the escaped power.
  struct BorderSums
  {
    /// By face: outgoing power of the solution, outgoing power of the sweep (estimated), and incident power of the
    /// sweep.
    std::array<double, 6> out = {}, seeming = {}, came = {};
    /// Sum of the weights of the transport correction over the cells of voxels that have several faces on the box's
    /// boundary, and number of these cells.
    double transportWeight = 0.0, shared = 0.0;
  };
  /// @param counts  whether to include a cell, given by its face and its indices along the other two axes, the lower
  ///   axis first
  BorderSums SumBorders(const std::function<bool(int face, int u, int v)>& counts);
  /// Absorbed power of the solution in the voxels that this rank owns, W.
  double Absorbed() const;

  /// Power through the cells of the box's faces, W / length^2, after SumBorders().
  SurfacePowers PowersAtSurface() const;

  /// Replaces the moments of degree 1 in a sweep's path integrals, W length, by those that belong to NextFluence(): the
  /// sweep's moments, plus the diffusive net flux of the solution minus that of the result of FindModel() (numerics.md,
  /// Eq. (70a)).
  void PutNextFlux(const Buffer<float>& path);

  /// Adds the net flux of the solution times the voxel's volume to `flux`, [channel][x, y, z][voxel].
  void AddFlux(const Buffer<float>& flux);

private:
  std::size_t Values() const { return this->HasMoments() ? 4 * this->Count : this->Count; }
  bool HasMoments() const { return this->Inputs.swept != this->Inputs.sigma_t; }
  // Kernel arguments for optional arrays. An array that does not exist is replaced by another one, which the kernel
  // does not read.
  const Buffer<float>& GivenFlux() const
  {
    return this->Inputs.givenFlux ? *this->Inputs.givenFlux : *this->Inputs.given;
  }
  const Buffer<float>& Faces() const { return this->Inputs.faces ? *this->Inputs.faces : this->Model; }
  const Buffer<float>& Passed() const { return this->Inputs.passed ? *this->Inputs.passed : this->Model; }
  void FindFlatSource(const SweepModel& model);
  void FindSkins();
  const Buffer<float>& ExtinctionInRows();
  cl::Kernel Kernel(const char* name) const;
  cl::Kernel RowsKernel(const char* name) const; ///< kernel of DiffusionRows.cl
  void Run(cl::Kernel& kernel);                  ///< runs a kernel with one work-item per voxel
  void RunBorder(cl::Kernel& kernel);            ///< runs a kernel with one work-item per cell of the box's faces
  void RunRows(cl::Kernel& kernel) const { RunRowsOf(this->TheDevice, kernel, this->Layout.rows); }
  /// Creates a kernel whose arguments are the layout, the arrays of the channel, and then `more`.
  template <class... More>
  cl::Kernel OnArrays(const char* kernel, const More&... more);

  Device& TheDevice;
  DiffusionLayout Layout = {};
  Arrays Inputs;
  std::size_t Count, BorderCells;
  MultigridSolver& Solver;
  Buffer<float> FlatSource, Pattern, Model;
  int MostOpaque = NoSkin;
  Buffer<cl_int> Skins; ///< by row of voxels, [z][y], NoSkin to EndlessSkin
  AndersonMixing Mixing;
  ExactValues Borders;
  /// State from which the next sweep's source is computed, and the last solution, in the layout of State()
  ExactValues Next, Solution;
};
}
