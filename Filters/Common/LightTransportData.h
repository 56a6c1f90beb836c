#pragma once

#include "Common/ImageInput.h"
#include "Common/LightTransportWriting.h"
#include "Device/Errors.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"

#include "vtkFloatArray.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkImageData;
class vtkPolyData;

/// Reading of the data that flow between filters: arrays, their names, shapes and units. Writing:
/// LightTransportWriting.h.
///
/// These functions throw InvalidInput with a message for users; a filter does all its work within Guarded, which turns
/// it into an error of VTK:
///
///     int vtkX::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
///     {
///       return Guarded(this, outputs, [&] {
///         vtkImageData* image = vtkImageData::GetData(inputs[0]);
///         const MediumInput input = ReadMedium(this, image);
///         LightField light = Solve(input.medium, ..., MonitorOf(this));
///         vtkImageData* output = vtkImageData::GetData(outputs);
///         output->ShallowCopy(image);
///         WriteLight(std::move(light), output);
///       });
///     }
namespace tyndall
{
/// The three numbers of a property: a colour or a position.
inline std::array<double, 3> Triple(const double* values)
{
  return { values[0], values[1], values[2] };
}

/// The cells of an image, wherever its extent starts.
/// @throws InvalidInput if there is no image or no cell, a spacing is not a positive number, or it is rotated
Grid GridOf(vtkImageData* image);

/// The array itself if it is of floats, else a copy; null for null.
vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array);

/// An array as floats; keeps its memory.
class FloatField
{
public:
  FloatField() = default; ///< of a quantity that is zero everywhere
  explicit FloatField(vtkSmartPointer<vtkFloatArray> array)
    : Array(std::move(array))
  {
  }

  bool IsThere() const { return this->Array != nullptr; }
  int Components() const { return this->Array ? this->Array->GetNumberOfComponents() : 1; }
  const float* Values() const { return this->Array ? this->Array->GetPointer(0) : nullptr; }
  operator Field() const { return { this->Values(), this->Components() }; }

private:
  vtkSmartPointer<vtkFloatArray> Array;
};

enum class Need
{
  Required, ///< a missing array is an error
  Optional, ///< a missing array is a FloatField that is not there, unless it was chosen
};

/// Names of arrays for messages: 'a', 'b', or none.
std::string NamesOf(vtkDataSetAttributes* attributes);

/// Shapes an array may have; empty: any.
using Components = std::initializer_list<int>;

/// Values of the image's cells: the cell array of that name, or its point array averaged to cells (Guarded has turned
/// points into cells before if there are voxels around them, ImageInput.h). Float arrays are used in place, other types
/// are converted. Hidden cells (ImageInput.h) have 0, or refractive index 1.
/// @throws InvalidInput naming the array, its components, or the arrays that there are
FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components = { 1, 3 });

/// The same for the array that SetInputArrayToProcess chose as number `index`, by name or by attribute. If points were
/// chosen, the point array is preferred to a cell array of the same name. If nothing was chosen (SCALARS for VTK, ""
/// for ParaView before it knows the input), or the name `otherwise`, the array is read that the filter upstream took
/// for the quantity (NoteChoices), or else `otherwise`; "" there stands for the active scalars. An array that was
/// chosen by another name is never optional.
FloatField ReadChosenCells(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise,
  Need need, Components components = { 1, 3 });

/// The array that ReadChosenCells would read, or null; not checked.
vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise);

/// Names of the arrays that a filter reads of an image, as far as it has them.
struct ArraysRead
{
  std::vector<std::string> ofCells, ofPoints;
};
ArraysRead FindArrays(vtkAlgorithm* filter, const VoxelArrays& arrays, vtkImageData* image);

/// Whether arrays were chosen by SetInputArrayToProcess, or are announced as active, and all of them are of points.
/// @param chosen  VoxelArrays
bool ChoosesOnlyPoints(vtkAlgorithm* filter, const std::vector<std::string>& chosen, vtkInformation* input);

/// Relative density of the fog that fills a level set, by the distance from its surface, which is negative inside: 1,
/// and less in proportion within a voxel of the surface; 0 outside. What OpenVDB's sdfToFogVolume makes with that
/// cutoff.
template <typename Value>
Value FogInside(Value distance, double voxel)
{
  return std::min(std::max(static_cast<Value>(-distance / voxel), Value(0)), Value(1));
}

/// Numbers of SetInputArrayToProcess for the filters that take a medium at port 0.
enum MediumArray
{
  SigmaA = 0,
  SigmaS = 1,
  Emission = 2,
};
/// The same for the refractive index, of those that know it.
constexpr int RefractiveIndex = 3;

/// Numbers of SetInputArrayToProcess, and the names of the arrays where none is chosen.
using Quantities = std::vector<std::pair<int, std::string>>;
Quantities QuantitiesOfMedium(); ///< those of MediumArray, and RefractiveIndex

