#pragma once

#include <stdexcept>
#include <string>

namespace tyndall
{
/// Something about the device: none there, a kernel that does not build, too little memory. The text names the device,
/// the cause and what to do; it is meant to be shown to the user as it is.
struct DeviceError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Input that has no meaning: a negative coefficient, a grid without voxels. The text names what, where and what to do.
struct InvalidInput : std::invalid_argument
{
  using std::invalid_argument::invalid_argument;
};

/// @throws InvalidInput with this text where `holds` is false
inline void Require(bool holds, const std::string& text)
{
  if (!holds)
  {
    throw InvalidInput(text);
  }
}

/// Thrown out of a long computation when its Monitor said stop. Not an error: nothing is to be shown.
struct Aborted : std::runtime_error
{
  Aborted()
    : std::runtime_error("aborted")
  {
  }
};
}
