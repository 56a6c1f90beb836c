#pragma once

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Device/KernelPrograms.h"
#include "Device/OpenCL.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall
{
/// Limits for a solve's use of a device's memory.
struct MemoryBudget
{
  static constexpr std::size_t NoLimit = std::numeric_limits<std::size_t>::max();

  std::size_t bytes = NoLimit; ///< limit for all buffers on the device together, bytes
  /// Whether buffers that do not fit are placed in host memory, from which the device reads them; false: DeviceError.
  bool spills = false;
  /// Arrays of at least this many bytes are always placed in host memory, and sweeps stream them to the device.
  std::size_t hostFrom = NoLimit;
};

/// Memory in which an array is placed.
enum class Residence
{
  AsBudgetSays,
  /// device memory as long as there is room, for arrays that kernels access all the time
  Device
};

/// Lock-free, thread-safe count of the bytes that are allocated out of a limit.
class MemoryCount
{
public:
  explicit MemoryCount(std::size_t limit)
    : Most(limit)
  {
  }

  std::size_t Limit() const { return this->Most; }
  std::size_t InUse() const { return this->Taken; }
  std::size_t Left() const { return this->Most - this->Taken; }
  std::size_t Peak() const { return this->Largest; } ///< largest number of bytes in use since ResetPeak()
  void ResetPeak() { this->Largest = this->InUse(); }

  /// Reserves bytes.
  /// @return whether enough bytes were left; if not, none are reserved
  bool Take(std::size_t bytes)
  {
    std::size_t before = this->Taken;
    do
    {
      if (bytes > this->Most - before)
      {
        return false;
      }
    } while (!this->Taken.compare_exchange_weak(before, before + bytes));
    for (std::size_t peak = this->Largest; peak < before + bytes;)
    {
      this->Largest.compare_exchange_weak(peak, before + bytes);
    }
    return true;
  }

  /// Releases bytes that were reserved by Take.
  void GiveBack(std::size_t bytes) { this->Taken -= bytes; }

private:
  const std::size_t Most;
  std::atomic<std::size_t> Taken{ 0 }, Largest{ 0 };
};

/// An OpenCL device: its context, one in-order queue, the programs built for it, and a count of the allocated memory.
///
/// Thread-safe if each thread has its own buffers and kernels: the queue runs the commands of all threads in some
/// order. A thread that waits may also wait for the commands of other threads, and PeakBytes covers all threads.
class Device
{
public:
  /// The device whose name or platform contains `name` (case-insensitive). An empty `name` stands for the device that
  /// the environment variable TYNDALL_DEVICE names or, without this variable, for PoCL's CPU device, or else for the
  /// first device. Later calls return the same object, so that programs are built once per process.
  /// @throws DeviceError if there is no such device; the text lists the available devices
  static std::shared_ptr<Device> Find(const std::string& name = {});

  /// Warnings about how devices were opened since the last call, for example that compiled programs are cached in
  /// another folder than the user asked for.
  static std::vector<std::string> TakeWarnings();

  /// Creates the context and the queue of an OpenCL device.
  /// @param cacheFolder  folder to which the platform writes compiled programs, if known; its free space is checked
  ///   before each build
  Device(const cl::Platform& platform, const cl::Device& device, std::string cacheFolder = {});
  /// Creates a view of the device `whole` for one solve: allocations by the view are limited by `budget` and also count
  /// towards those of `whole`, which must outlive the view.
  Device(Device& whole, const MemoryBudget& budget);

  const std::string& Name() const { return this->DeviceName; }
  bool IsCpu() const { return this->Cpu; }
  int ComputeUnits() const { return this->Units; }
  /// Number of floats that a work-item should process at once. On a CPU: the number that a register holds, within the
  /// range from `least` to `most` for which the kernel is written. On a GPU, which vectorises across work-items:
  /// `leastOnGpu`.
  int KernelWidth(int least = 4, int most = 16, int leastOnGpu = 1) const
  {
    return this->Cpu ? std::clamp(this->VectorWidth, least, most) : leastOnGpu;
  }
  /// Whether the device has an OpenCL extension. False for extensions that the environment variable TYNDALL_WITHOUT
  /// names (separated by blanks), which tests use.
  bool HasExtension(const std::string& name) const;

  /// Limit, in bytes, for all buffers on this device together. It is the memory that OpenCL reports. On a CPU it is at
  /// least three quarters of the machine's memory, because PoCL reports less than is available.
  std::size_t MemoryLimit() const { return this->Memory.Limit(); }
  std::size_t AllocationLimit() const { return this->LargestAllocation; } ///< largest size of a single buffer, bytes
  /// Whether the budget places large arrays in host memory (MemoryBudget::hostFrom), so that sweeps must stream them.
  bool Streams() const { return this->Budget.hostFrom != MemoryBudget::NoLimit; }
  /// Whether kernels access host memory directly, so that copies to the device have no advantage. False if the
  /// environment variable TYNDALL_WITHOUT names `host_memory`.
  bool SharesHostMemory() const;
  /// Approximate cache size per core, bytes: private caches and the core's share of the common ones. 0 if the
  /// environment variable TYNDALL_WITHOUT names `cache`.
  std::size_t CacheBytes() const;
  std::size_t HostBytes() const { return this->OnHost.InUse(); }    ///< bytes of buffers in host memory
  std::size_t PeakHostBytes() const { return this->OnHost.Peak(); } ///< largest value that HostBytes() has had
  std::size_t BytesInUse() const { return this->Memory.InUse(); }
  std::size_t PeakBytes() const { return this->Memory.Peak(); } ///< largest value of BytesInUse() since ResetPeak()
  void ResetPeak() { this->Memory.ResetPeak(); }

  /// A kernel of the program `source`. Programs are cached, so that a second call with the same source and options
  /// costs nothing. The kernel object belongs to the caller; two threads receive two objects, because OpenCL does not
  /// allow them to set the arguments of one object.
  /// @param name  name of the kernel function
  /// @param source  text of a .cl file with its includes expanded (kernel_source::...)
  /// @param options  compiler options, e.g. "-DCHANNELS=3"
  /// @throws DeviceError with the build log
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options = {});

  /// Memory of a Buffer.
  struct Allocation
  {
    cl::Buffer memory;
    bool onHost = false; ///< whether the buffer is in host memory, which does not count towards a budget
  };
  /// Allocates memory for a Buffer.
  /// @param what  description of the content, for the error message
  /// @throws DeviceError if `bytes` more do not fit
  Allocation Allocate(
    std::size_t bytes, cl_mem_flags flags, const char* what, Residence residence = Residence::AsBudgetSays);
  void Release(std::size_t bytes, bool onHost);

  const cl::Context& Context() const { return this->TheContext; }
  cl::CommandQueue& Queue() { return this->TheQueue; }
  /// Creates another in-order queue, with profiling events. Commands on both queues may run concurrently.
  cl::CommandQueue AnotherQueue() const { return { this->TheContext, this->TheDevice, CL_QUEUE_PROFILING_ENABLE }; }
  void Finish();
  /// Waits for all queued commands if a program was compiled since the last wait, and meanwhile notifies this thread's
  /// CompilationListener: PoCL completes the compilation of a kernel at its first run. Must be called before any other
  /// wait for queued commands, for example a blocking read.
  void AwaitFirstRuns();

  /// Allocates the memory pages of a buffer of `bytes` bytes that will be written completely (tyndall::TakePages). Does
  /// nothing if the device has its own memory, or for a few pages.
  void TakePages(const cl::Buffer& memory, std::size_t bytes) const;

  /// Adds `seconds`, the estimated run time of queued work, to a sum, and waits for all queued work once the sum
  /// reaches a tenth of a second. Progress is then reported, and aborts are noticed. Between these waits, short kernels
  /// follow each other without the host.
  void Queued(double seconds);

  /// Seconds of the clock by which work is distributed: WorkSeconds, or a test's clock, which must be set before work
  /// begins.
  double Now() const { return this->TheClock(); }
  void SetClock(Clock clock) { this->TheClock = std::move(clock); }

private:
  Allocation AllocateOnHost(std::size_t bytes, cl_mem_flags flags, const char* what);

  cl::Device TheDevice;
  cl::Context TheContext;
  cl::CommandQueue TheQueue;
  std::string DeviceName;
  std::string Extensions;
  bool Cpu = true;
  int Units = 1;
  int VectorWidth = 1;
  std::size_t LargestAllocation = 0;
  Device* Whole = nullptr; ///< device of which this object is a view, with a budget; null: it is no view
  MemoryBudget Budget;     ///< limits of this view; unlimited if this is not a view
  MemoryCount Memory;
  MemoryCount OnHost;
  std::atomic<double> SecondsQueued{ 0.0 };
  Clock TheClock = WorkSeconds;
  std::shared_ptr<KernelPrograms> Programs; ///< programs, shared by all views of the device
};

