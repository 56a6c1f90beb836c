#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <functional>

namespace tyndall
{
/// Clock: monotonic time in seconds since an arbitrary start. Code that distributes work by measured run times has its
/// clock as a parameter, so that tests can control it.
using Clock = std::function<double()>;

/// Monotonic time of the machine, seconds.
inline double ClockSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of all threads of this process, seconds. Other load on the machine hardly affects it.
inline double CoreSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Number of different kernels that this process's devices have created. A kernel is compiled, or read from a cache,
/// when it first runs. If this number does not change while run time is measured, the time includes no compilation.
std::size_t KernelsMade();
/// Counts a kernel that a device has created.
/// @param program  program of the kernel, which must not be destroyed
void NoteKernel(const void* program, const char* name);

/// Time of this process without compilation, seconds: ClockSeconds minus the time spent compiling kernels.
double WorkSeconds();

/// Stops WorkSeconds during the lifetime of this object.
class WhileCompiling
{
public:
  WhileCompiling();
  ~WhileCompiling();
  WhileCompiling(const WhileCompiling&) = delete;
  WhileCompiling& operator=(const WhileCompiling&) = delete;
};

/// Callback during compilation, which takes seconds if the kernels are not cached. While this object exists, its `call`
/// runs every 150 ms in the thread that created it, whenever that thread waits for a device's compiler. If a thread has
/// several listeners, the latest one is called.
class CompilationListener
{
public:
  using Call = std::function<void()>; ///< function that the listener calls; must not throw

  explicit CompilationListener(Call call);
  ~CompilationListener();
  CompilationListener(const CompilationListener&) = delete;
  CompilationListener& operator=(const CompilationListener&) = delete;

  /// The listener that this thread created last and has not destroyed; null if there is none.
  static const CompilationListener* OfThisThread();

  /// Calls isDone(duration) until it returns true, and the listener after each false. isDone waits for at most
  /// `duration`.
  /// @return whether the listener was called
  template <class IsDone>
  bool Wait(const IsDone& isDone) const
  {
    bool called = false;
    while (!isDone(Patience))
    {
      this->TheCall();
      called = true;
    }
    return called;
  }

private:
  /// Time between two calls of the listener. Reading a program from the compiler's cache takes less.
  static constexpr std::chrono::milliseconds Patience{ 150 };

  Call TheCall;
  const CompilationListener* Before;
};
}
