#include "LightPropagation/Conservative/TransportParts.h"

#include "LightPropagation/Emission/UncollidedEmission.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "LightPropagation/Sweep/SweepOfDevice.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <utility>

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

/// Arrays needed on the device. Without absorption sigma_s equals sigma_t; without scattering it is not read.
MediumOnDevice::Needs NeedsOf(const PropagationProblem& problem, const VolumeLayout& layout, bool byBalance)
{
  const MediumTraits& traits = problem.Traits();
  const bool alike = !traits.absorbs && (layout.channels == 1 || !layout.sharedExtinction);
  const bool unused = !traits.scatters && !byBalance;
  return { !(problem.Settings().leaveOut && (alike || unused)), byBalance };
}

/// Adds the mean boundary radiance.
void AddMeanRadiance(const BoundaryLight* boundary, Rgb& mean)
{
  for (const Rgb& power : boundary ? boundary->IncomingPower() : std::array<Rgb, 6>())
  {
    for (std::size_t c = 0; c < mean.size(); ++c)
    {
      mean[c] += power[c] / (6.0 * Pi);
    }
  }
}

/// Separates localised emission, which is traced along exact rays. These neither wrap around periodic axes, because
/// there would be infinitely many images, nor cross between blocks.
SplitEmission SplitEmissionOf(const PropagationProblem& problem, const Rgb& comesIn)
{
  const std::array<bool, 3>& periodic = problem.Settings().periodic;
  const bool endless = periodic[0] || periodic[1] || periodic[2];
  const bool has = problem.TheDomain().IsSerial() && !endless;
  return problem.Traits().emits && problem.Settings().emissionError > 0.0 && has ? Split(problem.TheMedium(), comesIn)
                                                                                 : SplitEmission();
}
}

TransportParts::TransportParts(Device& device, const PropagationProblem& problem, IterationScheme how,
  DirectionSet usual, const UncollidedDirections& finer)
  : TheDevice(device)
  , Problem(problem)
  , How(how)
  , Layout(LayoutOf(problem))
  , OnDevice(device, problem.TheMedium(), problem.Scattering(), this->Layout,
      NeedsOf(problem, this->Layout, this->ByBalance()))
  , Scattering(
      MakeScattering(device, this->Layout, this->OnDevice, problem.Scattering().Degree(), problem.ComputesScattering()))
  , Usual(problem.Whole(), problem.Settings(), std::move(usual), StartsOf(problem.Settings()))
  , Finer(finer)
{
  if (problem.HasGivenLight())
  {
    this->Given = std::make_unique<GivenLight>(problem.Shining().uncollided, problem.TheMedium(), problem.Scattering());
  }
  this->FindBoundaryLight();
  Rgb comesIn = {};
  AddMeanRadiance(this->UsualBoundary.get(), comesIn);
  AddMeanRadiance(this->ByBalance() ? nullptr : this->FineBoundary.get(), comesIn);
  this->Emission = SplitEmissionOf(problem, comesIn);
  this->FindFaceLight();
  if (!this->TheDomain().IsSerial())
  {
    this->Across = std::make_unique<AcrossFaces>(
      device, this->TheDomain().Comm(), this->TheDomain().Partition(), this->Layout, problem.Settings().periodic);
  }
  if (problem.Scattering().Degree() > 0 && !this->IsEmpty())
  {
    this->Angular =
      std::make_unique<SweptMoments>(this->Usual, problem.TheMedium().phase, problem.Scattering(), this->Lamps);
    this->Basis = &this->Angular->Basis();
  }
  const MediumTraits& traits = problem.Traits();
  const bool needsSource = problem.ComputesScattering() || traits.emits || this->ByBalance();
  const int beams = this->Angular ? this->Angular->Beams() : 0;
  this->Source = Buffer<float>(
    device, needsSource ? this->Layout.MomentFloats(this->Functions(), beams) : SweepPadding, "the scattered light");
  this->Path = Buffer<float>(device, this->Layout.MomentFloats(this->Functions()), "the light gathered");
  this->Fluence = Buffer<float>(device, this->Layout.Floats(), "fluence");
  if (problem.Settings().netFlux)
  {
    this->Flux = Buffer<float>(device, this->Layout.Floats(3), "net_flux");
    this->Flux.Fill(0.0f);
  }
  this->Source.Fill(0.0f);
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);
}

