// The sweep for GPUs beside the sweep for CPUs, on whatever device there is.

#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"
#include "RandomMedium.h"

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"
#include "LightPropagation/Sweep/SweepInMemory.h"
#include "Medium/BoxFaces.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

using namespace tyndall;

namespace
{
constexpr double Same = 1e-5;       ///< of the largest value
constexpr std::size_t OfPlanes = 1; ///< bytes: rays lie in host memory, too, and slots are of one plane each

/// A further sweep of the same operator.
enum class Next
{
  Shining,
  InTheDark,
  Lit,       ///< as the first: with a boundary
  Forgetting ///< shining, once all that is on its way is forgotten
};

/// A box of random voxels and how it is swept.
struct Sweeping
{
  Grid grid{ { 9, 6, 7 } };
  int components = 1; ///< of sigma_t
  int channels = 1;
  float densest = 0.7f;
  int perFace = 25;
  bool shines = true, lit = true, flux = false, currents = false, byOctant = false;
  bool faceIn = false, faceOut = false, spreadsAside = false; ///< light comes in, and leaves, by cells
  VoxelBox box = {};
  std::array<bool, 3> periodic = {};
  int mostPlanes = MostPlanesAround;
  std::vector<Next> sweeps = {};   ///< behind the first: rays stay on their way round periodic axes
  std::array<double, 3> beam = {}; ///< instead of all directions
};

struct Found
{
  std::vector<float> path, flux, currents, cells;
  SweepTally tally;
};

std::vector<AxisBundles> RaysOf(const Sweeping& how)
{
  std::vector<AxisBundles> rays;
  if (how.beam != std::array<double, 3>{})
  {
    const int axis = MarchingAxes(how.grid, how.beam).front();
    rays.push_back({ axis, BeamAlong(axis, how.grid, {}, how.beam, 2) });
    return rays;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    rays.push_back({ axis, BundlesAlong(axis, how.grid, how.periodic, FittedDirections(how.perFace), 1) });
  }
  return rays;
}
}

class SweepOnGpuTest : public DeviceTest
{
protected:
  /// @param ways  of SweepOnGpu; none: SweepInMemory
  Found Sweep(const Sweeping& how, std::optional<SweepOnGpu::Ways> ways) { return Sweep(this->GetDevice(), how, ways); }

  /// The volume in host memory, of which slices go through the device.
  /// @param bytes  for rays and slots; where there is too little for these, a slot is a plane
  Found SweepInSlices(const Sweeping& how, std::size_t bytes)
  {
    setenv("TYNDALL_WITHOUT", "host_memory", 1); // copies, as of a device with memory of its own
    MemoryBudget budget;
    budget.bytes = bytes;
    budget.spills = true;
    budget.hostFrom = sizeof(float) * how.grid.VoxelCount();
    Device streaming(this->GetDevice(), budget);
    Found found = Sweep(streaming, how, SweepOnGpu::Ways::Automatic);
    unsetenv("TYNDALL_WITHOUT");
    return found;
  }

