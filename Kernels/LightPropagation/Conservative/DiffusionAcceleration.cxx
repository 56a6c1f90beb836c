#include "LightPropagation/Conservative/DiffusionAcceleration.h"

#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostSweeps = 200;
constexpr double ThickForMoments = 0.1; ///< mean free paths a voxel
constexpr double Margin = 1.5;          ///< of the estimated error: changes do not fall off evenly

double Ratio(double of, double to)
{
  return to > 0.0 ? of / to : 1.0;
}
}

DiffusionAcceleration::DiffusionAcceleration(TransportParts& parts)
  : Parts(parts)
  , Settings(parts.Problem.Settings())
  , TheMedium(parts.Problem.TheMedium())
  , LinearSource(parts.Problem.Settings().source != PropagationSource::Constant)
{
}

IterationResult DiffusionAcceleration::Run(const Monitor& monitor)
{
  this->Parts.CountEmission(this->OfLamps);
  this->AddLamps(monitor);
  this->GiveFirstScattered();
  this->MakeSweep();
  int iteration = 0;
  do
  {
    const Monitor ofSweep =
      OfPart(monitor, [=](double done) { return ProgressOf(this->Settings, this->Residual, iteration + done); });
    this->Sweep(iteration, ofSweep);
    if (iteration == 0)
    {
      this->Parts.Fluence.Write(this->SweptFluence().data());
      this->Result.fluenceDirect = Interleaved(this->Parts.Layout, this->Parts.Fluence, 1.0);
      this->MakeSystems();
    }
    this->Correct(iteration);
    Report(ofSweep, 1.0);
    ++iteration;
  } while (!this->Done(iteration));
  this->WriteFluence();
  this->FindSurfaceRadiance();
  return std::move(this->Result);
}

/// In thick voxels it matters where lamps' light is first scattered.
bool DiffusionAcceleration::NeedsMoments() const
{
  const Grid& grid = this->TheMedium.grid;
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  bool thick = false;
  for (std::size_t i = 0; i < grid.VoxelCount() && !thick; ++i)
  {
    for (int c = 0; c < this->Parts.Layout.channels && !thick; ++c)
    {
      thick = this->TheMedium.TransportSigmaT(i, c) * longest > ThickForMoments;
    }
  }
  return this->LinearSource && thick && !this->Parts.Lamps.empty();
}

/// All uncollided light but that which sweeps carry, into `Lamps`.
void DiffusionAcceleration::AddLamps(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const auto count = [this](const SweepTally& tally) {
    this->OfLamps.Count(tally);
    for (int c = 0; c < 3; ++c)
    {
      this->Stranded[c] += tally.onTheWay[c];
    }
  };
  const Monitor first = OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, 1.0, done); });
  Buffer<float> moments, path; // of one lamp
  if (this->NeedsMoments())
  {
    moments = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), "light of lamps");
    path = Buffer<float>(parts.TheDevice, parts.Layout.Floats(), "light of lamps");
    this->Passed = Buffer<float>(parts.TheDevice, 6 * parts.Layout.Stride() * parts.Layout.channels, "light of lamps");
    this->Passed.Fill(0.0f);
  }
  for (const std::unique_ptr<UncollidedSource>& lamp : parts.LampSources())
  {
    if (moments.Size() == 0)
    {
      count(parts.AddUncollided(*lamp, parts.WholeDeposit(), first));
      continue;
    }
    moments.Fill(0.0f);
    path.Fill(0.0f);
    count(parts.AddUncollided(*lamp, { &path, parts.WholeDeposit().flux, nullptr, &moments }, first));
    this->PassLampLight(path, moments);
  }
  for (const std::unique_ptr<UncollidedSource>& peak : parts.BrightEmissionSources())
  {
    count(parts.AddUncollided(*peak, parts.WholeDeposit(), first));
  }
  this->Lamps = parts.Path.Read();
  if (parts.FineBoundary)
  {
    this->AddBoundaryDifference(first);
  }
}

