#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

namespace tyndall
{
/// A monotonic clock: seconds since an arbitrary start. Work that is distributed by measured run times takes its clock
/// as a parameter, so that tests can control it.
using Clock = std::function<double()>;

/// The machine's clock.
inline double ClockSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Number of kernels that this process's devices have created for the first time. Each is compiled, or read from a
/// cache, at its first run; a timing during which this number does not change includes no compilation.
std::size_t KernelsMade();
/// Called by devices when a kernel of a program, which must not be destroyed, is created.
void NoteKernel(const void* program, const char* name);

/// ClockSeconds less the time spent compiling kernels: this process's work clock.
double WorkSeconds();

/// WorkSeconds stands still during the lifetime of such an object.
class WhileCompiling
{
public:
  WhileCompiling();
  ~WhileCompiling();
  WhileCompiling(const WhileCompiling&) = delete;
  WhileCompiling& operator=(const WhileCompiling&) = delete;
};

/// During its lifetime, `call` runs about ten times a second in the thread that created it, whenever that thread waits
/// for a device's compiler (seconds, if the kernels are not cached). If a thread has several listeners, the latest one
/// is called.
class CompilationListener
{
public:
  using Call = std::function<void()>; ///< must not throw

  explicit CompilationListener(Call call);
  ~CompilationListener();
  CompilationListener(const CompilationListener&) = delete;
  CompilationListener& operator=(const CompilationListener&) = delete;

  /// The listener of this thread, or null.
  static const CompilationListener* OfThisThread();

  /// Waits until isDone(duration) returns true, and calls the listener each time it returns false.
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
  /// Reading from the compiler's cache takes less than this.
  static constexpr std::chrono::milliseconds Patience{ 150 };

  Call TheCall;
  const CompilationListener* Before;
};
}
