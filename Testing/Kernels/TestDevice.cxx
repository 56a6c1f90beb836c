#include "DeviceTest.h"

#include "Device/Batches.h"
#include "Device/Buffer.h"
#include "Device/Clock.h"
#include "Device/HostMemory.h"
#include "ErrorWords.h"
#include "TyndallKernelSources.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <future>
#include <iostream>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace tyndall;

namespace
{
bool Contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}
}

class DeviceLayer : public DeviceTest
{
};

TEST_F(DeviceLayer, HandsOutTheSameDeviceAgain)
{
  EXPECT_EQ(Device::Find().get(), Device::Find().get());
  EXPECT_EQ(Device::Find(this->GetDevice().Name().substr(2, 5)).get(), this->TheDevice.get())
    << "by a part of its name";
}

TEST_F(DeviceLayer, NamesTheDevicesThereAreWhereTheOneAskedForIsNot)
{
  const std::string complaint = ErrorWords<DeviceError>([] { Device::Find("no such device"); });
  EXPECT_TRUE(Contains(complaint, "no such device"));
  EXPECT_TRUE(Contains(complaint, this->GetDevice().Name()));
  EXPECT_TRUE(Contains(complaint, "TYNDALL_DEVICE"));
}

/// In a process of its own, which has not loaded a driver yet.
TEST(DeviceDeathTest, NamesMemoryWhereThatKeepsDriversFromLoading)
{
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto findWithLittle = [] {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (60u << 20);
    const struct rlimit limit = { most, most };
    setrlimit(RLIMIT_AS, &limit);
    const std::string complaint = ErrorWords<DeviceError>([] { Device::Find(); });
    std::cerr << complaint << std::endl;
    std::_Exit(Contains(complaint, "MiB in all (ulimit -v): let it take more") ? 0 : 1);
  };
  EXPECT_EXIT(findWithLittle(), testing::ExitedWithCode(0), "There is no OpenCL device to work on. .*OpenCL");
}

TEST_F(DeviceLayer, SaysHowManyBytesAreMissing)
{
  const std::size_t tooMany = this->GetDevice().MemoryLimit() / sizeof(float) + 1;
  const std::string complaint =
    ErrorWords<DeviceError>([&] { Buffer<float>(this->GetDevice(), tooMany, "a test of memory"); });
  EXPECT_TRUE(Contains(complaint, "a test of memory"));
  EXPECT_TRUE(Contains(complaint, std::to_string(tooMany * sizeof(float))));
  EXPECT_TRUE(Contains(complaint, this->GetDevice().Name()));
}

TEST_F(DeviceLayer, CountsTheMemoryItGives)
{
  Device& device = this->GetDevice();
  const std::size_t before = device.BytesInUse();
  device.ResetPeak();
  {
    Buffer<float> first(device, 1000, "a test");
    Buffer<float> second(std::move(first));
    first = Buffer<float>(device, 500, "a test");
    EXPECT_EQ(device.BytesInUse(), before + 1500 * sizeof(float));
  }
  EXPECT_EQ(device.BytesInUse(), before);
  EXPECT_EQ(device.PeakBytes(), before + 1500 * sizeof(float));
}

TEST_F(DeviceLayer, ShowsTheBuildLogOfAKernelThatDoesNotBuild)
{
  const std::string complaint = ErrorWords<DeviceError>(
    [&] { this->GetDevice().Kernel("broken", { "__kernel void broken() { undeclared = 1; }" }); });
  EXPECT_TRUE(Contains(complaint, "undeclared"));
  EXPECT_TRUE(Contains(complaint, "broken"));
}

/// Nobody has compiled it before (a comment would not do: caches pass it over), and both steps of the compiler take
/// longer than a listener's patience: reading the unused functions, and what is left when the kernel first runs.
std::string LargeKernel()
{
  std::string text = "__constant float once = " + std::to_string(ClockSeconds()) + "f;\n";
  for (int number = 0; number < 30000; ++number)
  {
    text += "static inline float f" + std::to_string(number) + "(float a) { return a * 1.5f + 0.5f; }\n";
  }
  text += "__kernel void large(__global float* x) { float a = x[0];\n";
  for (int line = 0; line < 500; ++line)
  {
    text += "a = native_sin(a * " + std::to_string(line) + ".5f) + x[" + std::to_string(line % 7) + "];\n";
  }
  return text + "x[0] = a; }";
}