  static Found Sweep(Device& device, const Sweeping& how, std::optional<SweepOnGpu::Ways> ways)
  {
    const RandomMedium medium(how.grid, how.components, how.densest, 20261126);
    const VolumeLayout layout = { how.grid, how.channels, how.components == 1 };
    const TruncatedScattering scattering(medium.medium, 0, how.channels);
    const MediumOnDevice onDevice(device, medium.medium, scattering, layout, { true, false });
    const Buffer<float> source = PlanarOnDevice(
      device, layout, how.channels, [&](std::size_t i, int c) { return static_cast<float>((7 * i + c) % 11); },
      "source");
    Buffer<float> path(device, layout.Floats(), "path"), flux(device, layout.Floats(3), "flux"),
      currents(device, layout.Floats(6), "currents");
    path.Fill(1.0f); // is added to
    flux.Fill(0.0f);
    currents.Fill(0.0f);
    SweepWorkspace workspace;
    SweepRequest request = { { &path, how.flux ? &flux : nullptr, how.currents ? &currents : nullptr }, RaysOf(how) };
    request.box = how.box;
    request.mostPlanes = how.mostPlanes;
    const Buffer<float> octants = OctantsOf(device, layout);
    request.octantSource = how.byOctant ? &octants : nullptr;
    const Buffer<float> faceIn = CellsOf(device, layout);
    Buffer<float> faceOut(device, faceIn.Size(), "cells");
    faceOut.Fill(0.0f);
    request.faceIn = how.faceIn ? &faceIn : nullptr;
    request.deposit.faceOut = how.faceOut ? &faceOut : nullptr;
    request.deposit.spreadsAside = how.spreadsAside;
    std::unique_ptr<SweepOperator> sweep;
    if (ways)
    {
      sweep = std::make_unique<SweepOnGpu>(device, layout, onDevice.SigmaT(), how.periodic, request, workspace, *ways);
    }
    else
    {
      sweep = std::make_unique<SweepInMemory>(device, layout, onDevice.SigmaT(), how.periodic, request, workspace);
    }
    const SweepBoundary boundary = [](int d, int face) { return Rgb{ 1.0 + 0.3 * face, 0.5 + d % 3, 0.1 * (d % 7) }; };
    Found found;
    found.tally = sweep->Apply(how.shines ? &source : nullptr, how.lit ? boundary : SweepBoundary(), {});
    for (const Next next : how.sweeps)
    {
      if (next == Next::Forgetting)
      {
        sweep->Forget();
      }
      found.tally =
        sweep->Apply(next == Next::InTheDark ? nullptr : &source, next == Next::Lit ? boundary : SweepBoundary(), {});
    }
    found.path = path.Read();
    found.flux = flux.Read();
    found.currents = currents.Read();
    found.cells = faceOut.Read();
    return found;
  }

  /// Light that comes in, other through each cell.
  static Buffer<float> CellsOf(Device& device, const VolumeLayout& layout)
  {
    std::vector<float> light(layout.channels * BoxFaceCellCount(layout.grid));
    for (std::size_t i = 0; i < light.size(); ++i)
    {
      light[i] = 0.3f * static_cast<float>((5 * i) % 11);
    }
    return { device, light, "light by cells" };
  }

  /// By how much more, or less, voxels shine into each octant.
  static Buffer<float> OctantsOf(Device& device, const VolumeLayout& layout)
  {
    std::vector<float> more(8 * layout.Floats(), 0.0f);
    for (int row = 0; row < 8 * layout.channels; ++row)
    {
      for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
      {
        more[row * layout.Stride() + i] = 0.2f * static_cast<float>((5 * i + 3 * row) % 13) - 1.0f;
      }
    }
    return { device, more, "sources by octant" };
  }

  static void ExpectSame(const Found& found, const Found& expected, const char* what)
  {
    EXPECT_LT(RelativeDifference(found.path, expected.path), Same) << what;
    EXPECT_LT(RelativeDifference(found.flux, expected.flux), Same) << what;
    EXPECT_LT(RelativeDifference(found.currents, expected.currents), Same) << what;
    EXPECT_LT(RelativeDifference(found.cells, expected.cells), Same) << what;
    const double onTheWay = Sum(expected.tally.onTheWay);
    EXPECT_NEAR(Sum(found.tally.onTheWay), onTheWay, 1e-5 * onTheWay) << what;
    double out = 0.0;
    for (const Rgb& rgb : expected.tally.out)
    {
      out = std::max(out, Sum(rgb));
    }
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(found.tally.in[face][c], expected.tally.in[face][c], 1e-12) << what;
        EXPECT_NEAR(found.tally.out[face][c], expected.tally.out[face][c], 1e-6 * out) << what << ", face " << face;
      }
    }
  }

  /// The device once more, taken as a GPU.
  std::shared_ptr<Device> AsGpu() const
  {
    const cl::Device device = this->TheDevice->Context().getInfo<CL_CONTEXT_DEVICES>().front();
    setenv("TYNDALL_AS_GPU", "1", 1);
    const auto asGpu = std::make_shared<Device>(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()), device);
    unsetenv("TYNDALL_AS_GPU");
    return asGpu;
  }

  void Compare(const Sweeping& how)
  {
    const Found expected = this->Sweep(how, {});
    ExpectSame(this->Sweep(how, SweepOnGpu::Ways::Automatic), expected, "all ways at once");
    ExpectSame(this->Sweep(how, SweepOnGpu::Ways::OneByOne), expected, "way by way");
    ExpectSame(this->SweepInSlices(how, OfPlanes), expected, "in slices");
  }
};

struct NamedSweeping
{
  const char* name;
  std::function<void(Sweeping&)> change;
};

class SweptOnGpu
  : public SweepOnGpuTest
  , public testing::WithParamInterface<NamedSweeping>
{
};

