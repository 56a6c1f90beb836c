#include "LightPropagation/Uncollided/LampBeams.h"

#include "Device/Defines.h"
#include "LightPropagation/Uncollided/LampBeamsShared.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int PointsPerEdge = 4;    ///< of a rectangle
constexpr double BeamWidth = 0.5;   ///< of a lamp's beams where they leave the box, voxels; a rectangle's: twice
constexpr int BeamsAcrossCone = 16; ///< of a spot, at least
constexpr int RowsPerLaunch = 256;  ///< keeps a launch well below a tenth of a second for rows of a thousand voxels
constexpr int RoundsAtMost = 64;    ///< of a ray on a periodic axis

/// Smallest and largest tangent (voxels along `aside` per layer) at which the box is seen from `position` between two
/// depths, within the pyramid.
std::array<double, 2> Tangents(const Grid& grid, const glm::dvec3& position, int aside, double near, double far)
{
  const double low = -position[aside];
  const double high = grid.size[aside] - position[aside];
  const double depth = std::max(near, 1e-9);
  return { std::max(-1.0, std::min(low / depth, low / far)), std::min(1.0, std::max(high / depth, high / far)) };
}

/// Tangents (voxels along `aside` per layer) between which a spot's cone is seen in the pyramid along `axis`. The
/// planes that touch the cone and hold the third axis are turned by asin(sin(half angle) / R) from its middle, R the
/// length of that in the plane of the two axes. The first is larger than the second where the cone is not seen there.
std::array<double, 2> TangentsOfCone(const Grid& grid, int axis, bool up, int aside, const Light& light)
{
  constexpr double rightAngle = 0.5 * Pi;
  constexpr double margin = 1e-6; // rounding must not cut the cone
  const glm::dvec3 middle = glm::normalize(Vector(light.direction));
  const double forward = up ? middle[axis] : -middle[axis];
  const double half = 0.5 * light.angle * Pi / 180.0;
  const double inPlane = std::hypot(forward, middle[aside]);
  if (half >= rightAngle || std::sin(half) >= inPlane)
  {
    return { -1.0, 1.0 };
  }
  const double turn = std::atan2(middle[aside], forward);
  const double reach = std::asin(std::sin(half) / inPlane) + margin;
  if (turn - reach >= rightAngle || turn + reach <= -rightAngle)
  {
    return { 1.0, -1.0 };
  }
  const auto tangent = [&](double angle) {
    return std::abs(angle) >= rightAngle ? std::copysign(1.0, angle)
                                         : std::tan(angle) * grid.spacing[axis] / grid.spacing[aside];
  };
  const double low = tangent(turn - reach), high = tangent(turn + reach);
  const double aroundIt = 0.01 * (high - low); // beams' edges do not fall on the cone's
  return { std::max(low - aroundIt, -1.0), std::min(high + aroundIt, 1.0) };
}

/// The beams of `light` from `position` (in voxels), row by row; a beam is at most `width` voxels wide where it leaves
/// the box.
std::vector<BeamRow> Beams(const Grid& grid, const Light& light, const glm::dvec3& position, double width)
{
  std::vector<BeamRow> rows;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const bool up = face % 2 == 1;
    const double near = std::max(0.0, up ? -position[axis] : position[axis] - grid.size[axis]);
    const double far = up ? grid.size[axis] - position[axis] : position[axis];
    if (far <= 0.0)
    {
      continue;
    }
    std::array<double, 2> u = Tangents(grid, position, (axis + 1) % 3, near, far);
    std::array<double, 2> v = Tangents(grid, position, (axis + 2) % 3, near, far);
    int fewest = 1;
    if (light.type == LightType::Spot)
    {
      const std::array<double, 2> coneU = TangentsOfCone(grid, axis, up, (axis + 1) % 3, light);
      const std::array<double, 2> coneV = TangentsOfCone(grid, axis, up, (axis + 2) % 3, light);
      u = { std::max(u[0], coneU[0]), std::min(u[1], coneU[1]) };
      v = { std::max(v[0], coneV[0]), std::min(v[1], coneV[1]) };
      fewest = BeamsAcrossCone;
    }
    if (u[0] >= u[1] || v[0] >= v[1])
    {
      continue;
    }
    const auto parts = [=](double tangents) { return static_cast<int>(std::ceil(tangents * far / width - 1e-6)); };
    const int countU = std::max({ fewest, 1, parts(u[1] - u[0]) }); // rounding must not decide on one more
    const int countV = std::max({ fewest, 1, parts(v[1] - v[0]) });
    for (int j = 0; j < countV; ++j)
    {
      const double widthU = (u[1] - u[0]) / countU;
      const double widthV = (v[1] - v[0]) / countV;
      rows.push_back({ axis, up, static_cast<float>(u[0] + 0.5 * widthU), static_cast<float>(v[0] + (j + 0.5) * widthV),
        static_cast<float>(widthU), static_cast<float>(widthV), countU, static_cast<float>(near) });
    }
  }
  return rows;
}

