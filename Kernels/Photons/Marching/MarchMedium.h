#pragma once

#include "Device/Buffer.h"
#include "Distribution/BrickedBytes.h"
#include "Distribution/Domain.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"
#include "Medium/VoxelBox.h"
#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Photons.h"
#include "Refraction/Index/IndexField.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
struct MarchShares;

/// Properties of the medium in the domain that decide how photons are marched; the same on all ranks.
struct MarchTraits : MediumTraits
{
  bool coloured = false; ///< whether sigma_a or sigma_s is given with three components
  IndexRange index;      ///< smallest and largest refractive index

  int Channels(const MarchSettings& settings) const; ///< number of channels of sigma_t in the march, 1 or 3
  /// Number of channels of the light that packed photons deposit, 1 or 3.
  int ColoursOf(const PackedPhotons& packed) const { return packed.grey && !this->coloured ? 1 : 3; }
};
// The following functions check this rank's block of the medium through which photons are marched.

/// Checks the medium of this rank's block; a rank without voxels checks nothing.
/// @param levels  octree levels of the block's voxels; null if there is no octree
/// @param octree  whether any rank has octree levels
/// @return for each brick of the medium whether it holds any medium
/// @throws InvalidInput if the block's input is not valid
FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree);

/// Checks that all ranks agree on the partition, on whether there is a refractive index, and on the number of
/// components of sigma_a and sigma_s. Collective.
/// @throws InvalidInput  on every rank, if ranks differ
void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior);

/// Range of the refractive index in the domain. Collective.
/// @param own  range in this rank's block
IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own);

/// Traits of the medium in the whole domain. Collective.
/// @param medium, ior  coefficients and refractive index of this rank's block
/// @param filled  filled bricks of this rank's medium
MarchTraits MarchTraitsOf(const Domain& domain, const Medium& medium, const Field& ior, const FilledBricks& filled);

/// Memory layout by bricks, for the medium and for the sums of deposits. A record has the values of one voxel. A filled
/// brick has one record per voxel, x fastest; an empty brick has a single record. Record 0 stands for all places
/// outside the grid.
class PhotonBricks
{
public:
  PhotonBricks() = default; ///< creates the layout without bricks: arrays are stored voxel by voxel
  PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid);

  bool AreThere() const { return this->RecordCount > 0; }   ///< whether arrays are stored by bricks
  std::size_t Records() const { return this->RecordCount; } ///< number of records
  std::size_t Count() const { return this->Begin.size(); }  ///< number of bricks
  /// Index of the first record of each filled brick. For an empty brick: the index of its record, negated and therefore
  /// below 0.
  const Buffer<cl_int>& First() const { return this->OnDevice; }

  struct Coefficients ///< coefficients of the medium by records
  {
    /// Optical thickness of a voxel's diagonal, [channel][record], as pack_extinction in PhotonMedium.cl computes it
    /// voxel by voxel.
    std::vector<float> extinction;
    std::vector<float> sigmaA, sigmaS; ///< 1/length, [record][component]
  };
  /// Packs the coefficients of a medium in the layout by bricks, record after record.
  /// @param diagonal  length of a voxel's diagonal
  /// @param channels  number of extinction channels
  /// @param aComponents, sComponents  components of sigma_a and sigma_s in the medium, or 0 to leave them out
  Coefficients Pack(const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const;

private:
  /// Calls act(first record, first voxel, number of voxels) for each row of voxels along x in filled bricks, on all
  /// cores.
  template <class Act>
  void ForFilled(const Act& act) const;

  Grid Voxels;
  std::array<int, 3> BrickCount = { 0, 0, 0 };
  std::size_t RecordCount = 0;
  std::vector<cl_int> Begin;
  Buffer<cl_int> OnDevice;
};

/// The box through which one rank marches photons, and the larger box in which it has the refractive index.
struct MarchedPart
{
  Grid whole;   ///< grid of the domain
  VoxelBox own; ///< box of the domain's voxels through which the rank marches photons
  /// Voxels in which the rank has the refractive index: `own` and a halo, on which paths in `own` depend.
  VoxelBox known;
};

/// Maximum number of path segments of a photon; a segment ends at a voxel wall or where the velocity changes.
int MarchEventLimit(const Grid& whole, const MarchSettings& settings);

/// The medium of one rank on its device, in the layout of the marching kernels, with the parameters of these kernels.
class MarchMedium
{
public:
  /// Uploads and packs the medium of a rank's block of the domain, or of the entire domain.
  /// @param medium  coefficients in block.own, which have been checked
  /// @param ior     refractive index in block.known
  /// @param traits  traits of the medium in the domain
  /// @param filled  filled bricks of the medium; null: light is stored voxel by voxel, as is required in a block of a
  ///   larger domain
  /// @param levels  octree levels of the voxels in block.own; null: no octree. In a block of a larger domain,
  ///   SetNodes must be called afterwards
  MarchMedium(Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings,
    const MarchTraits& traits, const MarchedPart& block, const FilledBricks* filled = nullptr,
    const std::uint8_t* levels = nullptr);

