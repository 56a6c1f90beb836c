#include "Device/Device.h"

#include "Device/HostMemory.h"
#include "Device/PoclCache.h"

#include <cctype>
#include <cstdlib>
#include <optional>
#include <sys/mman.h>
#include <sys/resource.h>
#include <thread>
#include <utility>

namespace tyndall
{
namespace
{
const char* const Pocl = "portable computing language"; ///< text that PoCL's platform name contains

std::string Lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

struct Candidate
{
  cl::Platform Platform;
  cl::Device Device;
  std::string Label;
};

/// State shared by all threads of the process.
struct Shared
{
  std::mutex Guard; ///< protects all members of this structure
  std::map<std::string, std::shared_ptr<Device>> Devices;
  std::optional<PoclCache> Cache; ///< cache folder of PoCL; no value until PoCL has been asked for devices
  std::vector<std::string> Warnings;
};

/// The shared state. It is never destroyed, because an OpenCL platform may be unloaded before static objects are
/// destroyed, and must not be called then.
Shared& TheShared()
{
  static auto& shared = *new Shared;
  return shared;
}

/// Records the checksums of compiled programs. Called at the end of the process, so that the next process can detect
/// files that were damaged in the meantime.
void NoteWhatWasCompiled()
{
  if (KernelPrograms::HaveCompiled())
  {
    NoteChecksums(TheShared().Cache->folder);
  }
}

bool IsPocl(const cl::Platform& platform)
{
  return Lower(platform.getInfo<CL_PLATFORM_NAME>()).find(Pocl) != std::string::npos;
}

/// The devices of a platform.
/// @throws cl::Error; DeviceError if PoCL finds no folder to write to; PoCL must then not be used
std::vector<cl::Device> DevicesOf(const cl::Platform& platform, Shared& shared)
{
  if (IsPocl(platform) && !shared.Cache)
  {
    shared.Cache = PreparePocl();
    std::atexit(NoteWhatWasCompiled);
    if (!shared.Cache->warning.empty())
    {
      shared.Warnings.push_back(shared.Cache->warning);
    }
  }
  std::vector<cl::Device> devices;
  platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
  return devices;
}

/// Memory limit of this process, MiB; no value if it is unlimited.
std::optional<std::size_t> LimitOfMemory()
{
  struct rlimit limit = {};
  const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return limited ? std::optional<std::size_t>(limit.rlim_cur >> 20) : std::nullopt;
}

/// Sentence for an error message. It says that an OpenCL driver needs more memory, and how to provide it.
std::string NeedsMemory()
{
  const std::optional<std::size_t> limit = LimitOfMemory();
  return " A driver of OpenCL takes some hundred MiB of memory, " +
    (limit ? "and this process may take " + std::to_string(*limit) + " MiB in all (ulimit -v): let it take more."
           : std::string("and there is too little: end other programs."));
}

/// All devices of all platforms. A platform whose driver fails is skipped, since others may work.
/// @param troubles  receives a sentence for each skipped platform
std::vector<Candidate> AllDevices(Shared& shared, std::string& troubles)
{
  std::vector<cl::Platform> platforms;
  bool tooLittleMemory = false;
  try
  {
    cl::Platform::get(&platforms);
  }
  catch (const cl::Error& error) // no driver is installed, or none could be loaded
  {
    tooLittleMemory = error.err() == CL_OUT_OF_HOST_MEMORY;
  }
  if (platforms.empty())
  {
    // The OpenCL loader also reports that there is no driver if memory is short.
    troubles += tooLittleMemory || LimitOfMemory() ? NeedsMemory() + " If there is no driver, install one:"
                                                   : std::string(" Install one:");
    troubles += " Debian's package pocl-opencl-icd, or tyndall[cpu] of pip, runs OpenCL on the CPU.";
  }
  std::vector<Candidate> found;
  for (const cl::Platform& platform : platforms)
  {
    const std::string name = platform.getInfo<CL_PLATFORM_NAME>();
    try
    {
      for (const cl::Device& device : DevicesOf(platform, shared))
      {
        found.push_back({ platform, device, device.getInfo<CL_DEVICE_NAME>() + " [" + name + "]" });
      }
    }
    catch (const cl::Error& error)
    {
      const std::string ofMemory = error.err() == CL_OUT_OF_HOST_MEMORY ? NeedsMemory() : std::string();
      troubles += " The platform " + name + " is installed and gives none (OpenCL error " +
        std::to_string(error.err()) + ")." +
        (ofMemory.empty() ? " Start the program anew" +
              std::string(IsPocl(platform) ? " with POCL_CACHE_DIR a folder that can be written" : "") +
              ", or install another driver."
                          : ofMemory);
    }
    catch (const DeviceError& error)
    {
      troubles += std::string(" ") + error.what();
    }
  }
  return found;
}

std::size_t Choose(const std::vector<Candidate>& candidates, const std::string& name)
{
  const std::string wanted = Lower(name.empty() ? Pocl : name);
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    if (Lower(candidates[i].Label).find(wanted) != std::string::npos)
    {
      return i;
    }
  }
  return name.empty() ? 0 : candidates.size();
}
}

