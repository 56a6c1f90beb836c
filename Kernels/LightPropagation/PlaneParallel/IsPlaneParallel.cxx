#include "LightPropagation/PlaneParallel/IsPlaneParallel.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr int MostLayers = 8192; ///< about 200 MB if all differ

/// Whether a field is constant within each layer perpendicular to an axis.
bool IsLayered(const Field& field, const Grid& grid, int axis)
{
  const std::size_t stride = grid.Strides()[axis], count = static_cast<std::size_t>(grid.size[axis]);
  const auto components = static_cast<std::size_t>(field.components);
  for (std::size_t i = 0; field.values && i < grid.VoxelCount(); ++i)
  {
    const float* const first = field.values + i / stride % count * stride * components;
    if (!std::equal(first, first + components, field.values + i * components))
    {
      return false;
    }
  }
  return true;
}

bool IsLayered(const Medium& medium, int axis)
{
  const Grid& grid = medium.grid;
  return IsLayered(medium.sigma_a, grid, axis) && IsLayered(medium.sigma_s, grid, axis) &&
    IsLayered(medium.emission, grid, axis) && IsLayered(medium.phase.G(), grid, axis);
}
}

int AxisOfLayers(const std::array<bool, 3>& periodic)
{
  int axis = -1, count = 0;
  for (int a = 0; a < 3; ++a)
  {
    axis = periodic[a] ? axis : a;
    count += periodic[a] ? 1 : 0;
  }
  return count == 2 ? axis : -1;
}

bool IsPlaneParallel(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  const int axis = AxisOfLayers(settings.periodic);
  const bool asked = settings.source == PropagationSource::Automatic &&
    settings.acceleration == PropagationAcceleration::Automatic && settings.adaptDirections && settings.leaveOut &&
    settings.maximumOrders == 0 && settings.angularDegree < 0 && !settings.firstMoments;
  const bool near = std::any_of(illumination.lights.begin(), illumination.lights.end(),
    [](const Light& light) { return light.type != LightType::Directional; });
  return axis >= 0 && medium.grid.size[axis] <= MostLayers && asked && !near && illumination.environment.Empty() &&
    !illumination.uncollided.IsThere() && IsLayered(medium, axis);
}
}
