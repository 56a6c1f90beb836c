#pragma once

#include "Device/Buffer.h"
#include "Medium/Medium.h"

#include <string>

namespace tyndall
{
/// How photons draw the cosine by which they are scattered (numerics.md, Eqs. (99b), (99c)): in closed form for
/// isotropic scattering and for Henyey and Greenstein's and Schlick's functions, whose parameter may vary by voxel;
/// else by a table of the distribution's inverse, in 65536 even parts of the light.
class SampledPhase
{
public:
  /// @param medium  of one channel
  SampledPhase(Device& device, const Medium& medium);

  std::string Options() const; ///< as ScatterPhotons.cl has them
  const Buffer<float>& Values() const { return this->Numbers; }

private:
  int Way = 0;
  bool Varies = false;
  int Parts = 0;
  Buffer<float> Numbers;
};
}
