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
  , Settings(parts.Problem.Settings())
  , TheMedium(parts.Problem.TheMedium())
  , LinearSource(parts.Problem.HasLinearSource())
  , Warm(parts, kept, "diffusion acceleration")
{
}

IterationResult DiffusionAcceleration::Run(const Monitor& monitor)
{
  this->Uncollided.emplace(this->Parts,
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
      this->Parts.Fluence.Write(this->SweptFluence().data());
      this->Result.fluenceDirect = Interleaved(this->Parts.Layout, this->Parts.Fluence, 1.0);
      this->MakeSystems();
      this->LookAtDirect();
    }
    this->Correct(iteration);
    if (iteration == 0 && this->Warm.Keeps())
    {
      this->BeginWarm();
    }
    Report(ofSweep, 1.0);
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
    this->Result.leftByCell = this->LeftByCell();
  }
  return std::move(this->Result);
}

/// The source of a next sweep, less what the medium emits and what lamps' light is scattered first.
void DiffusionAcceleration::FindShown()
{
  TransportParts& parts = this->Parts;
  this->ScatterFound();
  Buffer<float> shown(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light shown");
  shown.Fill(0.0f);
  parts.LoadEmission(shown);
  if (!this->Uncollided->PathOfLamps().empty())
  {
    parts.Path.Write(this->Uncollided->PathOfLamps().data());
    parts.Scattering->AddFirstScattered(parts.WholeDeposit(), shown);
  }
  AddToShown(parts.TheDevice, parts.Layout.Places(parts.Functions()).beams, parts.Source, shown, -1.0f);
  this->Result.shown = std::move(shown);
}

/// What of uncollided light is scattered is a given source, like what the medium emits.
void DiffusionAcceleration::GiveFirstScattered()
{
  TransportParts& parts = this->Parts;
  this->Given = Buffer<float>(parts.TheDevice, parts.Source.Read(), "the light given");
  parts.DarkenBeams(); // until what is first scattered shines
  this->GivenPower = this->Uncollided->Ledger().Balance().emitted;
  std::vector<float> path = this->Uncollided->Path();
  parts.Path.Write(path.data());
  parts.Scattering->AddFirstScattered(parts.WholeDeposit(), this->Given);
  if (parts.Basis)
  {
    this->GivenFlux = Buffer<float>(parts.TheDevice, parts.Layout.Floats(3), "the net flux given");
    this->GivenFlux.Fill(0.0f);
    AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), this->Given, this->GivenFlux);
  }
  const double volume = parts.Layout.grid.VoxelVolume();
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->GivenPower[c] += SumOverVoxels(parts.Layout.grid, [&](std::size_t i) {
      float& here = path[c * parts.Layout.Stride() + i];
      const double scattered = static_cast<double>(parts.Problem.Scattering().SigmaS(i, c)) * here;
      here = static_cast<float>(here / volume);
      return scattered;
    });
  }
  this->UncollidedFluence.swap(path);
}

void DiffusionAcceleration::MakeSweep()
{
  TransportParts& parts = this->Parts;
  this->PartialCurrents = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), "the power from voxel to voxel");
  SweepRequest request = { this->DepositOfSweep(), parts.AllRays() };
  request.sameBoundary = true;
  request.angular = parts.UsualValues();
  request.faceIn = parts.LightByCells();
  this->Swept = parts.MakeSweep(request);
}

/// No flux: it comes from the system.
Deposit DiffusionAcceleration::DepositOfSweep() const
{
  const Deposit whole = this->Parts.WholeDeposit();
  return { whole.path, nullptr, &this->PartialCurrents, nullptr, whole.faceOut, whole.spreadsAside };
}

/// From the source that is there to path integrals and partial currents. The light that comes in from outside comes in
/// every time.
void DiffusionAcceleration::Sweep(int iteration, const Monitor& monitor)
{
  if (iteration == 1)
  {
    this->Parts.LightBeams(this->Given);
  }
  this->ScatterFound();
  for (std::size_t c = 0; c < this->Systems.size(); ++c)
  {
    if (this->VoxelPower(static_cast<int>(c)) > 0.0)
    {
      this->Systems[c]->ShapeSource();
    }
  }
  this->Parts.Path.Fill(0.0f);
  this->PartialCurrents.Fill(0.0f);
  this->Swept->Forget();
  const bool shines = iteration > 0 || this->Parts.HasSource();
  this->Tally = this->Swept->Apply(shines ? &this->Parts.Source : nullptr, this->Parts.BoundaryOfSweeps(), monitor);
  this->TakeSweptFaces();
}

/// What of uncollided light comes back comes back every time.
void DiffusionAcceleration::ReflectUncollided()
{
  TransportParts& parts = this->Parts;
  if (!parts.Faces)
  {
    return;
  }
  this->Box.emplace(*parts.Faces);
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->GivenPower[c] += this->Box->GivenBack()[c];
    this->Faces.emplace_back(parts.TheDevice, (FaceLeaves + 1) * parts.Faces->Cells(), "the light at the box's faces");
  }
}

