#include "Reconstruction/WholeRows.h"

#include "TyndallKernelSources.h"

namespace tyndall
{
WholeRows::WholeRows(const RowKernels& kernels, const HostMappedBuffer<float>& array, const std::array<int, 3>& size,
  int volumes, int components, bool written, const char* what)
  : Kernels(kernels)
  , Own(array)
  , Voxels(size[0])
  , Components(components)
  , Rows(Count(size[1]) * Count(size[2]) * Count(volumes))
  , Pitch(WholeVectors(size[0], kernels.Width()))
{
  if (this->Pitch != this->Voxels)
  {
    this->Wide = Buffer<float>(kernels.On(), this->Rows * Count(this->Pitch) * Count(components), what);
    if (!written)
    {
      this->Copy(this->Own.Handle(), this->Voxels, this->Wide.Handle(), this->Pitch);
    }
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
  With(kernel, from, cl_int(this->Voxels), cl_int(fromRow), to, cl_int(toRow), cl_int(this->Components));
  this->Kernels.On().Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Rows), cl::NullRange);
}
}
