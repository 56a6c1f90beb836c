#pragma once

#include "Device/Buffer.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// One explicit step along every direction, as long as the shortest edge of a voxel (Gong et al., Eqs. (7) and (9)).
/// The paper leaves open how a grid is read between its voxels; here linearly, as its textures are. Where sigma_t times
/// the step is above 1, radiance becomes negative; above 2 it grows without end (numerics.md, Eq. (D13)).
class PublishedStep
{
public:
  /// @param reflecting  where what leaves is added to by cell, and what is given back comes from; null: no face gives
  /// back light
  PublishedStep(Device& device, const Grid& grid, const OrdinateGroups& groups, const std::array<bool, 3>& periodic,
    const IncomingRadiance& incoming, const FaceLight* reflecting);

  double Length() const { return this->Step; }
  /// @param radiance  becomes scratch
  /// @param scattered, steady  sources, W / (length^3 sr)
  void Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t, const Buffer<float>& after) const;
  /// W through each face.
  FacePowers Powers(const Buffer<float>& radiance) const;
  /// Adds what leaves through each cell of the faces, where they give back light.
  void LeaveByCells(const Buffer<float>& radiance) const;

private:
  cl::Kernel Kernel(const char* name) const;

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  std::array<bool, 3> Periodic;
  double Step;
  std::array<double, 6> Entering = {};
  const FaceLight* Reflecting;
  Buffer<float> Parts, Incoming, Across;
  Buffer<cl_int> Up;
};
}
