#pragma once

#include "Device/Buffer.h"
#include "Device/HostMappedBuffer.h"

#include <cstdlib>
#include <memory>
#include <string>

namespace tyndall
{
/// An array on a device that is zero where nothing was written. On a CPU, parts that are never written take no memory,
/// since the system maps new pages to a single page of zeros; only the written part must fit.
template <class T>
class ZeroedBuffer
{
public:
  ZeroedBuffer() = default;

  /// @param everywhere  kernels write the whole array before it is read, so that no zeros are needed
  /// @throws DeviceError if it does not fit
  ZeroedBuffer(Device& device, std::size_t count, bool everywhere, const char* what)
  {
    if (count == 0 || everywhere || !device.IsCpu())
    {
      this->Whole = Buffer<T>(device, count, what);
      if (!everywhere)
      {
        this->Whole.Fill(T());
      }
      return;
    }
    this->Pages.reset(static_cast<T*>(std::calloc(count, sizeof(T))));
    if (!this->Pages)
    {
      throw DeviceError("The machine has no room for " + std::string(what) + ", an array of " +
        std::to_string(count * sizeof(T)) + " bytes. Use a coarser grid.");
    }
    this->Mapped = std::make_unique<HostMappedBuffer<T>>(device, this->Pages.get(), count, what);
  }

  const cl::Buffer& Handle() const { return this->Mapped ? this->Mapped->Handle() : this->Whole.Handle(); }

private:
  struct Free
  {
    void operator()(T* pages) const { std::free(pages); }
  };
  std::unique_ptr<T, Free> Pages;
  std::unique_ptr<HostMappedBuffer<T>> Mapped; // destroyed before its pages
  Buffer<T> Whole;
};
}
