// Several threads at one device, each with work of its own. With the preset `thread` ThreadSanitizer watches.
#include "DeviceTest.h"
#include "MediumScene.h"
#include "PhotonScene.h"
#include "RandomMedium.h"
#include "ViewScene.h"

#include "Device/Buffer.h"
#include "LightPropagation/Published/ParallelPropagation.h"

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Threads = 4;

/// work(0), work(1), ... each in a thread, all at once.
void InThreads(const std::function<void(int)>& work)
{
  std::atomic<int> here{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < Threads; ++t)
  {
    threads.emplace_back([&, t] {
      for (++here; here < Threads;)
      {
        std::this_thread::yield(); // until all are there
      }
      work(t);
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

/// Another scene for each thread.
Scene Cloud(int number)
{
  Scene scene({ 6, 5 + number, 6 });
  scene.Randomise(2.0, 1.0, 0.8, static_cast<unsigned>(number) + 1);
  scene.settings.directionsPerFace = 4;
  scene.ShineFromEverywhere(1.0 + number);
  scene.ShineAlong({ 0.0, 0.6, 0.8 });
  return scene;
}

/// Work that can be stopped at any of its reports.
using Work = std::function<void(Device&, const Monitor&)>;

std::vector<Photon> PhotonsAlongZ(const Grid& grid)
{
  std::vector<Photon> photons(100);
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].position = grid.origin;
    photons[i].position[0] += (i + 0.5) / photons.size() * grid.Length(0);
    photons[i].position[1] += 0.5 * grid.Length(1);
    photons[i].power = { 1.0f, 1.0f, 1.0f };
  }
  return photons;
}

/// How much of the work was reported before it was told to stop at report `last`; less than that: it ended.
int StopAt(int last, Device& device, const Work& work)
{
  int reports = 0;
  try
  {
    work(device, [&](double) { return ++reports < last; });
  }
  catch (const Aborted&)
  {
  }
  return reports;
}
}

class DeviceInThreads : public DeviceTest
{
};

TEST(MemoryCountInThreads, GivesNoByteToTwo)
{
  constexpr std::size_t limit = 1000;
  MemoryCount count(limit);
  std::vector<int> taken(Threads);
  InThreads([&](int t) {
    // Others may hold all there is while they sleep: then this one goes on until they wake.
    for (std::size_t i = 0; i < 1000000 || taken[t] == 0; ++i)
    {
      const std::size_t bytes = 100 + (37 * i + 11 * static_cast<std::size_t>(t)) % 400;
      if (count.Take(bytes))
      {
        ++taken[t];
        count.GiveBack(bytes);
      }
    }
  });
  EXPECT_EQ(count.InUse(), 0u);
  EXPECT_EQ(count.Left(), limit);
  EXPECT_LE(count.Peak(), limit);
  for (const int times : taken)
  {
    EXPECT_GT(times, 0);
  }
}

TEST_F(DeviceInThreads, IsFoundByAllAtOnce)
{
  std::vector<std::shared_ptr<Device>> found(Threads);
  InThreads([&](int t) {
    for (int i = 0; i < 20; ++i)
    {
      found[t] = Device::Find();
    }
  });
  for (const std::shared_ptr<Device>& device : found)
  {
    EXPECT_EQ(device, this->TheDevice);
  }
}

TEST_F(DeviceInThreads, CountsMemoryThatAllTake)
{
  Device& device = this->GetDevice();
  const std::size_t before = device.BytesInUse();
  InThreads([&](int t) {
    for (std::size_t i = 0; i < 100000; ++i)
    {
      Buffer<float> buffer(device, 1 + (i * 7 + static_cast<std::size_t>(t)) % 100, "a test");
    }
  });
  EXPECT_EQ(device.BytesInUse(), before);
}

TEST_F(DeviceInThreads, BuildsAProgramOnceForAll)
{
  Device& device = this->GetDevice();
  std::vector<std::vector<float>> found(Threads);
  InThreads([&](int t) {
    for (int i = 0; i < 12; ++i)
    {
      const std::string text =
        "__kernel void fill(__global float* v, float f) { v[get_global_id(0)] = f + " + std::to_string(i % 3) + "; }";
      cl::Kernel fill = device.Kernel("fill", { text });
      Buffer<float> values(device, 64, "a test");
      With(fill, values, cl_float(10 * t));
      device.Queue().enqueueNDRangeKernel(fill, cl::NullRange, cl::NDRange(64), cl::NullRange);
      device.Queued(0.03);
      const std::vector<float> read = values.Read();
      found[t].insert(found[t].end(), read.begin(), read.end());
    }
  });
  for (int t = 0; t < Threads; ++t)
  {
    for (std::size_t i = 0; i < found[t].size(); ++i)
    {
      ASSERT_EQ(found[t][i], 10.0f * t + i / 64 % 3) << "thread " << t << ", value " << i;
    }
  }
}

TEST_F(DeviceInThreads, SolvesAsItDoesInOne)
{
  Device& device = this->GetDevice();
  std::vector<std::vector<float>> expected;
  for (int t = 0; t < Threads; ++t)
  {
    expected.push_back(Cloud(t).Solve(device).fluence);
  }
  const std::size_t before = device.BytesInUse();
  InThreads([&](int t) {
    for (int i = 0; i < 5; ++i)
    {
      EXPECT_EQ(Cloud(t).Solve(device).fluence, expected[t]) << "thread " << t << ", solve " << i;
    }
  });
  EXPECT_EQ(device.BytesInUse(), before);
}

/// What solvers take is given back wherever they are stopped.
class Stopped
  : public DeviceTest
  , public testing::WithParamInterface<const char*>
{
protected:
  static Work WorkNamed(const std::string& name)
  {
    if (name == "conservative")
    {
      return [](Device& device, const Monitor& monitor) { Cloud(0).Solve(device, monitor); };
    }
    if (name == "by_orders")
    {
      return [](Device& device, const Monitor& monitor) {
        Scene scene = Cloud(0);
        scene.settings.acceleration = PropagationAcceleration::None;
        scene.Solve(device, monitor);
      };
    }
    if (name == "published")
    {
      return [](Device& device, const Monitor& monitor) {
        RandomMedium random({ 6, 6, 6 });
        Illumination sky;
        sky.sky = { 1.0, 1.0, 1.0 };
        SolveParallel(device, random.medium, sky, {}, monitor);
      };
    }
    if (name == "photons")
    {
      return [](Device& device, const Monitor& monitor) {
        PhotonScene scene(8, 1.0, 0.1f, 0.1f);
        scene.SetBall(0.5, 1.3);
        scene.Marcher(device).March(PhotonsAlongZ(scene.medium.grid), monitor);
      };
    }
    return [](Device& device, const Monitor& monitor) {
      const viewing::Scene scene = viewing::Blobs();
      scene.Caster(device).Render(scene.Framed(), monitor);
    };
  }
};

TEST_P(Stopped, GivesBackWhatItTook)
{
  Device& device = this->GetDevice();
  const Work work = this->WorkNamed(this->GetParam());
  const std::size_t before = device.BytesInUse();
  int stops = 0;
  for (int last = 1; StopAt(last, device, work) == last; ++last)
  {
    ++stops;
    ASSERT_EQ(device.BytesInUse(), before) << "stopped at report " << last;
  }
  EXPECT_GT(stops, 0);
  EXPECT_EQ(device.BytesInUse(), before) << "not stopped";
}

TEST_P(Stopped, GivesBackWhatItTookBesideOthers)
{
  Device& device = this->GetDevice();
  const Work work = this->WorkNamed(this->GetParam());
  const std::size_t before = device.BytesInUse();
  InThreads([&](int t) {
    for (int i = 0; i < 5; ++i)
    {
      StopAt(1 + t + i, device, work);
    }
  });
  EXPECT_EQ(device.BytesInUse(), before);
}

TEST_P(Stopped, GivesBackWhatItTookWhereMemoryEnds)
{
  Device& device = this->GetDevice();
  const std::string name = this->GetParam();
  if (!device.SharesHostMemory() && (name == "conservative" || name == "by_orders"))
  {
    GTEST_SKIP() << "what does not fit lies in host memory there";
  }
  const Work work = this->WorkNamed(this->GetParam());
  device.ResetPeak();
  const std::size_t before = device.BytesInUse();
  work(device, {});
  const std::size_t needed = device.PeakBytes() - before;
  std::vector<Buffer<char>> hoard = AllMemoryBut(device, needed / 20);
  const std::size_t hoarded = device.BytesInUse();
  EXPECT_THROW(work(device, {}), DeviceError);
  EXPECT_EQ(device.BytesInUse(), hoarded);
  hoard.clear();
  EXPECT_EQ(device.BytesInUse(), before);
  EXPECT_NO_THROW(work(device, {}));
}

INSTANTIATE_TEST_SUITE_P(Solvers, Stopped,
  testing::Values("conservative", "by_orders", "published", "photons", "viewed"),
  [](const auto& info) { return std::string(info.param); });
