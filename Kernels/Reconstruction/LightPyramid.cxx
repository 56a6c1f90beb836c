#include "Reconstruction/LightPyramid.h"

#include "Device/Defines.h"
#include "Numerics/PyramidLayout.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::size_t Alignment = 1024; // floats at which a part of a buffer may begin, on every device
}

LightPyramid::LightPyramid(const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what)
  : Kernels(kernels)
  , Fields(fields)
{
  const PyramidLayout layout(grid.size);
  std::size_t end = 0;
  std::vector<std::size_t> counts;
  for (int level = 0; level <= levels; ++level)
  {
    this->Sizes.push_back(layout.sizes[static_cast<std::size_t>(std::min(level, layout.Top()))]);
    this->Where.size[level] = LightRows::LayoutOf(this->Sizes.back(), kernels.Width());
    this->Where.offset[level] = end;
    counts.push_back(LightRows::CountOf(this->Sizes.back(), fields, kernels.Width()));
    end += RoundUp(counts.back(), Alignment);
  }
  this->Told = Buffer<PyramidLevels>(kernels.On(), &this->Where, 1, what);
  this->Memory = Buffer<float>(kernels.On(), end, what);
  for (std::size_t level = 0; level < counts.size(); ++level)
  {
    const cl_buffer_region region = { this->Where.offset[level] * sizeof(float), counts[level] * sizeof(float) };
    cl::Buffer all = this->Memory.Handle();
    this->Parts.push_back(all.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region));
  }
}

void LightPyramid::Fill(const WholeRows& voxels, int components, int first)
{
  cl::Kernel split = this->Kernels.Kernel("split_voxels", kernel_source::LightPyramid);
  const cl_int pitch = VoxelLayout(this->Sizes[0], this->Kernels.Width()).s[3];
  With(split, voxels.Handle(), cl_int(components), pitch, this->Parts[0], this->Where.size[0], cl_int(first));
  this->Kernels.Run(split, this->Sizes[0]);
}

void LightPyramid::Build(Down down)
{
  cl::Kernel kernel = this->Kernels.Kernel(down == Down::Gauss ? "smooth_down" : "join_down",
    kernel_source::LightPyramid, Define("GAUSS", down == Down::Gauss) + Define("MEAN_OF_LIT", down == Down::MeanOfLit));
  for (std::size_t level = 1; level < this->Parts.size(); ++level)
  {
    With(kernel, this->Parts[level - 1], this->Where.size[level - 1], this->Parts[level], this->Where.size[level],
      cl_int(this->Fields));
    this->Kernels.Run(kernel, this->Sizes[level]);
  }
}
}
