#include "Viewing/MediumRayCaster.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Medium/Traits.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/SquaredIndex.h"
#include "TyndallKernelSources.h"
#include "Viewing/Backdrop/GroundLight.h"
#include "Viewing/Backdrop/SurfaceLight.h"
#include "Viewing/Backdrop/ViewLights.h"
#include "Viewing/Samples/Bricks.h"
#include "Viewing/Scene/ViewChecks.h"
#include "Viewing/Sources/Aureole.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 16;            ///< of a ray through the volume, in sums of its edges
constexpr double BentStretch = 4.0;         ///< voxels, before it is asked whether rays still bend
constexpr double BesideSurface = 5.0;       ///< voxels from a surface, beyond its smoothing (9 voxels wide) by default
constexpr double SurfacePrecision = 1.0e-3; ///< voxels
constexpr double SamplesAtOnce = 3.2e7; ///< of the work between two reports, at most: under a second on one old core
constexpr int DirectionsOfPeaks = 25;   ///< a face, by which the environment's peaks are told from the rest
constexpr double ManySteps = 4096.0;    ///< of a ray, from which on rounding in each of them adds up to 1e-4

/// Columns and rows of pixels in a packet, as in View.cl.
std::array<int, 2> PacketPixels(int width)
{
  return width == 16 ? std::array<int, 2>{ 4, 4 }
    : width == 8     ? std::array<int, 2>{ 4, 2 }
    : width == 4     ? std::array<int, 2>{ 2, 2 }
                     : std::array<int, 2>{ 1, 1 };
}

/// A bound of sigma_t over voxels and channels, 1/length.
double ExtinctionBound(const Medium& medium)
{
  double sum = 0.0;
  for (const Field& field : { medium.sigma_a, medium.sigma_s })
  {
    const std::size_t count = field.values ? medium.grid.VoxelCount() * field.components : 0;
    sum += count > 0 ? *std::max_element(field.values, field.values + count) : 0.0f;
  }
  return sum;
}

/// Of the moments that a picture is made of; -1: of none.
int ShownDegree(const SolvedLight& light, const ViewSettings& settings)
{
  return light.scatteredMoments.values && !settings.singleScatteringOnly ? DegreeOf(light.scatteredMoments) : -1;
}

bool Shine(const std::vector<Light>& lamps)
{
  return std::any_of(lamps.begin(), lamps.end(), [](const Light& lamp) { return !IsBlack(lamp.power); });
}

std::size_t PaddedCount(const Grid& grid)
{
  return static_cast<std::size_t>(grid.size[0] + 2) * (grid.size[1] + 2) * (grid.size[2] + 2);
}

/// Work-groups have fixed shapes throughout: PoCL compiles a kernel anew for every shape.
///
/// Of rows of cells of work: whole rows, or parts of them where a row takes more than SamplesAtOnce.
/// @param samples  that a cell takes, at most
Batches BatchesOfRows(std::size_t rows, std::size_t cells, double samples, double from, double to)
{
  const double atOnce = std::max(SamplesAtOnce / std::max(samples, 1.0), 1.0);
  Batches batches;
  batches.count = rows * cells;
  batches.whole = atOnce >= static_cast<double>(cells) ? cells : 1;
  batches.most = static_cast<std::size_t>(std::min(atOnce, static_cast<double>(batches.count)));
  batches.first = std::max<std::size_t>(1, rows / 8) * cells;
  batches.from = from;
  batches.to = to;
  return batches;
}

/// A part of such a batch that is a rectangle.
struct Patch
{
  int column, row;
  std::size_t columns, rows;
};

/// Calls launch(patch) for the rectangles that cells [begin, begin + size) of rows of `cells` consist of.
template <class Launch>
void InPatches(std::size_t begin, std::size_t size, std::size_t cells, const Launch& launch)
{
  for (const std::size_t end = begin + size; begin < end;)
  {
    const std::size_t column = begin % cells;
    const bool whole = column == 0 && end - begin >= cells;
    const std::size_t columns = whole ? cells : std::min(cells - column, end - begin);
    const std::size_t rows = whole ? (end - begin) / cells : 1;
    launch(Patch{ static_cast<int>(column), static_cast<int>(begin / cells), columns, rows });
    begin += columns * rows;
  }
}
}

