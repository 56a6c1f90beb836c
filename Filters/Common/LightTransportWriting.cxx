#include "Common/LightTransportWriting.h"

#include "Common/PropertyRange.h"
#include "Device/Errors.h"
#include "Medium/BoxFaces.h"
#include "Medium/Medium.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Names the components of a colour array R, G, B.
void NameChannels(vtkDataArray* array)
{
  const char* const names[] = { "R", "G", "B" };
  for (int c = 0; c < 3 && array->GetNumberOfComponents() == 3; ++c)
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

vtkNew<vtkDoubleArray> LightArray(const char* name, std::initializer_list<const char*> components, std::size_t tuples)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(components.size()));
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  int component = 0;
  for (const char* componentName : components)
  {
    if (componentName[0] != '\0')
    {
      array->SetComponentName(component, componentName);
    }
    ++component;
  }
  return array;
}

/// Makes a cell array for an image without adding it.
vtkSmartPointer<vtkFloatArray> CellArray(
  vtkImageData* image, const char* name, std::vector<float>&& values, int components)
{
  const auto needed = static_cast<std::size_t>(image->GetNumberOfCells()) * static_cast<std::size_t>(components);
  if (values.size() != needed)
  {
    throw std::logic_error(std::string(name) + " has " + std::to_string(values.size()) +
      " values where the image takes " + std::to_string(needed) + ".");
  }
  return ArrayOf<vtkFloatArray>(name, std::move(values), components);
}

using NameComponents = void (*)(vtkDataArray*);

void AddNamedCells(vtkImageData* image, const char* name, std::vector<float>&& values, int components,
  NameComponents nameComponents, const char* advice = nullptr)
{
  const ArrayRanges ranges = RequireFiniteCells(image, name, values.data(), values.size(), components, advice);
  const vtkSmartPointer<vtkFloatArray> array = CellArray(image, name, std::move(values), components);
  nameComponents(array);
  LeaveRanges(ranges, array);
  image->GetCellData()->AddArray(array);
}
}

void AddCells(vtkImageData* image, const char* name, std::vector<float>&& values, int components, const char* advice)
{
  AddNamedCells(
    image, name, std::move(values), components, [](vtkDataArray*) {}, advice);
}

void AddLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels)
{
  AddNamedCells(image, name, std::move(values), channels, NameChannels);
}

void AddSameLight(vtkImageData* image, const char* name, const char* as)
{
  vtkDataArray* const light = image->GetCellData()->GetArray(as);
  vtkNew<vtkFloatArray> array;
  array->ShallowCopy(light);
  array->SetName(name);
  NameChannels(array);
  LeaveSameRanges(light, array);
  image->GetCellData()->AddArray(array);
}

