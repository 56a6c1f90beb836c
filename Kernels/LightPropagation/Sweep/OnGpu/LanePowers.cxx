#include "LightPropagation/Sweep/OnGpu/LanePowers.h"

#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <array>

namespace tyndall
{
LanePowers::LanePowers(Device& device, const GpuLanes& lanes)
  : TheDevice(device)
  , Lanes(lanes)
  , OfPlanes(device, lanes.escaped, "the power that leaves sideways", CL_MEM_READ_WRITE, Residence::Device)
  , Sides(device, lanes.sideRows, "sums")
  , Ends(device, lanes.endRows, "sums")
{
  if (lanes.escaped > 0)
  {
    this->OfPlanes.Fill(0.0f); // the ends of rows of shorter faces stay zero
  }
}

void LanePowers::AddUp(const LaneBatch& batch, const MapsOfLane& maps)
{
  cl::Kernel kernel = this->TheDevice.Kernel("sum_rows", kernel_source::LaneSums, this->Lanes.Options());
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->Lanes.lanes[i];
    With(kernel, maps(lane), lane.map, cl_int(lane.planes.sizeU), this->Ends, cl_ulong(this->Lanes.ends[i]));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Lanes.EndRows(i)));
    With(kernel, this->OfPlanes, lane.escaped, lane.positions, this->Sides, cl_ulong(this->Lanes.sides[i]));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Lanes.SideRows(i)));
  }
}

void LanePowers::CountSides(const LaneBatch& batch, SweepTally& tally) const
{
  const std::vector<float> sums = this->Sides.Read();
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const PlaneAxes axes = AcrossAxis(this->Lanes.lanes[i].axis);
    const std::array<int, 4> faces = { 2 * axes.u, 2 * axes.u + 1, 2 * axes.v, 2 * axes.v + 1 };
    for (std::size_t r = 0; r < this->Lanes.SideRows(i); ++r)
    {
      tally.out[faces[r / this->Lanes.channels % 4]][r % this->Lanes.channels] += sums[this->Lanes.sides[i] + r];
    }
  }
}

void LanePowers::CountEnds(const LaneBatch& batch, SweepTally& tally) const
{
  const std::vector<float> sums = this->Ends.Read();
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->Lanes.lanes[i];
    const Rgb left = this->OfEnds(i, sums);
    for (int c = 0; c < this->Lanes.channels; ++c)
    {
      tally.out[2 * lane.axis + 1 - lane.backward][c] += left[c];
    }
  }
}

Rgb LanePowers::OfEnds(const LaneBatch& batch) const
{
  const std::vector<float> sums = this->Ends.Read();
  Rgb power = {};
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const Rgb ofLane = this->OfEnds(i, sums);
    for (int c = 0; c < this->Lanes.channels; ++c)
    {
      power[c] += ofLane[c];
    }
  }
  return power;
}

Rgb LanePowers::OfEnds(int lane, const std::vector<float>& sums) const
{
  Rgb power = {};
  const std::size_t ofMap = this->Lanes.lanes[lane].planes.sizeV;
  for (std::size_t r = 0; r < this->Lanes.EndRows(lane); ++r)
  {
    power[r / ofMap % this->Lanes.channels] += sums[this->Lanes.ends[lane] + r];
  }
  return power;
}
}
