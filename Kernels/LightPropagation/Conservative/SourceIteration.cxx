#include "LightPropagation/Conservative/SourceIteration.h"

#include "Device/Sizes.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr int FewPlanes = 256;        ///< that a ray crosses around a periodic axis per order, if more orders follow
constexpr double MostlyLit = 0.75;    ///< fraction of rays above which a separate sweep does not pay
constexpr double MostlyFilled = 0.75; ///< the same for voxels
constexpr double FallByCells = 0.3;   ///< smallest assumed ratio of successive remainders
constexpr int OrdersExpected = 6;     ///< assumed when deciding whether to sweep empty slabs only at the end
}

SourceIteration::SourceIteration(TransportParts& parts, const KeptLight* kept)
  : Parts(parts)
  , TheDomain(parts.TheDomain())
  , Settings(parts.Problem.Settings())
  , Warm(parts, kept, parts.How == IterationScheme::CoarseMeshDsa ? "diffusion on cells" : "source iteration")
  , Shining(parts.HasSource())
{
  const bool thick = parts.How == IterationScheme::SourceIteration && OctantSources::Matter(parts.Problem);
  this->TheDomain.Collective([&] {
    if (this->Warm.Keeps() && parts.Basis)
    {
      this->Moments = Buffer<float>(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light to keep");
      this->Moments.Fill(0.0f);
    }
    if (thick)
    {
      this->AtFaces.emplace(OctantSources::Scene{ parts.TheDevice, this->Settings, parts.Layout, parts.OnDevice,
        this->TheDomain.Whole(), this->TheDomain.Own(), !parts.Lights.Lamps.empty() });
    }
    if (parts.StoresMoments())
    {
      this->Result.shown =
        Buffer<float>(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light shown");
      this->Result.shown.Fill(0.0f);
    }
  });
  if (parts.How == IterationScheme::CoarseMeshDsa)
  {
    this->Cells.emplace(parts);
    for (RestOfOrders& rest : this->Rest)
    {
      rest.BeginWarm(FallByCells);
    }
  }
  this->MakeSweeps();
}

IterationResult SourceIteration::Run(const Monitor& monitor)
{
  this->Parts.Lights.CountEmission(this->Result.ledger);
  do
  {
    const Monitor ofOrder =
      OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, this->Residual, this->Order + done); });
    const double uncollided = this->Order == 0 ? UncollidedPart : 0.0;
    if (this->Order == 0)
    {
      this->AddUncollided(OfPart(ofOrder, 0.0, uncollided));
    }
    const bool scatteredShines = this->Shining && this->Order > 0;
    this->SweepOrder(OfPart(ofOrder, uncollided, 1.0));
    if (this->Escaping && scatteredShines)
    {
      this->LetEscape();
    }
    this->ReflectOrder();
    this->ScatterOrder();
    if (this->Order == 0 && this->Warm.Begins() && !this->Cells)
    {
      this->BeginWarm();
    }
    this->TheDomain.Collective([&] { Report(ofOrder, 1.0); });
    ++this->Order;
    this->Lit.reset();
  } while (!this->Done());
  if (this->Filled && this->Order > 1)
  {
    this->SweepEmptySlabs(monitor);
  }
  if (this->Cells)
  {
    this->Result.ledger = this->Cells->WithOut(this->Result.ledger);
  }
  // Dark voxels can be slightly negative, by rounding and because later sweeps would have corrected them; so can voxels
  // behind sources of thick voxels.
  if (this->AtFaces || this->Warm.Begins() || this->Cells)
  {
    Communicator& comm = this->TheDomain.Comm();
    CutOffNegative(comm, Halo(comm, this->TheDomain.Partition(), this->Settings.periodic, 1), this->Parts.Layout,
      this->Parts.Problem.TheMedium().sigma_a, this->Parts.Fluence);
  }
  this->Result.ledger.ShareEscaped(this->Escaped);
  this->Result.leftOut = this->LeftOut();
  if (this->Warm.Keeps())
  {
    this->Leave();
  }
  if (this->Parts.Faces)
  {
    const FaceLight& faces = *this->Parts.Faces;
    this->Result.leftByCell = this->Cells
      ? faces.ScaledTo(
          faces.LeftInAll(), this->Result.ledger.FacePowerOut()) // coarse-mesh DSA changes the totals of faces
      : faces.LeftInAll();
  }
  return std::move(this->Result);
}

