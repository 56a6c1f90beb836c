// Shared by C++ and the kernel of ScatterPhotons.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "Photons/Marching/MarchShared.h"

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

/// A photon that goes from one block of a grid into another: all that its way and its scatterings from there on depend
/// on.
typedef struct
{
  ulong number; ///< which its random numbers belong to
  WayOnward way;
  uint blocks; ///< of random numbers that it has drawn from
  int drawn;   ///< numbers of the last one that are left
  int events;  ///< walls and turns since it was scattered last; 0: it sets off anew, in the direction `way.velocity`
  int scatterings;
  float depth;                             ///< optical, to the next scattering
  float dim;                               ///< power below which Russian roulette is played
  float power, absorbedAtFirst, exchanged; ///< as of ScatterEnd
} ScatteredOnItsWay;
SHARED_END
