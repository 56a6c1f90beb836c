#include "LightPropagation/Scattering/BeamsInSource.h"

namespace tyndall
{
void BeamsInSource::Hold()
{
  if (this->Count > 0)
  {
    this->Held = Buffer<float>(this->TheDevice, this->Count, "the light of beams");
    this->Held.CopyFrom(this->Source, this->First, this->Count, 0);
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}

void BeamsInSource::GoOn()
{
  if (this->Held.Size() > 0)
  {
    this->Source.CopyFrom(this->Held, 0, this->Count, this->First);
    this->Held = {};
  }
  else
  {
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}
}