/// Records in an output which of its arrays the filter took for these quantities, so that filters downstream take the
/// same: field data `sigma_a_array` and so on, a text with the array's name, and "points" if these were preferred to
/// cells of that name. None for the default array.
/// @param input  of the filter; the output has its arrays
void NoteChoices(vtkAlgorithm* filter, const Quantities& quantities, vtkImageData* input, vtkImageData* output);

/// For a filter that makes a medium's arrays itself: removes what its input recorded.
void ForgetChoices(vtkImageData* output);

/// Whether the array that ReadChosenCells would read exists and differs from the usual value in a cell that is not
/// hidden: for filters that ignore the quantity. Not checked otherwise.
bool IsUnusual(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& name, float usual);

/// Texts of field data `ignored` (IgnoredFact) for a filter without refraction, and for one whose photons come from
/// lights alone; empty if nothing is ignored.
std::vector<std::string> IgnoredIndex(bool isUnusual);
std::vector<std::string> IgnoredEmission(bool isUnusual);
/// The same as a warning.
std::string WarningOf(const std::vector<std::string>& ignored);

/// A medium and the arrays that it refers to.
struct MediumInput
{
  Medium medium;
  FloatField sigma_a, sigma_s, emission, g;

  bool Emits() const; ///< anywhere: an array of zeros is no light
};

/// The medium of an image: cells `sigma_a`, `sigma_s` (1 or 3 components, 1/length), `emission` (optional, 1 or 3) or
/// the arrays chosen instead by MediumArray, and the phase function: cells `g` (optional, 1 or 3 components) where the
/// mean cosine varies by voxel, else field data `g` (1 or 3 numbers; missing: 0), and field data `phase_function` and
/// its companions (PhaseFunctionData.h; missing: Henyey and Greenstein's). Checked.
MediumInput ReadMedium(vtkAlgorithm* filter, vtkImageData* image);

/// Angular moments that WriteLight wrote; without values if the solver found none, or part of them is gone.
struct MomentsInput
{
  FloatField moments, straightOn;
  std::vector<Light> lampsApart;
};

/// Uncollided light of another solver, and the arrays that it refers to.
struct UncollidedInput
{
  UncollidedImage image;
  FloatField fluence, meanDirection;
};

/// Everything that lights a medium, and the arrays that it refers to.
struct IlluminationInput
{
  Illumination illumination;
  UncollidedInput uncollided;
  bool isDefaultSky = false; ///< no light is given, see vtkPropagationAlgorithm
};

/// Uncollided light of PhotonMarcher or PhotonReconstruction: cells `fluence_direct` (1 or 3 components), optional
/// cells `mean_direction` (3; missing: isotropic), optional field data `face_power_out` (missing: 0).
/// @throws InvalidInput if its voxels are not those of the medium, or an array is missing or has the wrong shape
UncollidedInput ReadUncollided(vtkImageData* image, const Grid& medium);

/// @throws InvalidInput if one has the wrong shape
MomentsInput ReadMoments(vtkImageData* image);

/// Field data `name`: one number.
/// @throws InvalidInput if it is not one number
double ReadFact(vtkDataObject* data, const char* name, double missing);

/// Lights as LightRig makes them: point data `light_type` and `power` (1 or 3 components); `direction`, `size` and
/// `angle` where the types need them. Hidden and duplicate points are left out. No polydata or one without points: no
/// lights. Checked.
std::vector<Light> ReadLights(vtkPolyData* lights);

/// Lights of the scene, and illumination with its sky, in the axes of an image.
std::vector<Light> InOwnAxes(std::vector<Light> lights, const OwnAxes& axes);
Illumination InOwnAxes(Illumination illumination, const OwnAxes& axes);

/// The environment of a latitude-longitude image: point data `radiance`, 1 (grey) or 3 components, of width x height x
/// 1 points; hidden ones are black. No image: an empty environment. Checked.
Environment ReadEnvironment(vtkImageData* image);

/// Whether there is neither a lamp nor an environment, and sky and all faces are black.
bool NothingShines(const Illumination& illumination);

/// Adds isotropic radiance (red, green, blue) and that through the faces -x, +x, -y, +y, -z, +z, W/(length^2 sr).
/// Checked.
void AddDiffuse(Illumination& illumination, const double* sky, const double* faceRadiance);

/// Adds reflecting boundaries: an albedo for each face, times factors red, green, blue for each. Checked.
void AddFaceAlbedo(Illumination& illumination, const double* albedo, const double* colour);

/// Whether a grid's voxels have the same corners as those of the medium, but for rounding.
bool AreSameVoxels(const Grid& grid, const Grid& medium);

/// @param whose, remedy  for the message: "The octree", "Make the octree of the same medium."
/// @throws InvalidInput where a grid's voxels do not have the same corners as those of the medium, but for rounding
void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy);
}
