#include "Viewing/Samples/PackedSamples.h"

#include "Device/Defines.h"
#include "Device/OpenCL.h"
#include "Device/Sizes.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexField.h"
#include "TyndallKernelSources.h"
#include "Viewing/Scene/ViewShared.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// King's moves from each brick to the nearest brick of another kind, computed by sweeps that propagate distances from
/// neighbours.
class Moves
{
public:
  Moves(const std::vector<cl_char>& bricks, const std::array<int, 3>& count)
    : Bricks(bricks)
    , Count(count)
    , Found(bricks.size(), 127)
  {
    const std::ptrdiff_t row = count[0], slice = row * count[1];
    for (int neighbour = 0; neighbour < Neighbours; ++neighbour)
    {
      this->Offsets[neighbour] = (neighbour % 3 - 1) + (neighbour / 3 % 3 - 1) * row + (neighbour / 9 - 1) * slice;
    }
  }

  /// @param side  1: use the neighbours before a brick in memory; -1: those after it
  void Relax(int i, int j, int k, int side)
  {
    const std::ptrdiff_t here = (static_cast<std::ptrdiff_t>(k) * this->Count[1] + j) * this->Count[0] + i;
    const bool inside =
      i > 0 && j > 0 && k > 0 && i + 1 < this->Count[0] && j + 1 < this->Count[1] && k + 1 < this->Count[2];
    int moves = this->Found[here];
    for (int neighbour = 0; neighbour < Neighbours; ++neighbour)
    {
      if (inside ||
        this->IsThere(
          i + side * (neighbour % 3 - 1), j + side * (neighbour / 3 % 3 - 1), k + side * (neighbour / 9 - 1)))
      {
        const std::ptrdiff_t there = here + side * this->Offsets[neighbour];
        moves = std::min(moves, this->Bricks[there] != this->Bricks[here] ? 1 : this->Found[there] + 1);
      }
    }
    this->Found[here] = moves;
  }

  int operator[](std::size_t brick) const { return this->Found[brick]; }

private:
  static constexpr int Neighbours = 13; ///< neighbours on either side

  bool IsThere(int i, int j, int k) const
  {
    return i >= 0 && j >= 0 && k >= 0 && i < this->Count[0] && j < this->Count[1] && k < this->Count[2];
  }

  const std::vector<cl_char>& Bricks;
  const std::array<int, 3> Count;
  std::array<std::ptrdiff_t, Neighbours> Offsets;
  std::vector<int> Found;
};

/// Multiplies each brick's kind (1 empty, -1 filled, 0 where rays bend) by the number of king's moves to the nearest
/// brick of another kind, at most 127; two sweeps find it exactly.
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count)
{
  Moves moves(bricks, count);
  for (int k = 0; k < count[2]; ++k)
  {
    for (int j = 0; j < count[1]; ++j)
    {
      for (int i = 0; i < count[0]; ++i)
      {
        moves.Relax(i, j, k, 1);
      }
    }
  }
  for (int k = count[2] - 1; k >= 0; --k)
  {
    for (int j = count[1] - 1; j >= 0; --j)
    {
      for (int i = count[0] - 1; i >= 0; --i)
      {
        moves.Relax(i, j, k, -1);
      }
    }
  }
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    bricks[brick] = static_cast<cl_char>(bricks[brick] * moves[brick]);
  }
}

std::size_t PaddedCount(const Grid& grid)
{
  return static_cast<std::size_t>(grid.size[0] + 2) * (grid.size[1] + 2) * (grid.size[2] + 2);
}

constexpr int PackedAlong = 64; ///< voxels of a row that a work-group packs

/// For each work-group in the rows of a brick: whether any of its voxels is seen. The first sample of a row belongs to
/// the border.
std::vector<cl_uchar> SeenGroups(const SeenBricks& bricks, const Grid& grid)
{
  const int along = PartsOf(grid.size[0] + 2, PackedAlong);
  std::vector<cl_uchar> seen;
  for (int row = 0; row < bricks.count[1] * bricks.count[2]; ++row)
  {
    const unsigned char* const ofRow = bricks.seen.data() + Count(row) * Count(bricks.count[0]);
    for (int group = 0; group < along; ++group)
    {
      const int first = std::max(group * PackedAlong - 1, 0) / BrickEdge;
      const int last = std::min((group + 1) * PackedAlong - 2, grid.size[0] - 1) / BrickEdge;
      seen.push_back(*std::max_element(ofRow + std::min(first, last), ofRow + last + 1));
    }
  }
  return seen;
}
}

