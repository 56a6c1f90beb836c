#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"

namespace tyndall
{
namespace
{
/// The members of a bundle that march one way along its axis with these signs of direction across it.
Bundle MembersThatGo(const Bundle& bundle, int way, int signU, int signV)
{
  Bundle part = bundle;
  part.members.clear();
  for (Member member : bundle.members)
  {
    int& other = way == 0 ? member.opposite : member.direction;
    const int direction = way == 0 ? member.direction : member.opposite;
    other = -1;
    if (direction >= 0 && member.uFromU + member.uFromV == signU && member.vFromU + member.vFromV == signV)
    {
      part.members.push_back(member);
    }
  }
  return part;
}

/// Divides a set of bundles into parts of at most mostRays rays, or of one bundle if that has more.
void AddParts(const ParallelBundles& whole, int mostRays, std::vector<ParallelBundles>& parts)
{
  ParallelBundles part = whole;
  part.bundles.clear();
  for (const Bundle& bundle : whole.bundles)
  {
    const int rays = part.Rays() + static_cast<int>(bundle.members.size());
    if (mostRays > 0 && rays > mostRays && !part.bundles.empty())
    {
      parts.push_back(part);
      part.bundles.clear();
      part.goThroughEdges = false;
    }
    part.bundles.push_back(bundle);
    part.goThroughEdges = part.goThroughEdges || bundle.MovesBothWaysAtOnce();
  }
  if (!part.bundles.empty())
  {
    parts.push_back(part);
  }
}
}

int ParallelBundles::Rays() const
{
  std::size_t rays = 0;
  for (const Bundle& bundle : this->bundles)
  {
    rays += bundle.members.size();
  }
  return static_cast<int>(rays);
}

std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays)
{
  std::vector<ParallelBundles> parts;
  for (const AxisBundles& along : rays)
  {
    const PlaneAxes axes = AcrossAxis(along.axis);
    for (int octant = 0; octant < 8; ++octant)
    {
      const auto sign = [octant](int bit) { return octant >> bit & 1 ? -1 : 1; };
      ParallelBundles part;
      part.axis = along.axis;
      part.way = octant >> 2;
      part.signs[axes.u] = sign(0);
      part.signs[axes.v] = sign(1);
      part.signs[axes.axis] = sign(2);
      for (const Bundle& bundle : along.bundles)
      {
        const Bundle going = MembersThatGo(bundle, part.way, sign(0), sign(1));
        if (!going.members.empty())
        {
          part.bundles.push_back(going);
        }
      }
      AddParts(part, mostRays, parts);
    }
  }
  return parts;
}
}
