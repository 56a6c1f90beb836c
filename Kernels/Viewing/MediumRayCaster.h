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
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SceneOnDevice.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"
#include "Viewing/Sources/SeenSources.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// Pictures of a medium whose light is known: marches a ray through every pixel and gathers scattered and emitted light
/// and the background, each dimmed by the medium before it (numerics.md, section 14, Eq. (105)). The source and sigma_t
/// are taken at voxel centres and interpolated linearly between them; each step is exact for the coefficients in its
/// middle, so that vacuum, opaque voxels and everything between need no special case.
///
/// The in-scattered radiance is
///
///   |                     | single scattering only   | all                               |
///   |---|---|---|
///   | without shadow rays | f fluenceDirect / (4 pi) | f fluence / (4 pi)                |
///   | with shadow rays    | sum over lights of E p   | that + max(fluence - D, 0) / 4 pi |
///
/// f is 4 pi times the medium's phase function, averaged over the directions from which the light comes, as far as
/// meanDirection tells (Eqs. (107) to (108a)); 1, light scatters evenly, where the medium is isotropic or meanDirection
/// is not given. One direction a voxel stands for all its light, in single scattering as well.
///
/// E is a light's irradiance behind the medium, p the phase function, of the voxel and of each channel, from the
/// light's direction to the camera's. D = min(sum of E, fluenceDirect) is the part of fluence that E shows already,
/// so that nothing counts twice. The sum over lights is found at voxel centres. With shadow rays all other light
/// scatters evenly. Shadow rays go straight on, through glass as well.
///
/// Where voxels at the faces of the box are thicker than a mean free path, rays that come in through such a face show
/// the radiance that the solver says leaves there (`surface`), see BackdropTables.h: in straight views of all light,
/// without shadow rays, directions of light or a table.
///
/// sigma_s and sigma_t are the medium's own in every term, also where a solver worked with sigma_s (1 - g).
/// `scattered_radiance`, which solvers keep for chosen directions, is data to look at and is not used here: a camera
/// sees along as many directions as it has pixels.
///
/// Where the light has angular moments (scatteredMoments) and singleScatteringOnly is off, they replace all this
/// (numerics.md, section 14.7, Eqs. (112a) to (112c)): scattered light by its moments, evaluated in each voxel along
/// the way to the camera; the first scattering of lampsApart by shadow rays and the whole phase function, whether
/// shadowRays asks for them or not; and what of that was scattered forwards more than once. What was taken to go
/// straight on goes on along the camera's rays too, but alpha, depth, backgroundColor and the environment's peaks are
/// of light that is not scattered at all. The illumination's lights are not used then.
///
/// Refraction (Pfeuti 2009, section 3.1.6 and listing A.4, who steps by Euler's method). Where the refractive index n
/// varies rays bend, by a leapfrog of order 2 on the spline of n^2 that photons follow too (numerics.md, Eq. (91)). L /
/// n^2 stays the same along a ray, Eq. (109), so that glass in a furnace cannot be told from the rest. The index is
/// taken to go on beyond the box's faces as it is there: no light is bent at a face. A ray that does not find out of
/// the box within 16 times the sum of its edges (total reflection can trap light) sees the background along the
/// direction that it has then.
///
/// Surface. On its way from the camera a ray is split where n first rises through surfaceIndex (found by bisection to
/// 1e-3 voxel): the reflected part is marched through the medium as well, and reflects no further. Fresnel's equations
/// (Eq. (110)) take the indices five voxels before and behind; a sheet thinner than that reflects as if it were
/// thicker.
///
/// Ground. Where a ray leaves the box through a face that gives back light (faceAlbedo), it sees, in place of the
/// background, albedo / pi times what leaves through the face there (facePower), smooth between the cells' middles (Eq.
/// (111a)). It is part of the background: showBackground switches it off, alpha and depth do not know of it, and from
/// outside it is not seen.
///
/// Table. Where a ray leaves the box through tableFace it sees
///   tableColor / pi  irradiance  +  tableReflectance  mirrored light,
/// the irradiance by the fluence and meanDirection of the voxels on the table (Eq. (111)); with singleScatteringOnly,
/// by fluenceDirect. What rays from the camera mirror there is marched through the medium; where that, or what a
/// surface reflected, meets the table (again), the background stands for what the table mirrors of it. From outside the
/// table is not seen.
class MediumRayCaster
{
public:
  /// Brings medium and light to the device.
  /// @param illumination  its lights are used by shadow rays, environment and sky as background
  /// @param ior  refractive index, one component per voxel; null or constant: rays are straight
  /// @param block  where the medium is one of several blocks of a grid whose pictures are to make up that of the whole
  ///   (Blocks/PictureInBlocks.h): `ior` is of the voxels that it says. Null: of none
  /// @throws InvalidInput as Check(medium) and Check(illumination); for a light array that is not finite or has not 1
  ///   or 3 components (a direction 3); for an index that is not within [1e-3, 1e3] or has not one component; where
  ///   settings ask for an array that is not there; for a setting out of its range
  /// @throws DeviceError if the samples do not fit: 16 bytes per voxel (of a medium that is mostly empty, of bricks
  ///   in and around what is filled only; on a GPU only where SampleBricks.h applies), and as many again for each of
  ///   coloured extinction, the light's direction, emission beside it, a coloured g by voxel, and a refractive index
  ///   that varies; with moments, these and 36 bytes more
  MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const ViewSettings& settings, const Field& ior = {}, const BlockOfScene* block = nullptr);
  MediumRayCaster(const MediumRayCaster&) = delete; // its parts see each other
  MediumRayCaster& operator=(const MediumRayCaster&) = delete;

  /// Takes over those settings that need nothing new on the device, so that a caster can be kept while its medium,
  /// light and illumination stay as they are: imageSize, stepSize, backgroundColor, minimumTransmittance,
  /// those of the surface, tableColor, tableReflectance.
  /// @return false, and nothing is changed, where one of the others differs: that needs a new caster
  /// @throws InvalidInput as the constructor
  bool Adopt(const ViewSettings& settings);

  /// Whether settings' backgroundColor is seen: there is nothing else behind the medium, and the background is shown.
  bool ShowsBackgroundColor() const;

  /// What the rays meet is packed by the constructor; with shadow rays, and where it depends on the camera, here.
  /// @param ends  where an opaque surface ends each pixel's ray, as a distance along the view axis, length; 1e30 where
  ///   none does; empty: nowhere. What the surface hides, the background with it, is not in the picture then: alpha is
  ///   1 - transmittance up to there. What is reflected or mirrored does not end.
  /// @param block  of the larger grid of which the medium is a block; null: of none. The picture then has what the
  ///   block adds to that of the whole (Blocks/BlockPixels.h), where CastsBlocks
  /// @throws InvalidInput for a camera that looks nowhere, or ends of another number than pixels; Aborted
  Picture Render(const Camera& camera, const Monitor& monitor = {}, const std::vector<float>& ends = {},
    const GridBlock* block = nullptr);

  /// Whether pictures of blocks that know nothing of each other make up that of the whole: rays go straight on and meet
  /// no table. Shadow rays end at the block's faces.
  bool CastsBlocks() const { return this->Traits.OnlyStraight(); }

  /// What has to be the same of all blocks of a grid where they are cast one by one: refractive index and phase
  /// function.
  using SharedNumbers = std::array<double, 15>;
  SharedNumbers SharedByBlocks() const;

  /// After Render of a block from the same camera: its picture behind other blocks. Rays end where little light is left
  /// of all that they have lost, and depth is where half of that is.
  /// @throws Aborted
  Picture RenderBehind(const Camera& camera, const GridBlock& block, const Starts& starts, const Monitor& monitor = {});

  // Steps of Render for blocks that are seen together (Blocks/PictureInBlocks.h), of a caster that has been given its
  // block. What a step finds here, other blocks need for the next.

  const BlockOfScene& Block() const { return *this->Part; }
  double StepSize() const { return this->Settings.stepSize; }
  bool ShowsMoments() const { return this->Traits.ShowsMoments(); }
  bool NeedsSources() const { return !this->SourcesReady || this->Traits.sourcesDependOnCamera; }
  /// Whose shadow rays are followed.
  const std::vector<SmallLight>& LightsOfBlock() const { return this->Sources.LightsOfBlock(); }
  void PackForShadowRays() { this->Pack(Packing::ForShadowRays); }
  /// See SeenSources. @throws Aborted
  std::vector<float> DepthsTowards(int light, const VoxelBox& asked, const Monitor& monitor);
  void SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths);
  /// When all lights are seen.
  void FinishSources(const Camera& camera);
  /// Of rays that go straight on through the block.
  Picture CastStraight(const Camera& camera, const Monitor& monitor);

  /// What rays that go from block to block are cast with.
  struct Pass
  {
    ViewInfo view;
    OpticsInfo optics;
  };
  /// @param sharp  of what comes from behind without being scattered, after the other: where ShowsMoments
  Pass BeginPass(const Camera& camera, bool sharp);
  std::size_t RaysThatFit() const { return this->Rays.CountThatFits(this->Settings); }
  std::vector<RayOnItsWay> StartRays(const Pass& pass, const PixelRows& rows) const;
  /// See RayCasting. @throws Aborted
  std::vector<RayOnItsWay> MarchRays(const Pass& pass, std::vector<RayOnItsWay>& rays, const Monitor& monitor) const;

  /// At which rays end.
  double MinimumTransmittance() const { return this->Settings.minimumTransmittance; }

  /// What the scene did not need, in words.
  const std::vector<std::string>& LeftOut() const { return this->Omitted; }

  /// Warnings of what in the scene may not look as it was meant to, a sentence each.
  const std::vector<std::string>& Warnings() const { return this->Doubts; }

private:
  MediumRayCaster(Device& device, const Medium& medium, const FilledBricks& filled, const SolvedLight& light,
    const Illumination& illumination, const ViewSettings& settings, const Field& ior, const BlockOfScene* block);
  std::vector<std::string> LeftOutNow() const;
  void PrepareSources(const Camera& camera, const Monitor& monitor);
  void Pack(Packing what);
  Pass PassOf(const ViewInfo& view, bool sharp) const;
  Picture Cast(
    const ViewInfo& view, const std::vector<float>& ends, const Starts& starts, double from, const Monitor& monitor);
  Picture Read(const ViewInfo& view) const;

  std::optional<BlockOfScene> Part; ///< of a whole
  bool LampsShine = false;
  bool AskedForShadowRays = false; ///< though there may be no lamp
  ViewSettings Settings;           ///< as far as the scene needs them
  ViewTraits Traits;
  SceneOnDevice Scene; ///< given back once packed, where nothing will read it again
  PackedSamples Samples;
  SeenSources Sources;
  Backdrop Behind;
  RayCasting Rays;
  bool SourcesReady = false;
  std::vector<std::string> Omitted, Doubts;
};
}
