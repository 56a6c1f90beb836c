#pragma once

#include "Device/Buffer.h"
#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"
#include "Refraction/Index/IndexRange.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewedPhase.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// The light in a medium as a solver gives it, `fluence` and `fluence_direct` of the data contract; seen, not owned.
struct SolvedLight
{
  Field fluence;       ///< W / length^2, all of it; null: dark
  Field fluenceDirect; ///< its unscattered part; null: not known
  /// Mean direction of the light weighted by power, 3 components; its length is the anisotropy, in [0, 1]. Null: not
  /// known.
  Field meanDirection;
  /// W / (length^2 sr) that leaves through the box's faces, a value for each cell of BoxFaces.h, 4 components
  /// (SurfaceCosines) or 3 times as many (cosine by cosine, red, green, blue). Null: not known.
  Field surface = {};
  /// LightField::scatteredMoments, (degree + 1)^2 or 3 times as many components, and straightOn and lampsApart that
  /// belong to them. Null: not known.
  Field scatteredMoments = {}, straightOn = {};
  std::vector<Light> lampsApart = {};
  /// LightField::facePower, 1 or 3 components, and faceAlbedo, of faces that give back light. Null: not known.
  Field facePower = {};
  std::array<Rgb, 6> faceAlbedo = {};
};

/// What a surface of refractive objects reflects of the light that meets it from the side of the smaller index.
enum class SurfaceReflection
{
  None = 0,
  Fresnel = 1, ///< of unpolarised light, for the indices on both sides
  Fixed = 2,
};

/// The names are those of the filter's properties.
struct ViewSettings
{
  std::array<int, 2> imageSize = { 800, 600 }; ///< pixels
  double stepSize = 0.5;                       ///< voxels a ray advances between samples, [0.01, 10]
  bool singleScatteringOnly = false;           ///< show only light that was scattered once
  /// Find the lights' direct light by shadow rays, with the medium's phase function; without lamps and suns nothing
  /// changes.
  bool shadowRays = false;
  int rectangleSamples = 3;                ///< per edge of a rectangular light, for shadow rays
  bool showBackground = true;              ///< also in what surface and table reflect
  Rgb backgroundColor = { 0.0, 0.0, 0.0 }; ///< radiance behind the medium where there is no environment, [0, 1e37]
  bool skipEmptyBricks = true;             ///< leap over what is empty; changes the time and nothing else
  /// Whether to leave out what the scene does not need; false: three channels, rays that could bend and no leaps, to
  /// measure what that saves.
  bool leaveOut = true;
  double minimumTransmittance = 1e-3; ///< a ray that has less left stops; 0: never
  SurfaceReflection surfaceReflection = SurfaceReflection::None;
  double surfaceIndex = 0.0; ///< the surface is where n has this value, > 0; 0: midway between least and largest n
  double surfaceReflectance = 0.1; ///< of SurfaceReflection::Fixed, [0, 1]
  int tableFace = -1; ///< face of the box (-x, +x, -y, +y, -z, +z) that is a table, seen from within; -1: none
  /// Diffuse reflectance of the table, lit by the light in the voxels on it, [0, 1]; at most 1 together with
  /// tableReflectance.
  Rgb tableColor = { 0.6, 0.6, 0.6 };
  double tableReflectance = 0.1; ///< part that the table mirrors, [0, 1]
  int packetWidth = 0; ///< rays marched together: 1, 4, 8 or 16; 0: what the device does best. Changes the time only
};

