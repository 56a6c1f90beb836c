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

class vtkAlgorithm;
class vtkDataObject;
class vtkImageData;
class vtkPolyData;
class vtkTable;

/// Writes the data that filters exchange: arrays with their names, shapes and units. No other code writes them.
namespace tyndall
{
/// Adds a cell array to an image without copying the values.
/// @param values  `components` per cell, x fastest
/// @param advice  what the user can do about a value that is not finite (RequireFinite)
/// @throws InvalidInput if a value is not finite
void AddCells(
  vtkImageData* image, const char* name, std::vector<float>&& values, int components, const char* advice = nullptr);

/// Adds a cell array with one component per channel to an image by AddCells, and names three components R, G, B.
void AddLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// Adds a second array `name` with the values of the image's array `as`. The arrays share memory; values are not
/// checked.
void AddSameLight(vtkImageData* image, const char* name, const char* as);

/// Adds a cell array of light from the user's input. Unlike AddLight it does not check the values, which may be NaN
/// where the light is unknown.
void AddGivenLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// Name of field data of an image that was read: fraction of its voxels that are active in the file. Missing: unknown.
constexpr const char* ActivePartFact = "active_part";
/// Name of field data of light from scattered photons: total number of scattering events. Missing: no scattering.
constexpr const char* ScatteringsFact = "scatterings";
/// Adds an array called `name` to the field data of a data object.
/// @param values  tuples of `components` values each
void AddFact(vtkDataObject* data, const char* name, const std::vector<double>& values, int components = 1);
void AddFact(vtkDataObject* data, const char* name, const std::vector<std::string>& values);
void AddFact(vtkDataObject* data, const char* name, const std::vector<std::array<double, 3>>& vectors);

/// Name of field data: radiance that leaves optically thick voxels at the domain's faces (LightField::surfaceRadiance);
/// one tuple for each face of a boundary voxel; ordered by face of the domain, -x to +z, and within a face with the
/// lower axis fastest.
constexpr const char* SurfaceRadianceFact = "surface_radiance";
/// Names of field data: estimated standard error of `surface_radiance` (LightField::surfaceError), and length over
/// which errors of `fluence` have the same sign (LightField::errorLength).
constexpr const char* SurfaceErrorFact = "surface_radiance_error";
constexpr const char* ErrorLengthFact = "error_length";
/// Name of field data with one text for each array of the medium that the solver ignores: the array, and filters that
/// use it.
constexpr const char* IgnoredFact = "ignored";
/// Names of field data. FacePowerFact: outgoing partial current LightField::facePower, W / length^2, one tuple for each
/// face of a boundary voxel; ordered by face of the domain, -x to +z, and within a face with the lower axis fastest.
/// FaceAlbedoFact: fraction of the current that a face of the domain reflects; red, green, blue for each face, -x to
/// +z.
constexpr const char* FacePowerFact = "face_power";
constexpr const char* FaceAlbedoFact = "face_albedo";
/// Name of field data: radiance that enters through the faces -x to +z of the domain, W/(length^2 sr), for pictures of
/// angular moments.
constexpr const char* FaceRadianceFact = "face_radiance";
/// Names of field data of light at the domain's faces, and of its error.
constexpr const char* FaceFacts[] = { SurfaceRadianceFact, SurfaceErrorFact, ErrorLengthFact, FacePowerFact,
  FaceAlbedoFact, FaceRadianceFact };

/// Names of cell arrays. MomentsArray: angular moments of scattered light (LightField::scatteredMoments).
/// StraightOnArray: fraction of scattering that the solver treats as unscattered (LightField::straightOn).
/// LampsApartFact: name of field data with the lamps whose first-collision source the moments exclude, one tuple for
/// each lamp: type, position, direction, power, size, angle.
constexpr const char* FluenceErrorArray = "fluence_error"; ///< standard error of `fluence`, W/length^2
constexpr const char* MomentsArray = "scattered_moments";
constexpr const char* StraightOnArray = "straight_on";
constexpr const char* LampsApartFact = "lamps_apart";
constexpr int LampComponents = 13;

// Names of arrays and field data that vtkLPMPropagate writes and vtkLPMCollect reads.

/// Names of the cell arrays with the temporary buffers T, the deposits of the rays (Gruson et al. 2012, Eq. 6): one
/// array for the ray directions towards each face of a cube, -x to +z.
constexpr const char* const NamesOfT[6] = { "T_xmin", "T_xmax", "T_ymin", "T_ymax", "T_zmin", "T_zmax" };

/// Names of field data, all set by vtkLPMPropagate: rays per voxel edge, number of stored directions, number of the
/// propagated scattering order.
constexpr const char* const MapResolutionFact = "map_resolution";
constexpr const char* const StoredDirectionsFact = "stored_directions_count";
constexpr const char* const OrderFact = "scattering_order";

/// Joins texts with line breaks, for ParaView's panel.
std::string Lines(const std::vector<std::string>& texts);

/// Records the computations that a filter skipped, in the field data `left_out` of its output and in its property
/// LeftOut.
void TellLeftOut(vtkAlgorithm* filter, vtkDataObject* output, const std::vector<std::string>& texts);

/// Writes everything a solver computed except its convergence. Cell arrays: `fluence` (made the active scalars),
/// `fluence_direct`, `fluence_error`, `net_flux`, `scattered_radiance` (channels fastest, then stored directions),
/// `scattered_moments` (channels fastest, then spherical harmonics), `straight_on`; empty ones are skipped. Field data:
/// `energy_balance`, `face_power_out`, `face_power`, `face_albedo`, `half_range_flux`, `stored_directions`,
/// `surface_radiance`, `lamps_apart`, `left_out`, `settings_used`, `device`. Light that the output already holds is
/// removed.
void WriteLight(LightField&& light, vtkImageData* output);

/// Names of the data of a lit colour, the display colour of each voxel. Cell array: LitColor::rgba, unsigned char, 4
/// components. Field data: the length to which the opacities refer (VTK's scalar opacity unit distance), and the
/// exposure, a factor of radiance.
constexpr const char* LitColorArray = "lit_color";
constexpr const char* LitColorDistanceFact = "lit_color_distance";
constexpr const char* LitColorExposureFact = "lit_color_exposure";
void WriteLitColor(LitColor&& lit, vtkImageData* output);

/// Writes the convergence of a solve to a table, one row per iteration: `iteration`, `seconds`, `residual`, `change`,
/// `absorbed`, `escaped`, `left_over`, and `sweeps_saved` if light is kept between solves (LightField.h).
void WriteConvergence(const std::vector<ConvergenceRow>& rows, const std::vector<int>& sweepsSaved, vtkTable* table);

/// Writes one vertex for each light, with the point arrays that vtkLightRig lists.
void WriteLights(const std::vector<Light>& lights, vtkPolyData* output);

/// Copies the input to the output: the output shares the input's arrays but has a separate field data object. After a
/// shallow copy alone, arrays that a filter adds to the output's field data would appear in the input, and vanish when
/// the input is recomputed.
void PassOn(vtkDataObject* input, vtkDataObject* output);

/// Checks that all values of an array are finite.
/// @param place   describes the position of a tuple to a user: "voxel (1, 2, 3)", "photon 5"
/// @param advice  what the user can do; null: advice for light and coefficients of a medium
/// @return ranges of the values, to be stored in the array
/// @throws InvalidInput if a value is not finite: names the array, the first such position, the value and the likely
///   cause
ArrayRanges RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice = nullptr);

/// Checks that all values of an image's cells are finite, as RequireFinite does; messages give a voxel's indices.
ArrayRanges RequireFiniteCells(vtkImageData* image, const char* array, const float* values, std::size_t count,
  int components, const char* advice = nullptr);
}