/// What came back and left in the sweep, for the diffusion systems.
void DiffusionAcceleration::TakeSweptFaces()
{
  if (!this->Box)
  {
    return;
  }
  this->Box->TakeSwept();
  for (std::size_t c = 0; c < this->Faces.size(); ++c)
  {
    this->Faces[c].Write(this->Box->RowsOf(static_cast<int>(c)).data());
  }
}

/// By cell of the box's faces, without the pattern of rays.
std::vector<double> DiffusionAcceleration::LeftByCell() const
{
  const Grid& grid = this->Parts.Layout.grid;
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  std::vector<double> tau;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    ForBoxFaceCells(
      grid, [&](const BoxFaceCell& cell) { tau.push_back(longest * this->TheMedium.TransportSigmaT(cell.voxel, c)); });
  }
  const std::array<Rgb, 6> incoming =
    this->Parts.SweepCarriesBoundarySource() ? this->Parts.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{};
  return this->Box->LeftWithoutPattern(incoming, tau, this->Parts.SpreadsAside());
}

/// The source of the next sweep, of what the last one and the systems found.
void DiffusionAcceleration::ScatterFound()
{
  for (std::size_t c = 0; c < this->Systems.size(); ++c)
  {
    if (this->VoxelPower(static_cast<int>(c)) > 0.0)
    {
      this->Parts.Scattering->ScatterFluence(
        static_cast<int>(c), this->DepositOfSweep(), this->Systems[c]->NextFluence(), this->Given, this->Parts.Source);
    }
  }
}

/// Of the last sweep, with uncollided light; [channel][stride].
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
  const CrossingPattern pattern = FindCrossingPattern(
    parts.Layout.grid, parts.Usual.Set(), this->Settings.mapResolution, parts.Usual.Starts(), this->Settings.periodic);
  const std::array<Rgb, 6> incoming =
    parts.SweepCarriesBoundarySource() ? parts.UsualBoundary->IncomingPower() : std::array<Rgb, 6>{};
  const bool passes = this->Uncollided->Passed().Size() > 0;
  if (passes)
  {
    this->OfLamps = this->Uncollided->ScatteredInVoxels();
  }
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    std::array<double, 6> ofChannel, albedo = {};
    for (int face = 0; face < 6; ++face)
    {
      albedo[face] = parts.Faces ? parts.Faces->Albedo()[face][c] : 0.0;
      ofChannel[face] = incoming[face][c];
      this->PowerIn[c] += this->Tally.in[face][c];
    }
    const DiffusionSystem::Arrays arrays = { parts.Layout.Stride(), parts.Layout.ExtinctionFirst(c),
      c * parts.Layout.Stride(), &parts.OnDevice.TransportSigmaT(), &parts.OnDevice.SigmaT(), &parts.OnDevice.SigmaA(),
      &parts.OnDevice.SigmaS(), &this->Given, parts.Layout.Places(parts.Functions()), c,
      parts.Basis ? &this->GivenFlux : nullptr, &parts.Source, &parts.Path, &this->PartialCurrents,
      passes ? &this->Uncollided->Passed() : nullptr, passes ? &this->OfLamps : nullptr,
      parts.Faces ? &this->Faces[c] : nullptr, albedo };
    this->Systems.push_back(std::make_unique<DiffusionSystem>(parts.TheDevice, parts.Layout.grid,
      this->Settings.periodic, parts.Usual.Set(), pattern, arrays, ofChannel, this->LinearSource));
  }
}

/// W of a voxel, about: the unit that the system's solver works in.
double DiffusionAcceleration::VoxelPower(int c) const
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
    const double power = this->VoxelPower(c);
    if (power > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(power));
      if (this->Parts.Basis)
      {
        this->Systems[c]->PutNextFlux(this->Parts.Path);
      }
    }
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

/// Where the power went, by the diffusion system, which conserves it. What left in the sweep is used only to share it
/// among the faces.
void DiffusionAcceleration::CountLight()
{
  this->Result.ledger = this->Uncollided->Ledger();
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
      continue; // dark: never solved for
    }
    this->Result.ledger.Absorb(c, this->Systems[c]->Absorbed());
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(entered, ofSweep);
    if (this->Box)
    {
      const std::vector<float> rows = this->Faces[c].Read();
      this->Box->SetLeaving(
        c, { rows.begin() + static_cast<std::ptrdiff_t>(FaceLeaves * this->Parts.Faces->Cells()), rows.end() });
    }
    for (int face = 0; face < 6 && !this->Box; ++face)
    {
      this->Result.ledger.Escape(c, face, outflow[face]);
    }
  }
  if (this->Box)
  {
    this->Box->Count(this->Result.ledger);
  }
}

bool DiffusionAcceleration::Done(int iterations) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweeps;
  // A guess has shown already how fast changes fall, but angular moments are not among them.
  const int least = this->Warm.Begins() && !this->Parts.Basis ? 2 : 3;
  return iterations >= most || this->Residual == 0.0 ||
    (iterations >= least && MeetsTolerance(this->Settings, this->Residual));
}

