// The balance of thick voxels in a medium that is spread over ranks, against that of the whole on one.

#include "BlocksOfLight.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace blocks_of_light;
using namespace tyndall;

/// Voxels of several mean free paths, which absorb little or nothing: the balance of voxels goes with the sweeps.
class ThickPropagationBlocks : public DeviceTest
{
protected:
  static PropagationSettings Accelerated()
  {
    PropagationSettings settings = SettingsOf(0);
    settings.acceleration = PropagationAcceleration::Automatic;
    settings.source = PropagationSource::Automatic;
    return settings;
  }
  static Illumination Diffuse()
  {
    Illumination shining = LitFromOutside();
    shining.lights.clear();
    return shining;
  }

  /// On several ranks that of a serial solve, to its tolerance, and on any number of them the same, to 1e-6 of the
  /// largest fluence.
  void ExpectTheLightOfTheWhole(const RandomMedium& whole, const Illumination& shining,
    const PropagationSettings& settings, const std::vector<BlockPartition>& partitions, double tolerance)
  {
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
    const LightField onTwo =
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 2), whole, shining, settings);
    EXPECT_TRUE(onTwo.converged);
    EXPECT_LE(onTwo.convergence.size(), expected.convergence.size() + 1);
    EXPECT_LT(LargestDifference(onTwo.fluence, expected.fluence), tolerance);
    EXPECT_LT(RelativeRmse(onTwo.netFlux, expected.netFlux), 2.0 * tolerance);
    EXPECT_LT(RelativeRmse(onTwo.fluenceDirect, expected.fluenceDirect), 1e-6);
    EXPECT_LE(LargestDifference(onTwo.facePower, expected.facePower), tolerance);
    EXPECT_LE(LargestDifference(onTwo.scatteredMoments, expected.scatteredMoments), tolerance);
    ExpectTheSurface(onTwo, expected, tolerance);
    ExpectEnergyKept(whole, expected);
    ExpectEnergyKept(whole, onTwo);
    for (std::size_t i = 0; i < partitions.size(); ++i)
    {
      SCOPED_TRACE("partition " + std::to_string(i));
      const LightField found = LightOfAll(GetDevice(), partitions[i], whole, shining, settings);
      EXPECT_EQ(found.convergence.size(), onTwo.convergence.size());
      EXPECT_LT(LargestDifference(found.fluence, onTwo.fluence), 1e-6);
      EXPECT_LT(RelativeRmse(found.netFlux, onTwo.netFlux), 1e-5);
      EXPECT_LE(LargestDifference(found.facePower, onTwo.facePower), 1e-6);
      EXPECT_LE(LargestDifference(found.scatteredMoments, onTwo.scatteredMoments), 1e-6);
      ExpectTheSurface(found, onTwo, 1e-6);
      ExpectEnergyKept(whole, found);
    }
  }
  /// What leaves thick voxels at the box's faces.
  static void ExpectTheSurface(const LightField& found, const LightField& expected, double tolerance)
  {
    EXPECT_EQ(found.surfaceRadiance.empty(), expected.surfaceRadiance.empty());
    EXPECT_LE(LargestDifference(found.surfaceRadiance, expected.surfaceRadiance), tolerance);
  }
  static void ExpectEnergyKept(const RandomMedium& whole, const LightField& light)
  {
    EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
    EXPECT_GE(*std::min_element(light.fluence.begin(), light.fluence.end()), 0.0f);
    const Field& sigma_a = whole.medium.sigma_a;
    for (int c = 0; c < light.channels; ++c)
    {
      double absorbed = 0.0;
      for (std::size_t i = 0; i < whole.medium.grid.VoxelCount(); ++i)
      {
        absorbed += sigma_a.At(i, c) * light.fluence[i * light.channels + c];
      }
      const EnergyBalance& balance = light.balance;
      EXPECT_NEAR(absorbed * whole.medium.grid.VoxelVolume(), balance.absorbed[c],
        1e-4 * (balance.entered[c] + balance.emitted[c]));
    }
  }
  /// Over the largest value.
  static double LargestDifference(const std::vector<float>& found, const std::vector<float>& expected)
  {
    double largest = 0.0, difference = found.size() == expected.size() ? 0.0 : HUGE_VAL;
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      largest = std::max<double>(largest, std::abs(expected[i]));
      difference = std::max<double>(difference, std::abs(found[i] - expected[i]));
    }
    return largest > 0.0 ? difference / largest : difference;
  }
  static std::vector<BlockPartition> OnRanks(const Grid& grid, const std::vector<int>& ranks)
  {
    std::vector<BlockPartition> partitions;
    for (const int count : ranks)
    {
      partitions.push_back(BlockPartition::Even(grid, count));
    }
    return partitions;
  }
};

