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
/// Number of voxels per row, and number of rows, on a face of the box; the axes along a row and across the rows are y
/// and z, x and z, or x and y.
/// @param face  0 to 5: -x, +x, -y, +y, -z, +z
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Radiance that rays receive where they leave or enter the medium: of environment and sky, of reflecting faces of the
/// box (the ground), of the table (the face ViewSettings::tableFace, with diffuse and specular reflectance), and the
/// correction for light at the surface of optically thick voxels.
class Backdrop
{
public:
  /// Computes the lookup tables from which kernels interpolate this radiance, and copies them to the device.
  /// @throws DeviceError if the tables do not fit the device
  /// @param block  position of the medium in a larger grid; null: the medium is the whole domain
  Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block = nullptr);

  /// Whether the background is the illumination's environment or sky and not the settings' background colour.
  bool IsSky() const { return this->UnderSky; }
  bool HasEnvironment() const { return this->Size[0] > 0; }
  bool HasGround() const { return (this->FaceBits & 63) != 0; }
  bool HasSurfaceLight() const { return this->HasSurface; }

  /// All lookup tables in one array, which is empty if the backdrop needs no table. The members of ViewInfo::backdrop
  /// are the indices at which they begin.
  const Buffer<cl_float4>& Tables() const { return this->Cells; }
  /// Sets the parameters of background, environment and reflecting faces, and the indices of the lookup tables.
  /// @param sharp  whether the kernel renders the pass for unscattered light: if light is shown by angular moments,
  ///   that pass shows only the peaks of the environment
  void Describe(const ViewSettings& settings, bool sharp, ViewInfo& view) const;

private:
  bool UnderSky = false, HasSurface = false;
  Rgb Sky = {};
  std::array<int, 2> Size = {}; ///< width and height of the environment, pixels; 0: no environment
  Rotation Turn = {};           ///< rotation from world axes to the environment's axes
  /// Bit mask of the faces that are shown: bits 0 to 5 reflecting faces, 6 to 11 those through which light enters.
  int FaceBits = 0;
  /// Index in Cells at which each lookup table begins: environment, reflecting faces, light at the surface, scene's
  /// table.
  cl_int4 First = {};
  int FirstSharp = 0; ///< index in Cells of the environment's peaks; set only if light is shown by angular moments
  Buffer<cl_float4> Cells;
};
}
