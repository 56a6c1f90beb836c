#pragma once

#include "Device/Buffer.h"

#include <cstdlib>
#include <memory>
#include <string>

namespace tyndall
{
/// The caller's array, for use by kernels: the caller's memory itself on a CPU, otherwise a copy on the device. The
/// array must outlive this object. It must not be accessed between a kernel's start and the device's next Finish (or
/// Fetch).
template <class T>
class HostMappedBuffer
{
public:
  /// Wraps an array that kernels only read.
  HostMappedBuffer(Device& device, const T* values, std::size_t count, const char* what)
    : HostMappedBuffer(device, const_cast<T*>(values), count, what, CL_MEM_READ_ONLY)
  {
    if (count > 0 && !device.IsCpu())
    {
      this->Copy.Write(values);
    }
  }

  /// Wraps an array that kernels write completely; call Fetch() after they have been queued.
  HostMappedBuffer(Device& device, T* values, std::size_t count, const char* what)
    : HostMappedBuffer(device, values, count, what, CL_MEM_READ_WRITE)
  {
  }

  HostMappedBuffer(const HostMappedBuffer&) = delete;
  HostMappedBuffer& operator=(const HostMappedBuffer&) = delete;

  /// Waits for the device, because the caller may free the array once this object is destroyed. After a failure,
  /// kernels that were queued before may still access the array.
  ~HostMappedBuffer()
  {
    if (this->Count > 0 && this->Copy.Size() == 0)
    {
      try
      {
        this->Owner->Finish();
      }
      catch (const cl::Error&) // ignored: the error occurs again in a later call, which reports it
      {
      }
    }
  }

  const cl::Buffer& Handle() const { return this->Copy.Size() > 0 ? this->Copy.Handle() : this->Memory; }

  /// Waits for the device; afterwards the array contains the values that the kernels wrote.
  void Fetch() const
  {
    if (this->Copy.Size() > 0)
    {
      this->Copy.Read(this->Values);
      return;
    }
    if (this->Count > 0) // mapping makes the values visible to the host; nothing is copied
    {
      this->Owner->AwaitFirstRuns();
      cl::CommandQueue& queue = this->Owner->Queue();
      void* seen = queue.enqueueMapBuffer(this->Memory, CL_TRUE, CL_MAP_READ, 0, this->Count * sizeof(T));
      queue.enqueueUnmapMemObject(this->Memory, seen);
    }
    this->Owner->Finish();
  }

private:
  HostMappedBuffer(Device& device, T* values, std::size_t count, const char* what, cl_mem_flags flags)
    : Owner(&device)
    , Values(values)
    , Count(count)
  {
    if (count == 0 || !device.IsCpu())
    {
      this->Copy = Buffer<T>(device, count, what, flags);
      this->Memory = this->Copy.Handle();
      return;
    }
    try
    {
      this->Memory = cl::Buffer(device.Context(), flags | CL_MEM_USE_HOST_PTR, count * sizeof(T), values);
    }
    catch (const cl::Error& error)
    {
      throw DeviceError("The device " + device.Name() + " cannot use " + std::string(what) + ", an array of " +
        std::to_string(count * sizeof(T)) + " bytes (" + error.what() + " gave " + std::to_string(error.err()) +
        "); the largest it takes has " + std::to_string(device.AllocationLimit()) +
        ". Use a coarser grid or fewer batches.");
    }
  }

  Device* Owner;
  T* Values;
  std::size_t Count;
  cl::Buffer Memory;
  Buffer<T> Copy;
};

/// Array on a device that is zero where nothing was written. On a CPU, parts that are never written use no memory,
/// since the system maps new pages to a single page of zeros. Only the written parts must fit.
template <class T>
class ZeroedBuffer
{
public:
  ZeroedBuffer() = default;

  /// Allocates an array of `count` zeros.
  /// @param everywhere  whether kernels write the whole array before it is read, so that no zeros are needed
  /// @throws DeviceError if the array does not fit the device
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
  // Declared after Pages, the memory that it wraps, since it must be destroyed first.
  std::unique_ptr<HostMappedBuffer<T>> Mapped;
  Buffer<T> Whole;
};
}
