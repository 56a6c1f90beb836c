#include "LightPropagation/Conservative/Acceleration/AccelerationInBlocks.h"

#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/LampPassing.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostSweepsOverRanks = 200;
constexpr float Elsewhere = -1.0f; ///< sigma_s of other ranks' voxels, which are counted there
}

AccelerationInBlocks::AccelerationInBlocks(
  TransportParts& parts, LampAdder addLamp, EnergyLedger& ledger, WarmStart& warm)
  : Parts(parts)
  , TheDomain(parts.TheDomain())
  , Settings(parts.Problem.Settings())
  , Layout(parts.Layout)
  , TheMedium(parts.Problem.TheMedium())
  , AddLamp(std::move(addLamp))
  , Ledger(ledger)
  , Warm(warm)
  , LinearSource(parts.Problem.HasLinearSource())
  , Block(this->TheDomain.Comm(), this->TheDomain.Partition(), this->Settings.periodic, this->Layout.channels,
      this->Layout.sharedExtinction)
  , Moments(this->TheDomain.Comm(), this->Block, parts.Functions())
{
  this->TheDomain.Collective([&] {
    const char* what = "the diffusion system";
    const VolumeLayout& held = this->Block.WithGhosts();
    const int extinctions = held.sharedExtinction ? 1 : held.channels;
    const bool any = this->Moments.Any();
    this->SigmaT = Buffer<float>(parts.TheDevice, held.FloatsOf(extinctions), what);
    this->SweptSigmaT = Buffer<float>(parts.TheDevice, any ? held.FloatsOf(extinctions) : 0, what);
    this->GivenFlux = Buffer<float>(parts.TheDevice, any ? held.Floats(3) : 0, what);
    for (Buffer<float>* array : { &this->SigmaA, &this->CountedSigmaS, &this->Given, &this->Source })
    {
      *array = Buffer<float>(parts.TheDevice, held.Floats(), what);
    }
    this->Path = Buffer<float>(parts.TheDevice, this->Moments.HeldFloats(), what);
    this->OwnNext = ExactValues(parts.TheDevice, this->Layout.grid.VoxelCount(), what);
    this->PartialCurrents = Buffer<float>(parts.TheDevice, held.Floats(6), what);
    this->OwnCurrents = Buffer<float>(parts.TheDevice, this->Layout.Floats(6), "the power from voxel to voxel");
  });
  this->SpreadMedium();
}

void AccelerationInBlocks::SpreadMedium()
{
  const VolumeLayout& own = this->Layout;
  const int extinctions = own.sharedExtinction ? 1 : own.channels;
  std::vector<float> sigmaT, swept, sigmaA;
  this->TheDomain.Collective([&] {
    sigmaT = this->Parts.OnDevice.TransportSigmaT().Read();
    swept = this->Parts.OnDevice.SigmaT().Read();
    this->OwnSigmaS = this->Parts.OnDevice.SigmaS().Read();
    const Field& absorption = this->TheMedium.sigma_a;
    sigmaA = Planar(own, own.channels, [&](std::size_t i, int c) { return absorption.At(i, c); });
  });
  this->Block.SpreadWithGhosts(sigmaT, extinctions, this->SigmaT);
  if (this->Moments.Any())
  {
    this->Block.SpreadWithGhosts(swept, extinctions, this->SweptSigmaT);
  }
  this->Block.SpreadWithGhosts(sigmaA, own.channels, this->SigmaA);
  this->Block.Spread(this->OwnSigmaS, own.channels, this->CountedSigmaS, Elsewhere);
}

/// In thick voxels it matters where lamps' light is first scattered.
bool AccelerationInBlocks::NeedsFirstMoments() const
{
  const bool own = !this->Parts.IsEmpty() && AnyVoxelIsThickerThan(ThickForFirstMoments, this->TheMedium);
  return OnAnyRank(this->TheDomain.Comm(), own) && this->LinearSource;
}

