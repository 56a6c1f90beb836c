#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Viewing/Backdrop/Backdrop.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Rays/RayCasting.h"
#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"
#include "Viewing/Sources/SeenSources.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// Renders a medium whose light field is already solved: marches one ray through every pixel and accumulates scattered
/// light, emission and background, each attenuated by the medium in front of it (numerics.md, section 14, Eq. (105)).
/// Source and sigma_t are sampled at voxel centres and interpolated linearly in between; each step is exact for the
/// coefficients at its midpoint, so vacuum and opaque voxels are not special cases.
///
/// The in-scattered radiance is
///
///   |                     | single scattering only   | all                               |
///   |---|---|---|
///   | without shadow rays | f fluenceDirect / (4 pi) | f fluence / (4 pi)                |
///   | with shadow rays    | sum over lights of E p   | that + max(fluence - D, 0) / 4 pi |
///
/// f is 4 pi times the medium's phase function, averaged over the directions of the incident light as far as
/// meanDirection determines them (Eqs. (107) to (108a)). f = 1 (isotropic scattering) where the medium is isotropic or
/// meanDirection is not given. A single mean direction per voxel represents all of its light, also with single
/// scattering only.
///
/// E is the irradiance of one light after attenuation by the medium; p is the phase function of the voxel and channel,
/// from the light's direction to the camera's. D = min(sum of E, fluenceDirect) is the part of fluence that the shadow
/// rays already give; it is subtracted so that no light counts twice. The sum over lights is evaluated at voxel
/// centres. With shadow rays all other light is taken to scatter isotropically. Shadow rays are straight, also through
/// glass.
///
/// Where the voxels at a face of the box are optically thick, rays that enter through the face receive the solver's
/// outgoing radiance at the face (`surface`), see SurfaceLight in Backdrop.cxx. This applies to straight rays that show
/// all light, without shadow rays, mean directions or a table.
///
/// Every term uses the medium's own sigma_s and sigma_t, even if the solver worked with sigma_s (1 - g).
/// `scattered_radiance`, which solvers store for chosen directions, is for analysis and is not used here: a camera
/// needs as many directions as it has pixels.
///
/// Where the light has angular moments (scatteredMoments) and singleScatteringOnly is off, the moments replace the
/// table above (numerics.md, section 14.7, Eqs. (112a) to (112c)). The picture is then the sum of three parts. The
/// moments give the scattered light of each voxel in the direction of the camera. Shadow rays give the first scattering
/// of lampsApart with the whole phase function, whether or not shadowRays is set. The third part is light of lampsApart
/// that was scattered forwards more than once. Scattering that the solver treated as unscattered does not attenuate the
/// camera's rays. But alpha, depth, backgroundColor and the environment's peaks refer to light that is not scattered at
/// all. The illumination's lights are not used.
///
/// Refraction (Pfeuti 2009, section 3.1.6 and listing A.4, which uses Euler steps). Where the refractive index n
/// varies, rays bend: they are integrated by a second-order leapfrog on the same spline of n^2 that photons use
/// (numerics.md, Eq. (91)). L / n^2 is constant along a ray, Eq. (109), so that glass in an isothermal furnace is
/// invisible. The index is continued unchanged beyond the faces of the box: a face refracts no light. A ray that has
/// not left the box within 16 times the sum of its edges (total reflection can trap light) sees the background in its
/// direction at that point.
///
/// Surface. A ray from the camera is split where n first rises through surfaceIndex (located by bisection to 1e-3
/// voxel): the reflected part is marched through the medium too, but is not reflected again. Fresnel's equations (Eq.
/// (110)) use the indices five voxels before and behind the surface; a sheet thinner than that reflects as if it were
/// thicker.
///
/// Ground. A ray that leaves the box through a reflecting face (faceAlbedo) receives light from the face instead of the
/// background: albedo / pi times the outgoing partial current (facePower), interpolated between the centres of the
/// face's cells (Eq. (111a)). The ground is part of the background: showBackground switches it off, alpha and depth
/// ignore it, and it is invisible from outside.
///
/// Table. Where a ray leaves the box through tableFace it sees
///   tableColor / pi  irradiance  +  tableReflectance  mirrored light,
/// where the irradiance follows from fluence and meanDirection of the voxels on the table (Eq. (111)); with
/// singleScatteringOnly, from fluenceDirect. The mirrored ray of a primary ray is marched through the medium; if that
/// ray, or one reflected by a surface, meets the table (again), it sees the background along its mirrored direction.
/// The table is invisible from outside.
class MediumRayCaster
{
public:
  /// Copies medium and light to the device.
  /// @param illumination  its lights are the targets of shadow rays, its environment and sky are the background
  /// @param ior  refractive index, one component per voxel; null or constant: rays are straight
  /// @param block  if the medium is one block of a grid whose blocks' pictures are composited
  ///   (Blocks/PictureInBlocks.h): position of the block; `ior` then covers the voxels of BlockOfScene::known. Null:
  ///   the medium is the whole domain
  /// @throws InvalidInput as Check(medium) and Check(illumination); for a light array that is not finite or does not
  ///   have 1 or 3 components (a direction: 3); for an index outside [1e-3, 1e3] or without exactly one component; if
  ///   the settings need an array that is missing; for a setting out of its range
  /// @throws DeviceError if the samples do not fit: 16 bytes per voxel (for a mostly empty medium, only for bricks in
  ///   and around the filled ones; on a GPU only where PackedSamples.h applies), and 16 more for each of coloured
  ///   extinction, the light's direction, separate emission, a coloured g by voxel, and a varying refractive index;
  ///   with moments, these and 36 bytes more
  MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const ViewSettings& settings, const Field& ior = {}, const BlockOfScene* block = nullptr);
  MediumRayCaster(const MediumRayCaster&) = delete; // not copyable, since members refer to each other
  MediumRayCaster& operator=(const MediumRayCaster&) = delete;

  /// Changes settings that need no new device data, so that the caster can be reused while medium, light and
  /// illumination stay the same. These settings are imageSize, stepSize, backgroundColor, minimumTransmittance, the
  /// settings of the surface, tableColor and tableReflectance.
  /// @return false, with nothing changed, if any other setting differs: a new caster is needed then
  /// @throws InvalidInput as the constructor
  bool Adopt(const ViewSettings& settings);

  /// Whether backgroundColor is visible: the background is shown, and neither environment nor sky is behind the medium.
  bool ShowsBackgroundColor() const;

  /// Renders the picture. The samples have been packed by the constructor, or are packed here if there are shadow rays
  /// or if the sources depend on the camera.
  /// @param ends  distance along the view axis at which an opaque surface ends each pixel's ray, in units of length;
  ///   1e30 if no surface does; empty: no ray ends. What the surface hides, including the background, is not shown:
  ///   alpha is 1 - transmittance up to the surface. Reflected and mirrored rays are not ended.
  /// @param block  set if the medium is a block of a larger grid: the picture then holds the contribution of this block
  ///   (Blocks/BlockPixels.h); requires CastsBlocks(). Null: the medium is the whole domain
  /// @throws InvalidInput for a degenerate camera, or if `ends` does not have one value per pixel; Aborted
  Picture Render(const Camera& camera, const Monitor& monitor = {}, const std::vector<float>& ends = {},
    const GridBlock* block = nullptr);

  /// Whether the blocks of a grid can be rendered independently and composited: rays are straight and there is no
  /// table. Shadow rays then end at the block's faces.
  bool CastsBlocks() const { return this->Traits.OnlyStraight(); }

  /// Renders a block again, after Render with the same camera, now that the transmittance of the blocks in front is
  /// known. Rays end where the total transmittance of these blocks and this one falls below the minimum; the depth is
  /// where it falls to 1/2.
  /// @param starts  transmittance of the blocks in front
  /// @throws Aborted
  Picture RenderBehind(const Camera& camera, const GridBlock& block, const Starts& starts, const Monitor& monitor = {});

  /// Descriptions of the features that the kernels omit because the scene does not need them.
  const std::vector<std::string>& LeftOut() const { return this->Omitted; }

  /// Warnings about parts of the scene that may not look as intended, a sentence each.
  const std::vector<std::string>& Warnings() const { return this->Doubts; }