/// Applies the escape correction to the light that was just swept.
void SourceIteration::LetEscape()
{
  Rgb escaped = {};
  this->TheDomain.Collective(
    [&] { escaped = this->TheDomain.IsEmpty() ? Rgb{} : this->Escaping->Apply(this->Parts.Path, this->Parts.Source); });
  escaped = this->TheDomain.Sum(escaped);
  for (int c = 0; c < 3; ++c)
  {
    this->Escaped[c] += escaped[c];
    this->Result.ledger.Escape(c, escaped[c]);
  }
}

void SourceIteration::MakeSweeps()
{
  // Coarse-mesh DSA does not know of rays that wait for the next sweep, so they go all the way.
  const bool wholeWay = this->Settings.maximumOrders > 0 || this->Cells;
  const int mostPlanes = wholeWay ? MostPlanesAround : FewPlanes;
  SweepRequest request = { this->DepositOfSweep(), this->Parts.AllRays(), {}, mostPlanes };
  request.octantSource = this->AtFaces ? &this->AtFaces->Sources() : nullptr;
  request.angular = this->Parts.UsualValues();
  request.faceIn = this->Parts.LightByCells();
  this->Whole = this->Parts.Transport.MakeSweep(request);
  this->MakeFilledSweep();
  if (this->Settings.leaveOut && this->Parts.Lights.SweepCarriesBoundarySource() && !this->Shining)
  {
    this->MakeLitSweep();
  }
}

/// Makes the sweep of later orders, which covers only the box that the medium fills: light that leaves this box does
/// not come back. Fluence in the other voxels is computed at the end, for all orders in one sweep. Not used with
/// periodic axes, whose rays would be under way in both sweeps; nor if face light by cell is requested, or sources
/// differ by octant, which the final sweep does not know.
void SourceIteration::MakeFilledSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const MediumTraits& traits = this->Parts.Problem.Traits();
  if (!this->Parts.Transport.SweepsParts() || !this->Settings.leaveOut || !traits.scatters ||
    !this->Parts.Scattering->CanScatterAllOrders() || periodic[0] || periodic[1] || periodic[2] || this->Parts.Faces ||
    this->AtFaces || this->Cells)
  {
    return;
  }
  const double filled =
    static_cast<double>(traits.filled.VoxelCount()) / static_cast<double>(this->Parts.Layout.grid.VoxelCount());
  const int later = (this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : OrdersExpected) - 1;
  if (filled < MostlyFilled && later * (1.0 - filled) > 1.0)
  {
    // No flux: the final sweep computes it.
    this->Filled = this->Parts.Transport.MakeSweep(
      { { &this->Parts.Path, nullptr, nullptr, nullptr }, this->Parts.AllRays(), traits.filled });
  }
}

/// Makes the first sweep, restricted to directions with incident light, if these are few. Not used with periodic axes,
/// where rays wait in the other directions for the next order.
void SourceIteration::MakeLitSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (periodic[0] || periodic[1] || periodic[2])
  {
    return;
  }
  const auto isLit = [this](int direction) { return this->Parts.Lights.UsualBoundary->IsLit(direction); };
  double all = 0.0, lit = 0.0;
  std::vector<AxisBundles> ways;
  for (int axis = 0; axis < 3; ++axis)
  {
    all += CountRays(this->Parts.Usual.Along(axis));
    for (int way = 0; way < 2; ++way)
    {
      ways.push_back({ axis, this->Parts.Usual.LitAlong(axis, way, isLit) });
      lit += CountRays(ways.back().bundles);
    }
  }
  if (lit <= MostlyLit * all)
  {
    this->LitPart = lit / all;
    SweepRequest request = { this->DepositOfSweep(), ways };
    request.angular = this->Parts.UsualValues();
    this->Lit = this->Parts.Transport.MakeSweep(request);
  }
}

