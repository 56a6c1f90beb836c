#include "Medium/FilledBricks.h"

#include "Device/HostThreads.h"
#include "Device/Sizes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace tyndall
{
namespace
{
std::int32_t BitsOf(float value)
{
  std::int32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// One field in a row of bricks along x. Floats as integers: bits of those that are not negative are in the order of
/// their values, with all that is not finite above, and integers take no branch a value.
class RowOfBricks
{
public:
  RowOfBricks(const Field& field, const Grid& grid)
    : Of(field)
    , TheGrid(grid)
    , Bits(Count(grid.size[0]) * Count(field.components))
  {
  }

  /// Marks bricks in which any value is not zero, and widens what is known of all values.
  void Mark(int row, int layer, unsigned char* bricks, FilledBricks::Values& all)
  {
    this->Collect(row, layer);
    const std::size_t ofBrick = Count(BrickEdge) * Count(this->Of.components);
    std::int32_t largest = 0, signs = 0;
    for (std::size_t begin = 0, brick = 0; begin < this->Bits.size(); begin += ofBrick, ++brick)
    {
      const std::size_t end = std::min(begin + ofBrick, this->Bits.size());
      std::int32_t here = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        here |= this->Bits[i];
      }
      if (here != 0)
      {
        signs |= here;
        const std::int32_t most = this->LargestIn(row, layer, begin, end);
        largest = std::max(largest, most);
        bricks[brick] |= most > 0 ? 1 : 0;
      }
    }
    float value;
    std::memcpy(&value, &largest, sizeof(value));
    all.sound = all.sound && signs >= 0 && value <= std::numeric_limits<float>::max(); // NaN is not
    all.largest = std::max(all.largest, value);
  }

private:
  template <class Act>
  void ForRows(int row, int layer, const Act& act) const
  {
    const std::array<int, 3>& size = this->TheGrid.size;
    for (int z = layer * BrickEdge; z < std::min((layer + 1) * BrickEdge, size[2]); ++z)
    {
      for (int y = row * BrickEdge; y < std::min((row + 1) * BrickEdge, size[1]); ++y)
      {
        act(this->Of.values + this->TheGrid.IndexOf({ 0, y, z }) * Count(this->Of.components));
      }
    }
  }

  /// All bits of values that stand one above the other.
  void Collect(int row, int layer)
  {
    std::fill(this->Bits.begin(), this->Bits.end(), 0);
    std::int32_t* const bits = this->Bits.data();
    const std::size_t count = this->Bits.size();
    this->ForRows(row, layer, [&](const float* values) {
      for (std::size_t i = 0; i < count; ++i)
      {
        bits[i] |= BitsOf(values[i]);
      }
    });
  }

  std::int32_t LargestIn(int row, int layer, std::size_t begin, std::size_t end) const
  {
    std::int32_t largest = 0;
    this->ForRows(row, layer, [&](const float* values) {
      for (std::size_t i = begin; i < end; ++i)
      {
        largest = std::max(largest, BitsOf(values[i]));
      }
    });
    return largest;
  }

  const Field& Of;
  const Grid& TheGrid;
  std::vector<std::int32_t> Bits;
};

void Widen(FilledBricks::Values& all, const FilledBricks::Values& part)
{
  all.largest = std::max(all.largest, part.largest);
  all.sound = all.sound && part.sound;
}

/// What a layer of bricks along z has of one field.
void MarkLayer(const Field& field, const Grid& grid, int layer, FilledBricks& bricks, FilledBricks::Values& values)
{
  if (!field.values)
  {
    return;
  }
  RowOfBricks bricksOfRow(field, grid);
  for (int row = 0; row < bricks.count[1]; ++row)
  {
    bricksOfRow.Mark(row, layer, &bricks.filled[Count(layer * bricks.count[1] + row) * Count(bricks.count[0])], values);
  }
}
}

FilledBricks FindFilledBricks(const Medium& medium)
{
  FilledBricks bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    bricks.count[axis] = PartsOf<int>(medium.grid.size[axis], BrickEdge);
  }
  const std::size_t layers = Count(bricks.count[2]);
  bricks.filled.assign(Count(bricks.count[0]) * Count(bricks.count[1]) * layers, 0);
  const std::array<const Field*, 3> fields = { &medium.sigma_a, &medium.sigma_s, &medium.emission };
  const std::array<FilledBricks::Values*, 3> found = { &bricks.absorption, &bricks.scattering, &bricks.emission };
  std::vector<std::array<FilledBricks::Values, 3>> ofLayers(layers);
  InThreads(layers, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t layer = begin; layer < end; ++layer)
    {
      for (std::size_t f = 0; f < fields.size(); ++f)
      {
        MarkLayer(*fields[f], medium.grid, static_cast<int>(layer), bricks, ofLayers[layer][f]);
      }
    }
  });
  for (const std::array<FilledBricks::Values, 3>& layer : ofLayers)
  {
    for (std::size_t f = 0; f < fields.size(); ++f)
    {
      Widen(*found[f], layer[f]);
    }
  }
  bricks.filledCount = static_cast<std::size_t>(std::count(bricks.filled.begin(), bricks.filled.end(), 1));
  return bricks;
}
}
