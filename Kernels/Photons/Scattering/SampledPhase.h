#pragma once

#include "Device/Buffer.h"
#include "Medium/Medium.h"

#include <string>

namespace tyndall
{
/// Samples the cosine of the scattering angle (numerics.md, Eqs. (99b), (99c)): in closed form for isotropic scattering
/// and for the Henyey-Greenstein and Schlick phase functions, whose parameter may vary by voxel; otherwise from a table
/// of the inverse cumulative distribution at 65536 equal steps of probability.
class SampledPhase
{
public:
  /// @param medium  a medium of one channel
  SampledPhase(Device& device, const Medium& medium);

  std::string Options() const; ///< options of ScatterPhotons.cl
  const Buffer<float>& Values() const { return this->Numbers; }

private:
  int Way = 0;
  bool Varies = false;
  int Parts = 0;
  Buffer<float> Numbers;
};
}
