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

/// Values of one field in a layer of bricks normal to z, which is contiguous in memory. Floats are compared as
/// integers, without branches: read as integers, the bit patterns of non-negative floats have the same order as the
/// floats, and those of non-finite values are larger.
class LayerOfBricks
{
public:
  LayerOfBricks(const Field& field, const Grid& grid, const FilledBricks& bricks, int layer)
    : Of(field)
    , TheGrid(grid)
    , BrickCount(bricks.count)
    , Layer(layer)
    , Bits(Count(bricks.count[0]) * Count(bricks.count[1]) * Lanes, 0)
  {
    const bool one = field.components == 3 && !field.HasColour();
    for (std::size_t i = 0; i < this->Used.size(); ++i)
    {
      this->Used[i] = one && static_cast<int>(i % 3) != field.standsForAll ? 0 : -1;
    }
  }

  /// Marks in `bricks` the bricks that have any non-zero value, and includes all values in the summary `all`.
  void Mark(unsigned char* bricks, FilledBricks::Values& all)
  {
    this->Collect();
    std::int32_t largest = 0, signs = 0;
    for (std::size_t brick = 0; brick < this->Bits.size() / Lanes; ++brick)
    {
      std::int32_t here = 0;
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        here |= this->Bits[brick * Lanes + lane];
      }
      if (here != 0)
      {
        signs |= here;
        const std::int32_t most = this->LargestIn(static_cast<int>(brick));
        largest = std::max(largest, most);
        bricks[brick] |= most > 0 ? 1 : 0;
      }
    }
    float value;
    std::memcpy(&value, &largest, sizeof(value));
    all.sound = all.sound && signs >= 0 && value <= std::numeric_limits<float>::max(); // a comparison with NaN is false
    all.largest = std::max(all.largest, value);
  }

private:
  static constexpr std::size_t Lanes = 8; ///< number of partial results per brick, one per lane of a vector instruction

  /// Calls act(row, y) for the rows of voxels from y0 to y1, in the order of memory.
  template <class Act>
  void ForRows(int y0, int y1, const Act& act) const
  {
    for (int z = this->Layer * BrickEdge; z < std::min((this->Layer + 1) * BrickEdge, this->TheGrid.size[2]); ++z)
    {
      for (int y = y0; y < std::min(y1, this->TheGrid.size[1]); ++y)
      {
        act(this->Of.values + this->TheGrid.IndexOf({ 0, y, z }) * Count(this->Of.components), y);
      }
    }
  }

  /// Combines the bits of each brick's values by OR, in Bits. Memory is read sequentially, because reading brick by
  /// brick would take twice as long.
  void Collect()
  {
    const std::size_t each = Count(this->Of.components), ofBrick = BrickEdge * each;
    const std::size_t values = Count(this->TheGrid.size[0]) * each, whole = values / ofBrick;
    this->ForRows(0, this->TheGrid.size[1], [&](const float* row, int y) {
      std::int32_t* const bits = this->Bits.data() + Count(y / BrickEdge) * Count(this->BrickCount[0]) * Lanes;
      for (std::size_t brick = 0; brick < whole; ++brick)
      {
        for (std::size_t part = 0; part < each; ++part)
        {
          for (std::size_t lane = 0; lane < Lanes; ++lane)
          {
            bits[brick * Lanes + lane] |=
              BitsOf(row[(brick * each + part) * Lanes + lane]) & this->Used[part * Lanes + lane];
          }
        }
      }
      for (std::size_t i = whole * ofBrick; i < values; ++i)
      {
        bits[whole * Lanes] |= BitsOf(row[i]) & this->Used[i - whole * ofBrick];
      }
    });
  }

  std::int32_t LargestIn(int brick) const
  {
    const int x = brick % this->BrickCount[0] * BrickEdge, y = brick / this->BrickCount[0] * BrickEdge;
    const std::size_t each = Count(this->Of.components), begin = Count(x) * each;
    const std::size_t end = Count(std::min(x + static_cast<int>(BrickEdge), this->TheGrid.size[0])) * each;
    std::int32_t largest = 0;
    this->ForRows(y, y + BrickEdge, [&](const float* row, int) {
      for (std::size_t i = begin; i < end; ++i)
      {
        largest = std::max(largest, BitsOf(row[i]) & this->Used[i - begin]);
      }
    });
    return largest;
  }

  const Field& Of;
  const Grid& TheGrid;
  const std::array<int, 3> BrickCount;
  const int Layer;
  /// Mask for the values of a row of a brick: all bits set for components in use, 0 for others.
  std::array<std::int32_t, 3 * BrickEdge> Used;
  /// [brick][lane of a vector instruction]: the bits of a brick's values in this lane, combined by OR
  std::vector<std::int32_t> Bits;
};
static_assert(BrickEdge == 8, "a row of a brick is whole lanes");

void Widen(FilledBricks::Values& all, const FilledBricks::Values& part)
{
  all.largest = std::max(all.largest, part.largest);
  all.sound = all.sound && part.sound;
}

/// Marks the bricks of a layer normal to z in which one field has a non-zero value.
void MarkLayer(const Field& field, const Grid& grid, int layer, FilledBricks& bricks, FilledBricks::Values& values)
{
  if (field.values)
  {
    LayerOfBricks(field, grid, bricks, layer)
      .Mark(&bricks.filled[Count(layer) * Count(bricks.count[1]) * Count(bricks.count[0])], values);
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
