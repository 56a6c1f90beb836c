#include "LightPropagation/Conservative/LightSources.h"

#include "LightPropagation/Emission/UncollidedEmission.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double More = 0.5; ///< acceptable increase of the solve's time by finer directions, as a fraction
/// The same for discrete ordinates with anisotropic scattering, whose rays carry many angular moments.
constexpr double MoreInMoments = 0.1;
/// Time of a solve outside its sweeps, in units of the time of one scattering order along all directions of scattered
/// light; measured: 0.8 in 100^3 voxels, 2 in 40^3.
constexpr double SetUp = 0.8;
/// Time of a solve with DSA, in units of the time of one scattering order: set-up, and five sweeps with their
/// corrections.
constexpr double AcceleratedOrders = 18.0;
/// Time of a solve with coarse-mesh DSA, in units of the time of one scattering order; measured: 9 in 128^3 voxels, 14
/// in 64^3.
constexpr double OrdersByCells = 12.0;
constexpr double LeastOrders = 3.0; ///< smallest number of scattering orders that source iteration sweeps
constexpr double Lit = 0.5;         ///< fraction of all directions that carry light of one face
constexpr int Choices[] = { 36, 49, 64, 100 };

bool FacesShine(const Illumination& light)
{
  return std::any_of(light.faces.begin(), light.faces.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
}

/// Predicted time of a solve without its first sweep, in units of the time of one scattering order.
double TimeOfLaterOrders(const PropagationProblem& problem, IterationScheme how)
{
  const int most = problem.Settings().maximumOrders;
  switch (how)
  {
    case IterationScheme::Dsa: return AcceleratedOrders - 1.0;
    case IterationScheme::CoarseMeshDsa: return OrdersByCells - 1.0;
    case IterationScheme::SourceIteration: break;
  }
  const double orders = std::max(OrdersNeeded(problem), LeastOrders);
  return SetUp + (most > 0 ? std::min<double>(orders, most) : orders) - 1.0;
}

/// Adds the radiance of a boundary source, averaged over the six faces, to `mean`, W / (length^2 sr).
void AddMeanRadiance(const BoundaryLight* boundary, Rgb& mean)
{
  for (const Rgb& power : boundary ? boundary->IncomingPower() : std::array<Rgb, 6>())
  {
    for (std::size_t c = 0; c < mean.size(); ++c)
    {
      mean[c] += power[c] / (6.0 * Pi);
    }
  }
}

/// Boundary source that is transported along the finer directions, as an Illumination of which only the radiance of
/// faces and sky is used.
Illumination AlongFiner(const UncollidedDirections& finer, const Illumination& shining)
{
  Illumination part = finer.perFace > 0 ? shining : Illumination();
  part.sky = finer.ofFacesAlone ? Rgb{} : part.sky;
  return part;
}

/// Boundary source that is transported along the quadrature of scattered light: `shining` without the radiance that
/// AlongFiner() returns.
Illumination AlongUsual(const UncollidedDirections& finer, const Illumination& shining)
{
  Illumination part = shining;
  if (finer.perFace > 0)
  {
    part.faces = {};
    part.sky = finer.ofFacesAlone ? shining.sky : Rgb{};
  }
  return part;
}

/// Rays of the finer quadrature.
/// @param accelerated  whether the solve uses DSA: the finer directions are then swept in addition to those of
///   scattered light
std::unique_ptr<const SweptDirections> FinerDirections(
  const Grid& grid, const PropagationSettings& settings, int perFace, bool accelerated, const SweptDirections& usual)
{
  DirectionSet set = FittedDirections(perFace, "UncollidedDirections");
  const bool asAsked = accelerated || !set.orbits.empty();
  const RayStarts starts = asAsked || usual.Starts() == RayStarts::Pairs ? usual.Starts() : RayStarts::Staggered;
  return std::make_unique<SweptDirections>(grid, settings, std::move(set), starts);
}
}

UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how)
{
  // Whether boundary light is swept along finer directions in addition to those of scattered light; false: instead of
  // them.
  const bool besideUsual = how == IterationScheme::Dsa;
  const PropagationSettings& settings = problem.Settings();
  const Illumination& shining = problem.Shining();
  const bool scatters = problem.Traits().scatters, byOrdinates = !settings.alongRays;
  if (settings.uncollidedDirections >= 0 && !byOrdinates)
  {
    return { settings.uncollidedDirections, false,
      settings.uncollidedDirections > 0 && !besideUsual && scatters && !Reflects(shining) };
  }
  if (!FacesShine(shining) || Reflects(shining) || problem.IsSlab() || how == IterationScheme::CoarseMeshDsa ||
    (byOrdinates ? besideUsual : !scatters || usual.orbits.empty()))
  {
    return {};
  }
  if (besideUsual && problem.Scattering().Degree() > 0)
  {
    // No finer directions: four sets of moments of uncollided light would be stored at once, hundreds of bytes per
    // voxel.
    return {};
  }
  const double before = settings.directionsPerFace;
  const bool inMoments = byOrdinates && !problem.IsIsotropic();
  const double more = inMoments ? MoreInMoments : More;
  const double affordable = more * (TimeOfLaterOrders(problem, how) + Lit) * before;
  UncollidedDirections found;
  if (byOrdinates)
  {
    const int least = inMoments && settings.uncollidedDirections < 0 ? Choices[0] : settings.uncollidedDirections;
    found = { std::max(least, settings.directionsPerFace), true, false };
  }
  for (int choice : Choices)
  {
    const double light = Lit * (besideUsual ? choice + before : choice - before);
    const double evenSky = besideUsual ? choice + before : 0.0;
    if (settings.uncollidedDirections < 0 && choice > before && light + evenSky <= affordable)
    {
      found = { choice, true, false };
    }
  }
  return found;
}

LightSources::LightSources(const PropagationProblem& problem, bool byBalance, const VolumeLayout& layout,
  const SweptDirections& usual, const UncollidedDirections& finer)
  : Problem(problem)
  , ByBalance(byBalance)
  , Layout(layout)
  , Usual(usual)
  , Finer(finer)
  , CorrectsEscape(finer.correctsEscape)
{
  if (problem.HasGivenLight())
  {
    this->Given = std::make_unique<GivenLight>(problem.Shining().uncollided, problem.TheMedium(), problem.Scattering());
  }
  this->FindBoundaryLight();
}

std::vector<float> LightSources::EmissionOf(bool emptyVoxels) const
{
  const PropagationProblem& problem = this->Problem;
  const Field smooth = this->Emission.Smooth(problem.TheMedium());
  return Planar(this->Layout, this->Layout.channels, [&](std::size_t i, int c) {
    const bool apart = this->OfVacuum && VacuumEmission::IsEmpty(problem.Scattering().SigmaT(i, c), this->Layout.grid);
    return apart == emptyVoxels ? smooth.At(i, c) : 0.0f;
  });
}

void LightSources::FindEmission()
{
  Rgb comesIn = {};
  AddMeanRadiance(this->UsualBoundary.get(), comesIn);
  AddMeanRadiance(this->ByBalance ? nullptr : this->FineBoundary.get(), comesIn);
  this->Emission = SplitOfDomain(this->Problem, comesIn);
  const PropagationSettings& settings = this->Problem.Settings();
  const Grid& grid = this->Problem.Whole();
  if (!this->Problem.Traits().emits || !VacuumEmission::IsApart(grid, settings))
  {
    return;
  }
  bool any = false;
  this->Problem.TheDomain().Collective([&] {
    this->OfVacuum = VacuumEmission::DirectionsFor(grid, settings);
    const std::vector<float> emitted = this->EmissionOf(true);
    any = std::any_of(emitted.begin(), emitted.end(), [](float value) { return value > 0.0f; });
  });
  if (!this->Problem.TheDomain().Any(any))
  {
    this->OfVacuum.reset();
  }
}

/// Splits the environment into peaks, which become lamps, and a smooth part, which can be resolved by the quadrature
/// that transports it.
SplitEnvironment LightSources::SplitFar(const Environment& environment) const
{
  return Split(environment, (this->Fine && !this->Finer.ofFacesAlone ? *this->Fine : this->Usual).Set());
}

void LightSources::FindBoundaryLight()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Illumination& shining = this->Problem.Shining();
  const Grid& grid = this->Problem.Whole();
  if (this->Finer.perFace > 0)
  {
    this->Fine = FinerDirections(grid, settings, this->Finer.perFace, this->ByBalance, this->Usual);
  }
  const SplitEnvironment environment = this->SplitFar(shining.environment);
  this->Lamps = shining.lights;
  this->Lamps.insert(this->Lamps.end(), environment.peaks.begin(), environment.peaks.end());
  this->FarAway = environment.smooth;
  this->FindFineBoundary();
  const bool all = this->ByBalance || !this->FineBoundary;
  this->UsualBoundary = std::make_unique<BoundaryLight>(grid, settings, this->Usual,
    all ? shining : AlongUsual(this->Finer, shining), all || this->Finer.ofFacesAlone ? this->FarAway : Environment());
  if (settings.alongRays && this->SweepCarriesBoundarySource())
  {
    this->UsualBoundary->CheckRays(this->Layout.channels);
  }
}

