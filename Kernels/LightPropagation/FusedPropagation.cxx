#include "FusedSolver.h"

#include "../Device/Sizes.h"
#include "EmissionRays.h"
#include "EnvironmentPeaks.h"
#include "FirstCollision.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace tyndall
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int MostOrders = 100000;
/// Planes that a ray goes round a periodic axis before it is given up, or waits for the next order.
constexpr int ManyPlanes = 8192;
constexpr int FewPlanes = 256;        ///< the same where there will be more orders as long as it matters
constexpr double MostlyLit = 0.75;    ///< part of the rays from which on sweeps of their own do not pay
constexpr double MostlyFilled = 0.75; ///< the same of voxels
constexpr int OrdersExpected = 6;     ///< to tell whether it pays to sweep empty slabs at the end only

}

LightField FusedSolver::Run(const Monitor& monitor)
{
  this->Start = std::chrono::steady_clock::now();
  this->ChooseAcceleration();
  this->FindOutsideLight();
  this->Load();
  this->Iterating = this->Accelerated;
  this->MakeSweeps();
  if (this->Accelerated)
  {
    this->RunAccelerated(monitor);
  }
  else
  {
    this->RunOrders(monitor);
  }
  this->CheckBalance();
  this->Unload();
  return std::move(this->Result);
}

void FusedSolver::RunOrders(const Monitor& monitor)
{
  int order = 0;
  do
  {
    const Monitor ofOrder =
      monitor ? Monitor([&](double done) { return monitor(this->Progress(order, done)); }) : Monitor();
    if (order == 0)
    {
      this->PropagateLights(ofOrder);
      this->Stranded = this->OnTheWay;
    }
    const bool shone = this->Shining;
    this->PropagateOrder(order, ofOrder);
    if (shone && order > 0 && this->ExtraEscape.Size() > 0)
    {
      this->LetEscape();
    }
    this->CollectOrder(order);
    Report(ofOrder, 1.0);
    ++order;
    this->LitSweeps.clear();
    this->Swept = this->FilledSweeps.empty() ? Part::All : Part::Filled;
  } while (!this->Done(order));
  if (this->Swept == Part::Filled && order > 1)
  {
    this->SweepEmptySlabs(monitor);
  }
  this->ShareEscape();
}

void FusedSolver::Load()
{
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  const std::size_t extinctions = this->SharedExtinction ? 1 : 3;
  const std::size_t all = this->Stride * this->Channels + SweepPadding;
  Device& device = this->TheDevice;
  this->Extinction = Buffer<float>(device, this->Stride * extinctions + SweepPadding, "sigma_t");
  const bool sourceNeeded = this->ScattersAtAll() || this->Traits.emits || this->Accelerated;
  this->Source = Buffer<float>(device, sourceNeeded ? all : SweepPadding, "the scattered light");
  this->Path = Buffer<float>(device, all, "the light gathered");
  this->Fluence = Buffer<float>(device, all, "fluence");
  if (this->Settings.netFlux)
  {
    this->Flux = Buffer<float>(device, 3 * this->Stride * this->Channels + SweepPadding, "net_flux");
    this->Flux.Fill(0.0f);
  }
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);

  std::vector<float> values(all, 0.0f);
  const auto load = [&](Buffer<float>& buffer, std::size_t channels, auto&& value) {
    std::fill(values.begin(), values.end(), 0.0f);
    for (std::size_t c = 0; c < channels; ++c)
    {
      for (std::size_t i = 0; i < voxels; ++i)
      {
        values[c * this->Stride + i] = value(i, static_cast<int>(c));
      }
    }
    buffer.Write(values.data());
  };
  load(this->Extinction, extinctions, [&](std::size_t i, int c) { return this->SigmaT(i, c); });
  if (&this->SigmaSOnDevice() == &this->Scattering)
  {
    this->Scattering = Buffer<float>(device, all, "sigma_s");
    load(this->Scattering, this->Channels, [&](std::size_t i, int c) { return this->SigmaS(i, c); });
  }
  if (this->Traits.emits)
  {
    this->LoadEmission(load);
  }
  else
  {
    this->Source.Fill(0.0f);
  }
  this->Shining = this->Shining || !this->Settings.leaveOut;
}

