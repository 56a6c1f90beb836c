#include "Refraction/Octree/MinMaxPyramid.h"

#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
MinMaxPyramid::MinMaxPyramid(Device& device, const Grid& grid, const Buffer<float>& values)
  : TheLayout(grid.size)
  , TheNodes(device, this->TheLayout.nodeCount, "the pyramid of smallest and largest values")
{
  const PyramidLayout& layout = this->TheLayout;
  cl::Kernel ofVoxels = device.Kernel("min_max_of_voxels", kernel_source::MinMaxPyramid);
  cl::Kernel ofNodes = device.Kernel("min_max_of_nodes", kernel_source::MinMaxPyramid);
  for (int level = 1; level <= layout.Top(); ++level)
  {
    const cl_int4 below = Int4(layout.sizes[level - 1]);
    const cl_int4 size = Int4(layout.sizes[level]);
    const cl_ulong first = layout.offsets[level];
    const cl::Kernel& kernel = level == 1
      ? With(ofVoxels, values, below, this->TheNodes, first, size)
      : With(ofNodes, this->TheNodes, static_cast<cl_ulong>(layout.offsets[level - 1]), below, first, size);
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, PyramidRange(layout.sizes[level]), PyramidGroup());
  }
}
}
