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
constexpr int FewPlanes = 256;        ///< round a periodic axis, where there will be more orders as long as it matters
constexpr double MostlyLit = 0.75;    ///< part of the rays from which on sweeps of their own do not pay
constexpr double MostlyFilled = 0.75; ///< the same of voxels
constexpr double FallByCells = 0.3;   ///< of what is left over from order to order, at least so much in the forecast
constexpr int OrdersExpected = 6;     ///< to tell whether it pays to sweep empty slabs at the end only
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
        this->TheDomain.Whole(), this->TheDomain.Own(), !parts.Lamps.empty() });
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
  this->Parts.CountEmission(this->Result.ledger);
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
  // Rounding, and what the last sweeps would have taken away, can leave dark voxels a little below 0; and what shines
  // out of thick voxels, behind them.
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
      ? faces.ScaledTo(faces.LeftInAll(), this->Result.ledger.FacePowerOut()) // cells change faces as a whole
      : faces.LeftInAll();
  }
  return std::move(this->Result);
}

/// Of what was scattered and just swept.
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
  // What waits for the next sweep is light that the cells know nothing of.
  const bool wholeWay = this->Settings.maximumOrders > 0 || this->Cells;
  const int mostPlanes = wholeWay ? MostPlanesAround : FewPlanes;
  SweepRequest request = { this->DepositOfSweep(), this->Parts.AllRays(), {}, mostPlanes };
  request.octantSource = this->AtFaces ? &this->AtFaces->Sources() : nullptr;
  request.angular = this->Parts.UsualValues();
  request.faceIn = this->Parts.LightByCells();
  this->Whole = this->Parts.MakeSweep(request);
  this->MakeFilledSweep();
  if (this->Settings.leaveOut && this->Parts.SweepCarriesBoundarySource() && !this->Shining)
  {
    this->MakeLitSweep();
  }
}

/// Orders after the first go through the box that the medium fills alone: what leaves it does not come back. Their
/// light in the other voxels is found at the end, for all of them in one sweep. Not with periodic axes, whose rays
/// would be on the way in both; nor where the light that leaves through the faces' cells is wanted, or voxels shine
/// otherwise through each face, of which the sweep at the end knows nothing.
void SourceIteration::MakeFilledSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const MediumTraits& traits = this->Parts.Problem.Traits();
  if (!this->Parts.SweepsParts() || !this->Settings.leaveOut || !traits.scatters ||
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
    // No flux: it comes from the sweep at the end.
    this->Filled =
      this->Parts.MakeSweep({ { &this->Parts.Path, nullptr, nullptr, nullptr }, this->Parts.AllRays(), traits.filled });
  }
}

/// Of the directions alone from which light comes. Those of a periodic axis stay as they are: rays wait in them for the
/// next order.
void SourceIteration::MakeLitSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (periodic[0] || periodic[1] || periodic[2])
  {
    return;
  }
  const auto isLit = [this](int direction) { return this->Parts.UsualBoundary->IsLit(direction); };
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
    this->Lit = this->Parts.MakeSweep(request);
  }
}

void SourceIteration::AddUncollided(const Monitor& monitor)
{
  TransportParts::Sources sources = this->Parts.LampSources();
  const auto append = [&sources](TransportParts::Sources more) {
    std::move(more.begin(), more.end(), std::back_inserter(sources));
  };
  append(this->Parts.OtherSources());
  const std::size_t alongRays = sources.size(); // each by itself; the others are swept
  if (this->Parts.FineBoundary)
  {
    sources.push_back(std::make_unique<UncollidedBoundary>(this->Settings, *this->Parts.FineBoundary));
  }
  append(this->Parts.VacuumSources());
  const bool escapes = this->Parts.Finer.correctsEscape;
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
    const bool isLamp = i < this->Parts.Lamps.size();
    if (this->AtFaces && isLamp) // never with moments to show
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
      const bool ofVacuum = this->Parts.OfVacuum && i + 1 == sources.size();
      this->TheDomain.Collective(
        [&] { this->AtFaces->TakeIncoming(ofVacuum ? *this->Parts.OfVacuum : *this->Parts.Fine); });
    }
    if (i + 1 == this->Parts.Lamps.size())
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
    // Whatever shines: lights add up.
    const TransportParts::EvenSky sky = this->Parts.FindEvenSky(OfPart(monitor, sources.size() / all, 1.0));
    this->TheDomain.Collective([&] {
      this->Escaping.emplace(this->Parts.TheDevice, this->Parts.Layout, this->Parts.Problem.Scattering(),
        this->Parts.OnDevice.SigmaT(), sky.fine.path, sky.usual.path);
    });
  }
}

