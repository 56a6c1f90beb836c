#include "Viewing/Samples/PackedSamples.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexField.h"
#include "TyndallKernelSources.h"

#include <algorithm>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// Whether any sample in the record of a brick belongs to a filled voxel. A record has the samples at the corners of
/// the brick's cells. Since the border shifts samples by one voxel, these include the last voxels of the preceding
/// bricks.
/// @param cells  indices of the brick of cells along each axis
bool IsFilled(const FilledBricks& filled, const std::array<int, 3>& cells)
{
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a)
  {
    low[a] = std::max(cells[a] - 1, 0);
    high[a] = std::min(cells[a], filled.count[a] - 1);
  }
  bool any = false;
  for (int k = low[2]; k <= high[2]; ++k)
  {
    for (int j = low[1]; j <= high[1]; ++j)
    {
      const unsigned char* const row = filled.RowOf(j * BrickEdge, k * BrickEdge);
      any = any || std::count(row + low[0], row + high[0] + 1, 1) > 0;
    }
  }
  return any;
}
}

SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired)
{
  SampleBricks bricks;
  bricks.edges = { SampleEdge, paired ? static_cast<int>(BrickEdge) : static_cast<int>(SampleEdge), SampleEdge };
  for (int a = 0; a < 3; ++a)
  {
    bricks.count[a] = grid.size[a] / BrickEdge + 1;
  }
  const auto each = static_cast<cl_int>(bricks.SamplesEach());
  bricks.bricks.push_back(-1);
  ForGridVoxels(bricks.count, [&](std::size_t number, int i, int j, int k) {
    const bool isFilled = IsFilled(filled, { i, j, k });
    bricks.first.push_back(isFilled ? static_cast<cl_int>(bricks.bricks.size()) * each : 0);
    if (isFilled)
    {
      bricks.bricks.push_back(static_cast<cl_int>(number));
    }
  });
  return bricks;
}

namespace
{
/// Multiplies the class of each brick (1 empty, -1 filled, 0 where rays bend) by the Chebyshev distance, in bricks, to
/// the nearest brick of another class, at most 127. Distances are propagated from neighbours in two passes, forwards
/// and backwards, which gives exact values.
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count)
{
  const auto total = static_cast<std::ptrdiff_t>(bricks.size());
  const std::ptrdiff_t row = count[0], slice = row * count[1];
  std::vector<int> moves(bricks.size(), 127);
  for (const int side : { 1, -1 })
  {
    for (std::ptrdiff_t n = 0; n < total; ++n)
    {
      const std::ptrdiff_t here = side > 0 ? n : total - 1 - n;
      const std::ptrdiff_t i = here % row, j = here / row % count[1], k = here / slice;
      // Neighbours that precede the brick in memory (first pass), or follow it (second pass).
      for (int neighbour = 0; neighbour < 13; ++neighbour)
      {
        const int x = side * (neighbour % 3 - 1), y = side * (neighbour / 3 % 3 - 1), z = side * (neighbour / 9 - 1);
        if (i + x >= 0 && i + x < row && j + y >= 0 && j + y < count[1] && k + z >= 0 && k + z < count[2])
        {
          const std::ptrdiff_t there = here + x + y * row + z * slice;
          moves[here] = std::min(moves[here], bricks[there] != bricks[here] ? 1 : moves[there] + 1);
        }
      }
    }
  }
  std::transform(bricks.begin(), bricks.end(), moves.begin(), bricks.begin(),
    [](cl_char kind, int distance) { return static_cast<cl_char>(kind * distance); });
}

std::size_t PaddedCount(const Grid& grid)
{
  return static_cast<std::size_t>(grid.size[0] + 2) * (grid.size[1] + 2) * (grid.size[2] + 2);
}

constexpr int PackedAlong = 64; ///< number of voxels of a row that a work-group packs

/// Flags of the work-groups that pack samples, along x for each row of bricks: 1 if any ray samples a voxel of the
/// group, else 0. The first sample of a row belongs to the border.
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

/// Launches a packing kernel over all voxels with their border or, if samples are stored in bricks, over all samples of
/// the records. Work-groups have a fixed shape, because PoCL compiles a kernel anew for every shape.
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

/// Parameters of the kernels that pack samples.
PackInfo PackedSamples::InfoOf(const ViewedComponents& components) const
{
  PackInfo info = {};
  info.size = Int4(this->Traits.grid.size);
  info.bricks = Int4(this->Count);
  info.known = Int4(this->KnownSize);
  info.before = Int4(this->KnownBefore);
  info.components = components;
  info.single = this->Traits.singleScatteringOnly ? 1 : 0;
  info.g = this->Traits.phase.parameters.first.s[0];
  return info;
}

void PackedSamples::PackSources(const SceneOnDevice& scene, const Buffer<float>& direct)
{
  const ViewTraits& traits = this->Traits;
  const bool forShadowRays = this->For == Packing::ForShadowRays;
  const bool bends = traits.bends && !forShadowRays; // shadow rays are straight
  ViewedComponents components = traits.Components();
  components.direct = traits.shadowRays && !forShadowRays ? 6 : 0;
  cl::Kernel pack = this->TheDevice.Kernel("pack_samples", kernel_source::ScatteredLight,
    traits.SampleOptions() + Define("FLOW", traits.Flow()) + Define("GLOW", traits.GlowsApart()) +
      Define("BENDS", bends));
  With(pack, this->InfoOf(components), scene.arrays[0].Handle(), scene.arrays[1].Handle(), scene.arrays[2].Handle(),
    scene.arrays[3].Handle(), scene.arrays[4].Handle(), direct, scene.meanDirection.Handle(), scene.ior,
    scene.meanCosines, this->Samples(), this->Extinctions(), this->Flow(), this->Glow(), this->Cosines(),
    this->SeenGroups, this->BricksOfRecords);
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
  ViewedComponents components = traits.Components();
  components.straightOn = this->For == Packing::Unscattered ? 0 : components.straightOn;
  cl::Kernel pack = this->TheDevice.Kernel("pack_shown", kernel_source::ShownSamples,
    traits.SampleOptions() + Define("GLOW", traits.GlowsApart()) + Define("BENDS", bends) +
      Define("AUREOLE", traits.moments.aureoleChannels > 0) + this->ShownOptions());
  With(pack, this->InfoOf(components), scene.arrays[0].Handle(), scene.arrays[1].Handle(), scene.arrays[2].Handle(),
    scene.straightOn, diffuse, direct, scene.ior, this->Samples(), this->Extinctions(), this->Flow(), this->Glow(),
    this->SeenGroups);
  this->Launch(pack, traits.grid.size);
  this->FindBricks(bends, true);
}

void PackedSamples::FindBricks(bool bends, bool shown)
{
  const ViewTraits& traits = this->Traits;
  const SampleTraits of = { traits.coloured, traits.grey, traits.bricked, traits.GlowsApart(), bends, shown };
  cl::Kernel find = this->TheDevice.Kernel("find_empty_bricks", kernel_source::EmptyBricks);
  With(find, this->InfoOf({}), of, this->Samples(), this->Extinctions(), this->Glow(), this->Gradients, this->Seen,
    this->First, this->Distances);
  this->TheDevice.Queue().enqueueNDRangeKernel(find, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(this->Count[0], 4), this->Count[1], this->Count[2]), cl::NDRange(4, 1, 1));
  std::vector<cl_char> distances = this->Distances.Read();
  this->EmptyBricks = std::find(distances.begin(), distances.end(), 1) != distances.end();
  FindDistances(distances, this->Count);
  this->Distances.Write(distances.data());
}
}