PackedSamples::PackedSamples(Device& device, const FilledBricks& filled, const SceneOnDevice& scene,
  const ViewTraits& traits, const BlockOfScene* block)
  : TheDevice(device)
  , Traits(traits)
  , Count(traits.bricks.count)
  , KnownSize(block ? block->known.size : traits.grid.size)
{
  if (traits.bricked)
  {
    this->InBricks = SampleBricksOf(filled, traits.grid, traits.grey);
  }
  const std::size_t count = traits.bricked ? this->InBricks.SampleCount() : PaddedCount(traits.grid);
  const auto samples = [&](bool needed, const char* what) {
    return ZeroedBuffer<cl_float4>(device, needed ? count : 0, traits.bricked || traits.bricks.all, what);
  };
  this->First = Buffer<cl_int>(device, this->InBricks.first, "the records of bricks");
  this->BricksOfRecords = Buffer<cl_int>(device, this->InBricks.bricks, "the bricks of records");
  this->Sources = samples(true, "the ray caster's samples");
  this->ColouredExtinctions = samples(traits.coloured, "the ray caster's coloured extinction");
  this->Directions = samples(traits.knowsFlow || traits.ShowsBeams(), "the ray caster's directions of light");
  this->ColouredG = samples(traits.PacksCosines(), "the ray caster's mean cosines");
  this->Emission = samples(traits.GlowsApart(), "the ray caster's emission");
  Grid known = traits.grid;
  known.size = this->KnownSize;
  for (int axis = 0; block && axis < 3; ++axis)
  {
    this->KnownBefore[axis] = block->block.first[axis] - block->known.first[axis];
  }
  this->Gradients = Buffer<cl_float4>(device, traits.bends ? PaddedCount(known) : 0, "the ray caster's refraction");
  this->Distances = Buffer<cl_char>(
    device, static_cast<std::size_t>(this->Count[0]) * this->Count[1] * this->Count[2], "the ray caster's bricks");
  this->Seen = Buffer<cl_uchar>(device, traits.bricks.seen, "the bricks that rays see");
  this->SeenGroups =
    Buffer<cl_uchar>(device, tyndall::SeenGroups(traits.bricks, traits.grid), "the samples that rays see");
  if (traits.bends)
  {
    this->PackBending(known, block ? scene.knownIor : scene.ior);
  }
}

/// Launches a packing kernel over all voxels with their border, or over all samples of the records. Work-groups have a
/// fixed shape, because PoCL compiles a kernel anew for every shape.
void PackedSamples::Launch(cl::Kernel& kernel, const std::array<int, 3>& size)
{
  if (this->Traits.bricked)
  {
    const std::array<int, 3>& edges = this->InBricks.edges;
    const auto x = static_cast<std::size_t>(edges[0]), y = static_cast<std::size_t>(edges[1]);
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
      cl::NDRange(x, y, this->InBricks.bricks.size() * static_cast<std::size_t>(edges[2])), cl::NDRange(x, y, 1));
    return;
  }
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(size[0] + 2, PackedAlong), size[1] + 2, size[2] + 2),
    cl::NDRange(PackedAlong, 1, 1));
}

void PackedSamples::PackBending(const Grid& grid, const Buffer<float>& ior)
{
  struct
  {
    cl_int size[3];
  } const size = { { grid.size[0], grid.size[1], grid.size[2] } };
  const Buffer<float> coefficients = SquaredIndexCoefficients(this->TheDevice, grid, ior);
  cl::Kernel pack = this->TheDevice.Kernel("pack_bending", kernel_source::BendingField);
  With(pack, size, Float4(1.0 / Vector(grid.spacing), 0.0), coefficients, this->Gradients);
  this->Launch(pack, grid.size);
  this->TheDevice.Finish();
}

void PackedSamples::Pack(
  Packing what, const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse)
{
  this->For = what;
  if (this->Traits.ShowsMoments())
  {
    this->PackShown(scene, direct, diffuse);
  }
  else
  {
    this->PackSources(scene, direct);
  }
}

