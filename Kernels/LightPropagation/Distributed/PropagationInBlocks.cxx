#include "LightPropagation/Distributed/PropagationInBlocks.h"

#include "Device/Errors.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/CellsOverRanks.h"
#include "LightPropagation/Distributed/SweepInBlocks.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/Scattering/IsotropicScattering.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr double CellAtMost = 1.0;  ///< optical width of cells where the medium is thickest
constexpr int MostHalvings = 3;     ///< of voxels into cells
constexpr double ManyOrders = 2.0;  ///< mean free paths through the box along its thinnest axis that pay for cells
constexpr double FallByCells = 0.3; ///< of what is left over from order to order, at least so much in the forecast

bool HasVoxels(const BlockPartition& partition, const Communicator& communicator)
{
  return partition.blocks[communicator.Rank()].VoxelCount() > 0;
}

/// A number on every rank, where ranks without voxels have none.
/// @throws InvalidInput where they differ
void RequireSame(Communicator& communicator, const char* what, bool has, std::vector<double> values)
{
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(-values[i]);
  }
  if (!has)
  {
    std::fill(values.begin(), values.end(), -std::numeric_limits<double>::infinity());
  }
  const std::vector<double> largest = communicator.Largest(values);
  for (std::size_t i = 0; i < count; ++i)
  {
    Require(largest[i] == -largest[count + i],
      std::string("The ranks that share the medium disagree about ") + what + ": give every piece the same.");
  }
}

/// The grid, and who has which part of it.
void RequireSame(Communicator& communicator, const BlockPartition& partition)
{
  std::vector<double> numbers;
  for (int axis = 0; axis < 3; ++axis)
  {
    numbers.push_back(partition.whole.size[axis]);
    numbers.push_back(partition.whole.spacing[axis]);
    numbers.push_back(partition.whole.origin[axis]);
    for (const VoxelBox& block : partition.blocks)
    {
      numbers.push_back(block.first[axis]);
      numbers.push_back(block.size[axis]);
    }
  }
  RequireSame(communicator, "the grid or its blocks", true, numbers);
}

/// What all ranks must have alike.
void RequireSame(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings)
{
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a, sigma_s or emission, or one has no emission", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s), 1.0 * components(medium.emission) });
  const bool varies = has && medium.phase.Varies();
  const auto cosine = [&](int c) { return has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  RequireSame(communicator, "g", has, { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) });
  RequireSame(communicator, "settings", true,
    { 1.0 * settings.directionsPerFace, 1.0 * settings.mapResolution, 1.0 * settings.maximumOrders, settings.tolerance,
      1.0 * settings.netFlux, 1.0 * settings.leaveOut, 1.0 * settings.staggeredRays });
  std::vector<double> light = { 1.0 * static_cast<double>(illumination.lights.size()), Sum(illumination.sky),
    1.0 * illumination.environment.width, 1.0 * illumination.environment.height };
  for (const Rgb& face : illumination.faces)
  {
    light.insert(light.end(), face.begin(), face.end());
  }
  RequireSame(communicator, "what shines on it", true, light);
}

/// Traits of the medium of all ranks.
MediumTraits TraitsOfAll(Communicator& communicator, bool has, const Medium& medium)
{
  MediumTraits traits = has ? TraitsOf(medium, true) : MediumTraits();
  const std::vector<double> any = communicator.Largest({ traits.absorbs ? 1.0 : 0.0, traits.scatters ? 1.0 : 0.0,
    traits.emits ? 1.0 : 0.0, traits.grey ? 0.0 : 1.0, traits.greyExtinction ? 0.0 : 1.0 });
  traits.absorbs = any[0] > 0.0;
  traits.scatters = any[1] > 0.0;
  traits.emits = any[2] > 0.0;
  traits.grey = any[3] == 0.0;
  traits.greyExtinction = any[4] == 0.0;
  return traits;
}

