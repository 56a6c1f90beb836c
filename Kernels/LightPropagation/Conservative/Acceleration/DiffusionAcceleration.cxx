#include "LightPropagation/Conservative/Acceleration/DiffusionAcceleration.h"

#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Diffusion/FluxLimit.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "Medium/BoxFaces.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostSweeps = 200;
}

DiffusionAcceleration::DiffusionAcceleration(TransportParts& parts, const KeptLight* kept)
  : Parts(parts)
  , TheDomain(parts.TheDomain())
  , Settings(parts.Problem.Settings())
  , TheMedium(parts.Problem.TheMedium())
  , LinearSource(parts.Problem.HasLinearSource())
  , Block(this->TheDomain, this->Settings.periodic, parts.Layout.channels, parts.Layout.sharedExtinction)
  , Coefficients(parts, this->Block)
  , Moments(this->Block, parts.Functions())
  , Warm(parts, kept, "diffusion acceleration")
{
}

IterationResult DiffusionAcceleration::Run(const Monitor& monitor)
{
  this->Uncollided.emplace(this->Parts, this->Block, this->Coefficients,
    OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, 1.0, UncollidedPart * done); }));
  this->GiveFirstScattered();
  this->ReflectUncollided();
  this->MakeSweep();
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
      this->LookAtDirect();
      this->MakeSystems();
    }
    this->Correct(iteration);
    if (iteration == 0 && this->Warm.Keeps())
    {
      this->BeginWarm();
    }
    this->TheDomain.Collective([&] { Report(ofSweep, 1.0); });
    ++iteration;
  } while (!this->Done(iteration));
  this->WriteFluence();
  this->FindSurfaceRadiance();
  this->Result.leftOut = this->Warm.LeftOut();
  if (this->Warm.Keeps())
  {
    this->Leave();
  }
  if (this->Parts.StoresMoments())
  {
    this->FindShown();
  }
  if (this->Box)
  {
    const bool shines = this->Parts.Lights.SweepCarriesBoundarySource();
    this->Result.leftByCell = this->Box->LeftByCell(
      shines ? this->Parts.Lights.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{}, this->TheMedium);
  }
  return std::move(this->Result);
}

/// Computes the scattered light to render: the next source minus emission and first-scattered light of lamps.
void DiffusionAcceleration::FindShown()
{
  TransportParts& parts = this->Parts;
  this->ScatterFound();
  this->TheDomain.Collective([&] {
    Buffer<float> shown(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light shown");
    shown.Fill(0.0f);
    if (!parts.IsEmpty())
    {
      parts.LoadEmission(shown);
      if (!this->Uncollided->PathOfLamps().empty())
      {
        parts.Path.Write(this->Uncollided->PathOfLamps().data());
        parts.Scattering->AddFirstScattered(parts.WholeDeposit(), shown);
      }
      AddToShown(parts.TheDevice, parts.Layout.Places(parts.Functions()).beams, parts.Source, shown, -1.0f);
    }
    this->Result.shown = std::move(shown);
  });
}

/// Adds the first-collision source to the given source, like emission.
void DiffusionAcceleration::GiveFirstScattered()
{
  TransportParts& parts = this->Parts;
  const int channels = parts.Layout.channels;
  std::vector<float> path = this->Uncollided->Path();
  Rgb scattered = {};
  this->TheDomain.Collective([&] {
    this->Given = Buffer<float>(parts.TheDevice, parts.Source.Read(), "the light given");
    parts.DarkenBeams(); // until the first-collision source is emitted
    parts.Path.Write(path.data());
    if (!parts.IsEmpty())
    {
      parts.Scattering->AddFirstScattered(parts.WholeDeposit(), this->Given);
    }
    this->GivenFlux =
      Buffer<float>(parts.TheDevice, this->HasMoments() ? parts.Layout.Floats(3) : 0, "the net flux given");
    this->GivenFlux.Fill(0.0f);
    if (parts.Basis)
    {
      AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), this->Given, this->GivenFlux);
    }
    const double volume = parts.Layout.grid.VoxelVolume();
    for (int c = 0; c < channels; ++c)
    {
      scattered[c] = SumOverVoxels(parts.Layout.grid, [&](std::size_t i) {
        float& here = path[c * parts.Layout.Stride() + i];
        const double power = static_cast<double>(parts.Problem.Scattering().SigmaS(i, c)) * here;
        here = static_cast<float>(here / volume);
        return power;
      });
    }
  });
  scattered = this->TheDomain.Sum(scattered);
  this->GivenPower = this->Uncollided->Ledger().Balance().emitted;
  std::transform(scattered.begin(), scattered.end(), this->GivenPower.begin(), this->GivenPower.begin(), std::plus<>());
  this->UncollidedFluence.swap(path);
  const char* what = "the diffusion system";
  this->GivenInSystems = { parts.TheDevice, this->Block, this->Given, channels, what };
  this->GivenInSystems.FillOwn();
  if (this->HasMoments())
  {
    this->GivenFluxInSystems = { parts.TheDevice, this->Block, this->GivenFlux, 3 * channels, what };
    this->GivenFluxInSystems.Fill();
  }
}