void SourceIteration::AddUncollided(const Monitor& monitor)
{
  LightSources::Sources sources = this->Parts.Lights.LampSources();
  const auto append = [&sources](LightSources::Sources more) {
    std::move(more.begin(), more.end(), std::back_inserter(sources));
  };
  append(this->Parts.Lights.OtherSources());
  const std::size_t alongRays = sources.size(); // sources that are traced; the others are swept
  if (this->Parts.Lights.FineBoundary)
  {
    sources.push_back(std::make_unique<UncollidedBoundary>(this->Settings, *this->Parts.Lights.FineBoundary));
  }
  append(this->Parts.Lights.VacuumSources());
  const bool escapes = this->Parts.Lights.Finer.correctsEscape;
  const double all = static_cast<double>(sources.size() + (escapes ? 1 : 0));
  SweepTally tally;
  Buffer<float> firstMoments;
  this->TheDomain.Collective([&] {
    firstMoments = Buffer<float>(
      this->Parts.TheDevice, this->Settings.firstMoments ? this->Parts.Layout.Floats(6) : 1, "where light is lost");
    firstMoments.Fill(0.0f);
  });
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const Monitor ofSource = OfPart(monitor, i / all, (i + 1) / all);
    const bool isLamp = i < this->Parts.Lights.Lamps.size();
    if (this->AtFaces && isLamp) // never if moments are stored
    {
      Add(tally, this->AddLamp(*sources[i], ofSource));
      continue;
    }
    const bool isSwept = i >= alongRays;
    Deposit deposit = isSwept ? this->DepositOfSweep() : this->Parts.WholeDeposit();
    deposit.firstMoments = this->Settings.firstMoments && isLamp ? &firstMoments : nullptr;
    Add(tally, this->Parts.AddUncollided(*sources[i], deposit, ofSource));
    if (this->AtFaces && isSwept)
    {
      const bool ofVacuum = this->Parts.Lights.OfVacuum && i + 1 == sources.size();
      this->TheDomain.Collective(
        [&] { this->AtFaces->TakeIncoming(ofVacuum ? *this->Parts.Lights.OfVacuum : *this->Parts.Lights.Fine); });
    }
    if (i + 1 == this->Parts.Lights.Lamps.size())
    {
      this->ShowLamps();
    }
  }
  this->TheDomain.Collective([&] {
    if (this->Settings.firstMoments)
    {
      const VolumeLayout& layout = this->Parts.Layout;
      this->Result.firstMoments = Interleaved(layout, firstMoments, 1.0 / layout.grid.VoxelVolume());
    }
    if (this->Parts.Faces)
    {
      this->Parts.Faces->TakeUncollided();
    }
  });
  this->Result.ledger.Count(tally);
  this->Stranded = tally.onTheWay;
  if (escapes)
  {
    // Needed for any light source, because contributions of sources add up.
    const TransportParts::EvenSky sky = this->Parts.FindEvenSky(OfPart(monitor, sources.size() / all, 1.0));
    this->TheDomain.Collective([&] {
      this->Escaping.emplace(this->Parts.TheDevice, this->Parts.Layout, this->Parts.Problem.Scattering(),
        this->Parts.OnDevice.SigmaT(), sky.fine.path, sky.usual.path);
    });
  }
}

/// Stores the first-scattered light of lamps, before any other light is added.
void SourceIteration::ShowLamps()
{
  this->TheDomain.Collective([&] {
    if (this->Parts.StoresMoments() && !this->TheDomain.IsEmpty())
    {
      this->Parts.Scattering->AddFirstScattered(this->Parts.WholeDeposit(), this->Result.shown);
    }
  });
}

/// Adds the uncollided light of a lamp, and the first moments of its deposit in thick voxels.
SweepTally SourceIteration::AddLamp(const UncollidedSource& lamp, const Monitor& monitor)
{
  const Deposit whole = this->Parts.WholeDeposit();
  const Deposit ofLamp = { &this->AtFaces->LampPath(), whole.flux, nullptr, &this->AtFaces->LampMoments(),
    whole.faceOut, whole.spreadsAside };
  const SweepTally tally = this->Parts.AddUncollided(lamp, ofLamp, monitor);
  this->TheDomain.Collective([&] { this->AtFaces->TakeLamp(this->Parts.Path); });
  return tally;
}

Deposit SourceIteration::DepositOfSweep() const
{
  Deposit deposit = this->Parts.WholeDeposit();
  deposit.partialCurrents = this->AtFaces ? &this->AtFaces->Currents() : nullptr;
  return deposit;
}

