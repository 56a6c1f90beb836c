#include "PreparedScenes.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkMeshVoxelizer.h"
#include "vtkNew.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"

#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <initializer_list>
#include <iterator>
#include <sys/stat.h>

namespace
{
/// A cloud with fluence by light propagation maps; if `length` is 0, a glass ball in fog with photons instead.
struct Scene
{
  int length; ///< voxels along x; sweeps are compiled for rows of up to 32, 64 and 128
  int preset;
  double around; ///< density of the box outside the ellipsoidal cloud
  bool coloured; ///< whether the light has a colour, so that three channels are solved
  bool ground;   ///< whether the lower face of the box reflects
};

const Scene Scenes[] = {
  { 64, vtkParticipatingMedium::CUSTOM, 0.5, false, false },
  { 0, 0, 0.0, false, false },
  { 64, vtkParticipatingMedium::CLOUD, 0.0, false, false },
  { 64, vtkParticipatingMedium::CLOUD, 0.0, true, false },
  { 64, vtkParticipatingMedium::CLOUD, 0.0, true, true },
  { 128, vtkParticipatingMedium::CUSTOM, 0.0, false, false },
  { 128, vtkParticipatingMedium::CLOUD, 0.0, true, false },
  { 128, vtkParticipatingMedium::CLOUD, 0.0, false, false },
  { 32, vtkParticipatingMedium::CUSTOM, 0.0, false, false },
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

void Observe(std::initializer_list<vtkAlgorithm*> filters, vtkCommand* listener)
{
  for (vtkAlgorithm* filter : filters)
  {
    filter->AddObserver(vtkCommand::ErrorEvent, listener);
    filter->AddObserver(vtkCommand::WarningEvent, listener);
  }
}

/// Solves and renders a cloud.
void SolveCloud(const Scene& scene, vtkCommand* listener)
{
  vtkNew<vtkParticipatingMedium> medium;
  vtkNew<vtkLightPropagationMaps> light;
  vtkNew<vtkMediumRayCaster> picture;
  Observe({ medium, light, picture }, listener);
  medium->SetInputDataObject(Density(scene.length, scene.around));
  medium->SetPreset(scene.preset);
  medium->SetMillimetresPerUnit(1e4); // unit of length 10 m, with which the preset CLOUD is optically thick
  light->SetInputConnection(medium->GetOutputPort());
  vtkNew<vtkLightRig> sun;
  if (scene.coloured)
  {
    sun->SetSunPower(4.0, 3.7, 3.2);
    light->SetLightsConnection(sun->GetOutputPort());
    light->SetSkyColor(0.03, 0.06, 0.13);
    picture->SetLightsConnection(sun->GetOutputPort());
  }
  if (scene.ground)
  {
    light->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.8, 0.0);
  }
  picture->SetInputConnection(light->GetOutputPort());
  picture->Update();
}

/// Follows photons through a glass ball in fog, from the mesh to the reconstructed fluence and a picture.
void MarchPhotons(vtkCommand* listener)
{
  vtkNew<vtkSphereSource> ball;
  vtkNew<vtkMeshVoxelizer> medium;
  vtkNew<vtkRefractionOctree> octree;
  vtkNew<vtkLightRig> lamp;
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkPhotonReconstruction> reconstruction;
  vtkNew<vtkMediumRayCaster> picture;
  Observe({ medium, octree, importance, emitter, marcher, reconstruction, picture }, listener);
  ball->SetThetaResolution(20);
  ball->SetPhiResolution(20);
  medium->SetInputConnection(ball->GetOutputPort());
  medium->SetModelBounds(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0);
  medium->SetSampleDimensions(Across, Across, Across);
  medium->SetInsideIndex(1.5);
  medium->SetOutsideScattering(0.35, 0.35, 0.35);
  octree->SetInputConnection(medium->GetOutputPort());
  lamp->SetSun(false);
  lamp->AddPointLight(0.9, 1.1, 3.6, 110.0, 110.0, 110.0);
  importance->SetInputConnection(octree->GetOutputPort());
  importance->SetLightsConnection(lamp->GetOutputPort());
  emitter->SetInputConnection(medium->GetOutputPort());
  emitter->SetLightsConnection(lamp->GetOutputPort());
  emitter->SetImportanceMapConnection(importance->GetOutputPort());
  emitter->SetPhotonCount(20000);
  marcher->SetInputConnection(medium->GetOutputPort());
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  marcher->SetOctreeConnection(octree->GetOutputPort());
  reconstruction->SetInputConnection(marcher->GetOutputPort());
  picture->SetInputConnection(reconstruction->GetOutputPort());
  picture->Update();
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
  if (scene.length > 0)
  {
    SolveCloud(scene, count);
  }
  else
  {
    MarchPhotons(count);
  }
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
