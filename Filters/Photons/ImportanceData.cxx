#include "Photons/ImportanceData.h"

#include "Common/Failure.h"
#include "Common/LightTransportData.h"
#include "Numerics/NumberText.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace tyndall
{
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

/// Number of the light that each layer belongs to.
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

/// @throws InvalidInput if the map has a layer of a light that the scene does not have, or two layers of one light
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
    return; // no light reaches the volume
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
    return {}; // a map of lights that do not reach the volume
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
