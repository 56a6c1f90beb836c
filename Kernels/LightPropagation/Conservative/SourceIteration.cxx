#include "LightPropagation/Conservative/SourceIteration.h"

#include "Device/Sizes.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "TyndallKernelSources.h"

#include <cmath>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000, MostOfOrdinates = 10000;
/// with coarse-mesh DSA: smallest ratio of successive orders assumed in the estimate of the orders not yet computed
constexpr double FallByCells = 0.3;
}

SourceIteration::SourceIteration(TransportParts& parts, const KeptLight* kept)
  : Parts(parts)
  , TheDomain(parts.TheDomain())
  , Settings(parts.Problem.Settings())
  , Warm(parts, kept, parts.How == IterationScheme::CoarseMeshDsa ? "diffusion on cells" : "source iteration")
  , Shining(parts.HasSource())
{
  this->TheDomain.Collective([&] {
    if (this->Warm.Keeps() && parts.Basis)
    {
      this->Moments = Buffer<float>(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light to keep");
      this->Moments.Fill(0.0f);
    }
    if (parts.ByOctant)
    {
      this->AtFaces.emplace(OctantSources::Scene{ parts.TheDevice, this->Settings, parts.Layout, parts.OnDevice,
        this->TheDomain.Whole(), this->TheDomain.Own(), !parts.Lights.Lamps.empty() || parts.Lights.Given });
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
    for (RestOfOrders& rest : this->ToCome.rest)
    {
      rest.BeginWarm(FallByCells);
    }
  }
  this->Sweeps.emplace(parts, this->DepositOfSweep(), this->AtFaces ? &this->AtFaces->Sources() : nullptr,
    this->Cells.has_value(), this->Shining);
}

IterationResult SourceIteration::Run(const Monitor& monitor)
{
  this->Parts.Lights.CountEmission(this->Result.ledger);
  do
  {
    const Monitor ofOrder = OfPart(
      monitor, [this](double done) { return ProgressOf(this->Settings, this->ToCome.residual, this->Order + done); });
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
    this->Sweeps->EndFirstOrder();
  } while (!this->Done());
  if (this->Order > 1)
  {
    this->Sweeps->SweepEmptySlabs(this->Result.ledger, monitor);
  }
  if (this->Cells)
  {
    this->Result.ledger = this->Cells->WithOut(this->Result.ledger);
    this->Result.ledger.SettleOvercount(this->Settings.tolerance);
  }
  this->LimitLight();
  this->Result.ledger.ShareEscaped(this->Escaped);
  this->Result.leftOut = this->LeftOut();
  if (this->Warm.Keeps())
  {
    this->Leave();
  }
  if (this->Parts.Faces)
  {
    const FaceLight& faces = *this->Parts.Faces;
    // With coarse-mesh DSA the ledger has the escaped power of each face, which differs from the sum over its cells.
    this->Result.leftByCell =
      this->Cells ? faces.ScaledTo(faces.LeftInAll(), this->Result.ledger.FacePowerOut()) : faces.LeftInAll();
  }
  return std::move(this->Result);
}

/// Raises slightly negative scattered fluence. Negative values occur behind voxels with sources by octant; in dark
/// voxels after a warm start or coarse-mesh DSA, if the iteration stops before sweeps have removed the error of the
/// predicted light; and where sources by angular moments are negative in some directions. Also limits the net flux of
/// thick voxels.
void SourceIteration::LimitLight()
{
  TransportParts& parts = this->Parts;
  if (!this->AtFaces && !this->Warm.Begins() && !this->Cells && parts.Problem.Scattering().Degree() == 0)
  {
    return;
  }
  Communicator& comm = this->TheDomain.Comm();
  CutOffNegative(comm, Halo(comm, this->TheDomain.Partition(), this->Settings.periodic, 1), parts.Layout,
    parts.Problem.TheMedium().sigma_a, this->Result.fluenceDirect, parts.Fluence);
  this->TheDomain.Collective([&] {
    if (this->AtFaces && this->Settings.netFlux)
    {
      LimitFlux(parts.Layout, parts.Fluence.Read(), parts.Flux);
    }
  });
}

/// Applies the escape correction (EscapeCorrection.h) to the path integrals of the last sweep.
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

/// Adds all uncollided light that the first sweep does not carry. Lamps are added first, because their first-scattered
/// light is stored separately (ShowLamps).
void SourceIteration::AddUncollided(const Monitor& monitor)
{
  const LightSources& lights = this->Parts.Lights;
  const LightSources::Sources lamps = lights.LampSources(), given = lights.GivenSources(),
                              traced = lights.PeakSources(), vacuum = lights.VacuumSources();
  const double all = static_cast<double>(lamps.size() + given.size() + traced.size() + vacuum.size()) +
    (lights.FineBoundary ? 1.0 : 0.0) + (lights.CorrectsEscape ? 1.0 : 0.0);
  double done = 0.0;
  const auto next = [&] {
    done += 1.0;
    return OfPart(monitor, (done - 1.0) / all, done / all);
  };
  SweepTally tally;
  Buffer<float> firstMoments;
  this->TheDomain.Collective([&] {
    firstMoments = Buffer<float>(
      this->Parts.TheDevice, this->Settings.firstMoments ? this->Parts.Layout.Floats(6) : 1, "where light is lost");
    firstMoments.Fill(0.0f);
  });
  for (const std::unique_ptr<UncollidedSource>& lamp : lamps)
  {
    Add(tally, this->AddLamp(*lamp, firstMoments, next()));
  }
  if (!lamps.empty())
  {
    this->ShowLamps();
  }
  for (const std::unique_ptr<UncollidedSource>& source : given)
  {
    Add(tally, this->AddLamp(*source, firstMoments, next()));
  }
  for (const std::unique_ptr<UncollidedSource>& source : traced)
  {
    Add(tally, this->Parts.AddUncollided(*source, this->Parts.WholeDeposit(), next()));
  }
  if (lights.FineBoundary)
  {
    Add(tally, this->AddSwept(UncollidedBoundary(this->Settings, *lights.FineBoundary), *lights.Fine, next()));
  }
  for (const std::unique_ptr<UncollidedSource>& source : vacuum)
  {
    Add(tally, this->AddSwept(*source, *lights.OfVacuum, next()));
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
  this->ToCome.stranded = tally.onTheWay;
  if (lights.CorrectsEscape)
  {
    this->PrepareEscape(next());
  }
}

/// Makes the escape correction. It is applied for every kind of light source, so that the light of several sources is
/// the sum of their separate solutions.
void SourceIteration::PrepareEscape(const Monitor& monitor)
{
  const TransportParts::EvenSky sky = this->Parts.FindEvenSky(monitor);
  this->TheDomain.Collective([&] {
    this->Escaping.emplace(this->Parts.TheDevice, this->Parts.Layout, this->Parts.Problem.Scattering(),
      this->Parts.OnDevice.SigmaT(), sky.fine.path, sky.usual.path);
  });
}

/// Adds the first-scattered light of lamps to Result.shown, before any other light is deposited.
void SourceIteration::ShowLamps()
{
  this->TheDomain.Collective([&] {
    if (this->Parts.StoresMoments() && !this->TheDomain.IsEmpty())
    {
      this->Parts.Scattering->AddFirstScattered(this->Parts.WholeDeposit(), this->Result.shown);
    }
  });
}

/// Adds the uncollided light of a lamp, or light given by another solver. If there are sources by octant, path
/// integrals and first moments of this light are stored in arrays of OctantSources. Sources by octant are not used
/// together with angular moments.
SweepTally SourceIteration::AddLamp(
  const UncollidedSource& lamp, const Buffer<float>& firstMoments, const Monitor& monitor)
{
  Deposit deposit = this->Parts.WholeDeposit();
  if (!this->AtFaces)
  {
    deposit.firstMoments = this->Settings.firstMoments ? &firstMoments : nullptr;
    return this->Parts.AddUncollided(lamp, deposit, monitor);
  }
  deposit.path = &this->AtFaces->LampPath();
  deposit.firstMoments = &this->AtFaces->LampMoments();
  const SweepTally tally = this->Parts.AddUncollided(lamp, deposit, monitor);
  this->TheDomain.Collective([&] { this->AtFaces->TakeLamp(this->Parts.Path); });
  return tally;
}

/// Adds uncollided light that is swept along a separate quadrature.
/// @param along  rays of that quadrature
SweepTally SourceIteration::AddSwept(
  const UncollidedSource& source, const SweptDirections& along, const Monitor& monitor)
{
  const SweepTally tally = this->Parts.AddUncollided(source, this->DepositOfSweep(), monitor);
  if (this->AtFaces)
  {
    this->TheDomain.Collective([&] { this->AtFaces->TakeIncoming(along); });
  }
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
  const bool nothing =
    !boundary && !this->Shining && Sum(this->ToCome.onTheWay) == 0.0 && Sum(this->ToCome.reflected) == 0.0;
  this->ToCome.wasOnTheWay = std::exchange(this->ToCome.onTheWay, {});
  if (nothing)
  {
    return;
  }
  const Buffer<float>* const source = this->Shining ? &this->Parts.Source : nullptr;
  SweepOperator& sweep = this->Sweeps->Of(this->Order);
  BeamsInSource beams = this->Parts.BeamsOfSource();
  this->TheDomain.Collective([&] {
    if (this->Order == 0)
    {
      beams.Hold();
    }
  });
  const SweepTally tally = sweep.Apply(source, boundary, monitor);
  beams.GoOn();
  this->ToCome.onTheWay = tally.onTheWay;
  if (!this->Sweeps->OmitsEmptySlabs(this->Order))
  {
    this->Result.ledger.Count(tally);
    return;
  }
  for (int c = 0; c < 3; ++c) // through which faces this power escaped is known only after OrderSweeps::SweepEmptySlabs
  {
    for (const Rgb& face : tally.out)
    {
      this->Result.ledger.Escape(c, face[c]);
    }
  }
}

/// Reflects the outgoing light of this order, and subtracts the reflected power from the escaped power.
void SourceIteration::ReflectOrder()
{
  this->ToCome.reflected = {};
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
      this->ToCome.reflected[c] += back[face][c];
      this->Result.ledger.Escape(c, face, -back[face][c]);
    }
  }
}

/// ScatterOrder() with coarse-mesh DSA: also adds the predicted sum of all later orders to the fluence, and subtracts
/// it from the next source.
void SourceIteration::ScatterByCells()
{
  const TransportParts& parts = this->Parts;
  if (this->Order == 0)
  {
    this->LookAtDirect(parts.Path, 1.0 / parts.Layout.grid.VoxelVolume());
  }
  const bool guessed = this->Order == 0 && this->Warm.Begins();
  Rgb foreseen = this->ToCome.onTheWay;
  std::transform(foreseen.begin(), foreseen.end(), this->ToCome.stranded.begin(), foreseen.begin(), std::plus<>());
  const OrdersByCells::Powers powers =
    this->Cells->ScatterOrder(this->Result.ledger, foreseen, guessed ? &this->Warm.Guess() : nullptr);
  this->ToCome.scattered = powers.scattered;
  this->Shining = Sum(powers.magnitude) > 0.0;
  this->ToCome.residual = 0.0;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    this->Result.ledger.SetUnaccounted(c, powers.left[c] + this->ToCome.onTheWay[c] + this->ToCome.stranded[c]);
    this->ToCome.allScattered[c] += powers.scattered[c];
    const double before = std::abs(this->ToCome.wasOnTheWay[c]), onTheWay = std::abs(this->ToCome.onTheWay[c]);
    this->ToCome.Expect(c,
      this->Cells->ForeseeWay() ? GoesOnAsForeseen(before, onTheWay, powers.magnitude[c])
                                : GoesOnToItsEnd(this->Settings.maximumOrders, before, onTheWay, powers.magnitude[c]));
  }
  const double all = Sum(this->ToCome.allScattered);
  this->Result.convergence.Add(this->ToCome.residual, all > 0.0 ? std::abs(Sum(this->ToCome.scattered)) / all : 0.0,
    this->Cells->WithOut(this->Result.ledger));
}

/// Stores the uncollided fluence in Result.fluenceDirect and, if light is kept for the next solve, in Direct.
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
  this->ToCome.scattered = powers.scattered;
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.Absorb(c, powers.absorbed[c]);
  }
  this->Shining = Sum(this->ToCome.scattered) > 0.0;
  if (this->Warm.Begins() && this->Order > 0)
  {
    this->GoOnWarm();
  }
  else
  {
    this->ToCome.residual = 0.0;
    for (int c = 0; c < this->Parts.Layout.channels; ++c)
    {
      const double now = GoesOnToItsEnd(this->Settings.maximumOrders, this->ToCome.wasOnTheWay[c],
        this->ToCome.onTheWay[c], this->ToCome.scattered[c] + this->ToCome.reflected[c]);
      this->ToCome.allScattered[c] += now;
      this->ToCome.Expect(c, now, this->ToCome.reflected[c]);
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.SetUnaccounted(
      c, this->ToCome.scattered[c] + this->ToCome.onTheWay[c] + this->ToCome.reflected[c] + this->ToCome.stranded[c]);
  }
  if (this->Order == 0)
  {
    this->LookAtDirect(this->Parts.Fluence, 1.0);
  }
  const double all = Sum(this->ToCome.allScattered);
  this->Result.convergence.Add(
    this->ToCome.residual, all > 0.0 ? Sum(this->ToCome.scattered) / all : 0.0, this->Result.ledger);
}

