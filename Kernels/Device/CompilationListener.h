#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

namespace tyndall
{
/// Kernels that devices of this process have made for the first time. Each is compiled, or read from a cache, when it
/// first runs: work during which this number stays is measured without that.
std::size_t KernelsMade();
/// For devices: of a program, which must stay, one was made.
void NoteKernel(const void* program, const char* name);

/// ClockSeconds without those in which kernels were compiled: this process's clock of work.
double WorkSeconds();

/// While one lives, WorkSeconds stands still.
class WhileCompiling
{
public:
  WhileCompiling();
  ~WhileCompiling();
  WhileCompiling(const WhileCompiling&) = delete;
  WhileCompiling& operator=(const WhileCompiling&) = delete;
};

/// While one lives, it is called about ten times a second in the thread that made it whenever that thread waits for a
/// device's compiler, which takes seconds where nobody has compiled the kernels before. Of several in a thread the last
/// one is called.
class CompilationListener
{
public:
  using Call = std::function<void()>; ///< must not throw

  explicit CompilationListener(Call call);
  ~CompilationListener();
  CompilationListener(const CompilationListener&) = delete;
  CompilationListener& operator=(const CompilationListener&) = delete;

  /// That of this thread, or null.
  static const CompilationListener* OfThisThread();

  /// Waits until isDone(for so long) says so; calls after each of these times that it did not.
  /// @return whether it called
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
  /// What is read from the compiler's cache is there sooner.
  static constexpr std::chrono::milliseconds Patience{ 150 };

  Call TheCall;
  const CompilationListener* Before;
};
}
