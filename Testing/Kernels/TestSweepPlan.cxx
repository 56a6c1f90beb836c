// Which planes units cross in which launch: what goes both ways waits for the other once a launch.

#include "DeviceTest.h"

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepPlan.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
SweepPlan PlanOf(const Device& device, const std::array<int, 3>& size, int axis)
{
  const Grid grid = { size, { 1.0, 1.0, 1.0 } };
  const std::vector<Bundle> bundles = BundlesAlong(axis, grid, {}, FittedDirections(25), 1);
  SweepDescription sweep = { grid };
  sweep.channels = 3;
  return SweepPlan(device, sweep, { axis, bundles });
}
}

class SweepPlans : public DeviceTest
{
};

/// Sizes that need one launch and many, even and odd, of whole vectors and not.
TEST_F(SweepPlans, GiveBothWaysAsMuchToDoInEachLaunch)
{
  for (const int size : { 1, 2, 3, 5, 64, 129, 250, 333, 512 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      SCOPED_TRACE(std::to_string(size) + "^3, axis " + std::to_string(axis));
      const SweepPlan plan = PlanOf(GetDevice(), { size, size, size }, axis);
      const std::size_t units = plan.units.size();
      ASSERT_EQ(plan.schedule.size(), units * plan.launches);
      std::vector<int> crossed(units, 0);
      for (int launch = 0; launch < plan.launches; ++launch)
      {
        std::vector<int> taken(size, 0);
        for (std::size_t u = 0; u < units; ++u)
        {
          const cl_int2 range = plan.schedule[launch * units + u];
          if (range.s[1] > range.s[0])
          {
            EXPECT_EQ(range.s[0], crossed[u]) << "in turn";
          }
          crossed[u] += range.s[1] - range.s[0];
          for (int k = range.s[0]; k < range.s[1]; ++k)
          {
            taken[plan.units[u].backward ? size - 1 - k : k] += 1;
          }
        }
        EXPECT_LE(*std::max_element(taken.begin(), taken.end()), 1) << "units meet in launch " << launch;
        for (std::size_t u = 0; u + 1 < units; ++u)
        {
          const cl_int2 one = plan.schedule[launch * units + u], other = plan.schedule[launch * units + u + 1];
          if (plan.units[u].firstBundle == plan.units[u + 1].firstBundle)
          {
            const int more = (one.s[1] - one.s[0]) - (other.s[1] - other.s[0]);
            EXPECT_LE(std::abs(more), size % 2) << "but the plane in the middle; launch " << launch;
          }
        }
      }
      EXPECT_EQ(crossed, std::vector<int>(units, size));
    }
  }
}