/// What a camera sees, row by row from the lowest, pixels from left to right.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<float> radiance; ///< 3 per pixel, W / (length^2 sr)
  /// 1 - transmittance, its mean over the channels: what the medium, and a surface's reflection, let through of what is
  /// behind. 1 where the table is seen.
  std::vector<float> alpha;
  /// Distance from the camera along the view axis to where transmittance (its mean over the channels) falls to 1/2, on
  /// rays that bend as well. `farDepth` where it never does.
  std::vector<float> depth;
  float farDepth = 0.0f; ///< beyond every point of the box
};

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
/// the radiance that the solver says leaves there (`surface`), see SurfaceLight.h: in straight views of all light,
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
  /// @throws InvalidInput as Check(medium) and Check(illumination); for a light array that is not finite or has not 1
  ///   or 3 components (a direction 3); for an index that is not within [1e-3, 1e3] or has not one component; where
  ///   settings ask for an array that is not there; for a setting out of its range
  /// @throws DeviceError if the samples do not fit: 16 bytes per voxel, and as many again for each of coloured
  ///   extinction, the light's direction, emission beside it, a coloured g by voxel, and a refractive index that
  ///   varies; with moments, these and 36 bytes more
  MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const ViewSettings& settings, const Field& ior = {});

  /// Takes over those settings that need nothing new on the device, so that a caster can be kept while its medium,
  /// light and illumination stay as they are: imageSize, stepSize, backgroundColor, skipEmptyBricks,
  /// minimumTransmittance, those of the surface, tableColor, tableReflectance.
  /// @return false, and nothing is changed, where one of the others differs: that needs a new caster
  /// @throws InvalidInput as the constructor
  bool Adopt(const ViewSettings& settings);

  /// The first picture packs what the rays meet; where nothing of it depends on the camera, later ones use it again.
  /// @throws InvalidInput for a camera that looks nowhere; Aborted
  Picture Render(const Camera& camera, const Monitor& monitor = {});

  /// What the scene did not need, in words.
  const std::vector<std::string>& LeftOut() const { return this->Omitted; }

  /// Warnings of what in the scene may not look as it was meant to, a sentence each.
  const std::vector<std::string>& Warnings() const { return this->Doubts; }

