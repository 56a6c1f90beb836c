#include "StressFilters.h"

#include "Measure.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkMediumRayCaster.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkPolyData.h"
#include "vtkRefractionOctree.h"

#include <algorithm>
#include <cmath>

namespace bench
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int ViewEdge = 12; ///< pixels

/// Ports and properties that the solvers on grids share.
template <class Solver>
void Shine(Solver* solver, const StressScene& scene, double tolerance)
{
  solver->SetInputDataObject(ImageOf(scene));
  solver->SetSkyColor(scene.sky.data());
  std::array<double, 6> faces = scene.faces;
  solver->SetFaceRadiance(faces.data());
  solver->SetPeriodicX(scene.periodic[0]);
  solver->SetPeriodicY(scene.periodic[1]);
  solver->SetPeriodicZ(scene.periodic[2]);
  solver->SetNetFlux(true);
  solver->SetTolerance(tolerance);
}

void SetOrders(vtkLightPropagationMaps* maps, const StressSolver& row)
{
  maps->SetAngularDegree(
    row.Is(Moments) ? -1 : 0); // else the similarity relation, as the twins of the row of g have it
  maps->SetScheme(row.Is(Published) ? vtkLightPropagationMaps::PUBLISHED : vtkLightPropagationMaps::CONSERVATIVE);
  if (row.Is(Published | ByOrders))
  {
    maps->SetSource(vtkLightPropagationMaps::CONSTANT);
    maps->SetAcceleration(vtkLightPropagationMaps::NONE);
    maps->SetMaximumOrders(row.Is(ByOrders) ? StressOrders : StressOrdersPublished);
  }
}

void SetOrders(vtkDiscreteOrdinates* ordinates, const StressSolver& row)
{
  ordinates->SetScheme(row.Is(Published) ? vtkDiscreteOrdinates::PUBLISHED : vtkDiscreteOrdinates::CONSERVATIVE);
  ordinates->SetMaximumOrders(row.Is(Published | ByOrders) ? StressOrdersOrdinates : 0);
}

void SetOrders(vtkLatticeBoltzmannLighting* lattice, const StressSolver& row)
{
  lattice->SetScheme(
    row.Is(Published) ? vtkLatticeBoltzmannLighting::PUBLISHED : vtkLatticeBoltzmannLighting::CONSERVATIVE);
  lattice->SetLattice(row.Is(SixLinks) ? 6 : 18);
  lattice->SetMaximumOrders(row.Is(Published | ByOrders) ? StressStepsLattice : 0);
}

void SetGivenLight(vtkScatteringSolver* solver, vtkPhotonEmitter*, vtkPhotonMarcher* marcher)
{
  solver->SetUncollidedLightConnection(marcher->GetOutputPort());
}

void SetGivenLight(vtkLatticeBoltzmannLighting* lattice, vtkPhotonEmitter* emitter, vtkPhotonMarcher* marcher)
{
  lattice->GetInterleaved() ? lattice->SetPhotonsConnection(emitter->GetOutputPort())
                            : lattice->SetUncollidedLightConnection(marcher->GetOutputPort());
}

