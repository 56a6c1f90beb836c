#pragma once

#include "Device/Buffer.h"
#include "Distribution/BrickedBytes.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"
#include "Medium/VoxelBox.h"
#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/PhotonBricks.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Marching/PhotonSumsShared.h"
#include "Photons/Photons.h"
#include "Refraction/Index/IndexRange.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
struct MarchShares;

/// What decides how photons are marched through a medium, all of it: blocks of one grid have it alike.
struct MarchTraits : MediumTraits
{
  bool coloured = false; ///< coefficients have three components, as data
  IndexRange index;

  int Channels(const MarchSettings& settings) const; ///< of extinction, 1 or 3
  /// Channels of the light that so many photons leave.
  int ColoursOf(const PackedPhotons& packed) const { return packed.grey && !this->coloured ? 1 : 3; }
};
MarchTraits MarchTraitsOf(const Medium& medium, const Field& ior, const FilledBricks& filled);

/// The part of a grid that photons are marched through in one go.
struct MarchedPart
{
  Grid whole;
  VoxelBox own;   ///< of the medium
  VoxelBox known; ///< of the refractive index: own, and the voxels round it that photons in it are bent by
};

/// Walls and turns of a photon at most.
int MarchEventLimit(const Grid& whole, const MarchSettings& settings);

/// A refractive medium on its device, as photons are marched through it, and what kernels need to know of it.
class MarchMedium
{
public:
  /// A rank's block of a grid, or all of it.
  /// @param medium  of block.own, and checked
  /// @param ior     of block.known
  /// @param traits  of all blocks
  /// @param filled  the medium's bricks: without them light is kept voxel by voxel, as in a block of a larger grid
  /// @param levels  of the octree in block.own; null: there is none. Of a larger grid: SetNodes is to follow
  MarchMedium(Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings,
    const MarchTraits& traits, const MarchedPart& block, const FilledBricks* filled = nullptr,
    const std::uint8_t* levels = nullptr);

  /// Of a block: whether n varies in each of its voxels, and then in which node of the octree it is (PhotonSteps.cl).
  /// @param levels  of the block's voxels
  std::vector<std::uint8_t> OwnNodes(const std::uint8_t* levels) const;
  /// @param all  OwnNodes of all blocks: steps look into nodes beyond the block
  void SetNodes(const BrickedBytes& all);

  MarchInfo Describe() const;
  IndexGrid DescribeGrid() const;
  /// How the sums of these photons become light.
  /// @param weightUnit  weight of one of the units that voxels sum up, where photons count
  LightSumsInfo DescribeSums(const PackedPhotons& packed, const MarchShares& shares, float weightUnit = 0.0f) const;
  int EventLimit() const { return MarchEventLimit(this->block.whole, this->settings); }
  double Diagonal() const;                                                        ///< of a voxel
  bool IsBlock() const { return this->block.own.size != this->block.whole.size; } ///< of a larger grid
  /// Voxels, with one more at either end of each axis.
  std::size_t PaddedCount() const { return Count(this->Padded(2)); }
  /// Of extinction and of sums: those of bricks, or the voxels of the padded grid.
  std::size_t Records() const { return this->bricks.AreThere() ? this->bricks.Records() : this->PaddedCount(); }

  /// A kernel of PhotonMarch.cl for so many channels of light; `options` are those that do not follow from the medium.
  cl::Kernel MarchKernel(const char* name, int channels, bool directions, const std::string& options) const;
  std::string Options() const; ///< of all kernels of this medium
  /// A kernel of PhotonSums.cl.
  cl::Kernel SumsKernel(const char* name, int channels, const std::string& options) const;

  /// The coarse cell of each voxel of the padded grid. @param cells  of the whole along each axis, no more than voxels
  Buffer<cl_int> Cells(const std::array<int, 3>& cells) const;

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range, const cl::NDRange& local = cl::NullRange) const;

  Device& device;
  Grid grid;
  MarchedPart block; ///< of the grid
  MarchSettings settings;
  MarchTraits traits;
  int channels; ///< of extinction, 1 or 3
  bool bends, hasLevels;
  bool nodesOfWhole = false; ///< SetNodes
  PhotonBricks bricks;       ///< where all arrays stand by bricks

  Buffer<float> sigmaA, sigmaS;
  Buffer<float> sigma;        ///< PhotonMedium.cl, pack_extinction; or PhotonBricks.h
  Buffer<float> coefficients; ///< SquaredIndex.cl
  Buffer<cl_uchar> nodes;     ///< PhotonMedium.cl, pack_extinction

private:
  using Size = std::array<std::size_t, 3>;
  static std::size_t Count(const Size& size) { return size[0] * size[1] * size[2]; }
  static cl::NDRange Range(const Size& size) { return { size[0], size[1], size[2] }; }
  static Size Padded(const std::array<int, 3>& size, int by);
  Size Padded(int by) const { return Padded(this->grid.size, by); }
  MarchMedium(Device& device, const Medium& medium, const MarchSettings& settings, const MarchTraits& traits,
    const MarchedPart& block, bool hasLevels);
  Buffer<float> Upload(const float* values, std::size_t voxels, int components, const char* what) const;
  cl::Kernel MediumKernel(const char* name) const;
  void FindRanges(Buffer<float>& low, Buffer<float>& high) const;
  void PackVoxels(const Medium& medium, const Field& ior, const std::uint8_t* levels);
  void PackNodes(const Buffer<float>& low, const Buffer<float>& high, const std::uint8_t* levels);
  void PackBricks(const Medium& medium);

  int AComponents, SComponents;
};
}
