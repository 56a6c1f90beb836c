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
/// What each voxel scatters towards the eye: of the lamps' light, found by shadow rays, and of light whose angular
/// moments are known. Empty for what the scene does not have.
class SeenSources
{
public:
  /// @param lamps   that shadow rays find, where ViewTraits::shadowRays
  /// @param rectangleSamples  per edge of a rectangular light
  /// @param traits  must stay
  /// @param block   of which the medium is one, must stay; null: of none
  /// @throws DeviceError if they do not fit
  SeenSources(Device& device, const Medium& medium, const std::vector<Light>& lamps, int rectangleSamples,
    const ViewTraits& traits, const BlockOfScene* block);

  /// Reports the first half of a picture.
  /// @param stepSize  voxels that shadow rays advance between samples
  /// @param samples   packed for shadow rays
  /// @throws Aborted
  void SeeLights(const Camera& camera, double stepSize, const SceneOnDevice& scene, const PackedSamples& samples,
    const Monitor& monitor);
  void SeeMoments(const Camera& camera, const SceneOnDevice& scene);

  // The same as SeeLights light by light and part by part, where the medium is one of several blocks of a grid: what
  // these find, each of its own part of the way, is added up in between.
  const std::vector<SmallLight>& LightsOfBlock() const { return this->Small; }
  /// Of a light: optical length in this block of the ways to it from voxels of the whole, 3 each.
  /// @throws Aborted
  std::vector<float> DepthsTowards(
    int light, const VoxelBox& asked, double stepSize, const PackedSamples& samples, const Monitor& monitor);
  /// @param part    voxels of the whole that follow each other in the medium: some of its rows along x in one slice, or
  ///   some of its slices
  /// @param depths  towards the light from each of them
  void SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths,
    const SceneOnDevice& scene, const PackedSamples& samples);

  /// 6 per voxel: what the lights scatter towards the eye, and their irradiance.
  const Buffer<float>& Direct() const { return this->OfLights; }
  /// 3 per voxel: what is scattered towards the eye of light that moments tell of.
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
  Buffer<float> AureoleTables; ///< where moments are shown and g does not vary
  Buffer<float> OfLights, OfMoments;
  Buffer<SmallLight> Lights;
};
}
