#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"

#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/LampPassing.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
namespace
{
constexpr int MostSweeps = 200;
constexpr float Elsewhere = -1.0f; ///< sigma_s of other ranks' voxels, which are counted there
}

AccelerationInBlocks::AccelerationInBlocks(const Parts& parts)
  : The(parts)
  , LinearSource(parts.settings.source != PropagationSource::Constant)
  , Block(parts.others, parts.partition, parts.settings.periodic, parts.layout.channels, parts.layout.sharedExtinction)
  , Moments(parts.others, this->Block, parts.functions)
{
  parts.others.Collective([&] {
    const char* what = "the diffusion system";
    const VolumeLayout& held = this->Block.WithGhosts();
    const int extinctions = held.sharedExtinction ? 1 : held.channels;
    const bool any = this->Moments.Any();
    this->SigmaT = Buffer<float>(parts.device, held.FloatsOf(extinctions), what);
    this->SweptSigmaT = Buffer<float>(parts.device, any ? held.FloatsOf(extinctions) : 0, what);
    this->GivenFlux = Buffer<float>(parts.device, any ? held.Floats(3) : 0, what);
    for (Buffer<float>* array : { &this->SigmaA, &this->CountedSigmaS, &this->Given, &this->Source })
    {
      *array = Buffer<float>(parts.device, held.Floats(), what);
    }
    this->Path = Buffer<float>(parts.device, this->Moments.HeldFloats(), what);
    this->OwnNext = ExactValues(parts.device, parts.layout.grid.VoxelCount(), what);
    this->PartialCurrents = Buffer<float>(parts.device, held.Floats(6), what);
    this->OwnCurrents = Buffer<float>(parts.device, parts.layout.Floats(6), "the power from voxel to voxel");
  });
  this->SpreadMedium();
}

