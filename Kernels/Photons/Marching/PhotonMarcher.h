#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Distribution/Rounds.h"
#include "Medium/Medium.h"
#include "Photons/Marching/MarchTurns.h"
#include "Photons/Photons.h"

#include <memory>

namespace tyndall
{
struct TurnsInBlocks;

/// Marches photons along bent rays through a medium, and deposits every voxel that they cross.
///
/// Paths follow Pfeuti 2009, Eq. 2.7 (numerics.md, Eqs. (89) to (92)), by a symplectic integrator on a tricubic
/// B-spline of n^2 through the voxels' centres; total reflection is part of it. There is no refraction at the faces of
/// the volume: outside, the index is that of the voxels there.
///
/// A voxel gains power times path integral of transmittance, exact for coefficients constant in it (Eqs. (97),
/// (98)): over its volume an unbiased estimate of `fluence`, W / length^2, whatever the number of photons. Scattered
/// light is not followed: `fluence` is the unscattered part, the source of single scattering.
///
/// Sums are in 64-bit fixed point (Eqs. (35), (99)) and do not depend on the order of photons or threads. Entered =
/// absorbed + scattered + escaped + left over to 1e-6.
///
/// With several ranks, each marches photons through its block, and hands those that leave it, with all that their paths
/// depend on, to the rank whose block they enter (numerics.md, section 12.6). Paths do not depend on the blocks: the
/// light is the same, bit for bit, on any number of ranks; powers of scattered light, sums of floats, to 1e-9. No rank
/// holds more of the medium than its block and, of the refractive index, some voxels around it: 20 or more for steps of
/// order 4 in an octree, whose nodes every rank has. Light by bricks and `Unsafe` sums are for undivided grids.
///
/// Where the index is constant, kernels have neither integrator nor interpolation; where all photons have one colour
/// and the medium is grey, they have one channel.
class PhotonMarcher
{
public:
  /// Collective, as all member functions.
  /// @param domain  the grid
  /// @param medium  of the rank's block, with the grid domain.OwnGrid(). As all arrays, read in the constructor only
  /// @param ior     refractive index, one component per voxel; null values: 1 everywhere
  /// @param levels  octree level of each voxel (0: itself, k: in a node of 2^k voxels per edge), which a step of
  ///                a path may cross whole (of order 4 a cube of it of 16 voxels per edge); null: step by step
  /// @throws InvalidInput for a medium, an index or a level that is not valid (names the voxel), or where ranks
  ///   disagree; DeviceError
  PhotonMarcher(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const MarchSettings& settings = {}, const std::uint8_t* levels = nullptr);
  /// Serial.
  PhotonMarcher(Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings = {},
    const std::uint8_t* levels = nullptr)
    : PhotonMarcher(device, Domain(medium.grid), medium, ior, settings, levels)
  {
  }
  ~PhotonMarcher();
  PhotonMarcher(PhotonMarcher&&) noexcept;

  /// Photons outside the volume are first moved to where they enter it.
  /// @param share  this rank's photons: all of them are those of rank 0, then those of rank 1, and so on
  /// @return arrays of the rank's block; balance, face powers and counts of the whole grid
  /// @throws InvalidInput where a photon's position, direction, power or weight is not finite, its power or weight
  ///   negative, or (where they are asked for) its batch not 0 to 63, or where there are more photons than voxels can
  ///   count; DeviceError where the sums of all batches do not fit; Aborted
  PhotonLight March(const std::vector<Photon>& share, const Monitor& monitor = {});

  /// The same light, of photons that march in turns. Without batches, of one order, and on one rank.
  /// @param times  how long turns took
  /// @throws InvalidInput where settings ask for batches or other orders than 1, or light is kept by bricks; as March
  PhotonLight MarchByTurns(
    const std::vector<Photon>& photons, const MarchTurns& turns, TurnTimes& times, const Monitor& monitor = {});

  /// The same of photons on several ranks, between whose turns nothing runs beside them.
  PhotonLight MarchByTurns(const std::vector<Photon>& share, const TurnsInBlocks& turns, const Monitor& monitor = {});

  /// Light of few photons in coarse cells, and where those of each cell came from (Pfeuti 2009, section 3.2.2). Paths
  /// are those of March, through the medium's own voxels. Voxel i of an axis belongs to cell i * cells / voxels,
  /// rounded down.
  /// @param photons  the same on all ranks, as their origins
  /// @param origins  of each photon: column and row of the cell of the photon plane that it was made in, 0 to 65535
  /// @param cells    along each axis, 1 to the grid's voxels (more are cut to them)
  /// @return the light of the whole grid, on each rank
  /// @throws InvalidInput as March, or where light is kept by bricks, there are not as many origins as photons, one is
  ///   out of its range, or there are no cells; Aborted
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor = {});

  /// The paths of every photon in `chosen`, corner by corner; those that miss the volume are left out.
  /// @param chosen  numbers among the photons of all ranks, ascending; the same on all ranks
  /// @return on rank 0; on the others none
  std::vector<PhotonPath> Paths(const std::vector<Photon>& share, const std::vector<std::size_t>& chosen);

  const RoundsTraffic& Traffic() const; ///< of the last march, of this rank

private:
  class Implementation;
  std::unique_ptr<Implementation> Inside;
};
}