/// What the coarse directions carry of it is the source; small bright parts go along rays of their own.
template <class Loader>
void FusedSolver::LoadEmission(const Loader& load)
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (this->Settings.emissionError > 0.0 &&
    !(periodic[0] || periodic[1] || periodic[2])) // of whose images there is no end
  {
    this->Emission = Split(this->TheMedium);
  }
  const Field smooth = this->Emission.Smooth(this->TheMedium);
  load(this->Source, this->Channels, [&](std::size_t i, int c) {
    const float emission = this->TheMedium.emission.At(i, c);
    this->Result.balance.emitted[c] += 4.0 * Pi * emission * this->TheMedium.grid.VoxelVolume();
    this->Shining = this->Shining || smooth.At(i, c) > 0.0f;
    return smooth.At(i, c);
  });
}

/// Without absorption sigma_t is sigma_s; without scattering nobody asks.
const Buffer<float>& FusedSolver::SigmaSOnDevice() const
{
  const bool alike = !this->Traits.absorbs && (this->Channels == 1 || !this->SharedExtinction);
  const bool unused = !this->Traits.scatters && !this->Accelerated;
  return this->Settings.leaveOut && (alike || unused) ? this->Extinction : this->Scattering;
}

void FusedSolver::FindOutsideLight()
{
  const int fine = this->Settings.firstFlightDirections;
  if (fine > 0)
  {
    this->FineDirections = SoundDirections(fine, "FirstFlightDirections");
  }
  const SplitEnvironment environment =
    Split(this->Outside.environment, fine > 0 ? this->FineDirections : this->Directions);
  this->FromFarAway = BoundaryRadiance(this->Directions, environment.smooth, this->Outside.sky);
  this->Lights = this->Outside.lights;
  this->Lights.insert(this->Lights.end(), environment.peaks.begin(), environment.peaks.end());
  if (fine > 0)
  {
    this->FindFlight(environment.smooth);
  }
  for (std::size_t d = 0; d < this->FromFarAway.size(); ++d)
  {
    for (int face = 0; face < 6; ++face)
    {
      this->LitFromOutside = this->LitFromOutside || Total(this->Incoming(static_cast<int>(d), face)) > 0.0;
    }
  }
  if (this->LitFromOutside)
  {
    this->CheckRays(this->Directions, this->Starts(), this->BoundaryOfOrder(0));
  }
  if (this->Flight)
  {
    this->CheckRays(this->FineDirections, this->FineStarts(),
      [this](int direction, int face) { return this->Flight->Incoming(direction, face); });
  }
}

/// Directions that are the same by symmetry are one; net flux tells them apart.
std::vector<Bundle> FusedSolver::BundlesOf(int axis) const
{
  const std::vector<Bundle> bundles =
    BundlesAlong(axis, this->TheMedium.grid, this->Settings.periodic, this->Directions, this->Settings.mapResolution,
      this->Starts());
  return this->MergesMirrors() ? this->Mirrors.Standing(bundles) : bundles;
}

FusedSolver::AxisSweeps FusedSolver::SweepsThrough(Part part)
{
  AxisSweeps sweeps;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<Bundle> bundles = this->BundlesOf(axis);
    if (!bundles.empty())
    {
      sweeps.push_back(std::make_unique<AxisSweep>(
        this->TheDevice, this->VolumeOf(0, part), axis, bundles, this->Settings.periodic, this->Workspace));
    }
  }
  return sweeps;
}

void FusedSolver::MakeSweeps()
{
  this->Sweeps = this->SweepsThrough(Part::All);
  if (this->LeavesSlabsOut())
  {
    this->FilledSweeps = this->SweepsThrough(Part::Filled);
  }
  if (this->Settings.leaveOut && this->LitFromOutside && !this->Shining && !this->Accelerated)
  {
    this->MakeLitSweeps();
  }
}

/// Orders after the first go through the box that the medium fills alone: what leaves it does not come back. What they
/// are outside of it is found at the end, for all of them in one sweep. Rays round a periodic axis would be on the way in both.
bool FusedSolver::LeavesSlabsOut() const
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (!this->Settings.leaveOut || this->Accelerated || !this->Traits.scatters || periodic[0] || periodic[1] ||
    periodic[2])
  {
    return false;
  }
  const double filled =
    static_cast<double>(this->Traits.filled.VoxelCount()) / static_cast<double>(this->TheMedium.grid.VoxelCount());
  const int later = (this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : OrdersExpected) - 1;
  return filled < MostlyFilled && later * (1.0 - filled) > 1.0;
}

