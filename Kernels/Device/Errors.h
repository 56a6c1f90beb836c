#pragma once

#include <stdexcept>
#include <string>

namespace tyndall
{
/// A device failure: no device, a kernel that does not build, too little memory. The text names the device, the cause
/// and the remedy, and is shown to the user unchanged.
struct DeviceError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Invalid input, e.g. a negative coefficient or a grid without voxels. The text says what is wrong, where, and what to
/// do.
struct InvalidInput : std::invalid_argument
{
  using std::invalid_argument::invalid_argument;
};

/// @throws InvalidInput with this text if `holds` is false
inline void Require(bool holds, const std::string& text)
{
  if (!holds)
  {
    throw InvalidInput(text);
  }
}

/// Thrown out of a long computation when its Monitor returned false. Not an error: nothing is shown to the user.
struct Aborted : std::runtime_error
{
  Aborted()
    : std::runtime_error("aborted")
  {
  }
};
}