int TransportParts::Functions() const
{
  const int degree = this->Problem.Scattering().Degree();
  return (degree + 1) * (degree + 1);
}

void TransportParts::LoadSource()
{
  this->FindVacuum();
  bool shines = false;
  this->TheDomain().Collective([&] {
    shines = this->LoadEmission(this->Source);
    if (this->Given && this->Problem.ComputesScattering())
    {
      const bool more = this->Given->AddStraightOn(this->TheDevice, this->Layout, this->Basis, this->Source);
      shines = shines || more;
    }
  });
  this->MediumShines = this->TheDomain().Any(shines) || !this->Problem.Settings().leaveOut;
}

bool TransportParts::LoadEmission(Buffer<float>& source) const
{
  if (!this->Problem.Traits().emits || this->IsEmpty())
  {
    return false;
  }
  const std::vector<float> emitted = this->EmissionOf(false);
  const bool shines = std::any_of(emitted.begin(), emitted.end(), [](float value) { return value > 0.0f; });
  source.Write(emitted.data(), emitted.size() - SweepPadding);
  return shines;
}

/// Emission without localised emission, W / (length^3 sr).
/// @param emptyVoxels  of empty voxels that are swept separately; false: of all other voxels
std::vector<float> TransportParts::EmissionOf(bool emptyVoxels) const
{
  const PropagationProblem& problem = this->Problem;
  const Field smooth = this->Emission.Smooth(problem.TheMedium());
  return Planar(this->Layout, this->Layout.channels, [&](std::size_t i, int c) {
    const bool apart = this->OfVacuum && VacuumEmission::IsEmpty(problem.Scattering().SigmaT(i, c), this->Layout.grid);
    return apart == emptyVoxels ? smooth.At(i, c) : 0.0f;
  });
}

void TransportParts::FindVacuum()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Grid& grid = this->Problem.Whole();
  if (!this->Problem.Traits().emits || !VacuumEmission::IsApart(grid, settings))
  {
    return;
  }
  bool any = false;
  this->TheDomain().Collective([&] {
    this->OfVacuum = VacuumEmission::DirectionsFor(grid, settings);
    const std::vector<float> emitted = this->EmissionOf(true);
    any = std::any_of(emitted.begin(), emitted.end(), [](float value) { return value > 0.0f; });
  });
  if (!this->TheDomain().Any(any))
  {
    this->OfVacuum.reset();
  }
}

/// Separates the environment into peaks and a smooth part, for the directions of that smooth part.
SplitEnvironment TransportParts::SplitFar(const Environment& environment) const
{
  return Split(environment, (this->Fine && !this->Finer.ofFacesAlone ? *this->Fine : this->Usual).Set());
}

void TransportParts::FindBoundaryLight()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Illumination& shining = this->Problem.Shining();
  const Grid& grid = this->Problem.Whole();
  if (this->Finer.perFace > 0)
  {
    this->Fine = FinerDirections(grid, settings, this->Finer.perFace, this->ByBalance());
  }
  const SplitEnvironment environment = this->SplitFar(shining.environment);
  this->Lamps = shining.lights;
  this->Lamps.insert(this->Lamps.end(), environment.peaks.begin(), environment.peaks.end());
  this->FarAway = environment.smooth;
  this->FindFineBoundary();
  const bool all = this->ByBalance() || !this->FineBoundary;
  this->UsualBoundary = std::make_unique<BoundaryLight>(grid, settings, this->Usual,
    all ? shining : AlongUsual(this->Finer, shining), all || this->Finer.ofFacesAlone ? this->FarAway : Environment());
  if (this->SweepCarriesBoundarySource())
  {
    this->UsualBoundary->CheckRays(this->Layout.channels);
  }
}

