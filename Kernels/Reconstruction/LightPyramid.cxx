#include "Reconstruction/LightPyramid.h"

#include "Device/Device.h"
#include "Numerics/PyramidLayout.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
int RowWidth(const Device& device, const Grid& grid)
{
  return grid.size[0] >= 16 ? device.KernelWidth(8, 8) : 1;
}

namespace
{
/// Pitch of layers in floats, equal to layer_of in LightRows.cl. Rows at the same position of all layers and quantities
/// are used together. With pitches that are multiples of 4 kB they would map to the same few cache sets. A layer
/// therefore ends with 3, and a quantity (FieldStride) with 41, unused lines of 64 bytes.
std::size_t LayerStride(const std::array<int, 3>& size, int stride)
{
  const std::size_t layer = Count(size[1]) * Count(stride);
  return layer < 1024 ? layer : layer + 48;
}

std::size_t FieldStride(const std::array<int, 3>& size, int stride)
{
  const std::size_t field = LayerStride(size, stride) * Count(size[2]);
  return field < 1024 ? field : field + 656;
}
}

cl_int4 LightRows::LayoutOf(const std::array<int, 3>& size, int width)
{
  return { { size[0], size[1], size[2], WholeVectors(size[0], width) + 2 * (width > 1 ? width : 2) } };
}

std::size_t LightRows::CountOf(const std::array<int, 3>& size, int fields, int width)
{
  return FieldStride(size, LayoutOf(size, width).s[3]) * Count(fields);
}

LightRows::LightRows(Device& device, const std::array<int, 3>& size, int fields, int width, const char* what)
  : Size(size)
  , FieldCount(fields)
  , Stride(LayoutOf(size, width).s[3])
  , Width(width)
  , Memory(device, CountOf(size, fields, width), what)
{
}

template <class Act>
void LightRows::ForValues(const Act& act) const
{
  const std::size_t layer = LayerStride(this->Size, this->Stride), field = FieldStride(this->Size, this->Stride);
  const int guard = this->Width > 1 ? this->Width : 2;
  std::size_t cell = 0;
  for (int z = 0; z < this->Size[2]; ++z)
  {
    for (int y = 0; y < this->Size[1]; ++y)
    {
      for (int x = 0; x < this->Size[0]; ++x, ++cell)
      {
        for (int f = 0; f < this->FieldCount; ++f)
        {
          act(cell, x, f, Count(f) * field + Count(z) * layer + Count(y) * Count(this->Stride) + Count(guard + x));
        }
      }
    }
  }
}

std::vector<float> LightRows::Read() const
{
  const std::vector<float> memory = this->Memory.Read();
  std::vector<float> cells(
    Count(this->Size[0]) * Count(this->Size[1]) * Count(this->Size[2]) * Count(this->FieldCount));
  this->ForValues([&](std::size_t cell, int, int field, std::size_t place) {
    cells[cell * Count(this->FieldCount) + Count(field)] = memory[place];
  });
  return cells;
}

void LightRows::Write(const std::vector<float>& cells)
{
  std::vector<float> memory(CountOf(this->Size, this->FieldCount, this->Width), 0.0f);
  const int end = WholeVectors(this->Size[0], this->Width) + 2;
  this->ForValues([&](std::size_t cell, int x, int field, std::size_t place) {
    const float value = cells[cell * Count(this->FieldCount) + Count(field)];
    memory[place] = value;
    if (x == 0)
    {
      memory[place - 1] = memory[place - 2] = value;
    }
    for (int beyond = 1; x == this->Size[0] - 1 && x + beyond < end; ++beyond)
    {
      memory[place + Count(beyond)] = value;
    }
  });
  this->Memory.Write(memory.data(), memory.size());
}

RowKernels::RowKernels(Device& device, int width)
  : TheDevice(device)
  , RowWidth(width)
{
}

cl::Kernel RowKernels::Kernel(const char* name, std::string_view source, const std::string& options) const
{
  return this->TheDevice.Kernel(name, source, Define("REAL_WIDTH", this->RowWidth) + options);
}