/// The device's name for the user. If a solve used host memory, the amounts of memory used on the device and in host
/// memory follow.
/// @param ofSolve  the view of the device with the solve's budget
std::string NameWithStreaming(const Device& ofSolve);

/// Compiler option " -Dname=value", which defines a macro for a kernel.
inline std::string Define(const char* name, int value)
{
  return std::string(" -D") + name + "=" + std::to_string(value);
}

/// Work-group size for work-items that each process a row or more. CPU: 1, so that all threads receive work. GPU:
/// chosen by the driver, since groups of one work-item would leave most lanes of the vector units idle.
/// @param dimensions  dimensions of the range, 1 to 3
inline cl::NDRange GroupOfLargeItems(const Device& device, int dimensions = 1)
{
  return !device.IsCpu() ? cl::NullRange
    : dimensions == 1    ? cl::NDRange(1)
    : dimensions == 2    ? cl::NDRange(1, 1)
                         : cl::NDRange(1, 1, 1);
}

/// Queues a kernel over a range of work-items; does nothing if the range is empty.
inline void Launch(
  Device& device, const cl::Kernel& kernel, const cl::NDRange& items, const cl::NDRange& group = cl::NullRange)
{
  const std::size_t* sizes = items.get();
  if (std::find(sizes, sizes + items.dimensions(), 0) == sizes + items.dimensions())
  {
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, items, group);
  }
}

/// Number of work-items per work-group in kernels that compute sums (Numerics/GroupSum.cl); 1 on a CPU.
inline int SummingGroup(const Device& device)
{
  return device.IsCpu() ? 1 : 128;
}

/// Compiler option that defines GROUP, the number of work-items in a work-group, for kernels whose work-groups sum over
/// their work-items.
inline std::string SummingOption(const Device& device)
{
  return Define("GROUP", SummingGroup(device));
}

/// Queues a kernel whose work-groups sum over their work-items, with `groups` work-groups per channel.
inline void RunSummingGroups(Device& device, const cl::Kernel& kernel, std::size_t groups, std::size_t channels = 1)
{
  const auto items = static_cast<std::size_t>(SummingGroup(device));
  device.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(groups * items, channels), cl::NDRange(items, 1));
}
}
