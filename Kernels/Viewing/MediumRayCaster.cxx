#include "Viewing/MediumRayCaster.h"

#include "Device/Errors.h"
#include "Light/LeftOut.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
constexpr float LeastViewedIndex = 1e-3f;
constexpr float LargestViewedIndex = 1e3f;
/// A warning is given if the refractive index varies over the box's faces by more than this fraction. Smoothing of
/// structures near the border causes smaller variations.
constexpr float FacesAlike = 1e-3f;

IndexRange RangeOnFaces(const Field& ior, const Grid& grid)
{
  IndexRange range = { ior.values[0], ior.values[0] };
  const std::array<int, 3>& size = grid.size;
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      const bool wholeRow = k == 0 || k == size[2] - 1 || j == 0 || j == size[1] - 1;
      const float* row = ior.values + grid.IndexOf({ 0, j, k });
      // Only voxels at the box's faces are examined. A row that lies on a y or z face is examined completely, other
      // rows at their first and last voxels, which lie on the x faces.
      const int step = wholeRow ? 1 : std::max(size[0] - 1, 1);
      for (int i = 0; i < size[0]; i += step)
      {
        range.least = std::min(range.least, row[i]);
        range.largest = std::max(range.largest, row[i]);
      }
    }
  }
  return range;
}

/// Warnings about inputs that probably do not give the intended picture, one sentence each: a table without light, a
/// surface index that does not occur in the medium, an index that varies over the box's faces.
/// @param ior    refractive index; null: constant
/// @param index  range of `ior`
std::vector<std::string> DoubtsAbout(
  const ViewSettings& settings, const SolvedLight& light, const Field& ior, const IndexRange& index, const Grid& grid)
{
  std::vector<std::string> doubts;
  if (settings.tableFace >= 0 && !light.fluence.values)
  {
    doubts.push_back(
      "The table is dark: it is lit by fluence, which is missing. PhotonMarcher and other solvers make it.");
  }
  if (!ior.values)
  {
    return doubts;
  }
  if (settings.surfaceReflection != SurfaceReflection::None && settings.surfaceIndex > 0.0 &&
    !(settings.surfaceIndex > index.least && settings.surfaceIndex <= index.largest))
  {
    doubts.push_back("No surface reflects: its index is " + Text("%g", settings.surfaceIndex) +
      ", those of the grid are from " + Text("%g", index.least) + " to " + Text("%g", index.largest) + ".");
  }
  const IndexRange faces = RangeOnFaces(ior, grid);
  if (faces.largest - faces.least > FacesAlike * faces.largest)
  {
    doubts.push_back("The refractive index varies over the faces of the box, from " + Text("%g", faces.least) + " to " +
      Text("%g", faces.largest) +
      ": light is not bent there, and looks brighter or darker by n^2. Give the box a margin.");
  }
  return doubts;
}

/// Checks the refractive index.
/// @throws InvalidInput for an index that is not finite, lies outside [1e-3, 1e3] or does not have exactly one
///   component
void CheckViewedIndex(const Field& ior, const Grid& grid)
{
  Require(!ior.values || ior.components == 1,
    "ior has " + std::to_string(ior.components) + " components a voxel; a refractive index has 1.");
  CheckIndex(ior, Domain(grid));
  for (std::size_t i = 0; ior.values && i < grid.VoxelCount(); ++i)
  {
    if (ior.values[i] < LeastViewedIndex || ior.values[i] > LargestViewedIndex)
    {
      throw InvalidInput("ior is " + Text("%g", ior.values[i]) + " in voxel " + VoxelName(grid, i) +
        " (the first such voxel); rays are followed where it is from 0.001 to 1000.");
    }
  }
}

/// The lights to which shadow rays are traced. If light is shown by angular moments, these are the lamps whose first
/// scattering is not in the moments (SolvedLight::lampsApart); otherwise they are the illumination's lights.
const std::vector<Light>& LampsOf(const SolvedLight& light, const Illumination& illumination, const ViewSettings& asked)
{
  return ShownDegree(light, asked) >= 0 ? light.lampsApart : illumination.lights;
}

bool Shine(const std::vector<Light>& lamps)
{
  return std::any_of(lamps.begin(), lamps.end(), [](const Light& lamp) { return !IsBlack(lamp.power); });
}

/// Adapts the caller's setting shadowRays to the scene. It is switched off if there are no lamps. It is switched on if
/// angular moments are shown, since these do not include the first scattering of lamps.
ViewSettings Needed(ViewSettings asked, bool showsMoments, bool lampsShine)
{
  asked.shadowRays = (asked.shadowRays || showsMoments) && lampsShine;
  return asked;
}

