#include "LightPropagation/Published/ParallelPropagation.h"

#include "Device/Defines.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedSweep.h"
#include "LightPropagation/Published/PublishedVolumes.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "TyndallKernelSources.h"

#include "Device/Sizes.h"

#include <string>
#include <utility>

namespace tyndall
{
namespace
{
using Batch = PublishedPlan::Batch;
}

struct ParallelPropagation::Implementation
{
  Implementation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes, int channels)
    : TheDevice(device)
    , TheMedium(medium)
    , Outside(illumination)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Traits(TraitsOf(medium))
    , Ledger(medium, this->Model.Channels(), settings)
    , Volumes(device, medium, this->Model, device.KernelWidth(8, 16))
    , Plan(device, medium.grid, this->Model, settings, this->Volumes, temporaryBytes)
    , Sweep(device, this->Volumes, this->Plan, this->Model, settings)
    , UpdateSources(device.Kernel("update_sources", kernel_source::PublishedCollect,
        Define("REAL_WIDTH", this->Volumes.Width) + Define("CHANNELS", this->Model.Channels()) +
          Define("COLOURED", this->Volumes.Coloured) + Define("MOMENTS", this->Model.MomentCount())))
    , Emits(this->Traits.emits || !settings.leaveOut)
  {
  }

  void Propagate(int number, const Monitor& monitor);
  void Collect(int number);
  void FinishOrder();
  void UpdateSourcesOfOrder();
  LightField Result() const;

  Device& TheDevice;
  const Medium& TheMedium;
  Illumination Outside;
  PropagationSettings Settings;
  PublishedModel Model;
  MediumTraits Traits;
  OrderLedger Ledger;
  PublishedVolumes Volumes;
  PublishedPlan Plan;
  PublishedSweep Sweep;
  cl::Kernel UpdateSources;
  SweepTally Tally; ///< of the current order
  bool Emits;       ///< U is not zero
  bool SourceGiven = false;
  std::vector<float> FluenceDirect;
};

/// Light is incident on the boundary in the first order.
void ParallelPropagation::Implementation::Propagate(int number, const Monitor& monitor)
{
  Batch& batch = this->Plan.batches[number];
  const double batches = static_cast<double>(this->Plan.batches.size());
  if (this->Ledger.Orders() > 0 && this->Settings.periodic[batch.Map().axis])
  {
    this->Plan.MakePasses(batch, this->Ledger.Orders()); // rays continue from their last place
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

void ParallelPropagation::Implementation::Collect(int number)
{
  const Batch& batch = this->Plan.batches[number];
  this->Sweep.Collect(batch, number == 0 || this->Plan.batches[number - 1].Layout() != batch.Layout());
}

void ParallelPropagation::Implementation::FinishOrder()
{
  const bool first = this->Ledger.Orders() == 0;
  if (first && this->Outside.uncollided.IsThere())
  {
    this->Volumes.AddGiven(this->Outside.uncollided);
    Add(this->Tally, TallyOf(this->Outside.uncollided, this->TheMedium, 0, this->Model.Channels()));
  }
  this->UpdateSourcesOfOrder();
  std::vector<float> fluence = this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0);
  this->Ledger.Count(std::exchange(this->Tally, {}));
  this->Ledger.CloseOrder(fluence);
  this->FluenceDirect = first ? std::move(fluence) : this->FluenceDirect;
  this->Emits = true; // from now on U is not zero
}

void ParallelPropagation::Implementation::UpdateSourcesOfOrder()
{
  const PublishedVolumes& volumes = this->Volumes;
  const auto size = [&](int d, int times, int local) {
    return static_cast<std::size_t>(RoundUp(volumes.Layouts.size[d] * times, local));
  };
  this->TheDevice.Queue().enqueueNDRangeKernel(
    With(this->UpdateSources, volumes.Layouts, static_cast<cl_int>(volumes.Parts.Size()), volumes.Parts,
      volumes.Scattering[0], volumes.OrderMoments[0], volumes.OrderMoments[1], volumes.Totals, volumes.Sources[0],
      volumes.Sources[1]),
    cl::NullRange, cl::NDRange(size(0, 1, 32), size(1, 1, 8), size(2, this->Model.Channels(), 1)),
    cl::NDRange(32, 8, 1));
}

LightField ParallelPropagation::Implementation::Result() const
{
  LightField field;
  this->Ledger.WriteTo(field);
  WritePublishedLight(
    this->Model, this->TheMedium, this->Traits, this->Outside, this->Settings,
    [this](int k) { return this->Volumes.ReadMoment(this->Volumes.Totals, k); }, field);
  field.fluenceDirect = this->FluenceDirect;
  field.device = this->TheDevice.Name();
  return field;
}

ParallelPropagation::ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t temporaryBytes, int channels)
  : Inner(std::make_unique<Implementation>(device, medium, illumination, settings, temporaryBytes, channels))
{
}

ParallelPropagation::~ParallelPropagation() = default;

const PublishedModel& ParallelPropagation::Model() const
{
  return this->Inner->Model;
}

int ParallelPropagation::BatchCount() const
{
  return static_cast<int>(this->Inner->Plan.batches.size());
}

int ParallelPropagation::FirstDirection(int batch) const
{
  return batch < this->BatchCount() ? this->Inner->Plan.batches[batch].first
                                    : static_cast<int>(this->Model().Directions().directions.size());
}

void ParallelPropagation::Propagate(int batch, const Monitor& monitor)
{
  this->Inner->Propagate(batch, monitor);
}

void ParallelPropagation::Collect(int batch)
{
  this->Inner->Collect(batch);
}

void ParallelPropagation::FinishOrder()
{
  this->Inner->FinishOrder();
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

bool ParallelPropagation::Done() const
{
  return this->Inner->Ledger.Done();
}

std::vector<std::vector<float>> ParallelPropagation::Contributions(int batch) const
{
  const PublishedVolumes& volumes = this->Inner->Volumes;
  const Batch& which = this->Inner->Plan.batches[batch];
  const std::size_t size = volumes.LayoutSize(which.Layout());
  std::vector<std::vector<float>> contributions;
  contributions.reserve(which.count);
  for (int i = 0; i < which.count; ++i)
  {
    contributions.push_back(
      volumes.Interleave(which.Layout(), volumes.ReadPart(this->Inner->Sweep.Contributions, i * size, size).data()));
  }
  return contributions;
}

void ParallelPropagation::SetContributions(int batch, const std::vector<std::vector<float>>& contributions)
{
  const Batch& which = this->Inner->Plan.batches[batch];
  for (int i = 0; i < which.count; ++i)
  {
    const std::vector<float> arranged = this->Inner->Volumes.Arrange(which.Layout(), contributions[i].data());
    this->Inner->TheDevice.Queue().enqueueWriteBuffer(this->Inner->Sweep.Contributions.Handle(), CL_TRUE,
      i * arranged.size() * sizeof(float), arranged.size() * sizeof(float), arranged.data());
  }
}

std::vector<float> ParallelPropagation::Source() const
{
  return this->Inner->Volumes.ReadSource();
}

void ParallelPropagation::SetSource(const std::vector<float>& source)
{
  this->Inner->Volumes.WriteSource(source);
  this->Inner->SourceGiven = true;
  this->Inner->Emits = true;
}

LightField ParallelPropagation::Result() const
{
  return this->Inner->Result();
}

LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, std::size_t temporaryBytes)
{
  Check(medium);
  Check(illumination);
  CheckPublished(medium, illumination); // before channels become one
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
