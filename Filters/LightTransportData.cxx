#include "LightTransportData.h"

#include "Device/OpenCL.h"
#include "LastFailure.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointDataToCellData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

namespace tyndall
{
namespace
{
std::string Quoted(const std::string& name)
{
  return "'" + name + "'";
}

std::string NamesOf(vtkDataSetAttributes* attributes)
{
  std::string names;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    const char* name = attributes->GetArrayName(i);
    names += (i > 0 ? ", " : "") + Quoted(name ? name : "");
  }
  return names.empty() ? "none" : names;
}

std::string Listed(Components components)
{
  std::string text;
  for (int count : components)
  {
    text += (text.empty() ? "" : " or ") + std::to_string(count);
  }
  return text;
}

void CheckShape(vtkDataArray* array, const std::string& name, vtkIdType tuples, Components components)
{
  const int given = array->GetNumberOfComponents();
  if (components.size() > 0 && std::find(components.begin(), components.end(), given) == components.end())
  {
    throw InvalidInput("Array " + Quoted(name) + " has " + std::to_string(given) + " components; it must have " +
      Listed(components) + ".");
  }
  if (array->GetNumberOfTuples() != tuples)
  {
    throw InvalidInput("Array " + Quoted(name) + " has " + std::to_string(array->GetNumberOfTuples()) +
      " values where the dataset has " + std::to_string(tuples) + ".");
  }
}

vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array)
{
  if (auto* floats = vtkArrayDownCast<vtkFloatArray>(array))
  {
    return floats;
  }
  auto floats = vtkSmartPointer<vtkFloatArray>::New();
  floats->DeepCopy(array);
  return floats;
}

vtkSmartPointer<vtkFloatArray> AveragedToCells(vtkImageData* image, vtkFloatArray* ofPoints)
{
  vtkNew<vtkImageData> points;
  points->CopyStructure(image);
  vtkNew<vtkFloatArray> named; // The filter loses an array without a name.
  named->ShallowCopy(ofPoints);
  named->SetName("averaged");
  points->GetPointData()->AddArray(named);
  vtkNew<vtkPointDataToCellData> average;
  average->SetInputData(points);
  average->Update();
  return vtkArrayDownCast<vtkFloatArray>(average->GetOutput()->GetCellData()->GetArray("averaged"));
}

/// An array of cells or points, found but not looked at.
struct Found
{
  vtkDataArray* array = nullptr;
  bool ofPoints = false;
};

FloatField ToField(vtkImageData* image, const Found& found, const std::string& name, Components components)
{
  CheckShape(found.array, name, found.ofPoints ? image->GetNumberOfPoints() : image->GetNumberOfCells(), components);
  const vtkSmartPointer<vtkFloatArray> floats = AsFloats(found.array);
  return FloatField(found.ofPoints ? AveragedToCells(image, floats) : floats);
}

/// What SetInputArrayToProcess was told.
struct Choice
{
  std::string name;   ///< of an array
  int attribute = -1; ///< or the attribute it is, e.g. SCALARS
  bool pointsFirst = false;
};

/// What ParaView's panel hands on where the input has no array of the default name (none_string of the proxies).
const char* const NothingChosen = "(by name)";

Choice ChoiceOf(vtkAlgorithm* filter, int index, const std::string& otherwise)
{
  vtkInformation* information = filter->GetInputArrayInformation(index);
  Choice choice;
  choice.pointsFirst = information->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    information->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  if (information->Has(vtkDataObject::FIELD_NAME()))
  {
    choice.name = information->Get(vtkDataObject::FIELD_NAME());
  }
  else if (information->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
  {
    choice.attribute = information->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
  }
  const bool nothing = choice.name == NothingChosen ||
    (choice.name.empty() && choice.attribute <= vtkDataSetAttributes::SCALARS); // VTK's own default
  if (nothing)
  {
    choice.pointsFirst = otherwise.empty();
    choice.name = otherwise;
    choice.attribute = otherwise.empty() ? static_cast<int>(vtkDataSetAttributes::SCALARS) : -1;
  }
  return choice;
}

vtkDataArray* ArrayOf(vtkDataSetAttributes* attributes, const Choice& choice)
{
  return choice.attribute >= 0 ? attributes->GetAttribute(choice.attribute) : attributes->GetArray(choice.name.c_str());
}

Found Find(vtkImageData* image, const Choice& choice)
{
  vtkDataArray* ofCells = ArrayOf(image->GetCellData(), choice);
  vtkDataArray* ofPoints = ArrayOf(image->GetPointData(), choice);
  if (choice.pointsFirst ? ofPoints != nullptr : ofCells == nullptr)
  {
    return { ofPoints, true };
  }
  return { ofCells, false };
}

FloatField Read(vtkImageData* image, const Choice& choice, Need need, Components components)
{
  GridOf(image); // says what is wrong with an image that has no cells
  const Found found = Find(image, choice);
  if (found.array)
  {
    const char* name = found.array->GetName();
    return ToField(image, found, name ? name : "", components);
  }
  if (need == Need::Required)
  {
    throw InvalidInput((choice.attribute >= 0 ? "The input has no active " +
                             std::string(vtkDataSetAttributes::GetAttributeTypeAsString(choice.attribute))
                                              : "The input has no array " + Quoted(choice.name)) +
      ". Its cell arrays: " + NamesOf(image->GetCellData()) + "; its point arrays: " + NamesOf(image->GetPointData()) +
      ".");
  }
  return {};
}
}

