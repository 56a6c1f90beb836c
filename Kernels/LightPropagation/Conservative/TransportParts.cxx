#include "LightPropagation/Conservative/TransportParts.h"

#include "LightPropagation/Scattering/IsotropicScattering.h"
#include "LightPropagation/Sweep/SweepInMemory.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "LightPropagation/Uncollided/UncollidedEmission.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Numerics/Constants.h"

namespace tyndall
{
namespace
{
RayStarts StartsOf(const PropagationSettings& settings)
{
  return settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle;
}

VolumeLayout LayoutOf(const PropagationProblem& problem)
{
  const bool shared = problem.Channels() == 1 || (problem.Settings().leaveOut && problem.Traits().greyExtinction);
  return { problem.TheGrid(), problem.Channels(), shared };
}

/// Without absorption sigma_s is sigma_t; without scattering it is not read.
MediumOnDevice::Needs NeedsOf(const PropagationProblem& problem, const VolumeLayout& layout, bool accelerated)
{
  const MediumTraits& traits = problem.Traits();
  const bool alike = !traits.absorbs && (layout.channels == 1 || !layout.sharedExtinction);
  const bool unused = !traits.scatters && !accelerated;
  return { !(problem.Settings().leaveOut && (alike || unused)), accelerated };
}

/// Peaks go along rays of their own, but not round periodic axes: of their images there is no end.
SplitEmission EmissionOf(const PropagationProblem& problem)
{
  const std::array<bool, 3>& periodic = problem.Settings().periodic;
  const bool endless = periodic[0] || periodic[1] || periodic[2];
  return problem.Traits().emits && problem.Settings().emissionError > 0.0 && !endless ? Split(problem.TheMedium())
                                                                                      : SplitEmission();
}
}

TransportParts::TransportParts(Device& device, const PropagationProblem& problem, bool accelerated)
  : TheDevice(device)
  , Problem(problem)
  , Layout(LayoutOf(problem))
  , OnDevice(device, problem.TheMedium(), this->Layout, NeedsOf(problem, this->Layout, accelerated))
  , Scattering(this->MakeScattering())
  , Usual(problem.TheGrid(), problem.Settings(), EquiangularDirections(problem.Settings().directionsPerFace),
      StartsOf(problem.Settings()))
  , Emission(EmissionOf(problem))
  , Accelerated(accelerated)
{
  this->FindBoundaryLight();
  const MediumTraits& traits = problem.Traits();
  const bool needsSource = problem.ComputesScattering() || traits.emits || accelerated;
  this->Source = Buffer<float>(device, needsSource ? this->Layout.Floats() : SweepPadding, "the scattered light");
  this->Path = Buffer<float>(device, this->Layout.Floats(), "the light gathered");
  this->Fluence = Buffer<float>(device, this->Layout.Floats(), "fluence");
  if (problem.Settings().netFlux)
  {
    this->Flux = Buffer<float>(device, this->Layout.Floats(3), "net_flux");
    this->Flux.Fill(0.0f);
  }
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);
  this->LoadSource();
}

/// What the usual directions carry of what the medium shines.
void TransportParts::LoadSource()
{
  this->MediumShines = !this->Problem.Settings().leaveOut;
  if (!this->Problem.Traits().emits)
  {
    this->Source.Fill(0.0f);
    return;
  }
  const Field smooth = this->Emission.Smooth(this->Problem.TheMedium());
  const std::vector<float> source = Planar(this->Layout, this->Layout.channels, [&](std::size_t i, int c) {
    this->MediumShines = this->MediumShines || smooth.At(i, c) > 0.0f;
    return smooth.At(i, c);
  });
  this->Source.Write(source.data());
}

void TransportParts::FindBoundaryLight()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Illumination& shining = this->Problem.Shining();
  const Grid& grid = this->Problem.TheGrid();
  if (settings.uncollidedDirections > 0)
  {
    this->Fine = std::make_unique<SweptDirections>(grid, settings,
      EquiangularDirections(settings.uncollidedDirections, "UncollidedDirections"),
      this->Accelerated ? StartsOf(settings) : RayStarts::Staggered);
  }
  const SplitEnvironment environment = Split(shining.environment, (this->Fine ? *this->Fine : this->Usual).Set());
  this->Lamps = shining.lights;
  this->Lamps.insert(this->Lamps.end(), environment.peaks.begin(), environment.peaks.end());
  this->UsualBoundary = std::make_unique<BoundaryLight>(grid, settings, this->Usual, shining, environment.smooth);
  if (this->Fine)
  {
    auto fine = std::make_unique<BoundaryLight>(grid, settings, *this->Fine, shining, environment.smooth);
    // What comes in evenly from everywhere is what accelerated sweeps carry already.
    if (fine->Shines() && !(this->Accelerated && fine->IsEven()))
    {
      this->FineBoundary = std::move(fine);
      this->FineBoundary->CheckRays(this->Layout.channels);
    }
  }
  if (this->SweepsAreLit())
  {
    this->UsualBoundary->CheckRays(this->Layout.channels);
  }
}

