#include "DiscreteOrdinates/OrdinateGroups.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
OrdinateGroups::OrdinateGroups(std::vector<Direction> directions)
  : Directions(std::move(directions))
{
  std::array<std::vector<int>, 8> octants;
  std::vector<int> along; // directions with a zero component, which may join any adjacent octant
  for (std::size_t d = 0; d < this->Directions.size(); ++d)
  {
    const std::array<double, 3>& omega = this->Directions[d].omega;
    const bool inside = omega[0] != 0.0 && omega[1] != 0.0 && omega[2] != 0.0;
    const int octant = (omega[0] > 0.0) + 2 * (omega[1] > 0.0) + 4 * (omega[2] > 0.0);
    (inside ? octants[octant] : along).push_back(static_cast<int>(d));
  }
  for (const int d : along) // each such direction joins the octant whose last group of eight has the most free places
  {
    const auto fits = [&](int octant) {
      bool same = true;
      for (int a = 0; a < 3; ++a)
      {
        const double along = this->Directions[d].omega[a];
        same = same && (along == 0.0 || (along > 0.0) == ((octant >> a & 1) != 0));
      }
      return same;
    };
    int best = -1, room = -1;
    for (int octant = 0; octant < 8; ++octant)
    {
      const int free = static_cast<int>((OrdinateLanes - octants[octant].size() % OrdinateLanes) % OrdinateLanes);
      if (fits(octant) && free > room)
      {
        best = octant;
        room = free;
      }
    }
    octants[best].push_back(d);
  }
  for (int octant = 0; octant < 8; ++octant)
  {
    for (std::size_t first = 0; first < octants[octant].size(); first += OrdinateLanes)
    {
      OrdinateGroup group;
      group.up = { (octant & 1) != 0, (octant & 2) != 0, (octant & 4) != 0 };
      group.count = static_cast<int>(std::min<std::size_t>(OrdinateLanes, octants[octant].size() - first));
      for (int lane = 0; lane < OrdinateLanes; ++lane)
      {
        group.direction[lane] = octants[octant][first + std::min(lane, group.count - 1)];
      }
      this->Groups.push_back(group);
    }
  }
}

std::vector<float> OrdinateGroups::Table(
  int parts, const std::function<double(int group, int part, int lane)>& value) const
{
  std::vector<float> table;
  table.reserve(this->Lanes() * parts);
  for (int group = 0; group < this->Count(); ++group)
  {
    for (int part = 0; part < parts; ++part)
    {
      for (int lane = 0; lane < OrdinateLanes; ++lane)
      {
        table.push_back(static_cast<float>(value(group, part, lane)));
      }
    }
  }
  return table;
}

std::vector<float> OrdinateGroups::Table(const std::function<double(int group, int lane)>& value) const
{
  return this->Table(1, [&](int group, int, int lane) { return value(group, lane); });
}
}