/// Makes the boundary source along the finer quadrature. A uniform boundary source keeps the usual quadrature, as
/// scattered light has, so that a furnace stays uniform. DSA with reflecting faces also keeps it, because faces cannot
/// reflect part of the light along other directions than those of sweeps.
void TransportParts::FindFineBoundary()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Illumination& shining = this->Problem.Shining();
  if (!this->Fine)
  {
    return;
  }
  const Grid& grid = this->Problem.Whole();
  const bool ofAll = !this->Finer.ofFacesAlone;
  auto fine = std::make_unique<BoundaryLight>(
    grid, settings, *this->Fine, AlongFiner(this->Finer, shining), ofAll ? this->FarAway : Environment());
  const bool isEven = (this->ByBalance() || !ofAll) && fine->IsEven();
  if (!fine->Shines() || isEven || (this->ByBalance() && Reflects(shining)))
  {
    return;
  }
  // Automatically chosen finer directions are dropped if few of their rays would hit the faces.
  if (ofAll)
  {
    fine->CheckRays(this->Layout.channels);
  }
  else if (!BoundaryLight::HasEnoughRays(grid, settings, *this->Fine))
  {
    return;
  }
  this->FineBoundary = std::move(fine);
}

BoundaryLight TransportParts::FinePartAlongUsual() const
{
  return { this->Problem.Whole(), this->Problem.Settings(), this->Usual,
    AlongFiner(this->Finer, this->Problem.Shining()), this->Finer.ofFacesAlone ? Environment() : this->FarAway };
}

void TransportParts::FindFaceLight()
{
  const Illumination& shining = this->Problem.Shining();
  if (Reflects(shining) || this->Problem.Settings().facePower)
  {
    const Grid& grid = this->Problem.Whole();
    this->Faces = std::make_unique<FaceLight>(this->TheDevice, grid, this->Layout.channels,
      SweptPowerIn(grid, this->Problem.Settings().periodic, this->Usual, !Reflects(shining)), shining.faceAlbedo);
  }
}

SweepBoundary TransportParts::BoundaryOfSweeps() const
{
  if (this->SweepCarriesBoundarySource())
  {
    return this->UsualBoundary->Boundary();
  }
  return this->Problem.Settings().leaveOut ? SweepBoundary() : [](int, int) { return Rgb{}; };
}

Deposit TransportParts::WholeDeposit() const
{
  return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr,
    this->Faces ? &this->Faces->Out() : nullptr, this->SpreadsAside() };
}

std::vector<AxisBundles> TransportParts::AllRays() const
{
  return { { 0, this->Usual.Along(0) }, { 1, this->Usual.Along(1) }, { 2, this->Usual.Along(2) } };
}

std::unique_ptr<SweepOperator> TransportParts::MakeSweep(const SweepRequest& request)
{
  const Domain& domain = this->TheDomain();
  const std::array<bool, 3>& periodic = this->Problem.Settings().periodic;
  std::unique_ptr<SweepOperator> sweep;
  domain.Collective([&] {
    if (domain.IsSerial())
    {
      sweep = SweepOfDevice(this->TheDevice, this->Layout, this->OnDevice.SigmaT(), periodic, request, this->Workspace);
      return;
    }
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, domain.Comm(), domain.Partition(), this->Layout,
      this->OnDevice.SigmaT(), periodic, request, this->PipelineWorkspace);
  });
  return sweep;
}

BeyondFaces TransportParts::FetchBeyond(const Buffer<float>& byFaces)
{
  return this->Across ? this->Across->Fetch(byFaces) : BeyondFaces();
}