SweepTally AccelerationInBlocks::AddBeams(const Monitor& monitor)
{
  const std::vector<Light>& lamps = this->Parts.Lamps;
  Deposit more = this->DepositOfSweep(); // with the faces' cells, as sweeps have them
  more.flux = this->Parts.Flux.Size() > 0 ? &this->Parts.Flux : nullptr;
  this->Beams = std::make_unique<BeamsInThickBlocks>(this->Parts.TheDevice, this->TheDomain.Comm(), this->Block,
    this->Parts.Path.Size(),
    BeamsInThickBlocks::Coefficients{
      this->SigmaT, this->SigmaA, this->CountedSigmaS, this->Moments.Any() ? this->SweptSigmaT : this->SigmaT });
  SweepTally tally;
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    const double all = static_cast<double>(lamps.size());
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    const bool shines = Sum(lamps[i].power) > 0.0;
    Add(tally, shines ? this->Beams->Add(i, this->AddLamp, this->Parts.Path, more, ofLamp) : SweepTally());
  }
  this->Beams->Finish();
  return tally;
}

ConvergenceRecord AccelerationInBlocks::Run(const Monitor& monitor)
{
  this->GiveFirstScattered();
  this->ReflectUncollided();
  SweepRequest request = { this->DepositOfSweep(),
    { { 0, this->Parts.Usual.Along(0) }, { 1, this->Parts.Usual.Along(1) }, { 2, this->Parts.Usual.Along(2) } } };
  request.faceIn = this->Parts.Faces && this->Parts.Faces->Reflects() ? &this->Parts.Faces->In() : nullptr;
  request.angular = this->Parts.UsualValues();
  this->Swept = this->Parts.MakeSweep(request);
  int iteration = 0;
  do
  {
    const double before = iteration == 0 ? UncollidedPart : iteration;
    const Monitor ofSweep = OfPart(monitor, [=](double done) {
      return ProgressOf(this->Settings, this->Residual, before + (iteration + 1 - before) * done);
    });
    this->Sweep(iteration, ofSweep);
    if (iteration == 0)
    {
      this->TakeDirect();
      this->MakeSystems();
    }
    this->Correct(iteration);
    if (iteration == 0 && this->Warm.Keeps())
    {
      this->BeginWarm();
    }
    ++iteration;
  } while (!this->Done(iteration));
  this->WriteFluence();
  return this->Convergence;
}

/// What of lamps' light is scattered is a given source, like what the medium emits.
void AccelerationInBlocks::GiveFirstScattered()
{
  this->FindGiven();
  const VolumeLayout& own = this->Layout;
  const double volume = own.grid.VoxelVolume();
  std::vector<double> sums(6, 0.0); // scattered, and absorbed before
  this->TheDomain.Collective([&] {
    this->UncollidedFluence = this->Parts.Path.Read();
    this->UncollidedFluence.resize(own.Floats());
    for (int c = 0; c < own.channels; ++c)
    {
      const std::size_t first = c * own.Stride();
      sums[c] = SumOverVoxels(own.grid, [&](std::size_t i) {
        float& here = this->UncollidedFluence[first + i];
        const double scattered = static_cast<double>(this->OwnSigmaS[first + i]) * here;
        here = static_cast<float>(here / volume);
        return scattered;
      });
      sums[3 + c] = SumOverVoxels(own.grid,
        [&](std::size_t i) { return volume * this->TheMedium.sigma_a.At(i, c) * this->UncollidedFluence[first + i]; });
    }
  });
  sums = this->TheDomain.Comm().Sum(sums);
  for (int c = 0; c < 3; ++c)
  {
    this->GivenPower[c] = this->Ledger.Balance().emitted[c] + sums[c];
    this->Ledger.Absorb(c, sums[3 + c]);
  }
  this->OfUncollided = this->Ledger;
}

