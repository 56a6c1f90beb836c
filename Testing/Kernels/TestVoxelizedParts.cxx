#include "DeviceTest.h"
#include "MeshShapes.h"

#include "Distribution/BlockPartition.h"
#include "Distribution/BoxExchange.h"
#include "RanksInThreads.h"
#include "Refraction/Index/RefractiveMedium.h"

#include <gmock/gmock.h>

#include <mutex>

using namespace tyndall;

namespace
{
const Grid Box = { { 21, 17, 19 }, { 0.1, 0.12, 0.11 }, { -1.03, -1.01, -1.05 } };

/// Glass and jade that overlap, of different colours and mean cosines, perturbed.
std::vector<Solid> TwoSolids()
{
  const Material glass = { 1.5, { 0.1, 0.2, 0.3 }, { 0.3, 0.2, 0.4 }, 0.3 };
  const Material jade = { 1.3, { 0.05, 0.05, 0.05 }, { 2.0, 2.0, 2.0 }, -0.2 };
  return { { "Ball", shapes::Sphere({ 0.01, 0.02, 0.03 }, 0.7, 4), glass },
    { "Stone", shapes::Sphere({ 0.3, -0.2, 0.1 }, 0.4, 3), jade } };
}

RefractiveMediumSettings SettingsFor(int filterSize, int samples = 4)
{
  RefractiveMediumSettings settings;
  settings.grid = Box;
  settings.outside = { 1.0, { 0.0, 0.0, 0.0 }, { 0.7, 0.7, 0.7 }, 0.0 };
  settings.perturbation = { 0.05, 0.3, 0.2, 7 };
  settings.filterSize = filterSize;
  settings.voxelization.samples = samples;
  return settings;
}

class VoxelizedPartsTest : public DeviceTest
{
protected:
  static void ExpectPart(const RefractiveMedium& part, const RefractiveMedium& whole, const VoxelBox& box)
  {
    const VoxelBox all = { {}, Box.size };
    const auto expect = [&](const std::vector<float>& found, const std::vector<float>& wanted, int components) {
      ASSERT_EQ(found.empty(), wanted.empty());
      if (!wanted.empty())
      {
        EXPECT_EQ(found, PartOf(wanted, all, box, components)) << box.first[0] << " " << box.first[1];
      }
    };
    expect(part.occupancy, whole.occupancy, 1);
    expect(part.ior, whole.ior, 1);
    expect(part.iorGradient, whole.iorGradient, 3);
    expect(part.sigma_a, whole.sigma_a, whole.components);
    expect(part.sigma_s, whole.sigma_s, whole.components);
    expect(part.gByVoxel, whole.gByVoxel, whole.components);
  }

  /// Every block, as a part made by itself.
  void ExpectBlocks(const RefractiveMediumSettings& settings, const std::vector<VoxelBox>& blocks)
  {
    const std::vector<Solid> solids = TwoSolids();
    const RefractiveMedium whole = Voxelize(this->GetDevice(), solids, settings);
    VoxelFindings all;
    all.empty = false;
    all.windings.resize(solids.size());
    for (const VoxelBox& block : blocks)
    {
      VoxelizedPart part = VoxelizePart(this->GetDevice(), solids, settings, { block, block });
      ExpectPart(Concluded(std::move(part), all, solids, settings), whole, block);
    }
  }
};

TEST_F(VoxelizedPartsTest, AreTheWholeBitForBit)
{
  for (const int filterSize : { 1, 5, 9 })
  {
    this->ExpectBlocks(SettingsFor(filterSize), BlockPartition::Even(Box, 8).blocks);
  }
  this->ExpectBlocks(SettingsFor(5, 3), BlockPartition::Even(Box, 3).blocks);
}

TEST_F(VoxelizedPartsTest, MayBeUnevenOrOneVoxel)
{
  this->ExpectBlocks(SettingsFor(5),
    { { { 0, 0, 0 }, { 20, 17, 19 } }, { { 20, 0, 0 }, { 1, 17, 19 } }, { { 0, 5, 0 }, { 21, 1, 19 } },
      { { 13, 6, 10 }, { 1, 1, 1 } }, { { 0, 0, 0 }, { 1, 1, 1 } }, { { 3, 2, 18 }, { 15, 13, 1 } } });
}

TEST_F(VoxelizedPartsTest, MayRunTheirColumnsEachWay)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    RefractiveMediumSettings settings = SettingsFor(3, 2);
    settings.voxelization.columnAxis = axis;
    this->ExpectBlocks(settings, BlockPartition::Even(Box, 5).blocks);
  }
}

