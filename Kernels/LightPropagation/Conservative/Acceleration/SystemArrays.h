#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/UncollidedLight.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"

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

/// The arrays that sweeps and diffusion systems exchange (DiffusionSystem::Arrays): those of the block, which sweeps
/// read and write, and their copies with ghost cells, which the systems do. All functions are collective, except for
/// those that return a member.
class SystemArrays
{
public:
  /// @param parts  must outlive this
  explicit SystemArrays(TransportParts& parts);

  const BlockWithGhosts& Block() const { return this->TheBlock; }
  const GhostedMedium& Medium() const { return this->Coefficients; }
  const MomentsWithGhosts& Moments() const { return this->OfPath; }

  /// Sets the given source to emission plus the first-collision source.
  /// @param uncollided  path of uncollided light, W length; the paths of `parts` become it
  void Give(const std::vector<float>& uncollided);
  const Buffer<float>& Given() const { return this->TheGiven; } ///< W / (length^3 sr), of the block

  /// Partial currents of the sweep, W, of the block.
  Buffer<float>& PartialCurrents() { return this->TheCurrents; }
  /// Takes the path integrals and partial currents of a sweep.
  void TakeSwept();
  /// Runs a step on the path's moments with ghost cells, and copies those of degree 1 back to the path.
  void ChangePath(const std::function<void(const Buffer<float>& path)>& step);
  /// Runs a step on the source of the next sweep, with ghost cells, and copies the source back.
  void ChangeSource(const std::function<void()>& step);
  void TakeSource() { this->SourceWithGhosts.FillOwn(); } ///< copies the sweep's source to the array with ghost cells

  /// @param faces  see DiffusionSystem::Arrays
  DiffusionSystem::Arrays OfChannel(int channel, const UncollidedLight& light, const Buffer<float>* faces) const;

private:
  TransportParts& Parts;
  const BlockWithGhosts TheBlock;
  const GhostedMedium Coefficients;
  MomentsWithGhosts OfPath;
  Buffer<float> TheGiven, GivenFlux, TheCurrents; ///< of the block, as in DiffusionSystem::Arrays
  GhostedBuffer GivenWithGhosts, GivenFluxWithGhosts, SourceWithGhosts, CurrentsWithGhosts;
};
}
