#include "Reconstruction/ArrayRange.h"

#include "Device/GroupSize.h"
#include "Device/Sizes.h"
#include "Reconstruction/ArrayRangeShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::size_t Run = RunStep * 170; // values a work-item
}

ArrayRange RangeOf(Device& device, const HostMappedBuffer<float>& array, const float* values, std::size_t count,
  int components, float low, float high)
{
  const std::size_t runs = PartsOf(count, Run);
  Buffer<RunRange> told(device, runs, "the range of an array");
  cl::Kernel kernel = device.Kernel("range_of_runs", kernel_source::ArrayRange);
  With(kernel, array.Handle(), cl_ulong(count), cl_int(Run), cl_int(components), low, high, told);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(runs), GroupOfLargeItems(device));

  ArrayRange range;
  const std::vector<RunRange> ranges = told.Read();
  for (std::size_t run = 0; run < runs; ++run)
  {
    if (ranges[run].unfit && !range.unfit)
    {
      const float* end = values + std::min(count, (run + 1) * Run);
      const float* first = std::find_if_not(values + run * Run, end, [&](float v) { return v >= low && v <= high; });
      range.unfit = static_cast<std::size_t>(first - values);
    }
    range.largest = std::max(range.largest, ranges[run].largest);
    for (std::size_t c = 0; c < 3; ++c)
    {
      range.total[c] += static_cast<double>(ranges[run].total[c]) * RangeSumUnit;
    }
  }
  return range;
}
}
