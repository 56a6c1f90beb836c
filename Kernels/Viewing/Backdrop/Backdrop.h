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
/// Number of voxels per row, and number of rows, on a face of the box. The axis along a row and the axis across the
/// rows are y and z on the faces -x and +x, x and z on -y and +y, x and y on -z and +z.
/// @param face  0 to 5: -x, +x, -y, +y, -z, +z
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Radiance that rays receive where they leave or enter the medium. Its sources are the environment or sky, reflecting
/// faces of the box (the ground), and the table, a plane at the face ViewSettings::tableFace with diffuse and specular
/// reflectance. Also holds the correction for light at the surface of optically thick voxels.
class Backdrop
{
public:
  /// Computes the arrays from which kernels interpolate this radiance, and copies them to the device.
  /// @throws DeviceError if the arrays do not fit the device
  /// @param block  position of the medium in a larger grid; null: the medium is the whole domain
  Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block = nullptr);

  /// Whether the background is the illumination's environment or sky. If not, it is the background colour of the
  /// settings.
  bool IsSky() const { return this->UnderSky; }
  bool HasEnvironment() const { return this->Size[0] > 0; }
  bool HasGround() const { return (this->FaceBits & 63) != 0; }
  bool HasSurfaceLight() const { return this->HasSurface; }

  /// All lookup tables in one array, empty if the backdrop needs none. ViewInfo::backdrop has the index at which each
  /// table begins.
  const Buffer<cl_float4>& Tables() const { return this->Cells; }
  /// Sets the parameters of background, environment and reflecting faces, and the indices of the lookup tables.
  /// @param sharp  whether the kernel renders the pass for unscattered light of a picture made of angular moments. This
  ///   pass shows only the peaks of the environment
  void Describe(const ViewSettings& settings, bool sharp, ViewInfo& view) const;

private:
  bool UnderSky = false, HasSurface = false;
  Rgb Sky = {};
  std::array<int, 2> Size = {}; ///< width and height of the environment, pixels; 0: no environment
  Rotation Turn = {};           ///< rotation from world axes to the environment's axes
  /// Bit mask of the faces that are shown. Bits 0 to 5: reflecting faces. Bits 6 to 11: faces through which light
  /// enters.
  int FaceBits = 0;
  /// Index in Cells at which each lookup table begins: environment, reflecting faces, correction for light at the
  /// surface, and irradiance of the scene's table (ViewSettings::tableFace).
  cl_int4 First = {};
  int FirstSharp = 0; ///< index in Cells of the environment's peaks; set only if light is shown by angular moments
  Buffer<cl_float4> Cells;
};
}