/// Beams of the source are dark until what is first scattered shines.
void AccelerationInBlocks::FindGiven()
{
  const VolumeLayout& own = this->Layout;
  std::vector<float> given, flux;
  this->TheDomain.Collective([&] {
    if (this->Moments.Any() && !this->Parts.IsEmpty() && this->Parts.Flux.Size() > 0)
    {
      AddFluxOfMoments(this->Parts.TheDevice, own, this->Parts.Functions(), this->Parts.Path, this->Parts.Flux);
    }
    given = this->Parts.Source.Read();
    this->OwnGiven = Buffer<float>(this->Parts.TheDevice, given, "the light given");
    if (!this->Parts.IsEmpty())
    {
      this->Parts.Source.Fill(0.0f, own.Places(this->Parts.Functions()).beams, this->Parts.BeamValues());
      this->Parts.Scattering->AddFirstScattered({ &this->Parts.Path }, this->OwnGiven);
      given = this->OwnGiven.Read();
    }
    flux = this->Moments.Any() ? this->FluxOf(this->OwnGiven) : std::vector<float>();
  });
  this->Block.Spread(given, own.channels, this->Given);
  if (this->Moments.Any())
  {
    this->Block.SpreadWithGhosts(flux, 3 * own.channels, this->GivenFlux);
  }
}

/// Net flux of the block's angular moments, as Parts::flux.
std::vector<float> AccelerationInBlocks::FluxOf(const Buffer<float>& moments) const
{
  Buffer<float> flux(this->Parts.TheDevice, this->Layout.Floats(3), "the net flux given");
  flux.Fill(0.0f);
  if (!this->Parts.IsEmpty())
  {
    AddFluxOfMoments(this->Parts.TheDevice, this->Layout, this->Parts.Functions(), moments, flux);
  }
  return flux.Read();
}

/// What of uncollided light comes back comes back every time.
void AccelerationInBlocks::ReflectUncollided()
{
  if (!this->Parts.Faces)
  {
    return;
  }
  this->Faces = std::make_unique<FaceBalanceInBlocks>(
    this->Parts.TheDevice, this->TheDomain.Comm(), *this->Parts.Faces, this->Block);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    this->GivenPower[c] += this->Faces->OfBox().GivenBack()[c];
  }
}

/// No flux: it comes from the systems.
Deposit AccelerationInBlocks::DepositOfSweep() const
{
  const FaceLight* const faces = this->Parts.Faces.get();
  return { &this->Parts.Path, nullptr, &this->OwnCurrents, nullptr, faces ? &faces->Out() : nullptr,
    faces && !faces->Reflects() };
}

/// W of a voxel, about: the unit that the system's solver works in.
double AccelerationInBlocks::VoxelPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->TheDomain.Whole().VoxelCount());
}

void AccelerationInBlocks::MakeSystems()
{
  const Grid& whole = this->TheDomain.Whole();
  const VolumeLayout& held = this->Block.WithGhosts();
  const SweptDirections& directions = this->Parts.Usual;
  const bool any = this->Moments.Any();
  const CrossingPattern pattern = FindCrossingPattern(
    whole, directions.Set(), this->Settings.mapResolution, directions.Starts(), this->Settings.periodic);
  const std::array<Rgb, 6> incoming =
    this->Parts.SweepCarriesBoundarySource() ? (*this->Parts.UsualBoundary).IncomingPower() : std::array<Rgb, 6>{};
  for (int c = 0; c < held.channels; ++c)
  {
    std::array<double, 6> ofChannel, albedo = {};
    for (int face = 0; face < 6; ++face)
    {
      albedo[face] = this->Parts.Faces ? this->Parts.Faces->Albedo()[face][c] : 0.0;
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    const DiffusionSystem::Arrays arrays = { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(), &this->SigmaT,
      any ? &this->SweptSigmaT : &this->SigmaT, &this->SigmaA, &this->CountedSigmaS, &this->Given,
      this->Moments.Places(), c, any ? &this->GivenFlux : nullptr, &this->Source, &this->Path, &this->PartialCurrents,
      this->Beams ? &this->Beams->Passed() : nullptr, this->Beams ? &this->Beams->OfLamps() : nullptr,
      this->Faces ? &this->Faces->Rows(c) : nullptr, albedo };
    this->Systems.push_back(
      std::make_unique<BalanceOverRanks>(this->Parts.TheDevice, this->TheDomain.Comm(), this->TheDomain.Partition(),
        this->Block, directions.Set(), pattern, arrays, ofChannel, this->Settings.periodic, this->LinearSource));
  }
}

/// The source of the next sweep: what is given, and what is scattered of the fluence that the systems found.
void AccelerationInBlocks::ScatterFound()
{
  this->TheDomain.Collective([&] {
    for (int c = 0; c < this->Layout.channels && !this->Parts.IsEmpty(); ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->OwnNext.Write(this->Systems[c]->NextFluence());
        this->Parts.Scattering->ScatterFluence(
          c, { &this->Parts.Path }, this->OwnNext, this->OwnGiven, this->Parts.Source);
      }
    }
  });
}

