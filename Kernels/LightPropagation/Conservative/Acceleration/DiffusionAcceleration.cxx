#include "LightPropagation/Conservative/Acceleration/DiffusionAcceleration.h"

#include "Device/HostThreads.h"
#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <cmath>
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
  , Arrays(parts)
  , Warm(parts, kept, "diffusion acceleration")
{
}

IterationResult DiffusionAcceleration::Run(const Monitor& monitor)
{
  this->Uncollided.emplace(this->Parts, this->Arrays.Block(), this->Arrays.Medium(),
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
    this->Result.leftByCell =
      this->Box->LeftWithoutPattern(shines ? this->Parts.Lights.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{},
        this->Parts.Problem.TheMedium());
  }
  return std::move(this->Result);
}

/// Computes Result.shown, the scattered light to render: the next source minus emission and first-scattered light of
/// lamps.
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

/// Adds the first-collision source to Arrays.Given(), the source that stays the same in all iterations, which already
/// contains the emission.
void DiffusionAcceleration::GiveFirstScattered()
{
  TransportParts& parts = this->Parts;
  const int channels = parts.Layout.channels;
  std::vector<float> path = this->Uncollided->Path();
  this->Arrays.Give(path);
  Rgb scattered = {};
  this->TheDomain.Collective([&] {
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
}

void DiffusionAcceleration::MakeSweep()
{
  TransportParts& parts = this->Parts;
  SweepRequest request = { this->DepositOfSweep(), parts.AllRays() };
  request.sameBoundary = true;
  request.angular = parts.UsualValues();
  request.faceIn = parts.LightByCells();
  this->Swept = parts.Scattered.make(request);
}

/// Arrays that a sweep adds to. Net flux is not among them, since the diffusion systems compute it.
Deposit DiffusionAcceleration::DepositOfSweep()
{
  const Deposit whole = this->Parts.WholeDeposit();
  return { whole.path, nullptr, &this->Arrays.PartialCurrents(), nullptr, whole.faceOut, whole.spreadsAside };
}

/// Sweeps once: transports the light of the current source and the boundary light, which is incident in every sweep,
/// and computes path integrals and partial currents.
void DiffusionAcceleration::Sweep(int iteration, const Monitor& monitor)
{
  this->TheDomain.Collective([&] {
    if (iteration == 1)
    {
      this->Parts.LightBeams(this->Arrays.Given());
    }
  });
  this->ScatterFound();
  this->ShapeSource();
  this->TheDomain.Collective([&] {
    this->Parts.Path.Fill(0.0f);
    this->Arrays.PartialCurrents().Fill(0.0f);
    this->Swept->Forget();
  });
  const bool shines = iteration > 0 || this->Parts.HasSource();
  this->Tally =
    this->Swept->Apply(shines ? &this->Parts.Source : nullptr, this->Parts.Lights.BoundaryOfSweeps(), monitor);
  if (this->Box)
  {
    this->Box->TakeSwept();
  }
  this->Arrays.TakeSwept();
}

/// Adjusts the source of the next sweep in optically thick voxels next to thinner ones (DiffusionSystem::ShapeSource).
void DiffusionAcceleration::ShapeSource()
{
  this->Arrays.TakeSource();
  if (this->Systems.empty())
  {
    return;
  }
  this->Arrays.ChangeSource([&] {
    for (std::size_t c = 0; c < this->Systems.size(); ++c)
    {
      if (this->VoxelPower(static_cast<int>(c)) > 0.0)
      {
        this->Systems[c]->ShapeSource();
      }
    }
  });
}

/// Reflects the uncollided light that left through the box faces. The reflected power is incident in every sweep.
void DiffusionAcceleration::ReflectUncollided()
{
  TransportParts& parts = this->Parts;
  if (!parts.Faces)
  {
    return;
  }
  this->Box.emplace(parts.TheDevice, *parts.Faces, this->Arrays.Block());
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->GivenPower[c] += this->Box->GivenBack()[c];
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
          this->Systems[c]->NextFluence(), this->Arrays.Given(), this->Parts.Source);
      }
    }
  });
}

/// Fluence of the last sweep plus uncollided fluence, W / length^2, [channel][voxel]; not negative.
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
  const SweepModel model = parts.Scattered.model();
  const std::array<Rgb, 6> incoming =
    parts.Lights.SweepCarriesBoundarySource() ? parts.Lights.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{};
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    std::array<double, 6> ofChannel;
    for (int face = 0; face < 6; ++face)
    {
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    this->Systems.push_back(std::make_unique<DiffusionSolver>(parts.TheDevice, this->Arrays.Block(), model,
      this->Arrays.OfChannel(c, *this->Uncollided, this->Box ? &this->Box->Rows(c) : nullptr), ofChannel,
      this->Settings.periodic, parts.Problem.HasLinearSource()));
  }
}

