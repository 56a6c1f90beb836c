#pragma once

#include <functional>
#include <string>

/// How work ends that may fail.
namespace tyndall
{
/// Thrown where an input is empty because the filter before failed, which has said why.
struct InputFailed
{
};

/// Thrown where an input is empty, and is meant to be.
struct InputIsEmpty
{
};

struct Ending
{
  enum Kind
  {
    Done,
    Aborted,     ///< no error: nothing is to be shown
    InputFailed, ///< the filter before has said why
    Empty,       ///< no error: there is nothing to work on
    Failed,
  };

  Kind kind = Done;
  std::string why; ///< of Failed: a text for users
};

/// Does something and catches whatever it throws.
Ending EndingOf(const std::function<void()>& work);

/// Throws what EndingOf makes the same ending of; of Failed InvalidInput.
void Throw(const Ending& ending);
}
