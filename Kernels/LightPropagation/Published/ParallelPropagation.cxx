#include "LightPropagation/Published/ParallelPropagation.h"

#include "Device/Defines.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedBorders.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedLight.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedSweep.h"
#include "LightPropagation/Published/PublishedVolumes.h"
#include "LightPropagation/Published/PublishedWarmStart.h"
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
using Pass = PublishedPlan::Pass;
}

struct ParallelPropagation::Implementation
{
  Implementation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes, int channels, const KeptLight* kept)
    : TheDevice(device)
    , TheMedium(medium)
    , Outside(illumination)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Traits(TraitsOf(medium))
    , Ledger(medium, this->Model, settings)
    , Channels(this->Model.Channels())
    , Volumes(device, medium, this->Model, device.KernelWidth(8, 16))
    , Plan(device, medium.grid, this->Model, settings, this->Volumes, temporaryBytes)
    , Borders(this->Model, settings, this->Plan)
    , Faces(medium.grid, this->Model, settings)
    , Warm(
        { medium, this->Model, this->Settings, medium.grid, static_cast<std::size_t>(this->Volumes.Layouts.volume[0]) },
        kept)
    , Sweep(
        device, this->Volumes, this->Model, settings, this->Plan.sizes, this->Faces.Count() ? this->Faces.Cells() : 0)
    , UpdateSources(device.Kernel("update_sources", kernel_source::PublishedCollect,
        Define("REAL_WIDTH", this->Volumes.Width) + Define("CHANNELS", this->Channels) +
          Define("COLOURED", this->Volumes.Coloured) + Define("MOMENTS", this->Model.MomentCount())))
    , Emits(this->Traits.emits || !settings.leaveOut)
  {
  }

  // One order
  bool FirstOrder() const { return this->Ledger.Orders() == 0 && !this->SourceGiven; }
  void Propagate(int number, const Monitor& monitor);
  void Collect(int number);
  void FinishOrder();
  void UpdateSourcesOfOrder();
  void LookAtDirect();
  void BeginFrom(const std::vector<float>& moments);

  // What came of it
  LightField Result() const;

  Device& TheDevice;
  const Medium& TheMedium;
  Illumination Outside;
  PropagationSettings Settings;
  PublishedModel Model;
  MediumTraits Traits;
  OrderLedger Ledger;
  int Channels;
  PublishedVolumes Volumes;
  PublishedPlan Plan;
  PublishedBorders Borders;
  PublishedFaces Faces;
  PublishedWarmStart Warm;
  PublishedSweep Sweep;
  cl::Kernel UpdateSources;
  SweepTally Tally; ///< of the order that runs
  bool Emits;       ///< U is not zero
  bool SourceGiven = false;
  std::vector<float> FluenceDirect;
};

/// Light from outside belongs to the first order.
void ParallelPropagation::Implementation::Propagate(int number, const Monitor& monitor)
{
  Batch& batch = this->Plan.batches[number];
  const double batches = static_cast<double>(this->Plan.batches.size());
  const bool goesOn = this->Settings.periodic[batch.Map().axis];
  if (this->Ledger.Orders() > 0 && goesOn)
  {
    this->Plan.MakePasses(batch, this->Ledger.Orders()); // rays go on from where they were
  }
  const bool first = this->FirstOrder();
  this->Sweep.Begin(first ? this->Borders.Radiance(batch) : std::vector<float>(), this->Faces.Radiance());
  if (first)
  {
    this->Borders.TallyEntered(batch, this->Tally);
  }
  const double passes = static_cast<double>(batch.passes.size());
  for (std::size_t p = 0; p < batch.passes.size(); ++p)
  {
    const auto report = [&](double part) {
      Report(monitor, this->Ledger.Progress((number + (static_cast<double>(p) + part) / passes) / batches));
    };
    const std::vector<float> escaped = this->Sweep.Send(
      this->Volumes, this->Plan, batch, batch.passes[p], { goesOn, goesOn }, !first || this->Emits, report);
    this->Borders.TallyEscaped(batch, escaped, this->Tally);
  }
  if (this->Faces.Count())
  {
    this->Borders.TallyLeft(batch, this->Sweep.LeftThroughCells(), this->Faces);
  }
  Report(monitor, this->Ledger.Progress((number + 1.0) / batches));
}