MediumRayCaster::MediumRayCaster(Device& device, const Medium& medium, const SolvedLight& light,
  const Illumination& illumination, const ViewSettings& asked, const Field& ior)
  : TheDevice(device)
  , TheGrid(medium.grid)
  , MomentDegree(ShownDegree(light, asked))
  , LampsShine(Shine(this->ShowsMoments() ? light.lampsApart : illumination.lights))
  , AskedForShadowRays(asked.shadowRays)
  , Settings(this->Needed(asked))
{
  Check(medium);
  Check(illumination);
  Check(asked);
  const ViewSettings& settings = this->Settings;
  Check(light, medium.grid, settings);
  CheckViewedIndex(ior, medium.grid);

  const std::vector<Light>& lamps = this->ShowsMoments() ? light.lampsApart : illumination.lights;
  const std::vector<SmallLight> lights =
    settings.shadowRays ? SmallLights(lamps, medium.grid, settings.rectangleSamples) : std::vector<SmallLight>();
  this->LightCount = static_cast<int>(lights.size());
  this->Phase = ViewedPhaseOf(medium.phase);
  this->TakeMoments(light);
  this->FindTraits(medium, light, ior);
  this->PrepareAureole(medium, light);
  this->Upload(medium, light, ior);
  this->Reserve();
  this->Lights = Buffer<SmallLight>(device, lights, "the lights");
  this->PrepareBackground(illumination);
  if (this->Bends)
  {
    this->PrepareBending();
  }
  this->Doubts = DoubtsAbout(settings, light, this->Bends ? ior : Field{}, this->Index, medium.grid);
  if (settings.tableFace >= 0)
  {
    this->PrepareTable(light, ior);
  }
  this->PrepareGround(light);
  this->PrepareSurface(medium, light);
  this->SayWhatIsLeftOut();
}

void MediumRayCaster::TakeMoments(const SolvedLight& light)
{
  if (!this->ShowsMoments())
  {
    return;
  }
  const std::size_t voxels = this->TheGrid.VoxelCount();
  this->MomentChannels = light.scatteredMoments.components / ((this->MomentDegree + 1) * (this->MomentDegree + 1));
  this->StraightOnChannels = light.straightOn.components;
  this->Moments = Buffer<float>(this->TheDevice, light.scatteredMoments.values,
    voxels * light.scatteredMoments.components, "the moments of scattered light");
  this->StraightOn = Buffer<float>(
    this->TheDevice, light.straightOn.values, voxels * light.straightOn.components, "what is scattered straight on");
}

/// Of the voxels in which least goes straight on: those that matter have as much.
void MediumRayCaster::PrepareAureole(const Medium& medium, const SolvedLight& light)
{
  if (!this->ShowsMoments() || this->LightCount == 0 || medium.phase.Varies())
  {
    return;
  }
  this->AureoleChannels = this->Phase.channels;
  std::vector<float> tables;
  for (int c = 0; c < this->AureoleChannels; ++c)
  {
    double least = 1.0;
    for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
    {
      least = medium.sigma_s.At(i, c) > 0.0f ? std::min<double>(least, light.straightOn.At(i, c)) : least;
    }
    const std::vector<float> table = AureoleTable(medium.phase.OfChannel(c), least, this->MomentDegree);
    tables.insert(tables.end(), table.begin(), table.end());
  }
  this->AureoleTables = Buffer<float>(this->TheDevice, tables, "light scattered forwards");
}

/// What of the scene varies, has colour or depends on the camera.
void MediumRayCaster::FindTraits(const Medium& medium, const SolvedLight& light, const Field& ior)
{
  const ViewSettings& settings = this->Settings;
  this->Index = IndexRangeOf(ior, medium.grid);
  this->Traits = TraitsOf(medium);
  const MediumTraits& traits = this->Traits;
  this->Bends = !settings.leaveOut || this->Index.Varies();
  const bool anisotropic = this->Phase.formula != ViewedPhase::Even;
  this->KnowsFlow =
    anisotropic && light.meanDirection.values && light.fluence.values && !settings.shadowRays && !this->ShowsMoments();
  this->Coloured = !settings.leaveOut || !traits.greyExtinction || this->StraightOnChannels == 3;
  // Beside directions of the light it does not pay to have sources by one channel.
  this->Grey = !this->Coloured && traits.grey && !this->KnowsFlow && this->LightCount == 0 && !this->ShowsMoments() &&
    light.fluence.components == 1 && light.fluenceDirect.components == 1 && (!traits.emits || traits.emission.IsGrey());
  this->SourcesDependOnCamera = (this->LightCount > 0 && anisotropic) || this->ShowsMoments();
  this->LargestSigmaT = ExtinctionBound(medium);
}

