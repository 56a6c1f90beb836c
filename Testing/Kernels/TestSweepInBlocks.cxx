// A sweep of a grid that is spread over ranks, against that of the whole in one memory.

#include "DeviceTest.h"
#include "RandomMedium.h"

#include "Distribution/RanksInThreads.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepInMemory.h"

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr std::array<bool, 3> open = { false, false, false };
constexpr int diagonal = 16; ///< directions a face, some of whose rays go through the edges between voxels

/// What a sweep finds: path [channel][voxel], flux and currents with the parts of each channel in turn.
struct Found
{
  std::vector<float> path, flux, currents;
  SweepTally tally;
};

/// A box of random voxels that shine, all lit from outside.
struct BlockScene
{
  BlockScene(Device& device, const Grid& grid, int components, int perFace, int mapResolution = 1)
    : theDevice(device)
    , medium(grid, components, 0.7f, 20261126)
    , set(FittedDirections(perFace))
    , resolution(mapResolution)
  {
    medium.Emit(2.0f);
  }

  int Channels() const { return medium.medium.sigma_a.components; }

  std::vector<AxisBundles> Rays() const
  {
    std::vector<AxisBundles> rays;
    for (int axis = 0; axis < 3; ++axis)
    {
      rays.push_back({ axis, BundlesAlong(axis, medium.medium.grid, open, set, resolution, RayStarts::Staggered) });
    }
    return rays;
  }

  SweepBoundary Boundary() const
  {
    return [](int d, int face) { return Rgb{ 1.0 + 0.1 * face, 0.5, 0.01 * (d % 7) }; };
  }

  /// A box of the medium by itself.
  RandomMedium Part(const VoxelBox& box) const
  {
    Grid grid = medium.medium.grid;
    grid.size = box.size;
    RandomMedium part(grid, Channels(), 0.0f, 1);
    part.Emit(0.0f);
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      const std::size_t whole = PlaceInWhole(box, i);
      for (int c = 0; c < Channels(); ++c)
      {
        part.absorption[i * Channels() + c] = medium.absorption[whole * Channels() + c];
        part.scattering[i * Channels() + c] = medium.scattering[whole * Channels() + c];
        part.emission[i * Channels() + c] = medium.emission[whole * Channels() + c];
      }
    }
    return part;
  }

  std::size_t PlaceInWhole(const VoxelBox& box, std::size_t i) const
  {
    Grid grid = medium.medium.grid;
    grid.size = box.size;
    std::array<int, 3> voxel = grid.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] += box.first[axis];
    }
    return medium.medium.grid.IndexOf(voxel);
  }

  using Maker = std::function<std::unique_ptr<SweepOperator>(
    const VolumeLayout&, const Buffer<float>& sigma_t, const SweepRequest&)>;

  /// What is asked for of a sweep.
  struct Wants
  {
    bool source = true, boundary = true;
  };
  /// @param part  of the medium, all of it or a block
  Found Sweep(const RandomMedium& part, const Wants& wants, const Maker& make) const
  {
    const VolumeLayout layout = { part.medium.grid, Channels(), Channels() == 1 };
    const TruncatedScattering scattering(part.medium, 0, Channels());
    const MediumOnDevice onDevice(theDevice, part.medium, scattering, layout, { true, false });
    const std::vector<float> emitted =
      Planar(layout, layout.channels, [&](std::size_t i, int c) { return part.medium.emission.At(i, c); });
    Buffer<float> source(theDevice, layout.Floats(), "source");
    source.Fill(0.0f);
    source.Write(emitted.data(), emitted.size());
    Buffer<float> path(theDevice, layout.Floats(), "path"), flux(theDevice, layout.Floats(3), "flux"),
      currents(theDevice, layout.Floats(6), "currents");
    path.Fill(0.0f);
    flux.Fill(0.0f);
    currents.Fill(0.0f);
    const SweepRequest request = { { &path, &flux, &currents, nullptr }, Rays() };
    const std::unique_ptr<SweepOperator> sweep = make(layout, onDevice.SigmaT(), request);
    Found found;
    found.tally = sweep->Apply(wants.source ? &source : nullptr, wants.boundary ? Boundary() : SweepBoundary(), {});
    const auto ofVoxels = [&](const Buffer<float>& buffer, int parts) {
      const std::vector<float> all = buffer.Read();
      std::vector<float> kept;
      for (int q = 0; q < parts * layout.channels; ++q)
      {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(q * layout.Stride());
        kept.insert(kept.end(), begin, begin + static_cast<std::ptrdiff_t>(layout.grid.VoxelCount()));
      }
      return kept;
    };
    found.path = ofVoxels(path, 1);
    found.flux = ofVoxels(flux, 3);
    found.currents = ofVoxels(currents, 6);
    return found;
  }

  Found InMemory(const Wants& wants) const
  {
    SweepWorkspace workspace;
    return Sweep(
      medium, wants, [&](const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request) {
        return std::make_unique<SweepInMemory>(theDevice, layout, sigma_t, open, request, workspace);
      });
  }

  Found InBlocks(const BlockPartition& partition, const Wants& wants, int mostRays) const
  {
    partition.Check();
    const std::size_t voxels = medium.medium.grid.VoxelCount();
    Found all = { std::vector<float>(Channels() * voxels), std::vector<float>(3 * Channels() * voxels),
      std::vector<float>(6 * Channels() * voxels), {} };
    std::mutex guard;
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox& box = partition.blocks[communicator.Rank()];
      BlockWorkspace workspace;
      const Found found = Sweep(
        Part(box), wants, [&](const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request) {
          return std::make_unique<SweepInBlocks>(
            theDevice, communicator, partition, layout, sigma_t, open, request, workspace, mostRays);
        });
      const std::lock_guard<std::mutex> lock(guard);
      PutInto(all.path, found.path, box);
      PutInto(all.flux, found.flux, box);
      PutInto(all.currents, found.currents, box);
      all.tally = found.tally;
    });
    return all;
  }

  void PutInto(std::vector<float>& whole, const std::vector<float>& part, const VoxelBox& box) const
  {
    const std::size_t own = box.VoxelCount(), all = medium.medium.grid.VoxelCount();
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      whole[i / own * all + PlaceInWhole(box, i % own)] = part[i];
    }
  }

  Device& theDevice;
  RandomMedium medium;
  DirectionSet set;
  int resolution;
};
}