void DiffusionAcceleration::MakeSweep()
{
  TransportParts& parts = this->Parts;
  const char* what = "the power from voxel to voxel";
  this->TheDomain.Collective(
    [&] { this->PartialCurrents = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), what); });
  this->SourceInSystems = { parts.TheDevice, this->Block, parts.Source, parts.Layout.channels, "the diffusion system" };
  this->Currents = { parts.TheDevice, this->Block, this->PartialCurrents, 6 * parts.Layout.channels, what };
  this->Moments.Allocate(parts.TheDevice, "the diffusion system");
  SweepRequest request = { this->DepositOfSweep(), parts.AllRays() };
  request.sameBoundary = true;
  request.angular = parts.UsualValues();
  request.faceIn = parts.LightByCells();
  this->Swept = parts.Transport.MakeSweep(request);
}

/// No flux: the diffusion system provides it.
Deposit DiffusionAcceleration::DepositOfSweep() const
{
  const Deposit whole = this->Parts.WholeDeposit();
  return { whole.path, nullptr, &this->PartialCurrents, nullptr, whole.faceOut, whole.spreadsAside };
}

/// Sweeps the current source into path integrals and partial currents. Boundary light enters in every sweep.
void DiffusionAcceleration::Sweep(int iteration, const Monitor& monitor)
{
  this->TheDomain.Collective([&] {
    if (iteration == 1)
    {
      this->Parts.LightBeams(this->Given);
    }
  });
  this->ScatterFound();
  this->ShapeSource();
  this->TheDomain.Collective([&] {
    this->Parts.Path.Fill(0.0f);
    this->PartialCurrents.Fill(0.0f);
    this->Swept->Forget();
  });
  const bool shines = iteration > 0 || this->Parts.HasSource();
  this->Tally =
    this->Swept->Apply(shines ? &this->Parts.Source : nullptr, this->Parts.Lights.BoundaryOfSweeps(), monitor);
  if (this->Box)
  {
    this->Box->TakeSwept();
  }
  this->Moments.Spread(this->Parts.Path);
  this->Currents.Fill();
}

/// Adjusts the source at the surfaces of optically thick voxels.
void DiffusionAcceleration::ShapeSource()
{
  this->SourceInSystems.FillOwn();
  if (this->Systems.empty())
  {
    return;
  }
  this->TheDomain.Collective([&] {
    for (std::size_t c = 0; c < this->Systems.size(); ++c)
    {
      if (this->VoxelPower(static_cast<int>(c)) > 0.0)
      {
        this->Systems[c]->ShapeSource();
      }
    }
  });
  this->SourceInSystems.TakeOwn();
}

/// Reflects uncollided light; its reflected part enters in every sweep.
void DiffusionAcceleration::ReflectUncollided()
{
  TransportParts& parts = this->Parts;
  if (!parts.Faces)
  {
    return;
  }
  this->Box.emplace(parts.TheDevice, *parts.Faces, this->Block);
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->GivenPower[c] += this->Box->OfBox().GivenBack()[c];
  }
}