void AddGivenLight(vtkImageData* image, const char* name, std::vector<float>&& values, int channels)
{
  const vtkSmartPointer<vtkFloatArray> array = CellArray(image, name, std::move(values), channels);
  NameChannels(array);
  LeaveRanges(array);
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

void AddFact(vtkDataObject* data, const char* name, const std::vector<std::array<double, 3>>& vectors)
{
  std::vector<double> values;
  for (const std::array<double, 3>& vector : vectors)
  {
    values.insert(values.end(), vector.begin(), vector.end());
  }
  AddFact(data, name, values, 3);
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

void TellLeftOut(vtkAlgorithm* filter, vtkDataObject* output, const std::vector<std::string>& texts)
{
  AddFact(output, "left_out", texts);
  NoteLeftOut(filter, Lines(texts));
}

namespace
{
/// Writes the angular moments; moves them out of `light`.
void WriteMoments(LightField& light, vtkImageData* output)
{
  const auto voxels = static_cast<std::size_t>(output->GetNumberOfCells());
  if (light.scatteredMoments.empty())
  {
    return;
  }
  const int components = static_cast<int>(light.scatteredMoments.size() / voxels);
  AddCells(output, MomentsArray, std::move(light.scatteredMoments), components);
  const int channels = static_cast<int>(light.straightOn.size() / voxels);
  AddCells(output, StraightOnArray, std::move(light.straightOn), channels);
  std::vector<double> lamps;
  for (const Light& lamp : light.lampsApart)
  {
    lamps.push_back(static_cast<double>(lamp.type));
    for (const std::array<double, 3>& triple : { lamp.position, lamp.direction, lamp.power })
    {
      lamps.insert(lamps.end(), triple.begin(), triple.end());
    }
    lamps.insert(lamps.end(), { lamp.size[0], lamp.size[1], lamp.angle });
  }
  AddFact(output, LampsApartFact, lamps, LampComponents);
}
}

namespace
{
/// Removes light that an earlier solver in the pipeline added to the input.
void RemoveLight(vtkImageData* output)
{
  for (const char* array :
    { "fluence", "fluence_direct", FluenceErrorArray, "fluence_batches", "net_flux", "scattered_radiance",
      "mean_direction", "photon_count", "photon_weight", "mip_level", MomentsArray, StraightOnArray, LitColorArray })
  {
    output->GetCellData()->RemoveArray(array);
  }
  for (const char* fact : { "stored_directions", "scattered", "packing_loss", "fluence_bias", "half_range_flux",
         "settings_used", IgnoredFact, LampsApartFact, LitColorDistanceFact, LitColorExposureFact })
  {
    output->GetFieldData()->RemoveArray(fact);
  }
  for (const char* fact : FaceFacts)
  {
    output->GetFieldData()->RemoveArray(fact);
  }
}

/// Writes the field data that describe the light.
void WriteFacts(const LightField& light, vtkImageData* output)
{
  const int channels = light.channels;
  const EnergyBalance& balance = light.balance;
  AddFact(output, "energy_balance",
    Channels({ balance.entered, balance.emitted, balance.absorbed, balance.escaped, balance.leftOver }, channels),
    channels);
  const std::array<Rgb, 6>& out = light.facePowerOut;
  AddFact(output, "face_power_out", Channels({ out[0], out[1], out[2], out[3], out[4], out[5] }, channels), channels);
  if (const Rgb& flux = light.halfRangeFlux; flux[0] > 0.0)
  {
    const bool one = channels == 1 || (flux[1] == flux[0] && flux[2] == flux[0]);
    AddFact(output, "half_range_flux", Channels({ flux }, one ? 1 : 3), one ? 1 : 3);
  }
  if (!light.storedDirections.empty())
  {
    AddFact(output, "stored_directions", light.storedDirections);
  }
  if (!light.surfaceRadiance.empty())
  {
    AddFact(output, SurfaceRadianceFact, { light.surfaceRadiance.begin(), light.surfaceRadiance.end() },
      static_cast<int>(SurfaceCosines.size()) * channels);
  }
  if (!light.surfaceError.empty())
  {
    AddFact(output, SurfaceErrorFact, { light.surfaceError.begin(), light.surfaceError.end() },
      static_cast<int>(SurfaceCosines.size()) * channels);
  }
  if (light.errorLength > 0.0)
  {
    AddFact(output, ErrorLengthFact, std::vector<double>{ light.errorLength }, 1);
  }
  if (!light.facePower.empty())
  {
    AddFact(output, FacePowerFact, { light.facePower.begin(), light.facePower.end() }, channels);
    const std::array<Rgb, 6>& back = light.faceAlbedo;
    AddFact(output, FaceAlbedoFact, Channels({ back[0], back[1], back[2], back[3], back[4], back[5] }, 3), 3);
  }
  AddFact(output, "left_out", light.leftOut);
  if (!light.settingsUsed.empty())
  {
    AddFact(output, "settings_used", light.settingsUsed);
  }
  AddFact(output, "device", std::vector<std::string>{ light.device });
}
}

void WriteLight(LightField&& light, vtkImageData* output)
{
  const int channels = light.channels;
  RemoveLight(output);
  const auto add = [&](const char* name, std::vector<float>& values, int components, NameComponents nameComponents) {
    if (!values.empty())
    {
      AddNamedCells(output, name, std::move(values), components, nameComponents);
    }
  };
  AddLight(output, "fluence", std::move(light.fluence), channels);
  output->GetCellData()->SetActiveScalars("fluence");
  const int stored = std::max(1, static_cast<int>(light.storedDirections.size()));
  add("fluence_direct", light.fluenceDirect, channels, NameChannels);
  add(FluenceErrorArray, light.fluenceError, channels, NameChannels);
  add("net_flux", light.netFlux, 3 * channels, NameFluxComponents);
  add("scattered_radiance", light.scatteredRadiance, channels * stored, [](vtkDataArray*) {});
  WriteMoments(light, output);
  WriteFacts(light, output);
}

void WriteLitColor(LitColor&& lit, vtkImageData* output)
{
  const auto array = ArrayOf<vtkUnsignedCharArray>(LitColorArray, std::move(lit.rgba), 4);
  const char* const names[] = { "R", "G", "B", "A" };
  for (int c = 0; c < 4; ++c)
  {
    array->SetComponentName(c, names[c]);
  }
  LeaveRanges(array);
  output->GetCellData()->AddArray(array);
  AddFact(output, LitColorDistanceFact, std::vector<double>{ lit.distance });
  AddFact(output, LitColorExposureFact, std::vector<double>{ lit.exposure });
}

void WriteConvergence(const std::vector<ConvergenceRow>& rows, const std::vector<int>& sweepsSaved, vtkTable* table)
{
  table->Initialize(); // without this, ParaView would keep the rows of an earlier update on a rank without voxels
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
  column("change", &ConvergenceRow::change);
  column("absorbed", &ConvergenceRow::absorbed);
  column("escaped", &ConvergenceRow::escaped);
  column("left_over", &ConvergenceRow::leftOver);
  if (!sweepsSaved.empty())
  {
    vtkNew<vtkIntArray> saved;
    saved->SetName("sweeps_saved");
    for (int sweeps : sweepsSaved)
    {
      saved->InsertNextValue(sweeps);
    }
    table->AddColumn(saved);
  }
}

void WriteLights(const std::vector<Light>& lights, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkUnsignedCharArray> type;
  type->SetName("light_type");
  type->SetNumberOfTuples(static_cast<vtkIdType>(lights.size()));
  const auto direction = LightArray("direction", { "X", "Y", "Z" }, lights.size());
  const auto power = LightArray("power", { "R", "G", "B" }, lights.size());
  const auto size = LightArray("size", { "width", "height" }, lights.size());
  const auto angle = LightArray("angle", { "" }, lights.size());

  for (const Light& light : lights)
  {
    const vtkIdType id = points->InsertNextPoint(light.position.data());
    vertices->InsertNextCell(1, &id);
    type->SetValue(id, static_cast<unsigned char>(light.type));
    direction->SetTuple(id, light.direction.data());
    power->SetTuple(id, light.power.data());
    size->SetTuple(id, light.size.data());
    angle->SetValue(id, light.angle);
  }

  output->SetPoints(points);
  output->SetVerts(vertices);
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{ type, direction, power, size, angle })
  {
    output->GetPointData()->AddArray(array);
  }
}

void PassOn(vtkDataObject* input, vtkDataObject* output)
{
  output->ShallowCopy(input);
  vtkNew<vtkFieldData> own;
  own->ShallowCopy(input->GetFieldData());
  output->SetFieldData(own);
}

namespace
{
constexpr const char* UsualAdvice =
  "Something is beyond what floats carry (3.4e+38): give lights, sky and emission less power (light is in proportion "
  "to it), "
  "the medium smaller coefficients, or choose a unit of length in which voxels are neither tiny nor huge.";

}

ArrayRanges RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice)
{
  ArrayRanges ranges = RangesOf(values, count, components);
  const std::size_t first = ranges.firstNotFinite;
  if (first == count)
  {
    return ranges;
  }
  const std::string where = place(first / static_cast<std::size_t>(components));
  const std::string value = std::isnan(values[first]) ? "not a number"
    : values[first] > 0.0f                            ? "infinite"
                                                      : "-infinite";
  throw InvalidInput("The output's '" + std::string(array) + "' would be " + value + " in " + where +
    " (the first such one), so there is no output. " + (advice ? advice : UsualAdvice));
}

ArrayRanges RequireFiniteCells(
  vtkImageData* image, const char* array, const float* values, std::size_t count, int components, const char* advice)
{
  Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = std::max(image->GetDimensions()[axis] - 1, 1);
  }
  return RequireFinite(
    array, values, count, components, [&](std::size_t voxel) { return "voxel " + VoxelName(grid, voxel); }, advice);
}
}