/// Sweeps of the directions alone from which light comes. Those of a periodic axis stay as they are: rays wait in them for the
/// next order.
void FusedSolver::MakeLitSweeps()
{
  const auto isLit = [this](int direction) {
    double most = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int face = 2 * axis + (this->Directions.directions[direction].omega[axis] > 0.0 ? 0 : 1);
      most = std::max(most, this->Settings.periodic[axis] ? 0.0 : Total(this->Incoming(direction, face)));
    }
    return most > 0.0;
  };
  double all = 0.0, lit = 0.0;
  AxisSweeps sweeps;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<Bundle> bundles = this->BundlesOf(axis);
    if (this->Settings.periodic[axis])
    {
      return;
    }
    all += CountRays(bundles);
    for (int way = 0; way < 2; ++way)
    {
      const std::vector<Bundle> ofWay = LitRays(bundles, way, isLit);
      lit += CountRays(ofWay);
      if (!ofWay.empty())
      {
        sweeps.push_back(std::make_unique<AxisSweep>(
          this->TheDevice, this->VolumeOf(0, Part::All), axis, ofWay, this->Settings.periodic, this->Workspace));
      }
    }
  }
  if (lit <= MostlyLit * all)
  {
    this->LitPart = lit / all;
    this->LitSweeps = std::move(sweeps);
  }
}

/// Radiance, in the mean over the directions that this one stands for.
Rgb FusedSolver::Incoming(int direction, int face) const
{
  if (this->Flight)
  {
    return this->UsualFlight ? this->UsualFlight->Incoming(direction, face) : Rgb{};
  }
  Rgb radiance = this->Outside.faces[face];
  const std::vector<int> itself = { direction };
  const std::vector<int>& all = this->MergesMirrors() ? this->Mirrors.AllOf(direction) : itself;
  for (const int one : all)
  {
    for (int c = 0; c < 3; ++c)
    {
      radiance[c] += this->FromFarAway[one][c] / static_cast<double>(all.size());
    }
  }
  return radiance;
}

SweepBoundary FusedSolver::BoundaryOfOrder(int order) const
{
  const bool dark = !this->LitFromOutside && this->Settings.leaveOut;
  if (order > 0 || dark)
  {
    return {};
  }
  return [this](int direction, int face) { return this->Incoming(direction, face); };
}

/// Do something to the volume: for all channels at once where they share sigma_t, else for one after the other. `act`
/// takes the volume and the first of its channels.
void FusedSolver::ForChannels(const std::function<void(const SweepVolume&, int)>& act)
{
  const int rounds = this->SharedExtinction ? 1 : this->Channels;
  for (int round = 0; round < rounds; ++round)
  {
    act(this->VolumeOf(round, this->Swept), round);
  }
}

/// The channels from `first` on that share sigma_t.
SweepVolume FusedSolver::VolumeOf(int first, Part part) const
{
  SweepVolume volume;
  volume.grid = this->TheMedium.grid;
  volume.box = part == Part::Filled ? this->Traits.filled : VoxelBox{};
  volume.channels = this->SharedExtinction ? this->Channels : 1;
  volume.stride = this->Stride;
  volume.sigma_t = &this->Extinction;
  volume.sigma_t_first = first * this->Stride;
  volume.source = &this->Source;
  volume.path = &this->Path;
  const bool flux = this->Settings.netFlux && !this->Iterating && part != Part::Filled; // the sweep at the end knows it
  volume.flux = flux ? &this->Flux : nullptr;
  volume.entering = this->Iterating ? &this->Entering : nullptr;
  volume.nearness = this->Nearness.Size() > 0 ? &this->Nearness : nullptr;
  volume.first = first * this->Stride;
  return volume;
}

