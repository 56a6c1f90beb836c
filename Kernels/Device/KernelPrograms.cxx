#include "Device/KernelPrograms.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Device/PoclCache.h"

#include <functional>
#include <future>
#include <utility>

namespace tyndall
{
namespace
{
/// Text prepended to every source, which turns off a warning of Clang: the calling convention of wide vectors depends
/// on the target. This does not matter, because kernel functions are never called from outside.
const char* const WideVectors = "#ifdef __clang__\n#pragma clang diagnostic ignored \"-Wpsabi\"\n#endif\n";

std::atomic<bool> AnyCompiled{ false };

/// Advice to delete the folder of compiled kernels, for the message of a failure that states no reason. Empty if the
/// folder is not known.
std::string AdviceOnCache(const std::string& folder)
{
  return folder.empty()
    ? std::string()
    : " Its compiled kernels in \"" + folder + "\" may be damaged: delete that folder and start again.";
}

std::unique_lock<std::timed_mutex> LockHeard(std::timed_mutex& mutex)
{
  std::unique_lock<std::timed_mutex> lock(mutex, std::defer_lock);
  if (const CompilationListener* listener = CompilationListener::OfThisThread())
  {
    listener->Wait([&](auto patience) { return lock.try_lock_for(patience); });
  }
  else
  {
    lock.lock();
  }
  return lock;
}

/// Calls `build`. Meanwhile, this thread's CompilationListener (a progress callback), if there is one, is called
/// repeatedly.
/// @return whether the call took longer than reading a program from a cache; false without a listener
bool CallHeard(const std::function<void()>& build)
{
  const CompilationListener* listener = CompilationListener::OfThisThread();
  if (!listener)
  {
    build();
    return false;
  }
  std::future<void> built = std::async(std::launch::async, build);
  const bool tookLong =
    listener->Wait([&](auto patience) { return built.wait_for(patience) == std::future_status::ready; });
  built.get();
  return tookLong;
}

/// Builds a program.
/// @param tookLong  set to true if the build ran longer than reading from a cache takes
/// @return the compiler's log if the build fails; empty if it succeeds
std::string LogOfFailure(cl::Program& program, const cl::Device& device, const std::string& options, bool& tookLong)
{
  try
  {
    tookLong = CallHeard([&] { program.build({ device }, options.c_str()); }) || tookLong;
    return {};
  }
  catch (const cl::Error& failed)
  {
    const std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    return log.empty() ? "OpenCL code " + std::to_string(failed.err()) : log;
  }
}
}

bool KernelPrograms::HaveCompiled()
{
  return AnyCompiled;
}

KernelPrograms::KernelPrograms(
  const cl::Context& context, const cl::Device& device, std::string deviceName, std::string cacheFolder)
  : Context(context)
  , TheDevice(device)
  , DeviceName(std::move(deviceName))
  , CacheFolder(std::move(cacheFolder))
{
}

cl::Kernel KernelPrograms::Kernel(const char* name, std::string_view source, const std::string& options)
{
  try
  {
    const cl::Program program = this->ProgramOf(name, std::string(source), "-cl-std=CL1.2 " + options);
    NoteKernel(program(), name);
    return cl::Kernel(program, name);
  }
  catch (const cl::Error& error)
  {
    throw DeviceError("The kernel " + std::string(name) + " cannot be made on " + this->DeviceName + ": " +
      error.what() + " gave " + std::to_string(error.err()) + "." + AdviceOnCache(this->CacheFolder));
  }
}

cl::Program KernelPrograms::ProgramOf(const char* kernel, const std::string& text, const std::string& options)
{
  std::shared_ptr<KeptProgram> kept;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    std::shared_ptr<KeptProgram>& known = this->All[options + '\n' + text];
    if (!known)
    {
      known = std::make_shared<KeptProgram>();
    }
    kept = known;
  }
  const std::unique_lock<std::timed_mutex> lock = LockHeard(kept->Building);
  if (!kept->IsBuilt)
  {
    kept->Program = this->Build(kernel, text, options);
    kept->IsBuilt = true;
  }
  return kept->Program;
}

cl::Program KernelPrograms::Build(const char* kernel, const std::string& text, const std::string& options)
{
  if (!this->CacheFolder.empty())
  {
    RequireRoom(this->CacheFolder);
  }
  const WhileCompiling compiling;
  const BuildMark mark(this->CacheFolder);
  constexpr double ofCompiling = 0.1; // seconds; a build that takes less has read the program from the cache
  const double begun = ClockSeconds();
  cl::Program program;
  bool tookLong = false;
  const std::string log = BuildBesideOthers([&] {
    program = cl::Program(this->Context, WideVectors + text);
    return LogOfFailure(program, this->TheDevice, options, tookLong);
  });
  if (!log.empty())
  {
    throw DeviceError("The kernel " + std::string(kernel) + " does not build on " + this->DeviceName + " with \"" +
      options + "\":\n" + log +
      (log.find("error") == std::string::npos ? AdviceOnCache(this->CacheFolder) : std::string()));
  }
  AnyCompiled = AnyCompiled || ClockSeconds() - begun > ofCompiling;
  if (tookLong)
  {
    this->CompiledSince = true;
  }
  return program;
}
}
