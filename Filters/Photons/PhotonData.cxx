#include "Photons/PhotonData.h"

#include "Common/Failure.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Device/HostThreads.h"
#include "Distribution/Communicator.h"
#include "Numerics/NumberText.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
vtkDataArray* PhotonArray(vtkPolyData* photons, const char* name, Need need, Components components)
{
  vtkDataArray* array = photons->GetPointData()->GetArray(name);
  if (!array)
  {
    if (need == Need::Optional && !photons->GetPointData()->HasArray(name))
    {
      return nullptr;
    }
    throw InvalidInput("The photons have no point array '" + std::string(name) + "'. Make photons with PhotonEmitter.");
  }
  const int given = array->GetNumberOfComponents();
  if (std::find(components.begin(), components.end(), given) == components.end())
  {
    throw InvalidInput("The photons' array '" + std::string(name) + "' has " + std::to_string(given) + " components; " +
      (components.size() > 1 ? "1 or 3" : std::to_string(*components.begin())) + " are needed.");
  }
  return array;
}

std::int32_t BatchOf(double number, vtkIdType photon)
{
  if (!(number >= 0.0 && number < MarchedBatchesAtMost) || number != std::floor(number))
  {
    throw InvalidInput("Photon " + std::to_string(photon) + " has batch " + Text("%g", number) +
      "; it must be a whole number of 0 to 63, as PhotonEmitter makes it.");
  }
  return static_cast<std::int32_t>(number);
}

template <class Array>
vtkSmartPointer<Array> NewArray(const char* name, int components, std::size_t tuples)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  return array;
}

constexpr std::size_t PhotonsOfThread = 8192; ///< smallest number of photons that one host thread converts
constexpr const char* BoxName = "photon_box";
constexpr double SameBox = 1e-6; ///< tolerance for equal bounds of two boxes, relative to the box's longest edge

using Box = std::array<double, 6>;

Box BoxOf(const Grid& grid)
{
  Box box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box[2 * axis] = grid.origin[axis];
    box[2 * axis + 1] = grid.origin[axis] + grid.Length(axis);
  }
  return box;
}

std::string Described(const Box& box)
{
  const auto number = [](double value) { return Text("%.9g", value); };
  return "x from " + number(box[0]) + " to " + number(box[1]) + ", y from " + number(box[2]) + " to " + number(box[3]) +
    ", z from " + number(box[4]) + " to " + number(box[5]);
}
}

namespace
{
template <class Turn>
std::array<float, 3> Turned(const std::array<float, 3>& direction, const Turn& turn)
{
  const std::array<double, 3> way = turn(std::array<double, 3>{ direction[0], direction[1], direction[2] });
  return { static_cast<float>(way[0]), static_cast<float>(way[1]), static_cast<float>(way[2]) };
}

/// Points whose bounds are computed in parallel, by FindBounds from the ranges of LeaveRanges; VTK would compute the
/// bounds on one core.
class BoundedPoints : public vtkPoints
{
public:
  static BoundedPoints* New() { VTK_STANDARD_NEW_BODY(BoundedPoints); }

  /// Sets the bounds. To be called when all points have been written.
  void FindBounds()
  {
    LeaveRanges(this->Data);
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Data->GetRange(this->Bounds + 2 * axis, axis);
    }
    this->ComputeTime.Modified();
  }
};
}

std::string DoubtOfBox(vtkPolyData* photons, const Grid& medium)
{
  vtkDataArray* const found = photons ? photons->GetFieldData()->GetArray(BoxName) : nullptr;
  if (!found || found->GetNumberOfValues() != 6)
  {
    return {}; // photons without `photon_box` are accepted; ReadPhotons throws for an invalid `photon_box`
  }
  Box made;
  const Box box = BoxOf(medium);
  bool same = true;
  const double tolerance = SameBox * std::max({ medium.Length(0), medium.Length(1), medium.Length(2) });
  for (int i = 0; i < 6; ++i)
  {
    made[i] = found->GetVariantValue(i).ToDouble();
    same = same && std::abs(made[i] - box[i]) <= tolerance;
  }
  return same ? ""
              : "The photons were made for the box " + Described(made) + ", the medium fills the box " +
      Described(box) + ": where they differ, light is missing or too much. Give PhotonEmitter the same medium.";
}