/// A block's scene in the units and channels of all.
struct BlockScene
{
  BlockScene(Communicator& communicator, bool has, const Grid& whole, const Medium& ofBlock,
    const Illumination& shining, const PropagationSettings& settings)
    : medium(ofBlock)
    , illumination(shining)
    , traits(TraitsOfAll(communicator, has, ofBlock))
    , lengthUnit(LengthUnitOf(whole))
  {
    communicator.Together([&] {
      if (has && this->lengthUnit != 1.0)
      {
        this->InLengths.emplace(this->medium, this->illumination, this->lengthUnit);
        this->medium = this->InLengths->medium;
        this->illumination = this->InLengths->illumination;
      }
    });
    this->powerUnit = communicator.Largest({ has ? PowerUnitOf(this->medium, this->illumination) : 0.0 })[0];
    if (has && this->powerUnit != 1.0)
    {
      this->InUnits.emplace(this->medium, this->illumination, this->powerUnit);
      this->medium = this->InUnits->medium;
      this->illumination = this->InUnits->illumination;
    }
    const SceneChannels reduction(this->medium, this->traits, this->illumination);
    this->channels = static_cast<int>(communicator.Largest({ has ? 1.0 * reduction.given : 1.0 })[0]);
    if (has && this->channels == 1)
    {
      const OneChannelScene one(this->medium, this->illumination, reduction);
      this->medium = one.medium;
      this->illumination = one.light;
    }
    this->sharedExtinction = this->channels == 1 || (settings.leaveOut && this->traits.greyExtinction);
  }
  BlockScene(const BlockScene&) = delete;
  BlockScene& operator=(const BlockScene&) = delete;

  /// The grid of all, in the unit of length.
  Grid WholeOf(Grid grid) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      grid.spacing[axis] /= this->lengthUnit;
      grid.origin[axis] /= this->lengthUnit;
    }
    return grid;
  }

  void Undo(LightField& light) const
  {
    if (this->powerUnit != 1.0)
    {
      ToWatts(light, this->powerUnit);
    }
    if (this->lengthUnit != 1.0)
    {
      MultiplyPowers(light, this->lengthUnit * this->lengthUnit);
    }
  }

  Medium medium;
  Illumination illumination;
  MediumTraits traits;
  double lengthUnit, powerUnit = 1.0;
  int channels = 1;
  bool sharedExtinction = true;

private:
  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
};

/// Source iteration on one rank's block, in step with the others.
class IterationInBlocks
{
public:
  IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const BlockScene& scene, const PropagationSettings& settings);
  LightField Run(const Monitor& monitor);

private:
  VolumeLayout LayoutOn(const Grid& grid) const { return { grid, this->Scene.channels, this->Scene.sharedExtinction }; }
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  void LoadEmission();
  void AddLamps(const Monitor& monitor);
  std::array<int, 3> CellHalvings();
  void MakeCells();
  void Scatter();
  void ScatterByCells();
  EnergyLedger WithOutOfCells() const;
  void EstimateResidual();
  bool Done() const;
  Deposit WholeDeposit() const
  {
    return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr };
  }
  LightField TakeLight();

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const BlockScene& Scene;
  const PropagationSettings& Settings;
  const bool Has; ///< voxels
  const VolumeLayout Layout, WholeLayout;
  const TruncatedScattering Truncated;
  const MediumOnDevice OnDevice;
  const IsotropicScattering Scattering;
  const SweptDirections Directions;
  const SplitEnvironment Far;
  const BoundaryLight Boundary;
  Buffer<float> Source, Path, Flux, Fluence;
  BlockWorkspace Workspace;
  std::vector<std::unique_ptr<CellsOverRanks>> Cells; ///< by channel; empty: orders are added up as they are
  std::array<Rgb, 6> OutOfCells = {};                 ///< W, through faces, of all orders to come

  EnergyLedger Ledger;
  ConvergenceRecord Convergence;
  std::vector<float> Direct;
  std::array<RestOfOrders, 3> Rest;
  Rgb Scattered = {}, AllScattered = {};
  double Residual = 1.0;
  int Order = 0;
  bool Shining = false;
};

IterationInBlocks::IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Scene(scene)
  , Settings(settings)
  , Has(HasVoxels(partition, communicator))
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

/// Directional lights and peaks of the environment, which are such.
void IterationInBlocks::AddLamps(const Monitor& monitor)
{
  std::vector<Light> lamps = this->Scene.illumination.lights;
  lamps.insert(lamps.end(), this->Far.peaks.begin(), this->Far.peaks.end());
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  // Rays of a beam are those through the whole box.
  const UncollidedVolume volume = { this->TheDevice, this->WholeLayout, this->OnDevice.SigmaT(),
    this->Settings.periodic, sweeps, this->WholeDeposit() };
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    const double all = static_cast<double>(lamps.size());
    this->Ledger.Count(UncollidedLamp(lamps[i]).AddTo(volume, OfPart(monitor, i / all, (i + 1) / all)));
  }
}

