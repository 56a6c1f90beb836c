#pragma once

#include "Device/Clock.h"
#include "Device/CompilationListener.h"
#include "Device/Errors.h"
#include "Device/MemoryBudget.h"
#include "Device/MemoryCount.h"
#include "Device/OpenCL.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall
{
/// One OpenCL device: its context, one in-order queue, the programs built for it, and a count of the memory taken on
/// it.
///
/// Safe for several threads at once, each with buffers and kernels of its own: what they queue is done in some order,
/// one after the other. A thread that waits may wait for the work of others too, and PeakBytes is of all of them.
class Device
{
public:
  /// The device whose name or platform contains `name` (any case); with an empty name the one that the variable
  /// TYNDALL_DEVICE names; without either PoCL's CPU device, or else the first device there is.
  /// The same device is handed out again on the next call, so that programs are built once a process.
  /// @throws DeviceError if there is no such device; the text lists those there are
  static std::shared_ptr<Device> Find(const std::string& name = {});

  /// What users should know of how devices were opened, e.g. that programs are kept elsewhere than they said. Each is
  /// given out once.
  static std::vector<std::string> TakeWarnings();

  /// @param cacheFolder  where the platform writes what it compiles, if that is known: checked for room before it does
  Device(const cl::Platform& platform, const cl::Device& device, std::string cacheFolder = {});
  /// The same device as a solve sees it: what it takes is part of what `whole`, which must stay, has, and within its
  /// budget.
  Device(Device& whole, const MemoryBudget& budget);

  const std::string& Name() const { return this->DeviceName; }
  bool IsCpu() const { return this->Cpu; }
  int ComputeUnits() const { return this->Units; }
  int FloatVectorWidth() const { return this->VectorWidth; } ///< 1 on GPUs, 4 to 16 on CPUs
  /// Floats that a work-item is to handle at once: on a CPU as many as its registers hold, but from `least` to `most`,
  /// for which a kernel is written; on a GPU, which makes its own vectors, as few as the kernel can do.
  int KernelWidth(int least = 4, int most = 16, int leastOnGpu = 1) const
  {
    return this->Cpu ? std::clamp(this->VectorWidth, least, most) : leastOnGpu;
  }
  /// Not those that the environment variable TYNDALL_WITHOUT names (with blanks between): to try what devices without
  /// them get.
  bool HasExtension(const std::string& name) const;

  /// Bytes that buffers on this device may take together. What OpenCL reports, on a CPU at least three quarters of the
  /// machine's memory (PoCL reports only a part of what can be had).
  std::size_t MemoryLimit() const { return this->Memory.Limit(); }
  std::size_t AllocationLimit() const { return this->LargestAllocation; } ///< largest single buffer, bytes
  /// Large arrays lie in host memory: sweeps are to stream them.
  bool Streams() const { return this->Budget.hostFrom != MemoryBudget::NoLimit; }
  /// Kernels work on host memory in place, so that copies would gain nothing. What TYNDALL_WITHOUT calls `host_memory`
  /// is left out, as extensions are.
  bool SharesHostMemory() const { return this->Cpu && !IsHidden("host_memory"); }
  /// Of a core, about: what its own caches hold, and its part of those that all share. None where TYNDALL_WITHOUT names
  /// `cache`.
  std::size_t CacheBytes() const { return IsHidden("cache") ? 0 : std::size_t{ 2 } << 20; }
  std::size_t HostBytes() const { return this->OnHost.InUse(); }    ///< of arrays in host memory
  std::size_t PeakHostBytes() const { return this->OnHost.Peak(); } ///< largest of them
  std::size_t BytesInUse() const { return this->Memory.InUse(); }
  std::size_t PeakBytes() const { return this->Memory.Peak(); } ///< largest BytesInUse since ResetPeak
  void ResetPeak() { this->Memory.ResetPeak(); }

  /// A kernel of the program that `source` makes. Programs are kept, so that asking again with the same source and
  /// options costs nothing. The kernel is the caller's own: two threads that ask for one get two, for OpenCL does not
  /// let them set arguments of the same.
  /// @param source  the text of a .cl file with what it includes (kernel_source::...)
  /// @param options  compiler options, e.g. "-DCHANNELS=3"
  /// @throws DeviceError with the build log
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options = {});

  /// Memory of a buffer.
  struct Allocation
  {
    cl::Buffer memory;
    bool onHost = false; ///< in host memory, which no budget counts
  };
  /// @throws DeviceError if `bytes` more do not fit; `what` says what they are for
  Allocation Allocate(
    std::size_t bytes, cl_mem_flags flags, const char* what, Residence residence = Residence::AsBudgetSays);
  void Release(std::size_t bytes, bool onHost);

  const cl::Context& Context() const { return this->TheContext; }
  cl::CommandQueue& Queue() { return this->TheQueue; }
  /// Another in-order queue, whose events know when they began and ended. What is on both may be done side by side.
  cl::CommandQueue AnotherQueue() const { return { this->TheContext, this->TheDevice, CL_QUEUE_PROFILING_ENABLE }; }
  void Finish();
  /// To be called before other waits for what was queued, e.g. a blocking read: where a program was compiled since the
  /// last one this waits itself, and this thread's CompilationListener hears of it. PoCL compiles the rest of a kernel
  /// when it first runs.
  void AwaitFirstRuns();

  /// tyndall::TakePages of a buffer of `bytes` that will be written all over. Nothing where the device has memory of
  /// its own, nor of a few pages.
  void TakePages(const cl::Buffer& memory, std::size_t bytes) const;

  /// Note that work of about so many seconds was queued, and wait for all of it once that is a tenth of a second:
  /// progress is reported and an abort noticed that often, while short kernels follow each other without the host.
  void Queued(double seconds);

  /// Seconds by the clock that work is shared out by: WorkSeconds, or that of a test, set before work begins.
  double Now() const { return this->TheClock(); }
  void SetClock(Clock clock) { this->TheClock = std::move(clock); }

private:
  /// A program, built by whichever thread needs it first. Only threads that need the same one wait.
  struct KeptProgram
  {
    std::timed_mutex Building;
    cl::Program Program;
    bool IsBuilt = false;
  };

  /// What was built for the device, for all who see it.
  struct KeptPrograms
  {
    std::mutex Guard; ///< of the map, not of what is in it
    std::map<std::string, std::shared_ptr<KeptProgram>> All;
    std::atomic<bool> CompiledSince{ false }; ///< the last wait for what was queued
  };

  static bool IsHidden(const std::string& name);
  [[noreturn]] void Complain(const char* what, std::size_t bytes, const std::string& cause, const char* advice) const;
  Allocation AllocateOnHost(std::size_t bytes, cl_mem_flags flags, const char* what);
  cl::Program ProgramOf(const char* kernel, const std::string& text, const std::string& options);
  cl::Program Build(const char* kernel, const std::string& text, const std::string& options);

  cl::Device TheDevice;
  cl::Context TheContext;
  cl::CommandQueue TheQueue;
  std::string DeviceName;
  std::string Extensions;
  std::string CacheFolder;
  bool Cpu = true;
  int Units = 1;
  int VectorWidth = 1;
  std::size_t LargestAllocation = 0;
  Device* Whole = nullptr; ///< null: this is the whole
  MemoryBudget Budget;     ///< of a part
  MemoryCount Memory;
  MemoryCount OnHost;
  std::atomic<double> SecondsQueued{ 0.0 };
  Clock TheClock = WorkSeconds;
  std::shared_ptr<KeptPrograms> Programs;
};
}
