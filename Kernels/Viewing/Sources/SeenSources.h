#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

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
  /// @throws DeviceError if they do not fit
  SeenSources(Device& device, const Medium& medium, const SolvedLight& light, const std::vector<Light>& lamps,
    int rectangleSamples, const ViewTraits& traits);

  /// Reports the first half of a picture.
  /// @param stepSize  voxels that shadow rays advance between samples
  /// @param samples   packed for shadow rays
  /// @throws Aborted
  void SeeLights(const Camera& camera, double stepSize, const SceneOnDevice& scene, const PackedSamples& samples,
    const Monitor& monitor);
  void SeeMoments(const Camera& camera, const SceneOnDevice& scene);

  /// 6 per voxel: what the lights scatter towards the eye, and their irradiance.
  const Buffer<float>& Direct() const { return this->OfLights; }
  /// 3 per voxel: what is scattered towards the eye of light that moments tell of.
  const Buffer<float>& Diffuse() const { return this->OfMoments; }

private:
  ShadowInfo MakeShadowInfo(const Camera& camera) const;

  Device& TheDevice;
  const ViewTraits& Traits;
  int LightCount = 0;
  Buffer<float> AureoleTables; ///< where moments are shown and g does not vary
  Buffer<float> OfLights, OfMoments;
  Buffer<SmallLight> Lights;
};
}
