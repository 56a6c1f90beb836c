#include "LightPropagation/Sweep/SweepWorkspace.h"

namespace tyndall
{
void SweepWorkspace::Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats)
{
  if (this->maps.Size() < mapFloats)
  {
    this->maps = {};
    this->maps = Buffer<float>(device, mapFloats, "the light propagation maps");
  }
  if (this->scratch.Size() < scratchFloats)
  {
    this->scratch = {};
    this->scratch = Buffer<float>(device, scratchFloats, "the planes being crossed");
  }
}

void SweepWorkspace::ReserveLost(Device& device, std::size_t floats)
{
  if (this->lost.Size() < floats)
  {
    this->lost = {};
    this->lost = Buffer<float>(device, floats, "what rounding takes from the light gathered");
  }
}
}
