#include "LightPropagation/Problem/UncollidedDirections.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double More = 0.25; ///< time, of a solve along the usual directions
/// What a solve takes beside its sweeps, in orders along all usual directions: measured 0.8 in 100^3 voxels, 2 in 40^3.
constexpr double SetUp = 0.8;
/// An accelerated solve in such orders: one to set up three, and five sweeps with their corrections.
constexpr double AcceleratedOrders = 18.0;
constexpr double OrdersByCells = 12.0; ///< the same with cells: measured 9 in 128^3 voxels, 14 in 64^3
constexpr double LeastOrders = 3.0;    ///< that are swept however few are needed
constexpr int Choices[] = { 36, 49, 64, 100 };

/// Light comes in through some of the box's faces, and not the same through all.
bool FacesShineUnevenly(const Illumination& light, const std::array<bool, 3>& periodic)
{
  const Rgb* first = nullptr;
  bool differ = false;
  for (int face = 0; face < 6; ++face)
  {
    if (!periodic[face / 2])
    {
      first = first ? first : &light.faces[face];
      differ = differ || light.faces[face] != *first;
    }
  }
  return differ;
}

/// Of all directions those that light comes in along, by the eight octants of their signs.
double LitPart(const Illumination& light, const std::array<bool, 3>& periodic)
{
  if (Sum(light.sky) > 0.0 || !light.environment.Empty())
  {
    return 1.0;
  }
  int lit = 0;
  for (int octant = 0; octant < 8; ++octant)
  {
    bool any = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      any = any || (!periodic[axis] && Sum(light.faces[EntryFace(axis, (octant >> axis) % 2 == 0)]) > 0.0);
    }
    lit += any ? 1 : 0;
  }
  return lit / 8.0;
}

/// In orders along all usual directions: a solve's, but for its first sweep.
double TimeOfLaterOrders(const ShiningScene& scene, OrdersAdded how)
{
  const int most = scene.settings.maximumOrders;
  switch (how)
  {
    case OrdersAdded::ByBalance: return AcceleratedOrders - 1.0;
    case OrdersAdded::ByCells: return OrdersByCells - 1.0;
    case OrdersAdded::OneByOne: break;
  }
  const double orders = std::max(scene.ordersNeeded(), LeastOrders);
  return SetUp + (most > 0 ? std::min<double>(orders, most) : orders) - 1.0;
}
}

UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, OrdersAdded how)
{
  return UncollidedDirectionsFor({ problem.Settings(), problem.Shining(), problem.IsSlab(), problem.Traits().scatters,
                                   problem.Scattering().Degree(), [&] { return OrdersNeeded(problem); } },
    usual, how);
}

UncollidedDirections UncollidedDirectionsFor(const ShiningScene& scene, const DirectionSet& usual, OrdersAdded how)
{
  const bool oneByOne = how == OrdersAdded::OneByOne;
  const bool besideUsual = how == OrdersAdded::ByBalance; // else the finer directions take the place of the usual ones
  const PropagationSettings& settings = scene.settings;
  if (settings.uncollidedDirections >= 0)
  {
    return { settings.uncollidedDirections, settings.uncollidedDirections > 0 };
  }
  if (usual.orbits.empty() || scene.isSlab || !scene.scatters || Reflects(scene.shining) ||
    !FacesShineUnevenly(scene.shining, settings.periodic))
  {
    return {};
  }
  if (besideUsual && scene.degree > 0)
  {
    return {}; // all moments of four lights would be kept at once: hundreds of bytes a voxel
  }
  const double lit = LitPart(scene.shining, settings.periodic), before = settings.directionsPerFace;
  const double affordable = More * (TimeOfLaterOrders(scene, how) + lit) * before;
  UncollidedDirections found;
  for (int choice : Choices)
  {
    const double light = lit * (besideUsual ? choice + before : choice - before);
    const double evenSky = choice + before;
    if (choice > before && light + (oneByOne ? 0.0 : evenSky) <= affordable)
    {
      // Beside fewer finer directions more of them gain more; but with cells they gain nothing by themselves.
      const bool most = choice == Choices[std::size(Choices) - 1];
      found = { choice, !besideUsual && (most || !oneByOne) && light + evenSky <= affordable };
    }
  }
  return found;
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