TEST_P(SweptOnGpu, FindsTheLight)
{
  Sweeping how;
  this->GetParam().change(how);
  this->Compare(how);
}

INSTANTIATE_TEST_SUITE_P(Of, SweptOnGpu,
  testing::ValuesIn<NamedSweeping>({
    { "ASource", [](Sweeping& how) { how.lit = false; } },
    { "ABoundary", [](Sweeping& how) { how.shines = false; } },
    { "FluxAndCurrents", [](Sweeping& how) { how.flux = how.currents = true; } },
    { "ThreeColoursOfOneExtinction",
      [](Sweeping& how) {
        how.channels = 3;
        how.flux = how.currents = true;
      } },
    { "ThreeColoursOfThreeExtinctions",
      [](Sweeping& how) {
        how.components = how.channels = 3;
        how.flux = how.currents = true;
      } },
    { "ABoundaryByOctant",
      [](Sweeping& how) {
        how.byOctant = true;
        how.shines = false;
      } },
    { "ForgottenRays",
      [](Sweeping& how) {
        how.periodic = { false, true, true };
        how.mostPlanes = 256;
        how.densest = 0.02f;
        how.sweeps = { Next::Shining, Next::Lit, Next::Forgetting, Next::InTheDark };
      } },
    { "UnequalVoxels",
      [](Sweeping& how) {
        how.grid.spacing = { 1.0, 0.7, 1.6 };
        how.flux = how.currents = true;
      } },
    { "ASlabOneVoxelWide",
      [](Sweeping& how) {
        how.grid.size = { 1, 40, 3 };
        how.currents = true;
      } },
    { "ABeam",
      [](Sweeping& how) {
        how.beam = { 0.3, -0.5, std::sqrt(1.0 - 0.34) };
        how.flux = how.currents = true;
        how.shines = false;
      } },
    { "APartOfTheGrid",
      [](Sweeping& how) {
        how.box = { { 2, 1, 3 }, { 4, 5, 3 } };
        how.flux = true;
      } },
    { "OneDirectionAFace",
      [](Sweeping& how) {
        how.perFace = 1; // moves both ways at once
        how.flux = how.currents = true;
      } },
    { "DirectionsOnDiagonals",
      [](Sweeping& how) {
        how.perFace = 121; // not fitted
        how.flux = how.currents = true;
      } },
  }),
  [](const auto& info) { return info.param.name; });

TEST_F(SweepOnGpuTest, FindsTheLightOfASourceByOctant)
{
  struct Colours
  {
    int extinctions, channels;
  };
  for (const int perFace : { 25, 121 }) // some of 121 go between octants
  {
    for (const Colours colours : { Colours{ 1, 1 }, { 1, 3 }, { 3, 3 } })
    {
      Sweeping how;
      how.perFace = perFace;
      how.components = colours.extinctions;
      how.channels = colours.channels;
      how.densest = 3.0f;
      how.flux = how.currents = how.byOctant = true;
      this->Compare(how);
    }
  }
}

/// From one direction a face too, whose rays move both ways at once: through edges of the grid.
TEST_F(SweepOnGpuTest, FindsTheLightByCellsOfFaces)
{
  for (const int perFace : { 25, 1, 16 })
  {
    Sweeping how;
    how.perFace = perFace;
    how.channels = 3;
    how.faceOut = true;
    this->Compare(how); // comes in alike
    how.faceIn = how.currents = true;
    how.spreadsAside = perFace != 1;
    this->Compare(how);
    how.components = 3;
    how.lit = how.shines = false;
    how.spreadsAside = false;
    this->Compare(how); // by cells alone
  }
}

TEST_F(SweepOnGpuTest, FindsTheLightByCellsOfFacesRoundPeriodicAxes)
{
  for (const std::array<bool, 3>& periodic : { std::array<bool, 3>{ false, true, false }, { true, false, true } })
  {
    Sweeping how;
    how.periodic = periodic;
    how.perFace = 16;
    how.faceIn = how.faceOut = how.spreadsAside = true;
    this->Compare(how);
    how.spreadsAside = false;
    how.densest = 0.02f;
    how.mostPlanes = 256;
    how.sweeps = { Next::Shining, Next::InTheDark };
    this->Compare(how);
  }
}

