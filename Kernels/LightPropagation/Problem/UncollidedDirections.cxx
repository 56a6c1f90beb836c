#include "LightPropagation/Problem/UncollidedDirections.h"

#include "LightPropagation/Problem/ScatteringOrders.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <array>

namespace tyndall
{
namespace
{
constexpr double More = 0.25; ///< time, of a solve along the usual directions
/// Time of a sweep of uncollided light a direction, over that of scattered light: measured 3 to 4.
constexpr double Dearer = 4.0;
constexpr int Choices[] = { 49, 64, 100 };

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
}

int UncollidedDirectionsFor(const PropagationProblem& problem, bool accelerated)
{
  const PropagationSettings& settings = problem.Settings();
  if (settings.uncollidedDirections >= 0)
  {
    return settings.uncollidedDirections;
  }
  if (accelerated || problem.IsSlab() || !problem.Traits().scatters || Reflects(problem.Shining()) ||
    !FacesShineUnevenly(problem.Shining(), settings.periodic))
  {
    return 0;
  }
  const double orders = OrdersNeeded(problem);
  const double sweeps = settings.maximumOrders > 0 ? std::min<double>(orders, settings.maximumOrders) : orders;
  const double lit = LitPart(problem.Shining(), settings.periodic);
  int directions = 0;
  for (int choice : Choices)
  {
    const double more = Dearer * lit * choice;
    directions =
      choice > settings.directionsPerFace && more <= More * sweeps * settings.directionsPerFace ? choice : directions;
  }
  return directions;
}
}
