#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Angular moments of the path integrals of a block, and the copy with ghost cells that the diffusion systems read. The
/// copy has degrees 0 and 1 only, and is 0 in ghost cells.
class MomentsWithGhosts
{
public:
  /// @param block  must outlive this
  /// @param functions  number of angular moments of the block, the same on all ranks; 1: isotropic
  MomentsWithGhosts(const BlockWithGhosts& block, int functions);

  bool Any() const { return this->Own.functions > 1; }
  /// Layout of the moments in arrays with ghost cells.
  const MomentPlaces& Places() const { return this->Held; }

  /// Allocates the array with ghost cells if the block has any; otherwise the systems read the array of the block.
  /// Collective, as are all methods that write.
  void Allocate(Device& device, const char* what);
  const Buffer<float>& Values(const Buffer<float>& own) const { return this->Array.Size() > 0 ? this->Array : own; }
  /// Copies the moments of the block to the array with ghost cells, and sets ghost cells to 0.
  void Spread(const Buffer<float>& own);
  /// Copies the moments of degree 1 back to the array of the block.
  void TakeFirstDegree(Buffer<float>& own) const;

  /// One channel of `values` in the layout of DiffusionSystem::State. Ghost cells have degree 0 only; their other
  /// moments are 0.
  /// @param values  of the block, in the layout of path integrals
  /// @param fluence  degree 0 with ghost cells, in the same unit
  std::vector<double> StateOf(int channel, const std::vector<float>& values, std::vector<double> fluence) const;

private:
  static int FunctionAlong(int axis) { return axis == 0 ? 3 : axis; } ///< AngularBasis orders degree 1 as y, z, x

  const BlockWithGhosts& Block;
  MomentPlaces Own, Held;
  Buffer<float> Array; ///< empty: the block has no ghost cells
};
}
