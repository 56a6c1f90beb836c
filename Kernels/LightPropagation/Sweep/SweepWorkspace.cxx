#include "LightPropagation/Sweep/SweepWorkspace.h"

namespace tyndall
{
void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what)
{
  if (buffer.Size() < floats)
  {
    buffer = {};
    buffer = Buffer<float>(device, floats, what, CL_MEM_READ_WRITE, Residence::Device);
  }
}

void SweepWorkspace::Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats)
{
  ReserveOnDevice(device, this->maps, mapFloats, "the light propagation maps");
  ReserveOnDevice(device, this->scratch, scratchFloats, "the planes being crossed");
}

void SweepWorkspace::ReserveLost(Device& device, std::size_t floats)
{
  if (this->lost.Size() < floats)
  {
    this->lost = {};
    this->lost = Buffer<float>(device, floats, "what rounding takes from the light gathered");
  }
}

void SweepWorkspace::ReserveSlots(Device& device, const SlotSizes& floats)
{
  for (std::size_t i = 0; i < floats.size(); ++i)
  {
    ReserveOnDevice(device, this->slots[i], floats[i], "slices of the volume");
  }
}
}