void FusedSolver::Count(const SweepTally& tally, int firstChannel, int channels)
{
  for (int c = 0; c < channels; ++c)
  {
    for (int face = 0; face < 6; ++face)
    {
      this->Result.balance.entered[firstChannel + c] += tally.in[face][c];
      this->Result.balance.escaped[firstChannel + c] += this->Swept == Part::Empty ? 0.0 : tally.out[face][c];
      this->Result.facePowerOut[face][firstChannel + c] += this->Swept == Part::Filled ? 0.0 : tally.out[face][c];
    }
    this->OnTheWay[firstChannel + c] += tally.onTheWay[c];
  }
}

void FusedSolver::PropagateLights(const Monitor& monitor)
{
  for (const Light& light : this->Lights)
  {
    this->ForChannels([&](const SweepVolume& volume, int first) {
      Light ofChannels = light;
      ofChannels.power = From(light.power, first);
      SweepVolume own = volume;
      if (volume.nearness)
      {
        this->Nearness.Fill(0.0f);
        this->LampPath.Fill(0.0f);
        own.path = &this->LampPath;
      }
      this->Count(DepositLight(this->TheDevice, own, ofChannels, this->Settings.periodic, this->Workspace, monitor),
        first, volume.channels);
      if (volume.nearness)
      {
        this->PassLight(first, volume.channels);
      }
    });
  }
  this->PropagateFlight(monitor);
  if (this->Settings.firstFlightDirections > 0 && !this->Accelerated && this->Traits.scatters)
  {
    this->FindExtraEscape(monitor); // whatever shines: lights add up
  }
  this->PropagatePeaks(monitor);
}

/// Small bright parts of the medium.
void FusedSolver::PropagatePeaks(const Monitor& monitor)
{
  for (const EmissionPeak& peak : this->Emission.peaks)
  {
    this->ForChannels([&](const SweepVolume& volume, int first) {
      this->Count(DepositEmission(this->TheDevice, volume, first, peak, this->Settings.emissionError, monitor), first,
        volume.channels);
    });
  }
}

void FusedSolver::PropagateOrder(int order, const Monitor& monitor)
{
  const SweepBoundary boundary = this->BoundaryOfOrder(order);
  const bool nothing = !boundary && !this->Shining && Total(this->OnTheWay) == 0.0;
  this->OnTheWay = {};
  if (nothing)
  {
    return;
  }
  const AxisSweeps& sweeps = this->Swept == Part::Filled ? this->FilledSweeps
    : order == 0 && !this->LitSweeps.empty()             ? this->LitSweeps
                                                         : this->Sweeps;
  this->PropagateSweeps(sweeps, boundary, this->Settings.maximumOrders > 0 ? ManyPlanes : FewPlanes, monitor);
}

/// What the orders after the first are in the voxels around the medium, and through which faces it leaves: one sweep of all
/// that was scattered but what the last order left over.
void FusedSolver::SweepEmptySlabs(const Monitor& monitor)
{
  const double perVolume = 1.0 / this->TheMedium.grid.VoxelVolume();
  const VoxelBox& filled = this->Traits.filled;
  const auto run = [&](cl::Kernel kernel) {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Stride, this->Channels));
  };
  cl::Kernel gather = this->TheDevice.Kernel("gather_scattered", { kernel_source::Numerics, kernel_source::Collect });
  run(With(gather, this->Fluence, this->Source, this->SigmaSOnDevice(), cl_ulong(this->Stride)));
  this->Swept = Part::Empty;
  this->Shining = true;
  this->PropagateSweeps(this->Sweeps, {}, ManyPlanes, monitor);
  cl::Kernel add = this->TheDevice.Kernel("add_outside", { kernel_source::Numerics, kernel_source::Collect });
  const std::array<int, 3>& n = this->TheMedium.grid.size;
  run(With(add, this->Path, this->Fluence, cl_ulong(this->Stride), static_cast<float>(perVolume),
    cl_int3{ { n[0], n[1], n[2] } }, cl_int3{ { filled.first[0], filled.first[1], filled.first[2] } },
    cl_int3{ { filled.size[0], filled.size[1], filled.size[2] } }));
}

