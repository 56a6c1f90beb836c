#include "LightPropagation/Distributed/IterationInBlocks.h"

#include "Light/LeftOut.h"
#include "LightPropagation/Distributed/AccelerationInBlocks.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr double FallByCells = 0.3; ///< of what is left over from order to order, at least so much in the forecast
}

IterationInBlocks::IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Scene(scene)
  , Settings(settings)
  , Has(partition.blocks[communicator.Rank()].VoxelCount() > 0)
  , Layout(this->LayoutOn(partition.OwnGrid(communicator.Rank())))
  , WholeLayout(this->LayoutOn(partition.whole))
  , Truncated(scene.medium, 0, scene.channels)
  , OnDevice(device, scene.medium, this->Truncated, this->Layout, { true, false })
  , Scattering(device, this->Layout, this->OnDevice, scene.traits.scatters)
  , Directions(partition.whole, settings, DirectionsForVoxels(settings.directionsPerFace, partition.whole.spacing),
      settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle)
  , Far(Split(scene.illumination.environment, this->Directions.Set()))
  , Boundary(partition.whole, settings, this->Directions, scene.illumination, this->Far.smooth)
{
  if (this->Boundary.Shines())
  {
    this->Boundary.CheckRays(scene.channels);
  }
  this->Source = Buffer<float>(device, this->Layout.Floats(), "the scattered light");
  this->Path = Buffer<float>(device, this->Layout.Floats(), "the light gathered");
  this->Fluence = Buffer<float>(device, this->Layout.Floats(), "fluence");
  if (settings.netFlux)
  {
    this->Flux = Buffer<float>(device, this->Layout.Floats(3), "net_flux");
    this->Flux.Fill(0.0f);
  }
  this->Source.Fill(0.0f);
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);
}

std::unique_ptr<SweepOperator> IterationInBlocks::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->Others.Together([&] {
    sweep = std::make_unique<SweepInBlocks>(
      this->TheDevice, this->Others, this->Partition, this->Layout, this->OnDevice.SigmaT(), request, this->Workspace);
  });
  return sweep;
}

void IterationInBlocks::LoadEmission()
{
  if (!this->Scene.traits.emits)
  {
    return;
  }
  this->Shining = true;
  std::vector<double> emitted(3, 0.0);
  if (this->Has)
  {
    const Field& emission = this->Scene.medium.emission;
    const std::vector<float> values =
      Planar(this->Layout, this->Layout.channels, [&](std::size_t i, int c) { return emission.At(i, c); });
    this->Source.Write(values.data(), values.size());
    for (int c = 0; c < this->Layout.channels; ++c)
    {
      emitted[c] = 4.0 * Pi * this->Layout.grid.VoxelVolume() *
        SumOverVoxels(this->Layout.grid, [&](std::size_t i) { return emission.At(i, c); });
    }
  }
  emitted = this->Others.Sum(emitted);
  for (int c = 0; c < 3; ++c)
  {
    this->Ledger.Emit(c, emitted[c]);
  }
}

/// Those that are given, and peaks of the environment.
std::vector<Light> IterationInBlocks::Lamps() const
{
  std::vector<Light> lamps = this->Scene.illumination.lights;
  lamps.insert(lamps.end(), this->Far.peaks.begin(), this->Far.peaks.end());
  return lamps;
}

/// A point, spot or rectangle lamp.
SweepTally IterationInBlocks::AddNearLamp(const Light& lamp, const Deposit& to, const Monitor& monitor)
{
  if (!this->NearLamps)
  {
    this->NearLamps = std::make_unique<LampsInBlocks>(
      this->TheDevice, this->Others, this->Partition, this->Layout, this->OnDevice.SigmaT());
  }
  UncollidedVolume volume = { this->TheDevice, this->Layout, this->OnDevice.SigmaT(), this->Settings.periodic, {}, to };
  volume.followLamp = [this](const SweepVolume& ofChannels, const Light& light, const Monitor& ofLamp) {
    return this->NearLamps->Deposit(ofChannels, light, ofLamp);
  };
  return UncollidedLamp(lamp).AddTo(volume, monitor);
}