void AccelerationInBlocks::SpreadMedium()
{
  const VolumeLayout& own = this->The.layout;
  const int extinctions = own.sharedExtinction ? 1 : own.channels;
  std::vector<float> sigmaT, swept, sigmaA;
  this->The.others.Collective([&] {
    sigmaT = this->The.medium.TransportSigmaT().Read();
    swept = this->The.medium.SigmaT().Read();
    this->OwnSigmaS = this->The.medium.SigmaS().Read();
    const Field& absorption = this->The.scene.medium.sigma_a;
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
  const bool own = this->Block.Has() && AnyVoxelIsThickerThan(ThickForFirstMoments, this->The.scene.medium);
  return OnAnyRank(this->The.others, own) && this->LinearSource;
}

SweepTally AccelerationInBlocks::AddBeams(const Monitor& monitor)
{
  const std::vector<Light>& lamps = this->The.lamps;
  Deposit more = this->DepositOfSweep(); // with the faces' cells, as sweeps have them
  more.flux = this->The.flux.Size() > 0 ? &this->The.flux : nullptr;
  this->Beams =
    std::make_unique<BeamsInThickBlocks>(this->The.device, this->The.others, this->Block, this->The.path.Size(),
      BeamsInThickBlocks::Coefficients{
        this->SigmaT, this->SigmaA, this->CountedSigmaS, this->Moments.Any() ? this->SweptSigmaT : this->SigmaT });
  SweepTally tally;
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    const double all = static_cast<double>(lamps.size());
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    const bool shines = Sum(lamps[i].power) > 0.0;
    Add(tally, shines ? this->Beams->Add(i, this->The.addLamp, this->The.path, more, ofLamp) : SweepTally());
  }
  this->Beams->Finish();
  return tally;
}

ConvergenceRecord AccelerationInBlocks::Run(const Monitor& monitor)
{
  this->GiveFirstScattered();
  this->ReflectUncollided();
  SweepRequest request = { this->DepositOfSweep(),
    { { 0, this->The.directions.Along(0) }, { 1, this->The.directions.Along(1) },
      { 2, this->The.directions.Along(2) } } };
  request.faceIn = this->The.faces && this->The.faces->Reflects() ? &this->The.faces->In() : nullptr;
  request.angular = this->The.angular ? &this->The.angular->Values() : nullptr;
  this->Swept = this->The.makeSweep(request);
  int iteration = 0;
  do
  {
    const double before = iteration == 0 ? UncollidedPart : iteration;
    const Monitor ofSweep = OfPart(monitor, [=](double done) {
      return ProgressOf(this->The.settings, this->Residual, before + (iteration + 1 - before) * done);
    });
    this->Sweep(iteration, ofSweep);
    if (iteration == 0)
    {
      this->TakeDirect();
      this->MakeSystems();
    }
    this->Correct(iteration);
    if (iteration == 0 && this->The.warm.Keeps())
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
  const VolumeLayout& own = this->The.layout;
  const double volume = own.grid.VoxelVolume();
  std::vector<double> sums(6, 0.0); // scattered, and absorbed before
  this->The.others.Collective([&] {
    this->UncollidedFluence = this->The.path.Read();
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
      sums[3 + c] = SumOverVoxels(own.grid, [&](std::size_t i) {
        return volume * this->The.scene.medium.sigma_a.At(i, c) * this->UncollidedFluence[first + i];
      });
    }
  });
  sums = this->The.others.Sum(sums);
  for (int c = 0; c < 3; ++c)
  {
    this->GivenPower[c] = this->The.ledger.Balance().emitted[c] + sums[c];
    this->The.ledger.Absorb(c, sums[3 + c]);
  }
  this->OfUncollided = this->The.ledger;
}

/// Beams of the source are dark until what is first scattered shines.
void AccelerationInBlocks::FindGiven()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> given, flux;
  this->The.others.Collective([&] {
    if (this->Moments.Any() && this->Block.Has() && this->The.flux.Size() > 0)
    {
      AddFluxOfMoments(this->The.device, own, this->The.functions, this->The.path, this->The.flux);
    }
    given = this->The.source.Read();
    this->OwnGiven = Buffer<float>(this->The.device, given, "the light given");
    if (this->Block.Has())
    {
      this->The.source.Fill(0.0f, own.Places(this->The.functions).beams, this->BeamValues());
      this->The.scattering.AddFirstScattered({ &this->The.path }, this->OwnGiven);
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

std::size_t AccelerationInBlocks::BeamValues() const
{
  return this->The.angular ? this->The.angular->Beams() * this->The.layout.Values() : 0;
}

/// Net flux of the block's angular moments, as Parts::flux.
std::vector<float> AccelerationInBlocks::FluxOf(const Buffer<float>& moments) const
{
  Buffer<float> flux(this->The.device, this->The.layout.Floats(3), "the net flux given");
  flux.Fill(0.0f);
  if (this->Block.Has())
  {
    AddFluxOfMoments(this->The.device, this->The.layout, this->The.functions, moments, flux);
  }
  return flux.Read();
}

/// What of uncollided light comes back comes back every time.
void AccelerationInBlocks::ReflectUncollided()
{
  if (!this->The.faces)
  {
    return;
  }
  this->Faces =
    std::make_unique<FaceBalanceInBlocks>(this->The.device, this->The.others, *this->The.faces, this->Block);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    this->GivenPower[c] += this->Faces->OfBox().GivenBack()[c];
  }
}

/// No flux: it comes from the systems.
Deposit AccelerationInBlocks::DepositOfSweep() const
{
  const FaceLight* const faces = this->The.faces;
  return { &this->The.path, nullptr, &this->OwnCurrents, nullptr, faces ? &faces->Out() : nullptr,
    faces && !faces->Reflects() };
}

/// W of a voxel, about: the unit that the system's solver works in.
double AccelerationInBlocks::VoxelPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->The.partition.whole.VoxelCount());
}

void AccelerationInBlocks::MakeSystems()
{
  const Grid& whole = this->The.partition.whole;
  const VolumeLayout& held = this->Block.WithGhosts();
  const SweptDirections& directions = this->The.directions;
  const bool any = this->Moments.Any();
  const CrossingPattern pattern = FindCrossingPattern(
    whole, directions.Set(), this->The.settings.mapResolution, directions.Starts(), this->The.settings.periodic);
  const std::array<Rgb, 6> incoming =
    this->The.boundary.Shines() ? this->The.boundary.IncomingPower() : std::array<Rgb, 6>{};
  for (int c = 0; c < held.channels; ++c)
  {
    std::array<double, 6> ofChannel, albedo = {};
    for (int face = 0; face < 6; ++face)
    {
      albedo[face] = this->The.faces ? this->The.faces->Albedo()[face][c] : 0.0;
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    const DiffusionSystem::Arrays arrays = { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(), &this->SigmaT,
      any ? &this->SweptSigmaT : &this->SigmaT, &this->SigmaA, &this->CountedSigmaS, &this->Given,
      this->Moments.Places(), c, any ? &this->GivenFlux : nullptr, &this->Source, &this->Path, &this->PartialCurrents,
      this->Beams ? &this->Beams->Passed() : nullptr, this->Beams ? &this->Beams->OfLamps() : nullptr,
      this->Faces ? &this->Faces->Rows(c) : nullptr, albedo };
    this->Systems.push_back(std::make_unique<BalanceOverRanks>(this->The.device, this->The.others, this->The.partition,
      this->Block, directions.Set(), pattern, arrays, ofChannel, this->The.settings.periodic, this->LinearSource));
  }
}

/// The source of the next sweep: what is given, and what is scattered of the fluence that the systems found.
void AccelerationInBlocks::ScatterFound()
{
  this->The.others.Collective([&] {
    for (int c = 0; c < this->The.layout.channels && this->Block.Has(); ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->OwnNext.Write(this->Systems[c]->NextFluence());
        this->The.scattering.ScatterFluence(c, { &this->The.path }, this->OwnNext, this->OwnGiven, this->The.source);
      }
    }
  });
}

/// To the systems, which have the source of the sweep without its beams and moments.
void AccelerationInBlocks::SpreadSource()
{
  std::vector<float> source;
  this->The.others.Collective([&] { source = this->The.source.Read(); });
  this->Block.Spread(source, this->The.layout.channels, this->Source);
}

/// At the surfaces of thick voxels, where others may have those beside them.
void AccelerationInBlocks::ShapeSource()
{
  const VolumeLayout& own = this->The.layout;
  this->SpreadSource();
  this->The.others.Collective([&] {
    for (int c = 0; c < own.channels; ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->ShapeSource();
      }
    }
    const std::vector<float> source = this->Block.TakeOwn(this->Source, own.channels);
    this->The.source.Write(source.data(), own.Values()); // the first moment
  });
}

