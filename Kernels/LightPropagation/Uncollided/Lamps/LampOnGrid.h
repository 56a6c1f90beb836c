#pragma once

#include "Device/Device.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "LightPropagation/Uncollided/Lamps/LampPoints.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <vector>

namespace tyndall
{
/// Factors that convert fractions of the traced power (LampShares, LampSums) to fractions of the lamp's power, with
/// corrections that make the energy balance exact.
struct LampFactors
{
  /// Factors for the power that enters, for the power that the medium removes, and for the power that escapes or is in
  /// transit.
  double in, taken, out;
};

/// Energy balance of a lamp's beams, as fractions of the traced power (LampOnGrid::Share).
struct LampShares
{
  std::array<double, 6> in = {}, out = {}; ///< power that enters, and that escapes, by face
  double onTheWay = 0.0;                   ///< power in transit along a periodic axis
  double shone = 0.0;                      ///< power emitted into the directions that were traced

  double In() const { return std::accumulate(this->in.begin(), this->in.end(), 0.0); }
  double Out() const { return std::accumulate(this->out.begin(), this->out.end(), this->onTheWay); }

  /// Adds the tallies (powers as fractions of the traced power) of one row of beams.
  /// @param sums  tallies of the row, [LampRowSums]
  void Count(const BeamRow& row, const float* sums)
  {
    // Entered power is counted by marching direction, not by face, since light of a lamp inside the box enters through
    // no face.
    this->in[2 * row.axis + row.up] += sums[0];
    for (int face = 0; face < 6; ++face)
    {
      this->out[face] += sums[1 + face];
    }
    this->onTheWay += sums[7];
    // For a rectangle, only rows of its smallest parts are counted: together they make up the larger parts, whose power
    // would be counted again.
    this->shone += row.skipped > 0 || row.partFrom > 0.0f ? 0.0 : sums[8];
  }

  void Add(const LampShares& other)
  {
    for (std::size_t face = 0; face < 6; ++face)
    {
      this->in[face] += other.in[face];
      this->out[face] += other.out[face];
    }
    this->onTheWay += other.onTheWay;
    this->shone += other.shone;
  }

  /// Sum of the energy balances of all ranks. Collective.
  LampShares SumOver(const Domain& domain) const
  {
    std::vector<double> values = { this->shone, this->onTheWay };
    values.insert(values.end(), this->in.begin(), this->in.end());
    values.insert(values.end(), this->out.begin(), this->out.end());
    values = domain.Sum(values);
    LampShares sum;
    sum.shone = values[0];
    sum.onTheWay = values[1];
    std::copy_n(values.begin() + 2, 6, sum.in.begin());
    std::copy_n(values.begin() + 8, 6, sum.out.begin());
    return sum;
  }

  /// Converts the energy balance to power, W.
  /// @param power  power of the lamp, W, by channel; `channels` of these are used
  SweepTally Times(const Rgb& power, int channels, const LampFactors& factors) const
  {
    SweepTally tally;
    for (int c = 0; c < channels; ++c)
    {
      for (int face = 0; face < 6; ++face)
      {
        tally.in[face][c] = power[c] * factors.in * this->in[face];
        tally.out[face][c] = power[c] * factors.out * this->out[face];
      }
      tally.onTheWay[c] = power[c] * factors.out * this->onTheWay;
    }
    return tally;
  }
};
/// A point, spot or rectangle lamp inside or outside a grid, prepared for the kernels that trace its beams
/// (numerics.md, sections 5.3 to 5.5).
class LampOnGrid
{
public:
  /// Maximum number of layers of voxels that the beams of one launch cross in total, so that a launch takes less than a
  /// tenth of a second.
  static constexpr double LayersPerLaunch = 4e6;

  /// @param grid  the whole grid; must outlive this object
  LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);

  const Light& TheLight() const { return this->Lamp; }

  /// Points that represent the lamp in a pass (a range of layers in which beams are traced): several for a rectangle
  /// in the first pass, else one.
  const std::vector<LampPoint>& PointsOf(const Pass& pass) const
  {
    return pass.begin == 0 ? this->Points : this->Centre;
  }

  /// Beams of a pass (a range of layers in which beams are traced), as rows, from a batch of the points that represent
  /// the lamp.
  /// @param factor  multiplies the power of the beams
  /// @param first  index of the batch's first point
  /// @param next  set to the index of the next batch's first point
  std::vector<BeamRow> Rows(const Pass& pass, double factor, std::size_t first, std::size_t& next) const;

  /// Factors that normalise the energy balance of the lamp's beams. If the traced power or the power that enters the
  /// box is known exactly, the factors enforce the exact value. The traced power is known for a lamp inside the box,
  /// and for a cone within the solid angle of the box.
  /// @param taken  fraction of the traced power that the medium removes, used for a rectangle
  /// @param even  fraction of the traced power that is to be distributed uniformly over the box
  LampFactors Factors(const LampShares& shares, double taken, double even) const;

  /// Upper bound, in (0, 1], of the fraction of the lamp's power that reaches the box. Deposits are summed as fractions
  /// of this share of the power, and so keep their precision however far away the lamp is.
  double Share() const;

  /// Arguments of the kernels that describe the lamp and the box.
  /// @param stored  voxels that the arrays cover
  /// @param followed  voxels of `stored` in which beams are traced
  LampInfo Describe(const VoxelBox& stored, const VoxelBox& followed) const;

  /// Number of additional sums per voxel for the deposit that a rectangle would have in vacuum (numerics.md, Eq.
  /// (34a)); 0 for other lamps.
  int SumsOfVacuum() const;
  RectangleInfo DescribeRectangle(const VoxelBox& own) const;

  /// Fixed-point units per unit of the path integral, which is a fraction of the traced power times length
  /// (numerics.md, Eq. (36)).
  double UnitsPerLength() const;
  double Diagonal() const; ///< diagonal of a voxel, in units of length

  /// Compiles a kernel with the options of LampBeams.cl.
  /// @param source  source of LampBeams.cl, or of a file with the same options
  /// @param inBlock  option IN_BLOCK of LampBeams.cl
  cl::Kernel Kernel(
    Device& device, const char* name, std::string_view source, const Deposit& deposit, bool inBlock = false) const;
  static bool HasAtomics(Device& device) { return device.HasExtension("cl_khr_int64_base_atomics"); }

private:
  void CountImages();
  bool FollowsAll() const;

  Light Lamp;
  const Grid& TheGrid;
  std::array<bool, 3> Periodic;
  /// Number of periodic images of a rectangle, on either side along each axis, whose light in vacuum is integrated
  /// analytically.
  std::array<int, 3> Images = {};
  double Entering = 0.0; ///< fraction of the lamp's power that enters the box; 0: unknown
  std::vector<LampPoint> Points, Centre;
};

/// Fraction of the power of a point, spot or rectangle lamp that enters the box, in closed form (numerics.md, section
/// 5.3); 0 if it is unknown, i.e. for a spot that is not outside the box or whose cone is too narrow for double
/// precision, and for a rectangle that is too far away.
double EnteringFraction(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);
}
