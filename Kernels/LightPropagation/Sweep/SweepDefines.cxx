#include "LightPropagation/Sweep/SweepDefines.h"

#include "Device/Defines.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr int RowsTogether = 8; ///< of a plane with many moments: they stay in the cache for all bundles

std::string DefineMoments(const SweepPlan& plan)
{
  if (!plan.angular)
  {
    return Define("DEGREE", 0) + Define("BEAMS", 0);
  }
  const auto [evenEven, oddEven, evenOdd, oddOdd] = plan.order.counts;
  return Define("DEGREE", plan.angular->degree) + Define("BEAMS", plan.angular->Beams()) +
    Define("EVEN_EVEN", evenEven) + Define("ODD_EVEN", oddEven) + Define("EVEN_ODD", evenOdd) +
    Define("ODD_ODD", oddOdd) + Define("MOMENTS_IN_PLACE", plan.momentsInPlace) + Define("TILE", RowsTogether);
}
}

std::string DefinesOf(const SweepPlan& plan)
{
  std::string options = Define("REAL_WIDTH", plan.vector) + Define("CHANNELS", plan.channels) +
    Define("ROW", plan.row) + Define("CURRENTS", plan.partialCurrents) + Define("CHAIN_KEEPS", plan.rowsKept) +
    Define("OCTANT_SOURCE", plan.octantSource) + DefineMoments(plan);
  // With moments each number of members takes some 8 s to compile; without, all four take a third longer than one, and
  // are one program for every set of directions. Blocks have 2, and 1 and 2, by axis.
  const auto has = [&](int members) {
    const auto is = [&](const BundleInfo& bundle) { return bundle.members == members; };
    return std::any_of(plan.bundleRows.begin(), plan.bundleRows.end(), is);
  };
  for (int members = 1; members <= MaxMembers; members *= 2)
  {
    if (!plan.angular || has(members) || (members == 1 && has(2)))
    {
      options += Define(("MEMBERS_" + std::to_string(members)).c_str(), 1);
    }
  }
  return options;
}
}
