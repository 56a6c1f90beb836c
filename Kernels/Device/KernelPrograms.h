#pragma once

#include "Device/OpenCL.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace tyndall
{
/// Cache of the programs built for one device. The device shares it with its views, the objects by which several solves
/// use one device, each with a memory budget of its own. Thread-safe.
class KernelPrograms
{
public:
  /// Creates an empty cache of programs for a device.
  /// @param cacheFolder  as in Device's constructor
  KernelPrograms(const cl::Context& context, const cl::Device& device, std::string deviceName, std::string cacheFolder);

  /// Returns a kernel of a program, which is built unless it is in the cache. Device::Kernel calls this function.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options);

  /// Whether a program was compiled since the last call, in a build so slow that it notified a CompilationListener.
  bool TakeCompiled() { return this->CompiledSince.exchange(false); }
  static bool HaveCompiled(); ///< whether this process has compiled a program rather than read it from a cache

private:
  /// A cached program. The first thread that needs it builds it; threads that need other programs do not wait.
  struct KeptProgram
  {
    std::timed_mutex Building;
    cl::Program Program;
    bool IsBuilt = false;
  };
  cl::Program ProgramOf(const char* kernel, const std::string& text, const std::string& options);
  cl::Program Build(const char* kernel, const std::string& text, const std::string& options);

  const cl::Context Context;
  const cl::Device TheDevice;
  const std::string DeviceName, CacheFolder;
  std::mutex Guard; ///< protects the map All, not its elements
  std::map<std::string, std::shared_ptr<KeptProgram>> All;
  std::atomic<bool> CompiledSince{ false };
};
}