namespace
{
/// Field data of outputs that are empty because their filter was aborted, or failed.
const char* const AbortedFact = "aborted";
const char* const FailedFact = "failed";

/// Thrown where an input is empty because the filter before failed, which has said why.
struct InputFailed
{
};

/// To be asked where an input is empty.
void StopWithFilterBefore(vtkDataObject* input)
{
  if (ReadFact(input, AbortedFact, 0.0) > 0.0)
  {
    throw Aborted();
  }
  if (ReadFact(input, FailedFact, 0.0) > 0.0)
  {
    throw InputFailed();
  }
}
}

Grid GridOf(vtkImageData* image)
{
  if (!image)
  {
    throw InvalidInput("There is no input image.");
  }
  const char* const axes[3] = { "x", "y", "z" };
  Grid grid;
  int extent[6];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = extent[2 * axis + 1] - extent[2 * axis];
    grid.spacing[axis] = image->GetSpacing()[axis];
    if (grid.size[axis] < 0)
    {
      StopWithFilterBefore(image);
      throw InvalidInput("The input image is empty.");
    }
    if (grid.size[axis] == 0)
    {
      throw InvalidInput("The input image has a single layer of points along " + std::string(axes[axis]) +
        ", so no voxels; it needs at least two.");
    }
    if (!(grid.spacing[axis] > 0.0) || std::isinf(grid.spacing[axis]))
    {
      throw InvalidInput("The input image has spacing " + std::to_string(grid.spacing[axis]) + " along " + axes[axis] +
        "; it must be a positive number.");
    }
    grid.origin[axis] = image->GetOrigin()[axis] + extent[2 * axis] * grid.spacing[axis];
    if (!std::isfinite(grid.origin[axis]))
    {
      throw InvalidInput("The input image has an origin that is not finite along " + std::string(axes[axis]) + ".");
    }
  }
  if (!image->GetDirectionMatrix()->IsIdentity())
  {
    throw InvalidInput("The input image is rotated by its direction matrix, which is not supported. Resample it, for "
                       "example with ResampleToImage.");
  }
  return grid;
}

FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components)
{
  Choice choice;
  choice.name = name;
  return Read(image, choice, need, components);
}

FloatField ReadChosenCells(
  vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise, Need need, Components components)
{
  return Read(image, ChoiceOf(filter, index, otherwise), need, components);
}

MediumInput ReadMedium(vtkAlgorithm* filter, vtkImageData* image)
{
  MediumInput input;
  input.medium.grid = GridOf(image);
  input.sigma_a = ReadChosenCells(filter, SigmaA, image, "sigma_a", Need::Required, { 1, 3 });
  input.sigma_s = ReadChosenCells(filter, SigmaS, image, "sigma_s", Need::Required, { 1, 3 });
  input.emission = ReadChosenCells(filter, Emission, image, "emission", Need::Optional, { 1, 3 });
  input.medium.sigma_a = input.sigma_a;
  input.medium.sigma_s = input.sigma_s;
  input.medium.emission = input.emission;
  input.medium.g = ReadFact(image, "g", 0.0);
  Check(input.medium);
  return input;
}

