#include "Device/DeviceWords.h"

namespace tyndall
{
namespace
{
std::string InMiB(std::size_t bytes)
{
  return std::to_string((bytes + (std::size_t(1) << 20) - 1) >> 20) + " MiB";
}
}

std::string NameWithStreaming(const Device& ofSolve)
{
  if (ofSolve.PeakHostBytes() == 0)
  {
    return ofSolve.Name();
  }
  return ofSolve.Name() + ": " + InMiB(ofSolve.PeakBytes()) + " within the memory budget, " +
    InMiB(ofSolve.PeakHostBytes()) +
    (ofSolve.SharesHostMemory() ? " of volumes in host memory, in place" : " streamed from host memory");
}
}
