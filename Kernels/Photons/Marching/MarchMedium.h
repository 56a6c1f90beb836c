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

/// The properties of the whole medium that decide how photons are marched; all blocks of a grid must share them.
struct MarchTraits : MediumTraits
{
  bool coloured = false; ///< whether coefficients are given with three components
  IndexRange index;

  int Channels(const MarchSettings& settings) const; ///< number of extinction channels, 1 or 3
  /// Number of channels of the light that these photons deposit.
  int ColoursOf(const PackedPhotons& packed) const { return packed.grey && !this->coloured ? 1 : 3; }
};
// Checks of the medium through which photons are marched; each rank has one block of it.

/// Checks the medium of this rank's block; a rank without voxels has none to check.
/// @param levels  null if there is no octree
/// @param octree  whether any rank has octree levels
/// @return which of the medium's bricks are filled
/// @throws InvalidInput if the block's input is not valid
FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree);

/// Checks that all blocks agree on the partition, on whether there is a refractive index, and on the number of
/// components of their coefficients. Collective.
/// @throws InvalidInput  on every rank, if they differ
void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior);

/// The range of the refractive index over all blocks. Collective.
IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own);

/// Collective. @param filled  bricks of the rank's medium
MarchTraits MarchTraitsOf(const Domain& domain, const Medium& medium, const Field& ior, const FilledBricks& filled);

/// Memory layout by bricks, for the medium and for the sums of deposits: a filled brick has a record for each of its
/// voxels, x fastest; an empty brick has a single record. Record 0 stands for everything outside the grid.
class PhotonBricks
{
public:
  PhotonBricks() = default; ///< no bricks: arrays are stored voxel by voxel
  PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid);

  bool AreThere() const { return this->RecordCount > 0; }
  std::size_t Records() const { return this->RecordCount; }
  std::size_t Count() const { return this->Begin.size(); }
  /// First record of each filled brick; for an empty brick, its record number, negated (less than 0).
  const Buffer<cl_int>& First() const { return this->OnDevice; }

  struct Coefficients
  {
    /// [channels][records], times the voxel diagonal, as pack_extinction in PhotonMedium.cl computes it by voxels.
    std::vector<float> extinction;
    std::vector<float> sigmaA, sigmaS; ///< [records][components]
  };
  /// @param aComponents, sComponents  components of sigma_a and sigma_s in the medium, or 0 to leave them out
  Coefficients Pack(const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const;

private:
  /// Calls act(first record, first voxel, count) for each row of voxels along x in filled bricks, on all cores.
  template <class Act>
  void ForFilled(const Act& act) const;

  Grid Voxels;
  std::array<int, 3> BrickCount = { 0, 0, 0 };
  std::size_t RecordCount = 0;
  std::vector<cl_int> Begin;
  Buffer<cl_int> OnDevice;
};

/// The part of a grid through which one rank marches photons.
struct MarchedPart
{
  Grid whole;
  VoxelBox own;   ///< voxels of the medium
  VoxelBox known; ///< voxels of the refractive index: own and a halo, by which photons in own are bent
};

/// Maximum number of path segments of a photon; a segment ends at a voxel wall or where the velocity changes.
int MarchEventLimit(const Grid& whole, const MarchSettings& settings);

/// A refractive medium on its device in the layout of the marching kernels, with the parameters that they need.
class MarchMedium
{
public:
  /// Constructs the medium of a rank's block of a grid, or of the whole grid.
  /// @param medium  coefficients in block.own, already checked
  /// @param ior     refractive index in block.known
  /// @param traits  traits of all blocks together
  /// @param filled  the medium's bricks; null: light is stored voxel by voxel, as it must be in a block of a larger
  ///   grid
  /// @param levels  octree levels in block.own; null: no octree. In a block of a larger grid, call SetNodes afterwards
  MarchMedium(Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings,
    const MarchTraits& traits, const MarchedPart& block, const FilledBricks* filled = nullptr,
    const std::uint8_t* levels = nullptr);

  /// For each voxel of the block, whether n varies in it, and the octree node that contains it (encoding:
  /// PhotonSteps.cl).
  /// @param levels  octree levels of the block's voxels
  std::vector<std::uint8_t> OwnNodes(const std::uint8_t* levels) const;
  /// @param all  OwnNodes of all blocks: steps look at nodes beyond the block
  void SetNodes(const BrickedBytes& all);

  MarchInfo Describe() const;
  IndexGrid DescribeGrid() const;
  /// Parameters of the conversion of these photons' sums to light.
  /// @param weightUnit  photon weight per unit of the voxels' sums, if photons are counted
  LightSumsInfo DescribeSums(const PackedPhotons& packed, const MarchShares& shares, float weightUnit = 0.0f) const;
  int EventLimit() const { return MarchEventLimit(this->block.whole, this->settings); }
  double Diagonal() const; ///< length of a voxel's diagonal
  /// Whether this is a block of a larger grid.
  bool IsBlock() const { return this->block.own.size != this->block.whole.size; }
  /// Number of voxels including a padding of one voxel on every side.
  std::size_t PaddedCount() const { return Count(this->Padded(2)); }
  /// Number of records of extinction and of sums: those of bricks, or the voxels of the padded grid.
  std::size_t Records() const { return this->bricks.AreThere() ? this->bricks.Records() : this->PaddedCount(); }

  /// Creates a kernel of PhotonMarch.cl for `channels` of light. `options`: those that do not follow from the medium.
  cl::Kernel MarchKernel(const char* name, int channels, bool directions, const std::string& options) const;
  std::string Options() const; ///< options of all kernels of this medium
  /// Creates a kernel of PhotonSums.cl.
  cl::Kernel SumsKernel(const char* name, int channels, const std::string& options) const;

  /// The coarse cell of each voxel of the padded grid. @param cells  cells along each axis of the whole grid, at most
  /// its voxels
  Buffer<cl_int> Cells(const std::array<int, 3>& cells) const;

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range, const cl::NDRange& local = cl::NullRange) const;

  Device& device;
  Grid grid;
  MarchedPart block; ///< position of `grid` in the whole grid
  MarchSettings settings;
  MarchTraits traits;
  int channels; ///< of extinction, 1 or 3
  bool bends, hasLevels;
  bool nodesOfWhole = false; ///< whether SetNodes was called
  PhotonBricks bricks;       ///< layout by bricks, if all arrays use it

  Buffer<float> sigmaA, sigmaS;
  Buffer<float> sigma;        ///< layout: pack_extinction in PhotonMedium.cl, or PhotonBricks
  Buffer<float> coefficients; ///< spline of n^2, SquaredIndex.cl
  Buffer<cl_uchar> nodes;     ///< layout: pack_extinction in PhotonMedium.cl

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