TEST_F(DeviceLayer, WhoeverWaitsForTheCompilerHearsOfIt)
{
  Device& device = this->GetDevice();
  const std::string source = LargeKernel();
  int building = 0, running = 0, again = 0, elsewhere = 0;
  const CompilationListener outer([&] { ++elsewhere; });
  Buffer<float> values(device, std::vector<float>(7, 0.5f), "a test");
  cl::Kernel kernel;
  {
    const CompilationListener listener([&] { ++building; });
    kernel = device.Kernel("large", source);
  }
  EXPECT_GT(building, 0);
  kernel.setArg(0, values.Handle());
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
  {
    const CompilationListener listener([&] { ++running; });
    values.Read();
  }
  if (device.Name().find("Portable Computing Language") != std::string::npos)
  {
    EXPECT_GT(running, 0) << "PoCL compiles the rest when the kernel first runs";
  }
  {
    const CompilationListener listener([&] { ++again; });
    device.Kernel("large", source);
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
    device.Finish();
  }
  EXPECT_EQ(again, 0);
  EXPECT_EQ(elsewhere, 0) << "the innermost listener hears";
}

TEST_F(DeviceLayer, WhoeverWaitsForTheCompilerOfAnotherThreadHearsOfIt)
{
  Device& device = this->GetDevice();
  const std::string source = LargeKernel();
  std::promise<void> compiles;
  std::thread first([&] {
    std::once_flag once;
    const CompilationListener listener([&] { std::call_once(once, [&] { compiles.set_value(); }); });
    device.Kernel("large", source);
  });
  int heard = 0;
  if (compiles.get_future().wait_for(std::chrono::seconds(60)) == std::future_status::ready)
  {
    const CompilationListener listener([&] { ++heard; });
    device.Kernel("large", source);
  }
  first.join();
  EXPECT_GT(heard, 0);
}

/// What the sizes of batches are on a machine that does so many things a second.
std::vector<std::size_t> SizesAt(Device& device, const Batches& batches, double thingsPerSecond)
{
  double now = 0.0;
  device.SetClock([&] { return now; });
  std::vector<std::size_t> sizes;
  InBatches(device, batches, {}, [&](std::size_t, std::size_t size) {
    sizes.push_back(size);
    now += static_cast<double>(size) / thingsPerSecond;
  });
  device.SetClock(ClockSeconds);
  return sizes;
}

TEST(WorkSeconds, StandStillWhileKernelsAreCompiled)
{
  const std::chrono::milliseconds pause(200);
  const double begun = WorkSeconds();
  {
    const WhileCompiling first;
    std::this_thread::sleep_for(pause);
    const WhileCompiling second;
    std::this_thread::sleep_for(pause);
  }
  EXPECT_LT(WorkSeconds() - begun, 0.2);
  std::this_thread::sleep_for(pause);
  EXPECT_GT(WorkSeconds() - begun, 0.19);
}

TEST_F(DeviceLayer, SharesWorkOutByItsClock)
{
  Batches batches;
  batches.count = 1000;
  batches.first = 10;
  batches.whole = 5;
  batches.seconds = 0.1;
  batches.growth = 4.0;
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(SizesAt(this->GetDevice(), batches, 2001.0), (Sizes{ 10, 40, 160, 200, 200, 200, 190 }))
    << "parts grow fourfold, until they take a tenth of a second";
  EXPECT_EQ(SizesAt(this->GetDevice(), batches, 1e12), (Sizes{ 10, 40, 160, 640, 150 })) << "a fast machine";
  const Sizes slow = SizesAt(this->GetDevice(), batches, 1.0);
  EXPECT_EQ(slow.size(), 199u) << "a slow machine: all but the first are as small as they can be";
  EXPECT_EQ(slow[1], 5u);
}

