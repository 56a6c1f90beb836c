#include "Viewing/Scene/BlockOfScene.h"

#include "Distribution/BlockPartition.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/Halo.h"
#include "Medium/Traits.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Distance in voxels, behind the midpoint of a step, from which the splitting of a ray at a surface reads values: the
/// surface lies between this midpoint and the previous one.
double ReachOfSplit(const ViewSettings& settings)
{
  return settings.surfaceReflection == SurfaceReflection::None ? 0.0 : settings.stepSize;
}
}

double LeastStraightOn(const Medium& medium, const SolvedLight& light, int channel)
{
  double least = 1.0;
  for (std::size_t i = 0; light.straightOn.values && i < medium.grid.VoxelCount(); ++i)
  {
    least = medium.sigma_s.At(i, channel) > 0.0f ? std::min<double>(least, light.straightOn.At(i, channel)) : least;
  }
  return least;
}

SharedScene SharedSceneOf(
  const Medium& medium, const SolvedLight& light, const Field& ior, const ViewSettings& settings)
{
  SharedScene shared;
  shared.index = IndexRangeOf(ior, medium.grid);
  shared.coloured = !settings.leaveOut || !TraitsOf(medium).greyExtinction || light.straightOn.components == 3;
  for (int c = 0; c < 3; ++c)
  {
    shared.straightOn[c] = LeastStraightOn(medium, light, c);
  }
  return shared;
}

std::vector<float> HeldIndex(const Field& known, const BlockOfScene& block, const std::array<int, 3>& size)
{
  return known.values
    ? PartOf({ known.values, known.values + block.known.VoxelCount() }, block.known, { block.block.first, size }, 1)
    : std::vector<float>();
}

VoxelBox HeldBox(const VoxelBox& own, const Grid& whole, const ViewSettings& settings, bool moments, bool surface)
{
  constexpr int Between = 1; // voxel centres around any point of the block
  // a layer reaches half a voxel beyond its centres
  const int split = static_cast<int>(std::ceil(ReachOfSplit(settings) - 0.5));
  // A voxel that does not scatter shows the light of its neighbours.
  VoxelBox held = Grown(own, Between + std::max(split, moments ? 1 : 0), whole);
  for (int axis = 0; surface && axis < 3; ++axis)
  {
    const int deep = std::min(VoxelsBehindSurface, whole.size[axis]);
    const int begin =
      EndOf(held, axis) == whole.size[axis] ? std::min(held.first[axis], whole.size[axis] - deep) : held.first[axis];
    const int end = held.first[axis] == 0 ? std::max(EndOf(held, axis), deep) : EndOf(held, axis);
    held.first[axis] = begin;
    held.size[axis] = end - begin;
  }
  return held;
}

VoxelBox KnownBox(const VoxelBox& own, const VoxelBox& held, const Grid& whole, const ViewSettings& settings)
{
  constexpr int OfSpline = 3; // a centre beyond the point, the coefficients of its neighbours, and theirs
  const double reach = ReachOfSplit(settings);
  const int layers = OfSpline + static_cast<int>(std::ceil(reach > 0.0 ? reach + VoxelsBesideSurface : 0.0));
  return Hull(Grown(own, layers, whole), { held });
}

BlockInfo BlockInfoOf(const GridBlock& block)
{
  BlockInfo info;
  info.whole = Int4(block.whole.size);
  info.first = Int4(block.first);
  info.first.s[3] = block.showsBackgroundBeside ? 1 : 0;
  info.begin = Int4(block.begin);
  info.end = Int4(block.end);
  return info;
}

bool IsOnFace(const GridBlock& block, const std::array<int, 3>& size, int face)
{
  const int axis = face / 2;
  return face % 2 ? block.first[axis] + size[axis] == block.whole.size[axis] : block.first[axis] == 0;
}
}