void FusedSolver::PropagateSweeps(
  const AxisSweeps& sweeps, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor)
{
  this->ForChannels([&](const SweepVolume& volume, int first) {
    const SweepBoundary ofChannels = boundary && first > 0
      ? SweepBoundary([&](int direction, int face) { return From(boundary(direction, face), first); })
      : boundary;
    for (std::size_t s = 0; s < sweeps.size(); ++s)
    {
      const double before = static_cast<double>(first * sweeps.size() + s);
      const double all = static_cast<double>(sweeps.size()) * this->Channels / volume.channels;
      const Monitor ofSweep =
        monitor ? Monitor([&](double done) { return monitor((before + done) / all); }) : Monitor();
      sweeps[s]->Start(volume, ofChannels, this->Shining, mostPlanes, ofSweep);
    }
    for (const std::unique_ptr<AxisSweep>& sweep : sweeps)
    {
      this->Count(sweep->Finish(), first, volume.channels);
    }
  });
}

/// The values of a channel that a sweep may have changed: whole vectors.
std::array<std::size_t, 2> FusedSolver::SweptValues() const
{
  if (this->Swept != Part::Filled)
  {
    return { 0, this->Stride };
  }
  const std::array<int, 3>& n = this->TheMedium.grid.size;
  const std::size_t layer = static_cast<std::size_t>(n[0]) * n[1];
  const VoxelBox& filled = this->Traits.filled;
  return { layer * filled.first[2] / SweepPadding * SweepPadding,
    RoundUp(layer * (filled.first[2] + filled.size[2]), SweepPadding) };
}

void FusedSolver::CollectOrder(int order)
{
  const int vector = this->TheDevice.FloatVectorWidth() >= 8 ? 8 : 4;
  cl::Kernel kernel = this->TheDevice.Kernel("collect", { kernel_source::Numerics, kernel_source::Collect },
    "-DREAL_WIDTH=" + std::to_string(vector) + " -DSCATTERS=" + std::to_string(this->ScattersAtAll()));
  const auto [begin, end] = this->SweptValues();
  const std::size_t chunks = (end - begin + CollectChunk - 1) / CollectChunk;
  Buffer<cl_float2> tally(this->TheDevice, chunks * this->Channels, "sums");
  With(kernel, this->Path, this->Fluence, this->Source, this->Extinction, this->SigmaSOnDevice(), tally,
    cl_ulong(this->Stride), cl_ulong(begin), cl_ulong(end), cl_int(this->SharedExtinction),
    static_cast<float>(1.0 / this->TheMedium.grid.VoxelVolume()));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(chunks, this->Channels), cl::NDRange(1, 1));
  this->Scattered = {};
  const std::vector<cl_float2> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    this->Result.balance.absorbed[i / chunks] += sums[i].s[0];
    this->Scattered[i / chunks] += sums[i].s[1];
  }
  for (int c = 0; c < 3; ++c)
  {
    this->Result.balance.leftOver[c] = this->Scattered[c] + this->OnTheWay[c] + this->Stranded[c];
  }
  this->Shining = Total(this->Scattered) > 0.0;
  this->EstimateResidual(order);
  if (order == 0)
  {
    this->Result.fluenceDirect = this->Interleaved(this->Fluence, 1.0);
  }
  this->AddRow(order, Total(this->AllScattered) > 0.0 ? Total(this->Scattered) / Total(this->AllScattered) : 0.0);
}

void FusedSolver::AddRow(int iteration, double change)
{
  this->Result.convergence.push_back({ iteration,
    std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count(), this->Residual, change,
    Total(this->Result.balance.absorbed), Total(this->Result.balance.escaped), Total(this->Result.balance.leftOver) });
}

/// What the orders to come will add to the light that is scattered, over what there is: the rest of a geometric series, as
/// orders fall off like one in the end. Its ratio grows towards that, so its last growth is added. The worst channel counts.
void FusedSolver::EstimateResidual(int order)
{
  this->Residual = 0.0;
  for (int c = 0; c < this->Channels; ++c)
  {
    const double now = this->Scattered[c] + this->OnTheWay[c];
    this->AllScattered[c] += now;
    if (now == 0.0)
    {
      continue;
    }
    const double ratio = order > 0 ? now / this->LastScattered[c] : 1.0;
    const double growth = order > 1 ? std::max(0.0, ratio - this->Ratio[c]) : 0.0;
    const double limit = std::min(ratio + growth, 1.0 - 1e-9);
    this->Residual = std::max(this->Residual, now / this->AllScattered[c] * limit / (1.0 - limit));
    this->Ratio[c] = ratio;
    this->LastScattered[c] = now;
  }
  this->Residual =
    order == 0 ? std::min(this->Residual, 1.0) : this->Residual; // one order says nothing of those to come
}

