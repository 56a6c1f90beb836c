#include "LightPropagation/Distributed/IterationInBlocks.h"

#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Distributed/Balance/GlobalStatistics.h"
#include "LightPropagation/Scattering/MomentScattering.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr int FewPlanes = 256;      ///< as SourceIteration has it
constexpr double FallByCells = 0.3; ///< of what is left over from order to order, at least so much in the forecast
}

IterationInBlocks::IterationInBlocks(BlockOnDevice& block, const IncidentLight& incident,
  UncollidedOverRanks& uncollided, const OrdersOverRanks& orders, const KeptLight* kept)
  : Block(block)
  , Incident(incident)
  , Uncollided(uncollided)
  , Orders(orders)
  , Kept(kept)
{
  if (block.StoresMoments())
  {
    this->Result.shown =
      Buffer<float>(block.TheDevice, block.Layout.MomentFloats(block.Functions()), "the light shown");
    this->Result.shown.Fill(0.0f);
  }
}

IterationResult IterationInBlocks::Run(const Monitor& monitor)
{
  this->Shining = this->Uncollided.LoadSource(this->Result.ledger);
  this->MakeWarm();
  this->MakeCells();
  this->MakeAtFaces();
  const std::unique_ptr<SweepOperator> sweep = this->MakeSweep();
  BeamsInSource beams = this->BeamsOfSource();
  do
  {
    const Monitor ofOrder = OfPart(
      monitor, [this](double done) { return ProgressOf(this->Block.Settings, this->Residual, this->Order + done); });
    const double uncollided = this->Order == 0 ? UncollidedPart : 0.0;
    if (this->Order == 0)
    {
      this->AddUncollided(OfPart(ofOrder, 0.0, uncollided));
    }
    const bool scatteredShines = this->Shining && this->Order > 0;
    this->SweepOrder(*sweep, beams, OfPart(ofOrder, uncollided, 1.0));
    if (this->Escaping && scatteredShines)
    {
      this->LetEscape();
    }
    this->Reflect();
    this->Scatter();
    if (this->Order == 0 && this->Warm->Begins() && !this->Cells)
    {
      this->BeginWarm();
    }
    ++this->Order;
  } while (!this->Done());
  this->Finish();
  return std::move(this->Result);
}

void IterationInBlocks::MakeWarm()
{
  BlockOnDevice& block = this->Block;
  this->Warm.emplace(SceneOf(block, this->Incident), this->Kept,
    this->Orders.how == IterationScheme::CoarseMeshDsa ? "diffusion on cells" : "source iteration");
  block.Comm.Collective([&] {
    if (this->Warm->Keeps() && block.Angular)
    {
      this->Moments = Buffer<float>(block.TheDevice, block.Layout.MomentFloats(block.Functions()), "the light to keep");
      this->Moments.Fill(0.0f);
    }
  });
}

void IterationInBlocks::MakeCells()
{
  if (this->Orders.how != IterationScheme::CoarseMeshDsa)
  {
    return;
  }
  this->Cells.emplace(this->Block, this->Orders.halvings);
  for (RestOfOrders& rest : this->Rest)
  {
    rest.BeginWarm(FallByCells);
  }
}

/// Where orders are added up one by one; words where they are not, too.
void IterationInBlocks::MakeAtFaces()
{
  BlockOnDevice& block = this->Block;
  if (!this->Cells && OctantSourcesMatter(block.Comm, block.Scene, block.Settings))
  {
    block.Comm.Collective([&] {
      this->AtFaces.emplace(OctantSources::Scene{ block.TheDevice, block.Settings, block.Layout, block.OnDevice,
        block.Partition.whole, block.Partition.blocks[block.Comm.Rank()], !this->Incident.Lamps().empty() });
    });
  }
  else if (block.Settings.source == PropagationSource::Octants)
  {
    const bool thick = OctantSources::AreThick(CountThickVoxels(block.Comm, block.Scene));
    this->NotByOctant = { thick ? left_out::NotByOctant : left_out::ThinVoxels };
  }
}