void ParallelPropagation::Implementation::Collect(int number)
{
  const Batch& batch = this->Plan.batches[number];
  const bool begins = number == 0 || this->Plan.batches[number - 1].Layout() != batch.Layout();
  this->Sweep.Collect(this->Volumes, this->Plan, batch, begins);
}

void ParallelPropagation::Implementation::FinishOrder()
{
  if (this->Ledger.Orders() == 1 && this->Warm.Begins())
  {
    std::vector<float> moments = this->Volumes.OrderMoments[0].Read();
    this->Warm.TakeFrom(moments);
    this->Volumes.OrderMoments[0].Write(moments.data());
  }
  if (this->Ledger.Orders() == 0 && this->Outside.uncollided.IsThere())
  {
    this->Volumes.AddGiven(this->Outside.uncollided);
    Add(this->Tally, TallyOf(this->Outside.uncollided, this->TheMedium, 0, this->Channels));
  }
  this->UpdateSourcesOfOrder();
  if (this->Ledger.Orders() == 0)
  {
    this->LookAtDirect();
  }
  this->Ledger.Count(std::exchange(this->Tally, {}));
  this->Faces.CloseOrder(this->Ledger);
  this->Ledger.CloseOrder(
    SumsOf(this->TheMedium, this->Channels, this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0).data()));
  std::swap(this->Sweep.Carried[0], this->Sweep.Carried[1]);
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
    cl::NullRange, cl::NDRange(size(0, 1, 32), size(1, 1, 8), size(2, this->Channels, 1)), cl::NDRange(32, 8, 1));
}

void ParallelPropagation::Implementation::LookAtDirect()
{
  this->FluenceDirect = this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0);
  if (this->Warm.Keeps())
  {
    std::vector<float> moments = this->Volumes.OrderMoments[0].Read();
    this->Warm.AddTo(moments, this->Faces, this->FluenceDirect);
    this->BeginFrom(moments);
  }
}

/// @param moments  of the first order, with a guess where there is one
void ParallelPropagation::Implementation::BeginFrom(const std::vector<float>& moments)
{
  if (this->Warm.Begins())
  {
    this->Volumes.OrderMoments[0].Write(moments.data());
    this->Volumes.OrderMoments[1].Fill(0.0f); // it is in the other already
    this->Volumes.Totals.Fill(0.0f);
    this->UpdateSourcesOfOrder();
    this->Ledger.BeginWarm(this->Warm.Rate());
  }
}

LightField ParallelPropagation::Implementation::Result() const
{
  LightField field;
  const auto moment = [this](int k) { return this->Volumes.ReadMoment(this->Volumes.Totals, k); };
  TakeMoments(this->Model, this->Settings.netFlux, moment, field);
  field.fluenceDirect = this->FluenceDirect;
  this->Ledger.WriteTo(field);
  this->Faces.WriteTo(field);
  field.leftOut = LeftOutAsPublished(this->TheMedium.phase.IsIsotropic(), this->Traits,
    this->Outside.uncollided.IsThere(), this->Outside, this->Settings, this->Ledger.Orders());
  if (this->Warm.Keeps())
  {
    field.leftOut.push_back(this->Warm.Words());
  }
  field.halfRangeFlux = HalfRangeFlux(this->Model.Directions());
  field.device = this->TheDevice.Name();
  JudgeConvergence(this->Settings, field, false);
  WarnAboutInputLight(this->Outside, field);
  return field;
}

ParallelPropagation::ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t temporaryBytes, int channels, const KeptLight* kept)
  : Inner(std::make_unique<Implementation>(device, medium, illumination, settings, temporaryBytes, channels, kept))
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

KeptLight ParallelPropagation::Left() const
{
  return this->Inner->Warm.Leave(this->Inner->Volumes.Totals.Read(), this->Inner->Faces, this->Inner->Ledger.Rate());
}

bool ParallelPropagation::BeganWarm() const
{
  return this->Inner->Warm.Begins();
}

LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, std::size_t temporaryBytes, KeptLight* kept)
{
  Check(medium);
  CheckPublishedPhase(medium); // before channels become one
  Check(illumination);
  const SceneChannels channels(medium, TraitsOf(medium), illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      ParallelPropagation propagation(device, ofChannels, light, settings, temporaryBytes, count, kept);
      do
      {
        propagation.RunOrder(monitor);
      } while (!propagation.Done());
      LightField found = propagation.Result();
      if (kept)
      {
        Keep(propagation.Left(), propagation.BeganWarm(), found, *kept);
      }
      return found;
    });
}
}
