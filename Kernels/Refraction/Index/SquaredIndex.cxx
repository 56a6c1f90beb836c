#include "Refraction/Index/SquaredIndex.h"

#include "TyndallKernelSources.h"

namespace tyndall
{
Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior)
{
  const struct
  {
    cl_int size[3];
  } size = { { grid.size[0], grid.size[1], grid.size[2] } };
  const auto padded = [&](int axis, int by) { return static_cast<std::size_t>(grid.size[axis] + by); };
  const auto launch = [&](const cl::Kernel& kernel, int by) {
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(padded(0, by), padded(1, by), padded(2, by)));
  };
  const Buffer<float> squares(device, padded(0, 6) * padded(1, 6) * padded(2, 6), "n^2 beyond the grid");
  Buffer<float> coefficients(device, padded(0, 4) * padded(1, 4) * padded(2, 4), "squared index");
  cl::Kernel extend = device.Kernel("extend_squared_index", kernel_source::SquaredIndex);
  With(extend, size, ior, squares);
  launch(extend, 6);
  cl::Kernel combine = device.Kernel("squared_index_coefficients", kernel_source::SquaredIndex);
  With(combine, size, squares, coefficients);
  launch(combine, 4);
  device.Finish();
  return coefficients;
}
}
