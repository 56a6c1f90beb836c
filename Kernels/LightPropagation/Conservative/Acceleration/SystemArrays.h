#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/UncollidedLight.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"

#include <vector>

namespace tyndall
{
/// Angular moments of a block's path integrals, copied to an array with ghost cells that the diffusion systems read.
/// The copy has degrees 0 and 1 only, and is 0 in ghost cells.
class MomentsWithGhosts
{
public:
  /// @param block  must outlive this
  /// @param functions  number of angular moments of the block, the same on all ranks; 1: isotropic
  MomentsWithGhosts(const BlockWithGhosts& block, int functions);

  bool Any() const { return this->Own.functions > 1; }
  /// Layout of the moments in arrays with ghost cells.
  const MomentPlaces& Places() const { return this->Held; }

  /// Allocates the array with ghost cells, if the block has any; if not, the diffusion systems read the block's own
  /// array. Collective, as are Spread() and TakeFirstDegree().
  void Allocate(Device& device, const char* what);
  const Buffer<float>& Values(const Buffer<float>& own) const { return this->Array.Size() > 0 ? this->Array : own; }
  /// Copies the moments of the block to the array with ghost cells, and sets ghost cells to 0.
  void Spread(const Buffer<float>& own);
  /// Copies the moments of degree 1 back to the array of the block.
  void TakeFirstDegree(Buffer<float>& own) const;

  /// One channel of angular moments as a diffusion system holds them, with ghost cells: degree 0 by voxel, followed by
  /// degree 1, [x, y, z][voxel]. The moments of degree 1 are 0 in ghost cells.
  /// @param values  moments of the block, in the layout of path integrals
  /// @param fluence  moment of degree 0 with ghost cells, in the unit of `values`
  std::vector<double> StateOf(int channel, const std::vector<float>& values, std::vector<double> fluence) const;

private:
  /// Index of the function of degree 1 along an axis; AngularBasis orders them y, z, x.
  static int FunctionAlong(int axis) { return axis == 0 ? 3 : axis; }

  const BlockWithGhosts& Block;
  MomentPlaces Own, Held;
  Buffer<float> Array; ///< moments with ghost cells; empty if the block has no ghost cells
};

/// Arrays that sweeps and diffusion systems exchange (DiffusionSystem::Arrays): arrays of the block, which sweeps read
/// and write, and their copies with ghost cells, which the diffusion systems read and write. All functions are
/// collective, except for those that return a member.
class SystemArrays
{
public:
  /// @param parts  must outlive this
  explicit SystemArrays(TransportParts& parts);

  const BlockWithGhosts& Block() const { return this->TheBlock; }
  const GhostedMedium& Medium() const { return this->Coefficients; }
  const MomentsWithGhosts& Moments() const { return this->OfPath; }

  /// Sets Given(), the source that stays the same in all iterations: emission plus the first-collision source.
  /// @param uncollided  path integrals of uncollided light, W length; also copied to TransportParts::Path
  void Give(const std::vector<float>& uncollided);
  /// Emission plus first-collision source of the block, W / (length^3 sr).
  const Buffer<float>& Given() const { return this->TheGiven; }

  /// Partial currents of the sweep in the block: power that enters each voxel through each of its faces, W,
  /// [channel][-x, +x, -y, +y, -z, +z][voxel].
  Buffer<float>& PartialCurrents() { return this->TheCurrents; }
  /// Copies the path integrals and partial currents of the last sweep to the arrays with ghost cells.
  void TakeSwept();
  /// Runs `step` on the moments of the path integrals with ghost cells, and copies those of degree 1 back to
  /// TransportParts::Path.
  void ChangePath(const std::function<void(const Buffer<float>& path)>& step);
  /// Runs `step`, which changes the next source in the array with ghost cells, and copies it back to the block.
  void ChangeSource(const std::function<void()>& step);
  /// Copies the source of the next sweep to its array with ghost cells.
  void TakeSource() { this->SourceWithGhosts.FillOwn(); }

  /// Arrays with ghost cells that the diffusion system of a channel reads.
  /// @param faces  power by cell of the box's faces (FaceBalance::Rows); null: no face reflects, and power by cell is
  ///   not requested
  DiffusionSystem::Arrays OfChannel(int channel, const UncollidedLight& light, const Buffer<float>* faces) const;

private:
  TransportParts& Parts;
  const BlockWithGhosts TheBlock;
  const GhostedMedium Coefficients;
  MomentsWithGhosts OfPath;
  /// Arrays of the block without ghost cells: emission and first-collision source, W / (length^3 sr); net flux of this
  /// source divided by 4 pi, if there are angular moments; partial currents of the sweep, W.
  Buffer<float> TheGiven, GivenFlux, TheCurrents;
  GhostedBuffer GivenWithGhosts, GivenFluxWithGhosts, SourceWithGhosts, CurrentsWithGhosts;
};
}