/// Emitter and marcher, and what may stand before and after them.
struct PhotonChain
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkRefractionOctree> octree;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkPhotonReconstruction> reconstruction;

  PhotonChain(const StressSolver& row, StressScene scene, StressListener* listener)
  {
    SetRig(this->rig, scene);
    if (row.family == StressFamily::Octree && scene.index.empty())
    {
      scene.index.assign(scene.VoxelCount(), 1.0f); // which it groups by extinction then
    }
    const vtkSmartPointer<vtkImageData> medium = ImageOf(scene);
    const std::array<vtkAlgorithm*, 6> filters = { this->rig, this->importance, this->emitter, this->octree,
      this->marcher, this->reconstruction };
    for (vtkAlgorithm* filter : filters)
    {
      listener->Hear(filter);
    }
    this->importance->SetInputDataObject(medium);
    this->importance->SetLightsConnection(this->rig->GetOutputPort());
    this->importance->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
    this->emitter->SetInputDataObject(medium);
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
    this->emitter->SetPhotonCount(static_cast<vtkIdType>(PhotonsFor(row, scene)));
    this->octree->SetInputDataObject(medium);
    this->octree->SetIncludeExtinction(true);
    this->marcher->SetInputDataObject(medium);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
    this->reconstruction->SetInputConnection(this->marcher->GetOutputPort());
    for (vtkAlgorithm* filter : filters)
    {
      row.set(filter);
    }
  }

  void March(bool published, StressOutcome& outcome)
  {
    this->marcher->SetScheme(published ? vtkPhotonMarcher::PUBLISHED : vtkPhotonMarcher::CONSERVATIVE);
    this->marcher->Update();
    ReadLight(vtkImageData::SafeDownCast(this->marcher->GetOutputDataObject(0)), outcome);
  }

  void Rebuild(bool published, StressOutcome& outcome)
  {
    this->emitter->SetImportanceMapConnection(this->importance->GetOutputPort());
    this->marcher->SetPhotonCounts(published);
    this->reconstruction->SetScheme(
      published ? vtkPhotonReconstruction::PUBLISHED : vtkPhotonReconstruction::CONSERVATIVE);
    this->reconstruction->Update();
    ReadLight(this->reconstruction->GetOutput(), outcome);
    const std::vector<float> raw =
      Floats(vtkImageData::SafeDownCast(this->marcher->GetOutputDataObject(0))->GetCellData(), "fluence");
    for (const float fluence : raw)
    {
      outcome.rawTotal += fluence;
    }
  }

  void MarchThroughOctree(StressOutcome& outcome)
  {
    this->marcher->SetOctreeConnection(this->octree->GetOutputPort());
    this->March(false, outcome);
    outcome.levels =
      Floats(vtkImageData::SafeDownCast(this->octree->GetOutputDataObject(0))->GetCellData(), "octree_level");
    outcome.nodes = static_cast<double>(this->octree->GetNodeCount());
  }
};

template <class Solver>
void RunGrid(
  const StressSolver& row, const StressScene& scene, double tolerance, StressListener* listener, StressOutcome& outcome)
{
  PhotonChain chain(row, scene, listener);
  vtkNew<Solver> solver;
  listener->Hear(solver);
  Shine(solver.Get(), scene, tolerance);
  SetOrders(solver.Get(), row);
  row.set(solver);
  if (row.Is(OfPhotons))
  {
    SetGivenLight(solver.Get(), chain.emitter, chain.marcher);
  }
  else
  {
    solver->SetLightsConnection(chain.rig->GetOutputPort());
  }
  std::array<double, 6> albedo = {};
  for (std::size_t face = 0; face < 6; ++face)
  {
    albedo[face] = row.Is(Reflecting) && !scene.periodic[face / 2] ? StressAlbedo : 0.0;
  }
  solver->SetFaceAlbedo(albedo.data());
  solver->SetPreview(row.Is(Preview));
  if (row.Is(Warm))
  {
    solver->SetSkyColor(scene.sky[0] + 0.3, scene.sky[1] + 0.3, scene.sky[2] + 0.3);
    solver->Update();
    if (!outcome.errors.empty())
    {
      outcome.empty = vtkImageData::SafeDownCast(solver->GetOutputDataObject(0))->GetNumberOfCells() == 0;
      return; // it would say so again
    }
    solver->SetSkyColor(scene.sky.data());
  }
  solver->Update();
  outcome.residual = solver->GetResidual() / solver->GetTolerance();
  ReadLight(vtkImageData::SafeDownCast(solver->GetOutputDataObject(0)), outcome);
}

/// The medium in a light of 4 pi everywhere, so that where it is in equilibrium with that all is 1 to the eye. Where
/// rays bend radiance is n^2 of that.
vtkSmartPointer<vtkImageData> ImageToView(const StressScene& scene, bool bent, bool lit)
{
  StressScene seen = scene;
  seen.index = bent ? IndexToView(scene) : std::vector<float>();
  std::vector<float> fluence(scene.VoxelCount(), static_cast<float>(4.0 * Pi));
  if (!lit)
  {
    seen.emission.clear();
  }
  for (std::size_t i = 0; bent && i < fluence.size(); ++i)
  {
    const float square = seen.index[i] * seen.index[i];
    fluence[i] *= square;
    for (int c = 0; c < seen.channels && !seen.emission.empty(); ++c)
    {
      seen.emission[i * seen.channels + c] *= square;
    }
  }
  const vtkSmartPointer<vtkImageData> image = ImageOf(seen);
  if (lit)
  {
    AddField(image, "fluence", fluence, 1);
  }
  return image;
}