void SourceIteration::SweepOrder(const Monitor& monitor)
{
  const SweepBoundary boundary = this->Order == 0 ? this->Parts.Lights.BoundaryOfSweeps() : SweepBoundary();
  const bool nothing = !boundary && !this->Shining && Sum(this->OnTheWay) == 0.0 && Sum(this->Reflected) == 0.0;
  this->WasOnTheWay = std::exchange(this->OnTheWay, {});
  if (nothing)
  {
    return;
  }
  const Buffer<float>* const source = this->Shining ? &this->Parts.Source : nullptr;
  SweepOperator& sweep = this->InFilledPart() ? *this->Filled : this->Lit ? *this->Lit : *this->Whole;
  BeamsInSource beams = this->Parts.BeamsOfSource();
  this->TheDomain.Collective([&] {
    if (this->Order == 0)
    {
      beams.Hold();
    }
  });
  const SweepTally tally = sweep.Apply(source, boundary, monitor);
  beams.GoOn();
  this->OnTheWay = tally.onTheWay;
  if (!this->InFilledPart())
  {
    this->Result.ledger.Count(tally);
    return;
  }
  for (int c = 0; c < 3; ++c) // the face is not known yet
  {
    for (const Rgb& face : tally.out)
    {
      this->Result.ledger.Escape(c, face[c]);
    }
  }
}

/// Reflects the outgoing light of this order, which has then not escaped.
void SourceIteration::ReflectOrder()
{
  this->Reflected = {};
  if (!this->Parts.Faces)
  {
    return;
  }
  std::array<Rgb, 6> back = {};
  this->TheDomain.Collective([&] { back = this->Parts.Faces->Reflect(); });
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Reflected[c] += back[face][c];
      this->Result.ledger.Escape(c, face, -back[face][c]);
    }
  }
}

/// Index range of a channel that a sweep may have changed, in whole vectors.
std::array<std::size_t, 2> SourceIteration::SweptValues() const
{
  if (!this->InFilledPart())
  {
    return { 0, this->Parts.Layout.Stride() };
  }
  const std::array<int, 3>& n = this->Parts.Layout.grid.size;
  const std::size_t layer = static_cast<std::size_t>(n[0]) * n[1];
  const VoxelBox& filled = this->Parts.Problem.Traits().filled;
  return { layer * filled.first[2] / SweepPadding * SweepPadding,
    RoundUp(layer * (filled.first[2] + filled.size[2]), SweepPadding) };
}

/// As ScatterOrder, plus the predicted sum of all orders to come (coarse-mesh DSA), which is subtracted from the next
/// source.
void SourceIteration::ScatterByCells()
{
  const TransportParts& parts = this->Parts;
  if (this->Order == 0)
  {
    this->LookAtDirect(parts.Path, 1.0 / parts.Layout.grid.VoxelVolume());
  }
  const bool guessed = this->Order == 0 && this->Warm.Begins();
  Rgb foreseen = this->OnTheWay;
  std::transform(foreseen.begin(), foreseen.end(), this->Stranded.begin(), foreseen.begin(), std::plus<>());
  const OrdersByCells::Powers powers =
    this->Cells->ScatterOrder(this->Result.ledger, foreseen, guessed ? &this->Warm.Guess() : nullptr);
  this->Scattered = powers.scattered;
  this->Shining = Sum(powers.magnitude) > 0.0;
  this->Residual = 0.0;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->Result.ledger.SetUnaccounted(c, powers.left[c] + this->OnTheWay[c] + this->Stranded[c]);
    this->AllScattered[c] += powers.scattered[c];
    const double before = std::abs(this->WasOnTheWay[c]), onTheWay = std::abs(this->OnTheWay[c]);
    const double now = this->Cells->ForeseeWay()
      ? GoesOnAsForeseen(before, onTheWay, powers.magnitude[c])
      : GoesOnToItsEnd(this->Settings.maximumOrders, before, onTheWay, powers.magnitude[c]);
    if (now > 0.0 && this->AllScattered[c] > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
    }
  }
  const double all = Sum(this->AllScattered);
  this->Result.convergence.Add(
    this->Residual, all > 0.0 ? std::abs(Sum(this->Scattered)) / all : 0.0, this->Cells->WithOut(this->Result.ledger));
}

