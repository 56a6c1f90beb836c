#include "Viewing/MediumRayCaster.h"

#include "Device/Errors.h"
#include "Light/LeftOut.h"
#include "Numerics/Vectors.h"
#include "Viewing/Rays/ViewInfos.h"
#include "Viewing/Scene/ViewChecks.h"

#include <algorithm>
#include <functional>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// The lights for which shadow rays are traced.
const std::vector<Light>& LampsOf(const SolvedLight& light, const Illumination& illumination, const ViewSettings& asked)
{
  return ShownDegree(light, asked) >= 0 ? light.lampsApart : illumination.lights;
}

bool Shine(const std::vector<Light>& lamps)
{
  return std::any_of(lamps.begin(), lamps.end(), [](const Light& lamp) { return !IsBlack(lamp.power); });
}

/// Switches shadow rays off without lamps, and on with moments, which exclude the first scattering of lamps.
ViewSettings Needed(ViewSettings asked, bool showsMoments, bool lampsShine)
{
  asked.shadowRays = (asked.shadowRays || showsMoments) && lampsShine;
  return asked;
}

/// Checks all inputs except the medium's own values.
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
  , Sources(device, medium, LampsOf(light, illumination, asked), this->Settings.rectangleSamples, this->Traits,
      this->Part ? &*this->Part : nullptr)
  , Behind(device, medium, light, illumination, ior, this->Settings, this->Traits, block)
  , Rays(device, this->Scene, this->Samples, this->Behind, this->Traits)
  , Omitted(this->LeftOutNow())
  , Doubts(
      DoubtsAbout(this->Settings, light, this->Traits.bends && !block ? ior : Field{}, this->Traits.index, medium.grid))
{
  if (this->Traits.PacksOnce())
  {
    this->PrepareSources({}, {}); // now, while the caller's arrays exist
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
  omit(this->Behind.FacesOfGround() != 0, "ground: no face of the box gives back light, or it is not shown");
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
  // shadow rays depend on the step size
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

void MediumRayCaster::Pack(Packing what)
{
  this->Samples.Pack(what, this->Scene, this->Sources.Direct(), this->Sources.Diffuse());
}

void MediumRayCaster::PrepareSources(const Camera& camera, const Monitor& monitor)
{
  if (this->Traits.shadowRays)
  {
    this->PackForShadowRays();
    this->Sources.SeeLights(camera, this->Settings.stepSize, this->Scene, this->Samples, monitor);
  }
  this->FinishSources(camera);
}

std::vector<float> MediumRayCaster::DepthsTowards(int light, const VoxelBox& asked, const Monitor& monitor)
{
  return this->Sources.DepthsTowards(light, asked, this->Settings.stepSize, this->Samples, monitor);
}

void MediumRayCaster::SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths)
{
  this->Sources.SeeLight(light, camera, part, depths, this->Scene, this->Samples);
}

void MediumRayCaster::FinishSources(const Camera& camera)
{
  if (this->Traits.ShowsMoments())
  {
    this->Sources.SeeMoments(camera, this->Scene);
  }
  this->Pack(Packing::Scattered);
  this->Omitted = this->LeftOutNow(); // empty bricks are known now
  this->SourcesReady = true;
  if (this->Traits.PacksOnce())
  {
    this->Scene.GiveBackWhatIsPacked();
  }
}

/// @param sharp  parameters of the pass for unscattered light, which alone shows a sharp background, and which gives
///   the picture's alpha and depth (numerics.md, section 14.7)
MediumRayCaster::Pass MediumRayCaster::PassOf(const ViewInfo& view, bool sharp) const
{
  Pass pass = { view, OpticsInfoOf(this->Settings, this->Traits, this->Part ? &*this->Part : nullptr) };
  if (this->Traits.ShowsMoments() && (sharp || !this->Behind.IsSky()))
  {
    // A background colour that is not a sky does not light the medium.
    const bool seen = sharp && !this->Behind.IsSky();
    pass.view.background =
      Float4(seen ? Vector(this->Behind.Colour(this->Settings)) : glm::dvec3(0.0), view.background.s[3]);
  }
  if (sharp)
  {
    pass.optics.table.s[0] = pass.optics.table.s[1] = pass.optics.table.s[2] = 0.0f; // already in the first pass
  }
  return pass;
}

/// @param from  progress that is reported at the begin, in [0, 1]
Picture MediumRayCaster::Cast(
  const ViewInfo& view, const std::vector<float>& ends, const Starts& starts, double from, const Monitor& monitor)
{
  const bool byMoments = this->Traits.ShowsMoments();
  const bool ofBlock = view.block.whole.s[0] > 0;
  this->Rays.Reserve(this->Settings, ends, ofBlock, starts.transmittance);
  const Pass first = this->PassOf(view, false);
  this->Rays.Cast(this->Settings, first.view, first.optics, from, byMoments ? 0.8 : 1.0, monitor);
  Picture picture = this->Read(view);
  if (byMoments)
  {
    this->Pack(Packing::Unscattered);
    this->Rays.Reserve(this->Settings, ends, ofBlock, starts.seen);
    const Pass second = this->PassOf(view, true);
    this->Rays.Cast(this->Settings, second.view, second.optics, 0.8, 1.0, monitor);
    picture.sharp = this->Rays.ReadRadiance();
    picture.sceneTransmittance = this->Rays.ReadTransmittance();
    picture.alpha = this->Rays.ReadAlpha();
    picture.depth = this->Rays.ReadDepth();
  }
  return picture;
}

Picture MediumRayCaster::Render(
  const Camera& camera, const Monitor& monitor, const std::vector<float>& ends, const GridBlock* block)
{
  if (block && !this->CastsBlocks())
  {
    throw InvalidInput("Rays that bend or meet a table cannot be cast through blocks of the medium one by one.");
  }
  const ViewInfo view = this->Rays.ViewOf(camera, this->Settings, block);
  Report(monitor, 0.0);
  const bool prepares = this->NeedsSources();
  if (prepares)
  {
    this->PrepareSources(camera, monitor);
  }
  Picture picture = this->Cast(view, ends, {}, prepares && this->Traits.shadowRays ? 0.5 : 0.0, monitor);
  if (!block && !picture.sharp.empty())
  {
    std::transform(picture.radiance.begin(), picture.radiance.end(), picture.sharp.begin(), picture.radiance.begin(),
      std::plus<float>());
    picture.sharp.clear();
  }
  return picture;
}

/// Reads the picture of the last pass.
Picture MediumRayCaster::Read(const ViewInfo& view) const
{
  Picture picture;
  picture.width = this->Settings.imageSize[0];
  picture.height = this->Settings.imageSize[1];
  picture.farDepth = view.marching.s[2];
  picture.radiance = this->Rays.ReadRadiance();
  picture.transmittance = this->Rays.ReadTransmittance();
  picture.sceneTransmittance = picture.transmittance;
  picture.missing = this->Rays.ReadMissing();
  picture.alpha = this->Rays.ReadAlpha();
  picture.depth = this->Rays.ReadDepth();
  return picture;
}

MediumRayCaster::SharedNumbers MediumRayCaster::SharedByBlocks() const
{
  const ViewedPhase& phase = this->Traits.phase;
  SharedNumbers shared = { this->Traits.index.least, this->Traits.index.largest, 1.0 * phase.formula,
    1.0 * phase.channels, phase.varies ? 1.0 : 0.0, this->Traits.knowsFlow ? 1.0 : 0.0 };
  auto next = shared.begin() + 6;
  for (const cl_float4& parameter : { phase.parameters.first, phase.parameters.second, phase.parameters.part })
  {
    for (int c = 0; c < 3; ++c)
    {
      *next++ = phase.varies ? 0.0 : parameter.s[c];
    }
  }
  return shared;
}

Picture MediumRayCaster::RenderBehind(
  const Camera& camera, const GridBlock& block, const Starts& starts, const Monitor& monitor)
{
  if (this->Samples.PackedFor() != Packing::Scattered)
  {
    this->Pack(Packing::Scattered);
  }
  return this->Cast(this->Rays.ViewOf(camera, this->Settings, &block), {}, starts, 0.0, monitor);
}

Picture MediumRayCaster::CastStraight(const Camera& camera, const Monitor& monitor)
{
  return this->RenderBehind(camera, this->Part->block, {}, monitor);
}

MediumRayCaster::Pass MediumRayCaster::BeginPass(const Camera& camera, bool sharp)
{
  const Packing what = sharp ? Packing::Unscattered : Packing::Scattered;
  if (this->Samples.PackedFor() != what)
  {
    this->Pack(what);
  }
  Pass pass = this->PassOf(this->Rays.ViewOf(camera, this->Settings, &this->Part->block), sharp);
  RayCasting::OfRounds(pass.view);
  return pass;
}

std::vector<RayOnItsWay> MediumRayCaster::StartRays(const Pass& pass, const PixelRows& rows) const
{
  return this->Rays.Start(this->Settings, pass.view, pass.optics, rows);
}

std::vector<RayOnItsWay> MediumRayCaster::MarchRays(
  const Pass& pass, std::vector<RayOnItsWay>& rays, const Monitor& monitor) const
{
  return this->Rays.March(this->Settings, pass.view, pass.optics, rays, monitor);
}
}
