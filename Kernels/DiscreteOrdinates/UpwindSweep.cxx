#include "DiscreteOrdinates/UpwindSweep.h"

#include "Device/Batches.h"
#include "Device/Device.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
/// Upper bound of the chord of a direction through a voxel, in voxel edges, for directions along which nothing varies
constexpr double LongestChord = 1e6;
/// Optical length of a voxel's longest edge up to which a sweep attenuates light along the mean chord (numerics.md, Eq.
/// (D10)) instead of by diamond differences, which overshoot in nearly empty voxels beside opaque ones.
constexpr double ThinForDiamonds = 0.01;

std::size_t FaceVoxels(const Grid& grid, int axis)
{
  const PlaneAxes across = AcrossAxis(axis);
  return static_cast<std::size_t>(grid.size[across.u]) * static_cast<std::size_t>(grid.size[across.v]);
}

double FaceArea(const Grid& grid, int axis)
{
  return grid.VoxelVolume() / grid.spacing[axis];
}

/// Parameters of a sweep through all layers of a part of the grid (SweepsAll, SweepsBox or SweepsBeyondBox).
SweptLayers PartOf(const Grid& grid, const VoxelBox& box, int part)
{
  SweptLayers layers = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    layers.size[axis] = grid.size[axis];
    layers.first[axis] = box.first[axis];
    layers.last[axis] = box.first[axis] + box.size[axis] - 1;
  }
  layers.part = part;
  layers.end = part == SweepsBox ? box.size[2] : grid.size[2];
  layers.stride = OrdinateStride(grid.VoxelCount());
  layers.thin = static_cast<float>(ThinForDiamonds / *std::max_element(grid.spacing.begin(), grid.spacing.end()));
  return layers;
}
}

SweptFaces SweptFaces::Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting)
{
  SweptFaces faces = { periodic, {}, reflecting, 0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    faces.unvarying[axis] = periodic[axis] && grid.size[axis] == 1;
  }
  return faces;
}

UpwindSweep::UpwindSweep(Device& device, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces)
  : TheDevice(device)
  , TheGrid(grid)
  , Groups(groups)
  , At(faces)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t lanes = groups.Lanes();
    this->Faces[axis] = Buffer<float>(device, lanes * FaceVoxels(grid, axis), "light through the faces");
    this->Sums[axis] = Buffer<float>(device, lanes * this->FaceSize(axis)[0], "sums");
    this->Faces[axis].Fill(0.0f);
  }
  this->LoadDirections();
}

std::size_t UpwindSweep::Bytes(const Grid& grid, const OrdinateGroups& groups)
{
  const std::size_t faces = FaceVoxels(grid, 0) + FaceVoxels(grid, 1) + FaceVoxels(grid, 2);
  // factor 2: a second set of arrays holds the radiance that leaves the box of ApplyWithin()
  return 2 * sizeof(float) * groups.Lanes() * faces;
}

std::array<int, 2> UpwindSweep::FaceSize(int axis) const
{
  const std::array<int, 3>& n = this->TheGrid.size;
  return axis == 0 ? std::array<int, 2>{ n[2], n[1] }
    : axis == 1    ? std::array<int, 2>{ n[2], n[0] }
                   : std::array<int, 2>{ n[1], n[0] };
}