std::shared_ptr<Device> Device::Find(const std::string& name)
{
  Shared& shared = TheShared();
  const std::lock_guard<std::mutex> lock(shared.Guard);
  const char* variable = std::getenv("TYNDALL_DEVICE");
  const std::string wanted = !name.empty() || !variable ? name : std::string(variable);

  std::string troubles;
  const std::vector<Candidate> candidates = AllDevices(shared, troubles);
  if (candidates.empty())
  {
    throw DeviceError("There is no OpenCL device to work on." + troubles);
  }
  const std::size_t chosen = Choose(candidates, wanted);
  if (chosen == candidates.size())
  {
    std::string there;
    for (const Candidate& candidate : candidates)
    {
      there += (there.empty() ? "" : ", ") + candidate.Label;
    }
    throw DeviceError("No OpenCL device has \"" + wanted + "\" in its name. There are: " + there +
      ". Choose a part of one of these names (Device property or TYNDALL_DEVICE), or leave it empty." + troubles);
  }
  std::shared_ptr<Device>& device = shared.Devices[candidates[chosen].Label];
  if (!device)
  {
    const cl::Platform& platform = candidates[chosen].Platform;
    device = std::make_shared<Device>(
      platform, candidates[chosen].Device, IsPocl(platform) ? shared.Cache->folder : std::string());
  }
  return device;
}

std::vector<std::string> Device::TakeWarnings()
{
  Shared& shared = TheShared();
  const std::lock_guard<std::mutex> lock(shared.Guard);
  return std::exchange(shared.Warnings, {});
}

namespace
{
/// Limit for all buffers on a device together, bytes; at least three quarters of the machine's memory on a CPU.
std::size_t MemoryOf(const cl::Device& device)
{
  const std::size_t said = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  const bool cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
  return cpu ? std::max<std::size_t>(said, HostMemory() / 4 * 3) : said;
}

/// Whether a device runs the CPU variants of kernels. The environment variable TYNDALL_AS_GPU selects the GPU variants
/// on a CPU, for tests.
bool IsTakenAsCpu(const cl::Device& device)
{
  return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0 && !std::getenv("TYNDALL_AS_GPU");
}
}

Device::Device(const cl::Platform& platform, const cl::Device& device, std::string cacheFolder)
  : TheDevice(device)
  , DeviceName(device.getInfo<CL_DEVICE_NAME>() + " [" + platform.getInfo<CL_PLATFORM_NAME>() + "]")
  , Extensions(device.getInfo<CL_DEVICE_EXTENSIONS>())
  , Cpu(IsTakenAsCpu(device))
  , Units(static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()))
  , VectorWidth(static_cast<int>(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>()))
  , LargestAllocation(device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>())
  , Memory(MemoryOf(device))
  , OnHost(HostMemory() / 4 * 3)
{
  try
  {
    this->TheContext = cl::Context(device);
    this->TheQueue = cl::CommandQueue(this->TheContext, device);
    this->Programs =
      std::make_shared<KernelPrograms>(this->TheContext, device, this->DeviceName, std::move(cacheFolder));
  }
  catch (const cl::Error& error)
  {
    throw DeviceError("The OpenCL device " + this->DeviceName + " cannot be used: " + error.what() + " gave " +
      std::to_string(error.err()) + ". Choose another device.");
  }
}

