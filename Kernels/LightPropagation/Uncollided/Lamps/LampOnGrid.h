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
/// A point source that represents a lamp, or a part of it.
struct LampPoint
{
  struct Sphere ///< in lengths from the grid's corner
  {
    glm::dvec3 middle = glm::dvec3(0.0);
    double radius = 0.0;
  };

  glm::dvec3 place;   ///< position, voxels from the grid's corner
  double share = 1.0; ///< fraction of the lamp's power

  /// The point illuminates voxels outside the first sphere and inside the second, beyond which the larger part of the
  /// lamp that was divided into this one takes over.
  Sphere part, whole = { glm::dvec3(0.0), std::numeric_limits<double>::infinity() };
  double reach = std::numeric_limits<double>::infinity(); ///< length to which its beams are traced
};

/// A point, spot or rectangle lamp inside or outside a grid, prepared for the kernels that trace its beams
/// (numerics.md, sections 5.4 and 5.5).
class LampOnGrid
{
public:
  /// Layers that all beams of a launch cross together; keeps it below a tenth of a second.
  static constexpr double LayersPerLaunch = 4e6;

  /// @param grid  the whole grid; must outlive this object
  LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);

  const Light& TheLight() const { return this->Lamp; }

  /// The points that represent the lamp in a pass: several for a rectangle in the first pass, else one.
  const std::vector<LampPoint>& PointsOf(const Pass& pass) const
  {
    return pass.begin == 0 ? this->Points : this->Centre;
  }

  /// The beams from a batch of the pass's points.
  /// @param factor  multiplies the power of the beams
  /// @param first  index of the batch's first point
  /// @param next  set to the index at which the next batch begins
  std::vector<BeamRow> Rows(const Pass& pass, double factor, std::size_t first, std::size_t& next) const;

  /// Factors that normalise the lamp's shares. If the power that is traced (a lamp inside the box, a cone that lies
  /// within the box's solid angle) or that enters the box is known exactly, the factors enforce it.
  /// @param taken  share that the medium removes, for a rectangle
  /// @param even  share that is to be spread uniformly
  LampFactors Factors(const LampShares& shares, double taken, double even) const;

  /// Upper bound, in (0, 1], of the fraction of the lamp's power that reaches the box. Sums are kept as fractions of
  /// this power, so that they retain their precision however far away the lamp is.
  double Share() const;

  /// @param stored  voxels that the arrays cover
  /// @param followed  voxels, among these, in which beams are traced
  LampInfo Describe(const VoxelBox& stored, const VoxelBox& followed) const;

  /// Number of additional sums per voxel for the correction in vacuum; 0 unless the lamp is a rectangle.
  int SumsOfVacuum() const;
  RectangleInfo DescribeRectangle(const VoxelBox& own) const;

  /// Fixed-point units per length (numerics.md, Eq. (36)).
  double UnitsPerLength() const;
  double Diagonal() const; ///< diagonal of a voxel, length

  /// @param source  of LampBeams.cl, or of a file that uses the same options
  cl::Kernel Kernel(Device& device, const char* name, std::string_view source, const Deposit& deposit) const;
  static bool HasAtomics(Device& device) { return device.HasExtension("cl_khr_int64_base_atomics"); }

private:
  void DivideRectangle();
  bool FollowsAll() const;

  Light Lamp;
  const Grid& TheGrid;
  std::array<bool, 3> Periodic;
  /// Periodic images to either side of a rectangle whose light is exact in vacuum, by axis.
  std::array<int, 3> Images = {};
  double Entering = 0.0; ///< fraction of the power that enters the box; 0: unknown
  std::vector<LampPoint> Points, Centre;
};
}