void MediumRayCaster::PrepareBackground(const Illumination& illumination)
{
  const Environment& environment = illumination.environment;
  this->UnderSky = !environment.Empty() || !IsBlack(illumination.sky);
  this->Background = this->UnderSky ? illumination.sky : this->Settings.backgroundColor;
  if (!environment.Empty() && this->Settings.showBackground)
  {
    this->EnvironmentSize = { environment.width, environment.height };
  }
  std::vector<cl_float4> pixels =
    this->EnvironmentSize[0] > 0 ? ClosedEnvironment(environment) : std::vector<cl_float4>();
  if (this->ShowsMoments() && !pixels.empty())
  {
    // What is small and bright is one of the lamps: what of it comes straight on without being scattered is seen apart.
    std::vector<cl_float4> sharp = pixels;
    pixels = ClosedEnvironment(Split(environment, EquiangularDirections(DirectionsOfPeaks)).smooth);
    for (std::size_t i = 0; i < sharp.size(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        sharp[i].s[c] -= pixels[i].s[c];
      }
    }
    this->SharpEnvironment = Buffer<cl_float4>(this->TheDevice, sharp, "the environment");
  }
  this->EnvironmentPixels = Buffer<cl_float4>(this->TheDevice, pixels, "the environment");
}

void MediumRayCaster::PrepareTable(const SolvedLight& light, const Field& ior)
{
  const bool single = this->Settings.singleScatteringOnly && light.fluenceDirect.values;
  this->Table = Buffer<cl_float4>(this->TheDevice,
    TableLight(this->TheGrid, single ? light.fluenceDirect : light.fluence, light.meanDirection,
      this->Bends ? ior : Field{}, this->Settings.tableFace, this->UnderSky),
    "light on the table");
}

void MediumRayCaster::PrepareGround(const SolvedLight& light)
{
  this->FacesOfGround = this->Settings.showBackground ? GroundFaces(light) : 0;
  this->Ground = Buffer<cl_float4>(this->TheDevice,
    this->FacesOfGround != 0 ? GroundLight(this->TheGrid, light) : std::vector<cl_float4>(), "light on the ground");
}

void MediumRayCaster::PrepareSurface(const Medium& medium, const SolvedLight& light)
{
  const bool plain = !this->Settings.singleScatteringOnly && this->LightCount == 0 && !this->KnowsFlow &&
    !this->ShowsMoments() && !this->Bends && this->Settings.tableFace < 0;
  this->Surface = Buffer<cl_float4>(this->TheDevice,
    plain && light.surface.values && light.fluence.values ? SurfaceLight(medium, light, this->Settings.stepSize)
                                                          : std::vector<cl_float4>(),
    "light at the surface");
}

/// What rays meet, a border of one voxel around.
void MediumRayCaster::Reserve()
{
  Device& device = this->TheDevice;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->BrickCount[axis] = PartsOf<int>(this->TheGrid.size[axis], BrickEdge);
  }
  const std::size_t count = PaddedCount(this->TheGrid);
  this->Samples = Buffer<cl_float4>(device, count, "the ray caster's samples");
  this->Extinctions = Buffer<cl_float4>(device, this->Coloured ? count : 0, "the ray caster's coloured extinction");
  this->Flow = Buffer<cl_float4>(
    device, this->KnowsFlow || this->ShowsBeams() ? count : 0, "the ray caster's directions of light");
  const bool cosines = this->KnowsFlow && this->Phase.varies && !this->FlowHasG();
  this->Cosines = Buffer<cl_float4>(device, cosines ? count : 0, "the ray caster's mean cosines");
  this->Glow = Buffer<cl_float4>(device, this->GlowsApart() ? count : 0, "the ray caster's emission");
  this->Bending = Buffer<cl_float4>(device, this->Bends ? count : 0, "the ray caster's refraction");
  this->Bricks =
    Buffer<cl_char>(device, static_cast<std::size_t>(this->BrickCount[0]) * this->BrickCount[1] * this->BrickCount[2],
      "the ray caster's bricks");
  this->Direct =
    Buffer<float>(device, this->LightCount > 0 ? 6 * this->TheGrid.VoxelCount() : 0, "light found by shadow rays");
  this->Diffuse =
    Buffer<float>(device, this->ShowsMoments() ? 3 * this->TheGrid.VoxelCount() : 0, "light scattered towards the eye");
}

void MediumRayCaster::PrepareBending()
{
  struct
  {
    cl_int size[3];
  } const grid = { { this->TheGrid.size[0], this->TheGrid.size[1], this->TheGrid.size[2] } };
  const std::size_t x = grid.size[0], y = grid.size[1], z = grid.size[2];
  const Buffer<float> coefficients = SquaredIndexCoefficients(this->TheDevice, this->TheGrid, this->Ior);
  cl::Kernel pack = this->TheDevice.Kernel("pack_bending", kernel_source::BendingField);
  With(pack, grid, Float4(1.0 / Vector(this->TheGrid.spacing), 0.0), coefficients, this->Bending);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    pack, cl::NullRange, cl::NDRange(RoundUp<std::size_t>(x + 2, 64), y + 2, z + 2), cl::NDRange(64, 1, 1));
  this->TheDevice.Finish();
}

