#include "LatticeBoltzmann/Distributed/MediumAround.h"

namespace tyndall
{
LatticeBox BoxOf(const Halo& around)
{
  return BoxOf(around, around.Own());
}

LatticeBox BoxOf(const Halo& around, VoxelBox box)
{
  int inner = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool goesRound = around.Periodic()[axis];
    inner |= goesRound || box.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= goesRound || EndOf(box, axis) < around.Whole().size[axis] ? 1 << (2 * axis + 1) : 0;
    box.first[axis] -= around.Known().first[axis];
  }
  return { around.KnownGrid(), box, inner };
}

MediumAround::MediumAround(const Halo& voxels, const Medium& own, const Field& ior, const UncollidedImage& image)
  : medium(own)
{
  this->medium.grid = voxels.KnownGrid();
  this->medium.sigma_a = voxels.Spread(own.sigma_a, this->Absorption);
  this->medium.sigma_s = voxels.Spread(own.sigma_s, this->Scattering);
  this->medium.emission = voxels.Spread(own.emission, this->Emission);
  if (own.phase.Varies())
  {
    this->medium.phase = own.phase.WithG(voxels.Spread(own.phase.G(), this->G));
  }
  this->index = voxels.Spread(ior, this->Index);
  this->uncollided = image;
  this->uncollided.fluence = voxels.Spread(image.fluence, this->Fluence);
  this->uncollided.meanDirection = voxels.Spread(image.meanDirection, this->Directions);
}
}
