// A sweep in angular moments against one sweep for each direction.

#include "DeviceTest.h"
#include "Difference.h"
#include "RandomMedium.h"

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"
#include "LightPropagation/Sweep/SweepInMemory.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
/// A box of random voxels, and a source of random moments, some of beams.
struct SweepScene
{
  SweepScene(Device& device, const Grid& grid, int channels, int degree, int perFace, int beams,
    const std::array<bool, 3>& periodicAxes, int extinctions = 1)
    : theDevice(device)
    , medium(grid, extinctions, 0.7f, 20261122)
    , set(FittedDirections(perFace))
    , basis(set, degree)
    , layout({ grid, channels, extinctions == 1 })
    , scattering(medium.medium, 0, channels)
    , onDevice(device, medium.medium, scattering, layout, { true, false })
    , periodic(periodicAxes)
  {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    angular.degree = degree;
    for (const Direction& direction : set.directions)
    {
      angular.functions.push_back(basis.At(direction.omega));
      std::vector<double> ofBeams(beams);
      std::generate(ofBeams.begin(), ofBeams.end(), [&] { return 1.0 + unit(random); });
      angular.beams.push_back(ofBeams);
    }
    source.assign(layout.MomentFloats(basis.Count(), beams), 0.0f);
    for (int q = 0; q < basis.Count() + beams; ++q)
    {
      for (int c = 0; c < channels; ++c)
      {
        for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
        {
          source[Place(q, c, i)] = static_cast<float>(q == 0 ? 2.0 : unit(random) / (q + 1));
        }
      }
    }
  }

  /// @param function  or behind them a beam
  std::size_t Place(int function, int channel, std::size_t voxel) const
  {
    const MomentPlaces places = layout.Places(basis.Count());
    const int beam = std::max(function - basis.Count(), 0);
    const std::size_t plain = (static_cast<std::size_t>(beam) * layout.channels + channel) * layout.Stride() + voxel;
    return function == 0         ? plain
      : function < basis.Count() ? VolumeLayout::MomentPlace(places, function, channel, voxel)
                                 : places.beams + plain;
  }

