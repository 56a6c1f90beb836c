#include "LightPropagation/Conservative/TransportParts.h"

#include "LightPropagation/ThickVoxels/OctantSources.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace tyndall
{
namespace
{
/// Starting positions of rays. Thick voxels have sources by octant and need two rays each, because the transmittance of
/// one ray in the middle of a thick voxel differs from the voxel's mean transmittance.
RayStarts StartsOf(const PropagationSettings& settings, bool byOctant)
{
  return settings.staggeredRays ? RayStarts::Staggered : byOctant ? RayStarts::Pairs : RayStarts::Middle;
}

VolumeLayout LayoutOf(const PropagationProblem& problem)
{
  const bool shared = problem.Channels() == 1 || (problem.Settings().leaveOut && problem.Traits().greyExtinction);
  return { problem.TheGrid(), problem.Channels(), shared };
}

/// Arrays of the medium that the device needs. A separate array of sigma_s is not needed if the medium does not absorb
/// (sigma_s then equals sigma_t) or does not scatter.
MediumOnDevice::Needs NeedsOf(const PropagationProblem& problem, const VolumeLayout& layout, bool byBalance)
{
  const MediumTraits& traits = problem.Traits();
  const bool alike = !traits.absorbs && (layout.channels == 1 || !layout.sharedExtinction);
  const bool unused = !traits.scatters && !byBalance;
  return { !(problem.Settings().leaveOut && (alike || unused)), byBalance };
}
}

TransportParts::TransportParts(Device& device, const PropagationProblem& problem, IterationScheme how,
  DirectionSet usual, const UncollidedDirections& finer)
  : TheDevice(device)
  , Problem(problem)
  , How(how)
  , ByOctant(how == IterationScheme::SourceIteration && OctantSources::Matter(problem))
  , Layout(LayoutOf(problem))
  , OnDevice(device, problem.TheMedium(), problem.Scattering(), this->Layout,
      NeedsOf(problem, this->Layout, this->ByBalance()))
  , Scattering(
      MakeScattering(device, this->Layout, this->OnDevice, problem.Scattering().Degree(), problem.ComputesScattering()))
  , Usual(problem.Whole(), problem.Settings(), std::move(usual), StartsOf(problem.Settings(), this->ByOctant))
  , Lights(problem, this->ByBalance(), this->Layout, this->Usual, finer)
  , Transport(device, problem.TheDomain(), this->Layout, this->OnDevice.SigmaT(), problem.Settings().periodic)
  , Scattered{ [this](const SweepRequest& request) { return this->Transport.MakeSweep(request); },
    [this] { return ModelOfRays(this->Problem.Whole(), this->Usual, this->Problem.Settings().periodic); } }
{
  this->FindFaceLight();
  if (problem.Scattering().Degree() > 0 && !this->IsEmpty())
  {
    this->Angular =
      std::make_unique<SweptMoments>(this->Usual, problem.TheMedium().phase, problem.Scattering(), this->Lights.Lamps);
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
  this->Lights.FindEmission();
  bool shines = false;
  this->TheDomain().Collective([&] {
    shines = this->LoadEmission(this->Source);
    if (this->Lights.Given && this->Problem.ComputesScattering())
    {
      const bool more = this->Lights.Given->AddStraightOn(this->TheDevice, this->Layout, this->Basis, this->Source);
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
  const std::vector<float> emitted = this->Lights.EmissionOf(false);
  const bool shines = std::any_of(emitted.begin(), emitted.end(), [](float value) { return value > 0.0f; });
  source.Write(emitted.data(), emitted.size() - SweepPadding);
  return shines;
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

Deposit TransportParts::WholeDeposit() const
{
  return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr,
    this->Faces ? &this->Faces->Out() : nullptr, this->SpreadsAside() };
}

std::vector<AxisBundles> TransportParts::AllRays() const
{
  return { { 0, this->Usual.Along(0) }, { 1, this->Usual.Along(1) }, { 2, this->Usual.Along(2) } };
}

SweepTally TransportParts::AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor)
{
  UncollidedVolume volume = this->Transport.VolumeOf(deposit, this->Basis);
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
  // AddTo() rethrows failures on all ranks, except for failures after its last collective step, which the Collective()
  // below rethrows.
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

/// Tally of all ranks from the tallies of their own voxels. Each rank knows the escaped power of the domain, and the
/// net power into its voxels; the incident power is the sum of this net power over ranks plus the escaped power.
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

/// Index of a parallel beam among the beams whose first scattering is stored with its own angular distribution
/// (SweptMoments); -1: `source` is no such beam.
int TransportParts::SlotOf(const UncollidedSource& source) const
{
  const auto* lamp = dynamic_cast<const UncollidedLamp*>(&source);
  for (std::size_t i = 0; lamp && this->Angular && i < this->Lights.Lamps.size(); ++i)
  {
    if (&lamp->TheLight() == &this->Lights.Lamps[i])
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
  return { along(*this->Lights.Fine, OfPart(monitor, 0.0, 0.8)), along(this->Usual, OfPart(monitor, 0.8, 1.0)) };
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