/// Parallel rays along -z that all meet the box well within its sides.
void LookDown(vtkMediumRayCaster* caster, const StressScene& scene)
{
  double middle[3], length[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    length[axis] = scene.cells[axis] * scene.spacing[axis];
    middle[axis] = 0.5 * length[axis];
  }
  caster->SetCameraFocalPoint(middle);
  caster->SetCameraPosition(middle[0], middle[1], middle[2] + length[2]);
  caster->SetCameraViewUp(0.0, 1.0, 0.0);
  caster->SetCameraParallelProjection(true);
  caster->SetCameraParallelScale(0.3 * std::min(length[0], length[1]));
}

void RunView(const StressSolver& row, const StressScene& scene, StressListener* listener, StressOutcome& outcome)
{
  for (const bool lit : { true, false })
  {
    vtkNew<vtkMediumRayCaster> caster;
    listener->Hear(caster);
    caster->SetInputDataObject(ImageToView(scene, row.Is(Bent), lit));
    caster->SetImageSize(ViewEdge, ViewEdge);
    caster->SetBackgroundRadiance(1.0, 1.0, 1.0);
    if (!lit)
    {
      LookDown(caster, scene);
    }
    row.set(caster);
    caster->Update();
    vtkPointData* pixels = caster->GetOutput()->GetPointData();
    outcome.empty = caster->GetOutput()->GetNumberOfPoints() == 0;
    (lit ? outcome.radiance : outcome.through) = Floats(pixels, "radiance");
    const std::vector<float> alpha = Floats(pixels, "alpha");
    outcome.alpha.insert(outcome.alpha.end(), alpha.begin(), alpha.end());
    if (!outcome.errors.empty())
    {
      return;
    }
  }
}
}

std::vector<float> IndexToView(const StressScene& scene)
{
  if (!scene.index.empty())
  {
    return scene.index;
  }
  std::vector<float> index(scene.VoxelCount(), 1.0f);
  for (int k = 0; k < scene.cells[2]; ++k)
  {
    for (int j = 0; j < scene.cells[1]; ++j)
    {
      for (int i = 0; i < scene.cells[0]; ++i)
      {
        double square = 0.0;
        const std::array<int, 3> at = { i, j, k };
        for (int axis = 0; axis < 3; ++axis)
        {
          const double x = (at[axis] + 0.5) / scene.cells[axis] - 0.5;
          square += scene.cells[axis] > 1 ? x * x : 0.0;
        }
        index[scene.Voxel(i, j, k)] += static_cast<float>(0.5 * std::exp(-60.0 * square));
      }
    }
  }
  return index;
}

StressOutcome RunStress(const StressSolver& solver, const StressScene& scene, double tolerance)
{
  StressOutcome outcome;
  vtkNew<StressListener> listener;
  listener->Outcome = &outcome;
  const double start = WallSeconds();
  if (solver.Is(Ranks))
  {
    RunOnRanks(solver, scene, tolerance, outcome);
    outcome.seconds = WallSeconds() - start;
    return outcome;
  }
  switch (solver.family)
  {
    case StressFamily::Maps: RunGrid<vtkLightPropagationMaps>(solver, scene, tolerance, listener, outcome); break;
    case StressFamily::Ordinates: RunGrid<vtkDiscreteOrdinates>(solver, scene, tolerance, listener, outcome); break;
    case StressFamily::Lattice:
      RunGrid<vtkLatticeBoltzmannLighting>(solver, scene, tolerance, listener, outcome);
      break;
    case StressFamily::View: RunView(solver, scene, listener, outcome); break;
    case StressFamily::Photons:
    {
      PhotonChain chain(solver, scene, listener);
      chain.marcher->SetMaximumOrders(solver.Is(Scattered) ? 0 : 1);
      chain.March(solver.Is(Published), outcome);
      break;
    }
    case StressFamily::Rebuilt: PhotonChain(solver, scene, listener).Rebuild(solver.Is(Published), outcome); break;
    case StressFamily::Octree: PhotonChain(solver, scene, listener).MarchThroughOctree(outcome); break;
    default: RunStage(solver, scene, listener, outcome);
  }
  outcome.seconds = WallSeconds() - start;
  return outcome;
}
}