TEST_F(ThickPropagationBlocks, ConvergeInAWhiteCube)
{
  for (const float perVoxel : { 4.0f, 10.0f })
  {
    SCOPED_TRACE(std::to_string(perVoxel) + " a voxel");
    RandomMedium whole(Grid{ { 16, 16, 16 } }, 1, 1.0f);
    std::fill(whole.absorption.begin(), whole.absorption.end(), 0.0f);
    std::fill(whole.scattering.begin(), whole.scattering.end(), perVoxel);
    whole.Emit(0.0f);
    ExpectTheLightOfTheWhole(whole, Diffuse(), Accelerated(), OnRanks(whole.medium.grid, { 3, 8 }), 1e-4);
  }
}

/// Blocks that end anywhere, of one voxel, and none; voxels of all thicknesses beside each other, void too.
TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeInUnevenBlocksOfAnyMedium)
{
  RandomMedium whole(Grid{ { 9, 7, 6 }, { 1.0, 0.7, 1.6 } }, 3, 12.0f, 3);
  whole.Emit(0.3f);
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  const BlockPartition uneven = { whole.medium.grid,
    { { { 0, 0, 0 }, { 3, 7, 6 } }, {}, { { 3, 0, 0 }, { 1, 7, 6 } }, { { 4, 0, 0 }, { 5, 1, 1 } },
      { { 4, 0, 1 }, { 5, 1, 5 } }, { { 4, 1, 0 }, { 5, 6, 6 } } } };
  ExpectTheLightOfTheWhole(whole, Diffuse(), settings, { uneven, BlockPartition::Even(whole.medium.grid, 4) }, 1e-4);
}

TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeAlongFinerDirections)
{
  RandomMedium whole(Grid{ { 8, 7, 9 } }, 1, 8.0f, 4);
  Share(whole, 0.001f, 0.999f);
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  for (const int perFace : { 36, -1 })
  {
    SCOPED_TRACE(std::to_string(perFace) + " directions a face");
    settings.uncollidedDirections = perFace;
    ExpectTheLightOfTheWhole(whole, Diffuse(), settings, OnRanks(whole.medium.grid, { 3 }), 1e-4);
  }
}

TEST_F(ThickPropagationBlocks, GoOnInBlocksOfOneVoxelBesideRanksWithout)
{
  RandomMedium whole(Grid{ { 2, 2, 1 } }, 1, 12.0f, 6);
  whole.Emit(0.3f);
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  ExpectTheLightOfTheWhole(whole, Diffuse(), settings, OnRanks(whole.medium.grid, { 6 }), 1e-4);
}

/// Beside opaque voxels in thin gas the systems' solution is negative.
TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeBesideOpaqueVoxels)
{
  RandomMedium whole(Grid{ { 9, 8, 7 } }, 1, 1.0f);
  whole.SpreadOverDecades(1e4, 8.0, 0.8, 5);
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  settings.tolerance = 1e-6;
  ExpectTheLightOfTheWhole(whole, Diffuse(), settings, OnRanks(whole.medium.grid, { 3 }), 1e-4);
}

