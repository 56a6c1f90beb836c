#pragma once

#include "Device/Buffer.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>

namespace tyndall
{
/// What rays see when they leave or enter the medium: environment and sky, ground, table, and surface light of
/// optically thick voxels. Arrays that the scene does not need are empty.
class Backdrop
{
public:
  /// @throws DeviceError if it does not fit
  Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block = nullptr);

  /// Whether the background is the illumination's sky and not the settings' background colour.
  bool IsSky() const { return this->UnderSky; }
  Rgb Colour(const ViewSettings& settings) const { return this->UnderSky ? this->Sky : settings.backgroundColor; }

  bool HasEnvironment() const { return this->Width > 0; }
  std::array<int, 2> EnvironmentSize() const { return { this->Width, this->Height }; } ///< pixels
  const Rotation& ToPicture() const { return this->Turn; } ///< from world axes to the environment's axes
  const Buffer<cl_float4>& Environment() const { return this->Pixels; }
  /// If moments are shown: the part of the environment that is seen only by unscattered light.
  const Buffer<cl_float4>& SharpEnvironment() const { return this->SharpPixels; }

  int FacesOfGround() const { return this->GroundBits; }                ///< bit mask of the reflecting faces
  const Buffer<cl_float4>& Ground() const { return this->GroundCells; } ///< see BackdropTables.h
  const Buffer<cl_float4>& Table() const { return this->TableCells; }   ///< see BackdropTables.h
  bool HasSurfaceLight() const { return this->SurfaceCells.Size() > 0; }
  const Buffer<cl_float4>& SurfaceLight() const { return this->SurfaceCells; } ///< see BackdropTables.h

private:
  bool UnderSky = false;
  Rgb Sky = {};
  int Width = 0, Height = 0;
  Rotation Turn = {};
  Buffer<cl_float4> Pixels, SharpPixels, TableCells, GroundCells, SurfaceCells;
  int GroundBits = 0;
};
}