double ReadFact(vtkDataObject* data, const char* name, double missing)
{
  vtkAbstractArray* found = data->GetFieldData()->GetAbstractArray(name);
  if (!found)
  {
    return missing;
  }
  auto* numbers = vtkArrayDownCast<vtkDataArray>(found);
  if (!numbers || numbers->GetNumberOfValues() != 1)
  {
    throw InvalidInput("The field data " + Quoted(name) + " must be one number.");
  }
  return numbers->GetTuple1(0);
}

namespace
{
/// A row of an array, zeros where the array is not there; of fewer components the first one repeated.
template <std::size_t N>
std::array<double, N> Row(vtkDataArray* array, vtkIdType row)
{
  std::array<double, N> values = {};
  for (std::size_t c = 0; array && c < N; ++c)
  {
    values[c] = array->GetComponent(row, std::min(static_cast<int>(c), array->GetNumberOfComponents() - 1));
  }
  return values;
}

vtkDataArray* LightArray(vtkPolyData* lights, const char* name, Need need, Components components)
{
  vtkDataArray* array = lights->GetPointData()->GetArray(name);
  if (array)
  {
    CheckShape(array, name, lights->GetNumberOfPoints(), components);
  }
  else if (need == Need::Required)
  {
    throw InvalidInput("The lights have no point array " + Quoted(name) +
      ". Their point arrays: " + NamesOf(lights->GetPointData()) + ". Make lights with LightRig.");
  }
  return array;
}

LightType TypeOf(double number, vtkIdType light)
{
  if (number != 0.0 && number != 1.0 && number != 2.0 && number != 3.0)
  {
    throw InvalidInput("Light " + std::to_string(light) + " has light_type " + std::to_string(number) +
      "; it must be 0 (directional), 1 (point), 2 (spot) or 3 (rectangle).");
  }
  return static_cast<LightType>(static_cast<int>(number));
}
}

std::vector<Light> ReadLights(vtkPolyData* data)
{
  if (!data)
  {
    return {};
  }
  if (data->GetNumberOfPoints() == 0)
  {
    StopWithFilterBefore(data);
    return {};
  }
  vtkDataArray* type = LightArray(data, "light_type", Need::Required, { 1 });
  vtkDataArray* power = LightArray(data, "power", Need::Required, { 1, 3 });
  vtkDataArray* direction = LightArray(data, "direction", Need::Optional, { 3 });
  vtkDataArray* size = LightArray(data, "size", Need::Optional, { 1, 2 });
  vtkDataArray* angle = LightArray(data, "angle", Need::Optional, { 1 });

  Illumination read;
  read.lights.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    Light& light = read.lights[static_cast<std::size_t>(i)];
    light.type = TypeOf(type->GetComponent(i, 0), i);
    data->GetPoint(i, light.position.data());
    light.power = Row<3>(power, i);
    light.direction = Row<3>(direction, i);
    light.size = Row<2>(size, i);
    light.angle = Row<1>(angle, i)[0];
  }
  Check(read);
  return read.lights;
}

Environment ReadEnvironment(vtkImageData* image)
{
  if (!image)
  {
    return {};
  }
  int size[3];
  image->GetDimensions(size);
  if (image->GetNumberOfPoints() == 0)
  {
    StopWithFilterBefore(image);
  }
  if (size[0] < 1 || size[1] < 1 || size[2] != 1)
  {
    throw InvalidInput("The environment has " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
      std::to_string(size[2]) +
      " points; it must be a flat latitude-longitude picture, as EnvironmentReader makes it.");
  }
  vtkDataArray* found = image->GetPointData()->GetArray("radiance");
  if (!found)
  {
    throw InvalidInput(
      "The environment has no point array 'radiance'. Its point arrays: " + NamesOf(image->GetPointData()) + ".");
  }
  CheckShape(found, "radiance", image->GetNumberOfPoints(), { 1, 3 });
  const vtkSmartPointer<vtkFloatArray> radiance = AsFloats(found);
  const int components = radiance->GetNumberOfComponents();
  const float* values = radiance->GetPointer(0);

  Illumination read;
  read.environment.width = size[0];
  read.environment.height = size[1];
  read.environment.radiance.resize(3 * static_cast<std::size_t>(image->GetNumberOfPoints()));
  for (std::size_t i = 0; i < read.environment.radiance.size(); ++i)
  {
    read.environment.radiance[i] = components == 3 ? values[i] : values[i / 3];
  }
  Check(read);
  return std::move(read.environment);
}

