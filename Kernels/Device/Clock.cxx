#include "Device/Clock.h"

#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
const CompilationListener*& Last()
{
  thread_local const CompilationListener* last = nullptr;
  return last;
}

struct Made
{
  std::mutex Guard;
  std::set<std::pair<const void*, std::string>> Kernels;
};

Made& AllMade()
{
  static auto& made = *new Made; // never destroyed, since kernels may be created until the process ends
  return made;
}
}

std::size_t KernelsMade()
{
  Made& made = AllMade();
  const std::lock_guard<std::mutex> lock(made.Guard);
  return made.Kernels.size();
}

void NoteKernel(const void* program, const char* name)
{
  Made& made = AllMade();
  const std::lock_guard<std::mutex> lock(made.Guard);
  made.Kernels.insert({ program, name });
}

namespace
{
struct Compiling
{
  std::mutex Guard;
  int Threads = 0;
  /// Seconds. A period is a time during which at least one thread compiles. `Since`: start of the current period.
  /// `Before`: total duration of earlier periods.
  double Since = 0.0, Before = 0.0;
};

Compiling& TheCompiling()
{
  static auto& compiling = *new Compiling;
  return compiling;
}
}

double WorkSeconds()
{
  Compiling& compiling = TheCompiling();
  const std::lock_guard<std::mutex> lock(compiling.Guard);
  return (compiling.Threads > 0 ? compiling.Since : ClockSeconds()) - compiling.Before;
}

WhileCompiling::WhileCompiling()
{
  Compiling& compiling = TheCompiling();
  const std::lock_guard<std::mutex> lock(compiling.Guard);
  compiling.Since = compiling.Threads++ == 0 ? ClockSeconds() : compiling.Since;
}

WhileCompiling::~WhileCompiling()
{
  Compiling& compiling = TheCompiling();
  const std::lock_guard<std::mutex> lock(compiling.Guard);
  compiling.Before += --compiling.Threads == 0 ? ClockSeconds() - compiling.Since : 0.0;
}

CompilationListener::CompilationListener(Call call)
  : TheCall(std::move(call))
  , Before(std::exchange(Last(), this))
{
}

CompilationListener::~CompilationListener()
{
  Last() = this->Before;
}

const CompilationListener* CompilationListener::OfThisThread()
{
  return Last();
}
}
