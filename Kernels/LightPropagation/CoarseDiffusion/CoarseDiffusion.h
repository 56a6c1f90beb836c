#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Diffusion matrix on the cells of coarse-mesh DSA (numerics.md, Eq. (76d)), for MultigridSolver.
struct CoarseMatrix
{
  /// Conductances of the cells' low faces, and absorbed power per fluence, length^2, in the memory layout of
  /// MultigridSolver (MultigridLevel).
  std::vector<float> conductance, loss;
  /// Escaped power per fluence through each cell of the box's faces (BoxFaces.h), length^2.
  std::vector<double> borders;
};

/// Computes the diffusion matrix of the cells.
/// @param grid  voxels of the whole domain
/// @param cells  grid of the cells of `box`; only its size is used
/// @param sigmaT, sigmaS  1/length, summed over the voxels of each cell, x fastest
CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS);

/// Coarse-mesh DSA: diffusion on cells of 2, 4 or 8 voxels along each axis (numerics.md, section 7.13), which predicts
/// the fluence of all later scattering orders from the power that the last sweep scattered. Cells are at most about a
/// mean free path wide, so that sweeps damp errors below cell size quickly. The prediction is subtracted from the next
/// sweep's result, so it changes the rate of convergence, not the limit.
///
/// Cells are cells of the whole grid, and may contain voxels of several ranks: each rank sums over its voxels, the
/// first rank solves, and all ranks receive the solution. Constructor and functions are collective.
///
/// Related: diffusion synthetic acceleration (Adams and Larsen 2002), here on a coarser grid than the sweeps'.
class CoarseDiffusion
{
public:
  struct Settings
  {
    std::array<bool, 3> periodic; ///< which axes of the domain are periodic
    std::array<int, 3> halvings;  ///< by axis: cells have 2^halvings voxels along it
    bool linear;                  ///< true: light varies linearly across voxels; false: it is constant in each
  };
  /// @param domain, medium, path  must outlive this object
  /// @param layout  layout of the rank's block
  /// @param path  path integrals of the sweeps, W length, [channel][voxel]
  CoarseDiffusion(Device& device, const Domain& domain, const VolumeLayout& layout, const MediumOnDevice& medium,
    const Buffer<float>& path, const Settings& settings);

  /// Powers of one scattering order in one channel, summed over ranks, W.
  struct Powers
  {
    double absorbed = 0.0;  ///< power absorbed from the light of this order and of the predicted later orders
    double scattered = 0.0; ///< power of the next source
    double magnitude = 0.0; ///< sum of the absolute values of the next source
    double left = 0.0;      ///< power of later orders that the solution neither absorbs nor lets escape
    /// Power by which the next sweep will overestimate the escaped power through each face of the box (numerics.md, Eq.
    /// (76g)); included in the next source.
    std::array<double, 6> kept = {};
    std::array<double, 6> out = {}; ///< escaped power through each face of the box, according to the solution
  };

  /// Computes the next source from a sweep's path integrals. Adds the path integrals, and the diffusion solution on the
  /// cells for all later orders, to `fluence`. Sets the path integrals to minus those of the solution, to which the
  /// next sweep adds. All arrays are [channel][voxel].
  /// @param source  W / (length^3 sr), replaced
  /// @param onTheWay  power in flight around periodic axes, W by channel; added to the right-hand side, uniformly over
  ///   the box
  /// @param guess  path integrals of all later orders, W length, used instead of the cells' solution; null: use the
  ///   solution
  /// @return powers by channel
  std::vector<Powers> ScatterOrder(
    const Buffer<float>& fluence, const Buffer<float>& source, const Rgb& onTheWay, const Buffer<float>* guess);

private:
  struct Sums
  {
    /// First two sums of the kernel: source and its absolute value, or power absorbed from all light and from later
    /// orders.
    double first = 0.0, second = 0.0;
    std::array<double, 6> byFace = {};
  };
  struct Channel
  {
    CoarseCells box = {};
    std::unique_ptr<MultigridSolver> solver; ///< solver of the diffusion on cells; null except on the first rank
    /// Escaped power per fluence through each cell of the box's faces, length^2 (CoarseMatrix).
    std::vector<double> borders;
    std::vector<double> found; ///< solution after the last scattering order, W / length^2, by cell
    ExactValues foundOnDevice;
  };
  void MakeBoxes(const VolumeLayout& layout, const Settings& settings);
  void FindMatrix(Channel& channel);
  cl::Kernel Kernel(const char* name) const;
  std::vector<double> SumByCells(
    const CoarseCells& box, const Buffer<float>& values, int first, double scale, double more) const;
  Sums Scatter(const Channel& channel, const Buffer<float>& source, double sign, bool adds) const;
  void Solve(Channel& channel, const Buffer<float>& source, double magnitude, double onTheWay) const;
  Sums AddLaterOrders(const Channel& channel, const Buffer<float>* guess, const Buffer<float>& fluence) const;
  std::array<double, 6> OutThroughFaces(const Channel& channel) const;
  Sums RunByRows(const char* name, const std::function<void(cl::Kernel&)>& setArguments) const;

  Device& TheDevice;
  const Domain& TheDomain;
  const MediumOnDevice& TheMedium;
  const Buffer<float>& Path;
  const BlockWithGhosts Block;
  GhostedBuffer PathWithGhosts, SigmaT, SigmaS;
  Grid Cells; ///< grid of the cells of the whole domain
  Buffer<float> CellSums;
  Buffer<cl_float8> Tally; ///< partial sums of kernels, by row of voxels
  std::vector<Channel> Channels;
};
}