private:
  friend class PictureInBlocks; // performs the steps of Render together with other ranks

  MediumRayCaster(Device& device, const Medium& medium, const FilledBricks& filled, const SolvedLight& light,
    const Illumination& illumination, const ViewSettings& settings, const Field& ior, const BlockOfScene* block);
  std::vector<std::string> LeftOutNow() const;
  bool NeedsSources() const { return !this->SourcesReady || this->Traits.sourcesDependOnCamera; }
  void PrepareSources(const Camera& camera, const Monitor& monitor);
  void PackForShadowRays();
  void FinishSources(const Camera& camera);
  void Pack(Packing what);
  Picture Cast(const Camera& camera, const GridBlock* block, const std::vector<float>& ends, const Starts& starts,
    double from, const Monitor& monitor);

  std::optional<BlockOfScene> Part; ///< position of the medium in a larger grid; no value if it is the whole domain
  bool LampsShine = false;
  bool AskedForShadowRays = false; ///< setting shadowRays as the caller gave it, also if there is no lamp
  ViewSettings Settings;           ///< the caller's settings, with shadow rays as the scene needs them (Needed)
  ViewTraits Traits;
  SceneOnDevice Scene; ///< arrays that are not read again are freed once the samples are packed
  PackedSamples Samples;
  SeenSources Sources;
  Backdrop Behind;
  RayCasting Rays;
  bool SourcesReady = false;
  std::vector<std::string> Omitted, Doubts;
};
}
