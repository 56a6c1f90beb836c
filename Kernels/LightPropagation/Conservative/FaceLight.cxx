#include "LightPropagation/Conservative/FaceLight.h"

#include "LightPropagation/Sweep/SweepOperator.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
/// Power that radiance 1 carries into the box through faces parallel to the marching axis, W, by face and by plane of
/// voxels along the marching axis. All cells of a face in one plane have the same value.
using ByPlane = std::array<std::vector<double>, 6>;

/// Axes perpendicular to the marching axis of rays, and the planes of voxels that the rays cross.
struct Aside
{
  PlaneAxes axes;
  AsidePlanes planes;
};

/// Adds to `power` the power of the rays of a bundle of directions that enter through faces parallel to the marching
/// axis, counted as SweepBorder counts it. Along a short periodic axis the ray pattern repeats only after several laps
/// around the axis (SweepPlan::LayLaps); the power is then the average over laps.
void AddAside(const Bundle& bundle, const Aside& aside, ByPlane& power)
{
  const PlaneAxes& axes = aside.axes;
  const int size = aside.planes.size, planes = PlanesOfPattern(size, aside.planes.periodic);
  const auto addSpread = [&](double tangent, int plane, double ofRay, std::vector<double>& to) {
    ForPlanesPassed(aside.planes, tangent, plane, [&](int p, double part) { to[p] += ofRay * part; });
  };
  const double ofLap = bundle.power * size / planes;
  for (int k = 0; k < planes; ++k)
  {
    const PlaneCrossing crossing = bundle.Crossing(k);
    for (int s = 1; s < crossing.count; ++s)
    {
      const Segment& segment = crossing.segments[s];
      for (const Member& member : bundle.members)
      {
        const int du = member.uFromU * segment.moveU + member.uFromV * segment.moveV;
        const int dv = member.vFromU * segment.moveU + member.vFromV * segment.moveV;
        for (int way = 0; way < 2; ++way)
        {
          const int plane = way ? size - 1 - k % size : k % size;
          const bool goes = (way ? member.opposite : member.direction) >= 0;
          if (du != 0 && goes)
          {
            const double tangent = member.uFromU != 0 ? bundle.tangentU : bundle.tangentV;
            addSpread(tangent, plane, ofLap * segment.part, power[EntryFace(axes.u, du > 0)]);
          }
          if (dv != 0 && goes)
          {
            const double tangent = member.vFromU != 0 ? bundle.tangentU : bundle.tangentV;
            addSpread(tangent, plane, ofLap * segment.part, power[EntryFace(axes.v, dv > 0)]);
          }
        }
      }
    }
  }
}
}

FaceReflection::FaceReflection(
  const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo)
  : TheGrid(grid)
  , ChannelCount(channels)
  , AlbedoOfFaces(albedo)
  , AnyAlbedo(!std::all_of(albedo.begin(), albedo.end(), IsBlack))
{
  ForBoxFaceCells(grid, [this](const BoxFaceCell& cell) { this->FaceOfCell.push_back(cell.face); });
  this->SetPowerIn(std::move(powerIn));
}

void FaceReflection::SetPowerIn(std::vector<double> powerIn)
{
  this->PowerIn = std::move(powerIn);
  this->MeanIn.clear();
  std::array<double, 6> sum = {}, count = {};
  for (std::size_t cell = 0; cell < this->Cells(); ++cell)
  {
    sum[this->FaceOf(cell)] += this->PowerIn[cell];
    count[this->FaceOf(cell)] += 1.0;
  }
  for (int face : this->FaceOfCell)
  {
    this->MeanIn.push_back(sum[face] / count[face]);
  }
}

std::vector<float> FaceReflection::RadianceOf(
  const std::vector<double>& swept, const std::vector<double>& uncollided) const
{
  // Power of uncollided light by cell, W, distributed like the light that the rays of a sweep carry into the cells of
  // the face.
  std::vector<double> brought(swept.size());
  for (std::size_t i = 0; i < swept.size(); ++i)
  {
    const std::size_t cell = i % this->Cells();
    brought[i] = this->MeanIn[cell] > 0.0 ? uncollided[i] * this->PowerIn[cell] / this->MeanIn[cell] : 0.0;
  }
  const std::array<Rgb, 6> is = this->PowerOfFaces(brought), shouldBe = this->PowerOfFaces(uncollided);
  std::vector<float> radiance(swept.size());
  for (std::size_t i = 0; i < swept.size(); ++i)
  {
    const std::size_t cell = i % this->Cells(), c = i / this->Cells();
    const int face = this->FaceOf(cell);
    const double part = is[face][c] > 0.0 ? shouldBe[face][c] / is[face][c] : 0.0;
    radiance[i] =
      static_cast<float>(this->PowerIn[cell] > 0.0 ? (swept[i] + part * brought[i]) / this->PowerIn[cell] : 0.0);
  }
  return radiance;
}

