#include "FusedSolver.h"

#include "EnvironmentPeaks.h"
#include "FirstCollision.h"
#include "PowerUnit.h"
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
constexpr std::size_t Chunk = 4096; ///< as in Collect.cl
constexpr int MostOrders = 100000;
/// Planes that a ray goes round a periodic axis before it is given up, or waits for the next order.
constexpr int ManyPlanes = 8192;
constexpr int FewPlanes = 256; ///< the same where there will be more orders as long as it matters

}

LightField FusedSolver::Run(const Monitor& monitor)
{
  this->Start = std::chrono::steady_clock::now();
  this->ChooseAcceleration();
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
    const Rgb ofLamps = this->Result.balance.entered;
    this->PropagateOrder(order, ofOrder);
    if (order == 0)
    {
      this->CheckEntering(ofLamps);
    }
    this->CollectOrder(order);
    Report(ofOrder, 1.0);
    ++order;
  } while (!this->Done(order));
}

int FusedSolver::NeededChannels(const Medium& medium, const Illumination& illumination)
{
  const auto coloured = [](const Rgb& rgb) { return rgb[0] != rgb[1] || rgb[1] != rgb[2]; };
  bool colour = medium.Channels() == 3 || coloured(illumination.sky);
  for (const Light& light : illumination.lights)
  {
    colour = colour || coloured(light.power);
  }
  for (const Rgb& face : illumination.faces)
  {
    colour = colour || coloured(face);
  }
  const std::vector<float>& radiance = illumination.environment.radiance;
  for (std::size_t i = 0; i + 2 < radiance.size() && !colour; i += 3)
  {
    colour = radiance[i] != radiance[i + 1] || radiance[i + 1] != radiance[i + 2];
  }
  return colour ? 3 : 1;
}

/// A coloured medium often has a grey sigma_t all the same: the same density, only the albedo has colour.
void FusedSolver::FindSharedExtinction()
{
  if (this->Channels == 1 || this->SharedExtinction)
  {
    this->SharedExtinction = true;
    return;
  }
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const float grey = this->SigmaT(i, 0);
    const float tolerance = 2e-7f * grey;
    if (std::abs(this->SigmaT(i, 1) - grey) > tolerance || std::abs(this->SigmaT(i, 2) - grey) > tolerance)
    {
      return;
    }
  }
  this->SharedExtinction = true;
}

void FusedSolver::Load()
{
  this->FindSharedExtinction();
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  const std::size_t extinctions = this->SharedExtinction ? 1 : 3;
  const std::size_t all = this->Stride * this->Channels + SweepPadding;
  Device& device = this->TheDevice;
  this->Extinction = Buffer<float>(device, this->Stride * extinctions + SweepPadding, "sigma_t");
  this->Scattering = Buffer<float>(device, all, "sigma_s");
  this->Source = Buffer<float>(device, all, "the scattered light");
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
  load(this->Scattering, this->Channels, [&](std::size_t i, int c) { return this->SigmaS(i, c); });
  load(this->Source, this->Channels, [&](std::size_t i, int c) {
    const float emission = this->TheMedium.emission.At(i, c);
    this->Result.balance.emitted[c] += 4.0 * Pi * emission * this->TheMedium.grid.VoxelVolume();
    return emission;
  });
  this->Shining = Total(this->Result.balance.emitted) > 0.0;
}

void FusedSolver::MakeSweeps()
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<Bundle> bundles =
      BundlesAlong(axis, this->TheMedium.grid, this->Directions, this->Settings.mapResolution);
    if (!bundles.empty())
    {
      this->Sweeps.push_back(std::make_unique<AxisSweep>(
        this->TheDevice, this->VolumeOf(0), axis, bundles, this->Settings.periodic, this->Workspace));
    }
  }
  const SplitEnvironment environment = Split(this->Outside.environment, this->Directions);
  this->FromFarAway = BoundaryRadiance(this->Directions, environment.smooth, this->Outside.sky);
  this->Lights = this->Outside.lights;
  this->Lights.insert(this->Lights.end(), environment.peaks.begin(), environment.peaks.end());
  for (const Rgb& radiance : this->FromFarAway)
  {
    this->LitFromOutside = this->LitFromOutside || Total(radiance) > 0.0;
  }
  for (const Rgb& radiance : this->Outside.faces)
  {
    this->LitFromOutside = this->LitFromOutside || Total(radiance) > 0.0;
  }
}

SweepBoundary FusedSolver::BoundaryOfOrder(int order) const
{
  if (order > 0 || !this->LitFromOutside)
  {
    return {};
  }
  return [this](int direction, int face) {
    Rgb radiance = this->FromFarAway[direction];
    for (int c = 0; c < 3; ++c)
    {
      radiance[c] += this->Outside.faces[face][c];
    }
    return radiance;
  };
}

/// Do something to the volume: for all channels at once where they share sigma_t, else for one after the other. `act`
/// takes the volume and the first of its channels.
void FusedSolver::ForChannels(const std::function<void(const SweepVolume&, int)>& act)
{
  const int rounds = this->SharedExtinction ? 1 : this->Channels;
  for (int round = 0; round < rounds; ++round)
  {
    act(this->VolumeOf(round), round);
  }
}

