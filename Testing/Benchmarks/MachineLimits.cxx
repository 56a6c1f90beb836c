#include "MachineLimits.h"

#include "Measure.h"

#include "Device/Buffer.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

namespace bench
{
namespace
{
using namespace tyndall;

constexpr int Chains = 12; ///< independent sums: more than the latency of a multiply-add times those begun in a cycle
constexpr int Rounds = 20000;
constexpr int Repetitions = 20;

constexpr const char* Source = R"(
#if WIDTH == 1
typedef float vector;
#else
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
typedef JOIN(float, WIDTH) vector;
#endif

// CHAINS * rounds multiply-adds of vectors a work-item
__kernel void multiply_adds(__global vector* result, int rounds, float a, float b)
{
  vector sums[CHAINS];
#pragma unroll
  for (int i = 0; i < CHAINS; ++i)
  {
    sums[i] = (vector)(i + 0.1f * get_global_id(0));
  }
  for (int round = 0; round < rounds; ++round)
  {
#pragma unroll
    for (int i = 0; i < CHAINS; ++i)
    {
      sums[i] = fma(sums[i], (vector)a, (vector)b);
    }
  }
  vector sum = (vector)0.0f;
#pragma unroll
  for (int i = 0; i < CHAINS; ++i)
  {
    sum += sums[i];
  }
  result[get_global_id(0)] = sum;
}

// `count` vectors a work-item: one after the other, or, `beside` 1, those of neighbouring work-items side by side
__kernel void triad(
  __global vector* a, const __global vector* b, const __global vector* c, float s, int count, int beside)
{
  const size_t begin = get_global_id(0) * (beside ? 1 : count), step = beside ? get_global_size(0) : 1;
  for (size_t i = begin; i < begin + count * step; i += step)
  {
    a[i] = b[i] + s * c[i];
  }
}
)";

/// The shortest of several runs, seconds.
double Shortest(Device& device, const std::function<void()>& enqueue)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < Repetitions; ++i)
  {
    const double start = WallSeconds();
    enqueue();
    device.Finish();
    shortest = std::min(shortest, WallSeconds() - start);
  }
  return shortest;
}
}

MachineLimits MeasureLimits(Device& device, bool largeArrays)
{
  const int width = device.KernelWidth(1);
  const int items = device.ComputeUnits() * (device.IsCpu() ? 4 : 4096);
  const std::size_t group = device.IsCpu() ? 1 : 64;
  const std::string options = "-DWIDTH=" + std::to_string(width) + " -DCHAINS=" + std::to_string(Chains);
  MachineLimits limits;

  Buffer<float> result(device, static_cast<std::size_t>(items) * width, "sums");
  cl::Kernel arithmetic = device.Kernel("multiply_adds", { Source }, options);
  With(arithmetic, result, cl_int(Rounds), 0.999f, 0.001f);
  const double busy = Shortest(device,
    [&] { device.Queue().enqueueNDRangeKernel(arithmetic, cl::NullRange, cl::NDRange(items), cl::NDRange(group)); });
  limits.multiplyAdds = static_cast<double>(Rounds) * Chains * width * items / busy;

  const std::size_t floats = (largeArrays ? 256 : 32) * std::size_t{ 1 << 18 } / (items * width) * (items * width);
  Buffer<float> a(device, floats, "an array to copy"), b(device, floats, "an array to copy"),
    c(device, floats, "an array to copy");
  b.Fill(1.0f);
  c.Fill(2.0f);
  cl::Kernel triad = device.Kernel("triad", { Source }, options);
  With(triad, a, b, c, 3.0f, cl_int(floats / (items * width)), cl_int(!device.IsCpu()));
  const double copying = Shortest(
    device, [&] { device.Queue().enqueueNDRangeKernel(triad, cl::NullRange, cl::NDRange(items), cl::NDRange(group)); });
  limits.bytes = 12.0 * floats / copying;
  return limits;
}
}