SweepBoundary TransportParts::BoundaryOfSweeps() const
{
  if (this->SweepsAreLit())
  {
    return this->UsualBoundary->Boundary();
  }
  return this->Problem.Settings().leaveOut ? SweepBoundary() : [](int, int) { return Rgb{}; };
}

Deposit TransportParts::WholeDeposit() const
{
  return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr };
}

std::vector<AxisBundles> TransportParts::AllRays() const
{
  return { { 0, this->Usual.Along(0) }, { 1, this->Usual.Along(1) }, { 2, this->Usual.Along(2) } };
}

std::unique_ptr<SweepOperator> TransportParts::MakeSweep(const SweepRequest& request)
{
  return std::make_unique<SweepInMemory>(this->TheDevice, this->Layout, this->OnDevice.SigmaT(),
    this->Problem.Settings().periodic, request, this->Workspace);
}

std::unique_ptr<const ScatteringOperator> TransportParts::MakeScattering() const
{
  return std::make_unique<IsotropicScattering>(
    this->TheDevice, this->Layout, this->OnDevice, this->Problem.ComputesScattering());
}

TransportParts::Sources TransportParts::LampSources() const
{
  Sources sources;
  for (const Light& lamp : this->Lamps)
  {
    sources.push_back(std::make_unique<UncollidedLamp>(lamp));
  }
  return sources;
}

TransportParts::Sources TransportParts::BrightEmissionSources() const
{
  Sources sources;
  for (const EmissionPeak& peak : this->Emission.peaks)
  {
    sources.push_back(std::make_unique<UncollidedEmission>(peak, this->Problem.Settings().emissionError));
  }
  return sources;
}

void TransportParts::CountEmission(EnergyLedger& ledger) const
{
  const double volume = this->Layout.grid.VoxelVolume();
  for (int c = 0; c < this->Layout.channels && this->Problem.Traits().emits; ++c)
  {
    for (std::size_t i = 0; i < this->Layout.grid.VoxelCount(); ++i)
    {
      ledger.Emit(c, 4.0 * Pi * this->Problem.TheMedium().emission.At(i, c) * volume);
    }
  }
}

SweepTally TransportParts::AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor)
{
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  const std::array<bool, 3>& periodic = this->Problem.Settings().periodic;
  return source.AddTo({ this->TheDevice, this->Layout, this->OnDevice.SigmaT(), periodic, sweeps, deposit }, monitor);
}

TransportParts::UncollidedFlux TransportParts::FindUncollided(const UncollidedSource& source, const Monitor& monitor)
{
  const bool netFlux = this->Problem.Settings().netFlux;
  Buffer<float> path(this->TheDevice, this->Layout.Floats(), "uncollided light");
  Buffer<float> flux(this->TheDevice, netFlux ? this->Layout.Floats(3) : 0, "its net flux");
  path.Fill(0.0f);
  flux.Fill(0.0f);
  UncollidedFlux found;
  found.tally = this->AddUncollided(source, { &path, netFlux ? &flux : nullptr, nullptr, nullptr }, monitor);
  found.path = path.Read();
  found.flux = flux.Read();
  return found;
}

TransportParts::EvenSky TransportParts::FindEvenSky(const Monitor& monitor)
{
  Illumination evenly;
  evenly.sky = { 1.0, 1.0, 1.0 };
  const PropagationSettings& settings = this->Problem.Settings();
  const auto along = [&](const SweptDirections& directions, const Monitor& ofThese) {
    const BoundaryLight light(this->Problem.TheGrid(), settings, directions, evenly, {});
    return this->FindUncollided(UncollidedBoundary(settings, light), ofThese);
  };
  return { along(*this->Fine, OfPart(monitor, 0.0, 0.8)), along(this->Usual, OfPart(monitor, 0.8, 1.0)) };
}
}