/// Computes the sources by octant from the light incident on each voxel of the block through its faces, including light
/// from neighbouring blocks.
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

/// Adds the path integrals of the last sweep to the fluence, and computes the next source from them.
/// @return absorbed and scattered power, summed over ranks, W
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
    powers = parts.Scattering->ScatterOrder(
      parts.WholeDeposit(), parts.Fluence, parts.Source, this->Sweeps->Values(this->Order));
    if (parts.StoresMoments())
    {
      // In the first order `shown` holds the first-scattered light of lamps, and becomes the source minus that light;
      // in later orders the source is added to it.
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

/// Warm start: adds the scattering source of the initial guess (the scattered light of the previous solve) to the
/// source of the next sweep.
void SourceIteration::BeginWarm()
{
  this->Warm.AddGuessTo(this->Parts.Source);
  this->Shining = this->Shining || Sum(this->Warm.GuessedPower()) != 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    this->ToCome.rest[c].BeginWarm(this->Warm.Rate(c));
  }
}

/// Warm start: subtracts the scattering source of the initial guess from the new source, after the first sweep that
/// carried it. The difference is the error of the guess, which later sweeps transport. It can be negative, so its
/// magnitude, not its power, enters the residual (numerics.md, Eqs. (46a) to (46c)).
void SourceIteration::GoOnWarm()
{
  const Rgb guessed = this->Order == 1 ? this->Warm.GuessedPower() : Rgb{};
  if (this->Order == 1)
  {
    this->Warm.TakeGuessFrom(this->Parts.Source);
  }
  Rgb magnitudes = this->Warm.MagnitudeOf(this->Parts.Source, this->Parts.Functions());
  if (this->AtFaces)
  {
    constexpr int Octants = 8;
    const Rgb byOctant = this->Warm.MagnitudeOf(this->AtFaces->Sources(), 1, Octants);
    std::transform(magnitudes.begin(), magnitudes.end(), byOctant.begin(), magnitudes.begin(), std::plus<>());
  }
  this->Shining = Sum(magnitudes) > 0.0;
  this->ToCome.residual = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    this->ToCome.allScattered[c] += this->ToCome.scattered[c];
    this->ToCome.scattered[c] -= guessed[c];
    const double reflected = this->Parts.Faces ? this->Parts.Faces->Magnitude()[c] : 0.0;
    this->ToCome.Expect(c,
      GoesOnToItsEnd(this->Settings.maximumOrders, std::abs(this->ToCome.wasOnTheWay[c]),
        std::abs(this->ToCome.onTheWay[c]), magnitudes[c] + reflected),
      reflected);
  }
}