/// How many voxels make a cell, 2^this along each axis; all 0: cells do not pay, or voxels are too thick for them.
std::array<int, 3> IterationInBlocks::CellHalvings()
{
  if (this->Settings.acceleration != PropagationAcceleration::Automatic || this->Settings.maximumOrders > 0 ||
    !this->Scene.traits.scatters)
  {
    return {};
  }
  double thickest = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < this->Layout.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < this->Layout.channels; ++c)
    {
      const double sigma = this->Scene.medium.TransportSigmaT(i, c);
      thickest = std::max(thickest, sigma);
      sum += sigma / this->Layout.channels;
    }
  }
  const Grid& whole = this->Partition.whole;
  thickest = this->Others.Largest({ thickest })[0];
  const double mean = this->Others.Sum({ sum })[0] / static_cast<double>(whole.VoxelCount());
  std::array<int, 3> halvings = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    int& times = halvings[axis];
    while (times < MostHalvings && thickest * whole.spacing[axis] * (2 << times) <= CellAtMost &&
      whole.size[axis] > 1 << times)
    {
      ++times;
    }
    if (mean * whole.Length(axis) < ManyOrders || times == 0)
    {
      return {};
    }
  }
  return halvings;
}

void IterationInBlocks::MakeCells()
{
  const std::array<int, 3> halvings = this->CellHalvings();
  for (int c = 0; c < this->Layout.channels && halvings[0] > 0; ++c)
  {
    this->Cells.push_back(std::make_unique<CellsOverRanks>(
      this->TheDevice, this->Others, this->Partition, this->Layout, c, this->OnDevice, halvings));
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
  light.convergence = this->Convergence.All();
  light.directionsPerFace = this->Settings.directionsPerFace;
  light.halfRangeFlux = HalfRangeFlux(this->Directions.Set());
  light.device = this->TheDevice.Name();
  if (this->Cells.empty())
  {
    light.leftOut.emplace_back(
      "acceleration: few scattering orders do, or voxels of a medium that is spread over ranks "
      "are thick");
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

std::string NotInBlocks(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  if (settings.periodic[0] || settings.periodic[1] || settings.periodic[2])
  {
    return "a periodic axis";
  }
  if (Reflects(illumination))
  {
    return "a face that gives back light (FaceAlbedo)";
  }
  const auto isNear = [](const Light& light) { return light.type != LightType::Directional; };
  if (std::any_of(illumination.lights.begin(), illumination.lights.end(), isNear))
  {
    return "a point, spot or rectangle light";
  }
  if (illumination.uncollided.IsThere())
  {
    return "light of another solver (UncollidedLight)";
  }
  if (!medium.phase.IsIsotropic() && settings.angularDegree != 0)
  {
    return "scattering that is not isotropic (g; with AngularDegree 0 it is solved by the similarity relation)";
  }
  if (settings.source == PropagationSource::Linear || settings.source == PropagationSource::Octants)
  {
    return "a source that is not constant in voxels";
  }
  if (settings.uncollidedDirections > 0)
  {
    return "directions of unscattered light of its own (UncollidedDirections)";
  }
  return settings.facePower ? "the power that leaves through cells of the faces" : std::string();
}

LightField SolveInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  const bool has = HasVoxels(partition, communicator);
  communicator.Together([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    if (has)
    {
      Check(medium, illumination, settings);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
    const std::string refused = NotInBlocks(medium, illumination, settings);
    Require(refused.empty(), "A medium that is spread over ranks is not solved with " + refused + ".");
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, settings);
  Medium own = has ? medium : Medium();
  own.grid = partition.OwnGrid(communicator.Rank());
  const BlockScene scene(communicator, has, partition.whole, own, illumination, settings);
  BlockPartition inUnits = partition;
  inUnits.whole = scene.WholeOf(partition.whole);
  std::unique_ptr<IterationInBlocks> iteration;
  communicator.Together(
    [&] { iteration = std::make_unique<IterationInBlocks>(device, communicator, inUnits, scene, settings); });
  LightField light = iteration->Run(monitor);
  communicator.Together([&] { scene.Undo(light); });
  JudgeConvergence(settings, light);
  return light;
}
}
