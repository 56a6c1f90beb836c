#pragma once

#include "Device/Device.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "LightPropagation/Uncollided/Lamps/LampShares.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <glm/vec3.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace tyndall
{
/// A point, spot or rectangle lamp beside or in a grid, as the kernels of its beams see it (numerics.md, sections 5.4
/// and 5.5).
class LampOnGrid
{
public:
  static constexpr double LayersPerLaunch = 4e6; ///< of beams that go far, for less than a tenth of a second

  /// @param grid  the whole; must stay, as the light
  LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);

  const Light& TheLight() const { return this->Lamp; }

  /// What stands for the lamp: a point, or the middles of a rectangle's parts; voxels from the grid's corner.
  std::vector<glm::dvec3> Points() const;
  glm::dvec3 Middle() const;                                ///< the same, of the lamp's position
  std::vector<glm::dvec3> PointsOf(const Pass& pass) const; ///< from far a rectangle is a point
  bool IsInside(const glm::dvec3& point) const;             ///< the end of a periodic axis is inside, a face is not

  /// The beams from one of its points.
  std::vector<BeamRow> Rows(const glm::dvec3& point, const Pass& pass) const;

  /// By what the found shares are multiplied to be parts of the lamp's power: where it is known which part of it is
  /// followed (all light of a lamp in the box and of a cone that leads into it) or enters (a point outside), that part.
  double Correction(const LampShares& shares) const;

  /// Of the lamp's power, at least what comes to the box: what is counted in parts of it keeps its digits however far
  /// away the lamp is.
  double Share() const;

  /// @param part  of the lamp's power that the point has
  /// @param stored  the voxels that arrays hold; and of them those in which beams are followed
  LampInfo Describe(double part, const VoxelBox& stored, const VoxelBox& followed) const;

  /// Fixed point units per length (numerics.md, Eq. (36)).
  double UnitsPerLength() const;
  double Diagonal() const; ///< of a voxel

  /// @param source  of LampBeams.cl, or of what includes it
  cl::Kernel Kernel(Device& device, const char* name, std::string_view source, const Deposit& deposit) const;
  static bool HasAtomics(Device& device) { return device.HasExtension("cl_khr_int64_base_atomics"); }

private:
  bool FollowsAll(const glm::dvec3& point) const;
  double EnteringPart() const;
  glm::dvec3 PlaceOf(const glm::dvec3& point) const;

  const Light& Lamp;
  const Grid& TheGrid;
  std::array<bool, 3> Periodic;
};
}
