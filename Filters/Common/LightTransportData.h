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

/// Reads the data that filters exchange: arrays with their names, shapes and units. LightTransportWriting.h writes
/// them.
///
/// These functions throw InvalidInput with a message for users. A filter does all its work within Guarded, which turns
/// the exception into a VTK error:
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
class Domain;

/// The three values of a property, such as a colour or a position.
inline std::array<double, 3> Triple(const double* values)
{
  return { values[0], values[1], values[2] };
}

/// The grid of an image's cells; the image's extent may start anywhere.
/// @throws InvalidInput if there is no image or no cell, if a spacing is not a positive number, or if the image is
///   rotated
Grid GridOf(vtkImageData* image);

/// The array itself if it is a vtkFloatArray, otherwise a converted copy; null for null.
vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array);

/// An array of floats together with shared ownership of its memory.
class FloatField
{
public:
  FloatField() = default; ///< a quantity that is zero everywhere
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
  Optional, ///< a missing array is an empty FloatField, unless the user chose that array
};

/// Names of arrays, for messages: 'a', 'b', or none.
std::string NamesOf(vtkDataSetAttributes* attributes);

/// Numbers of components that an array may have; empty: any.
using Components = std::initializer_list<int>;

/// Reads values of the image's cells from the cell array `name`, or from the point array `name` averaged to cells. (If
/// voxels are around points, Guarded has already turned point arrays into cell arrays, ImageInput.h.) Float arrays are
/// used in place, other types are converted. Hidden cells (ImageInput.h) read as 0, or as refractive index 1.
/// @throws InvalidInput naming the array and its number of components, or the arrays that exist
FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components = { 1, 3 });

/// The same for the array that SetInputArrayToProcess selected as number `index`, by name or by attribute. If a point
/// array was selected, it takes precedence over a cell array of the same name. If nothing was selected (SCALARS in VTK,
/// "" in ParaView before it knows the input), or the name `otherwise`, the function reads the array that the filter
/// upstream used for this quantity (NoteChoices), or else the array `otherwise`, where "" stands for the active
/// scalars. An array selected by another name is never optional.
FloatField ReadChosenCells(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise,
  Need need, Components components = { 1, 3 });

/// The array that ReadChosenCells would read, or null. Its type and shape are not checked.
vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise);

/// Names of the arrays that a filter reads from an image, among those that the image has.
struct ArraysRead
{
  std::vector<std::string> ofCells, ofPoints;
};
ArraysRead FindArrays(vtkAlgorithm* filter, const VoxelArrays& arrays, vtkImageData* image);

/// Whether some arrays are selected by SetInputArrayToProcess, or announced as active, and all of these are point
/// arrays.
/// @param chosen  VoxelArrays::chosen
bool ChoosesOnlyPoints(vtkAlgorithm* filter, const std::vector<std::string>& chosen, vtkInformation* input);

/// Relative density of fog inside a level set as a function of the signed distance from its surface, negative inside: 1
/// in the interior, falling linearly to 0 at the surface within the last voxel, 0 outside. Equals OpenVDB's
/// sdfToFogVolume with that cutoff.
template <typename Value>
Value FogInside(Value distance, double voxel)
{
  return std::min(std::max(static_cast<Value>(-distance / voxel), Value(0)), Value(1));
}

/// Indices for SetInputArrayToProcess in filters whose port 0 takes a medium.
enum MediumArray
{
  SigmaA = 0,
  SigmaS = 1,
  Emission = 2,
};
/// The index for the refractive index, in filters that use it.
constexpr int RefractiveIndex = 3;

/// Indices for SetInputArrayToProcess with the names of the default arrays.
using Quantities = std::vector<std::pair<int, std::string>>;
Quantities QuantitiesOfMedium(); ///< those of MediumArray, and RefractiveIndex

/// Records in the output's field data which of its arrays the filter used for these quantities, so that filters
/// downstream use the same ones: `sigma_a_array` and so on, a text with the array's name, followed by "points" if the
/// point array takes precedence over a cell array of that name. Nothing is recorded for a default array.
/// @param input  the filter's input, whose arrays the output has
void NoteChoices(vtkAlgorithm* filter, const Quantities& quantities, vtkImageData* input, vtkImageData* output);

/// Removes what the input recorded, for a filter that computes a medium's arrays itself.
void ForgetChoices(vtkImageData* output);

/// Whether the array that ReadChosenCells would read exists and differs from the value `usual` in a cell that is not
/// hidden. For filters that ignore the quantity; nothing else is checked.
bool IsUnusual(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& name, float usual);

