#include "StressSolvers.h"

#include "Measure.h"

#include "../Filters/MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightRig.h"
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
constexpr double MostScatterings = 300.0; ///< of a photon: a cell is to take seconds
constexpr int ViewEdge = 12;              ///< pixels

/// Keeps what a filter says.
class Listener : public vtkCommand
{
public:
  static Listener* New() { return new Listener; }
  void Execute(vtkObject*, unsigned long event, void* text) override
  {
    (event == vtkCommand::ErrorEvent ? this->Outcome->errors : this->Outcome->warnings)
      .emplace_back(static_cast<const char*>(text));
  }
  void Hear(vtkAlgorithm* filter)
  {
    for (const unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
    {
      filter->AddObserver(event, this);
      filter->GetExecutive()->AddObserver(event, this);
    }
  }
  StressOutcome* Outcome = nullptr;
};

void AddField(vtkImageData* image, const char* name, const std::vector<float>& values, int components)
{
  if (!values.empty())
  {
    test::AddValues<vtkFloatArray>(image->GetCellData(), name, image->GetNumberOfCells(), components,
      [&](vtkIdType i, int c) { return values[static_cast<std::size_t>(i * components + c)]; });
  }
}

vtkSmartPointer<vtkImageData> ImageOf(const StressScene& scene)
{
  test::Box box;
  box.cells = scene.cells;
  box.spacing = scene.spacing;
  const vtkSmartPointer<vtkImageData> image = test::MakeImage(box);
  AddField(image, "sigma_a", scene.absorption, scene.channels);
  AddField(image, "sigma_s", scene.scattering, scene.channels);
  AddField(image, "emission", scene.emission, scene.channels);
  AddField(image, "ior", scene.index, 1);
  test::AddValues<vtkDoubleArray>(image->GetFieldData(), "g", 1, 1, [&](vtkIdType, int) { return scene.g; });
  return image;
}

void AddLamp(vtkLightRig* rig, const Lamp& lamp, const StressScene& scene)
{
  const Vector &at = lamp.at, &to = lamp.along, &p = lamp.power;
  const double width = lamp.width > 0.0 ? lamp.width : 0.5 * scene.spacing[0];
  switch (lamp.kind)
  {
    case Lamp::Sun: rig->AddDirectionalLight(to[0], to[1], to[2], p[0], p[1], p[2]); break;
    case Lamp::Point: rig->AddPointLight(at[0], at[1], at[2], p[0], p[1], p[2]); break;
    case Lamp::Spot: rig->AddSpotLight(at[0], at[1], at[2], to[0], to[1], to[2], p[0], p[1], p[2], 60.0); break;
    case Lamp::Rectangle:
      rig->AddRectangleLight(at[0], at[1], at[2], to[0], to[1], to[2], p[0], p[1], p[2], width, width);
      break;
  }
}

void SetRig(vtkLightRig* rig, const StressScene& scene)
{
  rig->SetSun(false);
  for (const Lamp& lamp : scene.lamps)
  {
    AddLamp(rig, lamp, scene);
  }
}

std::vector<float> Floats(vtkDataSetAttributes* attributes, const char* name)
{
  std::vector<float> values;
  vtkDataArray* array = attributes->GetArray(name);
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    values.push_back(static_cast<float>(array->GetComponent(i / components, static_cast<int>(i % components))));
  }
  return values;
}

std::vector<double> Facts(vtkDataObject* data, const char* name)
{
  std::vector<double> values;
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    values.push_back(array->GetComponent(i / components, static_cast<int>(i % components)));
  }
  return values;
}