/// @param scale  converts `fluence` to W / length^2
void SourceIteration::LookAtDirect(const Buffer<float>& fluence, double scale)
{
  this->TheDomain.Collective([&] {
    this->Result.fluenceDirect = Interleaved(this->Parts.Layout, fluence, scale);
    if (this->Warm.Keeps())
    {
      this->Direct = fluence.Read();
      this->Direct.resize(this->Parts.Fluence.Size());
      std::transform(this->Direct.begin(), this->Direct.end(), this->Direct.begin(),
        [scale](float value) { return static_cast<float>(scale * value); });
    }
  });
  if (this->Warm.Keeps())
  {
    this->Warm.Prepare(this->Direct);
  }
}

void SourceIteration::ScatterOrder()
{
  if (this->Cells)
  {
    this->ScatterByCells();
    return;
  }
  this->FindOctantSources();
  const ScatteringOperator::Powers powers = this->ScatterSwept();
  this->Scattered = powers.scattered;
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.Absorb(c, powers.absorbed[c]);
  }
  this->Shining = Sum(this->Scattered) > 0.0;
  if (this->Warm.Begins() && this->Order > 0)
  {
    this->GoOnWarm();
  }
  else
  {
    this->EstimateResidual();
  }
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.SetUnaccounted(
      c, this->Scattered[c] + this->OnTheWay[c] + this->Reflected[c] + this->Stranded[c]);
  }
  if (this->Order == 0)
  {
    this->LookAtDirect(this->Parts.Fluence, 1.0);
  }
  const double all = Sum(this->AllScattered);
  this->Result.convergence.Add(this->Residual, all > 0.0 ? Sum(this->Scattered) / all : 0.0, this->Result.ledger);
}

/// Computes the sources by octant from all light incident on voxels, including that beyond the faces of the block.
void SourceIteration::FindOctantSources()
{
  if (!this->AtFaces)
  {
    return;
  }
  this->TheDomain.Collective([&] { this->AtFaces->TakeIncoming(this->Parts.Usual); });
  const BeyondFaces beyond = this->Parts.Transport.FetchBeyond(this->AtFaces->CameInThroughFaces());
  this->TheDomain.Collective([&] { this->AtFaces->Find(this->Parts.Source, beyond); });
}

/// Converts path integrals to fluence and the next source.
/// @return powers summed over ranks, W
ScatteringOperator::Powers SourceIteration::ScatterSwept()
{
  const TransportParts& parts = this->Parts;
  ScatteringOperator::Powers powers;
  this->TheDomain.Collective([&] {
    if (this->TheDomain.IsEmpty())
    {
      return;
    }
    this->GatherMoments();
    powers = parts.Scattering->ScatterOrder(parts.WholeDeposit(), parts.Fluence, parts.Source, this->SweptValues());
    if (parts.StoresMoments())
    {
      // Before the first order, `shown` holds only light of lamps.
      AddToShown(parts.TheDevice, parts.Layout.Places(parts.Functions()).beams, parts.Source, this->Result.shown,
        this->Order == 0 ? -1.0f : 1.0f);
      if (this->Order == 0 && parts.Lights.Given)
      {
        parts.Lights.Given->AddStraightOn(parts.TheDevice, parts.Layout, parts.Basis, this->Result.shown);
      }
    }
  });
  return { this->TheDomain.Sum(powers.absorbed), this->TheDomain.Sum(powers.scattered) };
}

/// Estimates the power that the orders to come will add to the scattered light, relative to the sum so far. Uses the
/// largest of all channels.
void SourceIteration::EstimateResidual()
{
  this->Residual = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    const double now = GoesOnToItsEnd(
      this->Settings.maximumOrders, this->WasOnTheWay[c], this->OnTheWay[c], this->Scattered[c] + this->Reflected[c]);
    this->AllScattered[c] += now;
    if (now == 0.0)
    {
      continue;
    }
    this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
  }
}

/// Adds the scattering source of the first guess to the source of the next sweep.
void SourceIteration::BeginWarm()
{
  this->Warm.AddGuessTo(this->Parts.Source);
  this->Shining = this->Shining || Sum(this->Warm.GuessedPower()) != 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    this->Rest[c].BeginWarm(this->Warm.Rate(c));
  }
}