/// What lamps' uncollided light, the only light so far, is first scattered.
void SourceIteration::ShowLamps()
{
  this->TheDomain.Collective([&] {
    if (this->Parts.StoresMoments() && !this->TheDomain.IsEmpty())
    {
      this->Parts.Scattering->AddFirstScattered(this->Parts.WholeDeposit(), this->Result.shown);
    }
  });
}

/// Beside it, where in thick voxels its light is first scattered.
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
  const SweepBoundary boundary = this->Order == 0 ? this->Parts.BoundaryOfSweeps() : SweepBoundary();
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
  for (int c = 0; c < 3; ++c) // through which of the box's faces is not known yet
  {
    for (const Rgb& face : tally.out)
    {
      this->Result.ledger.Escape(c, face[c]);
    }
  }
}

/// What faces give back of the light that left in this order has not left.
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

/// The values of a channel that a sweep may have changed: whole vectors.
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

/// As ScatterOrder, with what the cells say of all orders to come, which the next sweep is to have less.
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

/// @param scale  to W / length^2
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

/// Of all incident light, with that in the voxels beyond the block's faces.
void SourceIteration::FindOctantSources()
{
  if (!this->AtFaces)
  {
    return;
  }
  this->TheDomain.Collective([&] { this->AtFaces->TakeIncoming(this->Parts.Usual); });
  const BeyondFaces beyond = this->Parts.FetchBeyond(this->AtFaces->CameInThroughFaces());
  this->TheDomain.Collective([&] { this->AtFaces->Find(this->Parts.Source, beyond); });
}

/// From path integrals to fluence and the next source.
/// @return W of all ranks
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
      // What is shown holds lamps' light alone before the first order.
      AddToShown(parts.TheDevice, parts.Layout.Places(parts.Functions()).beams, parts.Source, this->Result.shown,
        this->Order == 0 ? -1.0f : 1.0f);
      if (this->Order == 0 && parts.Given)
      {
        parts.Given->AddStraightOn(parts.TheDevice, parts.Layout, parts.Basis, this->Result.shown);
      }
    }
  });
  return { this->TheDomain.Sum(powers.absorbed), this->TheDomain.Sum(powers.scattered) };
}

/// What the orders to come will add to the light that is scattered, over what there is. The worst channel counts.
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

/// Beside what is first scattered, the next sweep carries what is scattered of the guess.
void SourceIteration::BeginWarm()
{
  this->Warm.AddGuessTo(this->Parts.Source);
  this->Shining = this->Shining || Sum(this->Warm.GuessedPower()) != 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    this->Rest[c].BeginWarm(this->Warm.Rate(c));
  }
}

/// After the first sweep what is scattered of the guess is taken away from what was scattered: what is left is its
/// error, which the sweeps to come carry. It can be negative, so that its magnitude, not its power, tells how far the
/// light is from that of an endless iteration (numerics.md, Eqs. (46a) to (46c)).
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

/// Of the orders that were scattered before.
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
  const int least = this->Warm.Begins() ? 2 : 3; // a guess has shown already how fast orders fall
  return this->Settings.maximumOrders > 0 ? this->Order >= this->Settings.maximumOrders
                                          : this->Order >= least && MeetsTolerance(this->Settings, this->Residual);
}

/// Light of the orders after the first in the voxels around the medium, and the faces that it leaves through: one sweep
/// of all that was scattered but what the last order left over (numerics.md, Eq. (44)).
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

/// To fluence what a sweep left in the voxels outside a box.
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
