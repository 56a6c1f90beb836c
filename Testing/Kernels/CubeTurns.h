#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// The 48 rotations and mirrorings of the cube, as they move boxes of voxels and what is in them.
struct CubeTurn
{
  std::array<int, 3> to = { 0, 1, 2 }; ///< where axis a comes to lie
  std::array<bool, 3> turned = {};     ///< whether it is turned round

  template <class T>
  std::array<T, 3> Moved(const std::array<T, 3>& values) const
  {
    std::array<T, 3> moved = {};
    for (int a = 0; a < 3; ++a)
    {
      moved[this->to[a]] = values[a];
    }
    return moved;
  }

  std::array<double, 3> Direction(std::array<double, 3> direction) const
  {
    for (int a = 0; a < 3; ++a)
    {
      direction[a] = this->turned[a] ? -direction[a] : direction[a];
    }
    return this->Moved(direction);
  }

  /// @param lengths  of the box, whose lowest corner is 0 before and after
  std::array<double, 3> Position(std::array<double, 3> position, const std::array<double, 3>& lengths) const
  {
    for (int a = 0; a < 3; ++a)
    {
      position[a] = this->turned[a] ? lengths[a] - position[a] : position[a];
    }
    return this->Moved(position);
  }

  /// Of faces -x, +x, -y, +y, -z, +z.
  int Face(int face) const { return 2 * this->to[face / 2] + ((face % 2 == 1) != this->turned[face / 2] ? 1 : 0); }

  /// Values of voxels, x fastest, `components` each.
  template <class T>
  std::vector<T> Field(const std::vector<T>& values, const std::array<int, 3>& size, int components = 1) const
  {
    std::vector<T> field(values.size());
    const std::array<int, 3> n = this->Moved(size);
    std::size_t from = 0;
    for (int z = 0; z < size[2]; ++z)
    {
      for (int y = 0; y < size[1]; ++y)
      {
        for (int x = 0; x < size[0] && from < values.size(); ++x)
        {
          std::array<int, 3> at = { x, y, z };
          for (int a = 0; a < 3; ++a)
          {
            at[a] = this->turned[a] ? size[a] - 1 - at[a] : at[a];
          }
          at = this->Moved(at);
          const std::size_t voxel = (static_cast<std::size_t>(at[2]) * n[1] + at[1]) * n[0] + at[0];
          for (int c = 0; c < components; ++c, ++from)
          {
            field[voxel * components + c] = values[from];
          }
        }
      }
    }
    return field;
  }
};

inline std::vector<CubeTurn> AllCubeTurns()
{
  std::vector<CubeTurn> turns;
  std::array<int, 3> to = { 0, 1, 2 };
  do
  {
    for (int flips = 0; flips < 8; ++flips)
    {
      turns.push_back({ to, { (flips & 1) != 0, (flips & 2) != 0, (flips & 4) != 0 } });
    }
  } while (std::next_permutation(to.begin(), to.end()));
  return turns;
}
