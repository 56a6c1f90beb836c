#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Published/PublishedPhotonsShared.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
inline const int* WhereIs(const PublishedPhoton& photon)
{
  return photon.voxel;
}

/// A block of a medium on its device, and the light of photons marched through it by the published scheme.
class PublishedMarch
{
public:
  /// Halo of the refractive index in voxels: one for interpolation, and one for differences.
  static constexpr int Reach = 2;

  /// @param medium  coefficients in the block's voxels; must outlive this
  /// @param ior     refractive index in `part.known`, the block and a halo of Reach voxels; null: rays are straight
  /// @param levels  levels of the whole grid's octree in the block's voxels; null: no octree
  /// @param stepLimit  maximum number of steps of a photon
  /// @param tries   compare-and-swap attempts before a deposit is given up
  PublishedMarch(Device& device, const Medium& medium, const float* ior, const std::uint8_t* levels,
    const MarchedPart& part, int stepLimit, int tries);

  /// Marches photons as far as the block goes, and updates the position, face and counts of each.
  /// @param photons  those that start in the block or enter it. @throws Aborted
  void March(std::vector<PublishedPhoton>& photons, const Monitor& monitor);

  /// Three values per voxel.
  struct Light
  {
    std::vector<float> fluence, direction;
  };
  /// @param unit  W of one unit of power
  Light Unpack(double unit);
  /// Applies the 3x3x3 Gaussian filter of the published scheme to values in a box, 3 per voxel; beyond the box, values
  /// of the nearest voxel are used.
  std::vector<float> Smoothed(const VoxelBox& box, const std::vector<float>& values);

private:
  PublishedMarchInfo Describe(const MarchedPart& part, int stepLimit) const;
  cl::Kernel Kernel(const char* name);
  void Launch(const cl::Kernel& kernel, const cl::NDRange& range);
  Buffer<float> Upload(const Field& field);
  Buffer<cl_float4> FindIndex(const float* ior, const MarchedPart& part);

  Device& TheDevice;
  const Medium& TheMedium;
  const std::size_t Voxels;
  const std::string Options;
  const PublishedMarchInfo Info;
  Buffer<cl_float4> Index; ///< n and its gradient; empty if rays are straight
  Buffer<float> SigmaA, SigmaS;
  Buffer<cl_uchar> Nodes;
  Buffer<cl_ulong> Packed; ///< packed light
};
}