void DiffusionAcceleration::LookAtDirect()
{
  if (this->Warm.Keeps())
  {
    this->Warm.Prepare(this->Parts.Fluence.Read());
  }
}

/// What the first sweep and its system find is found anew each time; what later ones add to it is kept, and given to
/// the second sweep (numerics.md, Eq. (46d)).
void DiffusionAcceleration::BeginWarm()
{
  const TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  this->First = this->UncollidedFluence;
  this->First.resize(layout.Values());
  this->FirstMoments = parts.Basis ? parts.Path.Read() : std::vector<float>();
  for (int c = 0; c < layout.channels; ++c)
  {
    const std::vector<double> found = this->Systems[c]->Found();
    for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
    {
      this->First[c * layout.Stride() + i] += static_cast<float>(found[i]);
    }
    if (this->Warm.Begins())
    {
      this->Systems[c]->Begin(this->WithGuess(c));
    }
  }
  if (this->Warm.Begins() && parts.Basis)
  {
    AddMoments(parts.TheDevice, layout, parts.Functions(), this->Warm.Guess(), parts.Path);
  }
}

/// What a channel's system has solved for, and what is guessed beyond it.
std::vector<double> DiffusionAcceleration::WithGuess(int c) const
{
  const VolumeLayout& layout = this->Parts.Layout;
  const MomentPlaces places = layout.Places(this->Parts.Functions());
  const std::size_t voxels = layout.grid.VoxelCount();
  const double volume = layout.grid.VoxelVolume();
  std::vector<double> values = this->Systems[c]->State();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    values[i] += this->Warm.Guessed()[c * layout.Stride() + i] / volume;
    for (int axis = 0; axis < 3 && this->Parts.Basis; ++axis)
    {
      const int function = axis == 0 ? 3 : axis;
      values[(axis + 1) * voxels + i] +=
        this->Warm.Guessed()[VolumeLayout::MomentPlace(places, function, c, i)] / volume;
    }
  }
  return values;
}

void DiffusionAcceleration::Leave()
{
  std::vector<float> moments = this->Parts.Basis ? this->Parts.Path.Read() : std::vector<float>();
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    moments[i] -= this->FirstMoments[i];
  }
  const double rate = std::clamp(this->Rest.Ratio(), 0.5, 0.95);
  this->Result.warm = this->Warm.Begins();
  this->Result.kept = this->Warm.Leave(this->First, moments, { rate, rate, rate });
}

void DiffusionAcceleration::WriteFluence()
{
  TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  for (int c = 0; c < layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->VoxelPower(c));
    }
  }
  this->CountLight();
  std::vector<float> fluence(layout.Values(), 0.0f);
  for (int c = 0; c < layout.channels; ++c)
  {
    const std::vector<double> solved = this->Systems[c]->Found();
    std::copy(solved.begin(), solved.end(), fluence.begin() + static_cast<std::ptrdiff_t>(c * layout.Stride()));
    if (this->Settings.netFlux && !parts.Basis && this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->AddFlux(parts.Flux);
    }
  }
  SingleRank alone;
  const BlockPartition whole = BlockPartition::Even(layout.grid, 1);
  const Halo around(alone, whole, this->Settings.periodic, 1);
  MakeFluence(alone, around, layout, this->TheMedium.sigma_a, fluence, parts.Path.Read(), this->UncollidedFluence);
  parts.Fluence.Write(fluence.data());
  if (this->Settings.netFlux)
  {
    if (parts.Basis) // the moments of degree 1 have less of the pattern of rays than the powers through faces
    {
      AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), parts.Path, parts.Flux);
    }
    LimitFlux(parts.Layout, fluence, parts.Flux);
  }
}

/// Of thick voxels, from the powers of the system.
void DiffusionAcceleration::FindSurfaceRadiance()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const std::array<bool, 6> open = { !periodic[0], !periodic[0], !periodic[1], !periodic[1], !periodic[2],
    !periodic[2] };
  if (!this->LinearSource || !IsThickAtFaces(this->TheMedium, open, this->Parts.Layout.channels))
  {
    return;
  }
  std::vector<float> lamps = this->Uncollided->PathOfLamps();
  for (float& fluence : lamps)
  {
    fluence = static_cast<float>(fluence / this->Parts.Layout.grid.VoxelVolume());
  }
  std::vector<SurfacePowers> powers(this->Parts.Layout.channels);
  for (std::size_t c = 0; c < powers.size(); ++c)
  {
    powers[c] = this->VoxelPower(static_cast<int>(c)) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers();
    powers[c].lamps = lamps.empty() ? nullptr : lamps.data() + c * this->Parts.Layout.Stride();
  }
  this->Result.surfaceRadiance = SurfaceRadiance(this->TheMedium, open, this->Parts.Lamps, powers);
}
}