/// Computes the source of the next sweep from the last sweep and the diffusion solution.
void DiffusionAcceleration::ScatterFound()
{
  this->TheDomain.Collective([&] {
    for (std::size_t c = 0; c < this->Systems.size() && !this->Parts.IsEmpty(); ++c)
    {
      if (this->VoxelPower(static_cast<int>(c)) > 0.0)
      {
        this->Parts.Scattering->ScatterFluence(static_cast<int>(c), this->DepositOfSweep(),
          this->Systems[c]->NextFluence(), this->Given, this->Parts.Source);
      }
    }
  });
}

/// Fluence of the last sweep plus uncollided light, [channel][stride].
std::vector<float> DiffusionAcceleration::SweptFluence() const
{
  const double perVolume = 1.0 / this->Parts.Layout.grid.VoxelVolume();
  std::vector<float> values = this->Parts.Path.Read();
  InThreads(values.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
    {
      values[i] = std::max(static_cast<float>(values[i] * perVolume + this->UncollidedFluence[i]), 0.0f);
    }
  });
  return values;
}

void DiffusionAcceleration::MakeSystems()
{
  TransportParts& parts = this->Parts;
  const CrossingPattern pattern = FindCrossingPattern(this->TheDomain.Whole(), parts.Usual.Set(),
    this->Settings.mapResolution, parts.Usual.Starts(), this->Settings.periodic);
  const std::array<Rgb, 6> incoming =
    parts.Lights.SweepCarriesBoundarySource() ? parts.Lights.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{};
  const VolumeLayout& held = this->Block.WithGhosts();
  const GhostedMedium& medium = this->Coefficients;
  const bool passes = this->Uncollided->Passes();
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    std::array<double, 6> ofChannel, albedo = {};
    for (int face = 0; face < 6; ++face)
    {
      albedo[face] = parts.Faces ? parts.Faces->Albedo()[face][c] : 0.0;
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    const DiffusionSystem::Arrays arrays = { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(),
      &medium.sigma_t.Values(), &medium.Swept(), &medium.sigma_a.Values(), &medium.sigma_s.Values(),
      &this->GivenInSystems.Values(), this->Moments.Places(), c,
      this->HasMoments() ? &this->GivenFluxInSystems.Values() : nullptr, &this->SourceInSystems.Values(),
      &this->Moments.Values(parts.Path), &this->Currents.Values(), passes ? &this->Uncollided->Passed() : nullptr,
      passes ? &this->Uncollided->OfLamps() : nullptr, this->Box ? &this->Box->Rows(c) : nullptr, albedo };
    this->Systems.push_back(std::make_unique<DiffusionSolver>(parts.TheDevice, this->Block, parts.Usual.Set(), pattern,
      arrays, ofChannel, this->Settings.periodic, this->LinearSource));
  }
}

/// Approximate power of a voxel, W: the unit of the diffusion solver.
double DiffusionAcceleration::VoxelPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->TheDomain.Whole().VoxelCount());
}

/// Solves the diffusion system of each channel and estimates the distance from the limit of the iteration (numerics.md,
/// Eq. (73)), the largest of all channels.
void DiffusionAcceleration::Correct(int iteration)
{
  double change = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(this->VoxelPower(c)));
    }
  }
  if (this->HasMoments())
  {
    this->TheDomain.Collective([&] {
      for (int c = 0; c < this->Parts.Layout.channels; ++c)
      {
        if (this->VoxelPower(c) > 0.0)
        {
          this->Systems[c]->PutNextFlux(this->Moments.Values(this->Parts.Path));
        }
      }
    });
    this->Moments.TakeFirstDegree(this->Parts.Path);
  }
  this->CountLight();
  if (this->Parts.FacesReflect())
  {
    Rgb given = this->GivenPower;
    std::transform(given.begin(), given.end(), this->PowerIn.begin(), given.begin(), std::plus<>());
    double ofFaces = 0.0;
    this->TheDomain.Collective([&] { ofFaces = this->Box->OfBox().Reflect(iteration, given); });
    change = std::max(change, this->TheDomain.Max(ofFaces)); // devices of different ranks may round differently
  }
  const bool guessed = iteration == 1 && this->Warm.Begins() && this->Warm.Rate(0) > 0.0;
  this->Residual = this->Rest.After(change, guessed ? this->Warm.Rate(0) : 0.0);
  this->Result.convergence.Add(this->Residual, change, this->Result.ledger);
}