Device::Device(Device& whole, const MemoryBudget& budget)
  : TheDevice(whole.TheDevice)
  , TheContext(whole.TheContext)
  , TheQueue(whole.TheQueue)
  , DeviceName(whole.DeviceName)
  , Extensions(whole.Extensions)
  , Cpu(whole.Cpu)
  , Units(whole.Units)
  , VectorWidth(whole.VectorWidth)
  , LargestAllocation(whole.LargestAllocation)
  , Whole(&whole)
  , Budget(budget)
  , Memory(whole.Budget.spills ? budget.bytes : std::min(budget.bytes, whole.Memory.Limit()))
  , OnHost(whole.OnHost.Limit())
  , TheClock(whole.TheClock)
  , Programs(whole.Programs)
{
}

namespace
{
/// Whether the environment variable TYNDALL_WITHOUT names a property (an extension, host_memory or cache). Tests use it
/// to run code for devices that lack the property.
bool IsHidden(const std::string& name)
{
  const char* hidden = std::getenv("TYNDALL_WITHOUT");
  return hidden && (" " + std::string(hidden) + " ").find(" " + name + " ") != std::string::npos;
}
}

bool Device::SharesHostMemory() const
{
  return this->Cpu && !IsHidden("host_memory");
}

std::size_t Device::CacheBytes() const
{
  return IsHidden("cache") ? 0 : std::size_t{ 2 } << 20;
}

bool Device::HasExtension(const std::string& name) const
{
  return !IsHidden(name) && (" " + this->Extensions + " ").find(" " + name + " ") != std::string::npos;
}

cl::Kernel Device::Kernel(const char* name, std::string_view source, const std::string& options)
{
  return this->Programs->Kernel(name, source, "-DFOR_CPU=" + std::to_string(this->Cpu) + " " + options);
}

std::string NameWithStreaming(const Device& ofSolve)
{
  const auto inMiB = [](std::size_t bytes) {
    return std::to_string((bytes + (std::size_t(1) << 20) - 1) >> 20) + " MiB";
  };
  if (ofSolve.PeakHostBytes() == 0)
  {
    return ofSolve.Name();
  }
  return ofSolve.Name() + ": " + inMiB(ofSolve.PeakBytes()) + " within the memory budget, " +
    inMiB(ofSolve.PeakHostBytes()) +
    (ofSolve.SharesHostMemory() ? " of volumes in host memory, in place" : " streamed from host memory");
}

namespace
{
/// A buffer of a CPU device in memory pages of 2 MB, if available. With small pages, address translation (TLB misses)
/// limits marches across a large grid.
cl::Buffer InHugePages(const cl::Context& context, cl_mem_flags flags, std::size_t bytes)
{
  void* memory = nullptr;
  if (posix_memalign(&memory, LargePage, (bytes + LargePage - 1) / LargePage * LargePage) != 0)
  {
    throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "posix_memalign");
  }
#ifdef MADV_HUGEPAGE
  madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  try
  {
    cl::Buffer buffer(context, flags | CL_MEM_USE_HOST_PTR, bytes, memory);
    buffer.setDestructorCallback([](cl_mem, void* held) { std::free(held); }, memory);
    return buffer;
  }
  catch (...)
  {
    std::free(memory);
    throw;
  }
}

[[noreturn]] void Complain(
  const Device& device, const char* what, std::size_t bytes, const std::string& cause, const char* advice)
{
  throw DeviceError("Not enough memory on " + device.Name() + " for " + what + ": " + std::to_string(bytes) +
    " bytes are needed, " + cause + ". Use " + advice + ".");
}
}