void IterationInBlocks::AddLamps(const Monitor& monitor)
{
  const std::vector<Light> lamps = this->Lamps();
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  // Rays of a parallel beam are those through the whole box.
  const UncollidedVolume beams = { this->TheDevice, this->WholeLayout, this->OnDevice.SigmaT(), this->Settings.periodic,
    sweeps, this->WholeDeposit() };
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    const double all = static_cast<double>(lamps.size());
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    this->Ledger.Count(lamps[i].type == LightType::Directional
        ? UncollidedLamp(lamps[i]).AddTo(beams, ofLamp)
        : this->AddNearLamp(lamps[i], this->WholeDeposit(), ofLamp));
  }
}

void IterationInBlocks::MakeCells()
{
  for (int c = 0; c < this->Layout.channels && this->Orders.how == OrdersAdded::ByCells; ++c)
  {
    this->Cells.push_back(std::make_unique<CellsOverRanks>(
      this->TheDevice, this->Others, this->Partition, this->Layout, c, this->OnDevice, this->Orders.halvings));
    this->Rest[c].BeginWarm(FallByCells);
  }
}

/// As SourceIteration does.
void IterationInBlocks::ScatterByCells()
{
  this->Residual = 0.0;
  this->Shining = false;
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    const CellsOverRanks::Powers powers = this->Cells[c]->ScatterOrder(this->Path, this->Fluence, this->Source);
    this->Ledger.Absorb(c, powers.absorbed);
    this->Ledger.LeaveOver(c, powers.left);
    this->Scattered[c] = powers.scattered;
    this->AllScattered[c] += powers.scattered;
    this->Shining = this->Shining || powers.magnitude > 0.0;
    if (powers.magnitude > 0.0 && this->AllScattered[c] > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(powers.magnitude, this->AllScattered[c]));
    }
    for (int face = 0; face < 6; ++face)
    {
      this->OutOfCells[face][c] = powers.out[face];
    }
  }
  const double all = Sum(this->AllScattered);
  this->Convergence.Add(this->Residual, all > 0.0 ? std::abs(Sum(this->Scattered)) / all : 0.0, this->WithOutOfCells());
}

/// With what leaves of the orders to come.
EnergyLedger IterationInBlocks::WithOutOfCells() const
{
  EnergyLedger with = this->Ledger;
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      with.Escape(c, face, this->OutOfCells[face][c]);
    }
  }
  return with;
}

/// One order: from the light that was swept to the next source, with the powers of all ranks.
void IterationInBlocks::Scatter()
{
  if (this->Order == 0 && this->Has)
  {
    this->Direct = Interleaved(this->Layout, this->Path, 1.0 / this->Layout.grid.VoxelVolume());
  }
  if (!this->Cells.empty())
  {
    this->ScatterByCells();
    return;
  }
  std::vector<double> powers(6, 0.0);
  this->Others.Together([&] {
    if (!this->Has)
    {
      return;
    }
    const ScatteringOperator::Powers own =
      this->Scattering.ScatterOrder(this->WholeDeposit(), this->Fluence, this->Source, { 0, this->Layout.Stride() });
    std::copy(own.absorbed.begin(), own.absorbed.end(), powers.begin());
    std::copy(own.scattered.begin(), own.scattered.end(), powers.begin() + 3);
  });
  powers = this->Others.Sum(powers);
  for (int c = 0; c < 3; ++c)
  {
    this->Ledger.Absorb(c, powers[c]);
    this->Scattered[c] = powers[3 + c];
    this->Ledger.LeaveOver(c, this->Scattered[c]);
  }
  this->Shining = Sum(this->Scattered) > 0.0;
  this->EstimateResidual();
  const double all = Sum(this->AllScattered);
  this->Convergence.Add(this->Residual, all > 0.0 ? Sum(this->Scattered) / all : 0.0, this->Ledger);
}

/// As SourceIteration does.
void IterationInBlocks::EstimateResidual()
{
  this->Residual = 0.0;
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    const double now = this->Scattered[c];
    this->AllScattered[c] += now;
    if (now > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
    }
  }
}

bool IterationInBlocks::Done() const
{
  if (this->Residual == 0.0 || this->Order >= MostOrders)
  {
    return true;
  }
  return this->Settings.maximumOrders > 0 ? this->Order >= this->Settings.maximumOrders
                                          : this->Order >= 3 && MeetsTolerance(this->Settings, this->Residual);
}

