#pragma once

#include "Device/Device.h"
#include "Medium/Medium.h"

namespace bench
{
/// What one order of the conservative solver has to do for one voxel, direction and channel, counted in the texts of
/// Numerics.cl, Sweep.cl, SweepBundle.cl and IsotropicScattering.cl with the rays' real number of segments
/// (Bundle::Crossing). The order is one with scattered light, without net flux, on an open box; rows that are thin
/// throughout take the polynomial.
struct SweepWork
{
  /// Arithmetic on floats: each addition, multiplication, fused multiply-add, comparison, selection, conversion or
  /// shift is one. A processor starts no more of them in a cycle than multiply-adds.
  double operations = 0.0;
  double flops = 0.0;  ///< of these: additions and multiplications 1, multiply-adds 2, the others 0
  double bytes = 0.0;  ///< between memory and caches if the volumes are read and written once a sweep each way and
                       ///< the maps, which come again in every plane, stay in the caches
  double cached = 0.0; ///< between caches and registers: rays and planes, loads and stores
};

SweepWork CountSweepWork(
  const tyndall::Device& device, const tyndall::Medium& medium, int directionsPerFace, int channels);
}