/// Adds the part of a lamp's light that passes voxels' faces at once where it is first scattered.
void DiffusionAcceleration::PassLampLight(const Buffer<float>& path, const Buffer<float>& moments)
{
  const TransportParts& parts = this->Parts;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    const std::size_t first = c * parts.Layout.Stride();
    tyndall::PassLampLight(parts.TheDevice, parts.Layout.grid, this->Settings.periodic,
      { parts.Layout.Stride(), parts.Layout.ExtinctionFirst(c), first, &parts.OnDevice.SigmaT(),
        &parts.OnDevice.SigmaA(), &parts.OnDevice.SigmaS(), &path, &moments, &this->Passed, &parts.Path });
  }
}

/// Weight of the difference of finer and usual directions (numerics.md, Eqs. (55), (76)): little in thick voxels, where
/// it matters at which depth light is scattered, which the diffusion system has for the light in sweeps alone.
double DiffusionAcceleration::PartOfDifference(std::size_t voxel, int channel) const
{
  const std::array<double, 3>& h = this->TheMedium.grid.spacing;
  const double longest = *std::max_element(h.begin(), h.end());
  const double tau = longest * this->TheMedium.TransportSigmaT(voxel, channel);
  const double absorbing = longest * this->TheMedium.sigma_a.At(voxel, channel);
  // As the system weighs what sweeps find.
  return this->LinearSource ? 1.0 / (1.0 + tau * (0.25 * tau + 3.0 * absorbing)) : 1.0;
}

/// Sweeps carry all light from outside along the usual directions, as the diffusion system needs it. The difference
/// that finer ones make to it before it is scattered is added like the light of lamps (numerics.md, Eq. (76)): where
/// light is scattered many times, scaled in each voxel so that power is as in the sweeps and an even sky stays even,
/// else scaled by the power that enters. Power that this adds to voxels or takes from them is made up for by what
/// leaves the box.
void DiffusionAcceleration::AddBoundaryDifference(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const auto fine = parts.FindUncollided(UncollidedBoundary(this->Settings, *parts.FineBoundary), monitor);
  const auto usual = parts.FindUncollided(UncollidedBoundary(this->Settings, *parts.UsualBoundary), monitor);
  const bool many = ScatteredManyTimes(parts.Problem);
  const TransportParts::EvenSky even = many ? parts.FindEvenSky(monitor) : TransportParts::EvenSky();
  std::vector<float> flux = this->Settings.netFlux ? parts.Flux.Read() : std::vector<float>();
  const std::size_t stride = parts.Layout.Stride();
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    double more = 0.0, out = 0.0, in = 0.0, usualIn = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      in += fine.tally.in[face][c];
      usualIn += usual.tally.in[face][c];
    }
    const double whole = Ratio(usualIn, in);
    for (std::size_t i = 0; i < parts.Layout.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * stride + i;
      const double part = this->PartOfDifference(i, c);
      const double scale = many ? Ratio(even.usual.path[at], even.fine.path[at]) : whole;
      const double difference = part * (scale * fine.path[at] - usual.path[at]);
      this->Lamps[at] += static_cast<float>(difference);
      more += this->TheMedium.TransportSigmaT(i, c) * difference;
      for (int a = 0; a < 3 && !flux.empty(); ++a)
      {
        const std::size_t along = (3 * c + a) * stride + i;
        flux[along] += static_cast<float>(part * (scale * fine.flux[along] - usual.flux[along]));
      }
    }
    std::array<double, 6> leaves;
    for (int face = 0; face < 6; ++face)
    {
      const double scale = many ? Ratio(even.usual.tally.out[face][c], even.fine.tally.out[face][c]) : whole;
      leaves[face] = scale * fine.tally.out[face][c] - usual.tally.out[face][c];
      more += leaves[face];
      out += fine.tally.out[face][c];
    }
    for (int face = 0; face < 6 && out > 0.0; ++face)
    {
      this->OfLamps.Escape(c, face, leaves[face] - more * fine.tally.out[face][c] / out);
    }
  }
  if (!flux.empty())
  {
    parts.Flux.Write(flux.data());
  }
}