std::vector<Light> TransportParts::LampsOf(const Illumination& illumination) const
{
  const SplitEnvironment environment = this->SplitFar(illumination.environment);
  std::vector<Light> lamps = illumination.lights;
  lamps.insert(lamps.end(), environment.peaks.begin(), environment.peaks.end());
  return lamps;
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

TransportParts::Sources TransportParts::OtherSources() const
{
  Sources sources = this->BrightEmissionSources();
  if (this->Given)
  {
    sources.push_back(std::make_unique<GivenLight>(*this->Given));
  }
  return sources;
}

TransportParts::Sources TransportParts::VacuumSources() const
{
  Sources sources;
  if (this->OfVacuum)
  {
    sources.push_back(std::make_unique<VacuumEmission>(*this->OfVacuum, this->EmissionOf(true)));
  }
  return sources;
}

void TransportParts::CountEmission(EnergyLedger& ledger) const
{
  const double volume = this->Layout.grid.VoxelVolume();
  Rgb emitted = {};
  for (int c = 0; c < this->Layout.channels && this->Problem.Traits().emits; ++c)
  {
    emitted[c] = SumOverVoxels(this->Layout.grid,
      [&](std::size_t i) { return 4.0 * Pi * this->Problem.TheMedium().emission.At(i, c) * volume; });
  }
  emitted = this->TheDomain().Sum(emitted);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    ledger.Emit(c, emitted[c]);
  }
}

UncollidedVolume TransportParts::VolumeOf(const Deposit& deposit)
{
  const Domain& domain = this->TheDomain();
  const std::array<bool, 3>& periodic = this->Problem.Settings().periodic;
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  UncollidedVolume volume = { this->TheDevice, this->Layout, this->OnDevice.SigmaT(), periodic, sweeps, deposit,
    this->Basis, nullptr };
  if (domain.IsSerial())
  {
    return volume;
  }
  volume.whole = &this->Problem.Whole();
  volume.fetchBeyond = [this](const Buffer<float>& byFaces) { return this->FetchBeyond(byFaces); };
  volume.together = [&domain](const std::function<void()>& step) { domain.Collective(step); };
  volume.followLamp = [this, &domain, &periodic](
                        const SweepVolume& ofChannels, const Light& lamp, const Monitor& monitor) {
    if (!this->NearLamps)
    {
      this->NearLamps = std::make_unique<LampsInBlocks>(
        this->TheDevice, domain.Comm(), domain.Partition(), periodic, this->Layout, this->OnDevice.SigmaT());
    }
    return this->NearLamps->Deposit(ofChannels, lamp, monitor);
  };
  return volume;
}

SweepTally TransportParts::AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor)
{
  UncollidedVolume volume = this->VolumeOf(deposit);
  const int beam = this->SlotOf(source);
  Buffer<float> path;
  this->TheDomain().Collective([&] {
    if (beam >= 0)
    {
      path = Buffer<float>(this->TheDevice, this->Layout.Floats(), "the light of a beam");
      path.Fill(0.0f);
      volume.beamPath = &path;
    }
  });
  // A collective source reports failures on all ranks, except those after its last collective call.
  SweepTally tally;
  std::exception_ptr error;
  try
  {
    tally = source.AddTo(volume, monitor);
  }
  catch (...)
  {
    error = std::current_exception();
  }
  this->TheDomain().Collective([&] {
    if (error)
    {
      std::rethrow_exception(error);
    }
    if (beam >= 0)
    {
      this->Scattering->AddBeam(path, this->Source, beam);
    }
  });
  return source.TalliesOwnVoxels() ? this->SumOfVoxels(tally) : tally;
}

/// Tally of all ranks. Each rank knows the total escaped power and the net power into its own voxels; incident power is
/// the sum of the latter over ranks plus the escaped power.
SweepTally TransportParts::SumOfVoxels(const SweepTally& own) const
{
  if (this->TheDomain().IsSerial())
  {
    return own;
  }
  Rgb taken = {};
  std::vector<double> left;
  for (int c = 0; c < 3; ++c)
  {
    taken[c] = own.in[0][c];
    for (int face = 0; face < 6; ++face)
    {
      taken[c] -= own.out[face][c];
      left.push_back(own.out[face][c]);
    }
  }
  taken = this->TheDomain().Sum(taken);
  left = this->TheDomain().Max(left);
  SweepTally all;
  for (int c = 0; c < 3; ++c)
  {
    all.in[0][c] = taken[c];
    for (int face = 0; face < 6; ++face)
    {
      all.out[face][c] = left[6 * c + face];
      all.in[0][c] += all.out[face][c];
    }
  }
  return all;
}

