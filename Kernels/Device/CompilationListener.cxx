#include "Device/CompilationListener.h"

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
  static auto& made = *new Made; // never destroyed: kernels may be made until the end
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