  std::vector<AxisBundles> Rays(const std::function<bool(int)>& isLit) const
  {
    std::vector<AxisBundles> rays;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<Bundle> all = BundlesAlong(axis, layout.grid, periodic, set, 1);
      for (int way = 0; way < 2; ++way)
      {
        rays.push_back({ axis, LitRays(all, way, isLit) });
      }
    }
    return rays;
  }

  struct Found
  {
    std::vector<float> path, currents;
    SweepTally tally;
  };

  /// @param ways  of SweepOnGpu; none: SweepInMemory
  Found Sweep(const std::vector<float>& ofSource, const std::vector<AxisBundles>& rays, const AngularValues* values,
    std::optional<SweepOnGpu::Ways> ways = {})
  {
    SweepWorkspace workspace;
    return SweepOn(theDevice, workspace, ofSource, rays, values, ways);
  }

  /// By the sweep for GPUs, with the volume in host memory: through slots in which anything was left.
  Found SweepInSlices(
    const std::vector<float>& ofSource, const std::vector<AxisBundles>& rays, const AngularValues* values)
  {
    constexpr std::size_t MoreThanAll = 1 << 18;
    const std::size_t before = theDevice.BytesInUse();
    Found found;
    setenv("TYNDALL_WITHOUT", "host_memory", 1); // copies, as of a device with memory of its own
    {
      Device streaming(theDevice, { 1, true, sizeof(float) * layout.grid.VoxelCount() });
      SweepWorkspace workspace;
      for (Buffer<float>& slots : workspace.slots)
      {
        ReserveOnDevice(streaming, slots, MoreThanAll, "slots");
        slots.Fill(1e30f);
      }
      found = SweepOn(streaming, workspace, ofSource, rays, values, SweepOnGpu::Ways::Automatic);
    }
    unsetenv("TYNDALL_WITHOUT");
    EXPECT_EQ(theDevice.BytesInUse(), before);
    return found;
  }

  Found SweepOn(Device& device, SweepWorkspace& workspace, const std::vector<float>& ofSource,
    const std::vector<AxisBundles>& rays, const AngularValues* values, std::optional<SweepOnGpu::Ways> ways)
  {
    const int functions = values ? basis.Count() : 1;
    Buffer<float> shines(device, ofSource, "source");
    Buffer<float> path(device, layout.MomentFloats(functions), "path");
    Buffer<float> currents(device, layout.Floats(6), "currents");
    path.Fill(0.0f);
    currents.Fill(0.0f);
    SweepRequest request = { { &path, nullptr, &currents, nullptr }, rays };
    request.angular = values;
    std::unique_ptr<SweepOperator> sweep;
    if (ways)
    {
      sweep = std::make_unique<SweepOnGpu>(device, layout, onDevice.SigmaT(), periodic, request, workspace, *ways);
    }
    else
    {
      sweep = std::make_unique<SweepInMemory>(device, layout, onDevice.SigmaT(), periodic, request, workspace);
    }
    const SweepBoundary boundary = [this](int d, int face) { return Rgb{ 1.0 + 0.1 * face, 0.5, 0.01 * (d % 7) }; };
    const SweepTally tally = sweep->Apply(&shines, boundary, {});
    return { this->OfVoxels(path.Read(), functions), currents.Read(), tally };
  }

  /// Zero beyond the voxels of rows, where rays may have left anything.
  std::vector<float> OfVoxels(const std::vector<float>& moments, int functions) const
  {
    std::vector<float> kept(moments.size(), 0.0f);
    for (int q = 0; q < functions; ++q)
    {
      for (int c = 0; c < layout.channels; ++c)
      {
        for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
        {
          kept[Place(q, c, i)] = moments[Place(q, c, i)];
        }
      }
    }
    return kept;
  }

  /// The source in one direction, as that of light that shines alike everywhere.
  std::vector<float> SourceAlong(int direction) const
  {
    std::vector<float> along(layout.Floats(), 0.0f);
    for (int c = 0; c < layout.channels; ++c)
    {
      for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
      {
        double sum = 0.0;
        for (int q = 0; q < basis.Count(); ++q)
        {
          sum += angular.functions[direction][q] * source[Place(q, c, i)];
        }
        for (int b = 0; b < angular.Beams(); ++b)
        {
          sum += angular.beams[direction][b] * source[Place(basis.Count() + b, c, i)];
        }
        along[Place(0, c, i)] = static_cast<float>(sum);
      }
    }
    return along;
  }

  /// The moments of single sweeps for each direction.
  Found SweepOneByOne()
  {
    Found all;
    all.path.assign(layout.MomentFloats(basis.Count()), 0.0f);
    all.currents.assign(layout.Floats(6), 0.0f);
    for (int d = 0; d < static_cast<int>(set.directions.size()); ++d)
    {
      const Found one = Sweep(SourceAlong(d), Rays([d](int direction) { return direction == d; }), nullptr);
      for (int q = 0; q < basis.Count(); ++q)
      {
        for (int c = 0; c < layout.channels; ++c)
        {
          for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
          {
            all.path[Place(q, c, i)] += static_cast<float>(angular.functions[d][q] * one.path[Place(0, c, i)]);
          }
        }
      }
      for (std::size_t i = 0; i < all.currents.size(); ++i)
      {
        all.currents[i] += one.currents[i];
      }
      Add(all.tally, one.tally);
    }
    return all;
  }

  Device& theDevice;
  RandomMedium medium;
  DirectionSet set;
  AngularBasis basis;
  VolumeLayout layout;
  TruncatedScattering scattering;
  MediumOnDevice onDevice;
  std::array<bool, 3> periodic;
  AngularValues angular;
  std::vector<float> source;
};
}