/// To the systems, which have the source of the sweep without its beams and moments.
void AccelerationInBlocks::SpreadSource()
{
  std::vector<float> source;
  this->TheDomain.Collective([&] { source = this->Parts.Source.Read(); });
  this->Block.Spread(source, this->Layout.channels, this->Source);
}

/// At the surfaces of thick voxels, where others may have those beside them.
void AccelerationInBlocks::ShapeSource()
{
  const VolumeLayout& own = this->Layout;
  this->SpreadSource();
  this->TheDomain.Collective([&] {
    for (int c = 0; c < own.channels; ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->ShapeSource();
      }
    }
    const std::vector<float> source = this->Block.TakeOwn(this->Source, own.channels);
    this->Parts.Source.Write(source.data(), own.Values()); // the first moment
  });
}

/// From the source that is there to path integrals and partial currents. The light that comes in from outside comes in
/// every time.
void AccelerationInBlocks::Sweep(int iteration, const Monitor& monitor)
{
  const VolumeLayout& own = this->Layout;
  if (iteration == 1)
  {
    this->TheDomain.Collective([&] {
      if (this->Parts.BeamValues() > 0)
      {
        this->Parts.Source.CopyFrom(
          this->OwnGiven, own.Places(this->Parts.Functions()).beams, this->Parts.BeamValues());
      }
    });
  }
  if (iteration > 0)
  {
    this->ScatterFound();
    this->ShapeSource();
  }
  else
  {
    this->SpreadSource();
  }
  this->TheDomain.Collective([&] {
    this->Parts.Path.Fill(0.0f);
    this->OwnCurrents.Fill(0.0f);
  });
  const bool shines = iteration > 0 || this->Parts.HasSource();
  const SweepBoundary boundary =
    this->Parts.SweepCarriesBoundarySource() ? (*this->Parts.UsualBoundary).Boundary() : SweepBoundary();
  this->Swept->Forget();
  this->Tally = this->Swept->Apply(shines ? &this->Parts.Source : nullptr, boundary, monitor);
  std::vector<float> currents;
  this->TheDomain.Collective([&] { currents = this->OwnCurrents.Read(); });
  if (this->Faces)
  {
    this->Faces->TakeSwept();
  }
  this->Moments.Spread(this->Parts.Path, this->Path);
  this->Block.SpreadWithGhosts(currents, 6 * own.channels, this->PartialCurrents);
}