/// Round one axis of few planes, two and three: rays start in laps, come in sideways, and are on their way between
/// sweeps.
TEST_F(SweepOnGpuTest, FindsTheLightRoundPeriodicAxes)
{
  for (const std::array<bool, 3>& periodic :
    { std::array<bool, 3>{ false, true, false }, { true, false, true }, { true, true, true } })
  {
    Sweeping how;
    how.periodic = periodic;
    how.flux = how.currents = true;
    how.channels = 3;
    this->Compare(how);
    how.components = 3;
    how.mostPlanes = 256;
    how.densest = 0.02f;
    how.sweeps = { Next::InTheDark, Next::InTheDark }; // but what is on its way goes on
    this->Compare(how);
  }
}

TEST_F(SweepOnGpuTest, FindsTheLightInThickAndThinVoxels)
{
  for (const float densest : { 0.0f, 1e-4f, 0.9f, 3.0f, 1e6f })
  {
    Sweeping how;
    how.densest = densest;
    how.flux = true;
    this->Compare(how);
  }
}

TEST_F(SweepOnGpuTest, IsTheSameEachTime)
{
  for (const bool periodic : { false, true })
  {
    Sweeping how;
    how.flux = how.currents = true;
    how.periodic = { periodic, false, periodic };
    const Found once = this->Sweep(how, SweepOnGpu::Ways::Automatic),
                again = this->Sweep(how, SweepOnGpu::Ways::Automatic);
    EXPECT_EQ(once.path, again.path);
    EXPECT_EQ(once.flux, again.flux);
    EXPECT_EQ(once.currents, again.currents);
  }
}

/// Whole, all ways at once and one after the other, and in slices: of more planes than one, and of one.
TEST_F(SweepOnGpuTest, IsTheSameBitForBitInSlices)
{
  for (const int channels : { 1, 3 })
  {
    Sweeping how;
    how.grid.size = { 19, 6, 40 };
    how.channels = channels;
    how.flux = how.currents = how.byOctant = true;
    const Found whole = this->Sweep(how, SweepOnGpu::Ways::Automatic);
    for (const Found& found : { this->Sweep(how, SweepOnGpu::Ways::OneByOne), this->SweepInSlices(how, OfPlanes),
           this->SweepInSlices(how, std::size_t(1) << 18) })
    {
      EXPECT_EQ(found.path, whole.path);
      EXPECT_EQ(found.flux, whole.flux);
      EXPECT_EQ(found.currents, whole.currents);
      EXPECT_EQ(found.tally.out, whole.tally.out);
    }
  }
}

TEST_F(SweepOnGpuTest, KeepsEveryWatt)
{
  Sweeping how;
  how.grid.size = { 12, 11, 10 };
  const Found found = this->Sweep(how, SweepOnGpu::Ways::Automatic);
  const RandomMedium medium(how.grid, 1, how.densest, 20261126);
  double in = 0.0, out = 0.0;
  for (std::size_t i = 0; i < how.grid.VoxelCount(); ++i)
  {
    in += 16.0 * std::atan(1.0) * static_cast<double>(7 * i % 11);
    out += medium.medium.TransportSigmaT(i, 0) * (static_cast<double>(found.path[i]) - 1.0);
  }
  for (int face = 0; face < 6; ++face)
  {
    in += found.tally.in[face][0];
    out += found.tally.out[face][0];
  }
  EXPECT_NEAR(out / in, 1.0, 1e-6);
}

TEST_F(SweepOnGpuTest, SolvesAsTheOtherDoes)
{
  for (const auto acceleration : { PropagationAcceleration::Automatic, PropagationAcceleration::None })
  {
    const std::shared_ptr<Device> asGpu = this->AsGpu();
    ASSERT_FALSE(asGpu->IsCpu());
    std::vector<float> fluence[2];
    for (int i = 0; i < 2; ++i)
    {
      ::Scene scene({ 13, 10, 11 });
      scene.Randomise(2.0, 2.0, 0.9);
      scene.ShineFromEverywhere(1.0);
      scene.ShineAlong({ 0.3, -0.4, -0.8 });
      scene.settings.acceleration = acceleration;
      fluence[i] = scene.Solve(i == 0 ? this->GetDevice() : *asGpu).fluence;
    }
    EXPECT_TRUE(fluence[0] != fluence[1] || !this->GetDevice().IsCpu()); // bit for bit: another sweep it was
    EXPECT_LT(RelativeDifference(fluence[1], fluence[0]), Same);
  }
}