/// Counts the power according to the diffusion solution, which conserves it. The escaped power of the sweep serves only
/// to distribute it among the faces.
void DiffusionAcceleration::CountLight()
{
  this->Result.ledger = this->Uncollided->Ledger();
  std::vector<bool> lit(this->Parts.Layout.channels, false);
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    double entered = 0.0;
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      entered += this->Tally.in[face][c];
      ofSweep[face] = this->Tally.out[face][c];
      this->Result.ledger.Enter(c, this->Tally.in[face][c]);
    }
    if (!(this->VoxelPower(c) > 0.0))
    {
      continue; // dark channel: not solved
    }
    lit[c] = true;
    this->Result.ledger.Absorb(c, this->Systems[c]->Absorbed());
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(entered, ofSweep);
    for (int face = 0; face < 6 && !this->Box; ++face)
    {
      this->Result.ledger.Escape(c, face, outflow[face]);
    }
  }
  if (this->Box)
  {
    this->Box->TakeLeaving(lit);
    this->Box->OfBox().Count(this->Result.ledger);
  }
}

bool DiffusionAcceleration::Done(int iterations) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweeps;
  // After a guess the rate of decrease is known earlier, unless there are angular moments, which the guess does not
  // cover.
  const int least = this->Warm.Begins() && !this->HasMoments() ? 2 : 3;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->Settings, this->Residual));
}

/// Computes the uncollided fluence.
void DiffusionAcceleration::LookAtDirect()
{
  std::vector<float> direct;
  this->TheDomain.Collective([&] {
    this->Parts.Fluence.Write(this->SweptFluence().data());
    this->Result.fluenceDirect = Interleaved(this->Parts.Layout, this->Parts.Fluence, 1.0);
    direct = this->Parts.Fluence.Read();
  });
  if (this->Warm.Keeps())
  {
    this->Warm.Prepare(direct);
  }
}

/// The result of the first sweep and its diffusion solution is computed anew in each solve. The part that later
/// iterations add is kept, and added before the second sweep (numerics.md, Eq. (46d)).
void DiffusionAcceleration::BeginWarm()
{
  TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  this->TheDomain.Collective([&] {
    this->First = this->UncollidedFluence;
    this->First.resize(layout.Values());
    this->FirstMoments = this->HasMoments() ? parts.Path.Read() : std::vector<float>();
    for (int c = 0; c < layout.channels; ++c)
    {
      const std::vector<double> found = this->Systems[c]->Found();
      for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
      {
        this->First[c * layout.Stride() + i] += static_cast<float>(found[i]);
      }
    }
  });
  if (!this->Warm.Begins())
  {
    return;
  }
  GhostedBuffer guess(parts.TheDevice, this->Block, this->Warm.Guess(), layout.channels, "the last light");
  guess.Fill();
  std::vector<float> values;
  this->TheDomain.Collective([&] { values = guess.Values().Read(); });
  for (int c = 0; c < layout.channels; ++c)
  {
    this->Systems[c]->BeginBeyond(this->GuessOf(c, values));
  }
  this->TheDomain.Collective([&] {
    if (parts.Basis)
    {
      AddMoments(parts.TheDevice, layout, parts.Functions(), this->Warm.Guess(), parts.Path);
    }
  });
}

/// Guess minus the current solution of a channel, as state of its diffusion system.
/// @param fluence  with ghost cells, W length
std::vector<double> DiffusionAcceleration::GuessOf(int c, const std::vector<float>& fluence) const
{
  const VolumeLayout& held = this->Block.WithGhosts();
  const auto begin = fluence.begin() + static_cast<std::ptrdiff_t>(c * held.Stride());
  std::vector<double> state = this->Moments.StateOf(
    c, this->Warm.Guessed(), { begin, begin + static_cast<std::ptrdiff_t>(held.grid.VoxelCount()) });
  for (double& value : state)
  {
    value /= held.grid.VoxelVolume();
  }
  return state;
}

