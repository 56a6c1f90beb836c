#pragma once

#include "Device/Errors.h"
#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include "vtkFloatArray.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkImageData;
class vtkInformationVector;
class vtkPolyData;
class vtkTable;

/// The one place where filters read and write what flows between them: arrays, their names, shapes and units.
///
/// What reads throws InvalidInput with a text for the user; a filter does all its work within Guarded, which turns that
/// into an error of VTK. A filter's RequestData so reads:
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
/// The cells of an image, wherever its extent starts.
/// @throws InvalidInput where there is no image, no cell, a spacing that is not a positive number, or a rotation
Grid GridOf(vtkImageData* image);

/// An array as floats, and the memory they are in.
class FloatField
{
public:
  FloatField() = default; ///< the quantity that is zero everywhere
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

/// Values of the image's cells: the cell array of that name, or its point array averaged to cells. Float arrays are
/// used where they are, others are converted. Hidden cells (GhostFlags.h) have 0, of the refractive index 1.
/// @throws InvalidInput naming the array, the components it has, or the arrays that there are
FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components = { 1, 3 });

/// The same for the array that SetInputArrayToProcess chose as number `index`, by name or by attribute. Where points
/// were chosen, the point array is preferred to a cell array of the same name. Where nothing was chosen, which is
/// SCALARS to VTK and "" to ParaView before it knows the input, `otherwise` is read; "" there stands for the active
/// scalars. An array of another name that was chosen is never optional.
FloatField ReadChosenCells(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise,
  Need need, Components components = { 1, 3 });

/// The array that ReadChosenCells would read, or null; it is not looked at.
vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise);

/// Numbers of SetInputArrayToProcess for the filters that take a medium at port 0.
enum MediumArray
{
  SigmaA = 0,
  SigmaS = 1,
  Emission = 2,
};

/// A medium and the arrays that it sees.
struct MediumInput
{
  Medium medium;
  FloatField sigma_a, sigma_s, emission;
};

/// The medium of an image: cells `sigma_a`, `sigma_s` (1 or 3 components, 1/length), `emission` (optional, 1 or 3) or
/// the arrays chosen instead by MediumArray, and field data `g` (one number; missing: 0). Checked.
MediumInput ReadMedium(vtkAlgorithm* filter, vtkImageData* image);

/// Field data `name`: one number.
/// @throws InvalidInput where it is there and is not one number
double ReadFact(vtkDataObject* data, const char* name, double missing);

/// Lights as LightRig makes them: point data `light_type` and `power` (1 or 3 components); `direction`, `size` and
/// `angle` where the types need them. Hidden and duplicate points are left out. No polydata or one without points: no
/// lights. Checked.
std::vector<Light> ReadLights(vtkPolyData* lights);

/// The environment of a latitude-longitude image: point data `radiance`, 1 (grey) or 3 components, of width x height x
/// 1 points; hidden ones are black. No image: an empty environment. Checked.
Environment ReadEnvironment(vtkImageData* image);

/// Adds light without a source: radiance from every direction alike (red, green, blue) and through the faces -x, +x,
/// -y, +y, -z, +z, W/(length^2 sr). Checked.
void AddDiffuse(Illumination& illumination, const double* sky, const double* faceRadiance);

/// Add values to an image's cells, without copying them.
/// @param values  `components` a cell, x fastest
/// @param advice  see RequireFinite
/// @throws InvalidInput where a value is not finite
void AddCells(
  vtkImageData* image, const char* name, std::vector<float>&& values, int components, const char* advice = nullptr);

/// The same of light: of 3 channels they are named R, G, B.
void AddLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// The same of light that a user gave, NaN where it is not known: not looked at.
void AddGivenLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels);

/// Add field data.
/// @param values  tuples of `components` one after the other
void AddFact(vtkDataObject* data, const char* name, const std::vector<double>& values, int components = 1);
void AddFact(vtkDataObject* data, const char* name, const std::vector<std::string>& values);

/// What leaves thick voxels at the box's faces, see LightField::surfaceRadiance: a tuple a cell of BoxFaces.h.
constexpr const char* SurfaceRadianceFact = "surface_radiance";

/// Texts one a line, for the panel.
std::string Lines(const std::vector<std::string>& texts);

/// Everything a solver found but its convergence: cells `fluence` (made the active scalars), `fluence_direct`,
/// `fluence_error`, `net_flux`, `scattered_radiance` (channels fastest, then stored directions), those that are not
/// empty; field data `energy_balance`, `face_power_out`, `half_range_flux`, `stored_directions`, `surface_radiance`,
/// `left_out`, `device`. Light that the output already has is taken away.
void WriteLight(LightField&& light, vtkImageData* output);

/// One row an iteration: `iteration`, `seconds`, `residual`, `change`, `absorbed`, `escaped`, `left_over`.
void WriteConvergence(const std::vector<ConvergenceRow>& rows, vtkTable* table);

/// To be asked where an input is empty: ends the work of Guarded without an error where the filter before failed or was
/// aborted.
void StopWithFilterBefore(vtkDataObject* input);

/// Reports to the filter's progress; says stop when the filter is asked to abort.
Monitor MonitorOf(vtkAlgorithm* filter);

/// Make the output the input's arrays, with field data of its own: a shallow copy alone would share that, so that what
/// a filter adds would appear in its input, and vanish when that is made again.
void PassOn(vtkImageData* input, vtkImageData* output);

/// Runs the work of a filter's RequestData. Whatever it throws becomes one error of the filter; the outputs are empty
/// then and after an abort, which is no error, and the filter runs again when something has changed. Empty outputs have
/// field data `failed` or `aborted`, from which later filters know: they stay empty, too, without an error of their
/// own. What the device layer has to tell users (Device::TakeWarnings) becomes a warning of the filter.
/// @return what RequestData is to return: always 1. With 0 the pipeline would add an error that says less, and run the
///   filter again, in vain, with every update.
int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work);

/// Runs what may fail in a reader's RequestInformation. What it throws becomes one error, however often ParaView asks,
/// until the reader is modified; Guarded then leaves the outputs empty.
/// @return whether it succeeded. RequestInformation is to return 1 all the same, as RequestData.
bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work);
}
