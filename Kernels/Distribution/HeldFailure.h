#pragma once

#include <exception>
#include <functional>
#include <stdexcept>

namespace tyndall
{
/// A rank received a shorter message than it expected. Communicator::Collective reports the error that caused it if
/// another rank threw one.
struct MissingMessage : std::runtime_error
{
  MissingMessage()
    : std::runtime_error("Ranks were not sent as much as they wait for, and none says why: something that they were "
                         "given differs. Give all ranks the same properties.")
  {
  }
};

/// Holds the first error of a rank while others still wait for its messages: the rank continues, sends empty messages,
/// and throws at the end.
struct HeldFailure
{
  /// Runs `work` and holds what it throws; does nothing after an earlier failure.
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

  /// Throws the held error. Call it at the end, within Communicator::Collective.
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

  bool broken = false; ///< this rank has failed, or one upstream of it
  std::exception_ptr error;
};
}