void UpwindSweep::LoadDirections()
{
  const std::array<double, 3>& h = this->TheGrid.spacing;
  const double longest = LongestChord * *std::max_element(h.begin(), h.end());
  std::vector<float> shares, across;
  std::vector<cl_int> up;
  for (int g = 0; g < this->Groups.Count(); ++g)
  {
    std::array<std::array<float, OrdinateLanes>, 4> of, powers;
    for (int lane = 0; lane < OrdinateLanes; ++lane)
    {
      std::array<double, 3> crossed = {}; // number of voxel faces crossed along each axis, per unit length
      for (int a = 0; a < 3; ++a)
      {
        crossed[a] = this->IsCarried(a) ? std::abs(this->Groups.Of(g, lane).omega[a]) / h[a] : 0.0;
      }
      const double all = std::max(crossed[0] + crossed[1] + crossed[2], 1.0 / longest);
      for (int a = 0; a < 3; ++a)
      {
        const double areaAcross = std::abs(this->Groups.Of(g, lane).omega[a]) * FaceArea(this->TheGrid, a);
        powers[a][lane] = static_cast<float>(this->Groups.Weight(g, lane) * areaAcross);
        of[a][lane] = static_cast<float>(crossed[a] / all);
      }
      of[3][lane] = static_cast<float>(1.0 / all);
      powers[3][lane] = static_cast<float>(this->Groups.Weight(g, lane));
    }
    for (const auto& values : of)
    {
      shares.insert(shares.end(), values.begin(), values.end());
    }
    for (const auto& values : powers)
    {
      across.insert(across.end(), values.begin(), values.end());
    }
    const std::array<bool, 3>& way = this->Groups.All()[g].up;
    up.insert(up.end(), way.begin(), way.end());
  }
  this->Shares = Buffer<float>(this->TheDevice, shares, "the directions");
  this->Across = Buffer<float>(this->TheDevice, across, "the directions");
  this->Up = Buffer<cl_int>(this->TheDevice, up, "the directions");
}

cl::Kernel UpwindSweep::Kernel(const char* name, int width) const
{
  return this->TheDevice.Kernel(name, kernel_source::UpwindSweep, Define("REAL_WIDTH", width));
}

/// For each group of directions, whether light is incident along any of them through a face of the box.
std::vector<bool> UpwindSweep::LitGroups(const IncomingRadiance& incoming) const
{
  std::vector<bool> lit;
  for (const OrdinateGroup& group : this->Groups.All())
  {
    bool any = false;
    for (int lane = 0; lane < group.count; ++lane)
    {
      for (int axis = 0; axis < 3 && incoming; ++axis)
      {
        any = any || incoming(group.direction[lane], 2 * axis + (group.up[axis] ? 0 : 1)) > 0.0;
      }
    }
    lit.push_back(any);
  }
  return lit;
}

double UpwindSweep::LitPart(const IncomingRadiance& incoming) const
{
  const std::vector<bool> lit = this->LitGroups(incoming);
  return static_cast<double>(std::count(lit.begin(), lit.end(), true)) / static_cast<double>(lit.size());
}

FacePowers UpwindSweep::Apply(
  const OrdinateArrays& arrays, const IncomingRadiance& incoming, bool shines, const Monitor& monitor)
{
  FacePowers powers;
  this->LetIn(incoming, powers, arrays.onlyWraps);
  const int all = this->Groups.Count();
  const std::vector<bool> lit = shines ? std::vector<bool>(all, true) : this->LitGroups(incoming);
  for (int first = 0, end = 0; first < all; first = end)
  {
    end = first + 1;
    while (end < all && lit[end] == lit[first])
    {
      ++end;
    }
    if (lit[first])
    {
      const Monitor ofRun = OfPart(monitor, static_cast<double>(first) / all, static_cast<double>(end) / all);
      this->SweepGroups(first, end - first, arrays, ofRun);
    }
  }
  this->Count(powers);
  this->LeaveByCells();
  return powers;
}

void UpwindSweep::Forget()
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->At.periodic[axis])
    {
      this->Faces[axis].Fill(0.0f);
    }
  }
}

FacePowers UpwindSweep::ApplyWithin(const VoxelBox& box, const OrdinateArrays& arrays, const Monitor& monitor)
{
  FacePowers powers;
  this->LetIn({}, powers, arrays.onlyWraps);
  this->Sweep(0, this->Groups.Count(), PartOf(this->TheGrid, box, SweepsBox), arrays, monitor);
  this->Count(powers);
  cl::Kernel add = this->Kernel("add_face");
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Left[axis].Size() == 0)
    {
      this->Left[axis] = Buffer<float>(this->TheDevice, this->Faces[axis].Size(), "light that leaves the medium");
      this->Left[axis].Fill(0.0f);
    }
    With(add, this->Left[axis], this->Faces[axis]);
    Launch(this->TheDevice, add, cl::NDRange(this->Faces[axis].Size() / OrdinateLanes));
  }
  return powers;
}