void ReadLight(vtkImageData* image, StressOutcome& outcome)
{
  vtkCellData* cells = image->GetCellData();
  outcome.empty = image->GetNumberOfCells() == 0;
  outcome.fluence = Floats(cells, "fluence");
  outcome.fluenceDirect = Floats(cells, "fluence_direct");
  outcome.fluenceError = Floats(cells, "fluence_error");
  outcome.netFlux = Floats(cells, "net_flux");
  outcome.directions = Floats(cells, "mean_direction");
  outcome.balance = Facts(image, "energy_balance");
  outcome.facePowerOut = Facts(image, "face_power_out");
  outcome.halfRangeFlux = Facts(image, "half_range_flux");
  outcome.scattered = Facts(image, "scattered");
  vtkDataArray* fluence = cells->GetArray("fluence");
  outcome.channels = fluence ? fluence->GetNumberOfComponents() : 1;
}

void RunMaps(
  StressSolver solver, const StressScene& scene, double tolerance, Listener* listener, StressOutcome& outcome)
{
  vtkNew<vtkLightRig> rig;
  SetRig(rig, scene);
  vtkNew<vtkLightPropagationMaps> maps;
  listener->Hear(rig);
  listener->Hear(maps);
  maps->SetInputDataObject(ImageOf(scene));
  maps->SetLightsConnection(rig->GetOutputPort());
  maps->SetSkyColor(scene.sky.data());
  maps->SetFaceRadiance(scene.faces.data());
  maps->SetPeriodicX(scene.periodic[0]);
  maps->SetPeriodicY(scene.periodic[1]);
  maps->SetPeriodicZ(scene.periodic[2]);
  maps->SetNetFlux(true);
  maps->SetTolerance(tolerance);
  maps->SetAngularDegree(0); // the similarity relation, as the twins of the row of g have it
  const bool sequential = solver == StressSolver::MapsSequential;
  if (sequential || solver == StressSolver::MapsParallel)
  {
    maps->SetScheme(vtkLightPropagationMaps::PUBLISHED);
    maps->SetAlgorithm(sequential ? vtkLightPropagationMaps::SEQUENTIAL : vtkLightPropagationMaps::PARALLEL);
  }
  maps->SetLeaveOut(solver != StressSolver::MapsAll);
  maps->SetAngularDegree(solver == StressSolver::MapsMoments ? -1 : 0);
  if (!EndsByTolerance(solver))
  {
    maps->SetSource(vtkLightPropagationMaps::CONSTANT);
    maps->SetAcceleration(vtkLightPropagationMaps::NONE);
    maps->SetMaximumOrders(solver == StressSolver::MapsByOrders ? StressOrders : StressOrdersPublished);
  }
  maps->Update();
  outcome.residual = maps->GetResidual() / maps->GetTolerance();
  ReadLight(maps->GetOutput(), outcome);
}

void RunOrdinates(const StressScene& scene, Listener* listener, StressOutcome& outcome)
{
  vtkNew<vtkLightRig> rig;
  SetRig(rig, scene);
  vtkNew<vtkDiscreteOrdinates> ordinates;
  listener->Hear(rig);
  listener->Hear(ordinates);
  ordinates->SetInputDataObject(ImageOf(scene));
  ordinates->SetLightsConnection(rig->GetOutputPort());
  ordinates->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
  std::array<double, 6> faces = scene.faces;
  ordinates->SetFaceRadiance(faces.data());
  ordinates->SetPeriodicX(scene.periodic[0]);
  ordinates->SetPeriodicY(scene.periodic[1]);
  ordinates->SetPeriodicZ(scene.periodic[2]);
  ordinates->SetNetFlux(true);
  ordinates->SetMaximumOrders(StressOrdersOrdinates);
  ordinates->Update();
  outcome.residual = ordinates->GetResidual() / ordinates->GetTolerance();
  ReadLight(ordinates->GetOutput(), outcome);
}