/// Checks all inputs except the medium's own values.
/// @return the settings as the scene needs them (function Needed)
/// @throws InvalidInput as the constructor
ViewSettings Checked(const Medium& medium, const SolvedLight& light, const Illumination& illumination,
  const ViewSettings& asked, const Field& ior, const BlockOfScene* block, bool lampsShine)
{
  Check(illumination);
  Check(asked);
  const ViewSettings settings = Needed(asked, ShownDegree(light, asked) >= 0, lampsShine);
  Check(light, medium.grid, settings);
  Grid known = medium.grid;
  known.size = block ? block->known.size : known.size;
  CheckViewedIndex(ior, known);
  return settings;
}
}

MediumRayCaster::MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light,
  const Illumination& illumination, const ViewSettings& asked, const Field& ior, const BlockOfScene* block)
  : MediumRayCaster(device, medium, CheckedBricks(medium), light, illumination, asked, ior, block)
{
}

MediumRayCaster::MediumRayCaster(Device& device, const Medium& medium, const FilledBricks& filled,
  const SolvedLight& light, const Illumination& illumination, const ViewSettings& asked, const Field& ior,
  const BlockOfScene* block)
  : Part(block ? std::optional<BlockOfScene>(*block) : std::nullopt)
  , LampsShine(Shine(LampsOf(light, illumination, asked)))
  , AskedForShadowRays(asked.shadowRays)
  , Settings(Checked(medium, light, illumination, asked, ior, block, this->LampsShine))
  , Traits(
      ViewTraitsOf(medium, filled, light, ior, this->Settings, device.KernelWidth(), block ? &block->shared : nullptr))
  , Scene(device, medium, light, ior, this->Traits, block)
  , Samples(device, filled, this->Scene, this->Traits, block)
  , Sources(device, medium, LampsOf(light, illumination, asked), this->Settings, this->Traits, this->Scene,
      this->Samples, this->Part ? &*this->Part : nullptr)
  , Behind(device, medium, light, illumination, ior, this->Settings, this->Traits, block)
  , Rays(device, this->Scene, this->Samples, this->Behind, this->Traits, this->Settings,
      this->Part ? &*this->Part : nullptr)
  , Omitted(this->LeftOutNow())
  , Doubts(
      DoubtsAbout(this->Settings, light, this->Traits.bends && !block ? ior : Field{}, this->Traits.index, medium.grid))
{
  if (this->Traits.PacksOnce())
  {
    // The light that voxels emit and scatter is computed now and not in Render, because the caller's arrays may not
    // outlive the constructor.
    this->PrepareSources({}, {});
  }
}

std::vector<std::string> MediumRayCaster::LeftOutNow() const
{
  const ViewTraits& traits = this->Traits;
  std::vector<std::string> omitted;
  const auto omit = [&omitted](bool needed, const char* what) {
    if (!needed)
    {
      omitted.push_back(what);
    }
  };
  omit(traits.coloured || traits.grey, left_out::GreyExtinction);
  omit(!traits.grey, left_out::Grey);
  omit(traits.components[2] > 0, left_out::NoEmission);
  omit(traits.shadowRays,
    this->AskedForShadowRays ? "shadow rays: no lamp and no sun shines" : "shadow rays: not asked for");
  omit(this->Behind.HasEnvironment(), "environment: none, or not shown");
  omit(traits.ReadsPhase() || traits.ShowsMoments(),
    "phase function: the medium scatters evenly, or the direction of the light is not known");
  omit(traits.bends, left_out::ConstantIndex);
  omit(!traits.SkipsBricks(this->Settings) || !this->Samples.HasEmptyBricks(), left_out::EmptyBricks);
  omit(traits.Reflects(this->Settings),
    !traits.index.Varies() ? "surface reflection: the refractive index is constant"
      : this->Settings.surfaceReflection == SurfaceReflection::None
      ? "surface reflection: not asked for"
      : "surface reflection: no refractive index is as large "
        "as the surface's, or none is smaller");
  omit(traits.hasTable, "table: none");
  omit(this->Behind.HasGround(), "ground: no face of the box gives back light, or it is not shown");
  omit(this->Behind.HasSurfaceLight(),
    "light at the surface: no thick voxels at the faces of the box, or it is not known there");
  return omitted;
}

