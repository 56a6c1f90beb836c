#include "LightPropagation/Uncollided/LampBeams.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "LightPropagation/Uncollided/LampPyramids.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
constexpr int PointsPerEdge = 4;        ///< of a rectangle
constexpr double BeamWidth = 0.5;       ///< of a lamp's beams where they leave the box, voxels; a rectangle's: twice
constexpr int RowsPerLaunch = 256;      ///< keeps a launch well below a tenth of a second for rows of a thousand voxels
constexpr int RoundsAtMost = 64;        ///< that all power may go through one voxel, in fixed point
constexpr double LayersPerLaunch = 4e6; ///< of beams that go round a periodic axis: the same
constexpr int PassesAtMost = 9;         ///< in all
constexpr int EvenFrom = 3;             ///< passes, after which the light of a box without faces is spread evenly
constexpr double LeftAtMost = 5e-4;     ///< of the power: then no further pass

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
    this->FollowAll(monitor);
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
    if (this->Even > 0.0)
    {
      this->SpreadEvenly(correction);
    }
    return this->TallyTimes(correction);
  }

private:
  /// Round periodic axes in passes (numerics.md, section 5.3): beams that are still in the box where one pass ends go
  /// on as others, fewer, that share its power.
  void FollowAll(const Monitor& monitor)
  {
    Pass pass = FirstPass(this->Volume.grid);
    this->FollowPoints(pass, 1.0, OfPart(monitor, 0.0, 0.5));
    const bool endless = this->Periodic[0] && this->Periodic[1] && this->Periodic[2];
    for (int done = 1; done<PassesAtMost&& this->OnTheWay> LeftAtMost * this->Shone; ++done)
    {
      if (endless && done >= EvenFrom)
      {
        std::swap(this->Even, this->OnTheWay);
        return;
      }
      const Monitor ofPass = OfPart(monitor, 1.0 - std::exp2(-done), 1.0 - std::exp2(-done - 1));
      const double wanted = this->OnTheWay;
      this->OnTheWay = 0.0;
      pass = pass.Next();
      this->FollowPoints({ pass.begin, pass.begin }, 1.0, {}); // what these beams have left where the pass begins
      const double found = this->OnTheWay;
      if (!(found > 0.0))
      {
        this->OnTheWay = wanted;
        return;
      }
      this->OnTheWay = 0.0;
      this->FollowPoints(pass, wanted / found, ofPass);
    }
  }

  void FollowPoints(const Pass& pass, double factor, const Monitor& monitor)
  {
    // From far a rectangle is a point.
    const std::vector<glm::dvec3> points =
      pass.begin == 0 ? Points(this->TheLight) : std::vector<glm::dvec3>{ Vector(this->TheLight.position) };
    const double all = static_cast<double>(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
    {
      this->Follow(points[p], pass, factor / all, [&](double done) { Report(monitor, (p + done) / all); });
    }
  }

  /// In a box without faces thin light crosses all places alike in the end.
  void SpreadEvenly(double correction)
  {
    const SweepVolume& volume = this->Volume;
    const std::vector<float> sigma = volume.sigma_t->Read();
    const auto first = sigma.begin() + volume.sigma_t_first;
    const double sum = std::accumulate(first, first + volume.grid.VoxelCount(), 0.0);
    if (!(sum > 0.0))
    {
      this->OnTheWay = this->Even; // nothing ever takes it
      return;
    }
    for (int c = 0; c < volume.channels; ++c)
    {
      cl::Kernel add = this->Kernel("add_evenly");
      With(add, *volume.deposit.path, cl_ulong(volume.first + c * volume.stride),
        static_cast<float>(this->TheLight.power[c] * correction * this->Even / sum));
      this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(volume.grid.VoxelCount()));
    }
  }

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
    for (int face = 0; face < 6; ++face)
    {
      const BoxFaceLayout layout = LayoutOfFace(grid, face);
      info.faceFirst[face] = static_cast<cl_int>(layout.first);
      std::copy(layout.step.begin(), layout.step.end(), info.faceStep[face / 2]);
    }
    return info;
  }

  void Follow(const glm::dvec3& point, const Pass& pass, double part, const std::function<void(double)>& report)
  {
    const Grid& grid = this->Volume.grid;
    glm::dvec3 position;
    for (int a = 0; a < 3; ++a)
    {
      position[a] = (point[a] - grid.origin[a]) / grid.spacing[a];
    }
    const bool many = this->TheLight.type == LightType::Rectangle;
    this->AllInside = this->AllInside && IsInside(grid, position);
    const std::vector<BeamRow> rows =
      Beams(grid, this->Periodic, this->TheLight, position, many ? 2.0 * BeamWidth : BeamWidth, pass);
    if (rows.empty())
    {
      return;
    }
    const Buffer<BeamRow> rowBuffer(this->TheDevice, rows, "the beams of a lamp");
    Buffer<float> sums(this->TheDevice, rows.size() * LampRowSums, "sums");
    cl::Kernel kernel = this->Kernel("follow_lamp");
    const LampInfo info = this->Describe(position, part);
    for (std::size_t first = 0, count; first < rows.size(); first += count)
    {
      count = std::min<std::size_t>(this->RowsTogether(rows[first]), rows.size() - first);
      With(kernel, info, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), this->Path,
        cl_ulong(this->Volume.stride), this->Cells, rowBuffer, cl_int(count), cl_int(first), sums);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        kernel, cl::NullRange, cl::NDRange(this->HasAtomics() ? count : 1), GroupOfLargeItems(this->TheDevice));
      this->TheDevice.Finish();
      report(static_cast<double>(first + count) / rows.size());
    }
    this->Count(rows, sums.Read());
  }

  /// Rows of a launch. Round a periodic axis it may be far.
  std::size_t RowsTogether(const BeamRow& row) const
  {
    const double layers = this->Periodic[row.axis] ? static_cast<double>(row.count) * row.layers : 1.0;
    return static_cast<std::size_t>(std::clamp(LayersPerLaunch / layers, 1.0, static_cast<double>(RowsPerLaunch)));
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
      this->Shone += rows[r].skipped > 0 ? 0.0 : row[8];
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
  double Even = 0.0;  ///< to be spread over the whole box
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
