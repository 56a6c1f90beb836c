#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Path integrals of a block with their angular moments, and what the diffusion systems of the block with ghosts know
/// of these: those of degrees 0 and 1 of the block's own voxels.
class MomentsWithGhosts
{
public:
  /// @param block  must stay
  /// @param functions  of the block's angular moments, the same on all ranks; 1: all is isotropic
  MomentsWithGhosts(const BlockWithGhosts& block, int functions);

  bool Any() const { return this->Own.functions > 1; }
  /// Where moments are in arrays with ghosts.
  const MomentPlaces& Places() const { return this->Held; }

  /// Makes the array with ghosts, where the block has any: else the systems read the block's own. Collective, as all.
  void Allocate(Device& device, const char* what);
  const Buffer<float>& Values(const Buffer<float>& own) const { return this->Array.Size() > 0 ? this->Array : own; }
  /// Writes what the block has to the array with ghosts, which are dark.
  void Spread(const Buffer<float>& own);
  /// The moments of degree 1 the other way.
  void TakeFirstDegree(Buffer<float>& own) const;

  /// Of values as path integrals have them those of a channel as DiffusionSystem::State has them, in ghosts 0 but for
  /// degree 0.
  /// @param values  of the block
  /// @param fluence  degree 0 with ghosts, the same unit
  std::vector<double> StateOf(int channel, const std::vector<float>& values, std::vector<double> fluence) const;

private:
  static int FunctionAlong(int axis) { return axis == 0 ? 3 : axis; } ///< y, z, x, as AngularBasis has them

  const BlockWithGhosts& Block;
  MomentPlaces Own, Held;
  Buffer<float> Array; ///< empty: there are no ghosts
};
}
