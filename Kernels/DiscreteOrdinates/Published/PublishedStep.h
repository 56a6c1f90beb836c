#pragma once

#include "Device/Buffer.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>

namespace tyndall
{
/// Carries the radiance of all directions on by one explicit step.
class OrdinateStep
{
public:
  virtual ~OrdinateStep() = default;

  /// @param radiance  becomes scratch
  /// @param scattered, steady  sources, W / (length^3 sr)
  virtual void Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t, const Buffer<float>& after) = 0;
  /// W through each face.
  virtual FacePowers Powers(const Buffer<float>& radiance) const = 0;
  /// Adds what leaves through each cell of the faces, where they give back light.
  virtual void LeaveByCells(const Buffer<float>& radiance) = 0;
};

/// What lies at the faces of a box that is stepped.
struct SteppedFaces
{
  /// Of a box that is the whole grid. Must stay: `reflecting`.
  static SteppedFaces Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting);

  Grid whole;                               ///< of which the box is a part
  VoxelBox known;                           ///< voxels whose radiance is known, seen from the first own one
  std::array<bool, 3> periodic = {};        ///< axes: light that leaves comes in on the other side
  int outside = 0;                          ///< bits of the faces -x, +x, ... +z beyond which there are no voxels
  int counted = 0;                          ///< of those whose power is counted
  const LightOfCells* reflecting = nullptr; ///< null: no face gives back light
};

/// One explicit step along every direction, as long as the shortest edge of a voxel (Gong et al., Eqs. (7) and (9)).
/// The paper leaves open how a grid is read between its voxels; here linearly, as its textures are. Where sigma_t times
/// the step is above 1, radiance becomes negative; above 2 it grows without end (numerics.md, Eq. (D13)).
class PublishedStep : public OrdinateStep
{
public:
  /// @param grid  of the own voxels
  PublishedStep(Device& device, const Grid& grid, const OrdinateGroups& groups, const IncomingRadiance& incoming,
    const SteppedFaces& at);

  void Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t, const Buffer<float>& after) override;
  FacePowers Powers(const Buffer<float>& radiance) const override;
  void LeaveByCells(const Buffer<float>& radiance) override;

  // Its parts, for those who have radiance from elsewhere between them: what changes in each voxel, and what goes from
  // voxel to voxel, `before` being that of the known ones.
  void Change(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t) const;
  void MoveOn(const Buffer<float>& before, const Buffer<float>& after) const;

private:
  cl::Kernel Kernel(const char* name) const;

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  const SteppedFaces At;
  double Step;
  std::array<double, 6> Entering = {};
  Buffer<float> Parts, Incoming, Across;
  Buffer<cl_int> Up;
};
}
