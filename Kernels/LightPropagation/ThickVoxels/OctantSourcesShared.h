// Shared by C++ and the kernels of light at the faces of thick voxels: how their table lies.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
enum
{
  ResponseAlbedos = 11,  ///< sqrt(1 - albedo) from 0 to 1 in equal steps
  ResponseDepths = 23,   ///< base 2 logarithms of the optical thickness, two a unit
  FirstDepth = -4,       ///< the first of them
  ResponseProfiles = 17, ///< base 2 logarithms of a lamp's fall per mean free path, two a unit
  FirstProfile = -3,     ///< the first of them
  ResponseParts = 3,     ///< of a value: what differs between both faces, what is alike, what is lost of even light
  ResponseValues = ResponseParts * ResponseAlbedos * ResponseDepths ///< of one kind of light
};

/// Voxels whose light at their faces is found.
typedef struct
{
  int size[3];
  int periodic[3];
  int leftOut[3];              ///< axes along which nothing changes
  int pattern[6];              ///< where the tables of crossings begin: [axis][other axes in order]
  ulong firstT, first, stride; ///< where this channel begins: of sigma_t, of all others (by face: six times that)
  float spacing[3];
  float perRadiance; ///< power per area through a face of an even radiance of 1
  BeyondFacesInfo beyond;
} OctantSourceInfo;
SHARED_END