Device::Allocation Device::Allocate(std::size_t bytes, cl_mem_flags flags, const char* what, Residence residence)
{
  constexpr const char* Advice = "a coarser grid, fewer directions, or a device with more memory";
  const auto left = [this] {
    return std::to_string(this->Memory.Left()) + " of " + std::to_string(this->Memory.Limit());
  };
  if (this->Whole)
  {
    const bool streamed = bytes >= this->Budget.hostFrom && residence != Residence::Device;
    if (streamed || !this->Memory.Take(bytes))
    {
      if (!streamed && !this->Budget.spills)
      {
        Complain(*this, what, bytes, left() + " are left of the memory budget",
          "a larger MemoryBudget, a coarser grid, or fewer directions");
      }
      return this->AllocateOnHost(bytes, flags, what);
    }
    try
    {
      Allocation allocation = this->Whole->Allocate(bytes, flags, what, residence);
      // the device `Whole` is itself a view with a memory budget, and has placed the buffer in host memory
      if (allocation.onHost)
      {
        this->Memory.GiveBack(bytes);
        this->OnHost.Take(bytes);
      }
      return allocation;
    }
    catch (...)
    {
      this->Memory.GiveBack(bytes);
      throw;
    }
  }
  if (bytes > this->LargestAllocation)
  {
    Complain(*this, what, bytes, "the largest single allocation is " + std::to_string(this->LargestAllocation), Advice);
  }
  if (!this->Memory.Take(bytes)) // reserved before the allocation, so that another thread cannot reserve these bytes
  {
    Complain(*this, what, bytes, left() + " are left", Advice);
  }
  try
  {
    return { this->Cpu && bytes >= LargePage ? InHugePages(this->TheContext, flags, bytes)
                                             : cl::Buffer(this->TheContext, flags, bytes) };
  }
  catch (const cl::Error& error)
  {
    this->Memory.GiveBack(bytes);
    Complain(*this, what, bytes, "the driver refused them (" + std::to_string(error.err()) + ")", Advice);
  }
}

/// Allocates a buffer in host memory. Only for views, the devices that have the memory budget of a solve. If kernels
/// use host memory in place, the bytes count towards the memory of the device.
Device::Allocation Device::AllocateOnHost(std::size_t bytes, cl_mem_flags flags, const char* what)
{
  constexpr const char* Advice = "a coarser grid or fewer directions";
  if (!this->OnHost.Take(bytes))
  {
    Complain(*this, what, bytes, std::to_string(this->OnHost.Left()) + " are left of this machine's memory", Advice);
  }
  try
  {
    if (this->Whole->Whole)
    {
      return this->Whole->AllocateOnHost(bytes, flags, what);
    }
    return { this->SharesHostMemory() ? this->Whole->Allocate(bytes, flags, what).memory
                                      : cl::Buffer(this->TheContext, flags | CL_MEM_ALLOC_HOST_PTR, bytes),
      true };
  }
  catch (const cl::Error& error)
  {
    this->OnHost.GiveBack(bytes);
    Complain(
      *this, what, bytes, "the driver refused them in host memory (" + std::to_string(error.err()) + ")", Advice);
  }
  catch (...)
  {
    this->OnHost.GiveBack(bytes);
    throw;
  }
}

void Device::Release(std::size_t bytes, bool onHost)
{
  (onHost ? this->OnHost : this->Memory).GiveBack(bytes);
  if (this->Whole && this->Whole->Whole)
  {
    this->Whole->Release(bytes, onHost);
  }
  else if (this->Whole && (!onHost || this->SharesHostMemory()))
  {
    this->Whole->Release(bytes, false);
  }
}

void Device::Finish()
{
  this->SecondsQueued = 0.0; // reset first, so that work that other threads queue during the wait is counted
  this->AwaitFirstRuns();
  this->TheQueue.finish();
}

void Device::TakePages(const cl::Buffer& memory, std::size_t bytes) const
{
  void* const begin = this->Cpu && bytes >= 2 * LargePage ? memory.getInfo<CL_MEM_HOST_PTR>() : nullptr;
  if (begin)
  {
    tyndall::TakePages(begin, bytes);
  }
}

void Device::AwaitFirstRuns()
{
  const CompilationListener* listener = CompilationListener::OfThisThread();
  if (!listener || !this->Programs->TakeCompiled())
  {
    return;
  }
  const WhileCompiling compiling;
  cl::Event reached;
  this->TheQueue.enqueueMarkerWithWaitList(nullptr, &reached);
  this->TheQueue.flush();
  listener->Wait([&](std::chrono::duration<double> patience) {
    const auto isReached = [&] { return reached.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE; };
    const double end = ClockSeconds() + patience.count();
    while (!isReached() && ClockSeconds() < end)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return isReached();
  });
}

void Device::Queued(double seconds)
{
  double before = this->SecondsQueued;
  while (!this->SecondsQueued.compare_exchange_weak(before, before + seconds))
  {
  }
  if (before + seconds >= 0.1)
  {
    this->Finish();
  }
}
}
