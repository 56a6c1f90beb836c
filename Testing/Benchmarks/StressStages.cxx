#include "StressFilters.h"

#include "vtkCellArray.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkMeshVoxelizer.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace bench
{
namespace
{
double BadNumbers(const std::vector<float>& values, float least)
{
  return values.empty() ? 1.0 : static_cast<double>(std::count_if(values.begin(), values.end(), [=](float x) {
    return !(x >= least && std::isfinite(x));
  }));
}

void RunSteps(const StressScene& scene, StressListener* listener, StressOutcome& outcome)
{
  vtkNew<vtkLightRig> rig;
  SetRig(rig, scene);
  vtkNew<vtkLPMPropagate> propagate;
  vtkNew<vtkLPMCollect> collect;
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ rig, propagate, collect })
  {
    listener->Hear(filter);
  }
  propagate->SetInputDataObject(ImageOf(scene));
  propagate->SetLightsConnection(rig->GetOutputPort());
  propagate->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
  std::array<double, 6> faces = scene.faces;
  propagate->SetFaceRadiance(faces.data());
  collect->SetInputConnection(propagate->GetOutputPort());
  collect->Update();
  ReadLight(collect->GetOutput(), outcome);
}

/// A map of importance, photons by it or without, each checked.
void RunEmission(const StressSolver& row, const StressScene& scene, StressListener* listener, StressOutcome& outcome)
{
  vtkNew<vtkLightRig> rig;
  SetRig(rig, scene);
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  const vtkSmartPointer<vtkImageData> medium = ImageOf(scene);
  for (vtkLitMediumAlgorithm* filter : std::initializer_list<vtkLitMediumAlgorithm*>{ importance, emitter })
  {
    listener->Hear(filter);
    filter->SetInputDataObject(medium);
    filter->SetLightsConnection(rig->GetOutputPort());
    row.set(filter);
  }
  importance->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
  emitter->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
  emitter->SetPhotonCount(StressPhotons);
  if (row.family == StressFamily::Importance)
  {
    importance->Update();
    auto* const map = vtkImageData::SafeDownCast(importance->GetOutputDataObject(0));
    outcome.fluence = Floats(map->GetCellData(), "importance");
    outcome.empty = map->GetNumberOfCells() == 0;
    outcome.checks.push_back({ "bad_importance", BadNumbers(outcome.fluence, 1e-6f), 0.0 });
    return;
  }
  if (row.Is(ByImportance))
  {
    emitter->SetImportanceMapConnection(importance->GetOutputPort());
  }
  emitter->Update();
  vtkPolyData* const photons = emitter->GetOutput();
  outcome.empty = photons->GetNumberOfPoints() == 0;
  outcome.fluence = Floats(photons->GetPointData(), "power");
  outcome.directions = Floats(photons->GetPointData(), "direction");
  outcome.channels = 3;
  outcome.balance.assign(15, 0.0);
  double outside = 0.0, unlike = 0.0;
  for (vtkIdType i = 0; i < photons->GetNumberOfPoints(); ++i)
  {
    const float* const way = outcome.directions.data() + 3 * i;
    unlike = std::max(unlike, std::abs(std::hypot(way[0], way[1], way[2]) - 1.0));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double at = photons->GetPoint(i)[axis] / (scene.cells[axis] * scene.spacing[axis]);
      outside = std::max({ outside, -at, at - 1.0 });
      outcome.balance[axis] += outcome.fluence[3 * i + axis]; // of this channel
    }
  }
  outcome.checks = { { "bad_power", BadNumbers(outcome.fluence, 0.0f), 0.0 }, { "outside", outside, 1e-5 },
    { "not_of_length_1", unlike, 1e-5 } };
}

/// A closed box, of half the edges of the scene's.
vtkSmartPointer<vtkPolyData> BoxIn(const StressScene& scene)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int corner = 0; corner < 8; ++corner)
  {
    double at[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] = (corner >> axis & 1 ? 0.75 : 0.25) * scene.cells[axis] * scene.spacing[axis];
    }
    points->InsertNextPoint(at);
  }
  vtkNew<vtkCellArray> faces;
  for (const std::array<vtkIdType, 4>& face : { std::array<vtkIdType, 4>{ 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
         { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    faces->InsertNextCell(4, face.data());
  }
  const auto box = vtkSmartPointer<vtkPolyData>::New();
  box->SetPoints(points);
  box->SetPolys(faces);
  return box;
}

/// The box has an eighth of the volume, and of the first voxel's coefficients.
void RunMesh(const StressSolver& row, const StressScene& scene, StressListener* listener, StressOutcome& outcome)
{
  vtkNew<vtkMeshVoxelizer> voxelizer;
  listener->Hear(voxelizer);
  voxelizer->SetInputDataObject(BoxIn(scene));
  double bounds[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    bounds[2 * axis] = 0.0;
    bounds[2 * axis + 1] = scene.cells[axis] * scene.spacing[axis];
  }
  voxelizer->SetModelBounds(bounds);
  voxelizer->SetSampleDimensions(scene.cells[0], scene.cells[1], scene.cells[2]);
  const double absorption = scene.absorption[0], scattering = scene.scattering[0];
  voxelizer->SetInsideAbsorption(absorption, absorption, absorption);
  voxelizer->SetInsideScattering(scattering, scattering, scattering);
  voxelizer->SetOutsideScattering(0.0, 0.0, 0.0);
  voxelizer->SetInsideIndex(1.5);
  row.set(voxelizer);
  voxelizer->Update();
  vtkCellData* const cells = voxelizer->GetOutput()->GetCellData();
  outcome.empty = voxelizer->GetOutput()->GetNumberOfCells() == 0;
  const std::vector<float> occupancy = Floats(cells, "occupancy");
  outcome.fluence = Floats(cells, "ior");
  double bad = BadNumbers(occupancy, 0.0f) + BadNumbers(outcome.fluence, row.Is(Noisy) ? 0.1f : 1.0f), volume = 0.0;
  double excess = 0.0, absorbs = 0.0, scatters = 0.0;
  const std::vector<float> sigma_a = Floats(cells, "sigma_a"), sigma_s = Floats(cells, "sigma_s");
  bad += BadNumbers(sigma_a, 0.0f) + BadNumbers(sigma_s, 0.0f);
  for (std::size_t i = 0; i < occupancy.size() && bad == 0.0; ++i)
  {
    volume += occupancy[i] / static_cast<double>(occupancy.size());
    excess = std::max<double>(excess, occupancy[i] - 1.0);
    absorbs += absorption > 0.0 ? sigma_a[i] / absorption / static_cast<double>(occupancy.size()) : 0.0;
    scatters += scattering > 0.0 ? sigma_s[i] / scattering / static_cast<double>(occupancy.size()) : 0.0;
  }
  outcome.checks = { { "bad_voxels", bad, 0.0 }, { "occupied_above_1", excess, 1e-6 },
    { "volume", std::abs(8.0 * volume - 1.0), 1e-3 },
    { "absorbs", absorption > 0.0 ? std::abs(8.0 * absorbs - 1.0) : 0.0, 1e-3 },
    { "scatters", scattering > 0.0 ? std::abs(8.0 * scatters - 1.0) : 0.0, 1e-3 } };
}
}

void RunStage(const StressSolver& row, const StressScene& scene, StressListener* listener, StressOutcome& outcome)
{
  switch (row.family)
  {
    case StressFamily::Steps: RunSteps(scene, listener, outcome); break;
    case StressFamily::Mesh: RunMesh(row, scene, listener, outcome); break;
    default: RunEmission(row, scene, listener, outcome);
  }
}
}
