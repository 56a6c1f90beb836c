#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "PhaseFunction/PhaseFunction.h"
#include "Viewing/Samples/Marching.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Light that each voxel sends towards the eye: the lamps' direct light, scattered once and computed by shadow rays,
/// and scattered light from angular moments. Arrays that the scene does not need are empty.
class SeenSources
{
public:
  /// Settings, traits, scene, samples and block must outlive this object.
  /// @param lamps   lights to which shadow rays are traced; used if ViewTraits::shadowRays
  /// @param block   position of the medium in a larger grid; null: the medium is the whole domain
  /// @throws DeviceError if the arrays do not fit the device
  SeenSources(Device& device, const Medium& medium, const std::vector<Light>& lamps, const ViewSettings& settings,
    const ViewTraits& traits, const SceneOnDevice& scene, const PackedSamples& samples, const BlockOfScene* block);

  /// Computes Direct() by shadow rays through the samples, which must be packed for shadow rays. Reports progress from
  /// 0 to 1/2.
  /// @throws Aborted
  void SeeLights(const Camera& camera, const Monitor& monitor);
  void SeeMoments(const Camera& camera);

  // The following functions are the steps of SeeLights for a medium that is one of several blocks. They work light by
  // light and on parts of the block. Each block computes the optical length of its own section of each shadow ray; the
  // caller sums the sections over the blocks.
  const std::vector<SmallLight>& LightsOfBlock() const { return this->Small; }
  /// Optical length, within this block, of the paths from the centres of the voxels `asked` to a light, 3 per voxel.
  /// @param asked  box of voxels, in indices of the whole grid
  /// @throws Aborted
  std::vector<float> DepthsTowards(int light, const VoxelBox& asked, const Monitor& monitor);
  /// Adds the light of one lamp in some voxels to Direct().
  /// @param part    voxels (indices of the whole grid) that are contiguous in the medium's arrays: some rows along x of
  ///   one slice, or some slices
  /// @param depths  total optical length from each of these voxels to the light, 3 per voxel
  void SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths);

  /// Six values per voxel, see ShadowRays.cl. Three are the light of the lamps scattered towards the eye, W / (length^2
  /// sr). The other three are the irradiance by the lamps, W / length^2, or, if there are AureoleTables, the radiance
  /// that repeated forward scattering adds.
  const Buffer<float>& Direct() const { return this->OfLights; }
  /// Three values per voxel: radiance scattered towards the eye, from the angular moments, W / (length^2 sr).
  const Buffer<float>& Diffuse() const { return this->OfMoments; }

private:
  ShadowInfo InfoOfVoxels() const;
  ShadowInfo MakeShadowInfo(const Camera& camera) const;
  cl::Kernel Kernel(const char* name) const;
  void Launch(cl::Kernel& kernel, const std::array<int, 3>& size, double samples, double to, const Monitor& monitor,
    const std::function<void(const Patch& part)>& launch) const;
  void SetArguments(cl::Kernel& see, const ShadowInfo& info, const Buffer<float>& given);

  Device& TheDevice;
  const ViewSettings& Settings;
  const ViewTraits& Traits;
  const SceneOnDevice& Scene;
  const PackedSamples& Samples;
  const BlockOfScene* Block;
  std::vector<SmallLight> Small;
  /// Tables of the light that repeated forward scattering adds (AureoleTable), one per channel. Empty unless light is
  /// shown by angular moments and g is the same in all voxels.
  Buffer<float> AureoleTables;
  Buffer<float> OfLights, OfMoments;
  Buffer<SmallLight> Lights;
};

/// Table of the light that repeated forward scattering adds to the first scattering of a parallel beam. It is needed
/// where the solver treats a fraction of scattering as unscattered (numerics.md, Eq. (112c)); first scattering uses the
/// whole phase function. Values are per steradian, per unit of beam irradiance and per optical length of scattering
/// along the beam's path, tabulated by scattering angle and optical length. They are negative near the beam, because
/// the light treated as unscattered is in fact spread in angle.
///
/// The table has AureoleRows + 2 rows of AureoleColumns + 2 numbers, see aureole_at in ShadowRays.cl.
/// @param straightOn  fraction of scattering that is treated as unscattered
/// @param degree      degree of the moments that were solved for, used where straightOn is not a moment of the function
std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn, int degree);
}
