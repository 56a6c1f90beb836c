// Shared by C++ and the kernel of ScatterPhotons.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// How photons are followed beyond their first scattering.
typedef struct
{
  ulong seed;
  int mostScatterings; ///< that a photon goes through; where it would be scattered once more it is given up
} ScatterInfo;

/// What became of a photon; powers in units.
typedef struct
{
  int face;              ///< as of PhotonEnd
  int scatterings;       ///< that it went through
  float power;           ///< that is left of it
  float absorbedAtFirst; ///< before it was scattered
  float exchanged;       ///< that Russian roulette gave it, less what that took
} ScatterEnd;
SHARED_END
