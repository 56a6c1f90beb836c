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
#include <limits>
#include <string_view>
#include <vector>

namespace tyndall
{
/// A point that stands for a lamp, or for a part of it.
struct LampPoint
{
  struct Sphere ///< lengths from the grid's corner
  {
    glm::dvec3 middle = glm::dvec3(0.0);
    double radius = 0.0;
  };

  glm::dvec3 place;   ///< voxels from the grid's corner
  double share = 1.0; ///< of the lamp's power

  /// Voxels outside the first have its light, but for those outside the second, that of the part which was halved.
  Sphere part, whole = { glm::dvec3(0.0), std::numeric_limits<double>::infinity() };
  double reach = std::numeric_limits<double>::infinity(); ///< how far its beams go
};

/// A point, spot or rectangle lamp beside or in a grid, as the kernels of its beams see it (numerics.md, sections 5.4
/// and 5.5).
class LampOnGrid
{
public:
  static constexpr double LayersPerLaunch = 4e6; ///< of beams that go far, for less than a tenth of a second

  /// @param grid  the whole; must stay
  LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);

  const Light& TheLight() const { return this->Lamp; }

  /// What stands for the lamp in a pass: a point, or those of a rectangle's parts; in later passes a rectangle is a
  /// point.
  const std::vector<LampPoint>& PointsOf(const Pass& pass) const
  {
    return pass.begin == 0 ? this->Points : this->Centre;
  }

  /// The beams from some of its points.
  /// @param factor  of the power
  /// @param first  of these points; next: where the following call goes on, for beams are many
  std::vector<BeamRow> Rows(const Pass& pass, double factor, std::size_t first, std::size_t& next) const;

  /// Where it is known which part of the lamp's power is followed (all light of a lamp in the box and of a cone that
  /// leads into it) or enters, the factors make it that.
  /// @param taken  share that the medium takes, of a rectangle
  /// @param even  share that is to be spread evenly
  LampFactors Factors(const LampShares& shares, double taken, double even) const;

  /// Of the lamp's power, at least what comes to the box: what is counted in parts of it keeps its digits however far
  /// away the lamp is.
  double Share() const;

  /// @param stored  the voxels that arrays hold; and of them those in which beams are followed
  LampInfo Describe(const VoxelBox& stored, const VoxelBox& followed) const;

  /// Sums that a voxel has beside the others, of a rectangle.
  int SumsOfVacuum() const;
  RectangleInfo DescribeRectangle(const VoxelBox& own) const;

  /// Fixed point units per length (numerics.md, Eq. (36)).
  double UnitsPerLength() const;
  double Diagonal() const; ///< of a voxel

  /// @param source  of LampBeams.cl, or of what includes it
  cl::Kernel Kernel(Device& device, const char* name, std::string_view source, const Deposit& deposit) const;
  static bool HasAtomics(Device& device) { return device.HasExtension("cl_khr_int64_base_atomics"); }

private:
  void DivideRectangle();
  bool FollowsAll() const;

  Light Lamp;
  const Grid& TheGrid;
  std::array<bool, 3> Periodic;
  std::array<int, 3> Images = {}; ///< of a rectangle, beside it along a periodic axis, whose light is exact in vacuum
  double Entering = 0.0;          ///< part of the power that enters the box; 0 where it is not known
  std::vector<LampPoint> Points, Centre;
};
}