/// From the source that is there to path integrals and partial currents. The light that comes in from outside comes in
/// every time.
void AccelerationInBlocks::Sweep(int iteration, const Monitor& monitor)
{
  const VolumeLayout& own = this->The.layout;
  if (iteration == 1)
  {
    this->The.others.Collective([&] {
      if (this->BeamValues() > 0)
      {
        this->The.source.CopyFrom(this->OwnGiven, own.Places(this->The.functions).beams, this->BeamValues());
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
  this->The.others.Collective([&] {
    this->The.path.Fill(0.0f);
    this->OwnCurrents.Fill(0.0f);
  });
  const bool shines = iteration > 0 || this->The.shines;
  const SweepBoundary boundary = this->The.boundary.Shines() ? this->The.boundary.Boundary() : SweepBoundary();
  this->Swept->Forget();
  this->Tally = this->Swept->Apply(shines ? &this->The.source : nullptr, boundary, monitor);
  std::vector<float> currents;
  this->The.others.Collective([&] { currents = this->OwnCurrents.Read(); });
  if (this->Faces)
  {
    this->Faces->TakeSwept();
  }
  this->Moments.Spread(this->The.path, this->Path);
  this->Block.SpreadWithGhosts(currents, 6 * own.channels, this->PartialCurrents);
}

/// As DiffusionAcceleration::BeginWarm: what is guessed goes beyond what the first sweep and its systems found.
void AccelerationInBlocks::BeginWarm()
{
  const VolumeLayout& own = this->The.layout;
  this->The.others.Collective([&] {
    this->First = this->UncollidedFluence;
    this->First.resize(own.Values());
    this->FirstMoments = this->Moments.Any() ? this->The.path.Read() : std::vector<float>();
    for (int c = 0; c < own.channels && this->Block.Has(); ++c)
    {
      const std::vector<double> found = this->Systems[c]->Found();
      for (std::size_t i = 0; i < found.size(); ++i)
      {
        this->First[c * own.Stride() + i] += static_cast<float>(found[i]);
      }
    }
  });
  if (!this->The.warm.Begins())
  {
    return;
  }
  const VolumeLayout& held = this->Block.WithGhosts();
  Buffer<float> guess;
  this->The.others.Collective([&] { guess = Buffer<float>(this->The.device, held.Floats(), "the last light"); });
  this->Block.SpreadWithGhosts(this->The.warm.Guessed(), own.channels, guess);
  std::vector<float> values;
  this->The.others.Collective([&] { values = guess.Read(); });
  for (int c = 0; c < own.channels; ++c)
  {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(c * held.Stride());
    std::vector<double> ofChannel = this->Moments.StateOf(
      c, this->The.warm.Guessed(), { begin, begin + static_cast<std::ptrdiff_t>(held.grid.VoxelCount()) });
    for (double& value : ofChannel)
    {
      value /= own.grid.VoxelVolume();
    }
    this->Systems[c]->BeginBeyond(ofChannel);
  }
  this->The.others.Collective([&] {
    if (this->Moments.Any() && this->Block.Has())
    {
      AddMoments(this->The.device, own, this->The.functions, this->The.warm.Guess(), this->The.path);
    }
  });
}

KeptLight AccelerationInBlocks::Leave() const
{
  const double rate = std::clamp(this->Rest.Ratio(), 0.5, 0.95);
  std::vector<float> moments;
  this->The.others.Collective([&] {
    moments = this->Moments.Any() ? this->The.path.Read() : std::vector<float>();
    std::transform(moments.begin(), moments.end(), this->FirstMoments.begin(), moments.begin(), std::minus<>());
  });
  return this->The.warm.Leave(this->First, moments, { rate, rate, rate });
}

/// As DiffusionAcceleration::Correct.
void AccelerationInBlocks::Correct(int iteration)
{
  double change = 0.0;
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(this->VoxelPower(c)));
    }
  }
  this->PutNextFlux();
  this->CountLight();
  if (this->The.faces && this->The.faces->Reflects())
  {
    Rgb given = this->GivenPower;
    std::transform(given.begin(), given.end(), this->PowerIn.begin(), given.begin(), std::plus<>());
    double ofFaces = 0.0;
    this->The.others.Collective([&] { ofFaces = this->Faces->OfBox().Reflect(iteration, given); });
    // Which each rank has found for itself, and not to the last bit where their devices are of other kinds.
    change = std::max(change, this->The.others.Largest({ ofFaces })[0]);
  }
  const double guessed = iteration == 1 && this->The.warm.Begins() ? this->The.warm.Rate(0) : 0.0;
  this->Residual = this->Rest.After(change, guessed);
  this->Convergence.Add(this->Residual, change, this->The.ledger);
}

/// Into the moments of the path, of which the next source is scattered.
void AccelerationInBlocks::PutNextFlux()
{
  if (!this->Moments.Any())
  {
    return;
  }
  this->The.others.Collective([&] {
    for (int c = 0; c < this->The.layout.channels; ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->PutNextFlux(this->Path);
      }
    }
  });
  this->Moments.TakeFirstDegree(this->Path, this->The.path);
}

bool AccelerationInBlocks::Done(int iterations) const
{
  const int most = this->The.settings.maximumOrders > 0 ? this->The.settings.maximumOrders : MostSweeps;
  // A guess has shown already how fast changes fall, but angular moments are not among them.
  const int least = this->The.warm.Begins() && !this->Moments.Any() ? 2 : 3;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->The.settings, this->Residual));
}
}