/// Uncollided light is known: what of it is scattered is a given source, like what the medium emits.
void DiffusionAcceleration::GiveFirstScattered()
{
  const TransportParts& parts = this->Parts;
  const double volume = parts.Layout.grid.VoxelVolume();
  std::vector<float> given = parts.Source.Read();
  this->GivenPower = this->OfLamps.Balance().emitted;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    for (std::size_t i = 0; i < parts.Layout.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * parts.Layout.Stride() + i;
      const double scattered = static_cast<double>(this->TheMedium.TransportSigmaS(i, c)) * this->Lamps[at];
      given[at] += static_cast<float>(scattered / (4.0 * Pi * volume));
      this->OfLamps.Absorb(c, static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Lamps[at]);
      this->GivenPower[c] += scattered;
      this->Lamps[at] = static_cast<float>(this->Lamps[at] / volume);
    }
    this->OfLamps.LeaveOver(c, this->Stranded[c]);
  }
  this->Given = Buffer<float>(parts.TheDevice, given, "the light given");
}

void DiffusionAcceleration::MakeSweep()
{
  TransportParts& parts = this->Parts;
  this->PartialCurrents = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), "the power from voxel to voxel");
  // No flux: it comes from the system.
  SweepRequest request = { { &parts.Path, nullptr, &this->PartialCurrents, nullptr }, parts.AllRays() };
  request.sameBoundary = true;
  this->Swept = parts.MakeSweep(request);
}

/// From the source that is there to path integrals and partial currents. The light that comes in from outside comes in
/// every time.
void DiffusionAcceleration::Sweep(int iteration, const Monitor& monitor)
{
  for (std::size_t c = 0; c < this->Systems.size(); ++c)
  {
    if (this->UnitPower(static_cast<int>(c)) > 0.0)
    {
      this->Systems[c]->WriteSource();
    }
  }
  this->Parts.Path.Fill(0.0f);
  this->PartialCurrents.Fill(0.0f);
  this->Swept->Forget();
  const bool shines = iteration > 0 || this->Parts.HasSource();
  this->Tally = this->Swept->Apply(shines ? &this->Parts.Source : nullptr, this->Parts.BoundaryOfSweeps(), monitor);
}

/// Of the last sweep, with that of lamps; [channel][stride].
std::vector<float> DiffusionAcceleration::SweptFluence() const
{
  const double perVolume = 1.0 / this->Parts.Layout.grid.VoxelVolume();
  std::vector<float> values = this->Parts.Path.Read();
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = std::max(static_cast<float>(values[i] * perVolume + this->Lamps[i]), 0.0f);
  }
  return values;
}

void DiffusionAcceleration::MakeSystems()
{
  TransportParts& parts = this->Parts;
  const CrossingPattern pattern = FindCrossingPattern(
    parts.Layout.grid, parts.Usual.Set(), this->Settings.mapResolution, parts.Usual.Starts(), this->Settings.periodic);
  const std::array<Rgb, 6> incoming =
    parts.SweepsAreLit() ? parts.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{};
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    std::array<double, 6> ofChannel;
    for (int face = 0; face < 6; ++face)
    {
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    const DiffusionSystem::Arrays arrays = { parts.Layout.Stride(), parts.Layout.ExtinctionFirst(c),
      c * parts.Layout.Stride(), &parts.OnDevice.SigmaT(), &parts.OnDevice.SigmaA(), &parts.OnDevice.SigmaS(),
      &this->Given, &parts.Source, &parts.Path, &this->PartialCurrents,
      this->Passed.Size() > 0 ? &this->Passed : nullptr };
    this->Systems.push_back(std::make_unique<DiffusionSystem>(parts.TheDevice, parts.Layout.grid,
      this->Settings.periodic, parts.Usual.Set(), pattern, arrays, ofChannel, this->LinearSource));
  }
}

/// W of a voxel, about.
double DiffusionAcceleration::UnitPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->Parts.Layout.grid.VoxelCount());
}

/// Solve for the light of each channel and estimate how far it is from that of an endless iteration (numerics.md,
/// Eq. (73)). The worst channel counts.
void DiffusionAcceleration::Correct(int iteration)
{
  double change = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    const double unit = this->UnitPower(c);
    if (unit > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(unit));
    }
  }
  const double ratio = iteration > 0 && this->Change > 0.0 ? change / this->Change : 1.0;
  const double fall = std::clamp(iteration > 1 ? std::max(ratio, this->LastRatio) : ratio, 0.5, 0.95);
  this->Residual = iteration > 0 || change == 0.0 ? Margin * change * fall / (1.0 - fall) : 1.0;
  this->LastRatio = ratio;
  this->Change = change;
  this->CountLight();
  this->Result.convergence.Add(this->Residual, change, this->Result.ledger);
}