void AddDiffuse(Illumination& illumination, const double* sky, const double* faceRadiance)
{
  std::copy_n(sky, 3, illumination.sky.begin());
  for (int face = 0; face < 6; ++face)
  {
    illumination.faces[face].fill(faceRadiance[face]);
  }
  Check(illumination);
}

namespace
{
/// A vtkFloatArray, to the last bit of its name, whose first values live in a vector.
class VectorArray : public vtkFloatArray
{
public:
  static VectorArray* New() { VTK_STANDARD_NEW_BODY(VectorArray); }

  void Take(std::vector<float>&& values)
  {
    this->Values = std::move(values);
    this->SetArray(this->Values.data(), static_cast<vtkIdType>(this->Values.size()), 1);
  }

private:
  std::vector<float> Values;
};

void NameComponents(vtkDataArray* array)
{
  const char* const names[] = { "R", "G", "B" };
  for (int c = 0; c < array->GetNumberOfComponents(); ++c)
  {
    array->SetComponentName(c, names[c]);
  }
}

void NameFluxComponents(vtkDataArray* array)
{
  const char* const grey[] = { "X", "Y", "Z" };
  const char* const coloured[] = { "R_X", "R_Y", "R_Z", "G_X", "G_Y", "G_Z", "B_X", "B_Y", "B_Z" };
  const int count = array->GetNumberOfComponents();
  for (int c = 0; c < count; ++c)
  {
    array->SetComponentName(c, count == 3 ? grey[c] : coloured[c]);
  }
}

std::vector<double> Channels(std::initializer_list<Rgb> rows, int channels)
{
  std::vector<double> values;
  for (const Rgb& row : rows)
  {
    values.insert(values.end(), row.begin(), row.begin() + channels);
  }
  return values;
}

std::vector<double> Flat(const std::vector<std::array<double, 3>>& directions)
{
  std::vector<double> values;
  for (const std::array<double, 3>& direction : directions)
  {
    values.insert(values.end(), direction.begin(), direction.end());
  }
  return values;
}

void AddLightCells(vtkImageData* output, const char* name, std::vector<float>&& values, int components)
{
  if (!values.empty())
  {
    AddCells(output, name, std::move(values), components);
  }
}
}

void AddCells(vtkImageData* image, const char* name, std::vector<float>&& values, int components)
{
  const auto needed = static_cast<std::size_t>(image->GetNumberOfCells()) * static_cast<std::size_t>(components);
  if (values.size() != needed)
  {
    throw std::logic_error(std::string(name) + " has " + std::to_string(values.size()) +
      " values where the image takes " + std::to_string(needed) + ".");
  }
  vtkNew<VectorArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->Take(std::move(values));
  image->GetCellData()->AddArray(array);
}

void AddFact(vtkDataObject* data, const char* name, const std::vector<double>& values, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->GetFieldData()->AddArray(array);
}

void AddFact(vtkDataObject* data, const char* name, const std::vector<std::string>& values)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& value : values)
  {
    array->InsertNextValue(value);
  }
  data->GetFieldData()->AddArray(array);
}

std::string Lines(const std::vector<std::string>& texts)
{
  std::string lines;
  for (const std::string& text : texts)
  {
    lines += (lines.empty() ? "" : "\n") + text;
  }
  return lines;
}

void WriteLight(LightField&& light, vtkImageData* output)
{
  const int channels = light.channels;
  vtkCellData* cells = output->GetCellData();
  for (const char* earlier :
    { "fluence", "fluence_direct", "fluence_error", "net_flux", "scattered_radiance", "mean_direction" })
  {
    cells->RemoveArray(earlier); // of another solve that the input has been through
  }
  output->GetFieldData()->RemoveArray("stored_directions");
  AddCells(output, "fluence", std::move(light.fluence), channels);
  cells->SetActiveScalars("fluence");
  AddLightCells(output, "fluence_direct", std::move(light.fluenceDirect), channels);
  AddLightCells(output, "net_flux", std::move(light.netFlux), 3 * channels);
  const int stored = std::max(1, static_cast<int>(light.storedDirections.size()));
  AddLightCells(output, "scattered_radiance", std::move(light.scatteredRadiance), channels * stored);
  if (channels == 3)
  {
    for (const char* name : { "fluence", "fluence_direct" })
    {
      if (vtkDataArray* array = cells->GetArray(name))
      {
        NameComponents(array);
      }
    }
  }
  if (vtkDataArray* flux = cells->GetArray("net_flux"))
  {
    NameFluxComponents(flux);
  }

  const EnergyBalance& balance = light.balance;
  AddFact(output, "energy_balance",
    Channels({ balance.entered, balance.emitted, balance.absorbed, balance.escaped, balance.leftOver }, channels),
    channels);
  const std::array<Rgb, 6>& out = light.facePowerOut;
  AddFact(output, "face_power_out", Channels({ out[0], out[1], out[2], out[3], out[4], out[5] }, channels), channels);
  if (!light.storedDirections.empty())
  {
    AddFact(output, "stored_directions", Flat(light.storedDirections), 3);
  }
  AddFact(output, "left_out", light.leftOut);
  AddFact(output, "device", std::vector<std::string>{ light.device });
}