FacePowers UpwindSweep::ApplyBeyond(const VoxelBox& box, const OrdinateArrays& arrays, const Monitor& monitor)
{
  this->Faces.swap(this->Left);
  this->Sweep(0, this->Groups.Count(), PartOf(this->TheGrid, box, SweepsBeyondBox), arrays, monitor);
  FacePowers powers;
  this->Count(powers);
  return powers;
}

void UpwindSweep::SweepGroups(int first, int count, const OrdinateArrays& arrays, const Monitor& monitor)
{
  const SweptLayers all = PartOf(this->TheGrid, { { 0, 0, 0 }, this->TheGrid.size }, SweepsAll);
  this->Sweep(first, count, all, arrays, monitor);
}

/// Sweeps `count` groups of directions through a part of the grid.
void UpwindSweep::Sweep(int first, int count, SweptLayers part, const OrdinateArrays& arrays, const Monitor& monitor)
{
  const SweptSums* const sums = arrays.sums;
  const int width = this->TheDevice.IsCpu() || sums ? OrdinateLanes : 1; // a work-item sums over a whole group
  const std::string name = !sums ? "sweep_upwind" : sums->even ? "sweep_even" : "sweep_moments";
  cl::Kernel sweep = this->Kernel((sums && sums->byDiamonds ? name + "_by_diamonds" : name).c_str(), width);
  part.ofMean = sums && sums->ofMean;
  part.firstT = sums ? sums->firstExtinction : 0;
  part.firstSource = sums ? sums->first : 0;
  part.skips = arrays.empty != nullptr;
  for (int axis = 0; axis < 3 && arrays.netFlux; ++axis)
  {
    part.perArea[axis] = static_cast<float>(1.0 / FaceArea(this->TheGrid, axis));
  }
  Batches batches;
  batches.count = static_cast<std::size_t>(part.end);
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t begin, std::size_t size) {
    part.begin = static_cast<cl_int>(begin);
    part.end = static_cast<cl_int>(begin + size);
    const Buffer<float>& light = sums && sums->even ? *sums->even : arrays.radiance;
    const auto set = [&](const auto&... more) {
      With(sweep, light, arrays.sigma_t, more..., this->Shares, this->Across, this->Up, this->Faces[0], this->Faces[1],
        this->Faces[2], part);
    };
    sums ? set(sums->values) : set(arrays.scale, arrays.empty ? arrays.empty->Handle() : this->Up.Handle());
    const std::size_t items = OrdinateLanes / static_cast<std::size_t>(width);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      sweep, cl::NDRange(first * items), cl::NDRange(count * items), GroupOfLargeItems(this->TheDevice));
  });
}

std::vector<float> UpwindSweep::ReadFace(int axis, int firstGroup, int groups) const
{
  const std::size_t ofGroup = OrdinateLanes * FaceVoxels(this->TheGrid, axis);
  std::vector<float> values(groups * ofGroup);
  this->TheDevice.Queue().enqueueReadBuffer(this->Faces[axis].Handle(), CL_TRUE, firstGroup * ofGroup * sizeof(float),
    values.size() * sizeof(float), values.data());
  return values;
}

void UpwindSweep::WriteFace(int axis, int firstGroup, const std::vector<float>& values)
{
  const std::size_t ofGroup = OrdinateLanes * FaceVoxels(this->TheGrid, axis);
  this->TheDevice.Queue().enqueueWriteBuffer(this->Faces[axis].Handle(), CL_TRUE, firstGroup * ofGroup * sizeof(float),
    values.size() * sizeof(float), values.data());
}