std::array<Rgb, 6> FaceReflection::PowerOfFaces(const std::vector<double>& power) const
{
  std::array<Rgb, 6> sums = {};
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    sums[this->FaceOf(i % this->Cells())][i / this->Cells()] += power[i];
  }
  return sums;
}

double FaceReflection::Pattern(std::size_t cell) const
{
  return this->PowerIn[cell] > 0.0 ? this->PowerIn[cell] / this->MeanIn[cell] : 1.0;
}

std::vector<double> FaceReflection::ScaledTo(std::vector<double> power, const std::vector<double>& sums) const
{
  return this->ScaledTo(std::move(power), this->PowerOfFaces(sums));
}

std::vector<double> FaceReflection::ScaledTo(std::vector<double> power, const std::array<Rgb, 6>& shouldBe) const
{
  const std::array<Rgb, 6> is = this->PowerOfFaces(power);
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    const int face = this->FaceOf(i % this->Cells());
    const std::size_t c = i / this->Cells();
    power[i] *= is[face][c] > 0.0 ? shouldBe[face][c] / is[face][c] : 1.0;
  }
  return power;
}

std::vector<float> FaceReflection::PerArea(const std::vector<double>& power) const
{
  std::vector<float> perArea(power.size());
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    const std::size_t cell = i / this->ChannelCount, c = i % this->ChannelCount;
    const double area = this->TheGrid.VoxelVolume() / this->TheGrid.spacing[this->FaceOf(cell) / 2];
    perArea[i] = static_cast<float>(power[c * this->Cells() + cell] / area);
  }
  return perArea;
}

FaceLight::FaceLight(
  Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo)
  : FaceReflection(grid, channels, std::move(powerIn), albedo)
  , Leaving(device, channels * BoxFaceCellCount(grid), "the light that leaves through the faces")
  , Entering(device, channels * BoxFaceCellCount(grid), "the light that faces give back")
{
  this->AllSwept.assign(channels * this->Cells(), 0.0);
  this->AllUncollided = this->AllSwept;
  this->Leaving.Fill(0.0f);
  this->Entering.Fill(0.0f);
}

std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads)
{
  std::vector<double> power(BoxFaceCellCount(grid), 0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    const Aside aside = { AcrossAxis(axis), { grid.size[axis], periodic[axis], spreads } };
    ByPlane byPlane;
    byPlane.fill(std::vector<double>(aside.planes.size, 0.0));
    std::array<double, 2> ahead = {}; // power through each cell of the low and of the high face, W
    for (const Bundle& bundle : directions.Along(axis))
    {
      for (const Member& member : bundle.members)
      {
        ahead[0] += member.direction >= 0 ? bundle.power : 0.0;
        ahead[1] += member.opposite >= 0 ? bundle.power : 0.0;
      }
      AddAside(bundle, aside, byPlane);
    }
    ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
      const int plane = grid.VoxelAt(cell.voxel)[axis];
      power[cell.number] += cell.face / 2 == axis ? ahead[cell.face % 2] : byPlane[cell.face][plane];
    });
  }
  return power;
}

std::vector<float> FaceLight::TakeOut()
{
  std::vector<float> out = this->Leaving.Read();
  this->Leaving.Fill(0.0f);
  return out;
}

std::array<Rgb, 6> FaceLight::Reflect()
{
  const std::vector<float> out = this->TakeOut();
  this->Uncollided.resize(out.size(), 0.0f);
  std::vector<double> swept(out.size()), uncollided(out.size());
  for (std::size_t i = 0; i < out.size(); ++i)
  {
    const double albedo = this->AlbedoOf(i);
    this->AllSwept[i] += out[i];
    this->AllUncollided[i] += this->Uncollided[i];
    swept[i] = albedo * out[i];
    uncollided[i] = albedo * this->Uncollided[i];
  }
  this->Uncollided.clear();
  if (this->Reflects())
  {
    this->LetIn(swept, uncollided);
  }
  std::transform(swept.begin(), swept.end(), uncollided.begin(), swept.begin(), std::plus<>());
  this->LastMagnitude = {};
  for (std::size_t i = 0; i < swept.size(); ++i)
  {
    this->LastMagnitude[i / this->Cells()] += std::abs(swept[i]);
  }
  return this->PowerOfFaces(swept);
}

std::vector<double> FaceLight::LeftInAll() const
{
  std::vector<double> left = this->AllSwept;
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    left[i] /= this->Pattern(i % this->Cells());
  }
  left = this->ScaledTo(std::move(left), this->AllSwept);
  std::transform(left.begin(), left.end(), this->AllUncollided.begin(), left.begin(), std::plus<>());
  return left;
}

void FaceLight::LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided)
{
  this->Entering.Write(this->RadianceOf(swept, uncollided).data());
}
}
