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
/// Cache of the programs built for one device. The device shares the cache with its views, through which several solves
/// use the device, each with its own memory budget. Thread-safe.
class KernelPrograms
{
public:
  /// Creates an empty cache of programs for a device.
  /// @param cacheFolder  as in Device's constructor
  KernelPrograms(const cl::Context& context, const cl::Device& device, std::string deviceName, std::string cacheFolder);

  /// Returns a kernel of a program, which is built unless it is in the cache. Device::Kernel calls this function.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options);

  /// Whether, since the last call of this function, a program was compiled in a build so slow that it notified a
  /// CompilationListener.
  bool TakeCompiled() { return this->CompiledSince.exchange(false); }
  static bool HaveCompiled(); ///< whether this process has compiled a program rather than read it from a cache

private:
  /// A cached program. The first thread that needs the program builds it; other threads wait only if they need the same
  /// program.
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
