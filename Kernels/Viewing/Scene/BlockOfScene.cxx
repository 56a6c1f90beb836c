#include "Viewing/Scene/BlockOfScene.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/Halo.h"
#include "Medium/BoxFaces.h"
#include "Medium/Traits.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Distance in voxels, measured back from the midpoint of a step, within which samples are read when the reflecting
/// surface splits a ray. The surface lies between the midpoints of this step and of the previous one. 0 without a
/// surface.
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

double LargestError(const Medium& medium, const SolvedLight& light)
{
  const Field& error = light.fluenceError;
  const std::size_t count = error.values ? medium.grid.VoxelCount() * error.components : 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    largest = std::max<double>(largest, error.values[i]);
  }
  return largest;
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
  shared.largestError = LargestError(medium, light);
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
  constexpr int Between = 1; // layers of ghost cells for interpolation at any point of the block
  // One layer of ghost cells (Between) allows interpolation up to half a voxel beyond the block's own voxels.
  const int split = static_cast<int>(std::ceil(ReachOfSplit(settings) - 0.5));
  // If light is shown by angular moments, a voxel that does not scatter shows the mean light of its neighbours.
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
  // Three layers of ghost cells for the gradient of n^2 at a point. One is for interpolation between voxel centres, one
  // for the neighbouring spline coefficients at a centre, and one for the neighbouring values of n on which each
  // coefficient depends.
  constexpr int OfSpline = 3;
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

GridBlock BlockOfRank(const BlockPartition& partition, int rank, const VoxelBox& held)
{
  const VoxelBox& own = partition.blocks[rank];
  const bool isFirst = std::all_of(partition.blocks.begin(), partition.blocks.begin() + rank,
    [](const VoxelBox& block) { return block.VoxelCount() == 0; });
  return { partition.whole, held.first, own.first, { EndOf(own, 0), EndOf(own, 1), EndOf(own, 2) },
    isFirst && own.VoxelCount() > 0 };
}

std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size)
{
  Grid grid = block.whole;
  grid.size = size;
  std::vector<float> faces(BoxFaceCellCount(grid) * components, 0.0f);
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    const PlaneAxes axes = AcrossAxis(cell.face / 2);
    const int plane = block.first[axes.axis] + (cell.face % 2 ? size[axes.axis] : 0);
    if (plane == (cell.face % 2 ? block.whole.size[axes.axis] : 0))
    {
      const BoxFaceLayout layout = LayoutOfFace(block.whole, cell.face);
      const std::size_t number = layout.first + (cell.u + block.first[axes.u]) * layout.step[axes.u] +
        (cell.v + block.first[axes.v]) * layout.step[axes.v];
      std::copy_n(ofWhole.begin() + number * components, components, faces.begin() + cell.number * components);
    }
  });
  return faces;
}

namespace
{
/// Whether a camera ray can pass from block b into block a. Tests, for each axis along which a plane separates the
/// blocks, whether rays can cross this plane from b's side to a's side.
bool CanHide(const GridBlock& b, const GridBlock& a, const Camera& camera)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool below = a.end[axis] <= b.begin[axis];
    const bool above = b.end[axis] <= a.begin[axis];
    const double eye = (camera.position[axis] - a.whole.origin[axis]) / a.whole.spacing[axis];
    const double forward = camera.focalPoint[axis] - camera.position[axis];
    if ((below && (camera.parallelProjection ? forward >= 0.0 : eye <= b.begin[axis])) ||
      (above && (camera.parallelProjection ? forward <= 0.0 : eye >= b.end[axis])))
    {
      return false;
    }
  }
  return true;
}
}

std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera)
{
  std::vector<int> waiting, order;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    waiting.push_back(static_cast<int>(i));
  }
  while (!waiting.empty())
  {
    const auto isHidden = [&](int a) {
      return std::any_of(
        waiting.begin(), waiting.end(), [&](int b) { return b != a && CanHide(blocks[b], blocks[a], camera); });
    };
    auto front = std::find_if_not(waiting.begin(), waiting.end(), isHidden);
    front = front == waiting.end() ? waiting.begin() : front;
    order.push_back(*front);
    waiting.erase(front);
  }
  return order;
}
}
