#include "Viewing/Backdrop/Backdrop.h"

#include "Viewing/Backdrop/BackdropTables.h"

#include <vector>

namespace tyndall
{
namespace
{
std::vector<cl_float4> LightOnTable(
  const SolvedLight& light, const Field& ior, const ViewSettings& settings, const ViewTraits& traits, bool fromBelow)
{
  const bool single = settings.singleScatteringOnly && light.fluenceDirect.values;
  return TableLight(traits.grid, single ? light.fluenceDirect : light.fluence, light.meanDirection,
    traits.bends ? ior : Field{}, settings.tableFace, fromBelow);
}

/// Whether the surface light is known and applicable: all light is shown, without shadow rays, mean directions or a
/// table.
bool ShowsSurface(const SolvedLight& light, const ViewTraits& traits)
{
  const bool plain = !traits.singleScatteringOnly && !traits.shadowRays && !traits.knowsFlow &&
    !traits.ShowsMoments() && traits.OnlyStraight();
  return plain && light.surface.values && light.fluence.values;
}
}

Backdrop::Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
  const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block)
{
  const tyndall::Environment& environment = illumination.environment;
  this->UnderSky = !environment.Empty() || !IsBlack(illumination.sky);
  this->Sky = illumination.sky;
  EnvironmentPixels pixels;
  if (!environment.Empty() && settings.showBackground)
  {
    this->Width = environment.width;
    this->Height = environment.height;
    this->Turn = environment.toPicture;
    pixels = PixelsOf(environment, traits.ShowsMoments());
  }
  if (!pixels.sharp.empty())
  {
    this->SharpPixels = Buffer<cl_float4>(device, pixels.sharp, "the environment");
  }
  this->Pixels = Buffer<cl_float4>(device, pixels.shown, "the environment");
  if (traits.hasTable)
  {
    const std::vector<float> held = block ? HeldIndex(ior, *block, medium.grid.size) : std::vector<float>();
    const Field index = block ? Field{ held.empty() ? nullptr : held.data(), 1 } : ior;
    this->TableCells =
      Buffer<cl_float4>(device, LightOnTable(light, index, settings, traits, this->UnderSky), "light on the table");
  }
  this->GroundBits = settings.showBackground ? GroundFaces(light) : 0;
  this->GroundCells = Buffer<cl_float4>(
    device, this->GroundBits != 0 ? GroundLight(traits.grid, light) : std::vector<cl_float4>(), "light on the ground");
  this->SurfaceCells = Buffer<cl_float4>(device,
    ShowsSurface(light, traits)
      ? tyndall::SurfaceLight(medium, light, settings.stepSize, block ? &block->block : nullptr)
      : std::vector<cl_float4>(),
    "light at the surface");
}
}