/// Sets FineBoundary, the boundary source along the finer quadrature. If the medium emits, a uniform boundary source
/// stays with the quadrature of scattered light, so that the light in a furnace stays uniform. In DSA with reflecting
/// faces, all boundary light stays with that quadrature, because faces reflect only along the directions of sweeps.
void LightSources::FindFineBoundary()
{
  const PropagationSettings& settings = this->Problem.Settings();
  const Illumination& shining = this->Problem.Shining();
  if (!this->Fine)
  {
    return;
  }
  const Grid& grid = this->Problem.Whole();
  const bool ofAll = !this->Finer.ofFacesAlone;
  auto fine = std::make_unique<BoundaryLight>(
    grid, settings, *this->Fine, AlongFiner(this->Finer, shining), ofAll ? this->FarAway : Environment());
  const bool balances = this->ByBalance || !ofAll || this->Problem.Traits().emits || HasVeryFlatVoxels(grid);
  const bool isEven = balances && fine->Shines() && fine->IsEven();
  this->CorrectsEscape = this->CorrectsEscape && !isEven;
  if (!fine->Shines() || isEven || (this->ByBalance && Reflects(shining)))
  {
    return;
  }
  // Requested directions with too few rays are an error, which CheckRays() throws; automatically chosen directions with
  // too few rays are not used.
  if (ofAll)
  {
    fine->CheckRays(this->Layout.channels);
  }
  else if (!BoundaryLight::HasEnoughRays(grid, settings, *this->Fine))
  {
    return;
  }
  this->FineBoundary = std::move(fine);
}

BoundaryLight LightSources::FinePartAlongUsual() const
{
  return { this->Problem.Whole(), this->Problem.Settings(), this->Usual,
    AlongFiner(this->Finer, this->Problem.Shining()), this->Finer.ofFacesAlone ? Environment() : this->FarAway };
}

SweepBoundary LightSources::BoundaryOfSweeps() const
{
  if (this->SweepCarriesBoundarySource())
  {
    return this->UsualBoundary->Boundary();
  }
  return this->Problem.Settings().leaveOut ? SweepBoundary() : [](int, int) { return Rgb{}; };
}

std::vector<Light> LightSources::LampsOf(const Illumination& illumination) const
{
  const SplitEnvironment environment = this->SplitFar(illumination.environment);
  std::vector<Light> lamps = illumination.lights;
  lamps.insert(lamps.end(), environment.peaks.begin(), environment.peaks.end());
  return lamps;
}

LightSources::Sources LightSources::LampSources() const
{
  Sources sources;
  for (const Light& lamp : this->Lamps)
  {
    sources.push_back(std::make_unique<UncollidedLamp>(lamp));
  }
  return sources;
}

LightSources::Sources LightSources::PeakSources() const
{
  Sources sources;
  for (const EmissionPeak& peak : this->Emission.peaks)
  {
    sources.push_back(std::make_unique<UncollidedEmission>(peak, this->Problem.Settings().emissionError));
  }
  return sources;
}

LightSources::Sources LightSources::GivenSources() const
{
  Sources sources;
  if (this->Given)
  {
    sources.push_back(std::make_unique<GivenLight>(*this->Given));
  }
  return sources;
}

LightSources::Sources LightSources::VacuumSources() const
{
  Sources sources;
  if (this->OfVacuum)
  {
    sources.push_back(std::make_unique<VacuumEmission>(*this->OfVacuum, this->EmissionOf(true)));
  }
  return sources;
}

void LightSources::CountEmission(EnergyLedger& ledger) const
{
  const double volume = this->Layout.grid.VoxelVolume();
  Rgb emitted = {};
  for (int c = 0; c < this->Layout.channels && this->Problem.Traits().emits; ++c)
  {
    emitted[c] = SumOverVoxels(this->Layout.grid,
      [&](std::size_t i) { return 4.0 * Pi * this->Problem.TheMedium().emission.At(i, c) * volume; });
  }
  emitted = this->Problem.TheDomain().Sum(emitted);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    ledger.Emit(c, emitted[c]);
  }
}
}
