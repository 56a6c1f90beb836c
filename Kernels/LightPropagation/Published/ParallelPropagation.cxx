#include "LightPropagation/Published/ParallelPropagation.h"

#include "Device/Device.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "TyndallKernelSources.h"

#include "Device/Sizes.h"

#include <string>
#include <utility>

namespace tyndall
{
ParallelPropagation::ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t temporaryBytes, int channels)
  : TheDevice(device)
  , TheMedium(medium)
  , Outside(illumination)
  , Settings(settings)
  , TheModel(medium, illumination, settings, channels)
  , Traits(TraitsOf(medium))
  , Ledger(medium, this->TheModel.Channels(), settings)
  , Volumes(device, medium, this->TheModel, device.KernelWidth(8, 16))
  , Plan(device, medium.grid, this->TheModel, settings, this->Volumes, temporaryBytes)
  , Sweep(device, this->Volumes, this->Plan, this->TheModel, settings)
  , UpdateSources(device.Kernel("update_sources", kernel_source::PublishedCollect,
      Define("REAL_WIDTH", this->Volumes.Width) + Define("CHANNELS", this->TheModel.Channels()) +
        Define("COLOURED", this->Volumes.Coloured) + Define("MOMENTS", this->TheModel.MomentCount())))
  , Emits(this->Traits.emits || !settings.leaveOut)
{
}

/// Boundary light is incident in the first order only.
void ParallelPropagation::Propagate(int number, const Monitor& monitor)
{
  Batch& batch = this->Plan.batches[number];
  const double batches = static_cast<double>(this->Plan.batches.size());
  if (this->Ledger.Orders() > 0 && this->Settings.periodic[batch.Map().axis])
  {
    // rays continue from their position at the end of the previous order
    this->Plan.MakePasses(batch, this->Ledger.Orders());
  }
  const bool first = this->Ledger.Orders() == 0 && !this->SourceGiven;
  this->Sweep.Begin(batch, first, this->Tally);
  const double passes = static_cast<double>(batch.passes.size());
  for (std::size_t p = 0; p < batch.passes.size(); ++p)
  {
    const auto report = [&](double part) {
      Report(monitor, this->Ledger.Progress((number + (static_cast<double>(p) + part) / passes) / batches));
    };
    this->Sweep.Send(batch, batch.passes[p], !first || this->Emits, this->Tally, report);
  }
  Report(monitor, this->Ledger.Progress((number + 1.0) / batches));
}

void ParallelPropagation::Collect(int number)
{
  const Batch& batch = this->Plan.batches[number];
  this->Sweep.Collect(batch, number == 0 || this->Plan.batches[number - 1].Layout() != batch.Layout());
}

void ParallelPropagation::FinishOrder()
{
  const bool first = this->Ledger.Orders() == 0;
  if (first && this->Outside.uncollided.IsThere())
  {
    this->Volumes.AddGiven(this->Outside.uncollided);
    Add(this->Tally, TallyOf(this->Outside.uncollided, this->TheMedium, 0, this->TheModel.Channels()));
  }
  this->UpdateSourcesOfOrder();
  std::vector<float> fluence = this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0);
  this->Ledger.Count(std::exchange(this->Tally, {}));
  this->Ledger.CloseOrder(fluence);
  this->FluenceDirect = first ? std::move(fluence) : this->FluenceDirect;
  this->Emits = true; // from the second order on the source U is not zero
}

void ParallelPropagation::UpdateSourcesOfOrder()
{
  const PublishedVolumes& volumes = this->Volumes;
  const auto size = [&](int d, int times, int local) {
    return static_cast<std::size_t>(RoundUp(volumes.Layouts.size[d] * times, local));
  };
  this->TheDevice.Queue().enqueueNDRangeKernel(
    With(this->UpdateSources, volumes.Layouts, static_cast<cl_int>(volumes.Parts.Size()), volumes.Parts,
      volumes.Scattering[0], volumes.OrderMoments[0], volumes.OrderMoments[1], volumes.Totals, volumes.Sources[0],
      volumes.Sources[1]),
    cl::NullRange, cl::NDRange(size(0, 1, 32), size(1, 1, 8), size(2, this->TheModel.Channels(), 1)),
    cl::NDRange(32, 8, 1));
}

LightField ParallelPropagation::Result() const
{
  LightField field;
  this->Ledger.WriteTo(field);
  WritePublishedLight(
    this->TheModel, this->TheMedium, this->Traits, this->Outside, this->Settings,
    [this](int k) { return this->Volumes.ReadMoment(this->Volumes.Totals, k); }, field);
  field.fluenceDirect = this->FluenceDirect;
  field.device = this->TheDevice.Name();
  return field;
}

std::vector<std::string> ParallelPropagation::LeftOut() const
{
  std::vector<std::string> words = LeftOutAsPublished(this->Outside);
  if (this->TheModel.Channels() == 1)
  {
    words.emplace_back(left_out::Grey);
  }
  if (!this->Emits)
  {
    words.emplace_back(left_out::NoEmission);
  }
  if (this->TheMedium.phase.IsIsotropic() && this->Traits.scatters)
  {
    words.emplace_back(left_out::Isotropic);
  }
  return words;
}

int ParallelPropagation::FirstDirection(int batch) const
{
  return batch < this->BatchCount() ? this->Plan.batches[batch].first
                                    : static_cast<int>(this->TheModel.Directions().directions.size());
}

void ParallelPropagation::RunOrder(const Monitor& monitor)
{
  for (int batch = 0; batch < this->BatchCount(); ++batch)
  {
    this->Propagate(batch, monitor);
    this->Collect(batch);
  }
  this->FinishOrder();
}

std::vector<std::vector<float>> ParallelPropagation::Contributions(int batch) const
{
  const PublishedVolumes& volumes = this->Volumes;
  const Batch& which = this->Plan.batches[batch];
  const std::size_t size = volumes.LayoutSize(which.Layout());
  std::vector<std::vector<float>> contributions;
  contributions.reserve(which.count);
  for (int i = 0; i < which.count; ++i)
  {
    contributions.push_back(
      volumes.Interleave(which.Layout(), volumes.ReadPart(this->Sweep.Contributions, i * size, size).data()));
  }
  return contributions;
}

void ParallelPropagation::SetContributions(int batch, const std::vector<std::vector<float>>& contributions)
{
  const Batch& which = this->Plan.batches[batch];
  for (int i = 0; i < which.count; ++i)
  {
    const std::vector<float> arranged = this->Volumes.Arrange(which.Layout(), contributions[i].data());
    this->TheDevice.Queue().enqueueWriteBuffer(this->Sweep.Contributions.Handle(), CL_TRUE,
      i * arranged.size() * sizeof(float), arranged.size() * sizeof(float), arranged.data());
  }
}

void ParallelPropagation::SetSource(const std::vector<float>& source)
{
  this->Volumes.WriteSource(source);
  this->SourceGiven = true;
  this->Emits = true;
}

LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, std::size_t temporaryBytes)
{
  Check(medium);
  Check(illumination);
  CheckPublished(medium, illumination); // checked before channels are merged
  const SceneChannels channels(medium, TraitsOf(medium), illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      ParallelPropagation propagation(device, ofChannels, light, settings, temporaryBytes, count);
      do
      {
        propagation.RunOrder(monitor);
      } while (!propagation.Done());
      return propagation.Result();
    });
}
}