void RunLattice(int directions, const StressScene& scene, double tolerance, Listener* listener, StressOutcome& outcome)
{
  vtkNew<vtkLightRig> rig;
  SetRig(rig, scene);
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  listener->Hear(rig);
  listener->Hear(lattice);
  lattice->SetInputDataObject(ImageOf(scene));
  lattice->SetLightsConnection(rig->GetOutputPort());
  lattice->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
  std::array<double, 6> faces = scene.faces;
  lattice->SetFaceRadiance(faces.data());
  lattice->SetPeriodicX(scene.periodic[0]);
  lattice->SetPeriodicY(scene.periodic[1]);
  lattice->SetPeriodicZ(scene.periodic[2]);
  lattice->SetLattice(directions);
  lattice->SetNetFlux(true);
  lattice->SetTolerance(tolerance);
  lattice->Update();
  outcome.residual = lattice->GetResidual() / lattice->GetTolerance();
  ReadLight(vtkImageData::SafeDownCast(lattice->GetOutputDataObject(0)), outcome);
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

  PhotonChain(StressSolver solver, StressScene scene, Listener* listener)
  {
    SetRig(this->rig, scene);
    if (solver == StressSolver::Octree && scene.index.empty())
    {
      scene.index.assign(scene.VoxelCount(), 1.0f); // which it groups by extinction then
    }
    const vtkSmartPointer<vtkImageData> medium = ImageOf(scene);
    for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{
           this->rig, this->importance, this->emitter, this->octree, this->marcher, this->reconstruction })
    {
      listener->Hear(filter);
    }
    this->importance->SetInputDataObject(medium);
    this->importance->SetLightsConnection(this->rig->GetOutputPort());
    this->importance->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
    this->emitter->SetInputDataObject(medium);
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetSkyColor(scene.sky[0], scene.sky[1], scene.sky[2]);
    this->emitter->SetPhotonCount(StressPhotons);
    this->octree->SetInputDataObject(medium);
    this->octree->SetIncludeExtinction(true);
    this->marcher->SetInputDataObject(medium);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
    this->reconstruction->SetInputConnection(this->marcher->GetOutputPort());
  }

  void Scatter(StressOutcome& outcome)
  {
    this->marcher->SetMaximumOrders(0);
    this->March(false, outcome);
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

void RunView(bool bent, const StressScene& scene, Listener* listener, StressOutcome& outcome)
{
  for (const bool lit : { true, false })
  {
    vtkNew<vtkMediumRayCaster> caster;
    listener->Hear(caster);
    caster->SetInputDataObject(ImageToView(scene, bent, lit));
    caster->SetImageSize(ViewEdge, ViewEdge);
    caster->SetBackgroundRadiance(1.0, 1.0, 1.0);
    if (!lit)
    {
      LookDown(caster, scene);
    }
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

/// How often a photon is scattered, about, until it is absorbed or has left: as often as its mean way through the box
/// has mean free paths, or the square of the box or the thickest voxel if it begins inside.
double ScatteringsOf(const StressScene& scene)
{
  double scatters = 0.0, removes = 0.0, thickest = 0.0, area = 0.0, longest = 0.0, edge = 0.0;
  for (std::size_t i = 0; i < scene.VoxelCount() * static_cast<std::size_t>(scene.channels); ++i)
  {
    const double one = scene.scattering.empty() ? 0.0 : scene.scattering[i];
    scatters += one;
    thickest = std::max(thickest, one);
    removes += one + (scene.absorption.empty() ? 0.0 : scene.absorption[i]);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    area += 2.0 * scene.cells[a] * scene.spacing[a] * scene.cells[b] * scene.spacing[b];
    longest = std::max(longest, scene.cells[axis] * scene.spacing[axis]);
    edge = std::max(edge, scene.spacing[axis]);
  }
  const double mean = scatters / static_cast<double>(scene.VoxelCount() * static_cast<std::size_t>(scene.channels));
  const double volume = static_cast<double>(scene.VoxelCount()) * scene.VoxelVolume();
  const bool inside =
    std::any_of(scene.lamps.begin(), scene.lamps.end(), [](const Lamp& lamp) { return lamp.kind != Lamp::Sun; });
  const double across = std::max(mean * longest, 0.5 * thickest * edge);
  const double way = inside ? across * std::max(1.0, across) : mean * 4.0 * volume / area;
  return scatters > 0.0 ? std::min(way, removes / std::max(removes - scatters, 1e-30)) : 0.0;
}
}

const char* NameOf(StressSolver solver)
{
  static const char* const names[] = { "maps", "maps, all", "maps, moments", "maps, orders", "maps, parallel",
    "maps, sequential", "ordinates", "lattice", "lattice of 6", "photons", "photons, all orders", "photons, published",
    "rebuilt", "rebuilt, published", "octree", "view", "view, bent" };
  return names[static_cast<int>(solver)];
}

bool IsMaps(StressSolver solver)
{
  return solver <= StressSolver::MapsSequential;
}

bool EndsByTolerance(StressSolver solver)
{
  return solver == StressSolver::Maps || solver == StressSolver::MapsAll || solver == StressSolver::MapsMoments ||
    IsLattice(solver);
}

bool IsLattice(StressSolver solver)
{
  return solver == StressSolver::Lattice || solver == StressSolver::LatticeOfSix;
}

bool IsGrid(StressSolver solver)
{
  return IsMaps(solver) || solver == StressSolver::Ordinates || IsLattice(solver);
}

bool CountsOrders(StressSolver solver)
{
  return solver == StressSolver::MapsByOrders || solver == StressSolver::Ordinates;
}

bool IsPhotons(StressSolver solver)
{
  return solver >= StressSolver::Photons && solver <= StressSolver::Octree;
}

bool IsView(StressSolver solver)
{
  return solver >= StressSolver::View;
}

bool Concerns(StressSolver solver, const StressCase& stressCase)
{
  const StressScene& scene = stressCase.scene;
  if (solver == StressSolver::PhotonsScattered)
  {
    return (!scene.lamps.empty() || scene.sky != Vector{}) && ScatteringsOf(scene) <= MostScatterings;
  }
  if (stressCase.forward || solver == StressSolver::MapsMoments)
  {
    return stressCase.forward && (solver == StressSolver::MapsMoments || solver == StressSolver::Ordinates);
  }
  if (IsPhotons(solver))
  {
    return !scene.lamps.empty() || scene.sky != Vector{};
  }
  if (IsView(solver))
  {
    const bool thin = *std::min_element(scene.cells.begin(), scene.cells.end()) < 3; // no room for a ball of glass
    return !(thin && solver == StressSolver::ViewBent) &&
      (stressCase.furnace > 0.0 || !scene.index.empty() || scene.g != 0.0 || stressCase.row == "colours 1e6 apart" ||
        stressCase.row == "hot voxel in vacuum" || (stressCase.row == "power" && !scene.emission.empty()));
  }
  return true;
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

StressOutcome RunStress(StressSolver solver, const StressScene& scene, double tolerance)
{
  StressOutcome outcome;
  vtkNew<Listener> listener;
  listener->Outcome = &outcome;
  const double start = WallSeconds();
  if (IsMaps(solver))
  {
    RunMaps(solver, scene, tolerance, listener, outcome);
  }
  else if (solver == StressSolver::Ordinates)
  {
    RunOrdinates(scene, listener, outcome);
  }
  else if (IsLattice(solver))
  {
    RunLattice(solver == StressSolver::Lattice ? 18 : 6, scene, tolerance, listener, outcome);
  }
  else if (IsView(solver))
  {
    RunView(solver == StressSolver::ViewBent, scene, listener, outcome);
  }
  else
  {
    PhotonChain chain(solver, scene, listener);
    switch (solver)
    {
      case StressSolver::Rebuilt:
      case StressSolver::RebuiltPublished: chain.Rebuild(solver == StressSolver::RebuiltPublished, outcome); break;
      case StressSolver::PhotonsScattered: chain.Scatter(outcome); break;
      case StressSolver::Octree: chain.MarchThroughOctree(outcome); break;
      default: chain.March(solver == StressSolver::PhotonsPublished, outcome);
    }
  }
  outcome.seconds = WallSeconds() - start;
  return outcome;
}
}
