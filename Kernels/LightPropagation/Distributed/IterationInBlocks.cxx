#include "LightPropagation/Distributed/IterationInBlocks.h"

#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/ShownLight.h"
#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/Scattering/BeamsInSource.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr int FewPlanes = 256;      ///< as SourceIteration has it
constexpr double FallByCells = 0.3; ///< of what is left over from order to order, at least so much in the forecast
}

IterationInBlocks::IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings, const WayInBlocks& way)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Scene(scene)
  , Settings(settings)
  , Way(way)
  , Has(partition.blocks[communicator.Rank()].VoxelCount() > 0)
  , Layout(this->LayoutOn(partition.OwnGrid(communicator.Rank())))
  , OnDevice(device, scene.medium, scene.Scattering(), this->Layout, { true, false })
  , Scattering(MakeScattering(device, this->Layout, this->OnDevice, scene.Scattering().Degree(), scene.traits.scatters))
  , Directions(partition.whole, settings, DirectionsForVoxels(settings.directionsPerFace, partition.whole.spacing),
      settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle)
  , Fine(way.finer.perFace > 0 ? FinerDirections(partition.whole, settings, way.finer.perFace, false) : nullptr)
  , Far(Split(scene.illumination.environment, this->DirectionsOfBoundary().Set()))
  , Boundary(partition.whole, settings, this->Directions, scene.illumination, this->Far.smooth)
  , Lamps(this->LampsOf(scene.illumination))
{
  this->MakeFineBoundary();
  if (scene.given && this->Has)
  {
    this->Given = std::make_unique<GivenLight>(scene.illumination.uncollided, scene.medium, scene.Scattering());
  }
  if (scene.Scattering().Degree() > 0 && this->Has)
  {
    this->Angular =
      std::make_unique<SweptMoments>(this->Directions, scene.medium.phase, scene.Scattering(), this->Lamps);
    this->OfLamp = Buffer<float>(device, this->Layout.Floats(), "the light of a lamp");
  }
  const std::size_t moments = this->Layout.MomentFloats(this->Functions());
  const int beams = this->Angular ? this->Angular->Beams() : 0;
  this->Source = Buffer<float>(device, this->Layout.MomentFloats(this->Functions(), beams), "the scattered light");
  this->Path = Buffer<float>(device, moments, "the light gathered");
  this->Fluence = Buffer<float>(device, this->Layout.Floats(), "fluence");
  if (settings.netFlux)
  {
    this->Flux = Buffer<float>(device, this->Layout.Floats(3), "net_flux");
    this->Flux.Fill(0.0f);
  }
  if (Reflects(scene.illumination) || settings.facePower)
  {
    const bool spreads = !Reflects(scene.illumination);
    this->Faces = std::make_unique<FaceLight>(device, partition.whole, scene.channels,
      SweptPowerIn(partition.whole, settings.periodic, this->Directions, spreads), scene.illumination.faceAlbedo);
  }
  if (this->StoresMoments())
  {
    this->Shown = Buffer<float>(device, moments, "the light shown");
    this->Shown.Fill(0.0f);
  }
  this->Source.Fill(0.0f);
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);
}

/// As TransportParts does.
void IterationInBlocks::MakeFineBoundary()
{
  const int channels = this->Scene.channels;
  if (this->Fine && this->Boundary.Shines())
  {
    this->FineBoundary = std::make_unique<BoundaryLight>(
      this->Partition.whole, this->Settings, *this->Fine, this->Scene.illumination, this->Far.smooth);
    const bool asked = this->Settings.uncollidedDirections >= 0;
    if (asked)
    {
      this->FineBoundary->CheckRays(channels);
    }
    else if (!this->FineBoundary->HasEnoughRays(channels))
    {
      this->FineBoundary.reset();
    }
  }
  if (!this->FineBoundary && this->Boundary.Shines())
  {
    this->Boundary.CheckRays(channels);
  }
}

Deposit IterationInBlocks::WholeDeposit() const
{
  return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr,
    this->Faces ? &this->Faces->Out() : nullptr, this->Faces && !this->Faces->Reflects() };
}

