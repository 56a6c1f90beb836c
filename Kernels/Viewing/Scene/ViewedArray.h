#pragma once

#include "Device/Buffer.h"
#include "Device/HostMappedBuffer.h"

#include <memory>

namespace tyndall
{
/// An array that kernels read: a copy on the device, or one that its owner lends, of which a CPU needs no copy.
class ViewedArray
{
public:
  ViewedArray() = default;

  /// @param lent  the values stay until this goes
  ViewedArray(Device& device, const float* values, std::size_t count, bool lent, const char* what)
    : Copy(device, lent ? nullptr : values, lent ? 0 : count, what)
    , Lent(lent ? std::make_unique<HostMappedBuffer<float>>(device, values, count, what) : nullptr)
  {
  }

  const cl::Buffer& Handle() const { return this->Lent ? this->Lent->Handle() : this->Copy.Handle(); }

private:
  Buffer<float> Copy;
  std::unique_ptr<HostMappedBuffer<float>> Lent;
};
}