void WritePhotons(const EmittedPhotons& emitted, const Grid& box, const OwnAxes& axes, vtkPolyData* output)
{
  const bool turned = !axes.AreThoseOfScene();
  const std::size_t count = emitted.photons.size();
  vtkNew<BoundedPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  const auto direction = NewArray<vtkFloatArray>("direction", 3, count);
  const auto power = NewArray<vtkFloatArray>("power", 3, count);
  const auto weight = NewArray<vtkFloatArray>("weight", 1, count);
  const auto light = NewArray<vtkIntArray>("light", 1, count);
  const auto batch = NewArray<vtkIntArray>("batch", 1, count);
  vtkNew<vtkIdTypeArray> starts, numbers; // offsets and point numbers of the cells: one vertex per photon
  starts->SetNumberOfValues(static_cast<vtkIdType>(count) + 1);
  numbers->SetNumberOfValues(static_cast<vtkIdType>(count));
  starts->SetValue(static_cast<vtkIdType>(count), static_cast<vtkIdType>(count));
  auto* const places = vtkDoubleArray::SafeDownCast(points->GetData());
  InThreads(count, PhotonsOfThread, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<vtkIdType>(begin); i < static_cast<vtkIdType>(end); ++i)
    {
      Photon photon = emitted.photons[static_cast<std::size_t>(i)];
      if (turned)
      {
        photon.position = axes.PlaceInScene(photon.position);
        photon.direction = Turned(photon.direction, [&](const auto& way) { return axes.WayInScene(way); });
      }
      places->SetTypedTuple(i, photon.position.data());
      direction->SetTypedTuple(i, photon.direction.data());
      power->SetTypedTuple(i, photon.power.data());
      weight->SetValue(i, photon.weight);
      light->SetValue(i, emitted.lights[static_cast<std::size_t>(i)]);
      batch->SetValue(i, photon.batch);
      starts->SetValue(i, i);
      numbers->SetValue(i, i);
    }
  });
  vtkNew<vtkCellArray> vertices;
  vertices->SetData(starts, numbers);
  const auto photonName = [](std::size_t photon) { return "photon " + std::to_string(photon); };
  for (vtkFloatArray* array : { direction.Get(), power.Get(), weight.Get() })
  {
    LeaveRanges(RequireFinite(array->GetName(), array->GetPointer(0),
                  static_cast<std::size_t>(array->GetNumberOfValues()), array->GetNumberOfComponents(), photonName),
      array);
  }
  points->FindBounds();
  LeaveRanges(light);
  LeaveRanges(batch);
  const Box bounds = BoxOf(box);
  AddFact(output, BoxName, std::vector<double>(bounds.begin(), bounds.end()));
  output->SetPoints(points);
  output->SetVerts(vertices);
  output->GetPointData()->SetVectors(direction);
  output->GetPointData()->AddArray(power);
  output->GetPointData()->AddArray(weight);
  output->GetPointData()->AddArray(light);
  output->GetPointData()->AddArray(batch);
}

namespace
{
void CheckBoxFact(vtkPolyData* photons)
{
  vtkAbstractArray* const found = photons->GetFieldData()->GetAbstractArray(BoxName);
  if (found && (!vtkArrayDownCast<vtkDataArray>(found) || found->GetNumberOfValues() != 6))
  {
    throw InvalidInput("The photons' field data '" + std::string(BoxName) + "' has " +
      std::to_string(found->GetNumberOfValues()) +
      " values; it must be the six bounds of the box that they were made for, or not be there.");
  }
}
}

std::vector<Photon> ReadPhotons(vtkPolyData* data, const OwnAxes& axes)
{
  const bool turned = !axes.AreThoseOfScene();
  if (!data)
  {
    return {};
  }
  if (data->GetNumberOfPoints() == 0)
  {
    StopIfUpstreamFailed(data);
    return {};
  }
  CheckBoxFact(data);
  const auto direction = AsFloats(PhotonArray(data, "direction", Need::Required, { 3 }));
  const auto power = AsFloats(PhotonArray(data, "power", Need::Required, { 1, 3 }));
  const auto weight = AsFloats(PhotonArray(data, "weight", Need::Optional, { 1 }));
  vtkDataArray* batch = PhotonArray(data, "batch", Need::Optional, { 1 });
  const int colours = power->GetNumberOfComponents();
  const std::vector<long long> points = PointsThatCount(data);
  std::vector<Photon> photons(points.size());
  InThreads(points.size(), PhotonsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at)
    {
      const vtkIdType i = points[at];
      Photon& photon = photons[at];
      data->GetPoint(i, photon.position.data());
      for (int c = 0; c < 3; ++c)
      {
        photon.direction[c] = direction->GetTypedComponent(i, c);
        photon.power[c] = power->GetTypedComponent(i, colours == 3 ? c : 0);
      }
      if (turned)
      {
        photon.position = axes.Place(photon.position);
        photon.direction = Turned(photon.direction, [&](const auto& way) { return axes.Way(way); });
      }
      photon.weight = weight ? weight->GetValue(i) : 1.0f;
      photon.batch = batch ? BatchOf(batch->GetComponent(i, 0), i) : 0;
    }
  });
  return photons;
}

