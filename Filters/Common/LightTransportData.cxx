#include "Common/LightTransportData.h"

#include "Common/Failure.h"
#include "Common/ImageInput.h"
#include "Common/PhaseFunctionData.h"
#include "Distribution/Domain.h"
#include "Distribution/SharedMedium.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <utility>

namespace tyndall
{
Quantities QuantitiesOfMedium()
{
  return { { SigmaA, "sigma_a" }, { SigmaS, "sigma_s" }, { Emission, "emission" }, { RefractiveIndex, "ior" } };
}

std::vector<std::string> IgnoredIndex(bool isUnusual)
{
  return isUnusual ? std::vector<std::string>{ "ior (light goes straight on, as if it were 1 everywhere; PhotonMarcher "
                                               "knows it, with MaximumOrders 0 for scattered light too, and so does "
                                               "LatticeBoltzmannLighting by its conservative scheme where light is "
                                               "diffuse)" }
                   : std::vector<std::string>();
}

std::vector<std::string> IgnoredEmission(bool isUnusual)
{
  return isUnusual
    ? std::vector<std::string>{ "emission (photons carry the light of lights alone; LightPropagationMaps, "
                                "DiscreteOrdinates and LatticeBoltzmannLighting know it)" }
    : std::vector<std::string>();
}

std::string WarningOf(const std::vector<std::string>& ignored)
{
  std::string words;
  for (const std::string& text : ignored)
  {
    words += (words.empty() ? "" : ", and ") + text;
  }
  return words.empty() ? words : "The light does not depend on the medium's " + words + ".";
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
  input.g = ReadMeanCosines(image, input.sigma_s);
  input.medium.phase = ReadPhase(image, input.g, input.sigma_s);
  Check(input.medium);
  return input;
}

MediumInput ReadMedium(vtkAlgorithm* filter, const Domain& domain, vtkImageData* own)
{
  MediumInput input;
  domain.Collective([&] { input = own || domain.IsSerial() ? ReadMedium(filter, own) : input; });
  if (!domain.IsSerial())
  {
    AgreeOnMeanCosine(domain.Comm(), own != nullptr, input.g, input.medium);
  }
  return input;
}

MomentsInput ReadMoments(vtkImageData* image)
{
  MomentsInput input;
  vtkDataArray* const lamps = image->GetFieldData()->GetArray(LampsApartFact);
  if (!image->GetCellData()->GetArray(MomentsArray) || !image->GetCellData()->GetArray(StraightOnArray) || !lamps)
  {
    return input;
  }
  if (lamps->GetNumberOfComponents() != LampComponents)
  {
    throw InvalidInput("The field data '" + std::string(LampsApartFact) + "' has " +
      std::to_string(lamps->GetNumberOfComponents()) + " numbers a lamp; it must have " +
      std::to_string(LampComponents) + ", as solvers write it.");
  }
  input.moments = ReadCells(image, MomentsArray, Need::Required, {});
  input.straightOn = ReadCells(image, StraightOnArray, Need::Required);
  for (vtkIdType row = 0; row < lamps->GetNumberOfTuples(); ++row)
  {
    double v[LampComponents];
    lamps->GetTuple(row, v);
    Light lamp;
    lamp.type = static_cast<LightType>(static_cast<int>(v[0]));
    lamp.position = { v[1], v[2], v[3] };
    lamp.direction = { v[4], v[5], v[6] };
    lamp.power = { v[7], v[8], v[9] };
    lamp.size = { v[10], v[11] };
    lamp.angle = v[12];
    input.lampsApart.push_back(lamp);
  }
  Illumination all;
  all.lights = input.lampsApart;
  Check(all);
  return input;
}

namespace
{
/// Net power that escapes through the faces -x, +x, -y, +y, -z, +z, W, from field data `face_power_out`; 0 if missing.
std::array<Rgb, 6> FacePowersOf(vtkDataObject* data)
{
  std::array<Rgb, 6> powers = {};
  auto* const found = vtkArrayDownCast<vtkDataArray>(data->GetFieldData()->GetAbstractArray("face_power_out"));
  if (found)
  {
    CheckShape(found, "face_power_out", 6, { 1, 3 });
  }
  for (int face = 0; found && face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      powers[face][c] = found->GetComponent(face, found->GetNumberOfComponents() == 3 ? c : 0);
    }
  }
  return powers;
}
}

UncollidedInput ReadUncollided(vtkImageData* image, const Grid& medium)
{
  CheckSameVoxels(GridOf(image), medium, "UncollidedLight",
    "March the photons through the same medium, or resample their light to its voxels.");
  Require(!(ReadFact(image, ScatteringsFact, 0.0) > 0.0),
    "UncollidedLight holds scattered light of photons, too: its mean_direction and face_power_out are of "
    "all of it. Take PhotonMarcher with MaximumOrders 1.");
  UncollidedInput input;
  input.fluence = ReadCells(image, "fluence_direct", Need::Required, { 1, 3 });
  input.meanDirection = ReadCells(image, "mean_direction", Need::Optional, { 3 });
  input.image.fluence = input.fluence;
  input.image.meanDirection = input.meanDirection;
  input.image.escaped = FacePowersOf(image);
  return input;
}