LightField IterationInBlocks::Run(const Monitor& monitor)
{
  this->LoadEmission();
  this->Orders = HowOrdersAreAdded(this->Others, this->Partition, this->Scene, this->Settings);
  if (this->Orders.how == OrdersAdded::ByBalance)
  {
    this->RunByBalance(monitor);
    return this->TakeLight();
  }
  this->MakeCells();
  const std::unique_ptr<SweepOperator> sweep = this->MakeSweep({ this->WholeDeposit(),
    { { 0, this->Directions.Along(0) }, { 1, this->Directions.Along(1) }, { 2, this->Directions.Along(2) } } });
  do
  {
    const Monitor ofOrder =
      OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, this->Residual, this->Order + done); });
    const bool first = this->Order == 0;
    if (first)
    {
      this->AddLamps(OfPart(ofOrder, 0.0, UncollidedPart));
    }
    const SweepBoundary boundary = first && this->Boundary.Shines() ? this->Boundary.Boundary() : SweepBoundary();
    if (this->Shining || boundary)
    {
      this->Ledger.Count(sweep->Apply(
        this->Shining ? &this->Source : nullptr, boundary, OfPart(ofOrder, first ? UncollidedPart : 0.0, 1.0)));
    }
    this->Scatter();
    ++this->Order;
  } while (!this->Done());
  return this->TakeLight();
}

/// Light of lamps goes ahead, and what of it is scattered is given to the sweeps.
void IterationInBlocks::RunByBalance(const Monitor& monitor)
{
  AccelerationInBlocks acceleration({ this->TheDevice, this->Others, this->Partition, this->Scene, this->Settings,
    this->Layout, this->OnDevice, this->Directions, this->Boundary,
    [this](const SweepRequest& request) { return this->MakeSweep(request); },
    [this](const Light& lamp, const Deposit& to, const Monitor& ofLamp) { return this->AddNearLamp(lamp, to, ofLamp); },
    this->Source, this->Path, this->Fluence, this->Flux, this->Ledger });
  const Monitor ofLamps =
    OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, 1.0, UncollidedPart * done); });
  const std::vector<Light> lamps = this->Lamps();
  if (!lamps.empty() && acceleration.NeedsFirstMoments())
  {
    acceleration.AddBeams(lamps, ofLamps);
  }
  else
  {
    this->AddLamps(ofLamps);
  }
  this->Rows = acceleration.Run(monitor);
  this->Direct = acceleration.Direct();
}

LightField IterationInBlocks::TakeLight()
{
  LightField light;
  light.channels = this->Layout.channels;
  if (this->Has)
  {
    light.fluence = Interleaved(this->Layout, this->Fluence, 1.0);
    for (float& fluence : light.fluence)
    {
      fluence = std::max(fluence, 0.0f); // what the last sweeps would have taken away
    }
    if (this->Settings.netFlux)
    {
      light.netFlux = Interleaved(this->Layout, this->Flux, 1.0 / this->Layout.grid.VoxelVolume());
    }
    for (const float fluence : light.fluence)
    {
      light.scatteredRadiance.push_back(static_cast<float>(fluence / (4.0 * Pi)));
    }
    light.fluenceDirect = std::move(this->Direct);
  }
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  const EnergyLedger ledger = this->WithOutOfCells();
  light.balance = ledger.Balance();
  light.facePowerOut = ledger.FacePowerOut();
  light.convergence = this->Orders.how == OrdersAdded::ByBalance ? this->Rows : this->Convergence.All();
  light.directionsPerFace = this->Settings.directionsPerFace;
  light.halfRangeFlux = HalfRangeFlux(this->Directions.Set());
  light.device = this->TheDevice.Name();
  if (this->Orders.how == OrdersAdded::OneByOne)
  {
    light.leftOut.emplace_back("acceleration: few scattering orders do");
  }
  if (this->Scene.traits.emits && this->Settings.emissionError > 0.0)
  {
    light.leftOut.emplace_back("exact rays of small bright emission: the medium is spread over ranks");
  }
  if (!this->Settings.netFlux)
  {
    light.leftOut.emplace_back(left_out::NetFlux);
  }
  return light;
}
}
