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

/// A block of a medium on its device, and the light of the photons that were marched through it as published.
class PublishedMarch
{
public:
  /// Voxels round a block whose index bends photons in it: one for interpolation, and one for differences.
  static constexpr int Reach = 2;

  /// @param medium  of the block's voxels; must stay
  /// @param ior     of `part.known`, as far as Reach goes; null: rays are straight
  /// @param levels  of the block's voxels, of the whole grid's octree; null: there is none
  /// @param stepLimit  of a photon
  /// @param tries   of compare-and-swap before a deposit is given up
  PublishedMarch(Device& device, const Medium& medium, const float* ior, const std::uint8_t* levels,
    const MarchedPart& part, int stepLimit, int tries);

  /// As far as the block goes: of each photon its place, face and counts are what became of it.
  /// @param photons  that set off in the block or come to it. @throws Aborted
  void March(std::vector<PublishedPhoton>& photons, const Monitor& monitor);

  /// 3 per voxel.
  struct Light
  {
    std::vector<float> fluence, direction;
  };
  /// @param unit  W of one unit of power
  Light Unpack(double unit);
  /// Values of a box, 3 a voxel, after the 3x3x3 Gauss filter of the published scheme; beyond the box, the
  /// values of its faces again.
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
  Buffer<cl_float4> Index; ///< and its gradient; empty where rays are straight
  Buffer<float> SigmaA, SigmaS;
  Buffer<cl_uchar> Nodes;
  Buffer<cl_ulong> Packed; ///< light
};
}
