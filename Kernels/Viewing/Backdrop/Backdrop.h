#pragma once

#include "Device/Buffer.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>

namespace tyndall
{
/// Voxels per row and number of rows of a face: along y and z, x and z, or x and y.
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// What rays see when they leave or enter the medium: environment and sky, ground, table, and surface light of
/// optically thick voxels.
class Backdrop
{
public:
  /// @throws DeviceError if it does not fit
  Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block = nullptr);

  /// Whether the background is the illumination's sky and not the settings' background colour.
  bool IsSky() const { return this->UnderSky; }
  bool HasEnvironment() const { return this->Size[0] > 0; }
  bool HasGround() const { return this->GroundBits != 0; }
  bool HasSurfaceLight() const { return this->HasSurface; }

  /// All tables one after the other; empty if there is none.
  const Buffer<cl_float4>& Tables() const { return this->Cells; }
  /// Sets what the kernels need to know of the background and the tables.
  /// @param sharp  only what unscattered light shows of the environment, if moments are shown
  void Describe(const ViewSettings& settings, bool sharp, ViewInfo& view) const;

private:
  bool UnderSky = false, HasSurface = false;
  Rgb Sky = {};
  std::array<int, 2> Size = {}; ///< pixels of the environment
  Rotation Turn = {};           ///< from world axes to the environment's axes
  int GroundBits = 0;           ///< bit mask of the reflecting faces
  cl_int4 First = {};           ///< ViewInfo::backdrop
  int FirstSharp = 0;           ///< index of the environment's peaks
  Buffer<cl_float4> Cells;
};
}
