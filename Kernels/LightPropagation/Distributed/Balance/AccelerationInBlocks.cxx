#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"

#include "Device/HostThreads.h"
#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/FluxLimit.h"
#include "LightPropagation/Diffusion/LampPassing.h"
#include "LightPropagation/Distributed/Balance/SurfaceInBlocks.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

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
{
  parts.others.Together([&] {
    const char* what = "the diffusion system";
    const VolumeLayout& held = this->Block.WithGhosts();
    const int extinctions = held.sharedExtinction ? 1 : held.channels;
    this->SigmaT = Buffer<float>(parts.device, extinctions * held.Stride() + SweepPadding, what);
    for (Buffer<float>* array : { &this->SigmaA, &this->CountedSigmaS, &this->Given, &this->Source, &this->Path })
    {
      *array = Buffer<float>(parts.device, held.Floats(), what);
    }
    this->PartialCurrents = Buffer<float>(parts.device, held.Floats(6), what);
    this->OwnCurrents = Buffer<float>(parts.device, parts.layout.Floats(6), "the power from voxel to voxel");
  });
  this->SpreadMedium();
}

void AccelerationInBlocks::SpreadMedium()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> sigmaT, sigmaA;
  this->The.others.Together([&] {
    sigmaT = this->The.medium.SigmaT().Read();
    this->OwnSigmaS = this->The.medium.SigmaS().Read();
    const Field& absorption = this->The.scene.medium.sigma_a;
    sigmaA = Planar(own, own.channels, [&](std::size_t i, int c) { return absorption.At(i, c); });
  });
  this->Block.SpreadWithGhosts(sigmaT, own.sharedExtinction ? 1 : own.channels, this->SigmaT);
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
  const VolumeLayout whole = { this->The.partition.whole, this->The.layout.channels,
    this->The.layout.sharedExtinction };
  this->Beams = std::make_unique<BeamsInThickBlocks>(this->The.device, this->The.others, this->Block, whole,
    this->The.settings.periodic, BeamsInThickBlocks::Coefficients{ this->SigmaT, this->SigmaA, this->CountedSigmaS });
  SweepTally tally;
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    const double all = static_cast<double>(lamps.size());
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    Add(tally, this->Beams->Add(lamps[i], this->The.makeSweep, this->The.addNearLamp, this->The.path, more, ofLamp));
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
  this->Swept = this->The.makeSweep(request);
  int iteration = 0;
  do
  {
    const double before = iteration == 0 ? UncollidedPart : iteration;
    const Monitor ofSweep = OfPart(monitor, [=](double done) {
      return ProgressOf(this->The.settings, this->Residual, before + (iteration + 1 - before) * done);
    });
    this->Sweep(iteration == 0, ofSweep);
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
  const VolumeLayout& own = this->The.layout;
  const double volume = own.grid.VoxelVolume();
  std::vector<double> sums(6, 0.0); // scattered, and absorbed before
  this->The.others.Together([&] {
    this->OwnGiven = this->The.source.Read();
    this->UncollidedFluence = this->The.path.Read();
    for (int c = 0; c < own.channels; ++c)
    {
      const std::size_t first = c * own.Stride();
      sums[c] = SumOverVoxels(own.grid, [&](std::size_t i) {
        float& here = this->UncollidedFluence[first + i];
        const double scattered = static_cast<double>(this->OwnSigmaS[first + i]) * here;
        this->OwnGiven[first + i] += static_cast<float>(scattered / (4.0 * Pi * volume));
        here = static_cast<float>(here / volume);
        return scattered;
      });
      sums[3 + c] = SumOverVoxels(own.grid, [&](std::size_t i) {
        return volume * this->The.scene.medium.sigma_a.At(i, c) * this->UncollidedFluence[first + i];
      });
    }
  });
  this->Block.Spread(this->OwnGiven, own.channels, this->Given);
  sums = this->The.others.Sum(sums);
  for (int c = 0; c < 3; ++c)
  {
    this->GivenPower[c] = this->The.ledger.Balance().emitted[c] + sums[c];
    this->The.ledger.Absorb(c, sums[3 + c]);
  }
  this->OfUncollided = this->The.ledger;
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
      &this->SigmaT, &this->SigmaA, &this->CountedSigmaS, &this->Given, held.Places(1), c, nullptr, &this->Source,
      &this->Path, &this->PartialCurrents, this->Beams ? &this->Beams->Passed() : nullptr,
      this->Beams ? &this->Beams->OfLamps() : nullptr, this->Faces ? &this->Faces->Rows(c) : nullptr, albedo };
    this->Systems.push_back(std::make_unique<BalanceOverRanks>(this->The.device, this->The.others, this->The.partition,
      this->Block, directions.Set(), pattern, arrays, ofChannel, this->The.settings.periodic, this->LinearSource));
  }
}