private:
  ViewSettings Needed(ViewSettings asked) const;
  double LongestSteps() const;
  std::string StepOption() const;
  std::string PackingOptions() const;
  int PacketWidth() const;
  bool SkipsBricks() const { return this->Settings.skipEmptyBricks && this->Settings.leaveOut; }
  /// Whether the light's mean direction is kept times g, which then is that of all channels.
  bool FlowHasG() const
  {
    return this->Phase.channels == 1 &&
      (this->Phase.formula == ViewedPhase::HenyeyGreenstein || this->Phase.formula == ViewedPhase::Schlick);
  }
  bool ShowsMoments() const { return this->MomentDegree >= 0; }
  /// Emission is not scattered.
  bool GlowsApart() const { return (this->KnowsFlow || this->ShowsMoments()) && this->Components[2] > 0; }
  bool ShowsBeams() const { return this->ShowsMoments() && this->LightCount > 0; }
  double SurfaceIndex() const
  {
    return this->Settings.surfaceIndex > 0.0 ? this->Settings.surfaceIndex
                                             : 0.5 * (this->Index.least + this->Index.largest);
  }
  bool Reflects() const
  {
    return this->Bends && this->Settings.surfaceReflection != SurfaceReflection::None &&
      this->SurfaceIndex() > this->Index.least && this->SurfaceIndex() <= this->Index.largest;
  }
  void TakeMoments(const SolvedLight& light);
  void PrepareAureole(const Medium& medium, const SolvedLight& light);
  void FindTraits(const Medium& medium, const SolvedLight& light, const Field& ior);
  void Upload(const Medium& medium, const SolvedLight& light, const Field& ior);
  void Reserve();
  void PrepareBackground(const Illumination& illumination);
  void PrepareBending();
  void PreparePhase(const PhaseOfMedium& phase);
  std::string PhaseOptions(bool needed) const;
  void PrepareTable(const SolvedLight& light, const Field& ior);
  void PrepareGround(const SolvedLight& light);
  void PrepareSurface(const Medium& medium, const SolvedLight& light);
  void SayWhatIsLeftOut();
  enum class Packing
  {
    ForShadowRays,
    Scattered,  ///< what the camera's rays meet
    Unscattered ///< the same in the dark: how much of what is behind comes through without being scattered at all
  };
  void Pack(Packing what);
  void PackShown(Packing what);
  std::string ShownOptions(Packing what) const;
  void FindBricks(const std::string& options);
  std::string CastingOptions(Packing what) const;
  ShadowInfo MakeShadowInfo(const Camera& camera) const;
  void SeeLights(const Camera& camera, const Monitor& monitor);
  void SeeMoments(const Camera& camera);
  void AddUnscattered(ViewInfo& view, const Monitor& monitor, std::vector<float>& radiance);
  void PrepareSources(const Camera& camera, const Monitor& monitor);
  void CastRays(ViewInfo& view, const OpticsInfo& optics, Packing what, double from, double to, const Monitor& monitor);
  cl::Kernel CastingKernel(Packing what);
  ViewInfo MakeView(const Camera& camera) const;
  OpticsInfo MakeOptics() const;

  Device& TheDevice;
  Grid TheGrid;
  int MomentDegree = -1; ///< of the light; -1: it is not shown by moments
  bool LampsShine = false;
  bool AskedForShadowRays = false; ///< though there may be no lamp
  ViewSettings Settings;           ///< as far as the scene needs them
  ViewedPhase Phase;
  MediumTraits Traits;
  bool HasEmptyBricks = false;
  bool Coloured = false;  ///< extinction differs between channels
  bool Grey = false;      ///< nor does the source
  bool Bends = false;     ///< the refractive index varies
  bool KnowsFlow = false; ///< the light's direction is known and scattering depends on it
  IndexRange Index;
  bool SourcesDependOnCamera = false;
  bool SourcesReady = false;
  double LargestSigmaT = 0.0; ///< at least the largest sigma_t, 1/length
  bool UnderSky = false;      ///< the background is the illumination's, not the settings'
  Rgb Background = {};
  std::array<int, 2> EnvironmentSize = { 0, 0 };
  std::array<int, 3> BrickCount = {};
  int LightCount = 0;
  std::array<int, 5> Components = {};  ///< of absorption, scattering, emission, fluence, fluenceDirect
  std::array<Buffer<float>, 5> Arrays; ///< given back once packed, where nothing will ask for them again
  Buffer<float> MeanDirection, Ior;    ///< as Arrays
  Buffer<float> Moments, StraightOn;   ///< where moments are shown
  Buffer<float> AureoleTables;         ///< there, where g does not vary
  int AureoleChannels = 0;
  int MomentChannels = 0, StraightOnChannels = 0;
  Buffer<float> MeanCosines; ///< g by voxel, likewise
  Buffer<float> PhaseRows;
  Buffer<float> Diffuse;     ///< 3 per voxel: what is scattered towards the eye of light that moments tell of
  Buffer<float> Direct;      ///< 6 per voxel: what the lights scatter towards the eye, and their irradiance
  Buffer<cl_float4> Samples; ///< source and grey extinction, with a border; see ScatteredLight.cl
  Buffer<cl_float4> Extinctions;
  Buffer<cl_float4> Flow;    ///< mean direction, times g where FlowHasG; of ShownSamples.cl lamps' light
  Buffer<cl_float4> Glow;    ///< emission, where Flow is there
  Buffer<cl_float4> Cosines; ///< coloured g by voxel, where Flow is there
  Buffer<cl_float4> Bending; ///< gradient of n^2, and n^2
  Buffer<cl_float4> Table;   ///< light on the table
  Buffer<cl_float4> Ground;  ///< see GroundLight.h
  int FacesOfGround = 0;     ///< a bit for each
  Buffer<cl_float4> Surface; ///< see SurfaceLight.h
  Buffer<cl_char> Bricks;
  Buffer<cl_float4> EnvironmentPixels;
  Buffer<cl_float4> SharpEnvironment; ///< where moments are shown: what of it is seen without being scattered at all
  Buffer<SmallLight> Lights;
  Buffer<float> Radiance, Alpha, Depth; ///< the last picture; kept for the next of its size
  std::vector<std::string> Omitted, Doubts;
};
}
