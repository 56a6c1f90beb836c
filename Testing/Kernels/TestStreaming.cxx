// Volumes that are larger than what may be taken of the device: streamed through slots, the light is the same.

#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "MediumScene.h"
#include "RandomMedium.h"

#include "LightPropagation/Conservative/SolveMemory.h"

#include <algorithm>
#include <cstdlib>
#include <string>

using namespace tyndall;

namespace
{
/// As long as it lives the device does not work on host memory in place, but by copies, as one with memory of its own.
struct OwnMemory
{
  OwnMemory() { setenv("TYNDALL_WITHOUT", "host_memory", 1); }
  ~OwnMemory() { unsetenv("TYNDALL_WITHOUT"); }
};

const std::array<int, 3> SmallSize = { 40, 33, 27 }, LargeSize = { 128, 128, 128 };

/// Random voxels under a sun and a sky.
Scene RandomScene(const std::array<int, 3>& size)
{
  Scene scene(size);
  scene.medium.grid.spacing = { 1.0, 0.9, 1.1 };
  scene.Randomise(0.4, 2.0, 0.8);
  scene.ShineFromEverywhere(0.3);
  scene.ShineAlong({ 0.3, -0.5, -1.0 }, 2.0);
  scene.settings.directionsPerFace = 16;
  scene.settings.maximumOrders = 3;
  return scene;
}

/// Three colours, each with densities of its own.
void Colour(Scene& scene)
{
  const std::vector<float> sigma_a = scene.sigma_a, sigma_s = scene.sigma_s;
  scene.sigma_a.clear();
  scene.sigma_s.clear();
  for (std::size_t i = 0; i < sigma_a.size(); ++i)
  {
    for (float part : { 1.0f, 0.6f, 0.3f })
    {
      scene.sigma_a.push_back(part * sigma_a[i]);
      scene.sigma_s.push_back((1.2f - part) * sigma_s[i]);
    }
  }
}

/// Three colours that share sigma_t.
void ColourAlbedo(Scene& scene)
{
  Colour(scene);
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    scene.sigma_a[i] = 0.3f * static_cast<float>(1 + i % 3) / 4.0f;
    scene.sigma_s[i] = 0.3f - scene.sigma_a[i];
  }
}

/// Round periodic axes of GPUs to rounding: what is swept whole there is gathered in arrays of its own.
void ExpectSame(const Device& device, const Scene& scene, const LightField& light, const LightField& expected)
{
  const std::array<bool, 3>& periodic = scene.settings.periodic;
  if (!device.IsCpu() && std::count(periodic.begin(), periodic.end(), true) > 0)
  {
    EXPECT_LT(RelativeRmse(light.fluence, expected.fluence), 1e-6);
    EXPECT_EQ(light.convergence.size(), expected.convergence.size());
    return;
  }
  EXPECT_TRUE(light.fluence == expected.fluence);
  EXPECT_TRUE(light.fluenceDirect == expected.fluenceDirect);
  EXPECT_TRUE(light.netFlux == expected.netFlux);
  EXPECT_TRUE(light.facePower == expected.facePower);
  EXPECT_TRUE(light.scatteredMoments == expected.scatteredMoments);
  EXPECT_EQ(light.balance.absorbed, expected.balance.absorbed);
  EXPECT_EQ(light.balance.escaped, expected.balance.escaped);
  EXPECT_EQ(light.convergence.size(), expected.convergence.size());
}

class Streaming : public DeviceTest
{
protected:
  /// Solves a scene whole and within parts of what that took.
  void ExpectSameLight(Scene scene, std::initializer_list<int> parts)
  {
    Device& device = this->GetDevice();
    const std::size_t before = device.BytesInUse();
    device.ResetPeak();
    const LightField whole = scene.Solve(device);
    const std::size_t taken = device.PeakBytes() - before;
    EXPECT_EQ(whole.device, device.Name());
    const PropagationProblem problem(scene.medium, scene.light, scene.settings);
    const std::size_t bytes = BytesOfSolve(device, problem, ChooseIterationScheme(problem));
    EXPECT_TRUE(!device.IsCpu() || taken <= bytes) << taken << " of " << bytes;
    for (const int part : parts)
    {
      SCOPED_TRACE("within a " + std::to_string(part) + "th of " + std::to_string(taken) + " bytes");
      scene.settings.memoryBudget = std::min(taken, bytes) / part;
      {
        const OwnMemory ownMemory;
        device.ResetPeak();
        const LightField light = scene.Solve(device);
        EXPECT_LE(device.PeakBytes() - before, scene.settings.memoryBudget);
        EXPECT_NE(light.device.find("streamed from host memory"), std::string::npos) << light.device;
        ExpectSame(device, scene, light, whole);
      }
    }
    const LightField inPlace = scene.Solve(device);
    EXPECT_EQ(inPlace.device.find("in host memory") != std::string::npos, device.SharesHostMemory()) << inPlace.device;
    ExpectSame(device, scene, inPlace, whole);
    EXPECT_EQ(device.BytesInUse(), before);
  }
};