void MediumRayCaster::SayWhatIsLeftOut()
{
  this->Omitted.clear();
  const auto omit = [this](bool needed, const char* what) {
    if (!needed)
    {
      this->Omitted.push_back(what);
    }
  };
  omit(this->Coloured || this->Grey, left_out::GreyExtinction);
  omit(!this->Grey, left_out::Grey);
  omit(this->Components[2] > 0, left_out::NoEmission);
  omit(this->LightCount > 0,
    this->AskedForShadowRays ? "shadow rays: no lamp and no sun shines" : "shadow rays: not asked for");
  omit(this->EnvironmentSize[0] > 0, "environment: none, or not shown");
  omit(this->KnowsFlow || this->LightCount > 0 || this->ShowsMoments(),
    "phase function: the medium scatters evenly, or the direction of the light is not known");
  omit(this->Bends, left_out::ConstantIndex);
  omit(!this->SkipsBricks() || !this->HasEmptyBricks, left_out::EmptyBricks);
  omit(this->Reflects(),
    !this->Index.Varies() ? "surface reflection: the refractive index is constant"
      : this->Settings.surfaceReflection == SurfaceReflection::None
      ? "surface reflection: not asked for"
      : "surface reflection: no refractive index is as large "
        "as the surface's, or none is smaller");
  omit(this->Settings.tableFace >= 0, "table: none");
  omit(this->FacesOfGround != 0, "ground: no face of the box gives back light, or it is not shown");
  omit(this->Surface.Size() > 0,
    "light at the surface: no thick voxels at the faces of the box, or it is not known there");
}

/// Without a lamp there is nothing that shadow rays could find; moments lack what they find.
ViewSettings MediumRayCaster::Needed(ViewSettings asked) const
{
  asked.shadowRays = (asked.shadowRays || this->ShowsMoments()) && this->LampsShine;
  return asked;
}

bool MediumRayCaster::Adopt(const ViewSettings& asked)
{
  Check(asked);
  const ViewSettings settings = this->Needed(asked);
  const ViewSettings& now = this->Settings;
  if (settings.singleScatteringOnly != now.singleScatteringOnly || settings.shadowRays != now.shadowRays ||
    settings.rectangleSamples != now.rectangleSamples || settings.showBackground != now.showBackground ||
    settings.packetWidth != now.packetWidth || settings.tableFace != now.tableFace ||
    settings.leaveOut != now.leaveOut || (this->Surface.Size() > 0 && settings.stepSize != now.stepSize))
  {
    return false;
  }
  this->SourcesReady &= this->LightCount == 0 || settings.stepSize == now.stepSize; // shadow rays step as well
  this->Background = this->UnderSky ? this->Background : settings.backgroundColor;
  this->Settings = settings;
  this->AskedForShadowRays = asked.shadowRays;
  this->SayWhatIsLeftOut();
  return true;
}

int MediumRayCaster::PacketWidth() const
{
  return this->Settings.packetWidth > 0 ? this->Settings.packetWidth : this->TheDevice.KernelWidth();
}

void MediumRayCaster::Upload(const Medium& medium, const SolvedLight& light, const Field& ior)
{
  const std::array<Field, 5> fields = { medium.sigma_a, medium.sigma_s, medium.emission, light.fluence,
    light.fluenceDirect };
  // What the mode does not look at stays away.
  const bool shadows = this->Settings.shadowRays;
  const bool single = this->Settings.singleScatteringOnly;
  const bool all = !this->Settings.leaveOut;
  const std::array<bool, 5> used = { all || this->Traits.absorbs, all || this->Traits.scatters,
    all || this->Traits.emits, !single && !this->ShowsMoments(), shadows != single && !this->ShowsMoments() };
  const std::array<const char*, 5> names = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct" };
  const std::size_t voxels = medium.grid.VoxelCount();
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    this->Components[i] = used[i] && fields[i].values ? fields[i].components : 0;
    this->Arrays[i] = Buffer<float>(this->TheDevice, fields[i].values, voxels * this->Components[i], names[i]);
  }
  this->MeanDirection =
    Buffer<float>(this->TheDevice, light.meanDirection.values, this->KnowsFlow ? 3 * voxels : 0, "mean_direction");
  this->PreparePhase(medium.phase);
  const std::vector<float> even(this->Bends && !ior.values ? voxels : 0, 1.0f);
  this->Ior = Buffer<float>(this->TheDevice, ior.values ? ior.values : even.data(), this->Bends ? voxels : 0, "ior");
}

