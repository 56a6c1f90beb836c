// Shared by C++ and the kernels of OctantSources.cl: layout of the response tables, and kernel arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
enum
{
  ResponseAlbedos = 11, ///< number of values of sqrt(1 - albedo) in a table, from 0 to 1 in equal steps
  ResponseDepths = 23,  ///< number of values of log2(optical thickness) in a table, in steps of 1/2
  FirstDepth = -4,      ///< log2(optical thickness) of the first optical thickness in a table
  /// Number of response tables for lamps' light, one per rate at which it decays in the layer: log2(attenuation per
  /// mean free path) in steps of 1/2
  ResponseProfiles = 17,
  FirstProfile = -3, ///< log2(attenuation of a lamp's light per mean free path) of the first of these tables
  /// Number of values per table entry: coefficient alpha of the response that is antisymmetric in the two faces, beta
  /// of the symmetric response, and the fraction of isotropic light that collides in the layer.
  ResponseParts = 3,
  ResponseValues = ResponseParts * ResponseAlbedos * ResponseDepths ///< number of values in one table
};

/// One channel of the voxels of a subdomain, as argument of the kernels of OctantSources.cl.
typedef struct
{
  int size[3];
  int periodic[3];
  /// 1 for axes along which light does not vary, because the domain has one voxel and is periodic
  int leftOut[3];
  /// Indices of the crossing pattern (power of the rays across each voxel face relative to its mean, SweepModel.h) of
  /// the faces normal to axis a: pattern[2 a] is the index of the terms for positions along the first of the other two
  /// axes, pattern[2 a + 1] of the terms for positions along the second
  int pattern[6];
  /// Index of this channel's first value in sigma_t, and in other arrays over voxels; number of values per channel.
  ulong firstT, first, stride;
  float spacing[3];
  /// Power per area through a face at isotropic radiance 1, computed by the quadrature (about pi), sr
  float perRadiance;
  BeyondFacesInfo beyond;
} OctantSourceInfo;
SHARED_END
