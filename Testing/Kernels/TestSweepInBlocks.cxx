// A sweep of a grid that is spread over ranks, against that of the whole in one memory.

#include "DeviceTest.h"
#include "Difference.h"
#include "OnRanks.h"
#include "RandomMedium.h"

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepInMemory.h"

#include <mutex>
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

  using Maker = std::function<std::unique_ptr<SweepOperator>(
    const VolumeLayout&, const Buffer<float>& sigma_t, const SweepRequest&)>;

  /// What is asked for of a sweep.
  struct Wants
  {
    bool source = true, boundary = true;
  };
  /// Of a rank's block, as `make` sweeps it.
  Found Sweep(const Domain& domain, const Wants& wants, const Maker& make) const
  {
    const std::vector<float> sigma_a = BlockOf(domain, medium.absorption), sigma_s = BlockOf(domain, medium.scattering),
                             emission = BlockOf(domain, medium.emission);
    Medium part = medium.medium;
    part.grid = domain.OwnGrid();
    part.sigma_a.values = sigma_a.data();
    part.sigma_s.values = sigma_s.data();
    part.emission.values = emission.data();
    const VolumeLayout layout = { part.grid, Channels(), Channels() == 1 };
    const TruncatedScattering scattering(part, 0, Channels());
    const MediumOnDevice onDevice(theDevice, part, scattering, layout, { true, false });
    const std::vector<float> emitted =
      Planar(layout, layout.channels, [&](std::size_t i, int c) { return part.emission.At(i, c); });
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
    return Sweep(Domain(medium.medium.grid), wants,
      [&](const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request) {
        return std::make_unique<SweepInMemory>(theDevice, layout, sigma_t, open, request, workspace);
      });
  }

  Found InBlocks(const BlockPartition& partition, const Wants& wants, int mostRays) const
  {
    partition.Check();
    Found all;
    std::mutex guard;
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const Domain domain(communicator, partition);
      BlockWorkspace workspace;
      const Found found = Sweep(
        domain, wants, [&](const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request) {
          return std::make_unique<SweepInBlocks>(
            theDevice, communicator, partition, layout, sigma_t, open, request, workspace, mostRays);
        });
      const std::lock_guard<std::mutex> lock(guard);
      PutInto(all.path, found.path, domain, Channels());
      PutInto(all.flux, found.flux, domain, 3 * Channels());
      PutInto(all.currents, found.currents, domain, 6 * Channels());
      all.tally = found.tally;
    });
    return all;
  }

  static void PutInto(std::vector<float>& whole, const std::vector<float>& part, const Domain& domain, int arrays)
  {
    const std::size_t own = domain.Own().VoxelCount(), all = domain.Whole().VoxelCount();
    whole.resize(arrays * all);
    ForVoxels(domain, [&](std::size_t i, std::size_t there) {
      for (int array = 0; array < arrays; ++array)
      {
        whole[array * all + there] = part[array * own + i];
      }
    });
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

/// Blocks whose edges do not meet, of one voxel and of one layer, and a rank that has none.
TEST_F(SweepBlocks, AreTheWhole)
{
  const Grid grid = { { 6, 5, 7 } };
  const BlockPartition uneven = { grid,
    { { { 0, 0, 0 }, { 6, 5, 2 } }, { { 0, 0, 2 }, { 1, 1, 1 } }, { { 1, 0, 2 }, { 5, 1, 1 } },
      { { 0, 0, 0 }, { 0, 0, 0 } }, { { 0, 1, 2 }, { 4, 4, 1 } }, { { 4, 1, 2 }, { 2, 4, 1 } },
      { { 0, 0, 3 }, { 2, 5, 4 } }, { { 2, 0, 3 }, { 4, 2, 4 } }, { { 2, 2, 3 }, { 4, 3, 4 } } } };
  const BlockScene scene(GetDevice(), grid, 1, diagonal);
  ExpectSameInBlocks(scene, BlockPartition::Even(grid, 1));
  ExpectSameInBlocks(scene, uneven);
  ExpectSameInBlocks(scene, uneven, { false, true });
  ExpectSameInBlocks(scene, uneven, { true, false });
}

TEST_F(SweepBlocks, AreTheWholeInColourWithVoxelsThatAreNoCubes)
{
  const Grid grid = { { 7, 12, 5 }, { 1.0, 0.7, 1.9 } };
  ExpectSameInBlocks(BlockScene(GetDevice(), grid, 3, 9), BlockPartition::Even(grid, 4));
}

TEST_F(SweepBlocks, AreTheWholeOnFinerMapsWithFewerRaysAtOnce)
{
  const Grid grid = { { 8, 8, 8 } };
  ExpectSameInBlocks(BlockScene(GetDevice(), grid, 1, 16, 2), BlockPartition::Even(grid, 3), {}, 3);
}

/// Twice the same, bit for bit, whoever comes first; in blocks of one voxel.
TEST_F(SweepBlocks, DoNotDependOnWhichRankIsFast)
{
  const Grid grid = { { 3, 2, 2 } };
  const BlockScene scene(GetDevice(), grid, 1, diagonal);
  const BlockPartition partition = BlockPartition::Even(grid, 12);
  const Found first = scene.InBlocks(partition, {}, 0), second = scene.InBlocks(partition, {}, 0);
  ExpectSame(first, scene.InMemory({}));
  EXPECT_EQ(first.path, second.path);
  EXPECT_EQ(first.tally.out, second.tally.out);
}
