#pragma once

#include <exception>
#include <functional>
#include <stdexcept>

namespace tyndall
{
/// A rank was sent less than it waits for. Communicator::Collective tells what went wrong elsewhere before it.
struct MissingMessage : std::runtime_error
{
  MissingMessage()
    : std::runtime_error("Ranks were not sent as much as they wait for, and none says why: something that they were "
                         "given differs. Give all ranks the same properties.")
  {
  }
};

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

  /// In the end, within Communicator::Collective.
  void Throw() const
  {
    if (this->error)
    {
      std::rethrow_exception(this->error);
    }
    if (this->broken)
    {
      throw MissingMessage();
    }
  }

  bool broken = false; ///< something has gone wrong here, or on a rank before here
  std::exception_ptr error;
};
}