/// What tells how the medium scatters, as far as any light has a direction.
void MediumRayCaster::PreparePhase(const PhaseOfMedium& phase)
{
  const bool needed = this->KnowsFlow || this->LightCount > 0;
  this->PhaseRows =
    Buffer<float>(this->TheDevice, needed ? this->Phase.rows : std::vector<float>(), "the rows of the phase function");
  this->Phase.rows.clear();
  std::vector<float> g; // as all channels are seen
  const std::size_t count = needed && this->Phase.varies ? this->TheGrid.VoxelCount() * this->Phase.channels : 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    g.push_back(phase.G().At(i / this->Phase.channels, static_cast<int>(i % this->Phase.channels)));
  }
  this->MeanCosines = Buffer<float>(this->TheDevice, g, "g");
}

/// @param needed  whether light has a direction where this is asked
std::string MediumRayCaster::PhaseOptions(bool needed) const
{
  const ViewedPhase& phase = this->Phase;
  return Define("PHASE", needed ? static_cast<int>(phase.formula) : 0) + Define("PHASE_CHANNELS", phase.channels) +
    Define("FLOW_WITH_G", this->FlowHasG()) + Define("VARIED_G", this->Cosines.Size() > 0);
}

std::string MediumRayCaster::PackingOptions() const
{
  const std::array<const char*, 5> names = { "ABSORPTION", "SCATTERING", "EMISSION", "FLUENCE", "UNSCATTERED" };
  std::string options =
    Define("REAL_WIDTH", this->PacketWidth()) + Define("COLOURED", this->Coloured) + Define("GREY", this->Grey);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    options += Define(names[i], this->Components[i]);
  }
  const bool varies = this->MeanCosines.Size() > 0;
  return options + Define("FLOW", this->KnowsFlow) + Define("GLOW", this->GlowsApart()) +
    Define("MEAN_COSINE", varies ? this->Phase.channels : 0);
}

void MediumRayCaster::Pack(Packing what)
{
  if (this->ShowsMoments())
  {
    this->PackShown(what);
    return;
  }
  const bool forShadowRays = what == Packing::ForShadowRays;
  const bool bends = this->Bends && !forShadowRays; // shadow rays go straight on
  const std::string options = this->PackingOptions() + this->PhaseOptions(this->KnowsFlow) +
    Define("SHADOW_RAYS", this->LightCount > 0 && !forShadowRays) + Define("BENDS", bends) + Define("SHOWN", 0);
  const cl_int4 size = Int4(this->TheGrid.size);
  const cl_int single = this->Settings.singleScatteringOnly ? 1 : 0;

  cl::Kernel pack = this->TheDevice.Kernel("pack_samples", kernel_source::ScatteredLight, options);
  With(pack, size, single, this->Phase.parameters.first.s[0], this->Arrays[0], this->Arrays[1], this->Arrays[2],
    this->Arrays[3], this->Arrays[4], this->Direct, this->MeanDirection, this->Ior, this->MeanCosines, this->Samples,
    this->Extinctions, this->Flow, this->Glow, this->Cosines);
  this->TheDevice.Queue().enqueueNDRangeKernel(pack, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(size.s[0] + 2, 64), size.s[1] + 2, size.s[2] + 2), cl::NDRange(64, 1, 1));
  this->FindBricks(options);
}

/// SHOWN and BEAMS of the kernels.
std::string MediumRayCaster::ShownOptions(Packing what) const
{
  const int shown = !this->ShowsMoments() || what == Packing::ForShadowRays ? 0 : what == Packing::Scattered ? 1 : 2;
  return Define("SHOWN", shown) + Define("BEAMS", shown > 0 && this->ShowsBeams());
}

void MediumRayCaster::PackShown(Packing what)
{
  const std::string options = this->PackingOptions() + this->PhaseOptions(false) + Define("SHADOW_RAYS", 0) +
    Define("BENDS", this->Bends && what != Packing::ForShadowRays) +
    Define("STRAIGHT_ON", what == Packing::Unscattered ? 0 : this->StraightOnChannels) +
    Define("AUREOLE", this->AureoleChannels);
  const cl_int4 size = Int4(this->TheGrid.size);
  cl::Kernel pack =
    this->TheDevice.Kernel("pack_shown", kernel_source::ShownSamples, options + this->ShownOptions(what));
  With(pack, size, this->Arrays[0], this->Arrays[1], this->Arrays[2], this->StraightOn, this->Diffuse, this->Direct,
    this->Ior, this->Samples, this->Extinctions, this->Flow, this->Glow);
  this->TheDevice.Queue().enqueueNDRangeKernel(pack, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(size.s[0] + 2, 64), size.s[1] + 2, size.s[2] + 2), cl::NDRange(64, 1, 1));
  this->FindBricks(options + Define("SHOWN", 1));
}