/// 1 - exp(-tau) and exp(-tau) as the kernels see them.
class Extinguished
  : public DeviceTest
  , public testing::WithParamInterface<int>
{
};

TEST_P(Extinguished, KeepsItsRelativeErrorFromVacuumToOpaque)
{
  std::vector<float> tau = { 0.0f };
  for (double t = 1e-30; t < 1e7; t *= 1.013)
  {
    tau.push_back(static_cast<float>(t));
  }
  tau.resize((tau.size() + 15) / 16 * 16, 1.0f);
  const int width = GetParam();
  const std::string text = std::string(kernel_source::Numerics) +
    "__kernel void evaluate(__global float* tau, __global float* lost, __global float* left) {"
    " const size_t i = get_global_id(0) * REAL_WIDTH; real rest;"
    " const real gone = extinguished(load_real(i, tau), &rest);"
    " store_real(gone, i, lost); store_real(rest, i, left); }";
  Device& device = this->GetDevice();
  cl::Kernel kernel = device.Kernel("evaluate", text, "-DREAL_WIDTH=" + std::to_string(width));
  Buffer<float> in(device, tau, "tau"), lost(device, tau.size(), "lost"), left(device, tau.size(), "left");
  With(kernel, in, lost, left);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(tau.size() / width), cl::NullRange);
  const std::vector<float> gone = lost.Read();
  const std::vector<float> rest = left.Read();
  for (std::size_t i = 0; i < tau.size(); ++i)
  {
    const double exactGone = -std::expm1(-static_cast<double>(tau[i]));
    ASSERT_NEAR(gone[i], exactGone, 3e-7 * exactGone) << tau[i];
    if (tau[i] < 80.0f)
    {
      const double exactRest = std::exp(-static_cast<double>(tau[i]));
      ASSERT_NEAR(rest[i], exactRest, 4e-7 * exactRest) << tau[i];
    }
    else
    {
      ASSERT_GE(rest[i], 0.0f);
      ASSERT_LT(rest[i], 1e-34f);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Extinguished, testing::Values(1, 4, 8, 16));

/// Small ones and such as lie in pages of 2 MB.
TEST_F(DeviceLayer, BuffersAreSetAndSeenInPlace)
{
  for (const std::size_t count : { std::size_t(1000), std::size_t(3000001) })
  {
    std::vector<int> expected(count);
    std::iota(expected.begin(), expected.end(), 7);
    Buffer<int> buffer(this->GetDevice(), count, "numbers");
    buffer.WriteInPlace([&](int* values) { std::copy(expected.begin(), expected.end(), values); });
    EXPECT_EQ(buffer.Read(), expected);

    buffer.Fill(3, 10, count - 20);
    std::fill(expected.begin() + 10, expected.end() - 10, 3);
    std::vector<int> seen;
    buffer.ReadInPlace([&](const int* values) { seen.assign(values, values + count); });
    EXPECT_EQ(seen, expected);
  }
  Buffer<int> empty(this->GetDevice(), 0, "nothing");
  empty.WriteInPlace([](int*) { ADD_FAILURE() << "there is nothing to set"; });
  empty.ReadInPlace([](const int*) { ADD_FAILURE() << "there is nothing to see"; });
}

TEST_F(DeviceLayer, BuffersGoOnWhereSettingThemFailed)
{
  Buffer<int> buffer(this->GetDevice(), 100, "numbers");
  EXPECT_THROW(buffer.WriteInPlace([](int*) { throw std::runtime_error("no"); }), std::runtime_error);
  buffer.Fill(5);
  EXPECT_EQ(buffer.Read(), std::vector<int>(100, 5));
}

TEST(HostMemory, PagesThatAreTakenKeepWhatTheyHold)
{
  std::vector<int> expected(40 << 20 >> 2);
  std::iota(expected.begin(), expected.end(), 1);
  std::vector<int> values = expected;
  TakePages(values.data(), values.size() * sizeof(int));
  TakePages(values.data() + 1, 5);
  TakePages(nullptr, 0);
  EXPECT_EQ(values, expected);
  EXPECT_EQ(Zeros(30 << 20 >> 2), std::vector<float>(30 << 20 >> 2, 0.0f));
}