/// The channels from `first` on that share sigma_t.
SweepVolume FusedSolver::VolumeOf(int first) const
{
  SweepVolume volume;
  volume.grid = this->TheMedium.grid;
  volume.channels = this->SharedExtinction ? this->Channels : 1;
  volume.stride = this->Stride;
  volume.sigma_t = &this->Extinction;
  volume.sigma_t_first = first * this->Stride;
  volume.source = &this->Source;
  volume.path = &this->Path;
  volume.flux = this->Settings.netFlux && !this->Iterating ? &this->Flux : nullptr;
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
      this->Result.balance.escaped[firstChannel + c] += tally.out[face][c];
      this->Result.facePowerOut[face][firstChannel + c] += tally.out[face][c];
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
      this->Count(DepositLight(this->TheDevice, volume, ofChannels, this->Settings.periodic, this->Workspace, monitor),
        first, volume.channels);
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
  this->PropagateSweeps(boundary, this->Settings.maximumOrders > 0 ? ManyPlanes : FewPlanes, monitor);
}

void FusedSolver::PropagateSweeps(const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor)
{
  this->ForChannels([&](const SweepVolume& volume, int first) {
    const SweepBoundary ofChannels = boundary && first > 0
      ? SweepBoundary([&](int direction, int face) { return From(boundary(direction, face), first); })
      : boundary;
    for (std::size_t s = 0; s < this->Sweeps.size(); ++s)
    {
      const double before = static_cast<double>(first * this->Sweeps.size() + s);
      const double all = static_cast<double>(this->Sweeps.size()) * this->Channels / volume.channels;
      const Monitor ofSweep =
        monitor ? Monitor([&](double done) { return monitor((before + done) / all); }) : Monitor();
      this->Sweeps[s]->Start(volume, ofChannels, this->Shining, mostPlanes, ofSweep);
    }
    for (const std::unique_ptr<AxisSweep>& sweep : this->Sweeps)
    {
      this->Count(sweep->Finish(), first, volume.channels);
    }
  });
}

void FusedSolver::CollectOrder(int order)
{
  const int vector = this->TheDevice.FloatVectorWidth() >= 8 ? 8 : 4;
  cl::Kernel kernel = this->TheDevice.Kernel(
    "collect", { kernel_source::Numerics, kernel_source::Collect }, "-DREAL_WIDTH=" + std::to_string(vector));
  const std::size_t chunks = (this->Stride + Chunk - 1) / Chunk;
  Buffer<cl_float2> tally(this->TheDevice, chunks * this->Channels, "sums");
  With(kernel, this->Path, this->Fluence, this->Source, this->Extinction, this->Scattering, tally,
    cl_ulong(this->Stride), cl_int(this->SharedExtinction),
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
  if (this->Channels == 1)
  {
    words.push_back("colour: medium and light are grey, one channel does");
  }
  else if (this->SharedExtinction)
  {
    words.push_back("sigma_t a channel: red, green and blue share one, and its transmittance");
  }
  if (this->TheMedium.g != 0.0)
  {
    words.push_back("anisotropy: solved as isotropic scattering with sigma_s (1 - g), g = " +
      std::to_string(this->TheMedium.g) + " (similarity relation)");
  }
  if (Total(this->Result.balance.emitted) == 0.0)
  {
    words.push_back("emission: the medium does not shine");
  }
  if (!this->LitFromOutside)
  {
    words.push_back("boundary radiance: no environment, sky or face shines");
  }
  if (this->Lights.empty())
  {
    words.push_back("first-collision source: there are no lights");
  }
  if (this->Result.convergence.size() == 1)
  {
    words.push_back("scattering orders after the first: nothing is scattered");
  }
  if (!this->Accelerated)
  {
    words.push_back("acceleration: few scattering orders do");
  }
  if (!this->Settings.netFlux)
  {
    words.push_back("net_flux: not asked for");
  }
  return words;
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
  light.device = this->TheDevice.Name();
}

double EnergyBalance::RelativeError(int channels) const
{
  double worst = 0.0;
  for (int c = 0; c < channels; ++c)
  {
    const double in = this->entered[c] + this->emitted[c];
    const double out = this->absorbed[c] + this->escaped[c] + this->leftOver[c];
    const double error = in > 0.0 ? std::abs(in - out) / in : std::abs(out);
    worst = error <= worst ? worst : error; // what is not a number stays
  }
  return worst;
}

LightField SolveFused(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor)
{
  Check(medium);
  Check(illumination);
  Check(settings);
  const double unit = PowerUnitOf(medium, illumination);
  if (unit == 1.0)
  {
    return FusedSolver(device, medium, illumination, settings).Run(monitor);
  }
  const SceneInUnits scene(medium, illumination, unit);
  LightField light = FusedSolver(device, scene.medium, scene.illumination, settings).Run(monitor);
  ToWatts(light, unit);
  return light;
}
}