/// The source of the next sweep: what is given, and what is scattered of the fluence that the systems found.
void AccelerationInBlocks::ScatterFound()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> source = this->OwnGiven;
  this->The.others.Together([&] {
    for (int c = 0; c < own.channels; ++c)
    {
      const std::vector<double> next = this->Systems[c]->NextFluence();
      const std::size_t first = c * own.Stride();
      InThreads(this->VoxelPower(c) > 0.0 ? own.grid.VoxelCount() : 0, 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
        {
          const double fluence = std::max(next[this->Block.PlaceOf(i)], 0.0); // a system's can be negative
          const double scattered = this->OwnSigmaS[first + i] * fluence / (4.0 * Pi);
          source[first + i] = static_cast<float>(std::max(source[first + i] + scattered, 0.0));
        }
      });
    }
  });
  this->Block.Spread(source, own.channels, this->Source);
  this->The.others.Together([&] {
    for (int c = 0; c < own.channels; ++c)
    {
      if (this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->ShapeSource();
      }
    }
    source = this->Block.TakeOwn(this->Source, own.channels);
    this->The.source.Write(source.data(), source.size());
  });
}

/// From the source that is there to path integrals and partial currents. The light that comes in from outside comes in
/// every time.
void AccelerationInBlocks::Sweep(bool first, const Monitor& monitor)
{
  const VolumeLayout& own = this->The.layout;
  if (!first)
  {
    this->ScatterFound();
  }
  this->The.path.Fill(0.0f);
  this->OwnCurrents.Fill(0.0f);
  const bool shines = !first || this->The.shines;
  const SweepBoundary boundary = this->The.boundary.Shines() ? this->The.boundary.Boundary() : SweepBoundary();
  this->Swept->Forget();
  this->Tally = this->Swept->Apply(shines ? &this->The.source : nullptr, boundary, monitor);
  std::vector<float> source, path, currents;
  this->The.others.Together([&] {
    source = this->The.source.Read();
    path = this->The.path.Read();
    currents = this->OwnCurrents.Read();
  });
  if (first)
  {
    this->Block.Spread(source, own.channels, this->Source);
  }
  if (this->Faces)
  {
    this->Faces->TakeSwept();
  }
  this->Block.Spread(path, own.channels, this->Path);
  this->Block.SpreadWithGhosts(currents, 6 * own.channels, this->PartialCurrents);
}

void AccelerationInBlocks::TakeDirect()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> direct;
  this->The.others.Together([&] {
    if (!this->Block.Has())
    {
      return;
    }
    std::vector<float> values = this->The.path.Read();
    const double volume = own.grid.VoxelVolume();
    for (std::size_t i = 0; i < values.size() && i < this->UncollidedFluence.size(); ++i)
    {
      values[i] = std::max(static_cast<float>(values[i] / volume + this->UncollidedFluence[i]), 0.0f);
    }
    this->The.fluence.Write(values.data());
    this->FluenceDirect = Interleaved(own, this->The.fluence, 1.0);
    direct = std::move(values);
  });
  if (this->The.warm.Keeps())
  {
    this->The.warm.Prepare(direct);
  }
}

