#include "IO/VDB/VDBGrid.h"

#include "IO/VDB/VDBBytes.h"

#include <cmath>
#include <sstream>

namespace tyndall
{
bool DescribesTheFile(const std::string& key)
{
  using Grid = openvdb::GridBase;
  return key == Grid::META_SAVE_HALF_FLOAT || key == Grid::META_FILE_BBOX_MIN || key == Grid::META_FILE_BBOX_MAX ||
    key == Grid::META_FILE_COMPRESSION || key == Grid::META_FILE_MEM_BYTES || key == Grid::META_FILE_VOXEL_COUNT ||
    key == Grid::META_FILE_DELAYED_LOAD;
}

namespace
{
/// Reads one of OpenVDB's linear maps.
/// @return whether the type is one of them
bool ReadLinearMap(VDBBytes& bytes, const std::string& type, VDBGrid& grid)
{
  const auto vector = [&] { return bytes.Value<std::array<double, 3>>("the transform"); };
  const auto diagonal = [&](const std::array<double, 3>& scale) {
    for (int axis = 0; axis < 3; ++axis)
    {
      grid.Axes[axis][axis] = scale[axis];
    }
  };
  if (type == "AffineMap" || type == "UnitaryMap") // a matrix that multiplies row vectors from the right
  {
    for (int row = 0; row < 4; ++row)
    {
      (row < 3 ? grid.Axes[row] : grid.Translation) = vector();
      bytes.Skip(sizeof(double), "the transform");
    }
  }
  else if (type == "ScaleMap" || type == "UniformScaleMap") // followed by numbers derived from the scale
  {
    diagonal(vector());
    bytes.Skip(4 * 3 * sizeof(double), "the transform");
  }
  else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap")
  {
    grid.Translation = vector();
    diagonal(vector());
    bytes.Skip(4 * 3 * sizeof(double), "the transform");
  }
  else if (type == "TranslationMap")
  {
    grid.Translation = vector();
    diagonal({ 1.0, 1.0, 1.0 });
  }
  else
  {
    return false;
  }
  return true;
}

double TripleProduct(const std::array<std::array<double, 3>, 3>& v)
{
  return v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
    v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
}

/// Why an image cannot have the grid's map; empty if it can. Also sets Shears.
std::string FaultOfMap(VDBGrid& grid)
{
  const auto dot = [&](int i, int j) {
    const auto &a = grid.Axes[i], &b = grid.Axes[j];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  double lengths[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    lengths[axis] = std::sqrt(dot(axis, axis));
    if (!std::isfinite(lengths[axis]) || lengths[axis] <= 0.0 || !std::isfinite(grid.Translation[axis]))
    {
      return "its transform gives voxels no size";
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int next = (axis + 1) % 3;
    const double volume = TripleProduct(grid.Axes);
    if (!(std::abs(volume) > 1e-9 * lengths[0] * lengths[1] * lengths[2]))
    {
      return "its transform gives voxels no volume";
    }
    grid.Shears = grid.Shears || !(std::abs(dot(axis, next) / lengths[axis] / lengths[next]) < 1e-6);
  }
  return {};
}
}

openvdb::MetaMap ReadMetadata(VDBBytes& bytes)
{
  openvdb::MetaMap map;
  const auto count = bytes.Value<std::uint32_t>("the number of metadata");
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const std::string key = bytes.LengthAndText("the name of metadata");
    const std::string type = bytes.LengthAndText("the type of metadata");
    std::string value = bytes.LengthAndText("the value of metadata");
    if (key.empty())
    {
      bytes.Fail("metadata has no name");
    }
    if (DescribesTheFile(key) || type == "__delayedload" || !openvdb::Metadata::isRegisteredType(type))
    {
      continue;
    }
    const openvdb::Metadata::Ptr metadata = openvdb::Metadata::createMetadata(type);
    if (type != "string" && metadata->size() != value.size())
    {
      bytes.Fail("metadata \"" + key + "\" of type " + type + " has the wrong length");
    }
    if (type == "bool")
    {
      value[0] = value[0] != 0;
    }
    const auto length = static_cast<std::uint32_t>(value.size());
    std::istringstream stream(std::string(reinterpret_cast<const char*>(&length), sizeof(length)) + value);
    metadata->read(stream);
    map.removeMeta(key);
    map.insertMeta(key, *metadata);
  }
  return map;
}

bool ReadTransform(VDBBytes& bytes, VDBGrid& grid)
{
  const std::string type = bytes.LengthAndText("the type of the transform");
  if (!ReadLinearMap(bytes, type, grid))
  {
    grid.Unusable = "its transform (" + type +
      ") is not linear; an image needs one. Resample the grid, for example with OpenVDB's resampleToMatch";
    return false;
  }
  grid.Unusable = FaultOfMap(grid);
  return true;
}
}
