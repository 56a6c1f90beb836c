// Shared by C++ and the kernels of PhotonSums.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  CountShift = 40 ///< of the bits of counts, above those of weights
};

/// How sums become light.
typedef struct
{
  IndexGrid grid;
  float diagonal;  ///< of a voxel
  float fluence;   ///< W / length^2 of a unit of power that goes along a voxel's diagonal, over 2 to the power of
  int exponent;    ///< this one: it may be less than a float holds
  float colour[3]; ///< of what CHANNELS 1 stands for
  float weight;    ///< of a photon, one unit
  int absorption, scattering; ///< components of sigma_a and sigma_s, 0: there is none
  int copies, batches;        ///< of the sums: copy c is for batch c modulo batches
} LightSumsInfo;
SHARED_END