/// Texts for field data `ignored` (IgnoredFact): for a filter that ignores refraction, and for one that ignores the
/// medium's emission because its photons start from lights only. Empty if nothing is ignored.
std::vector<std::string> IgnoredIndex(bool isUnusual);
std::vector<std::string> IgnoredEmission(bool isUnusual);
/// The same texts as one warning.
std::string WarningOf(const std::vector<std::string>& ignored);

/// A medium together with the arrays that it refers to.
struct MediumInput
{
  Medium medium;
  FloatField sigma_a, sigma_s, emission, g;

  bool Emits() const; ///< whether emission is above 0 anywhere
};

/// Reads the medium of an image and checks it. Cell arrays `sigma_a` and `sigma_s` (1 or 3 components, 1/length) and
/// `emission` (optional, 1 or 3 components), or the arrays selected instead by MediumArray. Phase function: cell array
/// `g` (optional, 1 or 3 components) if the mean cosine varies by voxel, otherwise field data `g` (1 or 3 numbers;
/// default 0); field data `phase_function` and the parameters in PhaseFunctionData.h (default Henyey-Greenstein).
MediumInput ReadMedium(vtkAlgorithm* filter, vtkImageData* image);
/// The same for a rank's block of a domain. Collective.
/// @param own  the block's image; null if it has no voxels
/// @throws InvalidInput, the same on all ranks, if ReadMedium throws on any
MediumInput ReadMedium(vtkAlgorithm* filter, const Domain& domain, vtkImageData* own);

/// Angular moments as WriteLight writes them; empty if the solver computed none or some of the arrays are missing.
struct MomentsInput
{
  FloatField moments, straightOn;
  std::vector<Light> lampsApart;
};

/// Uncollided light computed by another filter, together with the arrays that it refers to.
struct UncollidedInput
{
  UncollidedImage image;
  FloatField fluence, meanDirection;
};

/// All light sources outside of the medium, together with the arrays that they refer to.
struct IlluminationInput
{
  Illumination illumination;
  UncollidedInput uncollided;
  bool isDefaultSky = false; ///< true if no light is given; see vtkPropagationAlgorithm
};

/// Reads the uncollided light of PhotonMarcher or PhotonReconstruction: cell array `fluence_direct` (1 or 3
/// components), optional cell array `mean_direction` (3 components; default isotropic), optional field data
/// `face_power_out` (default 0).
/// @throws InvalidInput if its voxels are not those of the medium, or an array is missing or has the wrong shape
UncollidedInput ReadUncollided(vtkImageData* image, const Grid& medium);

/// @throws InvalidInput if an array has the wrong shape
MomentsInput ReadMoments(vtkImageData* image);

/// Reads one number from field data `name`; returns `missing` if there is no such field data.
/// @throws InvalidInput if it is not exactly one number
double ReadFact(vtkDataObject* data, const char* name, double missing);

/// Reads lights as LightRig writes them, and checks them: point data `light_type` and `power` (1 or 3 components);
/// `direction`, `size` and `angle` if the types need them. Hidden and duplicate points are skipped. Returns no lights
/// without polydata or points.
std::vector<Light> ReadLights(vtkPolyData* lights);

/// Transforms lights, or illumination with its sky, from the scene to the medium axes.
std::vector<Light> InOwnAxes(std::vector<Light> lights, const OwnAxes& axes);
Illumination InOwnAxes(Illumination illumination, const OwnAxes& axes);

/// Reads the environment from a latitude-longitude image of width x height x 1 points, and checks it: point data
/// `radiance`, 1 (grey) or 3 components; hidden points are black. Returns an empty environment without an image.
Environment ReadEnvironment(vtkImageData* image);

/// Whether there is no light source: no lamp, no environment, and black sky and faces.
bool NothingShines(const Illumination& illumination);

/// Adds incident isotropic radiance `sky` (red, green, blue) and boundary sources at the faces -x, +x, -y, +y, -z, +z,
/// W/(length^2 sr). The values are checked.
void AddDiffuse(Illumination& illumination, const double* sky, const double* faceRadiance);

/// Adds reflecting boundaries: one albedo for each face, multiplied by red, green and blue factors for each face. The
/// values are checked.
void AddFaceAlbedo(Illumination& illumination, const double* albedo, const double* colour);

/// Whether the voxels of a grid have the same corners as those of the medium, up to rounding.
bool AreSameVoxels(const Grid& grid, const Grid& medium);

/// @param whose, remedy  parts of the message, e.g. "The octree", "Make the octree of the same medium."
/// @throws InvalidInput unless the voxels of the grid have the same corners as those of the medium, up to rounding
void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy);
}
