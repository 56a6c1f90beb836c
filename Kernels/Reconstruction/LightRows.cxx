#include "LightRows.h"

#include "TyndallKernelSources.h"

#include "../Device/Defines.h"

namespace tyndall
{
namespace
{
std::size_t Count(int number)
{
  return static_cast<std::size_t>(number);
}
}

int RowWidth(const Device& device, const Grid& grid)
{
  return device.IsCpu() && grid.size[0] >= 16 ? 8 : 1;
}

LightRows::LightRows(Device& device, const std::array<int, 3>& size, int fields, int width, const char* what)
  : Size(size)
  , FieldCount(fields)
  , Stride(StrideOf(size[0], width))
  , Memory(device, Count(this->Stride) * Count(size[1]) * Count(size[2]) * Count(fields), what)
{
}

double LightRows::Bytes(const std::array<int, 3>& size, int fields, int width)
{
  return 1.0 * sizeof(float) * StrideOf(size[0], width) * size[1] * size[2] * fields;
}

RowKernels::RowKernels(Device& device, int width, const std::string& options)
  : TheDevice(device)
  , RowWidth(width)
  , Options(Define("REAL_WIDTH", width) + options)
{
}

cl::Kernel RowKernels::Kernel(const char* name, std::string_view source, const std::string& options) const
{
  return this->TheDevice.Kernel(
    name, { kernel_source::Numerics, kernel_source::LightRows, source }, this->Options + options);
}

void RowKernels::Run(
  const cl::Kernel& kernel, const std::array<int, 3>& cells, std::size_t first, std::size_t layers) const
{
  if (this->RowWidth > 1)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NDRange(0, first), cl::NDRange(Count(cells[1]), layers), cl::NDRange(1, 1));
  }
  else
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NDRange(0, 0, first), cl::NDRange(Count(cells[0]), Count(cells[1]), layers), cl::NullRange);
  }
}
}