std::unique_ptr<SweepOperator> IterationInBlocks::MakeSweep()
{
  const SweptDirections& usual = this->Incident.Usual();
  const FaceLight* const faces = this->Block.Faces.get();
  SweepRequest request = { this->Block.WholeDeposit(),
    { { 0, usual.Along(0) }, { 1, usual.Along(1) }, { 2, usual.Along(2) } } };
  request.angular = this->Block.Angular ? &this->Block.Angular->Values() : nullptr;
  request.deposit.partialCurrents = this->AtFaces ? &this->AtFaces->Currents() : nullptr;
  request.octantSource = this->AtFaces ? &this->AtFaces->Sources() : nullptr;
  request.mostPlanes = this->Block.Settings.maximumOrders > 0 ? MostPlanesAround : FewPlanes;
  request.faceIn = faces && faces->Reflects() ? &faces->In() : nullptr;
  return this->Block.MakeSweep(request);
}

BeamsInSource IterationInBlocks::BeamsOfSource()
{
  BlockOnDevice& block = this->Block;
  const std::size_t count = block.Angular ? block.Angular->Beams() * block.Layout.Values() : 0;
  return { block.TheDevice, block.Source, block.Layout.Places(block.Functions()).beams, count };
}

void IterationInBlocks::AddUncollided(const Monitor& monitor)
{
  const bool corrects = this->Incident.CorrectsEscape();
  const auto sources = static_cast<double>(this->Uncollided.Count());
  const double part = corrects ? sources / (sources + 1.0) : 1.0; // of the time
  const SweepTally tally = this->Uncollided.AddAll(this->Block.StoresMoments() ? &this->Result.shown : nullptr,
    this->AtFaces ? &*this->AtFaces : nullptr, OfPart(monitor, 0.0, part));
  this->Block.Comm.Collective([&] {
    if (this->Block.Faces)
    {
      this->Block.Faces->TakeUncollided();
    }
  });
  this->Result.ledger.Count(tally);
  this->Stranded = tally.onTheWay;
  if (corrects)
  {
    this->FindEscaping(OfPart(monitor, part, 1.0));
  }
}

/// Whatever shines: lights add up.
void IterationInBlocks::FindEscaping(const Monitor& monitor)
{
  BlockOnDevice& block = this->Block;
  const UncollidedOverRanks::EvenSky sky = this->Uncollided.FindEvenSky(monitor);
  block.Comm.Collective([&] {
    this->Escaping.emplace(
      block.TheDevice, block.Layout, block.Scene.Scattering(), block.OnDevice.SigmaT(), sky.fine, sky.usual);
  });
}

void IterationInBlocks::SweepOrder(SweepOperator& sweep, BeamsInSource& beams, const Monitor& monitor)
{
  const bool lit = this->Order == 0 && this->Incident.SweepCarriesBoundarySource();
  const SweepBoundary boundary = lit ? this->Incident.UsualBoundary().Boundary() : SweepBoundary();
  const bool goesOn = Sum(this->OnTheWay) != 0.0 || Sum(this->Reflected) != 0.0; // of a guess they can be negative
  this->WasOnTheWay = std::exchange(this->OnTheWay, {});
  if (!this->Shining && !boundary && !goesOn)
  {
    return;
  }
  this->Block.Comm.Collective([&] {
    if (this->Order == 0)
    {
      beams.Hold();
    }
  });
  const SweepTally tally = sweep.Apply(this->Shining ? &this->Block.Source : nullptr, boundary, monitor);
  this->Result.ledger.Count(tally);
  this->OnTheWay = tally.onTheWay;
  beams.GoOn();
}

/// Of what was scattered and just swept.
void IterationInBlocks::LetEscape()
{
  BlockOnDevice& block = this->Block;
  Rgb own = {};
  block.Comm.Collective([&] { own = block.Has ? this->Escaping->Apply(block.Path, block.Source) : Rgb{}; });
  const std::vector<double> all = block.Comm.Sum({ own[0], own[1], own[2] });
  for (int c = 0; c < 3; ++c)
  {
    this->Escaped[c] += all[c];
    this->Result.ledger.Escape(c, all[c]);
  }
}

/// What faces give back of the light that left in this order has not left.
void IterationInBlocks::Reflect()
{
  this->Reflected = {};
  if (!this->Block.Faces)
  {
    return;
  }
  std::array<Rgb, 6> back = {};
  this->Block.Comm.Collective([&] { back = this->Block.Faces->Reflect(); });
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Reflected[c] += back[face][c];
      this->Result.ledger.Escape(c, face, -back[face][c]);
    }
  }
}