void PackedSamples::PackSources(const SceneOnDevice& scene, const Buffer<float>& direct)
{
  const ViewTraits& traits = this->Traits;
  const bool forShadowRays = this->For == Packing::ForShadowRays;
  const bool bends = traits.bends && !forShadowRays; // shadow rays are straight
  const std::string options = traits.SampleOptions() + Define("FLOW", traits.knowsFlow) +
    Define("FLOW_WITH_G", traits.knowsFlow && traits.FlowHasG()) + Define("VARIED_G", traits.PacksCosines()) +
    Define("GLOW", traits.GlowsApart()) + Define("SHADOW_RAYS", traits.shadowRays && !forShadowRays) +
    Define("BENDS", bends);
  const cl_int single = traits.singleScatteringOnly ? 1 : 0;

  cl::Kernel pack = this->TheDevice.Kernel("pack_samples", kernel_source::ScatteredLight, options);
  With(pack, Int4(traits.grid.size), traits.Components(), single, traits.phase.parameters.first.s[0],
    scene.arrays[0].Handle(), scene.arrays[1].Handle(), scene.arrays[2].Handle(), scene.arrays[3].Handle(),
    scene.arrays[4].Handle(), direct, scene.meanDirection.Handle(), scene.ior, scene.meanCosines, this->Samples(),
    this->Extinctions(), this->Flow(), this->Glow(), this->Cosines(), this->SeenGroups, this->BricksOfRecords);
  this->Launch(pack, traits.grid.size);
  this->FindBricks(bends, false);
}

std::string PackedSamples::ShownOptions() const
{
  const int shown = !this->Traits.ShowsMoments() || this->For == Packing::ForShadowRays ? 0
    : this->For == Packing::Scattered                                                   ? 1
                                                                                        : 2;
  return Define("SHOWN", shown) + Define("BEAMS", shown > 0 && this->Traits.ShowsBeams());
}

void PackedSamples::PackShown(const SceneOnDevice& scene, const Buffer<float>& direct, const Buffer<float>& diffuse)
{
  const ViewTraits& traits = this->Traits;
  const bool bends = traits.bends && this->For != Packing::ForShadowRays;
  const std::string options = traits.SampleOptions() + Define("GLOW", traits.GlowsApart()) + Define("BENDS", bends) +
    Define("AUREOLE", traits.aureoleChannels > 0);
  ViewedComponents components = traits.Components();
  components.straightOn = this->For == Packing::Unscattered ? 0 : components.straightOn;
  cl::Kernel pack = this->TheDevice.Kernel("pack_shown", kernel_source::ShownSamples, options + this->ShownOptions());
  With(pack, Int4(traits.grid.size), components, scene.arrays[0].Handle(), scene.arrays[1].Handle(),
    scene.arrays[2].Handle(), scene.straightOn, diffuse, direct, scene.ior, this->Samples(), this->Extinctions(),
    this->Flow(), this->Glow(), this->SeenGroups);
  this->Launch(pack, traits.grid.size);
  this->FindBricks(bends, true);
}

void PackedSamples::FindBricks(bool bends, bool shown)
{
  const ViewTraits& traits = this->Traits;
  const std::string options = Define("COLOURED", traits.coloured) + Define("GREY", traits.grey) +
    Define("BRICKED", traits.bricked) + Define("GLOW", traits.GlowsApart()) + Define("BENDS", bends) +
    Define("SHOWN", shown);
  const cl_int4 size = Int4(this->Traits.grid.size), bricks = Int4(this->Count);
  cl::Kernel find = this->TheDevice.Kernel("find_empty_bricks", kernel_source::EmptyBricks, options);
  With(find, size, bricks, Int4(this->KnownSize), Int4(this->KnownBefore), this->Samples(), this->Extinctions(),
    this->Glow(), this->Gradients, this->Seen, this->First, this->Distances);
  this->TheDevice.Queue().enqueueNDRangeKernel(find, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(bricks.s[0], 4), bricks.s[1], bricks.s[2]), cl::NDRange(4, 1, 1));
  std::vector<cl_char> distances = this->Distances.Read();
  this->EmptyBricks = std::find(distances.begin(), distances.end(), 1) != distances.end();
  FindDistances(distances, this->Count);
  this->Distances.Write(distances.data());
}
}
