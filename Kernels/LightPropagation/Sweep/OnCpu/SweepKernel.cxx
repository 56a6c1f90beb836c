#include "LightPropagation/Sweep/OnCpu/SweepKernel.h"

#include "Device/Device.h"
#include "Device/ExactValues.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
SweepKernel::SweepKernel(Device& device, const SweepPlan& plan)
  : TheDevice(device)
  , Plan(plan)
  , Border(device, 2 * (plan.eachWay.outside + plan.eachWay.radiance), "the light that comes in sideways")
  , Left(device, plan.units.size() * plan.PatternPlanes() * 4 * plan.channels, "the power that leaves sideways")
  , Coefficients(device, plan.coefficients, "the angular functions")
  , Bundles(device, plan.bundleRows, "the bundles of rays")
  , Units(device, plan.units, "the units of work")
  , FunctionPlaces(device, plan.FunctionPlaces(), "the angular functions")
{
}

void SweepKernel::SetBorder(const std::vector<float>& outside, const std::vector<float>& radiance)
{
  std::vector<float> border = outside;
  border.insert(border.end(), radiance.begin(), radiance.end());
  this->Border.Write(border.data());
  this->BorderIsClear = false;
}

void SweepKernel::ClearBorder()
{
  if (!this->BorderIsClear)
  {
    this->Border.Fill(0.0f);
    this->BorderIsClear = true;
  }
}

void SweepKernel::SetOwnLight(const std::vector<OwnLightInfo>& own)
{
  this->OwnLight = Buffer<OwnLightInfo>(this->TheDevice, own, "the ray pattern");
}

SweepInfo SweepKernel::InfoOf(const SweepVolume& volume, bool goesRound) const
{
  SweepInfo info = this->Plan.Info();
  info.sigmaFirst = volume.sigma_t_first;
  info.first = volume.first;
  info.stride = volume.stride;
  info.roundAxis = goesRound;
  info.sizeY = volume.grid.size[1];
  info.firstChannel = volume.firstChannel;
  info.skips = volume.skipsEmpty;
  return info;
}

cl::Kernel SweepKernel::Make(bool faces, bool periodic, bool sides) const
{
  const SweepPlan& plan = this->Plan;
  return this->TheDevice.Kernel("sweep", kernel_source::Sweep,
    Define("REAL_WIDTH", plan.vector) + Define("CHANNELS", plan.channels) + Define("ROW", plan.row) +
      Define("NET_FLUX", plan.netFlux) + Define("ROWS_KEPT", plan.rowsKept) +
      Define("OCTANT_SOURCE", plan.octantSource) + Define("ANGULAR", plan.angular != nullptr) +
      Define("BEAMS", plan.angular ? plan.angular->Beams() : 0) + Define("FACES", faces) +
      Define("PERIODIC", periodic) + Define("SIDES", sides) + ExactOption(this->TheDevice));
}

void SweepKernel::Launch(
  cl::Kernel& kernel, Crossing& crossing, int launch, const std::vector<cl::Event>* after, cl::Event* done) const
{
  const VolumeArrays& in = crossing.volume;
  crossing.info.launch = launch;
  With(kernel, crossing.info, in.sigma_t, in.source, in.octants, in.path, in.lost, in.flux, in.currents, crossing.maps,
    this->Border, crossing.scratch, this->Units, this->Bundles, this->Coefficients, crossing.crossings, this->OwnLight,
    crossing.schedule, this->Left, crossing.entering, crossing.leaving, this->FunctionPlaces);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(this->Plan.units.size()), cl::NDRange(1), after, done);
  this->TheDevice.Queued(crossing.secondsPerLaunch);
}
}
