#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// Computes the uncollided flux of one point, spot or rectangle lamp along exact rays. The power that rays lose is
/// deposited as in a sweep (numerics.md, sections 5.3 to 5.5). A quadrature would represent such a lamp by few rays,
/// with ray effects of 100% and more.
///
/// A lamp emits square beams, each with the power of its solid angle, Eq. (33). Beams are at most half a voxel wide
/// where they leave the box, and at least 16 beams fit across a spot's cone. A rectangle is divided into parts. Each
/// part lights the voxels that are far enough away from it, with beams one voxel wide or more. Each voxel's path
/// integral is then scaled to be exact in vacuum, Eq. (34a). Deposits are summed in 64-bit fixed point, Eq. (35), so
/// that the sum does not depend on the order of the beams. If the lamp is inside the box, all of its power is traced.
///
/// On a periodic axis rays wrap around, in at most nine passes with fewer beams at larger distance, until 0.005% of the
/// power is left (LampPyramids.h). A lamp outside the box then illuminates only the part of the box that it sees
/// directly, once per period.
///
/// On several ranks, a beam that leaves a block is sent to the rank of the block that it enters (numerics.md, section
/// 4.9). A beam covers up to four voxels, some of which may belong to another rank. Each rank therefore holds sigma_t
/// of its block and a halo of two voxels, and sends its beams' deposits in the halo to the owners of these voxels.
/// Deposits agree with those of a serial run bit for bit, with two exceptions: the final correction of the power is a
/// sum in another order, and around periodic axes beams with less than 1e-7 of their initial power are dropped.
///
/// Collective.
/// @param volume  this rank's block; the face cells of its deposit are those of the whole domain
/// @return incident power (for a lamp inside the box: all of its power), escaped power, and power in transit along
/// periodic axes, W; sums over all ranks
SweepTally DepositLamp(Device& device, const Domain& domain, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor);
}