void WritePaths(const std::vector<PhotonPath>& paths, const OwnAxes& axes, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkFloatArray> left;
  left->SetName("power_left");
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName("photon");
  for (const PhotonPath& path : paths)
  {
    lines->InsertNextCell(static_cast<int>(path.points.size()));
    for (std::size_t i = 0; i < path.points.size(); ++i)
    {
      const std::array<double, 3>& place = path.points[i];
      lines->InsertCellPoint(
        points->InsertNextPoint(axes.AreThoseOfScene() ? place.data() : axes.PlaceInScene(place).data()));
      left->InsertNextValue(path.left[i]);
    }
    numbers->InsertNextValue(static_cast<vtkIdType>(path.photon));
  }
  RequireFinite("power_left", left->GetPointer(0), static_cast<std::size_t>(left->GetNumberOfValues()), 1,
    [](std::size_t point) { return "point " + std::to_string(point) + " of the paths"; });
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetPointData()->SetScalars(left);
  output->GetCellData()->AddArray(numbers);
}

std::vector<std::uint8_t> ReadLevels(vtkImageData* image)
{
  const FloatField field = ReadCells(image, "octree_level", Need::Optional, { 1 });
  if (!field.IsThere())
  {
    return {};
  }
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(image->GetNumberOfCells()));
  InThreads(levels.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
    {
      const float level = field.Values()[i];
      if (!(level >= 0.0f && level <= 30.0f) || level != static_cast<float>(static_cast<int>(level)))
      {
        throw InvalidInput("octree_level is " + Text("%g", level) + " in voxel " + VoxelName(GridOf(image), i) +
          "; it must be a whole number, as RefractionOctree makes it.");
      }
      levels[i] = static_cast<std::uint8_t>(level);
    }
  });
  return levels;
}

std::vector<Photon> ShareOfPhotons(Communicator& communicator, vtkPolyData* given, const OwnAxes& axes)
{
  if (communicator.Ranks() == 1)
  {
    return ReadPhotons(given, axes);
  }
  std::vector<Photon> photons;
  std::uint64_t key = 0;
  communicator.Collective([&] {
    photons = ReadPhotons(given, axes);
    key = ContentKeyButFacts(given);
  });
  const double high = static_cast<double>(key >> 32), low = static_cast<double>(key & 0xFFFFFFFFu);
  const std::vector<double> largest = communicator.Largest({ high, -high, low, -low });
  if (largest[0] == -largest[1] && largest[2] == -largest[3])
  {
    const auto ranks = static_cast<std::size_t>(communicator.Ranks()),
               rank = static_cast<std::size_t>(communicator.Rank());
    const auto cut = [&](std::size_t part) {
      return photons.begin() + static_cast<std::ptrdiff_t>(photons.size() * part / ranks);
    };
    return { cut(rank), cut(rank + 1) };
  }
  return photons;
}

