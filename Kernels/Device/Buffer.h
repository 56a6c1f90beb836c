#pragma once

#include "Device/Device.h"
#include "Device/HostMemory.h"

#include <utility>
#include <vector>

namespace tyndall
{
/// Array of T in a device's memory. Movable, not copyable; the destructor frees the memory.
template <class T>
class Buffer
{
public:
  Buffer() = default;

  /// Allocates an array of `count` values, which are not set.
  /// @param what  description of the array's content, for the message when the array does not fit
  /// @throws DeviceError if the array does not fit the device
  Buffer(Device& device, std::size_t count, const char* what, cl_mem_flags flags = CL_MEM_READ_WRITE,
    Residence residence = Residence::AsBudgetSays)
    : Owner(&device)
    , Count(count)
    , Memory(device.Allocate(this->Bytes(), flags, what, residence))
  {
  }

  Buffer(Device& device, const T* values, std::size_t count, const char* what)
    : Buffer(device, count, what)
  {
    this->Write(values);
  }

  Buffer(Device& device, const std::vector<T>& values, const char* what)
    : Buffer(device, values.data(), values.size(), what)
  {
  }

  Buffer(Buffer&& other) noexcept { this->Swap(other); }
  Buffer& operator=(Buffer&& other) noexcept
  {
    Buffer taken(std::move(other));
    this->Swap(taken);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  ~Buffer()
  {
    if (this->Owner)
    {
      this->Owner->Release(this->Bytes(), this->Memory.onHost);
    }
  }

  std::size_t Size() const { return this->Count; }
  const cl::Buffer& Handle() const { return this->Memory.memory; }

  /// Write copies from `values` to the array, Read from the array to `values`. Both first wait for the device.
  void Write(const T* values) { this->Write(values, this->Count); }
  void Write(const T* values, std::size_t count) ///< copies the first `count` values only
  {
    if (count > 0)
    {
      this->Owner->AwaitFirstRuns();
      this->TakePages(0, count);
      this->Owner->Queue().enqueueWriteBuffer(this->Memory.memory, CL_TRUE, 0, count * sizeof(T), values);
    }
  }
  /// Waits for the device, then calls set(T* values), which must set all `Size()` values. On a CPU, `values` is the
  /// device's memory and nothing is copied. Commands queued on Device::Queue afterwards see the values; other queues
  /// must wait for that queue.
  template <class Set>
  void WriteInPlace(const Set& set)
  {
    if (this->Count > 0)
    {
      this->TakePages(0, this->Count);
      Mapping mapping(*this, CL_MAP_WRITE_INVALIDATE_REGION);
      set(mapping.values);
      mapping.GiveBack();
    }
  }
  /// Waits for the device, then calls look(const T* values) with all `Size()` values. On a CPU, `values` is the
  /// device's memory and nothing is copied.
  template <class Look>
  void ReadInPlace(const Look& look) const
  {
    if (this->Count > 0)
    {
      Mapping mapping(*this, CL_MAP_READ);
      look(static_cast<const T*>(mapping.values));
      mapping.GiveBack();
    }
  }
  /// Copies `count` values from `other`, from index `first` on in both buffers.
  void CopyFrom(const Buffer& other, std::size_t first, std::size_t count) const
  {
    const std::size_t begin = first * sizeof(T);
    this->Owner->Queue().enqueueCopyBuffer(other.Memory.memory, this->Memory.memory, begin, begin, count * sizeof(T));
  }
  void Read(T* values) const { this->Read(values, this->Count); }
  void Read(T* values, std::size_t count) const ///< copies the first `count` values only
  {
    if (count > 0)
    {
      this->Owner->AwaitFirstRuns();
      this->Owner->Queue().enqueueReadBuffer(this->Memory.memory, CL_TRUE, 0, count * sizeof(T), values);
    }
  }
  std::vector<T> Read() const
  {
    std::vector<T> values = Zeros<T>(this->Count);
    this->Read(values.data());
    return values;
  }

  void Fill(T value) { this->Fill(value, 0, this->Count); }
  void Fill(T value, std::size_t first, std::size_t count)
  {
    if (count > 0)
    {
      this->TakePages(first, count);
      this->Owner->Queue().enqueueFillBuffer(this->Memory.memory, value, first * sizeof(T), count * sizeof(T));
    }
  }

  void Swap(Buffer& other) noexcept
  {
    std::swap(this->Owner, other.Owner);
    std::swap(this->Count, other.Count);
    std::swap(this->Memory, other.Memory);
    std::swap(this->HasPages, other.HasPages);
  }

private:
  /// Maps a buffer, which must not be empty, to host memory during the lifetime of this object.
  struct Mapping
  {
    Mapping(const Buffer& of, cl_map_flags how)
      : owner(*of.Owner)
      , memory(of.Memory.memory)
    {
      this->owner.AwaitFirstRuns();
      this->values = static_cast<T*>(this->owner.Queue().enqueueMapBuffer(this->memory, CL_TRUE, how, 0, of.Bytes()));
    }
    void GiveBack() { this->owner.Queue().enqueueUnmapMemObject(this->memory, std::exchange(this->values, nullptr)); }
    ~Mapping()
    {
      if (this->values) // after an exception, which already reports the failure: errors of unmapping are ignored
      {
        clEnqueueUnmapMemObject(this->owner.Queue()(), this->memory(), this->values, 0, nullptr, nullptr);
      }
    }
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;

    Device& owner;
    cl::Buffer memory;
    T* values;
  };

  /// Allocates the memory pages of the buffer (Device::TakePages) when all of its values are written for the first
  /// time.
  void TakePages(std::size_t first, std::size_t count)
  {
    if (!this->HasPages && first == 0 && count == this->Count)
    {
      this->Owner->TakePages(this->Memory.memory, this->Bytes());
      this->HasPages = true;
    }
  }

  /// Size of the allocation, bytes. OpenCL has no empty buffers: an empty array allocates one value, so that it can be
  /// passed to a kernel.
  std::size_t Bytes() const { return (this->Count > 0 ? this->Count : 1) * sizeof(T); }

  Device* Owner = nullptr;
  std::size_t Count = 0;
  Device::Allocation Memory;
  bool HasPages = false; ///< whether Device::TakePages was called for the buffer
};

namespace detail
{
template <class T>
void SetArgument(cl::Kernel& kernel, cl_uint index, const T& value)
{
  kernel.setArg(index, value);
}
template <class T>
void SetArgument(cl::Kernel& kernel, cl_uint index, const Buffer<T>& buffer)
{
  kernel.setArg(index, buffer.Handle());
}
}

/// Sets the arguments of a kernel in order, from index `first` on; a Buffer is passed as its memory object.
template <class... Arguments>
void SetFrom(cl::Kernel& kernel, cl_uint first, const Arguments&... arguments)
{
  (detail::SetArgument(kernel, first++, arguments), ...);
}

/// Sets all arguments of a kernel, and returns the kernel.
template <class... Arguments>
cl::Kernel& With(cl::Kernel& kernel, const Arguments&... arguments)
{
  SetFrom(kernel, 0, arguments...);
  return kernel;
}
}
