// Random numbers by counter, against the known answers that come with their paper's code (Random123, kat_vectors).

#include "DeviceTest.h"

#include "Device/Buffer.h"
#include "TyndallKernelSources.h"

#include <string>
#include <vector>

using namespace tyndall;

namespace
{
using Words = std::vector<cl_uint>;
}

class Philox : public DeviceTest
{
protected:
  std::string Source(const char* kernel) const { return std::string(kernel_source::Philox.data()) + kernel; }

  Words Block(const Words& counter, const Words& key)
  {
    const std::string source = this->Source("__kernel void block(uint4 counter, uint2 key, __global uint* out)"
                                            "{ vstore4(philox(counter, key), 0, out); }");
    Buffer<cl_uint> out(this->GetDevice(), 4, "random numbers");
    cl::Kernel kernel = this->GetDevice().Kernel("block", source);
    With(kernel, cl_uint4{ { counter[0], counter[1], counter[2], counter[3] } }, cl_uint2{ { key[0], key[1] } }, out);
    this->GetDevice().Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1));
    return out.Read();
  }
};

TEST_F(Philox, GivesTheKnownAnswers)
{
  EXPECT_EQ(this->Block({ 0, 0, 0, 0 }, { 0, 0 }), (Words{ 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8 }));
  EXPECT_EQ(this->Block({ 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff }, { 0xffffffff, 0xffffffff }),
    (Words{ 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd }));
  EXPECT_EQ(this->Block({ 0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344 }, { 0xa4093822, 0x299f31d0 }),
    (Words{ 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1 }));
}

TEST_F(Philox, DrawsEvenly)
{
  constexpr int Count = 1 << 16, Bins = 64;
  const std::string source =
    this->Source("__kernel void draws(__global float* out)"
                 "{ random_numbers r = random_of(20261123, get_global_id(0));"
                 "  for (int i = 0; i < 16; ++i) out[get_global_id(0) * 16 + i] = draw(&r); }");
  Buffer<float> out(this->GetDevice(), Count, "random numbers");
  cl::Kernel kernel = this->GetDevice().Kernel("draws", source);
  With(kernel, out);
  this->GetDevice().Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(Count / 16));
  std::vector<int> bins(Bins, 0);
  for (float value : out.Read())
  {
    ASSERT_GT(value, 0.0f);
    ASSERT_LT(value, 1.0f);
    ++bins[static_cast<std::size_t>(value * Bins)];
  }
  double square = 0.0;
  for (int count : bins)
  {
    const double expected = static_cast<double>(Count) / Bins;
    square += (count - expected) * (count - expected) / expected;
  }
  EXPECT_GT(square, 30.0); // of 63 degrees of freedom: 1e-4 at either end
  EXPECT_LT(square, 110.0);
}