  /// Octree nodes of the block's voxels, one byte per voxel: 0 if n is constant in the voxel, else 1 + the level of the
  /// node that contains the voxel.
  /// @param levels  octree levels of the block's voxels
  std::vector<std::uint8_t> OwnNodes(const std::uint8_t* levels) const;
  /// Uploads the octree nodes of the whole domain, since steps read them beyond the block as well.
  /// @param all  nodes of the domain's voxels, from OwnNodes of all ranks
  void SetNodes(const BrickedBytes& all);

  MarchInfo Describe() const;     ///< parameters of the marching kernels
  IndexGrid DescribeGrid() const; ///< size of the grid for kernels
  /// Parameters of the kernels that convert the sums of deposits to light.
  /// @param weightUnit  photon weight that counts as 1 in the voxels' integer sums (StartingPhotons::weightUnit), if
  ///   photons are counted
  LightSumsInfo DescribeSums(const PackedPhotons& packed, const MarchShares& shares, float weightUnit = 0.0f) const;
  /// Maximum number of path segments of a photon in the domain (tyndall::MarchEventLimit).
  int EventLimit() const { return MarchEventLimit(this->block.whole, this->settings); }
  double Diagonal() const; ///< length of a voxel's diagonal
  /// Whether this medium covers a block of a larger domain.
  bool IsBlock() const { return this->block.own.size != this->block.whole.size; }
  /// Number of voxels of the grid with a padding of one voxel at each face.
  std::size_t PaddedCount() const { return Count(this->Padded(2)); }
  /// Number of records of extinction and of deposits. With bricks, these are the bricks' records; otherwise there is
  /// one record per voxel of the padded grid.
  std::size_t Records() const { return this->bricks.AreThere() ? this->bricks.Records() : this->PaddedCount(); }

  /// Creates a kernel of PhotonMarch.cl for photons with `channels` power channels.
  /// @param directions  whether directions are recorded
  /// @param options  definitions of macros that do not follow from the medium
  cl::Kernel MarchKernel(const char* name, int channels, bool directions, const std::string& options) const;
  std::string Options() const; ///< macro definitions that all kernels of this medium share
  /// Creates a kernel of PhotonSums.cl.
  cl::Kernel SumsKernel(const char* name, int channels, const std::string& options) const;

  /// Computes the index of the coarse cell of each voxel of the grid with a padding of one voxel at each face.
  /// @param cells  number of cells along each axis of the domain, at most its voxels
  Buffer<cl_int> Cells(const std::array<int, 3>& cells) const;

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range, const cl::NDRange& local = cl::NullRange) const;

  Device& device;
  Grid grid;
  MarchedPart block; ///< position of this medium's grid in the domain
  MarchSettings settings;
  MarchTraits traits;
  int channels;              ///< number of extinction channels, 1 or 3
  bool bends, hasLevels;     ///< whether paths bend (n varies); whether there is an octree
  bool nodesOfWhole = false; ///< whether `nodes` covers the domain (SetNodes was called)
  PhotonBricks bricks;       ///< layout of all arrays by bricks; without bricks, arrays are stored voxel by voxel

  Buffer<float> sigmaA, sigmaS; ///< 1/length, voxel by voxel or by records
  /// Optical thickness of voxel diagonals. Voxel by voxel: [channel][voxel of the padded grid], as pack_extinction of
  /// PhotonMedium.cl stores it. By bricks: [channel][record of PhotonBricks].
  Buffer<float> sigma;
  Buffer<float> coefficients; ///< coefficients of the spline of n^2, SquaredIndex.cl
  /// Octree nodes of the voxels: those of block.known, as pack_nodes of PhotonMedium.cl stores them, or, once SetNodes
  /// was called, those of the domain, as BrickedBytes
  Buffer<cl_uchar> nodes;

private:
  using Size = std::array<std::size_t, 3>;
  static std::size_t Count(const Size& size) { return size[0] * size[1] * size[2]; }
  static cl::NDRange Range(const Size& size) { return { size[0], size[1], size[2] }; }
  static Size Padded(const std::array<int, 3>& size, int by);
  Size Padded(int by) const { return Padded(this->grid.size, by); }
  cl::Kernel MediumKernel(const char* name) const;
  void FindRanges(Buffer<float>& low, Buffer<float>& high) const;
  void PackVoxels(const Medium& medium, const Field& ior, const std::uint8_t* levels);
  void PackNodes(const Buffer<float>& low, const Buffer<float>& high, const std::uint8_t* levels);
  void PackBricks(const Medium& medium);

  int AComponents, SComponents;
};
}