int IterationInBlocks::Functions() const
{
  const int degree = this->Scene.Scattering().Degree();
  return (degree + 1) * (degree + 1);
}

std::vector<Light> IterationInBlocks::LampsOf(const Illumination& shining) const
{
  const SplitEnvironment far = Split(shining.environment, this->DirectionsOfBoundary().Set());
  std::vector<Light> lamps = shining.lights;
  lamps.insert(lamps.end(), far.peaks.begin(), far.peaks.end());
  return lamps;
}

std::unique_ptr<SweepOperator> IterationInBlocks::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->Others.Together([&] {
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, this->Others, this->Partition, this->Layout,
      this->OnDevice.SigmaT(), this->Settings.periodic, request, this->Workspace);
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
    this->Source.Write(values.data(), values.size() - SweepPadding);
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

/// What of the light that is given goes straight on.
void IterationInBlocks::LoadStraightOn()
{
  bool any = false;
  this->Others.Together([&] {
    any = this->Given &&
      this->Given->AddStraightOn(
        this->TheDevice, this->Layout, this->Angular ? &this->Angular->Basis() : nullptr, this->Source);
  });
  this->Shining = this->Others.Largest({ any || this->Shining ? 1.0 : 0.0 })[0] > 0.0;
}

/// Of lamps, and peaks of the environment, which are such, then of what comes in along directions of its own, and what
/// is given.
void IterationInBlocks::AddUncollided(const Monitor& monitor)
{
  const bool corrects =
    this->Way.finer.correctsEscape && this->Scene.traits.scatters && !Reflects(this->Scene.illumination);
  const double all = static_cast<double>(this->Lamps.size() + (this->FineBoundary ? 1 : 0) + (corrects ? 1 : 0));
  SweepTally tally;
  for (std::size_t i = 0; i < this->Lamps.size(); ++i)
  {
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    Add(tally, this->AddOnAllRanks([&] { return this->AddLamp(i, ofLamp); }));
  }
  if (this->Has && this->StoresMoments())
  {
    this->Scattering->AddFirstScattered(this->WholeDeposit(), this->Shown);
  }
  if (this->FineBoundary)
  {
    const double before = static_cast<double>(this->Lamps.size());
    const Monitor ofBoundary = OfPart(monitor, before / all, (before + 1) / all);
    const UncollidedBoundary boundary(this->Settings, *this->FineBoundary);
    Add(tally, this->AddOnAllRanks([&] { return boundary.AddTo(this->VolumeOf(this->WholeDeposit()), ofBoundary); }));
  }
  if (this->Scene.given)
  {
    Add(tally, this->AddGiven(monitor));
  }
  this->Ledger.Count(tally);
  this->Stranded = tally.onTheWay;
  if (this->Faces)
  {
    this->Faces->TakeUncollided();
  }
  if (corrects)
  {
    this->FindEscaping(OfPart(monitor, (all - 1.0) / all, 1.0));
  }
}

/// What goes wrong on one rank does on all: light is swept by all together.
SweepTally IterationInBlocks::AddOnAllRanks(const std::function<SweepTally()>& add)
{
  SweepTally tally;
  std::exception_ptr error;
  try
  {
    tally = add();
  }
  catch (...)
  {
    error = std::current_exception();
  }
  this->Others.Together([&] {
    if (error)
    {
      std::rethrow_exception(error);
    }
  });
  return tally;
}

UncollidedVolume IterationInBlocks::VolumeOf(const Deposit& deposit)
{
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  UncollidedVolume volume = { this->TheDevice, this->Layout, this->OnDevice.SigmaT(), this->Settings.periodic, sweeps,
    deposit };
  volume.whole = &this->Partition.whole;
  volume.basis = this->Angular ? &this->Angular->Basis() : nullptr;
  volume.followLamp = [this](const SweepVolume& ofChannels, const Light& lamp, const Monitor& ofLamp) {
    if (!this->NearLamps)
    {
      this->NearLamps = std::make_unique<LampsInBlocks>(
        this->TheDevice, this->Others, this->Partition, this->Layout, this->OnDevice.SigmaT());
    }
    return this->NearLamps->Deposit(ofChannels, lamp, ofLamp);
  };
  return volume;
}

SweepTally IterationInBlocks::AddLamp(std::size_t lamp, const Monitor& monitor)
{
  UncollidedVolume volume = this->VolumeOf(this->WholeDeposit());
  if (this->Angular)
  {
    this->OfLamp.Fill(0.0f);
    volume.beamPath = &this->OfLamp;
  }
  const SweepTally tally = UncollidedLamp(this->Lamps[lamp]).AddTo(volume, monitor);
  const int beam = this->Angular ? this->Angular->BeamOf(lamp) : -1;
  if (beam >= 0)
  {
    this->Scattering->AddBeam(this->OfLamp, this->Source, beam);
  }
  return tally;
}

/// What came in is what all ranks' voxels take and what left, which each is told.
SweepTally IterationInBlocks::AddGiven(const Monitor& monitor)
{
  SweepTally own;
  this->Others.Together([&] {
    if (this->Given)
    {
      own = this->Given->AddTo(this->VolumeOf(this->WholeDeposit()), monitor);
    }
  });
  SweepTally all;
  std::vector<double> taken, left;
  for (int c = 0; c < 3; ++c)
  {
    taken.push_back(own.in[0][c]);
    for (int face = 0; face < 6; ++face)
    {
      taken.back() -= own.out[face][c];
      left.push_back(own.out[face][c]);
    }
  }
  taken = this->Others.Sum(taken);
  left = this->Others.Largest(left);
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

/// By an even sky along the finer directions and the usual ones, whatever shines: lights add up.
void IterationInBlocks::FindEscaping(const Monitor& monitor)
{
  Illumination evenly;
  evenly.sky = { 1.0, 1.0, 1.0 };
  const auto along = [&](const SweptDirections& directions, const Monitor& ofThese) {
    Buffer<float> path;
    this->Others.Together([&] {
      path = Buffer<float>(this->TheDevice, this->Layout.MomentFloats(this->Functions()), "uncollided light");
      path.Fill(0.0f);
    });
    const BoundaryLight light(this->Partition.whole, this->Settings, directions, evenly, {});
    const UncollidedBoundary boundary(this->Settings, light);
    this->AddOnAllRanks([&] { return boundary.AddTo(this->VolumeOf({ &path }), ofThese); });
    return path.Read();
  };
  const std::vector<float> fine = along(*this->Fine, OfPart(monitor, 0.0, 0.8));
  const std::vector<float> usual = along(this->Directions, OfPart(monitor, 0.8, 1.0));
  this->Others.Together([&] {
    this->Escaping.emplace(
      this->TheDevice, this->Layout, this->Scene.Scattering(), this->OnDevice.SigmaT(), fine, usual);
  });
}

/// Of what was scattered and just swept.
void IterationInBlocks::LetEscape()
{
  Rgb own = {};
  this->Others.Together([&] { own = this->Has ? this->Escaping->Apply(this->Path, this->Source) : Rgb{}; });
  const std::vector<double> all = this->Others.Sum({ own[0], own[1], own[2] });
  for (int c = 0; c < 3; ++c)
  {
    this->Escaped[c] += all[c];
    this->Ledger.Escape(c, all[c]);
  }
}

void IterationInBlocks::MakeCells()
{
  for (int c = 0; c < this->Layout.channels && this->Way.orders.how == OrdersAdded::ByCells; ++c)
  {
    this->Cells.push_back(std::make_unique<CellsOverRanks>(this->TheDevice, this->Others, this->Partition, this->Layout,
      c, this->OnDevice, this->Way.orders.halvings, this->Settings.source != PropagationSource::Constant));
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
      this->Ledger.Escape(c, face, -this->KeptByCells[face][c]); // that the sweep just done let out
      this->KeptByCells[face][c] = powers.kept[face];
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

/// What faces give back of the light that left in this order has not left.
void IterationInBlocks::Reflect()
{
  this->Reflected = {};
  if (!this->Faces)
  {
    return;
  }
  const std::array<Rgb, 6> back = this->Faces->Reflect();
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Reflected[c] += back[face][c];
      this->Ledger.Escape(c, face, -back[face][c]);
    }
  }
}

/// @param scale  to W / length^2
void IterationInBlocks::TakeDirect(const Buffer<float>& fluence, double scale)
{
  if (this->Order == 0 && this->Has)
  {
    this->Direct = Interleaved(this->Layout, fluence, scale);
  }
}

/// One order: from the light that was swept to the next source, with the powers of all ranks.
void IterationInBlocks::Scatter()
{
  if (!this->Cells.empty())
  {
    this->TakeDirect(this->Path, 1.0 / this->Layout.grid.VoxelVolume());
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
      this->Scattering->ScatterOrder(this->WholeDeposit(), this->Fluence, this->Source, { 0, this->Layout.Stride() });
    std::copy(own.absorbed.begin(), own.absorbed.end(), powers.begin());
    std::copy(own.scattered.begin(), own.scattered.end(), powers.begin() + 3);
    if (this->StoresMoments())
    {
      // What is shown holds lamps' light alone before the first order.
      const std::size_t values = this->Layout.Places(this->Functions()).beams;
      AddToShown(this->TheDevice, values, this->Source, this->Shown, this->Order == 0 ? -1.0f : 1.0f);
      if (this->Order == 0 && this->Given)
      {
        this->Given->AddStraightOn(this->TheDevice, this->Layout, &this->Angular->Basis(), this->Shown);
      }
    }
  });
  this->TakeDirect(this->Fluence, 1.0);
  powers = this->Others.Sum(powers);
  for (int c = 0; c < 3; ++c)
  {
    this->Ledger.Absorb(c, powers[c]);
    this->Scattered[c] = powers[3 + c];
    this->Ledger.LeaveOver(c, this->Scattered[c] + this->OnTheWay[c] + this->Reflected[c] + this->Stranded[c]);
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
    const double now = this->Scattered[c] + this->OnTheWay[c] + this->Reflected[c];
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
  if (this->Scene.given)
  {
    this->LoadStraightOn();
  }
  if (this->Way.orders.how == OrdersAdded::ByBalance)
  {
    this->RunByBalance(monitor);
    return this->TakeLight();
  }
  this->MakeCells();
  SweepRequest request = { this->WholeDeposit(),
    { { 0, this->Directions.Along(0) }, { 1, this->Directions.Along(1) }, { 2, this->Directions.Along(2) } } };
  request.angular = this->Angular ? &this->Angular->Values() : nullptr;
  request.mostPlanes = this->Settings.maximumOrders > 0 ? MostPlanesAround : FewPlanes;
  request.faceIn = this->Faces && this->Faces->Reflects() ? &this->Faces->In() : nullptr;
  const std::unique_ptr<SweepOperator> sweep = this->MakeSweep(request);
  const std::size_t ofBeams = this->Angular ? this->Angular->Beams() * this->Layout.Values() : 0;
  BeamsInSource beams(this->TheDevice, this->Source, this->Layout.Places(this->Functions()).beams, ofBeams);
  do
  {
    const Monitor ofOrder =
      OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, this->Residual, this->Order + done); });
    const bool first = this->Order == 0;
    if (first)
    {
      this->AddUncollided(OfPart(ofOrder, 0.0, UncollidedPart));
    }
    const bool lit = first && this->Boundary.Shines() && !this->FineBoundary;
    const SweepBoundary boundary = lit ? this->Boundary.Boundary() : SweepBoundary();
    const bool goesOn = Sum(this->OnTheWay) > 0.0 || Sum(this->Reflected) > 0.0;
    this->OnTheWay = {};
    if (this->Shining || boundary || goesOn)
    {
      if (first)
      {
        beams.Hold();
      }
      const SweepTally tally = sweep->Apply(
        this->Shining ? &this->Source : nullptr, boundary, OfPart(ofOrder, first ? UncollidedPart : 0.0, 1.0));
      this->Ledger.Count(tally);
      this->OnTheWay = tally.onTheWay;
      beams.GoOn();
    }
    if (this->Escaping && this->Shining && !first)
    {
      this->LetEscape();
    }
    this->Reflect();
    this->Scatter();
    ++this->Order;
  } while (!this->Done());
  this->Ledger.ShareEscaped(this->Escaped);
  return this->TakeLight();
}

