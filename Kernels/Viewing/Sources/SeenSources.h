#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Light that each voxel scatters towards the eye: the lamps' direct light, computed by shadow rays, and scattered
/// light given by angular moments. Arrays that the scene does not need are empty.
class SeenSources
{
public:
  /// @param lamps   lights for shadow rays; used if ViewTraits::shadowRays
  /// @param rectangleSamples  samples along each edge of a rectangular light
  /// @param traits  must outlive this object
  /// @param block   the medium's place in a larger grid; must outlive this object. Null: the medium is the whole domain
  /// @throws DeviceError if they do not fit
  SeenSources(Device& device, const Medium& medium, const std::vector<Light>& lamps, int rectangleSamples,
    const ViewTraits& traits, const BlockOfScene* block);

  /// Computes Direct() by shadow rays. Reports progress from 0 to 1/2 of a picture.
  /// @param stepSize  step of shadow rays, voxels
  /// @param samples   packed for shadow rays
  /// @throws Aborted
  void SeeLights(const Camera& camera, double stepSize, const SceneOnDevice& scene, const PackedSamples& samples,
    const Monitor& monitor);
  void SeeMoments(const Camera& camera, const SceneOnDevice& scene);

  // SeeLights split by light and by part of the block, for a medium that is one of several blocks: each block computes
  // the optical length of its own section of each shadow ray, and the sections are summed in between.
  const std::vector<SmallLight>& LightsOfBlock() const { return this->Small; }
  /// Optical length, within this block, of the paths from the voxels `asked` (indices of the whole grid) to a light, 3
  /// per voxel.
  /// @throws Aborted
  std::vector<float> DepthsTowards(
    int light, const VoxelBox& asked, double stepSize, const PackedSamples& samples, const Monitor& monitor);
  /// @param part    voxels (indices of the whole grid) that are contiguous in the medium's arrays: some rows along x of
  ///   one slice, or some slices
  /// @param depths  total optical length from each of these voxels to the light, 3 per voxel
  void SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths,
    const SceneOnDevice& scene, const PackedSamples& samples);

  /// Six values per voxel: light scattered towards the eye (3), and irradiance by the lights (3).
  const Buffer<float>& Direct() const { return this->OfLights; }
  /// Three values per voxel: radiance scattered towards the eye, from the angular moments.
  const Buffer<float>& Diffuse() const { return this->OfMoments; }

private:
  ShadowInfo InfoOfVoxels() const;
  ShadowInfo MakeShadowInfo(const Camera& camera) const;
  std::string Options(double steps, bool given) const;

  Device& TheDevice;
  const ViewTraits& Traits;
  const BlockOfScene* Block;
  int LightCount = 0;
  std::vector<SmallLight> Small;
  Buffer<float> AureoleTables; ///< only if moments are shown and g does not vary
  Buffer<float> OfLights, OfMoments;
  Buffer<SmallLight> Lights;
};
}
