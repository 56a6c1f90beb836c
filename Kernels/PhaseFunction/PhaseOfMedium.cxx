#include "PhaseFunction/PhaseOfMedium.h"

namespace tyndall
{
PhaseOfMedium::PhaseOfMedium(const PhaseFunction& ofAll)
  : PhaseOfMedium(std::array<PhaseFunction, 3>{ ofAll, ofAll, ofAll })
{
}

PhaseOfMedium::PhaseOfMedium(const std::array<PhaseFunction, 3>& ofChannels)
  : Functions(ofChannels)
  , MeanCosines({ ofChannels[0].MeanCosine(), ofChannels[1].MeanCosine(), ofChannels[2].MeanCosine() })
{
}

PhaseOfMedium::PhaseOfMedium(const PhaseFunction& kind, const Field& g)
  : PhaseOfMedium(kind)
{
  kind.WithMeanCosine(0.0); // throws InvalidInput unless functions of this kind are determined by g
  this->ByVoxel = g;
}

bool PhaseOfMedium::HasColour() const
{
  return this->ByVoxel.HasColour() || this->Functions[0] != this->Functions[1] ||
    this->Functions[0] != this->Functions[2];
}

PhaseFunction PhaseOfMedium::At(std::size_t voxel, int channel) const
{
  const PhaseFunction& function = this->Functions[channel];
  return this->Varies() ? function.WithMeanCosine(this->ByVoxel.At(voxel, channel)) : function;
}

PhaseOfMedium PhaseOfMedium::Seen(int channel) const
{
  PhaseOfMedium seen(this->Functions[channel]);
  seen.ByVoxel = this->ByVoxel;
  seen.ByVoxel.standsForAll = this->ByVoxel.HasColour() ? channel : this->ByVoxel.standsForAll;
  return seen;
}
}