void UpwindSweep::EnterByCells(int axis) const
{
  cl::Kernel enter = this->Kernel("enter_by_cells");
  const std::size_t cells = FaceVoxels(this->TheGrid, axis);
  With(enter, this->Faces[axis], this->At.reflecting->in, this->Up, axis, this->CellOf(2 * axis),
    this->CellOf(2 * axis + 1));
  Launch(this->TheDevice, enter, cl::NDRange(cells, this->Groups.Count()));
}

void UpwindSweep::LeaveByCells() const
{
  cl::Kernel leave = this->Kernel("leave_by_cells");
  for (int axis = 0; axis < 3 && this->At.reflecting; ++axis)
  {
    if (this->At.periodic[axis])
    {
      continue;
    }
    With(leave, this->Faces[axis], this->At.reflecting->out, this->Across, this->Up, axis, this->Groups.Count(),
      this->CellOf(2 * axis), this->CellOf(2 * axis + 1));
    Launch(this->TheDevice, leave, cl::NDRange(FaceVoxels(this->TheGrid, axis)));
  }
}

/// Sets the incident radiance of the boundary source. Periodic faces already hold the radiance that left at the other
/// end of the axis.
void UpwindSweep::LetIn(const IncomingRadiance& incoming, FacePowers& powers, bool onlyWraps)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->At.periodic[axis])
    {
      continue;
    }
    if (incoming)
    {
      this->FillFace(axis, incoming, powers);
    }
    else
    {
      this->Faces[axis].Fill(0.0f);
    }
    if (this->At.reflecting && !onlyWraps)
    {
      this->EnterByCells(axis);
    }
  }
}

void UpwindSweep::FillFace(int axis, const IncomingRadiance& incoming, FacePowers& powers)
{
  const std::size_t voxels = FaceVoxels(this->TheGrid, axis);
  const std::vector<float> values = this->Groups.Table([&](int g, int lane) {
    const OrdinateGroup& group = this->Groups.All()[g];
    return incoming(group.direction[lane], 2 * axis + (group.up[axis] ? 0 : 1));
  });
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const int g = static_cast<int>(i / OrdinateLanes), lane = i % OrdinateLanes;
    const double across = this->Groups.Weight(g, lane) * std::abs(this->Groups.Of(g, lane).omega[axis]);
    const int face = 2 * axis + (this->Groups.All()[g].up[axis] ? 0 : 1);
    powers.in[face] +=
      this->IsCounted(face) ? across * values[i] * FaceArea(this->TheGrid, axis) * static_cast<double>(voxels) : 0.0;
  }
  const Buffer<float> table(this->TheDevice, values, "light through the faces");
  cl::Kernel fill = this->Kernel("fill_face");
  With(fill, this->Faces[axis], table, cl_int(voxels));
  Launch(this->TheDevice, fill, cl::NDRange(this->Groups.Count() * voxels));
  this->TheDevice.Finish(); // the kernel reads `table`, which is destroyed on return
}

void UpwindSweep::Count(FacePowers& powers) const
{
  cl::Kernel sum = this->Kernel("sum_rows");
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!this->IsCarried(axis))
    {
      continue;
    }
    const std::array<int, 2> size = this->FaceSize(axis);
    With(sum, this->Faces[axis], this->Sums[axis], cl_int(size[1]));
    Launch(this->TheDevice, sum, cl::NDRange(this->Groups.Count() * size[0]));
    const std::vector<float> sums = this->Sums[axis].Read();
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      const int g = static_cast<int>(i / OrdinateLanes / size[0]), lane = i % OrdinateLanes;
      const double across = this->Groups.Weight(g, lane) * std::abs(this->Groups.Of(g, lane).omega[axis]);
      const int face = 2 * axis + (this->Groups.All()[g].up[axis] ? 1 : 0);
      const double watts = this->IsCounted(face) ? across * sums[i] * FaceArea(this->TheGrid, axis) : 0.0;
      (this->At.periodic[axis] ? powers.onTheWay : powers.out[face]) += watts;
    }
  }
}
}