bool IsInside(const Grid& grid, const glm::dvec3& position)
{
  bool inside = true;
  for (int a = 0; a < 3; ++a)
  {
    inside = inside && position[a] >= 0.0 && position[a] <= grid.size[a];
  }
  return inside;
}

/// Points that stand for the light: one, or the centres of a rectangle's parts.
std::vector<glm::dvec3> Points(const Light& light)
{
  if (light.type != LightType::Rectangle)
  {
    return { Vector(light.position) };
  }
  const std::array<std::array<double, 3>, 2> edges = RectangleEdges(light);
  std::vector<glm::dvec3> points;
  for (int j = 0; j < PointsPerEdge; ++j)
  {
    for (int i = 0; i < PointsPerEdge; ++i)
    {
      points.push_back(Vector(light.position) + Vector(edges[0]) * ((i + 0.5) / PointsPerEdge - 0.5) +
        Vector(edges[1]) * ((j + 0.5) / PointsPerEdge - 0.5));
    }
  }
  return points;
}

/// The beams of one lamp, from all points that stand for it.
class LampBeams
{
public:
  LampBeams(Device& device, const SweepVolume& volume, const Light& light, const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , Volume(volume)
    , TheLight(light)
    , Periodic(periodic)
    , Cells(device, volume.deposit.faceOut ? BoxFaceCellCount(volume.grid) : 1, "the light of a lamp")
    , Path(device, (1 + (volume.deposit.firstMoments ? 3 : 0) + (volume.deposit.flux ? 3 : 0)) * volume.stride,
        "the light of a lamp")
  {
    this->Path.Fill(0);
    this->Cells.Fill(0);
  }

  SweepTally Run(const Monitor& monitor)
  {
    const std::vector<glm::dvec3> points = Points(this->TheLight);
    for (std::size_t p = 0; p < points.size(); ++p)
    {
      this->Follow(points[p], 1.0 / points.size(), [&](double done) { Report(monitor, (p + done) / points.size()); });
    }
    cl::Kernel add = this->Kernel("add_fixed");
    // All directions of a lamp inside the box were followed: so it is known what beams on the cone's border missed.
    const double correction = this->AllInside && this->Shone > 0.0 ? 1.0 / this->Shone : 1.0;
    cl_float4 units = {};
    for (int c = 0; c < 3; ++c)
    {
      units.s[c] = static_cast<float>(this->TheLight.power[c] * correction / this->Scale());
    }
    const auto finish = [&](cl::Kernel& kernel, const Buffer<float>& sum) {
      With(kernel, this->Path, sum, cl_ulong(this->Volume.first), cl_ulong(this->Volume.stride), units,
        *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), static_cast<float>(this->Diagonal()));
      const cl::NDRange voxels(this->Volume.stride, this->Volume.channels);
      this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, voxels, cl::NullRange);
    };
    finish(add, *this->Volume.deposit.path);
    if (this->Volume.deposit.firstMoments)
    {
      cl::Kernel addMoments = this->Kernel("add_fixed_moments");
      finish(addMoments, *this->Volume.deposit.firstMoments);
    }
    if (this->Volume.deposit.flux)
    {
      cl::Kernel addFlux = this->Kernel("add_fixed_flux");
      finish(addFlux, *this->Volume.deposit.flux);
    }
    if (this->Volume.deposit.faceOut)
    {
      this->AddCells(correction);
    }
    return this->TallyTimes(correction);
  }

