#include "DiscreteOrdinates/Published/PublishedStep.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
SteppedFaces SteppedFaces::Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting)
{
  SteppedFaces faces = { grid, { {}, grid.size }, periodic, 0, 0, reflecting };
  for (int axis = 0; axis < 3; ++axis)
  {
    faces.outside |= periodic[axis] ? 0 : 3 << (2 * axis);
  }
  faces.counted = faces.outside;
  return faces;
}

PublishedStep::PublishedStep(Device& device, const Grid& grid, const OrdinateGroups& groups,
  const IncomingRadiance& incoming, const SteppedFaces& at)
  : TheDevice(device)
  , TheGrid(grid)
  , Groups(groups)
  , At(at)
  , Step(*std::min_element(grid.spacing.begin(), grid.spacing.end()))
{
  std::vector<float> parts, outside, across;
  std::vector<cl_int> up;
  for (int g = 0; g < groups.Count(); ++g)
  {
    for (int a = 0; a < 3; ++a)
    {
      const int face = 2 * a + (groups.All()[g].up[a] ? 0 : 1);
      up.push_back(groups.All()[g].up[a]);
      for (int lane = 0; lane < OrdinateLanes; ++lane)
      {
        const double along = std::abs(groups.Of(g, lane).omega[a]);
        const double radiance = incoming && !at.periodic[a] ? incoming(groups.All()[g].direction[lane], face) : 0.0;
        const double area = grid.VoxelVolume() / grid.spacing[a];
        this->Entering[face] +=
          groups.Weight(g, lane) * along * radiance * area * at.whole.VoxelCount() / at.whole.size[a];
        across.push_back(static_cast<float>(groups.Weight(g, lane) * along * area));
        parts.push_back(static_cast<float>(along * this->Step / grid.spacing[a]));
        outside.push_back(static_cast<float>(radiance));
      }
    }
  }
  this->Parts = Buffer<float>(device, parts, "the directions");
  this->Incoming = Buffer<float>(device, outside, "light through the faces");
  this->Across = Buffer<float>(device, across, "the directions");
  this->Up = Buffer<cl_int>(device, up, "the directions");
}

cl::Kernel PublishedStep::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::PublishedStep, Define("FACE_IN", this->At.reflecting != nullptr));
}

void PublishedStep::Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
  const Buffer<float>& sigma_t, const Buffer<float>& after)
{
  this->Change(radiance, scattered, steady, sigma_t);
  this->MoveOn(radiance, after);
}

void PublishedStep::Change(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
  const Buffer<float>& sigma_t) const
{
  cl::Kernel change = this->Kernel("change_radiance");
  With(change, radiance, scattered, steady, sigma_t, static_cast<float>(this->Step),
    cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    change, cl::NullRange, cl::NDRange(this->TheGrid.VoxelCount(), this->Groups.Count()));
}

void PublishedStep::MoveOn(const Buffer<float>& before, const Buffer<float>& after) const
{
  const VoxelBox& known = this->At.known;
  int around = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    around |= this->At.periodic[axis] && known.size[axis] == this->TheGrid.size[axis] ? 1 << axis : 0;
  }
  cl::Kernel move = this->Kernel("move_on");
  With(move, before, after, this->Parts, this->Up, this->Incoming,
    this->At.reflecting ? this->At.reflecting->in : this->Incoming, Int4(this->TheGrid.size), Int4(known.size),
    Int4({ -known.first[0], -known.first[1], -known.first[2] }), cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())),
    cl_ulong(OrdinateStride(known.VoxelCount())), this->At.outside, around);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    move, cl::NullRange, cl::NDRange(this->TheGrid.VoxelCount(), this->Groups.Count()));
  this->TheDevice.Finish();
}

FacePowers PublishedStep::Powers(const Buffer<float>& radiance) const
{
  FacePowers powers;
  powers.in = this->Entering;
  const std::array<std::size_t, 3> strides = this->TheGrid.Strides();
  cl::Kernel sum = this->Kernel("sum_leaving");
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->At.periodic[axis])
    {
      continue;
    }
    const PlaneAxes across = AcrossAxis(axis);
    const std::size_t rows = this->TheGrid.size[across.v];
    Buffer<float> sums(this->TheDevice, this->Groups.Lanes() * rows, "sums");
    With(sum, radiance, sums, this->Up, cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())), axis,
      cl_ulong(strides[axis] * (this->TheGrid.size[axis] - 1)), cl_ulong(strides[across.v]),
      cl_ulong(strides[across.u]), this->TheGrid.size[across.u]);
    this->TheDevice.Queue().enqueueNDRangeKernel(sum, cl::NullRange, cl::NDRange(rows, this->Groups.Count()));
    const std::vector<float> found = sums.Read();
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      const int g = static_cast<int>(i / OrdinateLanes / rows), lane = i % OrdinateLanes;
      const double across = this->Groups.Weight(g, lane) * std::abs(this->Groups.Of(g, lane).omega[axis]);
      const double area = this->TheGrid.VoxelVolume() / this->TheGrid.spacing[axis];
      const int face = 2 * axis + (this->Groups.All()[g].up[axis] ? 1 : 0);
      powers.out[face] += this->At.counted >> face & 1 ? across * found[i] * area : 0.0;
    }
  }
  return powers;
}

void PublishedStep::LeaveByCells(const Buffer<float>& radiance)
{
  const Grid& grid = this->TheGrid;
  const std::array<std::size_t, 3> strides = grid.Strides();
  cl::Kernel leave = this->Kernel("leave_by_cells");
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->At.periodic[axis])
    {
      continue;
    }
    const PlaneAxes across = AcrossAxis(axis);
    With(leave, radiance, this->At.reflecting->out, this->Across, this->Up, cl_ulong(OrdinateStride(grid.VoxelCount())),
      axis, this->Groups.Count(), cl_ulong(strides[axis] * (grid.size[axis] - 1)), cl_ulong(strides[across.v]),
      cl_ulong(strides[across.u]), cl_ulong(LayoutOfFace(grid, 2 * axis).first),
      cl_ulong(LayoutOfFace(grid, 2 * axis + 1).first));
    const cl::NDRange cells(grid.size[across.u], grid.size[across.v]);
    this->TheDevice.Queue().enqueueNDRangeKernel(leave, cl::NullRange, cells);
  }
}
}