namespace
{
constexpr const char* MapName = "importance";
constexpr const char* LightName = "light";
constexpr const char* EvenName = "even";

void SetGrid(vtkImageData* image, const Grid& grid)
{
  image->SetExtent(0, grid.size[0], 0, grid.size[1], 0, grid.size[2]);
  image->SetOrigin(grid.origin.data());
  image->SetSpacing(grid.spacing.data());
  image->SetDirectionMatrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
}

/// Index of the light of each layer of an importance map, from field data `light`: 0, 1, ... in the order of the
/// scene's lights, -1 for the environment or sky, -2 for the box's faces. Without field data `light`, layer k belongs
/// to light k.
/// @throws InvalidInput if `light` has not one light number for each layer
std::vector<int> LightsOf(vtkImageData* image, int layers)
{
  std::vector<int> lights(static_cast<std::size_t>(layers));
  vtkAbstractArray* const found = image->GetFieldData()->GetAbstractArray(LightName);
  auto* const numbers = vtkArrayDownCast<vtkDataArray>(found);
  if (found && (!numbers || numbers->GetNumberOfValues() != layers))
  {
    throw InvalidInput("The importance map has " + std::to_string(layers) + " layers, and its field data 'light' " +
      std::to_string(found->GetNumberOfValues()) + (numbers ? "" : " texts, no") +
      " numbers; it must be the number of each layer's light, as PhotonImportance makes it.");
  }
  for (int layer = 0; layer < layers; ++layer)
  {
    const double number = numbers ? numbers->GetVariantValue(layer).ToDouble() : layer;
    if (!(number >= -2.0 && number <= VTK_INT_MAX) || number != static_cast<int>(number))
    {
      throw InvalidInput("The importance map's field data 'light' has " + Text("%g", number) + " for layer " +
        std::to_string(layer) + "; it must be the number of a light.");
    }
    lights[static_cast<std::size_t>(layer)] = static_cast<int>(number);
  }
  return lights;
}

bool Shines(const Illumination& illumination, int light)
{
  const bool sky = !illumination.environment.Empty() || illumination.sky != Rgb{};
  const bool faces = illumination.faces != std::array<Rgb, 6>{};
  return light == -1 ? sky : light == -2 ? faces : light < static_cast<int>(illumination.lights.size());
}

/// Checks the lights of an importance map.
/// @param lights  index of the light of each layer, as LightsOf returns it
/// @throws InvalidInput if the scene lacks the light of a layer, or two layers are of the same light
void CheckLights(const std::vector<int>& lights, const Illumination& illumination)
{
  std::set<int> seen;
  std::string missing;
  for (int light : lights)
  {
    if (!seen.insert(light).second)
    {
      throw InvalidInput("The importance map has two layers of light " + std::to_string(light) + "; it takes one.");
    }
    if (!Shines(illumination, light))
    {
      missing += (missing.empty() ? "" : ", ") + std::to_string(light);
    }
  }
  if (!missing.empty())
  {
    throw InvalidInput("The importance map has layers of lights that there are not: " + missing + " (of " +
      std::to_string(illumination.lights.size()) +
      " lights from 0 on; -1 is the environment or SkyColor). Make it with PhotonImportance of the same Lights and "
      "Environment.");
  }
}
}

void WriteImportanceMap(const Importance& importance, vtkImageData* output)
{
  const ImportanceMap& map = importance.map;
  AddFact(output, EvenName, std::vector<double>{ importance.even ? 1.0 : 0.0 });
  if (map.lights.empty())
  {
    return; // an empty image, because no light reaches the volume
  }
  Grid grid;
  grid.size = { map.size, map.size, static_cast<int>(map.lights.size()) };
  grid.spacing = { 1.0 / map.size, 1.0 / map.size, 1.0 };
  SetGrid(output, grid);
  AddCells(output, MapName, std::vector<float>(map.density), 1);
  output->GetCellData()->SetActiveScalars(MapName);
  vtkNew<vtkIntArray> lights;
  lights->SetName(LightName);
  lights->SetNumberOfValues(static_cast<vtkIdType>(map.lights.size()));
  std::copy(map.lights.begin(), map.lights.end(), lights->GetPointer(0));
  output->GetFieldData()->AddArray(lights);
}

void WritePilotLight(Importance&& importance, vtkImageData* output)
{
  PilotLight& pilot = importance.pilot;
  SetGrid(output, pilot.grid);
  AddCells(output, "fluence", std::move(pilot.fluence), pilot.channels);
  output->GetCellData()->SetActiveScalars("fluence");
  AddCells(output, "photon_count", std::move(pilot.count), 1);
  AddCells(output, "origin_mean", std::move(pilot.originMean), 2);
  AddCells(output, "origin_deviation", std::move(pilot.originDeviation), 2);
  AddCells(output, "gradient", std::move(importance.gradient), 1);
  AddCells(output, "chosen", std::move(importance.chosen), 1);
}

ImportanceMap ReadImportanceMap(vtkImageData* image, const Illumination& illumination)
{
  if (!image)
  {
    return {};
  }
  if (image->GetNumberOfPoints() == 0)
  {
    StopIfUpstreamFailed(image);
    return {}; // the map is empty if no light reached the volume
  }
  const std::array<int, 3> size = GridOf(image).size;
  if (size[0] != size[1])
  {
    throw InvalidInput("The importance map has " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
      " cells for each light; it must be square, as PhotonImportance makes it.");
  }
  const FloatField density = ReadCells(image, MapName, Need::Required, { 1 });
  ImportanceMap map;
  map.size = size[0];
  map.lights = LightsOf(image, size[2]);
  map.density.assign(density.Values(), density.Values() + image->GetNumberOfCells());
  CheckLights(map.lights, illumination);
  Check(map);
  return ReadFact(image, EvenName, 0.0) > 0.0 ? ImportanceMap{} : map;
}
}