TEST_F(Streaming, OfGreyMediaIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  scene.settings.netFlux = true;
  this->ExpectSameLight(scene, { 2, 4, 16 });
}

TEST_F(Streaming, OfColouredMediaIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  Colour(scene);
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfColoursThatShareSigmaTIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  ColourAlbedo(scene);
  scene.settings.facePower = true;
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfAnAcceleratedSolveIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  scene.settings.maximumOrders = 0;
  scene.settings.source = PropagationSource::Linear;
  scene.settings.netFlux = true;
  this->ExpectSameLight(scene, { 2, 4, 16 });
}

TEST_F(Streaming, RoundPeriodicAxesIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  scene.settings.periodic = { true, true, false };
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfThickVoxelsIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  scene.Randomise(20.0, 2.0, 0.5);
  scene.settings.source = PropagationSource::Octants;
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfAngularMomentsIsTheSameLightBitForBit)
{
  Scene scene = RandomScene({ 64, 33, 27 });
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfAngularMomentsRoundAPeriodicAxisIsTheSameLight)
{
  Scene scene = RandomScene({ 19, 20, 15 });
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scene.settings.directionsPerFace = 4;
  scene.settings.periodic = { false, true, false };
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, OfABoxThatIsMostlyEmptyIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(SmallSize);
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    const bool filled =
      i % 40 > 8 && i % 40 < 30 && i / 40 % 33 > 5 && i / 40 % 33 < 25 && i / 1320 > 7 && i / 1320 < 22;
    scene.sigma_a[i] *= filled ? 1.0f : 0.0f;
    scene.sigma_s[i] *= filled ? 1.0f : 0.0f;
  }
  scene.settings.maximumOrders = 6;
  this->ExpectSameLight(scene, { 2, 16 });
}

TEST_F(Streaming, IsChosenWhereTheWholeDoesNotFit)
{
  Scene scene = RandomScene(SmallSize);
  Device& device = this->GetDevice();
  const OwnMemory ownMemory;
  const LightField whole = scene.Solve(device);
  EXPECT_EQ(whole.device, device.Name());
  const std::vector<Buffer<char>> hoard = AllMemoryBut(device, std::size_t(1) << 20);
  const LightField light = scene.Solve(device);
  EXPECT_NE(light.device.find("streamed from host memory"), std::string::npos) << light.device;
  ExpectSame(device, scene, light, whole);
}

TEST_F(Streaming, KeepsABudgetWithinAnother)
{
  Device outer(this->GetDevice(), MemoryBudget{ 1000, true });
  {
    Device inner(outer, MemoryBudget{});
    const Buffer<char> first(inner, 600, "the first");
    const Buffer<char> second(inner, 500, "the second"); // has no room in the outer one
    EXPECT_EQ(inner.BytesInUse(), 600u);
    EXPECT_EQ(inner.HostBytes(), 500u);
    EXPECT_EQ(outer.BytesInUse(), 600u);
    EXPECT_EQ(outer.HostBytes(), 500u);
  }
  EXPECT_EQ(outer.BytesInUse(), 0u);
  EXPECT_EQ(outer.HostBytes(), 0u);
}

TEST_F(Streaming, SaysWhatABudgetIsShortOf)
{
  Device part(this->GetDevice(), MemoryBudget{ 1000 });
  const Buffer<char> first(part, 600, "the first");
  const std::string text = ErrorWords<DeviceError>([&] { const Buffer<char> second(part, 500, "the second"); });
  EXPECT_NE(text.find("the second: 500 bytes are needed, 400 of 1000 are left of the memory budget"), std::string::npos)
    << text;
}

/// At the size of a usual grid.
TEST_F(Streaming, SlowAtOneHundredAndTwentyEightVoxelsIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(LargeSize);
  scene.settings.directionsPerFace = 25;
  this->ExpectSameLight(scene, { 2, 4, 16 });
}

TEST_F(Streaming, NightlyInColourAtOneHundredAndTwentyEightVoxelsIsTheSameLightBitForBit)
{
  Scene scene = RandomScene(LargeSize);
  Colour(scene);
  scene.settings.netFlux = true;
  scene.settings.maximumOrders = 2;
  this->ExpectSameLight(scene, { 2, 4, 16 });
}
}
