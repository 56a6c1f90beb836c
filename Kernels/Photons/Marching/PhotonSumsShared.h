// Shared by C++ and the kernels of PhotonSums.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  CountShift = 40 ///< bit position of photon counts, above the bits of weights
};

/// Parameters of the conversion of sums to light.
typedef struct
{
  IndexGrid grid;
  float diagonal;             ///< length of a voxel's diagonal
  float fluence;              ///< W / length^2 per unit of power along a voxel's diagonal, divided by 2^exponent
  int exponent;               ///< kept apart, as the product may be below the range of float
  float colour[3];            ///< colour of the single channel, if CHANNELS is 1
  float weight;               ///< photon weight per unit of the sums
  int absorption, scattering; ///< components of sigma_a and sigma_s; 0: absent
  int copies, batches;        ///< of the sums: copy c belongs to batch c modulo batches
} LightSumsInfo;
SHARED_END
