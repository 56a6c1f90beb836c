#pragma once

#include "Device/Buffer.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Index/RefractiveMedium.h"
#include "Refraction/Voxelization/MaterialsShared.h"

namespace tyndall
{
/// Mixes the materials in each voxel of a box of the grid, slab by slab.
class MaterialMixer
{
public:
  /// Keeps references to all arguments.
  /// @param variedG  whether the scattering materials differ in their mean cosines
  /// @param index    output: n in the box's voxels, not smoothed
  /// @param result   output: occupancy, coefficients and g of the box's voxels
  MaterialMixer(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
    const VoxelBox& box, bool variedG, Buffer<float>& index, RefractiveMedium& result);

  /// Adds the samples inside one mesh in one slab; a callback for CountSamplesInside.
  void Take(const SamplesInside& inside);

private:
  void Begin(std::size_t voxels);
  void Add(const SamplesInside& inside);
  void End(const SamplesInside& inside);
  MaterialSlab SlabOf(const SamplesInside& inside) const;
  float SamplesOfVoxel() const;
  void Launch(cl::Kernel& kernel, const SamplesInside& inside);
  void Copy(const Buffer<float>& from, const SamplesInside& inside, int components, std::vector<float>& to);

  Device& TheDevice;
  const std::vector<Solid>& Solids;
  const RefractiveMediumSettings& Settings;
  const VoxelBox Box;
  const bool VariedG;
  Buffer<float>& Index;
  RefractiveMedium& Result;
  Buffer<float> Covered, SigmaA, SigmaS, G; ///< buffers of one slab
  cl::Kernel AddObject, AddOutside;
};
}
