// Shared by C++ and the kernels of OctantSources.cl: layout of the response tables, and kernel arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
enum
{
  ResponseAlbedos = 11,  ///< number of table entries by sqrt(1 - albedo), from 0 to 1 in equal steps
  ResponseDepths = 23,   ///< number of table entries by log2(optical thickness), two per unit
  FirstDepth = -4,       ///< log2(optical thickness) of the first entry
  ResponseProfiles = 17, ///< number of tables by log2(attenuation of a lamp's light per mean free path), two per unit
  FirstProfile = -3,     ///< log2(attenuation) of the first table
  /// Number of values per table entry: response antisymmetric in the two faces, symmetric response, removed fraction of
  /// isotropic light.
  ResponseParts = 3,
  ResponseValues = ResponseParts * ResponseAlbedos * ResponseDepths ///< number of values in one table
};

/// One channel of the voxels of a subdomain, as argument of the kernels of OctantSources.cl.
typedef struct
{
  int size[3];
  int periodic[3];
  int leftOut[3]; ///< axes along which the scene is constant (one periodic voxel)
  int pattern[6]; ///< offset of the crossing tables: [axis][other axes in order]
  /// First value of this channel in sigma_t, and in other arrays by voxel; values per channel.
  ulong firstT, first, stride;
  float spacing[3];
  float perRadiance; ///< power per area through a face at isotropic radiance 1, by the quadrature, sr
  BeyondFacesInfo beyond;
} OctantSourceInfo;
SHARED_END