void MediumRayCaster::FindBricks(const std::string& options)
{
  const cl_int4 size = Int4(this->TheGrid.size), bricks = Int4(this->BrickCount);
  cl::Kernel find = this->TheDevice.Kernel("find_empty_bricks", kernel_source::ScatteredLight, options);
  With(find, size, bricks, this->Samples, this->Extinctions, this->Glow, this->Bending, this->Bricks);
  this->TheDevice.Queue().enqueueNDRangeKernel(find, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(bricks.s[0], 4), bricks.s[1], bricks.s[2]), cl::NDRange(4, 1, 1));
  std::vector<cl_char> distances = this->Bricks.Read();
  this->HasEmptyBricks = std::find(distances.begin(), distances.end(), 1) != distances.end();
  FindDistances(distances, this->BrickCount);
  this->Bricks.Write(distances.data());
}

ShadowInfo MediumRayCaster::MakeShadowInfo(const Camera& camera) const
{
  const double radius = std::cbrt(3.0 * this->TheGrid.VoxelVolume() / (4.0 * Pi));
  ShadowInfo info = {};
  info.spacing = Float4(Vector(this->TheGrid.spacing));
  info.eye = Float4(Vector(camera.position) - Vector(this->TheGrid.origin), camera.parallelProjection ? 1.0 : 0.0);
  info.forward = Float4(Vector(Axes(camera)[2]));
  info.size = Int4(this->TheGrid.size);
  info.bricks = Int4(this->BrickCount);
  info.phase = this->Phase.parameters;
  info.step = static_cast<float>(this->Settings.stepSize);
  info.nearestSquare = static_cast<float>(radius * radius / 3.0);
  info.lights = this->LightCount;
  return info;
}

void MediumRayCaster::SeeLights(const Camera& camera, const Monitor& monitor)
{
  ShadowInfo info = this->MakeShadowInfo(camera);
  cl::Kernel see = this->TheDevice.Kernel("see_lights", kernel_source::ShadowRays,
    this->PackingOptions() + this->PhaseOptions(true) + this->StepOption() + Define("AUREOLE", this->AureoleChannels) +
      Define("STRAIGHT_ON", this->StraightOnChannels) + Define("BESIDE", this->ShowsMoments()));
  const std::size_t across = RoundUp<std::size_t>(this->TheGrid.size[0], 4 * this->PacketWidth()) / this->PacketWidth();
  const std::size_t rows = this->TheGrid.size[1];
  const double samplesOfRow = this->LongestSteps() * this->LightCount * this->TheGrid.size[0];
  const auto launch = [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    With(see, info, this->Lights, this->Arrays[1], this->MeanCosines, this->PhaseRows, this->Samples, this->Extinctions,
      this->Bricks, this->Arrays[0], this->StraightOn, this->AureoleTables, this->Direct);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      see, cl::NullRange, cl::NDRange(across, part.columns, part.rows), cl::NDRange(4, 1, 1));
  };
  InBatches(this->TheDevice, BatchesOfRows(this->TheGrid.size[2], rows, samplesOfRow, 0.0, 0.5), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, rows, launch); });
}

void MediumRayCaster::SeeMoments(const Camera& camera)
{
  const ShadowInfo info = this->MakeShadowInfo(camera);
  cl::Kernel see = this->TheDevice.Kernel("see_moments", kernel_source::SeenMoments,
    Define("DEGREE", this->MomentDegree) + Define("MOMENT_CHANNELS", this->MomentChannels));
  With(see, info, this->Moments, this->Diffuse);
  this->TheDevice.Queue().enqueueNDRangeKernel(see, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(info.size.s[0], 8), info.size.s[1], info.size.s[2]), cl::NDRange(8, 1, 1));
}

ViewInfo MediumRayCaster::MakeView(const Camera& camera) const
{
  const auto axes = Axes(camera);
  CheckDistance(camera, this->TheGrid);
  const Grid& grid = this->TheGrid;
  const glm::dvec3 inverseSpacing = 1.0 / Vector(grid.spacing);
  const glm::dvec3 eye = Vector(camera.position) - Vector(grid.origin);
  const glm::dvec3 forward = Vector(axes[2]);
  const double halfHeight = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double halfWidth = halfHeight * this->Settings.imageSize[0] / this->Settings.imageSize[1];
  double farDepth = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(
      corner & 1 ? grid.Length(0) : 0.0, corner & 2 ? grid.Length(1) : 0.0, corner & 4 ? grid.Length(2) : 0.0);
    farDepth = std::max(farDepth, glm::dot(at - eye, forward));
  }
  ViewInfo view;
  view.eye = Float4(eye * inverseSpacing, camera.parallelProjection ? 1.0 : 0.0);
  view.forward = Float4(forward, 0.0);
  view.right = Float4(halfWidth * Vector(axes[0]), 0.0);
  view.up = Float4(halfHeight * Vector(axes[1]), 0.0);
  view.inverseSpacing = Float4(inverseSpacing, 0.0);
  view.background = Float4(Vector(this->Background), this->Settings.showBackground ? 1.0 : 0.0);
  view.marching = Float4({ this->Settings.stepSize, this->Settings.minimumTransmittance, farDepth }, 0.0);
  view.picture = Int4({ this->Settings.imageSize[0], this->Settings.imageSize[1], 0 });
  view.size = Int4(grid.size);
  view.bricks = Int4(this->BrickCount);
  view.environment = Int4({ this->EnvironmentSize[0], this->EnvironmentSize[1], 0 });
  view.phase = this->Phase.parameters;
  return view;
}

