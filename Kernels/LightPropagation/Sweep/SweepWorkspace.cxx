#include "LightPropagation/Sweep/SweepWorkspace.h"

namespace tyndall
{
void SweepWorkspace::Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats)
{
  if (this->maps.Size() < mapFloats)
  {
    this->maps = {};
    this->maps = Buffer<float>(device, mapFloats, "the light propagation maps", CL_MEM_READ_WRITE, Residence::Device);
  }
  if (this->scratch.Size() < scratchFloats)
  {
    this->scratch = {};
    this->scratch =
      Buffer<float>(device, scratchFloats, "the planes being crossed", CL_MEM_READ_WRITE, Residence::Device);
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

void SweepWorkspace::ReserveSlots(Device& device, const SlotSizes& floats)
{
  for (std::size_t i = 0; i < floats.size(); ++i)
  {
    Buffer<float>& slot = this->slots[i];
    if (slot.Size() < floats[i])
    {
      slot = {};
      slot = Buffer<float>(device, floats[i], "slices of the volume", CL_MEM_READ_WRITE, Residence::Device);
    }
  }
}
}
