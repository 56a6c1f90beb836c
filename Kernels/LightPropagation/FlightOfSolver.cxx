// Unscattered light from outside along directions of its own, in the solver.
#include "FusedSolver.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
}

/// What comes in evenly from everywhere is what accelerated orders carry already.
void FusedSolver::FindFlight(const Environment& farAway)
{
  const FirstFlight flight(
    this->TheMedium.grid, this->Settings, this->FineDirections, this->FineStarts(), this->Outside, farAway);
  if (!flight.Shines() || (this->Accelerated && flight.IsEven()))
  {
    return;
  }
  this->Flight.emplace(flight);
  if (this->Accelerated)
  {
    this->UsualFlight.emplace(
      this->TheMedium.grid, this->Settings, this->Directions, this->Starts(), this->Outside, farAway);
  }
}

/// What a sky of radiance 1 is before it is scattered, along the finer directions and along the usual ones. Read as how much of
/// the light that sets out from a voxel gets out of the box (reciprocity), it tells how far scattered light is off.
std::array<FusedSolver::FlightLight, 2> FusedSolver::LightOfEvenSky(const Monitor& monitor)
{
  Illumination evenly;
  evenly.sky = { 1.0, 1.0, 1.0 };
  const Grid& grid = this->TheMedium.grid;
  const FirstFlight fine(grid, this->Settings, this->FineDirections, this->FineStarts(), evenly, {});
  const FirstFlight usual(grid, this->Settings, this->Directions, this->Starts(), evenly, {});
  return { this->LightOf(fine, monitor), this->LightOf(usual, monitor) };
}

/// Where orders are added up one by one, the sweeps after it carry scattered light.
void FusedSolver::PropagateFlight(const Monitor& monitor)
{
  if (!this->Flight || this->UsualFlight)
  {
    return;
  }
  this->ForChannels([&](const SweepVolume& volume, int first) {
    this->Count(
      this->Flight->Deposit(this->TheDevice, volume, first, this->Workspace, monitor), first, volume.channels);
  });
}

/// More, or less, of what sets out from a voxel gets out of the box along the finer directions than along the usual ones. With that put
/// right, light that is the same everywhere stays so whatever comes in along the finer directions.
void FusedSolver::FindExtraEscape(const Monitor& monitor)
{
  const auto [fine, usual] = this->LightOfEvenSky(monitor);
  const std::array<double, 3>& h = this->TheMedium.grid.spacing;
  const double thinnest = std::min({ h[0], h[1], h[2] });
  // A voxel can only let out what it takes of its own light: about half its optical thickness; a half of that.
  const double whole = 0.25 * 4.0 * Pi * this->TheMedium.grid.VoxelVolume();
  std::vector<float> extra(this->Stride * this->Channels, 0.0f);
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * this->Stride + i;
      const double sigma_t = this->SigmaT(i, c);
      const double most = whole * thinnest * sigma_t / (1.0 + thinnest * sigma_t);
      const double difference = std::clamp<double>(fine.path[at] - usual.path[at], -most, most);
      extra[at] = sigma_t > 0.0 ? static_cast<float>(difference / sigma_t) : 0.0f;
    }
  }
  this->ExtraEscape = Buffer<float>(this->TheDevice, extra, "what escapes of scattered light");
}

/// After a sweep, from the scattered light that was its source. What the medium shines itself is left to the sweeps: it may come from
/// voxels so thin that they have nothing to give.
void FusedSolver::LetEscape()
{
  cl::Kernel kernel = this->TheDevice.Kernel("let_escape", { kernel_source::Numerics, kernel_source::Collect });
  const std::size_t chunks = (this->Stride + CollectChunk - 1) / CollectChunk;
  Buffer<float> tally(this->TheDevice, chunks * this->Channels, "sums");
  With(kernel, this->Path, this->Source, this->ExtraEscape, this->Extinction, tally, cl_ulong(this->Stride),
    cl_int(this->SharedExtinction));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(chunks, this->Channels), cl::NDRange(1, 1));
  const std::vector<float> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    this->Escaped[i / chunks] += sums[i];
    this->Result.balance.escaped[i / chunks] += sums[i];
  }
}

/// Through which faces that was is not known: as the rest.
void FusedSolver::ShareEscape()
{
  for (int c = 0; c < this->Channels; ++c)
  {
    double through = 0.0;
    for (const Rgb& face : this->Result.facePowerOut)
    {
      through += face[c];
    }
    for (Rgb& face : this->Result.facePowerOut)
    {
      face[c] *= through > 0.0 ? 1.0 + this->Escaped[c] / through : 1.0;
    }
  }
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
/// see of the unscattered light more, or less, is added like the light of lamps. Where light is scattered many times, of the part that they
/// see of an even sky, so that power is as in the sweeps in every voxel and through every face, and what is even stays so; where it is
/// not, that would only bring back what few directions do to an even sky: power is as in the sweeps in all. Power that this adds to
/// voxels or takes from them is made up for by what leaves the box.
void FusedSolver::AddFlightDifference(const Monitor& monitor)
{
  const Monitor ofFlight = monitor ? Monitor([&](double done) { return monitor(this->Progress(0, done)); }) : Monitor();
  const FlightLight fine = this->LightOf(*this->Flight, ofFlight);
  const FlightLight usual = this->LightOf(*this->UsualFlight, ofFlight);
  const bool many = this->ScatteredManyTimes();
  const auto [evenFine, evenUsual] = many ? this->LightOfEvenSky(ofFlight) : std::array<FlightLight, 2>{ fine, usual };
  const auto ratio = [](double of, double to) { return to > 0.0 ? of / to : 1.0; };
  std::vector<float> flux = this->Settings.netFlux ? this->Flux.Read() : std::vector<float>();
  for (int c = 0; c < this->Channels; ++c)
  {
    double more = 0.0, out = 0.0, in = 0.0, usualIn = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      in += fine.tally.in[face][c];
      usualIn += usual.tally.in[face][c];
    }
    const double whole = ratio(usualIn, in);
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * this->Stride + i;
      const double part = this->PartOfDifference(i, c);
      const double scale = many ? ratio(evenUsual.path[at], evenFine.path[at]) : whole;
      const double difference = part * (scale * fine.path[at] - usual.path[at]);
      this->Lamps[at] += static_cast<float>(difference);
      more += this->SigmaT(i, c) * difference;
      for (int a = 0; a < 3 && !flux.empty(); ++a)
      {
        const std::size_t along = (3 * c + a) * this->Stride + i;
        flux[along] += static_cast<float>(part * (scale * fine.flux[along] - usual.flux[along]));
      }
    }
    std::array<double, 6> leaves;
    for (int face = 0; face < 6; ++face)
    {
      const double scale = many ? ratio(evenUsual.tally.out[face][c], evenFine.tally.out[face][c]) : whole;
      leaves[face] = scale * fine.tally.out[face][c] - usual.tally.out[face][c];
      more += leaves[face];
      out += fine.tally.out[face][c];
    }
    for (int face = 0; face < 6 && out > 0.0; ++face)
    {
      const double power = leaves[face] - more * fine.tally.out[face][c] / out;
      this->LampFaces[face][c] += power;
      this->LampBalance.escaped[c] += power;
    }
  }
  if (!flux.empty())
  {
    this->Flux.Write(flux.data());
  }
}
}
