#pragma once

#include <exception>
#include <functional>

namespace tyndall
{
/// What has gone wrong on a rank while others wait for what it sends: it goes on, sends nothing in each message, and
/// throws in the end.
struct HeldFailure
{
  /// Nothing any more once something has gone wrong.
  void Attempt(const std::function<void()>& work)
  {
    try
    {
      if (!this->broken)
      {
        work();
      }
    }
    catch (...)
    {
      this->error = std::current_exception();
      this->broken = true;
    }
  }

  /// In the end, within Communicator::Together.
  void Throw() const
  {
    if (this->error)
    {
      std::rethrow_exception(this->error);
    }
  }

  bool broken = false; ///< something has gone wrong here, or on a rank before here
  std::exception_ptr error;
};
}