/// After the first sweep, subtracts the scattering source of the guess from the new source. The difference is the error
/// of the guess, which later sweeps transport. It can be negative, so its magnitude, not its power, measures the
/// distance from the limit of the iteration (numerics.md, Eqs. (46a) to (46c)).
void SourceIteration::GoOnWarm()
{
  const Rgb guessed = this->Order == 1 ? this->Warm.GuessedPower() : Rgb{};
  if (this->Order == 1)
  {
    this->Warm.TakeGuessFrom(this->Parts.Source);
  }
  const Rgb magnitudes = this->Warm.MagnitudeOf(this->Parts.Source);
  this->Shining = Sum(magnitudes) > 0.0;
  this->Residual = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    this->AllScattered[c] += this->Scattered[c];
    this->Scattered[c] -= guessed[c];
    const double reflected = this->Parts.Faces ? this->Parts.Faces->Magnitude()[c] : 0.0;
    const double now = GoesOnToItsEnd(this->Settings.maximumOrders, std::abs(this->WasOnTheWay[c]),
      std::abs(this->OnTheWay[c]), magnitudes[c] + reflected);
    if (now > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
    }
  }
}

/// Adds the angular moments of all orders scattered so far.
void SourceIteration::GatherMoments()
{
  if (this->Moments.Size() > 0 && this->Order > 0)
  {
    AddMoments(this->Parts.TheDevice, this->Parts.Layout, this->Parts.Functions(), this->Parts.Path, this->Moments);
  }
}

void SourceIteration::Leave()
{
  this->Result.warm = this->Warm.Begins();
  const Rgb rates = { this->Rest[0].Ratio(), this->Rest[1].Ratio(), this->Rest[2].Ratio() };
  std::vector<float> moments;
  this->TheDomain.Collective([&] { moments = this->Moments.Size() > 0 ? this->Moments.Read() : std::vector<float>(); });
  this->Result.kept = this->Warm.Leave(this->Direct, moments, rates);
}

bool SourceIteration::Done() const
{
  if (this->Residual == 0.0 || this->Order >= MostOrders)
  {
    return true;
  }
  const int least = this->Warm.Begins() ? 2 : 3; // after a guess the rate of decrease is known earlier
  return this->Settings.maximumOrders > 0 ? this->Order >= this->Settings.maximumOrders
                                          : this->Order >= least && MeetsTolerance(this->Settings, this->Residual);
}

/// Computes the light of all orders after the first in the voxels around the medium, and through the box faces: one
/// sweep of the source of all orders minus the unswept source of the last one (numerics.md, Eq. (44)).
void SourceIteration::SweepEmptySlabs(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  parts.Scattering->ScatterAllOrders(parts.Fluence, parts.Source);
  const SweepTally tally = this->Whole->Apply(&parts.Source, {}, monitor);
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Result.ledger.AssignFace(c, face, tally.out[face][c]);
    }
  }
  this->AddOutside(parts.Problem.Traits().filled);
}

/// Adds the path integrals of a sweep to the fluence of the voxels outside a box.
void SourceIteration::AddOutside(const VoxelBox& box)
{
  const TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  cl::Kernel add = parts.TheDevice.Kernel("add_outside", kernel_source::SourceIteration);
  const std::array<int, 3>& n = layout.grid.size;
  With(add, parts.Path, parts.Fluence, cl_ulong(layout.Stride()), static_cast<float>(1.0 / layout.grid.VoxelVolume()),
    cl_int3{ { n[0], n[1], n[2] } }, cl_int3{ { box.first[0], box.first[1], box.first[2] } },
    cl_int3{ { box.size[0], box.size[1], box.size[2] } });
  parts.TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
}

std::vector<std::string> SourceIteration::LeftOut() const
{
  std::vector<std::string> words = this->Warm.LeftOut();
  if (this->Filled)
  {
    words.push_back(left_out::EmptySlabs(this->Parts.Problem.Traits().filled, this->Parts.Layout.grid));
  }
  if (this->Settings.source == PropagationSource::Octants && !this->AtFaces)
  {
    words.emplace_back(OctantSources::AreThick(this->Parts.Problem) ? left_out::NotByOctant : left_out::ThinVoxels);
  }
  if (this->LitPart < 1.0)
  {
    words.push_back(left_out::DarkDirections(this->LitPart));
  }
  return words;
}
}
