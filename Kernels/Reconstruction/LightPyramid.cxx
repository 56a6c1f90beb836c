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

LightPyramid::LightPyramid(
  const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what, const PartOfPyramid& part)
  : Kernels(kernels)
  , Part(part)
  , Fields(fields)
{
  const PyramidLayout ofGrid(grid.size), ofWhole(levels > part.shared ? part.whole : grid.size);
  std::size_t end = 0;
  std::vector<std::size_t> counts;
  for (int level = 0; level <= levels; ++level)
  {
    const bool above = level > part.shared;
    const PyramidLayout& layout = above ? ofWhole : ofGrid;
    this->Sizes.push_back(layout.sizes[static_cast<std::size_t>(std::min(level, layout.Top()))]);
    std::copy_n(part.first.begin(), above ? 3 : 0, this->Where.first[level].s);
    this->Where.size[level] = LightRows::LayoutOf(this->Sizes.back(), kernels.Width());
    this->Where.offset[level] = end;
    counts.push_back(this->BytesOf(this->Sizes.size() - 1) / sizeof(float));
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

std::size_t LightPyramid::BytesOf(std::size_t level) const
{
  return LightRows::CountOf(this->Sizes[level], this->Fields, this->Kernels.Width()) * sizeof(float);
}

void LightPyramid::Copy(const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes) const
{
  this->Kernels.On().Queue().enqueueCopyBuffer(from, to, 0, 0, bytes);
}

std::vector<float> LightPyramid::Read(int level) const
{
  const auto at = static_cast<std::size_t>(level);
  const LightRows rows(
    this->Kernels.On(), this->Sizes[at], this->Fields, this->Kernels.Width(), "a level of the pyramid");
  this->Copy(this->Parts[at], rows.Values().Handle(), this->BytesOf(at));
  return rows.Read();
}

void LightPyramid::BuildAbove(Down down, const std::vector<float>& cells)
{
  const PyramidLayout layout(this->Part.whole);
  const auto shared = static_cast<std::size_t>(this->Part.shared);
  Grid grid;
  grid.size = layout.sizes[std::min(shared, static_cast<std::size_t>(layout.Top()))];
  const std::size_t above = this->Sizes.size() - 1 - shared;
  LightPyramid ofAll(this->Kernels, grid, this->Fields, static_cast<int>(above), "the pyramid of all blocks");
  LightRows rows(this->Kernels.On(), grid.size, this->Fields, this->Kernels.Width(), "a level of the pyramid");
  rows.Write(cells);
  ofAll.Copy(rows.Values().Handle(), ofAll.Parts[0], ofAll.BytesOf(0));
  ofAll.Build(down);
  for (std::size_t level = 1; level <= above; ++level)
  {
    this->Copy(ofAll.Parts[level], this->Parts[shared + level], ofAll.BytesOf(level));
  }
  this->Kernels.On().Finish(); // the buffers go
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
  const std::size_t end = std::min(this->Parts.size(), static_cast<std::size_t>(this->Part.shared) + 1);
  for (std::size_t level = 1; level < end; ++level)
  {
    With(kernel, this->Parts[level - 1], this->Where.size[level - 1], this->Parts[level], this->Where.size[level],
      cl_int(this->Fields));
    this->Kernels.Run(kernel, this->Sizes[level]);
  }
}
}
