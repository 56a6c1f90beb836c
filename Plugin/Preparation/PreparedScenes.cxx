#include "PreparedScenes.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkMediumRayCaster.h"
#include "vtkNew.h"
#include "vtkParticipatingMedium.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <iterator>
#include <sys/stat.h>

namespace
{
struct Scene
{
  int length; ///< voxels along x; sweeps are compiled for rows of up to 32, 64 and 128
  int preset;
  double around; ///< density of the box outside of the ellipsoid
};

const Scene Scenes[] = {
  { 64, vtkParticipatingMedium::CUSTOM, 0.5 },
  { 32, vtkParticipatingMedium::CUSTOM, 0.0 },
  { 64, vtkParticipatingMedium::CLOUD, 0.0 },
  { 128, vtkParticipatingMedium::CUSTOM, 0.0 },
  { 128, vtkParticipatingMedium::CLOUD, 0.0 },
};

/// Voxels along y and z: few, because only compilation matters, but enough that the same kernels are compiled as for a
/// cube.
constexpr int Across = 40;

/// Density of an ellipsoid: 1 at its centre, decreasing outwards.
vtkSmartPointer<vtkImageData> Density(int length, double around)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(length + 1, Across + 1, Across + 1);
  vtkNew<vtkFloatArray> density;
  density->SetName("density");
  density->SetNumberOfValues(image->GetNumberOfCells());
  const auto fromMiddle = [](vtkIdType i, int voxels) { return (2.0 * static_cast<double>(i) + 1.0) / voxels - 1.0; };
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    const double x = fromMiddle(i % length, length), y = fromMiddle(i / length % Across, Across),
                 z = fromMiddle(i / length / Across, Across);
    density->SetValue(i, static_cast<float>(std::max(around, 1.0 - std::sqrt(x * x + y * y + z * z))));
  }
  image->GetCellData()->SetScalars(density);
  return image;
}
}

int PreparedSceneCount()
{
  return static_cast<int>(std::size(Scenes));
}

bool PrepareScene(int number)
{
  const Scene& scene = Scenes[number];
  int errors = 0;
  vtkNew<vtkCallbackCommand> count; // counts errors of the filters; errors and warnings are not printed
  count->SetClientData(&errors);
  count->SetCallback([](vtkObject*, unsigned long event, void* all, void*) {
    *static_cast<int*>(all) += event == vtkCommand::ErrorEvent ? 1 : 0;
  });
  vtkNew<vtkParticipatingMedium> medium;
  vtkNew<vtkLightPropagationMaps> light;
  vtkNew<vtkMediumRayCaster> picture;
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ medium, light, picture })
  {
    filter->AddObserver(vtkCommand::ErrorEvent, count);
    filter->AddObserver(vtkCommand::WarningEvent, count);
  }
  medium->SetInputDataObject(Density(scene.length, scene.around));
  medium->SetPreset(scene.preset);
  medium->SetMillimetresPerUnit(1e4); // unit of length 10 m, with which the preset CLOUD is optically thick
  light->SetInputConnection(medium->GetOutputPort());
  picture->SetInputConnection(light->GetOutputPort());
  picture->Update();
  return errors == 0;
}

std::string LibraryVersion()
{
  Dl_info library = {};
  struct stat found = {};
  const auto* inIt = reinterpret_cast<const void*>(&vtkLightPropagationMaps::New);
  if (dladdr(inIt, &library) == 0 || stat(library.dli_fname, &found) != 0)
  {
    return {};
  }
  return std::string(library.dli_fname) + " " + std::to_string(found.st_size) + " " + std::to_string(found.st_mtime) +
    "\n";
}
