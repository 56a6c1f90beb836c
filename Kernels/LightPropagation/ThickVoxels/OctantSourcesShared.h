// Shared by C++ and the kernels for light at the faces of optically thick voxels: layout of the response tables.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
enum
{
  ResponseAlbedos = 11,  ///< number of values of sqrt(1 - albedo), from 0 to 1 in equal steps
  ResponseDepths = 23,   ///< number of values of log2(optical thickness), two per unit
  FirstDepth = -4,       ///< the first of these values
  ResponseProfiles = 17, ///< number of values of log2(attenuation of a lamp's light per mean free path), two per unit
  FirstProfile = -3,     ///< the first of these values
  /// Parts of an entry: antisymmetric in the two faces, symmetric, lost fraction of isotropic light.
  ResponseParts = 3,
  ResponseValues = ResponseParts * ResponseAlbedos * ResponseDepths ///< size of the table of one kind of light
};

/// Voxels for which light at the faces is computed.
typedef struct
{
  int size[3];
  int periodic[3];
  int leftOut[3];              ///< axes along which the scene is constant (one periodic voxel)
  int pattern[6];              ///< offset of the crossing tables: [axis][other axes in order]
  ulong firstT, first, stride; ///< offset of this channel: in sigma_t, in all others (by face: six times that)
  float spacing[3];
  float perRadiance; ///< power per area through a face at isotropic radiance 1
  BeyondFacesInfo beyond;
} OctantSourceInfo;
SHARED_END
