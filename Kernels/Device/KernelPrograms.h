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
/// The programs built for one device, shared by all views of it. Thread-safe.
class KernelPrograms
{
public:
  /// @param cacheFolder  see Device
  KernelPrograms(const cl::Context& context, const cl::Device& device, std::string deviceName, std::string cacheFolder);

  /// See Device::Kernel.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options);

  /// Whether a program was compiled, slowly enough for a CompilationListener, since the last call.
  bool TakeCompiled() { return this->CompiledSince.exchange(false); }
  static bool HaveCompiled(); ///< whether this process has compiled a program rather than read it from a cache

private:
  /// A program, built by the thread that needs it first. Only threads that need the same program wait.
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
  std::mutex Guard; ///< protects the map, not its elements
  std::map<std::string, std::shared_ptr<KeptProgram>> All;
  std::atomic<bool> CompiledSince{ false };
};
}