void MediumRayCaster::PrepareSources(const Camera& camera, const Monitor& monitor)
{
  if (this->LightCount > 0)
  {
    this->Pack(Packing::ForShadowRays);
    this->SeeLights(camera, monitor);
  }
  if (this->ShowsMoments())
  {
    this->SeeMoments(camera);
  }
  this->Pack(Packing::Scattered);
  this->SayWhatIsLeftOut(); // now empty bricks are known
  this->SourcesReady = true;
  if (!this->SourcesDependOnCamera && this->LightCount == 0)
  {
    this->Arrays = {};
    this->MeanDirection = {};
    this->MeanCosines = {};
    this->Ior = {};
  }
}

OpticsInfo MediumRayCaster::MakeOptics() const
{
  const ViewSettings& settings = this->Settings;
  const Grid& grid = this->TheGrid;
  const double index = this->SurfaceIndex();
  const int face = std::max(settings.tableFace, 0);
  const double edges = 1.0 * grid.size[0] + grid.size[1] + grid.size[2];
  const double halvings = std::log2(settings.stepSize / SurfacePrecision);
  OpticsInfo optics;
  optics.spacing = Float4(Vector(grid.spacing), 0.0);
  optics.surface = Float4({ index * index, settings.surfaceReflectance, BesideSurface }, 0.0);
  optics.table = Float4(Vector(settings.tableColor), settings.tableReflectance);
  optics.face = Int4({ face / 2, face % 2, FaceSize(grid, face)[0] });
  optics.flip = { { face / 2 == 0 ? -1.0f : 1.0f, face / 2 == 1 ? -1.0f : 1.0f, face / 2 == 2 ? -1.0f : 1.0f, 0.0f } };
  optics.limits = Int4({ static_cast<int>(std::min(1e9, std::ceil(RoundsAtMost * edges / settings.stepSize))),
    static_cast<int>(std::clamp(BentStretch / settings.stepSize, 1.0, 1e3)),
    static_cast<int>(std::ceil(std::max(halvings, 1.0))) });
  return optics;
}

/// Of the longest straight ray.
double MediumRayCaster::LongestSteps() const
{
  const std::array<int, 3>& size = this->TheGrid.size;
  return std::hypot(size[0], size[1], size[2]) / this->Settings.stepSize + 1.0;
}

std::string MediumRayCaster::StepOption() const
{
  return Define("MANY_STEPS", this->LongestSteps() > ManySteps);
}

std::string MediumRayCaster::CastingOptions(Packing what) const
{
  // Longest optical length of a step; the kernel has a shorter way to cross it up to 2. Bent steps can be a little
  // longer.
  const double longest = this->LargestSigmaT * this->Settings.stepSize *
    *std::max_element(this->TheGrid.spacing.begin(), this->TheGrid.spacing.end());
  return Define("REAL_WIDTH", this->PacketWidth()) + Define("COLOURED", this->Coloured) + Define("GREY", this->Grey) +
    Define("SKIP_BRICKS", this->SkipsBricks()) + Define("ENVIRONMENT", this->EnvironmentSize[0] > 0) +
    Define("GROUND", this->FacesOfGround) + Define("THIN_STEPS", longest <= (this->Bends ? 1.5 : 2.0)) +
    Define("GLOW", this->GlowsApart()) + this->PhaseOptions(this->KnowsFlow) + this->StepOption() +
    this->ShownOptions(what);
}

/// Rays that cannot but go straight on have a kernel of their own.
cl::Kernel MediumRayCaster::CastingKernel(Packing what)
{
  if (!this->Bends && this->Settings.tableFace < 0)
  {
    return this->TheDevice.Kernel("cast_rays", kernel_source::StraightView,
      this->CastingOptions(what) + Define("SURFACE_LIGHT", this->Surface.Size() > 0));
  }
  const int surface = this->Reflects() ? static_cast<int>(this->Settings.surfaceReflection) : 0;
  return this->TheDevice.Kernel("cast_bent_rays", kernel_source::BentView,
    this->CastingOptions(what) + Define("BENDS", this->Bends) + Define("SURFACE", surface) +
      Define("TABLE", this->Settings.tableFace >= 0));
}

