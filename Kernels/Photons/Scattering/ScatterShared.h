// Shared by C++ and the kernel of ScatterPhotons.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "Photons/Marching/MarchShared.h"

SHARED_BEGIN
/// Parameters of a launch that follows photons beyond their first scattering.
typedef struct
{
  ulong seed;
  ulong copyStride; ///< numbers from copy to copy of the sums
  /// Maximum number of scatterings of a photon; it is given up where it would be scattered once more.
  int mostScatterings;
  int first, count; ///< the photons of the launch
  int resumes;      ///< 1: photons that have arrived from other blocks; 0: photons that start
} ScatterInfo;

/// What became of a photon; powers are in units.
typedef struct
{
  int face;              ///< as PhotonEnd::face
  int scatterings;       ///< number of its scatterings
  float power;           ///< power left when it ended
  float absorbedAtFirst; ///< power absorbed before its first scattering
  float exchanged;       ///< net power added to it by Russian roulette
} ScatterEnd;

/// A photon that passes from one block of a grid into another, with all that its further path and scatterings depend
/// on.
typedef struct
{
  ulong number; ///< key of its random numbers
  WayOnward way;
  uint blocks; ///< number of blocks of random numbers it has drawn
  int drawn;   ///< unused numbers of the last block
  int events;  ///< path segments since its last scattering; 0: it starts anew, in the direction `way.velocity`
  int scatterings;
  float depth;                             ///< optical depth to the next scattering
  float dim;                               ///< power below which Russian roulette is played
  float power, absorbedAtFirst, exchanged; ///< as in ScatterEnd
} ScatteredOnItsWay;
SHARED_END