/// @param scale  to W / length^2
void IterationInBlocks::TakeDirect(const Buffer<float>& fluence, double scale)
{
  if (this->Order > 0)
  {
    return;
  }
  this->Block.Comm.Collective([&] {
    if (this->Block.Has)
    {
      this->Result.fluenceDirect = Interleaved(this->Block.Layout, fluence, scale);
    }
    if (this->Warm->Keeps())
    {
      this->Direct = fluence.Read();
      this->Direct.resize(this->Block.Fluence.Size());
      std::transform(this->Direct.begin(), this->Direct.end(), this->Direct.begin(),
        [scale](float value) { return static_cast<float>(scale * value); });
    }
  });
  if (this->Warm->Keeps())
  {
    this->Warm->Prepare(this->Direct);
  }
}

/// One order: from the light that was swept to the next source, with the powers of all ranks.
void IterationInBlocks::Scatter()
{
  if (this->Cells)
  {
    this->TakeDirect(this->Block.Path, 1.0 / this->Block.Layout.grid.VoxelVolume());
    this->ScatterByCells();
    return;
  }
  this->ShineByOctant();
  std::vector<double> powers = this->ScatterOwn();
  this->TakeDirect(this->Block.Fluence, 1.0);
  powers = this->Block.Comm.Sum(powers);
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.Absorb(c, powers[c]);
    this->Scattered[c] = powers[3 + c];
  }
  this->Shining = Sum(this->Scattered) > 0.0;
  if (this->Warm->Begins() && this->Order > 0)
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
  const double all = Sum(this->AllScattered);
  this->Result.convergence.Add(this->Residual, all > 0.0 ? Sum(this->Scattered) / all : 0.0, this->Result.ledger);
}

/// Of all light that came in, with what did so in the voxels beyond the block's faces.
void IterationInBlocks::ShineByOctant()
{
  if (!this->AtFaces)
  {
    return;
  }
  this->Block.Comm.Collective([&] { this->AtFaces->TakeIncoming(this->Incident.Usual()); });
  const BeyondFaces beyond = this->Block.Across.Fetch(this->AtFaces->CameInThroughFaces());
  this->Block.Comm.Collective([&] { this->AtFaces->Find(this->Block.Source, beyond); });
}

/// @return W of this rank, three that its voxels absorbed and three that they scattered
std::vector<double> IterationInBlocks::ScatterOwn()
{
  BlockOnDevice& block = this->Block;
  std::vector<double> powers(6, 0.0);
  block.Comm.Collective([&] {
    if (!block.Has)
    {
      return;
    }
    if (this->Moments.Size() > 0 && this->Order > 0) // of orders that were scattered before
    {
      AddMoments(block.TheDevice, block.Layout, block.Functions(), block.Path, this->Moments);
    }
    const ScatteringOperator::Powers own =
      block.Scattering->ScatterOrder(block.WholeDeposit(), block.Fluence, block.Source, { 0, block.Layout.Stride() });
    std::copy(own.absorbed.begin(), own.absorbed.end(), powers.begin());
    std::copy(own.scattered.begin(), own.scattered.end(), powers.begin() + 3);
    if (block.StoresMoments())
    {
      // What is shown holds lamps' light alone before the first order.
      const std::size_t values = block.Layout.Places(block.Functions()).beams;
      AddToShown(block.TheDevice, values, block.Source, this->Result.shown, this->Order == 0 ? -1.0f : 1.0f);
      if (this->Order == 0)
      {
        this->Uncollided.AddStraightOn(this->Result.shown);
      }
    }
  });
  return powers;
}

/// As SourceIteration does.
void IterationInBlocks::ScatterByCells()
{
  const bool guessed = this->Order == 0 && this->Warm->Begins();
  const OrdersByCellsInBlocks::Powers powers =
    this->Cells->ScatterOrder(this->Result.ledger, guessed ? &this->Warm->Guess() : nullptr);
  this->Scattered = powers.scattered;
  this->Shining =
    std::any_of(powers.magnitude.begin(), powers.magnitude.end(), [](double power) { return power > 0.0; });
  this->Residual = 0.0;
  for (int c = 0; c < this->Block.Layout.channels; ++c)
  {
    this->AllScattered[c] += powers.scattered[c];
    if (powers.magnitude[c] > 0.0 && this->AllScattered[c] > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(powers.magnitude[c], this->AllScattered[c]));
    }
  }
  const double all = Sum(this->AllScattered);
  this->Result.convergence.Add(
    this->Residual, all > 0.0 ? std::abs(Sum(this->Scattered)) / all : 0.0, this->Cells->WithOut(this->Result.ledger));
}