TEST_F(VoxelizedPartsTest, TakeLessOfTheDevice)
{
  RefractiveMediumSettings settings = SettingsFor(5);
  settings.grid.size = { 80, 80, 80 };
  settings.grid.spacing.fill(0.025);
  const auto bytes = [&](const VoxelBox& box) {
    const std::size_t before = this->GetDevice().BytesInUse();
    this->GetDevice().ResetPeak();
    VoxelizePart(this->GetDevice(), TwoSolids(), settings, { box, box });
    return static_cast<double>(this->GetDevice().PeakBytes() - before);
  };
  const double whole = bytes({ {}, settings.grid.size }), eighth = bytes({ { 40, 0, 40 }, { 40, 40, 40 } });
  EXPECT_LT(eighth, 0.3 * whole) << eighth << " of " << whole << " bytes";
}

/// A body that winds twice about what its two balls share, in one mesh.
Solid Twins()
{
  TriangleMesh mesh = shapes::Sphere({ -0.2, 0.0, 0.0 }, 0.5, 3);
  const TriangleMesh second = shapes::Sphere({ 0.2, 0.1, 0.0 }, 0.5, 3);
  const int first = static_cast<int>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), second.points.begin(), second.points.end());
  for (const std::array<int, 3>& corners : second.triangles)
  {
    mesh.triangles.push_back({ corners[0] + first, corners[1] + first, corners[2] + first });
  }
  return { "Twins", mesh, { 1.5, {}, {}, 0.0 } };
}

TEST_F(VoxelizedPartsTest, OfRanksSayOfTheBoxWhatTheWholeSays)
{
  const std::vector<Solid> solids = { Twins() };
  RefractiveMediumSettings settings = SettingsFor(5);
  settings.perturbation = {};
  VoxelizedPart whole = VoxelizePart(this->GetDevice(), solids, settings, { { {}, Box.size }, { {}, Box.size } });
  const VoxelFindings findings = whole.findings;
  const RefractiveMedium wanted = Concluded(std::move(whole), findings, solids, settings);
  ASSERT_THAT(wanted.warnings, testing::SizeIs(1)); // that it intersects itself, with number, volume and place
  for (const int ranks : { 1, 3, 8 })
  {
    std::vector<VoxelBox> blocks = BlockPartition::Even(Box, ranks == 8 ? 7 : ranks).blocks;
    blocks.resize(static_cast<std::size_t>(ranks)); // the last of 8 has nothing
    std::mutex one;
    RunInThreads(ranks, [&](Communicator& communicator) {
      const VoxelBox& own = blocks[static_cast<std::size_t>(communicator.Rank())];
      VoxelizedPart part;
      {
        const std::lock_guard<std::mutex> held(one);
        part = VoxelizePart(this->GetDevice(), solids, settings, { Grown(own, own.VoxelCount() > 0, Box), own });
      }
      const VoxelFindings all = FindingsOfAll(communicator, part.findings);
      const std::lock_guard<std::mutex> held(one);
      EXPECT_NEAR(all.volume, findings.volume, 1e-12);
      EXPECT_FALSE(all.empty);
      const RefractiveMedium medium = Concluded(std::move(part), all, solids, settings);
      EXPECT_EQ(medium.warnings, wanted.warnings) << ranks;
    });
  }
}

TEST_F(VoxelizedPartsTest, KnowAnEmptyBoxOnlyTogether)
{
  Solid ball = { "Ball", shapes::Sphere({ 5.0, 0.0, 0.0 }, 0.5, 2), { 1.5, {}, {}, 0.0 } };
  const RefractiveMediumSettings settings = SettingsFor(3);
  const VoxelBox own = { { 0, 0, 0 }, { 4, 4, 4 } };
  VoxelizedPart part = VoxelizePart(this->GetDevice(), { ball }, settings, { own, own });
  EXPECT_TRUE(part.findings.empty);
  VoxelFindings unknown = part.findings;
  unknown.empty = false;
  const RefractiveMedium alone = Concluded(VoxelizedPart(part), unknown, { ball }, settings);
  EXPECT_EQ(alone.ior, std::vector<float>(64, 1.0f));
  EXPECT_EQ(alone.iorGradient, std::vector<float>(3 * 64, 0.0f));
  EXPECT_TRUE(alone.warnings.empty());
  const VoxelFindings known = part.findings;
  const RefractiveMedium together = Concluded(std::move(part), known, { ball }, settings);
  EXPECT_TRUE(together.ior.empty() && together.iorGradient.empty());
  EXPECT_EQ(together.warnings.size(), 1u);
}
}
