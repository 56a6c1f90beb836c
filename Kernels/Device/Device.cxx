#include "Device.h"

#include "HostMemory.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sys/mman.h>
#include <vector>

namespace tyndall
{
namespace
{
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

/// Every device of every platform. A platform whose driver fails is passed over, not fatal: others may work.
std::vector<Candidate> AllDevices(std::string& troubles)
{
  std::vector<cl::Platform> platforms;
  try
  {
    cl::Platform::get(&platforms);
  }
  catch (const cl::Error& error)
  {
    troubles += " (" + std::string(error.what()) + " gave " + std::to_string(error.err()) + ")";
  }
  std::vector<Candidate> found;
  for (const cl::Platform& platform : platforms)
  {
    std::vector<cl::Device> devices;
    try
    {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    }
    catch (const cl::Error& error)
    {
      troubles += " (platform " + platform.getInfo<CL_PLATFORM_NAME>() + " gave " + std::to_string(error.err()) +
        "; is POCL_CACHE_DIR a folder that can be written?)";
    }
    for (const cl::Device& device : devices)
    {
      found.push_back(
        { platform, device, device.getInfo<CL_DEVICE_NAME>() + " [" + platform.getInfo<CL_PLATFORM_NAME>() + "]" });
    }
  }
  return found;
}

std::size_t Choose(const std::vector<Candidate>& candidates, const std::string& name)
{
  const std::string wanted = Lower(name.empty() ? "portable computing language" : name);
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
  // Never destroyed: an OpenCL platform may be gone before our statics are, and must not be called then.
  static auto& known = *new std::map<std::string, std::shared_ptr<Device>>;
  const char* variable = std::getenv("TYNDALL_DEVICE");
  const std::string wanted = !name.empty() || !variable ? name : std::string(variable);

  std::string troubles;
  const std::vector<Candidate> candidates = AllDevices(troubles);
  if (candidates.empty())
  {
    throw DeviceError("There is no OpenCL device on this machine" + troubles +
      ". Install one: Debian's package pocl-opencl-icd runs OpenCL on the CPU.");
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
      ". Choose a part of one of these names (Device property or TYNDALL_DEVICE), or leave it empty.");
  }
  std::shared_ptr<Device>& device = known[candidates[chosen].Label];
  if (!device)
  {
    device = std::make_shared<Device>(candidates[chosen].Platform, candidates[chosen].Device);
  }
  return device;
}

Device::Device(const cl::Platform& platform, const cl::Device& device)
  : TheDevice(device)
  , DeviceName(device.getInfo<CL_DEVICE_NAME>() + " [" + platform.getInfo<CL_PLATFORM_NAME>() + "]")
  , Extensions(device.getInfo<CL_DEVICE_EXTENSIONS>())
  , Cpu((device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0)
  , Units(static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()))
  , VectorWidth(static_cast<int>(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>()))
  , Limit(device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>())
  , LargestAllocation(device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>())
{
  if (this->Cpu)
  {
    this->Limit = std::max<std::size_t>(this->Limit, HostMemory() / 4 * 3);
  }
  try
  {
    this->TheContext = cl::Context(device);
    this->TheQueue = cl::CommandQueue(this->TheContext, device);
  }
  catch (const cl::Error& error)
  {
    throw DeviceError("The OpenCL device " + this->DeviceName + " cannot be used: " + error.what() + " gave " +
      std::to_string(error.err()) + ". Choose another device.");
  }
}

bool Device::HasExtension(const std::string& name) const
{
  const char* hidden = std::getenv("TYNDALL_WITHOUT");
  if (hidden && (" " + std::string(hidden) + " ").find(" " + name + " ") != std::string::npos)
  {
    return false;
  }
  return (" " + this->Extensions + " ").find(" " + name + " ") != std::string::npos;
}

cl::Kernel Device::Kernel(const char* name, std::initializer_list<std::string_view> sources, const std::string& options)
{
  std::string text;
  for (std::string_view source : sources)
  {
    text += source;
  }
  const std::string all = "-cl-std=CL1.2 " + options;
  const std::string key = all + '\n' + text;
  auto known = this->Programs.find(key);
  try
  {
    if (known == this->Programs.end())
    {
      cl::Program program(this->TheContext, text);
      try
      {
        program.build({ this->TheDevice }, all.c_str());
      }
      catch (const cl::Error&)
      {
        throw DeviceError("The kernel " + std::string(name) + " does not build on " + this->DeviceName + " with \"" +
          all + "\":\n" + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(this->TheDevice));
      }
      known = this->Programs.emplace(key, program).first;
    }
    return cl::Kernel(known->second, name);
  }
  catch (const cl::Error& error)
  {
    throw DeviceError("The kernel " + std::string(name) + " cannot be made on " + this->DeviceName + ": " +
      error.what() + " gave " + std::to_string(error.err()) + ".");
  }
}

namespace
{
constexpr std::size_t HugePage = std::size_t(1) << 21;

/// A buffer of a CPU in pages of 2 MB where the system has them to give: marching across a large grid otherwise waits for the
/// translation of addresses.
cl::Buffer InHugePages(const cl::Context& context, cl_mem_flags flags, std::size_t bytes)
{
  void* memory = nullptr;
  if (posix_memalign(&memory, HugePage, (bytes + HugePage - 1) / HugePage * HugePage) != 0)
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
}

cl::Buffer Device::Allocate(std::size_t bytes, cl_mem_flags flags, const char* what)
{
  const auto complain = [&](const std::string& cause) {
    throw DeviceError("Not enough memory on " + this->DeviceName + " for " + what + ": " + std::to_string(bytes) +
      " bytes are needed, " + cause + ". Use a coarser grid, fewer directions, or a device with more memory.");
  };
  if (bytes > this->LargestAllocation)
  {
    complain("the largest single allocation is " + std::to_string(this->LargestAllocation));
  }
  if (this->InUse + bytes > this->Limit)
  {
    complain(std::to_string(this->Limit - this->InUse) + " of " + std::to_string(this->Limit) + " are left");
  }
  cl_int status = CL_SUCCESS;
  cl::Buffer buffer;
  try
  {
    buffer = this->Cpu && bytes >= HugePage ? InHugePages(this->TheContext, flags, bytes)
                                            : cl::Buffer(this->TheContext, flags, bytes, nullptr, &status);
  }
  catch (const cl::Error& error)
  {
    complain("the driver refused them (" + std::to_string(error.err()) + ")");
  }
  this->InUse += bytes;
  this->Peak = std::max(this->Peak, this->InUse);
  return buffer;
}

void Device::Finish()
{
  this->TheQueue.finish();
  this->SecondsQueued = 0.0;
}

void Device::Queued(double seconds)
{
  this->SecondsQueued += seconds;
  if (this->SecondsQueued >= 0.1)
  {
    this->Finish();
  }
}
}
