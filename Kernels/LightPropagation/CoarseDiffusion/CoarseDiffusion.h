#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Problem/MediumOnDevice.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Diffusion of one channel on cells of 2, 4 or 8 voxels along each axis (numerics.md, section 7.13): what the orders
/// to come will add, about, to the light that a sweep found. Cells are at most about a mean free path wide, so that
/// what they do not see falls off fast in sweeps. A guess only: it is taken away again from what the next sweep finds
/// of it, so that it changes how fast the light converges and not what it converges to.
///
/// Related: diffusion synthetic acceleration (Adams and Larsen 2002), here on a coarser grid than the sweeps'.
class CoarseDiffusion
{
public:
  /// @param halvings  along each axis; cells have 2^halvings voxels
  /// @param linear  light is taken as linear across voxels, not as constant in each
  CoarseDiffusion(Device& device, const VolumeLayout& layout, int channel, const MediumOnDevice& medium,
    const std::array<bool, 3>& periodic, const std::array<int, 3>& halvings, bool linear);

  /// W, of one order.
  struct Powers
  {
    double absorbed = 0.0;  ///< of all light that is added
    double scattered = 0.0; ///< of it, the next source
    double magnitude = 0.0; ///< the same without signs
    double left = 0.0;      ///< neither absorbed nor out, by the solution
    /// Of the next source, what is to be let out less through each face of the box than the next sweep will.
    std::array<double, 6> kept = {};
    std::array<double, 6> out = {}; ///< leaves through each face of the box, by the solution
  };

  /// From what a sweep gathered to the next source: adds it to `fluence`, with what the cells' solution says of all
  /// orders to come, and leaves in `path` what the next sweep is to have less. All arrays [channel][stride].
  /// @param path  W length
  /// @param source  W / (length^3 sr), replaced
  /// @param onTheWay  W, that rays round periodic axes still carry; it is added to the right-hand side, evenly over the
  ///   box
  /// @param guess  W length, of all orders to come, in the place of the cells' solution; null: that
  Powers ScatterOrder(const Buffer<float>& path, const Buffer<float>& fluence, const Buffer<float>& source,
    double onTheWay = 0.0, const Buffer<float>* guess = nullptr);

private:
  struct Sums
  {
    double first = 0.0, second = 0.0; ///< what a kernel says of its tally
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
  std::vector<double> Borders; ///< as CoarseMatrix has them
};
}