bool FusedSolver::Done(int orders) const
{
  if (this->Residual == 0.0 || orders >= MostOrders)
  {
    return true;
  }
  return this->Settings.maximumOrders > 0 ? orders >= this->Settings.maximumOrders
                                          : orders > 2 && this->Residual <= this->Settings.tolerance;
}

/// Orders are counted where their number is known, else the logarithm of the residual tells how far the solve is.
double FusedSolver::Progress(int order, double done) const
{
  if (this->Settings.maximumOrders > 0)
  {
    return (order + done) / this->Settings.maximumOrders;
  }
  const double way = std::log(std::clamp(this->Residual, 1e-12, 1.0)) / std::log(this->Settings.tolerance);
  return std::clamp(std::max(way, 1.0 - 1.0 / (1.0 + 0.05 * (order + done))), 0.0, 0.99);
}

std::vector<float> FusedSolver::Interleaved(const Buffer<float>& planar, double scale) const
{
  const std::vector<float> values = planar.Read();
  const std::size_t parts = (values.size() - SweepPadding) / this->Stride;
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  std::vector<float> interleaved(voxels * parts);
  for (std::size_t p = 0; p < parts; ++p)
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      interleaved[i * parts + p] = static_cast<float>(values[p * this->Stride + i] * scale);
    }
  }
  return interleaved;
}

/// What the scene did not need, in words for the user.
std::vector<std::string> FusedSolver::LeftOut() const
{
  std::vector<std::string> words;
  if (this->TheMedium.g != 0.0 && this->Traits.scatters)
  {
    words.push_back("anisotropy: solved as isotropic scattering with sigma_s (1 - g), g = " +
      std::to_string(this->TheMedium.g) + " (similarity relation)");
  }
  if (this->Settings.leaveOut)
  {
    this->SayWhatIsLeftOut(words);
  }
  if (!this->Accelerated)
  {
    words.push_back("acceleration: few scattering orders do");
  }
  if (!this->Settings.netFlux)
  {
    words.push_back(left_out::NetFlux);
  }
  return words;
}

/// Of the scene's traits, but that one channel does for three.
void FusedSolver::SayWhatIsLeftOut(std::vector<std::string>& words) const
{
  const auto say = [&](bool condition, const std::string& text) {
    if (condition)
    {
      words.push_back(text);
    }
  };
  say(this->Channels == 3 && this->SharedExtinction, left_out::GreyExtinction);
  say(this->TheMedium.g == 0.0 && this->Traits.scatters, left_out::Isotropic);
  say(!this->Traits.scatters, left_out::NoScattering);
  say(!this->Traits.absorbs, left_out::NoAbsorption);
  say(!this->Traits.emits, left_out::NoEmission);
  say(!this->LitFromOutside && !this->Flight, left_out::DarkOutside);
  say(this->Settings.firstFlightDirections > 0 && this->LitFromOutside && !this->Flight, left_out::EvenOutside);
  say(this->Lights.empty(), left_out::NoLights);
  say(this->Traits.emits && this->Emission.peaks.empty(), left_out::NoEmissionPeaks);
  say(this->Traits.scatters && this->Result.convergence.size() == 1, left_out::OneOrder);
  say(!this->FilledSweeps.empty(), left_out::EmptySlabs(this->Traits.filled, this->TheMedium.grid));
  say(this->LitPart < 1.0, left_out::DarkDirections(this->LitPart));
  say(this->MergesMirrors() && this->Mirrors.Any(),
    left_out::MirrorImages(this->Mirrors.Count(), static_cast<int>(this->Directions.directions.size())));
}

void FusedSolver::Unload()
{
  LightField& light = this->Result;
  light.channels = this->Channels;
  light.fluence = this->Interleaved(this->Fluence, 1.0);
  if (this->Settings.netFlux)
  {
    light.netFlux = this->Interleaved(this->Flux, 1.0 / this->TheMedium.grid.VoxelVolume());
  }
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.leftOut = this->LeftOut();
  light.halfRangeFlux = HalfRangeFlux(this->Flight && !this->UsualFlight ? this->FineDirections : this->Directions);
  light.device = this->TheDevice.Name();
}
}
