#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Distribution/Rounds.h"
#include "Medium/Medium.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Photons.h"

#include <memory>
#include <string>

namespace tyndall
{
/// Marches photons along curved rays through a medium, and deposits light in every voxel on their paths.
///
/// Paths follow Pfeuti 2009, Eq. 2.7 (numerics.md, Eqs. (89) to (92)), by a symplectic integrator on a tricubic
/// B-spline of n^2 through the voxel centres, which includes total reflection. There is no refraction at the faces of
/// the volume: outside, the refractive index is that of the nearest voxels.
///
/// The deposit in a voxel is power times the path integral of transmittance, exact for coefficients constant in the
/// voxel (Eqs. (97), (98)). Divided by the voxel's volume it is an unbiased estimate of `fluence`, W / length^2, for
/// any number of photons. With one order, scattered light is not followed: `fluence` is the uncollided flux, the source
/// of single scattering.
///
/// Sums are in 64-bit fixed point (Eqs. (35), (99)) and do not depend on the order of photons or threads. Energy
/// balance: entered = absorbed + scattered + escaped + left over, to 1e-6.
///
/// With several ranks, each marches photons through its block (subdomain), and sends photons that leave it, with the
/// complete state of their paths, to the rank whose block they enter (numerics.md, section 12.6). Paths do not depend
/// on the blocks: the light is the same, bit for bit, on any number of ranks. Powers of scattered light, which are sums
/// of floats, agree to 1e-9. A rank stores its block of the medium and, for the refractive index, a halo of some
/// voxels; for steps of order 4 in an octree the halo has 20 or more. The nodes of the octree are stored on every rank.
/// Storing light by bricks requires an undivided grid.
///
/// Kernels are compiled for the scene: without path integrator and interpolation if the refractive index is constant,
/// and with one power channel if all photons have one colour and the medium is grey.
class PhotonMarcher
{
public:
  /// Collective, as are all member functions.
  /// @param domain  the grid and its partition; `Domain(grid)` for a serial march
  /// @param medium  the medium in this rank's block, on the grid domain.OwnGrid(). Its arrays are read in the
  ///   constructor only
  /// @param ior     refractive index, one component per voxel; null values: 1 everywhere
  /// @param levels  octree level of each voxel (0: a single voxel, k: in a node of 2^k voxels per edge); a step may
  ///   cross an entire node (with order 4, a cube of 16 voxels per edge). null: no octree
  /// @throws InvalidInput if the medium, an index or a level is not valid (names the voxel), or ranks disagree;
  ///   DeviceError
  PhotonMarcher(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const MarchSettings& settings = {}, const std::uint8_t* levels = nullptr);
  ~PhotonMarcher();
  PhotonMarcher(PhotonMarcher&&) noexcept;

  /// Marches photons through the domain. Photons outside the volume are first moved to the point where they enter it.
  /// @param share  this rank's photons: all photons are those of rank 0, then those of rank 1, and so on
  /// @return arrays of this rank's block; energy balance, face powers and counts of the domain
  /// @throws InvalidInput if a photon's position, direction, power or weight is not finite, its power or weight
  ///   negative, its batch (if batches are requested) not 0 to 63, or photons are counted and exceed the maximum of a
  ///   voxel's counter; DeviceError if the sums of all batches do not fit; Aborted
  PhotonLight March(const std::vector<Photon>& share, const Monitor& monitor = {});

  /// Warning that a march of these photons takes very many scatterings (PhotonScattering.h); empty if it does not, or
  /// photons are not followed beyond their first collision.
  /// @param share  this rank's photons, as in March
  std::string Warning(const std::vector<Photon>& share) const;

  /// Marches photons in turns, with callbacks in between. Each turn is a launch over a limited number of path segments.
  /// The light is the same as from March. For one rank and one scattering order, without batches.
  /// @param turns  callbacks and length of a turn; `times` receives the device times
  /// @throws InvalidInput if the settings request batches or more than one order, or light is stored by bricks;
  ///   otherwise as March
  PhotonLight MarchByTurns(const std::vector<Photon>& photons, MarchTurns& turns, const Monitor& monitor = {});

  /// Light of pilot photons in coarse cells, and the mean origin of the photons in each cell (Pfeuti 2009, section
  /// 3.2.2). Photons follow the paths of March, through the medium's own voxels. Voxel i of an axis belongs to cell i *
  /// cells / voxels, rounded down.
  /// @param photons  pilot photons, the same on all ranks
  /// @param origins  column and row, 0 to 65535, of the photon-plane cell from which each photon was sampled; the same
  ///   on all ranks
  /// @param cells    number of coarse cells along each axis, 1 to the number of voxels (larger values are reduced to
  ///   it)
  /// @return the light of the domain, on every rank
  /// @throws InvalidInput as March, and if light is stored by bricks, the numbers of origins and photons differ, an
  ///   origin is out of range, or the number of cells along an axis is 0; Aborted
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor = {});

  /// Paths of the photons in `chosen`, each as a list of corners (the points where its direction changes); photons
  /// that miss the volume are omitted.
  /// @param share  this rank's photons, as in March
  /// @param chosen  indices among the photons of all ranks, ascending; the same on all ranks
  /// @return the paths on rank 0, nothing on other ranks
  std::vector<PhotonPath> Paths(const std::vector<Photon>& share, const std::vector<std::size_t>& chosen);

  const RoundsTraffic& Traffic() const; ///< messages that this rank sent in the last march

private:
  class Implementation;
  std::unique_ptr<Implementation> Inside;
};
}