/// Mean emitted and incident power per voxel, W: the unit of power in the diffusion solver. 0 for a channel without
/// light.
double DiffusionAcceleration::VoxelPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->TheDomain.Whole().VoxelCount());
}

/// Solves the diffusion system of each channel, and estimates the residual of the iteration (numerics.md, Eq. (73)),
/// the largest of all channels.
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
    this->Arrays.ChangePath([&](const Buffer<float>& path) {
      for (int c = 0; c < this->Parts.Layout.channels; ++c)
      {
        if (this->VoxelPower(c) > 0.0)
        {
          this->Systems[c]->PutNextFlux(path);
        }
      }
    });
  }
  this->CountLight();
  if (this->Parts.FacesReflect())
  {
    Rgb given = this->GivenPower;
    std::transform(given.begin(), given.end(), this->PowerIn.begin(), given.begin(), std::plus<>());
    change = std::max(change, this->Box->Reflect(iteration, given));
  }
  const bool guessed = iteration == 1 && this->Warm.Begins() && this->Warm.Rate(0) > 0.0;
  this->Residual = this->Rest.After(change, guessed ? this->Warm.Rate(0) : 0.0);
  this->Result.convergence.Add(this->Residual, change, this->Result.ledger);
}

/// Sets the energy balance from the diffusion solution, which conserves power. The escaped power of the sweep only
/// determines how the escaped power is divided among the box faces.
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
      continue; // a channel without light is not solved
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
    this->Box->Count(this->Result.ledger);
  }
  this->Result.ledger.ShareEscaped();
}

bool DiffusionAcceleration::Done(int iterations) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweeps;
  // Least number of sweeps after which the rate of convergence is known. It is 2 after a warm start, which uses the
  // rate of the previous solve, else 3. With angular moments it is always 3, because the measured change of the light
  // does not include the change of moments.
  const int least = this->Warm.Begins() && !this->HasMoments() ? 2 : 3;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->Settings, this->Residual));
}

/// Stores the uncollided fluence in Result.fluenceDirect and, if light is kept from solve to solve, computes the
/// initial guess of the warm start.
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

/// Warm start: stores the light of the first iteration, which each solve computes anew. Before the second sweep, adds
/// the initial guess: the light that the later iterations of the previous solve added to that of its first one
/// (numerics.md, Eq. (46d)).
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
  GhostedBuffer guess(parts.TheDevice, this->Arrays.Block(), this->Warm.Guess(), layout.channels, "the last light");
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

/// Initial guess of a channel's diffusion system, W / length^2: fluence by voxel with ghost cells; with angular
/// moments, followed by the moments of degree 1, [x, y, z][voxel].
/// @param fluence  path integrals of the guess with ghost cells, W length
std::vector<double> DiffusionAcceleration::GuessOf(int c, const std::vector<float>& fluence) const
{
  const VolumeLayout& held = this->Arrays.Block().WithGhosts();
  const auto begin = fluence.begin() + static_cast<std::ptrdiff_t>(c * held.Stride());
  std::vector<double> state = this->Arrays.Moments().StateOf(
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
  this->WriteFluenceOfSystems();
  if (this->Settings.netFlux)
  {
    this->WriteFlux();
  }
}

/// Writes the fluence of the diffusion systems plus uncollided fluence, W / length^2, to Parts.Fluence; nowhere below
/// Result.fluenceDirect.
void DiffusionAcceleration::WriteFluenceOfSystems()
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
  const Field& sigma_a = this->Parts.Problem.TheMedium().sigma_a;
  MakeFluence(this->TheDomain.Comm(), around, layout, sigma_a, fluence, std::move(path), this->UncollidedFluence);
  fluence.resize(layout.Values());
  fluence.resize(layout.Floats(), 0.0f);
  this->TheDomain.Collective([&] { this->Parts.Fluence.Write(fluence.data()); });
  CutOffNegative(this->TheDomain.Comm(), around, layout, sigma_a, this->Result.fluenceDirect, this->Parts.Fluence);
}

/// Adds the net flux of scattered light: from the diffusion systems or, with angular moments, from the sweep's moments
/// of degree 1, which are less disturbed by the uneven pattern of rays.
void DiffusionAcceleration::WriteFlux()
{
  TransportParts& parts = this->Parts;
  GhostedBuffer flux(parts.TheDevice, this->Arrays.Block(), parts.Flux, 3 * parts.Layout.channels, "net_flux");
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
      LimitFlux(parts.Layout, parts.Fluence.Read(), parts.Flux);
    }
  });
}

/// Computes Result.surfaceRadiance of optically thick voxels from the powers through the box faces in the diffusion
/// solution.
void DiffusionAcceleration::FindSurfaceRadiance()
{
  if (!this->Parts.Problem.HasLinearSource())
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
  this->Result.surfaceRadiance = SurfaceRadiance(this->TheDomain, this->Settings.periodic,
    this->Parts.Problem.TheMedium(), layout.channels, this->Parts.Lights.Lamps, powers);
}
}