/// A beam that slants through voxels of all thicknesses, in colour: it is scattered near the faces it comes through.
TEST_F(ThickPropagationBlocks, HaveTheLightOfLampsThatIsScatteredNearFaces)
{
  RandomMedium whole(Grid{ { 8, 7, 9 } }, 3, 8.0f, 4);
  whole.Emit(0.0f);
  Share(whole, 0.001f, 0.999f);
  Illumination shining = LitFromOutside();
  shining.lights[0].power = { 1.0, 0.0, 3.0 };
  ExpectTheLightOfTheWhole(whole, shining, Accelerated(), OnRanks(whole.medium.grid, { 3, 8 }), 1e-4);
  for (const Light& lamp : NearLamps())
  {
    SCOPED_TRACE("a lamp at " + std::to_string(lamp.position[0]));
    shining.lights = { lamp };
    ExpectTheLightOfTheWhole(whole, shining, Accelerated(), OnRanks(whole.medium.grid, { 8 }), 1e-4);
  }
}

namespace
{
/// Cut into blocks that end anywhere, of one voxel's width, and none.
BlockPartition Anyhow(const Grid& grid)
{
  const auto [x, y, z] = grid.size;
  return { grid,
    { { { 0, 0, 0 }, { x / 2, y, z } }, {}, { { x / 2, 0, 0 }, { 1, y, z } },
      { { x / 2 + 1, 0, 0 }, { x - x / 2 - 1, 1, z } }, { { x / 2 + 1, 1, 0 }, { x - x / 2 - 1, y - 1, z } } } };
}
}

/// Faces that give back part of the light or all of it, in colour, lit from outside, by the medium and by a beam that
/// is scattered near the faces.
TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeBetweenFacesThatGiveBackLight)
{
  RandomMedium whole(Grid{ { 7, 6, 5 }, { 1.0, 0.7, 1.6 } }, 3, 6.0f, 8);
  whole.Emit(0.3f);
  Illumination shining = LitFromOutside();
  shining.lights[0].power = { 1.0, 0.0, 3.0 };
  shining.faceAlbedo[1] = { 0.9, 0.1, 0.5 };
  shining.faceAlbedo[3] = { 0.6, 0.6, 0.6 };
  shining.faceAlbedo[4] = { 1.0, 1.0, 1.0 };
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  std::vector<BlockPartition> partitions = OnRanks(whole.medium.grid, { 2, 3 });
  partitions.push_back(Anyhow(whole.medium.grid));
  ExpectTheLightOfTheWhole(whole, shining, settings, partitions, 1e-4);
}

/// Between faces that give back light, and without any. A beam round few thick voxels takes a minute.
TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeRoundPeriodicAxes)
{
  RandomMedium whole(Grid{ { 4, 3, 5 }, { 1.0, 0.7, 1.6 } }, 1, 6.0f, 9);
  whole.Emit(0.3f);
  Illumination shining = Diffuse();
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  shining.faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  settings.periodic = { true, false, false };
  ExpectTheLightOfTheWhole(whole, shining, settings, { Anyhow(whole.medium.grid) }, 1e-4);
  settings.periodic = { true, true, true };
  ExpectTheLightOfTheWhole(whole, Illumination(), settings, OnRanks(whole.medium.grid, { 3 }), 1e-4);
}

/// In colour with a beam that is scattered near faces, and round a periodic axis between faces that give back light.
TEST_F(ThickPropagationBlocks, HaveTheLightOfTheWholeInAngularMoments)
{
  RandomMedium whole(Grid{ { 6, 5, 4 }, { 1.0, 0.7, 1.6 } }, 3, 6.0f, 10);
  whole.Emit(0.3f);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  PropagationSettings settings = Accelerated();
  settings.source = PropagationSource::Linear;
  settings.angularDegree = 2;
  settings.storeMoments = true;
  settings.tolerance = 1e-5; // at 1e-4 rounding moves the last orders by as much as is asked here
  ExpectTheLightOfTheWhole(
    whole, LitFromOutside(), settings, { BlockPartition::Even(whole.medium.grid, 2), Anyhow(whole.medium.grid) }, 1e-4);
  RandomMedium grey(Grid{ { 4, 3, 5 } }, 1, 6.0f, 11);
  grey.Emit(0.3f);
  grey.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  Illumination shining = Diffuse();
  shining.faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  settings.periodic = { false, true, false };
  ExpectTheLightOfTheWhole(grey, shining, settings, OnRanks(grey.medium.grid, { 3 }), 1e-4);
}