/// As SourceIteration does.
void IterationInBlocks::EstimateResidual()
{
  this->Residual = 0.0;
  for (int c = 0; c < this->Block.Layout.channels; ++c)
  {
    const double now = GoesOnToItsEnd(this->Block.Settings.maximumOrders, this->WasOnTheWay[c], this->OnTheWay[c],
      this->Scattered[c] + this->Reflected[c]);
    this->AllScattered[c] += now;
    if (now > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
    }
  }
}

/// As SourceIteration does: beside what is first scattered, the next sweep carries what is scattered of the guess.
void IterationInBlocks::BeginWarm()
{
  this->Warm->AddGuessTo(this->Block.Source);
  this->Shining = this->Shining || Sum(this->Warm->GuessedPower()) != 0.0;
  for (int c = 0; c < this->Block.Layout.channels; ++c)
  {
    this->Rest[c].BeginWarm(this->Warm->Rate(c));
  }
}

/// As SourceIteration does: from the first sweep on it is the error of the guess that goes on.
void IterationInBlocks::GoOnWarm()
{
  const Rgb guessed = this->Order == 1 ? this->Warm->GuessedPower() : Rgb{};
  if (this->Order == 1)
  {
    this->Warm->TakeGuessFrom(this->Block.Source);
  }
  const Rgb magnitudes = this->Warm->MagnitudeOf(this->Block.Source);
  const FaceLight* const faces = this->Block.Faces.get(); // the same on all ranks
  this->Shining = Sum(magnitudes) > 0.0;
  this->Residual = 0.0;
  for (int c = 0; c < this->Block.Layout.channels; ++c)
  {
    this->AllScattered[c] += this->Scattered[c];
    this->Scattered[c] -= guessed[c];
    const double now = GoesOnToItsEnd(this->Block.Settings.maximumOrders, std::abs(this->WasOnTheWay[c]),
      std::abs(this->OnTheWay[c]), magnitudes[c] + (faces ? faces->Magnitude()[c] : 0.0));
    if (now > 0.0)
    {
      this->Residual = std::max(this->Residual, this->Rest[c].After(now, this->AllScattered[c]));
    }
  }
}

void IterationInBlocks::Leave()
{
  std::vector<float> moments;
  if (this->AtFaces || this->Warm->Begins() || this->Cells) // the same condition as in SourceIteration
  {
    const Halo around(this->Block.Comm, this->Block.Partition, this->Block.Settings.periodic, 1);
    CutOffNegative(this->Block.Comm, around, this->Block.Layout, this->Block.Scene.medium.sigma_a, this->Block.Fluence);
  }
  this->Block.Comm.Collective(
    [&] { moments = this->Moments.Size() > 0 ? this->Moments.Read() : std::vector<float>(); });
  this->Result.leftOut = this->Warm->LeftOut();
  this->Result.leftOut.insert(this->Result.leftOut.end(), this->NotByOctant.begin(), this->NotByOctant.end());
  this->Result.warm = this->Warm->Begins();
  if (this->Warm->Keeps())
  {
    this->Result.kept =
      this->Warm->Leave(this->Direct, moments, { this->Rest[0].Ratio(), this->Rest[1].Ratio(), this->Rest[2].Ratio() });
  }
}

bool IterationInBlocks::Done() const
{
  if (this->Residual == 0.0 || this->Order >= MostOrders)
  {
    return true;
  }
  const PropagationSettings& settings = this->Block.Settings;
  const int least = this->Warm->Begins() ? 2 : 3; // a guess has shown already how fast orders fall
  return settings.maximumOrders > 0 ? this->Order >= settings.maximumOrders
                                    : this->Order >= least && MeetsTolerance(settings, this->Residual);
}

/// Powers that are known at the end alone.
void IterationInBlocks::Finish()
{
  this->Leave();
  this->Result.ledger.ShareEscaped(this->Escaped);
  if (this->Cells)
  {
    this->Result.ledger = this->Cells->WithOut(this->Result.ledger);
  }
  if (const FaceLight* const faces = this->Block.Faces.get())
  {
    this->Result.leftByCell = this->Cells
      ? faces->ScaledTo(faces->LeftInAll(), this->Result.ledger.FacePowerOut()) // cells change faces as a whole
      : faces->LeftInAll();
  }
}
}
