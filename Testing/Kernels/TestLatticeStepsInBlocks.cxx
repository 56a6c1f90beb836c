// Steps of a lattice in a medium that is spread over ranks, against those of the whole.

#include "LatticeInBlocks.h"

#include <algorithm>
#include <string>
#include <vector>

using namespace tyndall;
using namespace lattice_in_blocks;

class LatticeStepsInBlocks : public LatticeBlocks
{
protected:
  /// With steps that are stable as published, too.
  static MediumToCut Thin(std::array<int, 3> size)
  {
    MediumToCut medium = Everything(size);
    for (float& scattering : medium.scene.sigma_s)
    {
      scattering = std::min(scattering, 0.5f);
    }
    return medium;
  }

  static void ExpectSameSteps(const LightField& light, const LightField& whole)
  {
    ExpectSameLight(light, whole, 1e-6);
    EXPECT_EQ(light.convergence.size(), whole.convergence.size());
    EXPECT_EQ(light.convergence.back().iteration, whole.convergence.back().iteration);
    EXPECT_NEAR(light.convergence.back().residual, whole.convergence.back().residual, 1e-4);
    EXPECT_EQ(light.doubts, whole.doubts);
    const double all = whole.balance.entered[0] + whole.balance.emitted[0];
    EXPECT_NEAR(light.balance.leftOver[0], whole.balance.leftOver[0], 1e-6 * all);
  }
};

/// Counted, or until little changes at some voxels; as published, and round periodic axes.
TEST_F(LatticeStepsInBlocks, AreThoseOfTheWhole)
{
  MediumToCut medium = Thin({ 7, 5, 6 });
  medium.scene.light.faceAlbedo[0] = medium.scene.light.faceAlbedo[1] = {};
  LatticeSettings counted = SettingsOf(), settled = SettingsOf(1e-3), published = SettingsOf();
  counted.maximumSteps = 37;
  counted.periodic = { true, false, false };
  settled.solvesSteady = false;
  settled.probes = 20;
  published.scheme = LatticeScheme::Published;
  published.maximumSteps = 20;
  for (const LatticeSettings& settings : { counted, settled, published })
  {
    SCOPED_TRACE(std::to_string(settings.maximumSteps));
    const LightField whole = this->Whole(medium, settings);
    for (const BlockPartition& partition : { BlockPartition::Even(medium.scene.medium.grid, 1),
           BlockPartition::Even(medium.scene.medium.grid, 8), Slices(medium.scene.medium.grid, { 0, 1, 1 }) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSameSteps(this->OfBlocks(partition, medium, settings), whole);
    }
  }
}

/// Blocks of voxels that step by themselves begin where those of the whole do, wherever ranks' blocks are cut.
TEST_F(LatticeStepsInBlocks, AreThoseOfBlocksOfVoxels)
{
  MediumToCut medium = Thin({ 9, 5, 6 });
  medium.scene.light.faceAlbedo[0] = medium.scene.light.faceAlbedo[1] = {};
  LatticeSettings counted = SettingsOf(), settled = SettingsOf(1e-3);
  counted.scheme = LatticeScheme::Published;
  counted.blockSize = settled.blockSize = 4;
  counted.maximumSteps = 37;
  counted.stepsPerExchange = 5;
  settled.periodic = { true, false, false };
  settled.probes = 20;
  for (const LatticeSettings& settings : { counted, settled })
  {
    SCOPED_TRACE(std::to_string(settings.maximumSteps));
    const LightField whole = this->Whole(medium, settings);
    for (const BlockPartition& partition :
      { BlockPartition::Even(medium.scene.medium.grid, 3), Slices(medium.scene.medium.grid, { 0, 1, 2, 4 }) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSameSteps(this->OfBlocks(partition, medium, settings), whole);
    }
  }
}

/// Counted or settled, by blocks of voxels, too; of photons of a colour and of none.
TEST_F(LatticeStepsInBlocks, GoOnBesidePhotonsAsInTheWhole)
{
  MediumToCut medium = Thin({ 8, 7, 5 });
  medium.scene.light.lights.clear();
  const Grid& grid = medium.scene.medium.grid;
  std::vector<Photon> photons = AnyPhotons(300);
  LatticeSettings counted = SettingsOf(), settled = SettingsOf(1e-3);
  counted.interleaves = settled.interleaves = true;
  counted.stretches = 3;
  counted.stepsPerExchange = 4;
  counted.maximumSteps = 25;
  counted.blockSize = 4;
  settled.stretches = 5;
  for (const LatticeSettings& settings : { counted, settled })
  {
    SCOPED_TRACE(std::to_string(settings.maximumSteps));
    const LightField whole = this->Whole(medium, photons, settings);
    EXPECT_EQ(whole.channels, settings.maximumSteps > 0 ? 3 : 1);
    for (const BlockPartition& partition : { BlockPartition::Even(grid, 3), Slices(grid, { 0, 1 }) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSameSteps(this->OfBlocks(partition, medium, photons, settings), whole);
    }
    for (Photon& photon : photons)
    {
      photon.power.fill(0.02f);
    }
  }
}

/// Who goes on with photons, and who waits for them to end, is agreed on before any of them marches.
TEST_F(LatticeStepsInBlocks, AreAgreedOnBeforePhotonsMarch)
{
  const MediumToCut medium = Thin({ 6, 5, 4 });
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 2);
  std::vector<std::string> errors(2);
  RunInThreads(2, [&](Communicator& communicator) {
    const int rank = communicator.Rank();
    MediumToCut part = medium.Part(partition.blocks[rank]);
    part.Attach();
    LatticeSettings settings = SettingsOf();
    settings.interleaves = rank == 1;
    try
    {
      SolveLatticeInBlocks(this->GetDevice(), communicator, partition, part.scene.medium, part.Index(), AnyPhotons(9),
        part.scene.light, settings);
    }
    catch (const InvalidInput& error)
    {
      errors[rank] = error.what();
    }
  });
  EXPECT_NE(errors[0].find("disagree about settings"), std::string::npos) << errors[0];
  EXPECT_EQ(errors[0], errors[1]);
}
