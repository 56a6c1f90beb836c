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
/// A cloud with fluence by light propagation maps, or a glass ball in fog with photons.
struct Scene
{
  int length;    ///< voxels of the cloud's box along x; sweeps are compiled for rows of up to 64, 128, 256 voxels
  int preset;    ///< preset of the cloud's medium; Glass: the scene is a glass ball
  bool coloured; ///< whether the light has a colour, so that three channels are solved
  double around; ///< density of the cloud's box outside the ellipsoidal cloud
  double radius; ///< radius of the cloud, relative to its box; if it is small, most of the box is empty
  bool ground;   ///< whether the lower face of the cloud's box reflects
};

constexpr int Glass = -1;

// Two processes prepare consecutive scenes of this list at the same time; these scenes should have few kernels in
// common.
const Scene Scenes[] = {
  { 64, vtkParticipatingMedium::CUSTOM, false, 0.5, 1.0, false },
  { 0, Glass, false, 0.0, 0.0, false },
  { 64, vtkParticipatingMedium::CLOUD, true, 0.0, 1.0, false },
  { 0, Glass, true, 0.0, 0.0, false },
  { 64, vtkParticipatingMedium::CLOUD, true, 0.0, 1.0, true },
  { 64, vtkParticipatingMedium::CUSTOM, true, 0.0, 0.6, false },
  { 64, vtkParticipatingMedium::CLOUD, false, 0.0, 1.0, false },
  { 64, vtkParticipatingMedium::CUSTOM, false, 0.0, 0.6, false },
  { 128, vtkParticipatingMedium::CLOUD, true, 0.0, 1.0, false },
  { 128, vtkParticipatingMedium::CUSTOM, false, 0.0, 1.0, false },
};

/// Voxels along y and z: few, because only compilation matters, but enough that the same kernels are compiled as for a
/// cube.
constexpr int Across = 40;
/// Voxels of the glass ball's box along each axis: a multiple of 16, as in most grids of users, so that light is read
/// in place, not copied to longer rows.
constexpr int GlassVoxels = 48;

/// Density of an ellipsoid: 1 at its centre, decreasing outwards.
vtkSmartPointer<vtkImageData> Density(const Scene& scene)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(scene.length + 1, Across + 1, Across + 1);
  vtkNew<vtkFloatArray> density;
  density->SetName("density");
  density->SetNumberOfValues(image->GetNumberOfCells());
  const auto fromMiddle = [](vtkIdType i, int voxels) { return (2.0 * static_cast<double>(i) + 1.0) / voxels - 1.0; };
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    const double x = fromMiddle(i % scene.length, scene.length), y = fromMiddle(i / scene.length % Across, Across),
                 z = fromMiddle(i / scene.length / Across, Across);
    density->SetValue(
      i, static_cast<float>(std::max(scene.around, 1.0 - std::sqrt(x * x + y * y + z * z) / scene.radius)));
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
  medium->SetInputDataObject(Density(scene));
  medium->SetPreset(scene.preset);
  medium->SetMillimetresPerUnit(1e4); // unit of length 10 m, with which the preset CLOUD is optically thick
  light->SetInputConnection(medium->GetOutputPort());
  light->SetTolerance(0.1); // few sweeps, of the same kernels
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

/// Renders a ball of glass on a table.
void SeeGlass(vtkAlgorithm* light, vtkMediumRayCaster* picture)
{
  picture->SetInputConnection(light->GetOutputPort());
  picture->SetSurfaceReflection(vtkMediumRayCaster::FRESNEL);
  picture->SetTableFace(4);
  picture->Update();
}

/// Follows photons through a ball of green glass in haze, and renders their light.
void MarchColouredPhotons(vtkMeshVoxelizer* medium, vtkCommand* listener)
{
  vtkNew<vtkLightRig> sun;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkMediumRayCaster> picture;
  Observe({ emitter, marcher, picture }, listener);
  sun->SetSunPower(4.0, 3.7, 3.2);
  medium->SetInsideAbsorption(0.2, 0.05, 0.09);
  medium->SetInsideMeanCosine(0.7);
  medium->SetOutsideMeanCosine(0.7);
  emitter->SetInputConnection(medium->GetOutputPort());
  emitter->SetLightsConnection(sun->GetOutputPort());
  emitter->SetPhotonCount(20000);
  marcher->SetInputConnection(medium->GetOutputPort());
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  marcher->SetPathCount(1);
  SeeGlass(marcher, picture);
}

/// Follows photons through a glass ball in fog, from the importance map to the reconstructed fluence, and renders it.
void MarchPhotons(vtkMeshVoxelizer* medium, vtkCommand* listener)
{
  vtkNew<vtkRefractionOctree> octree;
  vtkNew<vtkLightRig> lamp;
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkPhotonReconstruction> reconstruction;
  vtkNew<vtkMediumRayCaster> picture;
  Observe({ octree, importance, emitter, marcher, reconstruction, picture }, listener);
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
  marcher->SetPathCount(1);
  reconstruction->SetInputConnection(marcher->GetOutputPort());
  // The published reconstruction needs photon counts, for which the march is compiled separately.
  marcher->SetPhotonCounts(true);
  reconstruction->SetScheme(vtkPhotonReconstruction::PUBLISHED);
  reconstruction->Update();
  marcher->SetPhotonCounts(false);
  reconstruction->SetScheme(vtkPhotonReconstruction::CONSERVATIVE);
  SeeGlass(reconstruction, picture);
}

void PrepareGlass(const Scene& scene, vtkCommand* listener)
{
  vtkNew<vtkSphereSource> ball;
  vtkNew<vtkMeshVoxelizer> medium;
  Observe({ medium }, listener);
  ball->SetThetaResolution(20);
  ball->SetPhiResolution(20);
  medium->SetInputConnection(ball->GetOutputPort());
  medium->SetModelBounds(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0);
  medium->SetSampleDimensions(GlassVoxels, GlassVoxels, GlassVoxels);
  medium->SetInsideIndex(1.5);
  medium->SetOutsideScattering(0.35, 0.35, 0.35);
  scene.coloured ? MarchColouredPhotons(medium, listener) : MarchPhotons(medium, listener);
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
  scene.preset == Glass ? PrepareGlass(scene, count) : SolveCloud(scene, count);
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
