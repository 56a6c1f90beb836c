#include "LightPropagation/Problem/UncollidedDirections.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double More = 0.25; ///< additional time, relative to a solve with the usual directions
/// Time of a solve besides its sweeps, in units of a scattering order along all usual directions: measured 0.8 in 100^3
/// voxels, 2 in 40^3.
constexpr double SetUp = 0.8;
/// An accelerated solve in such orders: one to set up three, and five sweeps with their corrections.
constexpr double AcceleratedOrders = 18.0;
constexpr double OrdersByCells = 12.0; ///< time with coarse-mesh DSA: measured 9 in 128^3 voxels, 14 in 64^3
constexpr double LeastOrders = 3.0;    ///< orders that are always swept
constexpr double Lit = 0.5;            ///< fraction of all directions that carry light of one face
constexpr int Choices[] = { 36, 49, 64, 100 };

bool FacesShine(const Illumination& light)
{
  return std::any_of(light.faces.begin(), light.faces.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
}

/// Time of a solve except its first sweep, in orders along all usual directions.
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
}

UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how)
{
  const bool besideUsual = how == IterationScheme::Dsa; // otherwise finer directions replace the usual ones
  const PropagationSettings& settings = problem.Settings();
  const Illumination& shining = problem.Shining();
  const bool scatters = problem.Traits().scatters;
  if (settings.uncollidedDirections >= 0)
  {
    return { settings.uncollidedDirections, false,
      settings.uncollidedDirections > 0 && !besideUsual && scatters && !Reflects(shining) };
  }
  if (!FacesShine(shining) || Reflects(shining) || !scatters || problem.IsSlab() || usual.orbits.empty() ||
    how == IterationScheme::CoarseMeshDsa)
  {
    return {};
  }
  if (besideUsual && problem.Scattering().Degree() > 0)
  {
    return {}; // all moments of four lights would be stored at once: hundreds of bytes per voxel
  }
  const double before = settings.directionsPerFace;
  const double affordable = More * (TimeOfLaterOrders(problem, how) + Lit) * before;
  UncollidedDirections found;
  for (int choice : Choices)
  {
    const double light = Lit * (besideUsual ? choice + before : choice - before);
    const double evenSky = besideUsual ? choice + before : 0.0;
    if (choice > before && light + evenSky <= affordable)
    {
      found = { choice, true, false };
    }
  }
  return found;
}

Illumination AlongFiner(const UncollidedDirections& finer, const Illumination& shining)
{
  Illumination part = finer.perFace > 0 ? shining : Illumination();
  part.sky = finer.ofFacesAlone ? Rgb{} : part.sky;
  return part;
}

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

std::unique_ptr<const SweptDirections> FinerDirections(
  const Grid& grid, const PropagationSettings& settings, int perFace, bool accelerated)
{
  DirectionSet set = FittedDirections(perFace, "UncollidedDirections");
  const bool asAsked = accelerated || !set.orbits.empty();
  const RayStarts starts = settings.staggeredRays || !asAsked ? RayStarts::Staggered : RayStarts::Middle;
  return std::make_unique<SweptDirections>(grid, settings, std::move(set), starts);
}
}