/// As DiffusionAcceleration::BeginWarm: what is guessed goes beyond what the first sweep and its systems found.
void AccelerationInBlocks::BeginWarm()
{
  const VolumeLayout& own = this->The.layout;
  this->The.others.Together([&] {
    this->First = this->UncollidedFluence;
    this->First.resize(own.Values());
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
  this->The.others.Together([&] { guess = Buffer<float>(this->The.device, held.Floats(), "the last light"); });
  this->Block.SpreadWithGhosts(this->The.warm.Guessed(), own.channels, guess);
  std::vector<float> values;
  this->The.others.Together([&] { values = guess.Read(); });
  for (int c = 0; c < own.channels; ++c)
  {
    std::vector<double> ofChannel(held.grid.VoxelCount());
    std::transform(values.begin() + static_cast<std::ptrdiff_t>(c * held.Stride()),
      values.begin() + static_cast<std::ptrdiff_t>(c * held.Stride() + ofChannel.size()), ofChannel.begin(),
      [&](float value) { return value / own.grid.VoxelVolume(); });
    this->Systems[c]->BeginBeyond(ofChannel);
  }
}

KeptLight AccelerationInBlocks::Leave() const
{
  const double rate = std::clamp(this->Rest.Ratio(), 0.5, 0.95);
  return this->The.warm.Leave(this->First, {}, { rate, rate, rate });
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
  this->CountLight();
  if (this->The.faces && this->The.faces->Reflects())
  {
    Rgb given = this->GivenPower;
    std::transform(given.begin(), given.end(), this->PowerIn.begin(), given.begin(), std::plus<>());
    double ofFaces = 0.0;
    this->The.others.Together([&] { ofFaces = this->Faces->OfBox().Reflect(iteration, given); });
    change = std::max(change, ofFaces);
  }
  const double guessed = iteration == 1 && this->The.warm.Begins() ? this->The.warm.Rate(0) : 0.0;
  this->Residual = this->Rest.After(change, guessed);
  this->Convergence.Add(this->Residual, change, this->The.ledger);
}

void AccelerationInBlocks::CountLight()
{
  this->The.ledger = this->OfUncollided;
  std::vector<bool> lit(this->The.layout.channels, false);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    double entered = 0.0;
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      entered += this->Tally.in[face][c];
      ofSweep[face] = this->Tally.out[face][c];
      this->The.ledger.Enter(c, this->Tally.in[face][c]);
    }
    if (!(this->VoxelPower(c) > 0.0))
    {
      continue; // dark: never solved for
    }
    this->The.ledger.Absorb(c, this->Systems[c]->Absorbed());
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(entered, ofSweep);
    lit[c] = true;
    for (int face = 0; face < 6 && !this->Faces; ++face)
    {
      this->The.ledger.Escape(c, face, outflow[face]);
    }
  }
  if (this->Faces)
  {
    this->Faces->TakeLeaving(lit);
    this->Faces->OfBox().Count(this->The.ledger);
  }
}

bool AccelerationInBlocks::Done(int iterations) const
{
  const int most = this->The.settings.maximumOrders > 0 ? this->The.settings.maximumOrders : MostSweeps;
  const int least = this->The.warm.Begins() ? 2 : 3; // a guess has shown already how fast changes fall
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->The.settings, this->Residual));
}

/// Where the system's solution is negative, the fluence of the last sweep stands.
void AccelerationInBlocks::WriteFluence()
{
  const VolumeLayout& own = this->The.layout;
  for (int c = 0; c < own.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->VoxelPower(c));
    }
  }
  this->CountLight();
  this->The.others.Together([&] {
    if (!this->Block.Has())
    {
      return;
    }
    const double perVolume = 1.0 / own.grid.VoxelVolume();
    const std::vector<float> path = this->The.path.Read();
    std::vector<float> fluence(path.size(), 0.0f);
    const bool withFlux = this->The.flux.Size() > 0;
    Buffer<float> flux(this->The.device, withFlux ? this->Block.WithGhosts().Floats(3) : 0, "net_flux");
    flux.Fill(0.0f);
    for (int c = 0; c < own.channels; ++c)
    {
      const std::vector<double> solved = this->Systems[c]->Found();
      for (std::size_t i = 0; i < solved.size(); ++i)
      {
        const std::size_t at = c * own.Stride() + i;
        const double found = solved[i] >= 0.0 ? solved[i] : path[at] * perVolume;
        fluence[at] = std::max(static_cast<float>(found + this->UncollidedFluence[at]), 0.0f);
      }
      if (withFlux && this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->AddFlux(flux);
      }
    }
    this->The.fluence.Write(fluence.data());
    if (withFlux)
    {
      std::vector<float> all = this->The.flux.Read();
      const std::vector<float> found = this->Block.TakeOwn(flux, 3 * own.channels);
      std::transform(all.begin(), all.end(), found.begin(), all.begin(), std::plus<float>());
      this->The.flux.Write(all.data());
      LimitFlux(own, fluence, this->The.flux);
    }
  });
}

std::vector<double> AccelerationInBlocks::LeftByCell() const
{
  const BoundaryLight& boundary = this->The.boundary;
  return this->Faces->LeftByCell(
    boundary.Shines() ? boundary.IncomingPower() : std::array<Rgb, 6>{}, this->The.scene.medium);
}

std::vector<float> AccelerationInBlocks::FindSurfaceRadiance() const
{
  if (!this->LinearSource)
  {
    return {};
  }
  const VolumeLayout& own = this->The.layout;
  std::vector<SurfacePowers> powers;
  this->The.others.Together([&] {
    for (int c = 0; c < own.channels && this->Block.Has(); ++c)
    {
      powers.push_back(this->VoxelPower(c) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers());
      powers.back().lamps = this->The.lamps.empty() ? nullptr : this->UncollidedFluence.data() + c * own.Stride();
    }
  });
  return SurfaceRadianceInBlocks(this->The.others, this->The.partition, this->The.scene.medium,
    this->The.settings.periodic, own.channels, this->The.lamps, powers);
}
}