/// Light of lamps goes ahead, and what of it is scattered is given to the sweeps.
void IterationInBlocks::RunByBalance(const Monitor& monitor)
{
  AccelerationInBlocks acceleration({ this->TheDevice, this->Others, this->Partition, this->Scene, this->Settings,
    this->Layout, this->OnDevice, this->Directions, this->Boundary, this->Lamps,
    [this](const SweepRequest& request) { return this->MakeSweep(request); },
    [this](const Light& lamp, const Deposit& to, const Monitor& ofLamp) {
      return UncollidedLamp(lamp).AddTo(this->VolumeOf(to), ofLamp);
    },
    this->Source, this->Path, this->Fluence, this->Flux, this->Ledger, this->Shining });
  const Monitor ofLamps =
    OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, 1.0, UncollidedPart * done); });
  if (!this->Lamps.empty() && acceleration.NeedsFirstMoments())
  {
    acceleration.AddBeams(ofLamps);
  }
  else
  {
    this->AddUncollided(ofLamps);
  }
  this->Rows = acceleration.Run(monitor);
  this->Direct = acceleration.Direct();
  this->SurfaceRadiance = acceleration.FindSurfaceRadiance();
}

/// What is shown of scattered light, in the same form on all ranks.
void IterationInBlocks::AddShown(LightField& light)
{
  std::unique_ptr<ShownLight> shown;
  if (this->Angular)
  {
    std::size_t most = 0;
    for (const VoxelBox& block : this->Partition.blocks)
    {
      most = std::max(most, this->Layout.channels * block.VoxelCount());
    }
    shown = std::make_unique<ShownLight>(
      this->Scene.medium, this->Scene.Scattering(), this->Angular->Basis(), this->Layout, most);
  }
  const bool coloured = this->Others.Largest({ shown && shown->HasColour() ? 1.0 : 0.0 })[0] > 0.0;
  if (shown)
  {
    shown->TakeColour(coloured);
    shown->AddTo(light, this->TheDevice, this->Shown, this->Path);
  }
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
  if (this->Scene.traits.scatters)
  {
    light.leftOut = this->Scene.Scattering().LeftOut();
  }
  if (this->Scene.given)
  {
    light.leftOut.emplace_back(left_out::OwnUncollided);
  }
  if (this->StoresMoments())
  {
    this->AddShown(light);
  }
  else if (this->Scene.Scattering().Degree() > 0)
  {
    light.leftOut.emplace_back(left_out::MomentsForPictures);
  }
  const EnergyLedger ledger = this->WithOutOfCells();
  light.balance = ledger.Balance();
  light.facePowerOut = ledger.FacePowerOut();
  if (this->Faces)
  {
    const std::vector<double> left = this->Faces->LeftInAll();
    light.facePower =
      this->Faces->PerArea(this->Cells.empty() ? left : this->Faces->ScaledTo(left, light.facePowerOut));
  }
  light.surfaceRadiance = std::move(this->SurfaceRadiance);
  light.convergence = this->Way.orders.how == OrdersAdded::ByBalance ? this->Rows : this->Convergence.All();
  light.directionsPerFace = this->Settings.directionsPerFace;
  light.halfRangeFlux = HalfRangeFlux((this->FineBoundary ? *this->Fine : this->Directions).Set());
  light.uncollidedDirections = this->FineBoundary ? this->Fine->Set().PerFace() : 0;
  light.device = this->TheDevice.Name();
  if (this->Way.orders.how == OrdersAdded::OneByOne)
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
