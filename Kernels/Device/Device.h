#pragma once

#include "Errors.h"
#include "OpenCL.h"

#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace tyndall
{
/// One OpenCL device: its context, one in-order queue, the programs built for it, and a count of the memory taken on it.
///
/// Not safe for use by several threads at once.
class Device
{
public:
  /// The device whose name or platform contains `name` (any case); with an empty name the one that the variable
  /// TYNDALL_DEVICE names; without either PoCL's CPU device, or else the first device there is.
  /// The same device is handed out again on the next call, so that programs are built once a process.
  /// @throws DeviceError if there is no such device; the text lists those there are
  static std::shared_ptr<Device> Find(const std::string& name = {});

  Device(const cl::Platform& platform, const cl::Device& device);

  const std::string& Name() const { return this->DeviceName; }
  bool IsCpu() const { return this->Cpu; }
  int ComputeUnits() const { return this->Units; }
  int FloatVectorWidth() const { return this->VectorWidth; } ///< 1 on GPUs, 4 to 16 on CPUs
  /// Not those that the environment variable TYNDALL_WITHOUT names (with blanks between): to try what devices without them get.
  bool HasExtension(const std::string& name) const;

  /// Bytes that buffers on this device may take together. What OpenCL reports, on a CPU at least three quarters of the
  /// machine's memory (PoCL reports only a part of what can be had).
  std::size_t MemoryLimit() const { return this->Limit; }
  std::size_t AllocationLimit() const { return this->LargestAllocation; } ///< largest single buffer, bytes
  std::size_t BytesInUse() const { return this->InUse; }
  std::size_t PeakBytes() const { return this->Peak; } ///< largest BytesInUse since ResetPeak
  void ResetPeak() { this->Peak = this->InUse; }

  /// A kernel of the program that the given sources make one after the other. Programs are kept, so that asking again
  /// with the same sources and options costs nothing.
  /// @param sources  texts of .cl files (kernel_source::...), in the order they are to be read
  /// @param options  compiler options, e.g. "-DCHANNELS=3"
  /// @throws DeviceError with the build log
  cl::Kernel Kernel(const char* name, std::initializer_list<std::string_view> sources, const std::string& options = {});

  /// @throws DeviceError if `bytes` more do not fit; `what` says what they are for
  cl::Buffer Allocate(std::size_t bytes, cl_mem_flags flags, const char* what);
  void Release(std::size_t bytes) { this->InUse -= bytes; }

  const cl::Context& Context() const { return this->TheContext; }
  cl::CommandQueue& Queue() { return this->TheQueue; }
  void Finish();

  /// Note that work of about so many seconds was queued, and wait for all of it once that is a tenth of a second: progress is
  /// told and an abort heard that often, while short kernels follow each other without the host.
  void Queued(double seconds);

private:
  cl::Device TheDevice;
  cl::Context TheContext;
  cl::CommandQueue TheQueue;
  std::string DeviceName;
  std::string Extensions;
  bool Cpu = true;
  int Units = 1;
  int VectorWidth = 1;
  std::size_t Limit = 0;
  std::size_t LargestAllocation = 0;
  std::size_t InUse = 0;
  std::size_t Peak = 0;
  double SecondsQueued = 0.0;
  std::map<std::string, cl::Program> Programs;
};
}
