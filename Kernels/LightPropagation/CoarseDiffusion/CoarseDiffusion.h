#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Problem/TruncatedScattering.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Coarse-mesh DSA: diffusion of one channel on cells of 2, 4 or 8 voxels along each axis (numerics.md, section 7.13),
/// which estimates the contribution of all later scattering orders from the light that a sweep found. Cells are at most
/// about a mean free path wide, so that sweeps damp errors below cell size quickly. The correction is subtracted from
/// the next source, so it changes the rate of convergence, not the limit.
///
/// Related: diffusion synthetic acceleration (Adams and Larsen 2002), here on a coarser grid than the sweeps'.
class CoarseDiffusion
{
public:
  /// @param halvings  along each axis; cells have 2^halvings voxels
  /// @param linear  light varies linearly across voxels rather than being constant in each
  CoarseDiffusion(Device& device, const VolumeLayout& layout, int channel, const MediumOnDevice& medium,
    const std::array<bool, 3>& periodic, const std::array<int, 3>& halvings, bool linear);

  /// Powers of one scattering order, W.
  struct Powers
  {
    double absorbed = 0.0;  ///< absorbed from all light added in this order
    double scattered = 0.0; ///< power of the next source
    double magnitude = 0.0; ///< sum of the absolute values of the next source
    double left = 0.0;      ///< neither absorbed nor escaped, according to the solution
    /// Power by which the next sweep would overestimate the escaped power through each face of the box; included in the
    /// next source.
    std::array<double, 6> kept = {};
    std::array<double, 6> out = {}; ///< escaped power through each face of the box, according to the solution
  };

  /// Computes the next source from a sweep's path integrals. Adds these and the cells' solution for all later orders to
  /// `fluence`, and leaves in `path` the (negative) path to subtract from the next sweep's. All arrays are
  /// [channel][stride].
  /// @param path  W length
  /// @param source  W / (length^3 sr), replaced
  /// @param onTheWay  power that rays around periodic axes still carry, W; it is added to the right-hand side,
  ///   uniformly over the box
  /// @param guess  path of all later orders, W length, to use instead of the cells' solution; null: use the solution
  Powers ScatterOrder(const Buffer<float>& path, const Buffer<float>& fluence, const Buffer<float>& source,
    double onTheWay = 0.0, const Buffer<float>* guess = nullptr);

private:
  struct Sums
  {
    double first = 0.0, second = 0.0; ///< meaning as in the kernel's tally
    std::array<double, 6> byFace = {};
  };
  cl::Kernel Kernel(const char* name) const;
  std::vector<float> SumOfVoxels(const Buffer<float>& values, int first);
  void FindMatrix();
  Sums Scatter(const Buffer<float>& path, const Buffer<float>& source, double sign, bool adds);
  void Solve(const Buffer<float>& source, double magnitude, double onTheWay);
  Sums AddFound(const Buffer<float>& path, const Buffer<float>& fluence);
  Sums AddGuess(const Buffer<float>& guess, const Buffer<float>& path, const Buffer<float>& fluence);
  std::array<double, 6> OutThroughFaces() const;
  Grid CellGrid() const;
  Sums RunByRows(cl::Kernel& kernel);

  Device& TheDevice;
  const MediumOnDevice& TheMedium;
  Grid TheGrid;
  CoarseCells Box = {};
  bool Linear;
  MultigridSolver Solver;
  ExactValues Found; ///< W / length^2, by cells
  Buffer<cl_float8> Tally;
  std::vector<double> Borders; ///< as in CoarseMatrix
};
}
