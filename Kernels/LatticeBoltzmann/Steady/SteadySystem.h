#pragma once

#include "Device/Monitor.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// What the equations of a steady lattice are made of (numerics.md, Eqs. (L8), (L11)), of one channel in one memory or
/// over ranks. Values are by the voxels of the lattice.
class SteadySystem
{
public:
  using Values = std::vector<double>;

  virtual ~SteadySystem() = default;

  /// Carries light along all lines of links, where collisions make `even` even, W / length^2.
  /// @param shines  1, or 0: nothing comes in through the faces
  /// @param writes  densities go to the lattice
  /// @return what arrives in each voxel, W / length^2
  virtual Values Sweep(const Values& even, double shines, bool writes, const Monitor& monitor) = 0;

  /// A^-1 of Eq. (L12), to about a tenth.
  /// @param unit  root mean square of all of `residual`, above 0
  virtual Values Diffuse(const Values& residual, double unit) = 0;

  /// What a rank does by itself: where it fails on one, it does on all, and none waits for that.
  virtual void Alone(const std::function<void()>& work) { work(); }

  /// Sums over ranks of what each has of them.
  virtual std::vector<double> Sum(const std::vector<double>& ofRank) { return ofRank; }
};
}