/// Where the power went, by the diffusion system, which conserves it. What left in the sweep is used only to share it
/// among the faces.
void DiffusionAcceleration::CountLight()
{
  const Grid& grid = this->Parts.Layout.grid;
  this->Result.ledger = this->OfLamps;
  this->Found.clear();
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      ofSweep[face] = this->Tally.out[face][c];
      this->Result.ledger.Enter(c, this->Tally.in[face][c]);
    }
    if (!(this->UnitPower(c) > 0.0))
    {
      this->Found.emplace_back(grid.VoxelCount(), 0.0); // dark: never solved for
      continue;
    }
    this->Found.push_back(this->Systems[c]->Found());
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      this->Result.ledger.Absorb(
        c, static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Found[c][i] * grid.VoxelVolume());
    }
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(ofSweep);
    for (int face = 0; face < 6; ++face)
    {
      this->Result.ledger.Escape(c, face, outflow[face]);
    }
  }
}

bool DiffusionAcceleration::Done(int iterations) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweeps;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations > 2 && MeetsTolerance(this->Settings, this->Residual));
}

/// Where the system's solution is negative, the fluence of the last sweep stands.
void DiffusionAcceleration::WriteFluence()
{
  TransportParts& parts = this->Parts;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    if (this->UnitPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->UnitPower(c));
    }
  }
  this->CountLight();
  const double perVolume = 1.0 / parts.Layout.grid.VoxelVolume();
  const std::vector<float> path = parts.Path.Read();
  std::vector<float> fluence(path.size(), 0.0f);
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    for (std::size_t i = 0; i < parts.Layout.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * parts.Layout.Stride() + i;
      const double found = this->Found[c][i];
      const double swept = found >= 0.0 ? found : path[at] * perVolume;
      fluence[at] = std::max(static_cast<float>(swept + this->Lamps[at]), 0.0f);
    }
    if (this->Settings.netFlux && this->UnitPower(c) > 0.0)
    {
      this->Systems[c]->AddFlux(parts.Flux);
    }
  }
  parts.Fluence.Write(fluence.data());
  if (this->Settings.netFlux)
  {
    this->LimitFlux(fluence);
  }
}

/// Of thick voxels, from the powers of the system.
void DiffusionAcceleration::FindSurfaceRadiance()
{
  std::vector<SurfacePowers> powers(this->LinearSource ? this->Parts.Layout.channels : 0);
  for (std::size_t c = 0; c < powers.size(); ++c)
  {
    powers[c] = this->UnitPower(static_cast<int>(c)) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers();
    powers[c].lamps = this->Lamps.data() + c * this->Parts.Layout.Stride();
  }
  this->Result.surfaceRadiance = SurfaceRadiance(this->TheMedium, this->Settings.periodic, this->Parts.Lamps, powers);
}

/// Where light is absorbed within a voxel, the mean of the powers through its faces is more than its net flux, which is
/// cut to the fluence.
void DiffusionAcceleration::LimitFlux(const std::vector<float>& fluence)
{
  const std::size_t stride = this->Parts.Layout.Stride();
  std::vector<float> flux = this->Parts.Flux.Read();
  const double volume = this->Parts.Layout.grid.VoxelVolume();
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    for (std::size_t i = 0; i < this->Parts.Layout.grid.VoxelCount(); ++i)
    {
      float* const x = flux.data() + 3 * c * stride + i;
      float* const y = x + stride;
      float* const z = y + stride;
      const double most = fluence[c * stride + i] * volume;
      const double flows = std::hypot(*x, *y, *z);
      const auto part = static_cast<float>(flows > most ? most / flows : 1.0);
      *x *= part;
      *y *= part;
      *z *= part;
    }
  }
  this->Parts.Flux.Write(flux.data());
}
}