void DiffusionAcceleration::Leave()
{
  std::vector<float> moments;
  this->TheDomain.Collective([&] {
    moments = this->HasMoments() ? this->Parts.Path.Read() : std::vector<float>();
    std::transform(moments.begin(), moments.end(), this->FirstMoments.begin(), moments.begin(), std::minus<>());
  });
  const double rate = std::clamp(this->Rest.Ratio(), 0.5, 0.95);
  this->Result.warm = this->Warm.Begins();
  this->Result.kept = this->Warm.Leave(this->First, moments, { rate, rate, rate });
}

void DiffusionAcceleration::WriteFluence()
{
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->VoxelPower(c));
    }
  }
  this->CountLight();
  const std::vector<float> fluence = this->FluenceOfSystems();
  this->TheDomain.Collective([&] { this->Parts.Fluence.Write(fluence.data()); });
  if (this->Settings.netFlux)
  {
    this->WriteFlux(fluence);
  }
}

/// Fluence of the diffusion systems plus uncollided light, [channel][stride].
std::vector<float> DiffusionAcceleration::FluenceOfSystems()
{
  const VolumeLayout& layout = this->Parts.Layout;
  std::vector<float> fluence(layout.Floats(), 0.0f), path;
  this->TheDomain.Collective([&] {
    for (int c = 0; c < layout.channels; ++c)
    {
      const std::vector<double> solved = this->Systems[c]->Found();
      std::copy(solved.begin(), solved.end(), fluence.begin() + static_cast<std::ptrdiff_t>(c * layout.Stride()));
    }
    path = this->Parts.Path.Read();
  });
  const Halo around(this->TheDomain.Comm(), this->TheDomain.Partition(), this->Settings.periodic, 1);
  MakeFluence(
    this->TheDomain.Comm(), around, layout, this->TheMedium.sigma_a, fluence, std::move(path), this->UncollidedFluence);
  fluence.resize(layout.Values());
  fluence.resize(layout.Floats(), 0.0f);
  return fluence;
}

/// Adds the net flux of the diffusion systems; with angular moments that of the sweep, whose degree 1 has less of the
/// pattern of rays.
void DiffusionAcceleration::WriteFlux(const std::vector<float>& fluence)
{
  TransportParts& parts = this->Parts;
  GhostedBuffer flux(parts.TheDevice, this->Block, parts.Flux, 3 * parts.Layout.channels, "net_flux");
  flux.FillOwn();
  this->TheDomain.Collective([&] {
    for (int c = 0; c < parts.Layout.channels; ++c)
    {
      if (!this->HasMoments() && this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->AddFlux(flux.Values());
      }
    }
  });
  flux.TakeOwn();
  this->TheDomain.Collective([&] {
    if (parts.Basis)
    {
      AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), parts.Path, parts.Flux);
    }
    if (!parts.IsEmpty())
    {
      LimitFlux(parts.Layout, fluence, parts.Flux);
    }
  });
}

/// Computes the surface radiance of optically thick voxels from the powers of the diffusion system.
void DiffusionAcceleration::FindSurfaceRadiance()
{
  if (!this->LinearSource)
  {
    return;
  }
  const VolumeLayout& layout = this->Parts.Layout;
  std::vector<float> lamps = this->Uncollided->PathOfLamps();
  for (float& fluence : lamps)
  {
    fluence = static_cast<float>(fluence / layout.grid.VoxelVolume());
  }
  std::vector<SurfacePowers> powers;
  this->TheDomain.Collective([&] {
    for (int c = 0; c < layout.channels && !this->Parts.IsEmpty(); ++c)
    {
      powers.push_back(this->VoxelPower(c) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers());
      powers.back().lamps = lamps.empty() ? nullptr : lamps.data() + c * layout.Stride();
    }
  });
  this->Result.surfaceRadiance = SurfaceRadiance(
    this->TheDomain, this->Settings.periodic, this->TheMedium, layout.channels, this->Parts.Lights.Lamps, powers);
}
}
