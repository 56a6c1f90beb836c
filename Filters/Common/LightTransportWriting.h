#pragma once

#include "Common/ArrayRanges.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Viewing/LitColor.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkImageData;
class vtkPolyData;
class vtkTable;

/// The one place where filters write what flows between them: arrays, their names, shapes and units.
namespace tyndall
{
/// Add values to an image's cells, without copying them.
/// @param values  `components` per cell, x fastest
/// @param advice  see RequireFinite
/// @throws InvalidInput where a value is not finite
void AddCells(
  vtkImageData* image, const char* name, std::vector<float>&& values, int components, const char* advice = nullptr);

/// The same of light: of 3 channels they are named R, G, B.
void AddLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// Add the light that an array of the image holds under another name, without copying or looking at it: both have the
/// same memory.
void AddSameLight(vtkImageData* image, const char* name, const char* as);

/// The same of light that a user gave, NaN where it is not known: not looked at.
void AddGivenLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// Of an image that was read: the part of its voxels that the file holds as active. Not there: nobody knows.
constexpr const char* ActivePartFact = "active_part";
/// Add field data.
/// @param values  tuples of `components` one after the other
/// Field data of light of photons that were scattered: how often, all together. Not there: they were not.
constexpr const char* ScatteringsFact = "scatterings";
void AddFact(vtkDataObject* data, const char* name, const std::vector<double>& values, int components = 1);
void AddFact(vtkDataObject* data, const char* name, const std::vector<std::string>& values);
void AddFact(vtkDataObject* data, const char* name, const std::vector<std::array<double, 3>>& vectors);

/// What leaves thick voxels at the box's faces, see LightField::surfaceRadiance: a tuple per cell of BoxFaces.h.
constexpr const char* SurfaceRadianceFact = "surface_radiance";
/// Field data: arrays of the medium that the light does not depend on, and which filters know them, a text each.
constexpr const char* IgnoredFact = "ignored";
/// Field data: LightField::facePower, and what part of it comes back, red, green, blue of each face, -x to +z.
constexpr const char* FacePowerFact = "face_power";
constexpr const char* FaceAlbedoFact = "face_albedo";

/// Angular moments of what is scattered (LightField::scatteredMoments, straightOn), cells, and field data: the lamps
/// whose light they leave out until it is first scattered, a tuple each: type, position, direction, power, size, angle.
constexpr const char* MomentsArray = "scattered_moments";
constexpr const char* StraightOnArray = "straight_on";
constexpr const char* LampsApartFact = "lamps_apart";
constexpr int LampComponents = 13;

/// Texts one per line, for the panel.
std::string Lines(const std::vector<std::string>& texts);

/// Everything a solver found but its convergence: cells `fluence` (made the active scalars), `fluence_direct`,
/// `fluence_error`, `net_flux`, `scattered_radiance` (channels fastest, then stored directions), `scattered_moments`
/// (channels fastest, then spherical harmonics), `straight_on`, those that are not empty; field data `energy_balance`,
/// `face_power_out`, `face_power`, `face_albedo`, `half_range_flux`, `stored_directions`, `surface_radiance`,
/// `lamps_apart`, `left_out`, `settings_used`, `device`. Light that the output already has is taken away.
void WriteLight(LightField&& light, vtkImageData* output);

/// Cells: LitColor::rgba, unsigned char, 4 components; field data: its distance, length, and its exposure.
constexpr const char* LitColorArray = "lit_color";
constexpr const char* LitColorDistanceFact = "lit_color_distance";
constexpr const char* LitColorExposureFact = "lit_color_exposure";
void WriteLitColor(LitColor&& lit, vtkImageData* output);

/// One row an iteration: `iteration`, `seconds`, `residual`, `change`, `absorbed`, `escaped`, `left_over`, and
/// `sweeps_saved` where light is kept (LightField.h).
void WriteConvergence(const std::vector<ConvergenceRow>& rows, const std::vector<int>& sweepsSaved, vtkTable* table);

/// A vertex a light, with the point arrays that vtkLightRig lists.
void WriteLights(const std::vector<Light>& lights, vtkPolyData* output);

/// Make the output the input's arrays, with field data of its own: a shallow copy alone would share that, so that what
/// a filter adds would appear in its input, and vanish when that is made again.
void PassOn(vtkDataObject* input, vtkDataObject* output);

/// @param place   of a tuple, as a user finds it: "voxel (1, 2, 3)", "photon 5"
/// @param advice  what to do; null: what holds for light and coefficients of a medium
/// @return ranges, to be left in the array
/// @throws InvalidInput where a value is not finite: names the array, the first such place, the value, the likely cause
ArrayRanges RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice = nullptr);

/// The same of the cells of an image.
ArrayRanges RequireFiniteCells(vtkImageData* image, const char* array, const float* values, std::size_t count,
  int components, const char* advice = nullptr);
}