/// Adds the angular moments of the last sweep to Moments, the sum over all orders.
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
  const Rgb rates = { this->ToCome.rest[0].Ratio(), this->ToCome.rest[1].Ratio(), this->ToCome.rest[2].Ratio() };
  std::vector<float> moments;
  this->TheDomain.Collective([&] { moments = this->Moments.Size() > 0 ? this->Moments.Read() : std::vector<float>(); });
  this->Result.kept = this->Warm.Leave(this->Direct, moments, rates);
}

bool SourceIteration::Done() const
{
  if (this->ToCome.residual == 0.0 || this->Order >= (this->Settings.alongRays ? MostOrders : MostOfOrdinates))
  {
    return true;
  }
  // Least number of sweeps: the sum of the later orders is estimated from the ratio of successive orders, which is
  // known after three; a warm start uses the ratio that the previous solve found.
  const int least = this->Warm.Begins() ? 2 : 3;
  return this->Settings.maximumOrders > 0
    ? this->Order >= this->Settings.maximumOrders
    : this->Order >= least && MeetsTolerance(this->Settings, this->ToCome.residual);
}

std::vector<std::string> SourceIteration::LeftOut() const
{
  std::vector<std::string> words = this->Warm.LeftOut();
  if (this->Settings.source == PropagationSource::Octants && !this->AtFaces)
  {
    words.emplace_back(OctantSources::AreThick(this->Parts.Problem) ? left_out::NotByOctant : left_out::ThinVoxels);
  }
  for (const std::string& line : this->Sweeps->LeftOut())
  {
    words.push_back(line);
  }
  return words;
}
}
