// Unscattered light from outside along directions of its own, in the solver.
#include "FusedSolver.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
/// All channels and voxels together.
bool FusedSolver::ScattersMoreThanItAbsorbs() const
{
  double scattered = 0.0, absorbed = 0.0;
  for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      scattered += this->SigmaS(i, c);
      absorbed += this->TheMedium.sigma_a.At(i, c);
    }
  }
  return scattered > absorbed;
}

/// What comes in evenly has the error of the usual directions times the part that is absorbed along these, and times the part that is
/// scattered along finer ones.
void FusedSolver::FindFlight(const Environment& farAway)
{
  const Grid& grid = this->TheMedium.grid;
  const FirstFlight flight(grid, this->Settings, this->FineDirections, RayStarts::Staggered, this->Outside, farAway,
    this->ScattersMoreThanItAbsorbs());
  if (!flight.Shines())
  {
    return;
  }
  this->Flight.emplace(flight);
  if (this->Accelerated)
  {
    this->UsualFlight.emplace(flight, this->Directions, this->Starts(), this->Outside, farAway);
  }
}

/// Where orders are added up one by one, the sweeps after it carry scattered light and what comes in evenly.
void FusedSolver::PropagateFlight(const Monitor& monitor)
{
  if (!this->Flight || this->UsualFlight)
  {
    return;
  }
  const Rgb before = this->Result.balance.entered;
  this->ForChannels([&](const SweepVolume& volume, int first) {
    this->Count(
      this->Flight->Deposit(this->TheDevice, volume, first, this->Workspace, monitor), first, volume.channels);
  });
  this->CheckEntering(Minus(this->Result.balance.entered, before), this->Flight->PowerIn());
}

FusedSolver::FlightLight FusedSolver::LightOf(const FirstFlight& flight, const Monitor& monitor)
{
  const std::size_t all = this->Stride * this->Channels;
  Buffer<float> path(this->TheDevice, all + SweepPadding, "unscattered light");
  Buffer<float> flux(this->TheDevice, this->Settings.netFlux ? 3 * all + SweepPadding : 0, "its net flux");
  path.Fill(0.0f);
  flux.Fill(0.0f);
  FlightLight light;
  this->ForChannels([&](const SweepVolume& volume, int first) {
    SweepVolume own = volume;
    own.path = &path;
    own.flux = this->Settings.netFlux ? &flux : nullptr;
    own.entering = own.nearness = nullptr;
    const SweepTally tally = flight.Deposit(this->TheDevice, own, first, this->Workspace, monitor);
    for (int c = 0; c < volume.channels; ++c)
    {
      for (int face = 0; face < 6; ++face)
      {
        light.tally.in[face][first + c] = tally.in[face][c];
        light.tally.out[face][first + c] = tally.out[face][c];
      }
    }
  });
  light.path = path.Read();
  light.flux = flux.Read();
  return light;
}

/// How much of it counts: less where light hardly comes through a voxel. There it matters where in the voxel it is scattered, which
/// the low-order system knows of the light in sweeps.
double FusedSolver::PartOfDifference(std::size_t voxel, int channel) const
{
  const std::array<double, 3>& h = this->TheMedium.grid.spacing;
  const double longest = std::max({ h[0], h[1], h[2] });
  const double tau = longest * this->SigmaT(voxel, channel);
  const double absorbing = longest * this->TheMedium.sigma_a.At(voxel, channel);
  return this->LinearSource ? 1.0 / (1.0 + tau * (0.25 * tau + 3.0 * absorbing))
                            : 1.0; // as LowOrder.cl believes in sweeps
}

/// Where orders are accelerated, sweeps carry all light along the usual directions, as the low-order system wants it. What the finer ones
/// see of the unscattered light more, or less, is added like the light of lamps. Power that this adds to
/// voxels or takes from them is made up for by what leaves the box.
void FusedSolver::AddFlightDifference(const Monitor& monitor)
{
  const Monitor ofFlight = monitor ? Monitor([&](double done) { return monitor(this->Progress(0, done)); }) : Monitor();
  const FlightLight fine = this->LightOf(*this->Flight, ofFlight);
  const FlightLight usual = this->LightOf(*this->UsualFlight, ofFlight);
  std::vector<float> flux = this->Settings.netFlux ? this->Flux.Read() : std::vector<float>();
  Rgb in = {}, usualIn = {};
  for (int c = 0; c < this->Channels; ++c)
  {
    double out = 0.0, more = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      in[c] += fine.tally.in[face][c];
      usualIn[c] += usual.tally.in[face][c];
      out += fine.tally.out[face][c];
    }
    const double scale =
      in[c] > 0.0 ? usualIn[c] / in[c] : 1.0; // the sweeps' radiance is right, in thick media to their end
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * this->Stride + i;
      const double part = this->PartOfDifference(i, c);
      const double difference = part * (scale * fine.path[at] - usual.path[at]);
      this->Lamps[at] += static_cast<float>(difference);
      more += this->SigmaT(i, c) * difference;
      for (int a = 0; a < 3 && !flux.empty(); ++a)
      {
        const std::size_t along = (3 * c + a) * this->Stride + i;
        flux[along] += static_cast<float>(part * (scale * fine.flux[along] - usual.flux[along]));
      }
    }
    for (int face = 0; face < 6; ++face)
    {
      more += scale * fine.tally.out[face][c] - usual.tally.out[face][c];
    }
    for (int face = 0; face < 6 && out > 0.0; ++face)
    {
      const double leaves = scale * fine.tally.out[face][c] - usual.tally.out[face][c];
      const double power = leaves - more * fine.tally.out[face][c] / out;
      this->LampFaces[face][c] += power;
      this->LampBalance.escaped[c] += power;
    }
  }
  if (!flux.empty())
  {
    this->Flux.Write(flux.data());
  }
  this->CheckEntering(in, this->Flight->PowerIn());
}
}