void WriteConvergence(const std::vector<ConvergenceRow>& rows, vtkTable* table)
{
  vtkNew<vtkIntArray> iteration;
  iteration->SetName("iteration");
  for (const ConvergenceRow& row : rows)
  {
    iteration->InsertNextValue(row.iteration);
  }
  table->AddColumn(iteration);

  const auto column = [&](const char* name, double ConvergenceRow::*quantity) {
    vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    for (const ConvergenceRow& row : rows)
    {
      values->InsertNextValue(row.*quantity);
    }
    table->AddColumn(values);
  };
  column("seconds", &ConvergenceRow::seconds);
  column("residual", &ConvergenceRow::residual);
  column("absorbed", &ConvergenceRow::absorbed);
  column("escaped", &ConvergenceRow::escaped);
  column("left_over", &ConvergenceRow::leftOver);
}

void PassOn(vtkImageData* input, vtkImageData* output)
{
  output->ShallowCopy(input);
  vtkNew<vtkFieldData> own;
  own->ShallowCopy(input->GetFieldData());
  output->SetFieldData(own);
}

Monitor MonitorOf(vtkAlgorithm* filter)
{
  return [filter](double fractionDone) {
    filter->UpdateProgress(fractionDone);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
    return !filter->CheckAbort();
#else
    return filter->GetAbortExecute() == 0;
#endif
  };
}

namespace
{
void EmptyOutputs(vtkInformationVector* outputs, const char* why)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
      AddFact(output, why, std::vector<double>{ 1.0 });
    }
  }
}

/// Newer VTK leaves both set, and would run the filter again with every update until they are reset.
void ForgetAbort(vtkAlgorithm* filter)
{
  filter->AbortExecute = 0;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  filter->SetAbortOutput(false);
#endif
}
}

int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work)
{
  LastFailure last(filter);
  if (last.StillHolds())
  {
    EmptyOutputs(outputs, last.Was(LastFailure::Abort) ? AbortedFact : FailedFact);
    return 1;
  }
  last.Forget();
  const auto fail = [&](const std::string& why) {
    EmptyOutputs(outputs, FailedFact);
    vtkErrorWithObjectMacro(filter, << why);
    last.Note(LastFailure::Error);
  };
  try
  {
    work();
  }
  catch (const Aborted&)
  {
    EmptyOutputs(outputs, AbortedFact);
    ForgetAbort(filter);
    last.Note(LastFailure::Abort);
  }
  catch (const InputFailed&)
  {
    EmptyOutputs(outputs, FailedFact);
    last.Note(LastFailure::Error);
  }
  catch (const cl::Error& error)
  {
    fail(std::string("The OpenCL device failed in ") + error.what() + " (OpenCL error " + std::to_string(error.err()) +
      "). Try another device (property Device or variable TYNDALL_DEVICE).");
  }
  catch (const std::bad_alloc&)
  {
    fail("The machine's memory does not suffice. Use a smaller grid, or ask for fewer outputs.");
  }
  catch (const std::exception& error)
  {
    fail(error.what());
  }
  return 1;
}

bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work)
{
  LastFailure last(filter);
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    if (!last.Was(LastFailure::Information) || !last.StillHolds())
    {
      vtkErrorWithObjectMacro(filter, << error.what());
    }
    last.Note(LastFailure::Information);
    return false;
  }
  if (last.Was(LastFailure::Information))
  {
    last.Forget();
  }
  return true;
}
}
