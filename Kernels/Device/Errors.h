#pragma once

#include <stdexcept>
#include <string>

namespace tyndall
{
/// Device failure: no device, a kernel that does not build, too little memory. The text names the device, the cause and
/// the remedy, and is shown to the user unchanged.
struct DeviceError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Invalid input, e.g. a negative coefficient or a grid without voxels. The text states the error, its location and the
/// remedy.
struct InvalidInput : std::invalid_argument
{
  using std::invalid_argument::invalid_argument;
};

/// Checks a condition on the input.
/// @throws InvalidInput with the message `text` if `holds` is false
inline void Require(bool holds, const std::string& text)
{
  if (!holds)
  {
    throw InvalidInput(text);
  }
}

/// Abort of a long computation whose Monitor returned false. Not an error: nothing is shown to the user.
struct Aborted : std::runtime_error
{
  Aborted()
    : std::runtime_error("aborted")
  {
  }
};
}