bool MediumRayCaster::Adopt(const ViewSettings& asked)
{
  Check(asked);
  const ViewSettings settings = Needed(asked, this->Traits.ShowsMoments(), this->LampsShine);
  const ViewSettings& now = this->Settings;
  if (settings.singleScatteringOnly != now.singleScatteringOnly || settings.shadowRays != now.shadowRays ||
    settings.rectangleSamples != now.rectangleSamples || settings.showBackground != now.showBackground ||
    settings.packetWidth != now.packetWidth || settings.tableFace != now.tableFace ||
    settings.leaveOut != now.leaveOut || settings.skipEmptyBricks != now.skipEmptyBricks ||
    (this->Behind.HasSurfaceLight() && settings.stepSize != now.stepSize))
  {
    return false;
  }
  // Light computed by shadow rays depends on the step size.
  this->SourcesReady &= !this->Traits.shadowRays || settings.stepSize == now.stepSize;
  this->Settings = settings;
  this->AskedForShadowRays = asked.shadowRays;
  this->Omitted = this->LeftOutNow();
  return true;
}

bool MediumRayCaster::ShowsBackgroundColor() const
{
  return this->Settings.showBackground && !this->Behind.IsSky() && !this->Behind.HasEnvironment();
}

/// Packs the samples of the medium for the pass `what` of the picture, for scattered or for unscattered light, unless
/// they are already packed for this pass.
void MediumRayCaster::Pack(Packing what)
{
  if (this->Samples.PackedFor() != what)
  {
    this->Samples.Pack(what, this->Scene, this->Sources.Direct(), this->Sources.Diffuse());
  }
}

void MediumRayCaster::PrepareSources(const Camera& camera, const Monitor& monitor)
{
  if (this->Traits.shadowRays)
  {
    this->PackForShadowRays();
    this->Sources.SeeLights(camera, monitor);
  }
  this->FinishSources(camera);
}

/// Packs the samples for shadow rays.
void MediumRayCaster::PackForShadowRays()
{
  this->Samples.Pack(Packing::ForShadowRays, this->Scene, this->Sources.Direct(), this->Sources.Diffuse());
}

/// Completes the sources for camera rays once the light of all lamps is known: evaluates the angular moments in the
/// direction of the camera, then packs the samples.
void MediumRayCaster::FinishSources(const Camera& camera)
{
  if (this->Traits.ShowsMoments())
  {
    this->Sources.SeeMoments(camera);
  }
  this->Samples.Pack(Packing::Scattered, this->Scene, this->Sources.Direct(), this->Sources.Diffuse());
  this->Omitted = this->LeftOutNow(); // again, because only packing shows whether there are empty bricks
  this->SourcesReady = true;
  if (this->Traits.PacksOnce())
  {
    this->Scene.GiveBackWhatIsPacked();
  }
}

/// Renders one picture, or with angular moments its two passes, from the packed samples.
/// @param from  progress that is reported at the start, in [0, 1]
Picture MediumRayCaster::Cast(const Camera& camera, const GridBlock* block, const std::vector<float>& ends,
  const Starts& starts, double from, const Monitor& monitor)
{
  const bool byMoments = this->Traits.ShowsMoments();
  this->Pack(Packing::Scattered);
  Picture picture = this->Rays.Cast(
    this->Rays.PassOf(camera, block, false), ends, starts.transmittance, from, byMoments ? 0.8 : 1.0, monitor);
  if (byMoments)
  {
    this->Pack(Packing::Unscattered);
    Picture sharp = this->Rays.Cast(this->Rays.PassOf(camera, block, true), ends, starts.seen, 0.8, 1.0, monitor);
    sharp.sharp = std::exchange(sharp.radiance, std::move(picture.radiance));
    sharp.transmittance = std::move(picture.transmittance);
    return sharp;
  }
  return picture;
}

Picture MediumRayCaster::Render(
  const Camera& camera, const Monitor& monitor, const std::vector<float>& ends, const GridBlock* block)
{
  Require(!block || this->CastsBlocks(),
    "Rays that bend or meet a table cannot be cast through blocks of the medium one by one.");
  this->Rays.PassOf(camera, block, false); // throws if the camera is invalid; the result is not used
  Report(monitor, 0.0);
  const bool prepares = this->NeedsSources();
  if (prepares)
  {
    this->PrepareSources(camera, monitor);
  }
  Picture picture = this->Cast(camera, block, ends, {}, prepares && this->Traits.shadowRays ? 0.5 : 0.0, monitor);
  if (!block && !picture.sharp.empty())
  {
    std::transform(picture.radiance.begin(), picture.radiance.end(), picture.sharp.begin(), picture.radiance.begin(),
      std::plus<float>());
    picture.sharp.clear();
  }
  return picture;
}

Picture MediumRayCaster::RenderBehind(
  const Camera& camera, const GridBlock& block, const Starts& starts, const Monitor& monitor)
{
  return this->Cast(camera, &block, {}, starts, 0.0, monitor);
}
}