/// Index of the beam that has its own angular distribution; -1: none.
int TransportParts::SlotOf(const UncollidedSource& source) const
{
  const auto* lamp = dynamic_cast<const UncollidedLamp*>(&source);
  for (std::size_t i = 0; lamp && this->Angular && i < this->Lamps.size(); ++i)
  {
    if (&lamp->TheLight() == &this->Lamps[i])
    {
      return this->Angular->BeamOf(i);
    }
  }
  return -1;
}

void TransportParts::DarkenBeams()
{
  if (this->BeamValues() > 0)
  {
    this->Source.Fill(0.0f, this->Layout.Places(this->Functions()).beams, this->BeamValues());
  }
}

BeamsInSource TransportParts::BeamsOfSource()
{
  return { this->TheDevice, this->Source, this->Layout.Places(this->Functions()).beams, this->BeamValues() };
}

void TransportParts::LightBeams(const Buffer<float>& given) const
{
  if (this->BeamValues() > 0)
  {
    this->Source.CopyFrom(given, this->Layout.Places(this->Functions()).beams, this->BeamValues());
  }
}

TransportParts::UncollidedPath TransportParts::FindUncollidedPath(
  const UncollidedSource& source, const Monitor& monitor)
{
  Buffer<float> path;
  this->TheDomain().Collective([&] {
    path = Buffer<float>(this->TheDevice, this->Layout.MomentFloats(this->Functions()), "uncollided light");
    path.Fill(0.0f);
  });
  UncollidedPath found;
  found.tally = this->AddUncollided(source, { &path }, monitor);
  this->TheDomain().Collective([&] { found.path = path.Read(); });
  return found;
}

TransportParts::UncollidedFlux TransportParts::FindUncollided(const UncollidedSource& source, const Monitor& monitor)
{
  const bool netFlux = this->Problem.Settings().netFlux, inMoments = this->Functions() > 1;
  Buffer<float> path, flux;
  this->TheDomain().Collective([&] {
    path = Buffer<float>(this->TheDevice, this->Layout.MomentFloats(this->Functions()), "uncollided light");
    flux = Buffer<float>(this->TheDevice, netFlux ? this->Layout.Floats(3) : 0, "its net flux");
    path.Fill(0.0f);
    flux.Fill(0.0f);
  });
  UncollidedFlux found;
  found.tally =
    this->AddUncollided(source, { &path, netFlux && !inMoments ? &flux : nullptr, nullptr, nullptr }, monitor);
  this->TheDomain().Collective([&] {
    if (netFlux && this->Basis)
    {
      AddFluxOfMoments(this->TheDevice, this->Layout, this->Functions(), path, flux);
    }
    found.path = path.Read();
    found.flux = flux.Read();
  });
  return found;
}

TransportParts::EvenSky TransportParts::FindEvenSky(const Monitor& monitor)
{
  Illumination evenly;
  evenly.sky = { 1.0, 1.0, 1.0 };
  const PropagationSettings& settings = this->Problem.Settings();
  const auto along = [&](const SweptDirections& directions, const Monitor& ofThese) {
    const BoundaryLight light(this->Problem.Whole(), settings, directions, evenly, {});
    return this->FindUncollidedPath(UncollidedBoundary(settings, light), ofThese);
  };
  return { along(*this->Fine, OfPart(monitor, 0.0, 0.8)), along(this->Usual, OfPart(monitor, 0.8, 1.0)) };
}

std::unique_ptr<TransportParts> MakeParts(Device& device, const PropagationProblem& problem, IterationScheme how)
{
  const DirectionSet usual = DirectionsForVoxels(problem.Settings().directionsPerFace, problem.Whole().spacing);
  const UncollidedDirections finer = UncollidedDirectionsFor(problem, usual, how);
  std::unique_ptr<TransportParts> parts;
  problem.TheDomain().Collective([&] { parts = std::make_unique<TransportParts>(device, problem, how, usual, finer); });
  parts->LoadSource();
  return parts;
}
}
