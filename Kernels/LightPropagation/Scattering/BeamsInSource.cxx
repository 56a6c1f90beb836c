#include "LightPropagation/Scattering/BeamsInSource.h"

namespace tyndall
{
void BeamsInSource::Hold()
{
  if (this->Count > 0)
  {
    this->Held = Buffer<float>(this->TheDevice, this->Count, "the light of beams");
    this->TheDevice.Queue().enqueueCopyBuffer(
      this->Source.Handle(), this->Held.Handle(), this->First * sizeof(float), 0, this->Count * sizeof(float));
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}

void BeamsInSource::GoOn()
{
  if (this->Held.Size() > 0)
  {
    this->TheDevice.Queue().enqueueCopyBuffer(
      this->Held.Handle(), this->Source.Handle(), 0, this->First * sizeof(float), this->Count * sizeof(float));
    this->Held = {};
  }
  else
  {
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}
}