class AngularSweep : public DeviceTest
{
protected:
  /// By the sweep for CPUs, and by that for GPUs in these ways: each compiles kernels for seconds.
  void ExpectSameAsOneByOne(
    SweepScene& scene, const std::vector<SweepOnGpu::Ways>& waysOnGpu = { SweepOnGpu::Ways::Automatic })
  {
    const auto all = [](int) { return true; };
    const std::vector<AxisBundles> rays = scene.Rays(all);
    const SweepScene::Found expected = scene.SweepOneByOne();
    ExpectSame(scene.Sweep(scene.source, rays, &scene.angular), expected, scene.layout.channels, "for CPUs");
    for (const SweepOnGpu::Ways ways : waysOnGpu)
    {
      const SweepScene::Found found = scene.Sweep(scene.source, rays, &scene.angular, ways);
      ExpectSame(found, expected, scene.layout.channels,
        ways == SweepOnGpu::Ways::OneByOne ? "for GPUs, way by way" : "for GPUs, all ways at once");
    }
    ExpectSame(
      scene.SweepInSlices(scene.source, rays, &scene.angular), expected, scene.layout.channels, "for GPUs, in slices");
  }

  static void ExpectSame(
    const SweepScene::Found& found, const SweepScene::Found& expected, int channels, const char* what)
  {
    EXPECT_LT(RelativeRmse(found.path, expected.path), 2e-6) << what;
    EXPECT_LT(RelativeRmse(found.currents, expected.currents), 2e-6) << what;
    EXPECT_NEAR(Sum(found.tally.onTheWay), Sum(expected.tally.onTheWay), 1e-5 * Sum(expected.tally.onTheWay)) << what;
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < channels; ++c)
      {
        EXPECT_NEAR(found.tally.in[face][c], expected.tally.in[face][c], 1e-6 * expected.tally.in[face][c]) << what;
        EXPECT_NEAR(found.tally.out[face][c], expected.tally.out[face][c], 1e-5 * expected.tally.out[face][c]) << what;
      }
    }
  }
};

TEST_F(AngularSweep, OfDegreeThreeIsTheSumOverDirections)
{
  SweepScene scene(this->GetDevice(), Grid{ { 7, 20, 5 } }, 1, 3, 25, 0, {});
  this->ExpectSameAsOneByOne(scene);
}

TEST_F(AngularSweep, OfThreeChannelsAndUnequalVoxelsIsTheSumOverDirections)
{
  Grid grid{ { 9, 6, 11 } };
  grid.spacing = { 1.0, 0.7, 1.6 };
  SweepScene scene(this->GetDevice(), grid, 3, 2, 16, 0, {});
  this->ExpectSameAsOneByOne(scene, { SweepOnGpu::Ways::Automatic, SweepOnGpu::Ways::OneByOne });
}

TEST_F(AngularSweep, OfThreeExtinctionsIsTheSumOverDirections)
{
  SweepScene scene(this->GetDevice(), Grid{ { 5, 8, 6 } }, 3, 1, 9, 1, {}, 3);
  this->ExpectSameAsOneByOne(scene, { SweepOnGpu::Ways::Automatic, SweepOnGpu::Ways::OneByOne });
}

TEST_F(AngularSweep, WithBeamsIsTheSumOverDirections)
{
  SweepScene scene(this->GetDevice(), Grid{ { 8, 5, 21 } }, 1, 1, 9, 2, {});
  this->ExpectSameAsOneByOne(scene);
}

TEST_F(AngularSweep, RoundPeriodicAxesIsTheSumOverDirections)
{
  SweepScene scene(this->GetDevice(), Grid{ { 6, 19, 7 } }, 1, 2, 4, 1, { false, true, false });
  this->ExpectSameAsOneByOne(scene);
}

TEST_F(AngularSweep, GathersWhatItsSourceShines)
{
  // Without anything that is lost on the way in, path times sigma and what leaves add up to the source.
  SweepScene scene(this->GetDevice(), Grid{ { 12, 9, 10 } }, 1, 3, 25, 0, {});
  const auto all = [](int) { return true; };
  const SweepScene::Found found = scene.Sweep(scene.source, scene.Rays(all), &scene.angular);
  double in = 0.0, out = 0.0;
  for (std::size_t i = 0; i < scene.layout.grid.VoxelCount(); ++i)
  {
    in += 4.0 * Pi * scene.source[i];
    out += scene.medium.medium.TransportSigmaT(i, 0) * static_cast<double>(found.path[i]);
  }
  for (int face = 0; face < 6; ++face)
  {
    in += found.tally.in[face][0];
    out += found.tally.out[face][0];
  }
  EXPECT_NEAR(out / in, 1.0, 2e-6);
}
