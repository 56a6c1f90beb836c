#include "LightPropagation/Sweep/OnGpu/LaneArrays.h"

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
      array.Fill(0.0f); // padding stays zero
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
}
