#include "LightPropagation/Sweep/OnGpu/LaneSums.h"

#include "LightPropagation/Sweep/SweepBorder.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
LaneArrays::LaneArrays(Device& device, const GpuLanes& lanes, const VolumeLayout& layout, const Deposit& to)
  : TheDevice(device)
  , Lanes(lanes)
  , Layout(layout)
  , To(to)
{
  const std::size_t values = lanes.channels * layout.Stride();
  const auto make = [&](Buffer<float>& array, std::size_t count, std::size_t parts, const char* what) {
    if (count * parts > 0)
    {
      array = Buffer<float>(device, count * parts * values, what);
      array.Fill(0.0f); // the padding between channels remains zero
    }
  };
  make(this->path, lanes.mostWithArrays, lanes.functionCount, "the light of each way");
  make(this->lost, lanes.mostAround, lanes.functionCount, "the light of each way");
  make(this->flux, lanes.mostWithArrays, to.flux ? 3 : 0, "the net flux of each way");
  make(this->currents, lanes.mostWithArrays, to.partialCurrents ? 6 : 0, "the partial currents of each way");
}

void LaneArrays::Clear(const LaneBatch& batch)
{
  const std::size_t values = batch.count * this->Lanes.channels * this->Layout.Stride();
  this->path.Fill(0.0f, 0, this->Lanes.functionCount * values);
  this->lost.Fill(0.0f, 0, this->Lanes.functionCount * values);
  if (this->To.flux)
  {
    this->flux.Fill(0.0f, 0, 3 * values);
  }
  if (this->To.partialCurrents)
  {
    this->currents.Fill(0.0f, 0, 6 * values);
  }
}

void LaneArrays::AddUp(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume)
{
  cl::Kernel kernel = this->TheDevice.Kernel("add_lanes", kernel_source::LaneSums, this->Lanes.Options());
  const auto add = [&](const Buffer<float>& ofLanes, const Buffer<float>* to, std::size_t components) {
    if (!to)
    {
      return;
    }
    const std::size_t values = components * this->Lanes.channels * this->Layout.Stride();
    With(kernel, ofLanes, cl_int(batch.count), cl_ulong(values), *to, cl_ulong(components * volume.first));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
  };
  if (this->Lanes.functionCount > 1)
  {
    this->AddUpMoments(batch, launch, volume);
  }
  else
  {
    add(this->path, this->To.path, 1);
  }
  add(this->flux, this->To.flux, 3);
  add(this->currents, this->To.partialCurrents, 6);
}

void LaneArrays::AddUpMoments(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume)
{
  cl::Kernel kernel = this->TheDevice.Kernel("add_moments_of_lanes", kernel_source::LaneSums, this->Lanes.Options());
  With(kernel, launch, this->path, cl_int(batch.count), *this->To.path, cl_ulong(volume.first));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(
      this->Layout.grid.VoxelCount(), static_cast<std::size_t>(this->Lanes.functionCount) * this->Lanes.channels));
}

LanePowers::LanePowers(Device& device, const GpuLanes& lanes)
  : TheDevice(device)
  , Lanes(lanes)
  , OfPlanes(device, lanes.escaped, "the power that leaves sideways", CL_MEM_READ_WRITE, Residence::Device)
  , Sides(device, lanes.sideRows, "sums")
  , Ends(device, lanes.endRows, "sums")
{
  if (lanes.escaped > 0)
  {
    this->OfPlanes.Fill(0.0f); // positions beyond the end of a lane's shorter faces remain zero
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
    const auto begin = sums.begin() + this->Lanes.sides[i];
    CountSideways(this->Lanes.PlanOf(i), { begin, begin + this->Lanes.SideRows(i) }, tally);
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
