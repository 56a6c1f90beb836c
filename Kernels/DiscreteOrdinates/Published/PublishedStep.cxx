#include "DiscreteOrdinates/Published/PublishedStep.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
PublishedStep::PublishedStep(Device& device, const Grid& grid, const OrdinateGroups& groups,
  const std::array<bool, 3>& periodic, const IncomingRadiance& incoming, const FaceLight* reflecting)
  : TheDevice(device)
  , TheGrid(grid)
  , Groups(groups)
  , Periodic(periodic)
  , Step(*std::min_element(grid.spacing.begin(), grid.spacing.end()))
  , Reflecting(reflecting)
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
        const double radiance = incoming && !periodic[a] ? incoming(groups.All()[g].direction[lane], face) : 0.0;
        const double area = grid.VoxelVolume() / grid.spacing[a];
        this->Entering[face] += groups.Weight(g, lane) * along * radiance * area * grid.VoxelCount() / grid.size[a];
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
  return this->TheDevice.Kernel(name, kernel_source::PublishedStep, Define("FACE_IN", this->Reflecting != nullptr));
}

void PublishedStep::Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
  const Buffer<float>& sigma_t, const Buffer<float>& after) const
{
  const cl::NDRange all(this->TheGrid.VoxelCount(), this->Groups.Count());
  cl::Kernel change = this->Kernel("change_radiance"), move = this->Kernel("move_on");
  With(change, radiance, scattered, steady, sigma_t, static_cast<float>(this->Step),
    cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())));
  this->TheDevice.Queue().enqueueNDRangeKernel(change, cl::NullRange, all);
  const std::array<int, 3>& n = this->TheGrid.size;
  const int periodic = this->Periodic[0] + 2 * this->Periodic[1] + 4 * this->Periodic[2];
  const Buffer<float>& faceIn = this->Reflecting ? this->Reflecting->In() : this->Incoming;
  With(move, radiance, after, this->Parts, this->Up, this->Incoming, faceIn, n[0], n[1], n[2],
    cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())), periodic);
  this->TheDevice.Queue().enqueueNDRangeKernel(move, cl::NullRange, all);
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
    if (this->Periodic[axis])
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
      powers.out[2 * axis + (this->Groups.All()[g].up[axis] ? 1 : 0)] += across * found[i] * area;
    }
  }
  return powers;
}

void PublishedStep::LeaveByCells(const Buffer<float>& radiance) const
{
  const Grid& grid = this->TheGrid;
  const std::array<std::size_t, 3> strides = grid.Strides();
  cl::Kernel leave = this->Kernel("leave_by_cells");
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Periodic[axis])
    {
      continue;
    }
    const PlaneAxes across = AcrossAxis(axis);
    With(leave, radiance, this->Reflecting->Out(), this->Across, this->Up, cl_ulong(OrdinateStride(grid.VoxelCount())),
      axis, this->Groups.Count(), cl_ulong(strides[axis] * (grid.size[axis] - 1)), cl_ulong(strides[across.v]),
      cl_ulong(strides[across.u]), cl_ulong(LayoutOfFace(grid, 2 * axis).first),
      cl_ulong(LayoutOfFace(grid, 2 * axis + 1).first));
    const cl::NDRange cells(grid.size[across.u], grid.size[across.v]);
    this->TheDevice.Queue().enqueueNDRangeKernel(leave, cl::NullRange, cells);
  }
}
}