void MediumRayCaster::CastRays(
  ViewInfo& view, const OpticsInfo& optics, Packing what, double from, double to, const Monitor& monitor)
{
  const Buffer<cl_float4>& environment =
    what == Packing::Unscattered ? this->SharpEnvironment : this->EnvironmentPixels;
  const std::array<int, 2> packet = PacketPixels(this->PacketWidth());
  const bool straight = !this->Bends && this->Settings.tableFace < 0;
  cl::Kernel cast = this->CastingKernel(what);
  // Batches of whole work-groups: else the last rows of one would be cast again by the next.
  const int group = 4;
  const std::size_t across = RoundUp<std::size_t>(view.picture.s[0], group * packet[0]) / (group * packet[0]);
  const std::size_t rows = RoundUp<std::size_t>(view.picture.s[1], group * packet[1]) / (group * packet[1]);
  const double samples = this->LongestSteps() * group * group * packet[0] * packet[1];
  const auto launch = [&](const Patch& part) {
    view.picture.s[2] = part.row * group;
    view.picture.s[3] = part.column * group;
    if (straight)
    {
      With(cast, view, this->Samples, this->Extinctions, this->Flow, this->Glow, this->Cosines, this->PhaseRows,
        this->Bricks, environment, this->Ground, this->Surface, this->Radiance, this->Alpha, this->Depth);
    }
    else
    {
      With(cast, view, optics, this->Samples, this->Extinctions, this->Flow, this->Glow, this->Cosines, this->PhaseRows,
        this->Bending, this->Table, this->Bricks, environment, this->Ground, this->Radiance, this->Alpha, this->Depth);
    }
    this->TheDevice.Queue().enqueueNDRangeKernel(
      cast, cl::NullRange, cl::NDRange(part.columns * group, part.rows * group), cl::NDRange(group, group));
  };
  InBatches(this->TheDevice, BatchesOfRows(rows, across, samples, from, to), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, across, launch); });
}

/// What comes from behind without being scattered, which alone is sharp, and how much that is: the picture's alpha and
/// depth (numerics.md, section 14.7).
void MediumRayCaster::AddUnscattered(ViewInfo& view, const Monitor& monitor, std::vector<float>& radiance)
{
  this->Pack(Packing::Unscattered);
  view.background = Float4(this->UnderSky ? glm::dvec3(0.0) : Vector(this->Background), view.background.s[3]);
  OpticsInfo optics = this->MakeOptics();
  optics.table.s[0] = optics.table.s[1] = optics.table.s[2] = 0.0f; // it is in the picture already
  this->CastRays(view, optics, Packing::Unscattered, 0.8, 1.0, monitor);
  const std::vector<float> sharp = this->Radiance.Read();
  std::transform(radiance.begin(), radiance.end(), sharp.begin(), radiance.begin(), std::plus<float>());
}

Picture MediumRayCaster::Render(const Camera& camera, const Monitor& monitor)
{
  ViewInfo view = this->MakeView(camera);
  Report(monitor, 0.0);
  const bool prepares = !this->SourcesReady || this->SourcesDependOnCamera;
  if (prepares)
  {
    this->PrepareSources(camera, monitor);
  }

  Picture picture;
  picture.width = this->Settings.imageSize[0];
  picture.height = this->Settings.imageSize[1];
  picture.farDepth = view.marching.s[2];
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * picture.height;
  if (this->Alpha.Size() != pixels)
  {
    Buffer<float> radiance(this->TheDevice, 3 * pixels, "the picture");
    Buffer<float> alpha(this->TheDevice, pixels, "the picture's alpha");
    Buffer<float> depth(this->TheDevice, pixels, "the picture's depth");
    this->Radiance.Swap(radiance); // all or none, where one does not fit
    this->Alpha.Swap(alpha);
    this->Depth.Swap(depth);
  }
  if (this->ShowsMoments() && !this->UnderSky)
  {
    view.background = Float4(glm::dvec3(0.0), view.background.s[3]); // does not shine on the medium: see AddUnscattered
  }
  this->CastRays(view, this->MakeOptics(), Packing::Scattered, prepares && this->LightCount > 0 ? 0.5 : 0.0,
    this->ShowsMoments() ? 0.8 : 1.0, monitor);
  picture.radiance = this->Radiance.Read();
  if (this->ShowsMoments())
  {
    this->AddUnscattered(view, monitor, picture.radiance);
  }
  picture.alpha = this->Alpha.Read();
  picture.depth = this->Depth.Read();
  return picture;
}
}