/// As DiffusionAcceleration::BeginWarm: what is guessed goes beyond what the first sweep and its systems found.
void AccelerationInBlocks::BeginWarm()
{
  const VolumeLayout& own = this->Layout;
  this->TheDomain.Collective([&] {
    this->First = this->UncollidedFluence;
    this->First.resize(own.Values());
    this->FirstMoments = this->Moments.Any() ? this->Parts.Path.Read() : std::vector<float>();
    for (int c = 0; c < own.channels && !this->Parts.IsEmpty(); ++c)
    {
      const std::vector<double> found = this->Systems[c]->Found();
      for (std::size_t i = 0; i < found.size(); ++i)
      {
        this->First[c * own.Stride() + i] += static_cast<float>(found[i]);
      }
    }
  });
  if (!this->Warm.Begins())
  {
    return;
  }
  const VolumeLayout& held = this->Block.WithGhosts();
  Buffer<float> guess;
  this->TheDomain.Collective([&] { guess = Buffer<float>(this->Parts.TheDevice, held.Floats(), "the last light"); });
  this->Block.SpreadWithGhosts(this->Warm.Guessed(), own.channels, guess);
  std::vector<float> values;
  this->TheDomain.Collective([&] { values = guess.Read(); });
  for (int c = 0; c < own.channels; ++c)
  {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(c * held.Stride());
    std::vector<double> ofChannel = this->Moments.StateOf(
      c, this->Warm.Guessed(), { begin, begin + static_cast<std::ptrdiff_t>(held.grid.VoxelCount()) });
    for (double& value : ofChannel)
    {
      value /= own.grid.VoxelVolume();
    }
    this->Systems[c]->BeginBeyond(ofChannel);
  }
  this->TheDomain.Collective([&] {
    if (this->Moments.Any() && !this->Parts.IsEmpty())
    {
      AddMoments(this->Parts.TheDevice, own, this->Parts.Functions(), this->Warm.Guess(), this->Parts.Path);
    }
  });
}

KeptLight AccelerationInBlocks::Leave() const
{
  const double rate = std::clamp(this->Rest.Ratio(), 0.5, 0.95);
  std::vector<float> moments;
  this->TheDomain.Collective([&] {
    moments = this->Moments.Any() ? this->Parts.Path.Read() : std::vector<float>();
    std::transform(moments.begin(), moments.end(), this->FirstMoments.begin(), moments.begin(), std::minus<>());
  });
  return this->Warm.Leave(this->First, moments, { rate, rate, rate });
}

/// As DiffusionAcceleration::Correct.
void AccelerationInBlocks::Correct(int iteration)
{
  double change = 0.0;
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(this->VoxelPower(c)));
    }
  }
  this->PutNextFlux();
  this->CountLight();
  if (this->Parts.Faces && this->Parts.Faces->Reflects())
  {
    Rgb given = this->GivenPower;
    std::transform(given.begin(), given.end(), this->PowerIn.begin(), given.begin(), std::plus<>());
    double ofFaces = 0.0;
    this->TheDomain.Collective([&] { ofFaces = this->Faces->OfBox().Reflect(iteration, given); });
    // Which each rank has found for itself, and not to the last bit where their devices are of other kinds.
    change = std::max(change, this->TheDomain.Comm().Largest({ ofFaces })[0]);
  }
  const double guessed = iteration == 1 && this->Warm.Begins() ? this->Warm.Rate(0) : 0.0;
  this->Residual = this->Rest.After(change, guessed);
  this->Convergence.Add(this->Residual, change, this->Ledger);
}

/// Into the moments of the path, of which the next source is scattered.
void AccelerationInBlocks::PutNextFlux()
{
  if (!this->Moments.Any())
  {
    return;
  }
  this->TheDomain.Collective([&] {
    for (int c = 0; c < this->Layout.channels; ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->PutNextFlux(this->Path);
      }
    }
  });
  this->Moments.TakeFirstDegree(this->Path, this->Parts.Path);
}

bool AccelerationInBlocks::Done(int iterations) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweepsOverRanks;
  // A guess has shown already how fast changes fall, but angular moments are not among them.
  const int least = this->Warm.Begins() && !this->Moments.Any() ? 2 : 3;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->Settings, this->Residual));
}
}