void RowKernels::Run(
  const cl::Kernel& kernel, const std::array<int, 3>& cells, std::size_t first, std::size_t layers) const
{
  if (this->RowWidth > 1)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NDRange(0, first), cl::NDRange(Count(cells[1]), layers), GroupOfLargeItems(this->TheDevice, 2));
  }
  else
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NDRange(0, 0, first), cl::NDRange(Count(cells[0]), Count(cells[1]), layers), cl::NullRange);
  }
}

WholeRows::WholeRows(
  const RowKernels& kernels, const float* values, const std::array<int, 3>& size, int components, const char* what)
  : Kernels(kernels)
  , Own(kernels.On(), values, values ? Count(size[0]) * Count(size[1]) * Count(size[2]) * Count(components) : 0, what)
  , Voxels(size[0])
  , Components(components)
  , Rows(values ? Count(size[1]) * Count(size[2]) : 0)
  , Pitch(WholeVectors(size[0], kernels.Width()))
{
  if (this->Pitch != this->Voxels && this->Rows > 0)
  {
    this->Wide = Buffer<float>(kernels.On(), this->Rows * Count(this->Pitch) * Count(components), what);
    this->Copy(this->Own.Handle(), this->Voxels, this->Wide.Handle(), this->Pitch);
  }
}

WholeRows::WholeRows(const RowKernels& kernels, std::vector<float>& values, const std::array<int, 3>& size,
  int components, const char* what)
  : Kernels(kernels)
  , Own(kernels.On(), values.data(), values.size(), what)
  , Voxels(size[0])
  , Components(components)
  , Rows(values.empty() ? 0 : Count(size[1]) * Count(size[2]))
  , Pitch(WholeVectors(size[0], kernels.Width()))
{
  if (this->Pitch != this->Voxels)
  {
    this->Wide = Buffer<float>(kernels.On(), this->Rows * Count(this->Pitch) * Count(components), what);
  }
}

void WholeRows::Fetch() const
{
  if (this->Wide.Size() > 0)
  {
    this->Copy(this->Wide.Handle(), this->Pitch, this->Own.Handle(), this->Voxels);
  }
  this->Own.Fetch();
}

void WholeRows::Copy(const cl::Buffer& from, int fromRow, const cl::Buffer& to, int toRow) const
{
  cl::Kernel kernel = this->Kernels.Kernel("copy_rows", kernel_source::LightPyramid);
  With(kernel, from, cl_int(this->Voxels), cl_int(fromRow), to, cl_int(toRow), cl_int(1), cl_int(this->Components));
  this->Kernels.On().Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Rows), cl::NullRange);
}

namespace
{
constexpr std::size_t Alignment = 1024; // in floats; on every device, subbuffers may begin at multiples of this
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
  this->Kernels.On().Finish(); // kernels must have read the local buffers before their destructors release them
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
  // Weights exp(-x^2 / (2 * 4)) at x = 0.5 and 1.5, normalised so that the four weights add up to 1 (Pfeuti 2009,
  // section 3.2.4).
  constexpr cl_float near = 0.281088549f, far = 0.218911451f;
  cl::Kernel kernel =
    this->Kernels.Kernel(down == Down::Gauss ? "smooth_down" : "join_down", kernel_source::LightPyramid);
  if (down == Down::Gauss)
  {
    SetFrom(kernel, 5, near, far);
  }
  else
  {
    SetFrom(kernel, 5, cl_int(down == Down::MeanOfLit));
  }
  const std::size_t end = std::min(this->Parts.size(), static_cast<std::size_t>(this->Part.shared) + 1);
  for (std::size_t level = 1; level < end; ++level)
  {
    With(kernel, this->Parts[level - 1], this->Where.size[level - 1], this->Parts[level], this->Where.size[level],
      cl_int(this->Fields));
    this->Kernels.Run(kernel, this->Sizes[level]);
  }
}
}