class SweepBlocks : public DeviceTest
{
protected:
  static void ExpectSame(const Found& found, const Found& expected)
  {
    EXPECT_LT(RelativeRmse(found.path, expected.path), 1e-6);
    EXPECT_LT(RelativeRmse(found.flux, expected.flux), 1e-6);
    EXPECT_LT(RelativeRmse(found.currents, expected.currents), 1e-6);
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(found.tally.in[face][c], expected.tally.in[face][c], 1e-6 * expected.tally.in[face][c]);
        EXPECT_NEAR(found.tally.out[face][c], expected.tally.out[face][c], 1e-6 * expected.tally.out[face][c])
          << "face " << face << ", channel " << c;
      }
    }
  }

  static void ExpectSameInBlocks(
    const BlockScene& scene, const BlockPartition& partition, const BlockScene::Wants& wants = {}, int mostRays = 0)
  {
    ExpectSame(scene.InBlocks(partition, wants, mostRays), scene.InMemory(wants));
  }
};

TEST_F(SweepBlocks, AreTheWholeOnOneToEightRanks)
{
  const Grid grid = { { 13, 10, 9 } };
  const BlockScene scene(GetDevice(), grid, 1, diagonal);
  const Found expected = scene.InMemory({});
  for (const int ranks : { 1, 2, 3, 4, 5, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(scene.InBlocks(BlockPartition::Even(grid, ranks), {}, 0), expected);
  }
}

TEST_F(SweepBlocks, AreTheWholeInColourWithVoxelsThatAreNoCubes)
{
  const Grid grid = { { 7, 12, 5 }, { 1.0, 0.7, 1.9 } };
  const BlockScene scene(GetDevice(), grid, 3, 9);
  ExpectSameInBlocks(scene, BlockPartition::Even(grid, 4));
}

TEST_F(SweepBlocks, AreTheWholeOnFinerMapsWithFewerRaysAtOnce)
{
  const Grid grid = { { 8, 8, 8 } };
  const BlockScene scene(GetDevice(), grid, 1, 16, 2);
  ExpectSameInBlocks(scene, BlockPartition::Even(grid, 3), {}, 3);
}

TEST_F(SweepBlocks, AreTheWholeOfLightFromOutsideAloneAndOfASourceAlone)
{
  const Grid grid = { { 9, 6, 7 } };
  const BlockScene scene(GetDevice(), grid, 1, 4);
  ExpectSameInBlocks(scene, BlockPartition::Even(grid, 4), { false, true });
  ExpectSameInBlocks(scene, BlockPartition::Even(grid, 4), { true, false });
}

/// Blocks whose edges do not meet, of one voxel and of one layer, and a rank that has none.
TEST_F(SweepBlocks, AreTheWholeWhereTheyAreUneven)
{
  const Grid grid = { { 6, 5, 7 } };
  const BlockPartition partition = { grid,
    { { { 0, 0, 0 }, { 6, 5, 2 } }, { { 0, 0, 2 }, { 1, 1, 1 } }, { { 1, 0, 2 }, { 5, 1, 1 } },
      { { 0, 0, 0 }, { 0, 0, 0 } }, { { 0, 1, 2 }, { 4, 4, 1 } }, { { 4, 1, 2 }, { 2, 4, 1 } },
      { { 0, 0, 3 }, { 2, 5, 4 } }, { { 2, 0, 3 }, { 4, 2, 4 } }, { { 2, 2, 3 }, { 4, 3, 4 } } } };
  ExpectSameInBlocks(BlockScene(GetDevice(), grid, 1, diagonal), partition);
}

TEST_F(SweepBlocks, AreTheWholeInVoxelsByThemselves)
{
  const Grid grid = { { 3, 2, 2 } };
  ExpectSameInBlocks(BlockScene(GetDevice(), grid, 1, diagonal), BlockPartition::Even(grid, 12));
}

/// Twice the same, bit for bit, whoever comes first.
TEST_F(SweepBlocks, DoNotDependOnWhichRankIsFast)
{
  const Grid grid = { { 8, 9, 6 } };
  const BlockScene scene(GetDevice(), grid, 1, 9);
  const BlockPartition partition = BlockPartition::Even(grid, 4);
  const Found first = scene.InBlocks(partition, {}, 0), second = scene.InBlocks(partition, {}, 0);
  EXPECT_EQ(first.path, second.path);
  EXPECT_EQ(first.tally.out, second.tally.out);
}