private:
  void AddCells(double factor)
  {
    cl_float4 watts = {};
    for (int c = 0; c < 3; ++c)
    {
      watts.s[c] = static_cast<float>(this->TheLight.power[c] * factor);
    }
    const std::size_t cells = BoxFaceCellCount(this->Volume.grid);
    cl::Kernel add = this->Kernel("add_fixed_cells");
    With(add, this->Cells, *this->Volume.deposit.faceOut, cl_ulong(this->Volume.faceFirst), cl_ulong(cells), watts);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      add, cl::NullRange, cl::NDRange(cells, this->Volume.channels), cl::NullRange);
    this->TheDevice.Finish(); // the cells go
  }

  bool HasAtomics() const { return this->TheDevice.HasExtension("cl_khr_int64_base_atomics"); }

  cl::Kernel Kernel(const char* name)
  {
    return this->TheDevice.Kernel(name, kernel_source::LampBeams,
      Define("ATOMICS", this->HasAtomics()) + Define("LAMBERT", this->TheLight.type == LightType::Rectangle) +
        Define("CONE", this->TheLight.type == LightType::Spot) +
        Define("MOMENTS", this->Volume.deposit.firstMoments != nullptr) +
        Define("NET_FLUX", this->Volume.deposit.flux != nullptr) +
        Define("FACE_OUT", this->Volume.deposit.faceOut != nullptr) + DefineFloat("THIN", ThinForFirstMoments));
  }

  /// Fixed point units per length (numerics.md, Eq. (36)): no voxel can gather more than all power along its diagonal,
  /// once a round.
  double Scale() const { return std::exp2(std::floor(std::log2(0x1p60 / (this->Diagonal() * RoundsAtMost)))); }

  double Diagonal() const
  {
    const std::array<double, 3>& h = this->Volume.grid.spacing;
    return std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
  }

  LampInfo Describe(const glm::dvec3& position, double part) const
  {
    LampInfo info = {};
    const Grid& grid = this->Volume.grid;
    const glm::dvec3 direction = this->TheLight.type == LightType::Point
      ? glm::dvec3(0.0, 0.0, 1.0)
      : glm::normalize(Vector(this->TheLight.direction));
    for (int a = 0; a < 3; ++a)
    {
      info.size[a] = grid.size[a];
      info.periodic[a] = this->Periodic[a];
      info.spacing[a] = static_cast<float>(grid.spacing[a]);
      info.position[a] = static_cast<float>(position[a]);
      info.direction[a] = static_cast<float>(direction[a]);
    }
    info.intensity = static_cast<float>(AxialIntensity(this->TheLight) * part);
    info.cosine = static_cast<float>(std::cos(0.5 * this->TheLight.angle * Pi / 180.0));
    info.scale = static_cast<float>(this->Scale());
    info.diagonal = static_cast<float>(this->Diagonal());
    info.rounds = RoundsAtMost;
    for (int face = 0; face < 6; ++face)
    {
      const BoxFaceLayout layout = LayoutOfFace(grid, face);
      info.faceFirst[face] = static_cast<cl_int>(layout.first);
      std::copy(layout.step.begin(), layout.step.end(), info.faceStep[face / 2]);
    }
    return info;
  }

  void Follow(const glm::dvec3& point, double part, const std::function<void(double)>& report)
  {
    const Grid& grid = this->Volume.grid;
    glm::dvec3 position;
    for (int a = 0; a < 3; ++a)
    {
      position[a] = (point[a] - grid.origin[a]) / grid.spacing[a];
    }
    const bool many = this->TheLight.type == LightType::Rectangle;
    this->AllInside = this->AllInside && IsInside(grid, position);
    const std::vector<BeamRow> rows = Beams(grid, this->TheLight, position, many ? 2.0 * BeamWidth : BeamWidth);
    if (rows.empty())
    {
      return;
    }
    const Buffer<BeamRow> rowBuffer(this->TheDevice, rows, "the beams of a lamp");
    Buffer<float> sums(this->TheDevice, rows.size() * LampRowSums, "sums");
    cl::Kernel kernel = this->Kernel("follow_lamp");
    const LampInfo info = this->Describe(position, part);
    for (std::size_t first = 0; first < rows.size(); first += RowsPerLaunch)
    {
      const std::size_t count = std::min<std::size_t>(RowsPerLaunch, rows.size() - first);
      With(kernel, info, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), this->Path,
        cl_ulong(this->Volume.stride), this->Cells, rowBuffer, cl_int(count), cl_int(first), sums);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        kernel, cl::NullRange, cl::NDRange(this->HasAtomics() ? count : 1), cl::NDRange(1));
      this->TheDevice.Finish();
      report(static_cast<double>(first + count) / rows.size());
    }
    this->Count(rows, sums.Read());
  }

  void Count(const std::vector<BeamRow>& rows, const std::vector<float>& sums)
  {
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      const float* row = sums.data() + r * LampRowSums;
      this->In[2 * rows[r].axis + rows[r].up] += row[0]; // by the way it shines: lamps inside pass no face
      for (int face = 0; face < 6; ++face)
      {
        this->Out[face] += row[1 + face];
      }
      this->OnTheWay += row[7];
      this->Shone += row[8];
    }
  }

  SweepTally TallyTimes(double factor) const
  {
    SweepTally tally;
    for (int c = 0; c < this->Volume.channels; ++c)
    {
      const double power = this->TheLight.power[c] * factor;
      for (int face = 0; face < 6; ++face)
      {
        tally.in[face][c] = power * this->In[face];
        tally.out[face][c] = power * this->Out[face];
      }
      tally.onTheWay[c] = power * this->OnTheWay;
    }
    return tally;
  }

  Device& TheDevice;
  const SweepVolume& Volume;
  const Light& TheLight;
  std::array<bool, 3> Periodic;
  Buffer<cl_long> Cells, Path;
  std::array<double, 6> In = {}, Out = {}; ///< by face; these and the next are parts of the power
  double OnTheWay = 0.0;
  double Shone = 0.0; ///< in the directions that were followed
  bool AllInside = true;
};
}

SweepTally DepositLamp(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor)
{
  return LampBeams(device, volume, light, periodic).Run(monitor);
}
}