namespace
{
/// Tuple number `row` of an array; zeros if the array is missing. Missing components repeat the last one.
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
    throw InvalidInput("The lights have no point array '" + std::string(name) + "'" +
      ". Their point arrays: " + NamesOf(lights->GetPointData()) + ". Make lights with LightRig.");
  }
  return array;
}

LightType TypeOf(double number, vtkIdType light)
{
  if (number != 0.0 && number != 1.0 && number != 2.0 && number != 3.0)
  {
    throw InvalidInput("Light " + std::to_string(light) + " has light_type " + Text("%g", number) +
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
    StopIfUpstreamFailed(data);
    return {};
  }
  vtkDataArray* type = LightArray(data, "light_type", Need::Required, { 1 });
  vtkDataArray* power = LightArray(data, "power", Need::Required, { 1, 3 });
  vtkDataArray* direction = LightArray(data, "direction", Need::Optional, { 3 });
  vtkDataArray* size = LightArray(data, "size", Need::Optional, { 1, 2 });
  vtkDataArray* angle = LightArray(data, "angle", Need::Optional, { 1 });

  Illumination read;
  for (const vtkIdType i : PointsThatCount(data))
  {
    read.lights.emplace_back();
    Light& light = read.lights.back();
    light.type = TypeOf(type->GetComponent(i, 0), i);
    data->GetPoint(i, light.position.data());
    light.power = Row<3>(power, i);
    light.direction = Row<3>(direction, i);
    light.size = Row<2>(size, i);
    light.angle = light.type == LightType::Rectangle ? 0.0 : Row<1>(angle, i)[0];
  }
  Check(read);
  return read.lights;
}

std::vector<Light> InOwnAxes(std::vector<Light> lights, const OwnAxes& axes)
{
  for (Light& light : lights)
  {
    if (axes.AreThoseOfScene())
    {
      break;
    }
    const std::array<double, 3> edge = axes.Way(RectangleEdges(light)[0]);
    light.position = axes.Place(light.position);
    light.direction = axes.Way(light.direction);
    if (light.type == LightType::Rectangle)
    {
      light.angle = 0.0;
      const auto [level, steep] = RectangleEdges(light);
      const auto along = [&](const std::array<double, 3>& other, double length) {
        return (edge[0] * other[0] + edge[1] * other[1] + edge[2] * other[2]) / length;
      };
      light.angle = std::atan2(along(steep, light.size[1]), along(level, light.size[0])) * 180.0 / Pi;
    }
  }
  return lights;
}

Illumination InOwnAxes(Illumination illumination, const OwnAxes& axes)
{
  if (!axes.AreThoseOfScene())
  {
    illumination.lights = InOwnAxes(std::move(illumination.lights), axes);
    illumination.environment = Turned(illumination.environment, axes.axes);
  }
  return illumination;
}

namespace
{
/// Sets hidden pixels (vtkGhostType) to black.
void DarkenHidden(vtkImageData* image, std::vector<float>& rgb)
{
  vtkUnsignedCharArray* const flags = image->GetPointGhostArray();
  for (vtkIdType i = 0; flags && i < image->GetNumberOfPoints(); ++i)
  {
    if (flags->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT)
    {
      std::fill_n(rgb.begin() + 3 * i, 3, 0.0f);
    }
  }
}
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
    StopIfUpstreamFailed(image);
  }
  if (size[0] < 1 || size[1] < 1 || size[2] != 1)
  {
    throw InvalidInput("The environment has " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
      std::to_string(size[2]) +
      " points; it must be a flat latitude-longitude picture, as EnvironmentReader makes it.");
  }
  vtkDataArray* found = image->GetPointData()->GetArray("radiance");
  Require(
    found, "The environment has no point array 'radiance'. Its point arrays: " + NamesOf(image->GetPointData()) + ".");
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
  DarkenHidden(image, read.environment.radiance);
  Check(read);
  return std::move(read.environment);
}

bool MediumInput::Emits() const
{
  const std::size_t count = this->medium.grid.VoxelCount() * static_cast<std::size_t>(this->emission.Components());
  const float* const values = this->emission.Values();
  return values && std::any_of(values, values + count, [](float value) { return value > 0.0f; });
}

bool NothingShines(const Illumination& illumination)
{
  return illumination.lights.empty() && illumination.environment.Empty() && IsBlack(illumination.sky) &&
    std::all_of(illumination.faces.begin(), illumination.faces.end(), IsBlack);
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

void AddFaceAlbedo(Illumination& illumination, const double* albedo, const double* colour)
{
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      illumination.faceAlbedo[face][c] = albedo[face] * colour[3 * face + c];
    }
  }
  Check(illumination);
}
}
