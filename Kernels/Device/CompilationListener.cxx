#include "Device/CompilationListener.h"

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
