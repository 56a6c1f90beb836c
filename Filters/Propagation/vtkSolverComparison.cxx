#include "vtkSolverComparison.h"

#include "Common/Failure.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Comparison/SolverComparison.h"
#include "Numerics/NumberText.h"
#include "Photons/RefractiveInput.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/UpdateExtent.h"
#include "Scene/MeshSolids.h"
#include "Viewing/CasterProperties.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace
{
using Row = tyndall::ComparisonRow;

void AddTexts(
  vtkTable* table, const char* name, const std::vector<Row>& rows, const std::function<std::string(const Row&)>& text)
{
  vtkNew<vtkStringArray> column;
  column->SetName(name);
  for (const Row& row : rows)
  {
    column->InsertNextValue(text(row));
  }
  table->AddColumn(column);
}

template <class Array = vtkDoubleArray>
void AddNumbers(
  vtkTable* table, const char* name, const std::vector<Row>& rows, const std::function<double(const Row&)>& number)
{
  vtkNew<Array> column;
  column->SetName(name);
  for (const Row& row : rows)
  {
    column->InsertNextValue(static_cast<typename Array::ValueType>(number(row)));
  }
  table->AddColumn(column);
}

/// For charts: adds a column `error of METHOD` for each method that has rows, with `error_l2` in its rows and NaN in
/// the rows of other methods.
void AddErrorsByMethod(vtkTable* table, const std::vector<Row>& rows)
{
  std::set<tyndall::ComparedMethod> methods;
  for (const Row& row : rows)
  {
    methods.insert(row.method);
  }
  for (const tyndall::ComparedMethod method : methods)
  {
    AddNumbers(table, (std::string("error of ") + tyndall::NameOf(method)).c_str(), rows,
      [method](const Row& row) { return row.method == method ? row.errorL2 : Row::Unknown; });
  }
}

void AddFacePower(vtkTable* table, const std::vector<Row>& rows)
{
  vtkNew<vtkDoubleArray> column;
  column->SetName("face_power_out");
  column->SetNumberOfComponents(6);
  const char* const faces[] = { "-x", "+x", "-y", "+y", "-z", "+z" };
  for (int face = 0; face < 6; ++face)
  {
    column->SetComponentName(face, faces[face]);
  }
  for (const Row& row : rows)
  {
    column->InsertNextTuple(row.facePowerOut.data());
  }
  table->AddColumn(column);
}

std::string SizeOf(const Row& row)
{
  const std::array<int, 3>& size = row.grid.size;
  return std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]);
}

/// Describes a recommended row of the table to the user.
/// @param row  null: there is none
std::string InWords(const Row* row)
{
  return row ? std::string(tyndall::NameOf(row->method)) + ", " + row->setting + ": " +
      tyndall::Text("%.3g", row->seconds) + " s, error " + tyndall::Text("%.2g", 100.0 * row->errorL2) + "%"
             : "";
}

void Write(const tyndall::Comparison& comparison, vtkTable* table)
{
  const std::vector<Row>& rows = comparison.rows;
  const Row* const recommended = tyndall::RecommendedOf(rows);
  AddTexts(table, "method", rows, [](const Row& row) { return tyndall::NameOf(row.method); });
  AddTexts(table, "setting", rows, [](const Row& row) { return row.setting; });
  AddTexts(table, "quantity", rows, [](const Row& row) { return tyndall::NameOf(tyndall::QuantityOf(row.method)); });
  AddTexts(table, "grid", rows, SizeOf);
  AddNumbers(table, "seconds", rows, [](const Row& row) { return row.seconds; });
  AddNumbers(table, "core_seconds", rows, [](const Row& row) { return row.coreSeconds; });
  AddNumbers(table, "peak_bytes", rows, [](const Row& row) { return row.peakBytes; });
  AddNumbers(table, "error_l2", rows, [](const Row& row) { return row.errorL2; });
  AddNumbers(table, "error_max", rows, [](const Row& row) { return row.errorMax; });
  AddNumbers(table, "error_relative", rows, [](const Row& row) { return row.errorRelative; });
  AddNumbers(table, "balance", rows, [](const Row& row) { return row.balance; });
  AddNumbers<vtkIntArray>(table, "iterations", rows, [](const Row& row) { return row.iterations; });
  AddNumbers(table, "estimated_error", rows, [](const Row& row) { return row.estimatedError; });
  AddFacePower(table, rows);
  AddNumbers(table, "power_in", rows, [](const Row& row) { return row.powerIn; });
  AddNumbers<vtkIntArray>(table, "pareto", rows, [](const Row& row) { return row.pareto ? 1 : 0; });
  AddNumbers<vtkIntArray>(table, "recommended", rows, [](const Row& row) { return row.recommended ? 1 : 0; });
  AddTexts(table, "filters", rows, [](const Row& row) { return row.filters; });
  AddErrorsByMethod(table, rows);
  tyndall::AddFact(table, "reference", std::vector<std::string>{ comparison.reference.text });
  tyndall::AddFact(table, "recommended", std::vector<std::string>{ InWords(recommended) });
  tyndall::AddFact(table, "left_out", comparison.leftOut);
  tyndall::AddFact(table, "device", std::vector<std::string>{ comparison.device });
}

/// Reads the mesh of input 4, and its material from the medium that was made of it.
/// @return no value if `mesh` is null
/// @throws InvalidInput if the medium has no occupancy, or as tyndall::MaterialsOf
std::optional<tyndall::VoxelizedMaterials> ReadMesh(
  vtkPolyData* mesh, vtkImageData* image, const tyndall::RefractiveInput& read, const tyndall::OwnAxes& axes)
{
  if (!mesh)
  {
    return std::nullopt;
  }
  tyndall::StopIfUpstreamFailed(mesh);
  const tyndall::FloatField occupancy = tyndall::ReadCells(image, "occupancy", tyndall::Need::Optional, { 1 });
  tyndall::Require(occupancy.IsThere(),
    "A Mesh is connected, but the medium has no cell array 'occupancy': connect the medium that MeshVoxelizer made of "
    "this mesh, or no mesh.");
  tyndall::TriangleMesh triangles =
    std::move(tyndall::SolidsOf(mesh, "The mesh", "", 0, [](int) { return tyndall::Material(); }).front().mesh);
  for (std::array<double, 3>& point : triangles.points)
  {
    point = axes.Place(point);
  }
  return tyndall::MaterialsOf(read.input.medium, read.ior, occupancy, std::move(triangles));
}

/// Writes the reference to an image (output 1).
/// @param given  whether the reference is from input 3, and so may have NaN in voxels where it is not known
void Write(tyndall::ReferenceLight&& reference, bool given, vtkImageData* image)
{
  const std::array<int, 3>& size = reference.grid.size;
  image->SetExtent(0, size[0], 0, size[1], 0, size[2]);
  image->SetSpacing(reference.grid.spacing.data());
  image->SetOrigin(reference.grid.origin.data());
  image->SetDirectionMatrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  const std::pair<const char*, std::vector<float>*> arrays[] = { { "fluence", &reference.fluence },
    { "fluence_direct", &reference.fluenceDirect } };
  for (const auto& [name, values] : arrays)
  {
    if (!values->empty())
    {
      const auto add = given ? tyndall::AddGivenLight : tyndall::AddLight;
      add(image, name, std::move(*values), reference.channels);
    }
  }
  tyndall::AddFact(image, "reference", std::vector<std::string>{ reference.text });
}

/// Copies a cell array of the reference, with NaN in hidden cells, so that these are not compared.
std::vector<float> Copied(const tyndall::FloatField& field, vtkImageData* image)
{
  if (!field.IsThere())
  {
    return {};
  }
  const auto components = static_cast<std::size_t>(field.Components());
  const auto voxels = static_cast<std::size_t>(image->GetNumberOfCells());
  std::vector<float> values(field.Values(), field.Values() + voxels * components);
  const std::vector<unsigned char> hidden = tyndall::HiddenCells(image);
  for (std::size_t i = 0; i < hidden.size() * components; ++i)
  {
    values[i] = hidden[i / components] ? std::numeric_limits<float>::quiet_NaN() : values[i];
  }
  return values;
}

/// Reads the reference from the image of input 3.
/// @return the reference; none if `image` is null
std::optional<tyndall::ReferenceLight> ReadReference(vtkImageData* image)
{
  if (!image)
  {
    return std::nullopt;
  }
  tyndall::StopIfUpstreamFailed(image);
  const tyndall::FloatField fluence = tyndall::ReadCells(image, "fluence", tyndall::Need::Optional);
  const tyndall::FloatField direct = tyndall::ReadCells(image, "fluence_direct", tyndall::Need::Optional);
  tyndall::Require(fluence.IsThere() || direct.IsThere(),
    "The reference has neither an array 'fluence' nor 'fluence_direct'. Its cell arrays: " +
      tyndall::NamesOf(image->GetAttributes(vtkDataObject::CELL)) + ". Connect light of a solver, or no reference.");
  tyndall::Require(!fluence.IsThere() || !direct.IsThere() || fluence.Components() == direct.Components(),
    "The reference's 'fluence' and 'fluence_direct' must have as many components as each other.");
  tyndall::ReferenceLight reference;
  reference.grid = tyndall::GridOf(image);
  reference.channels = (fluence.IsThere() ? fluence : direct).Components();
  reference.fluence = Copied(fluence, image);
  reference.fluenceDirect = Copied(direct, image);
  auto* const text = vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray("reference"));
  reference.text = text && text->GetNumberOfValues() == 1 ? text->GetValue(0) : "the image that is connected";
  return reference;
}

}

vtkStandardNewMacro(vtkSolverComparison);

vtkSolverComparison::vtkSolverComparison()
  : Tried(std::make_unique<tyndall::ComparedSettings>())
{
  const tyndall::ComparisonSettings defaults;
  this->Repeats = defaults.repeats;
  this->TimeBudget = defaults.timeBudget;
  this->AcceptedError = defaults.acceptedError;
  this->EstimateError = defaults.estimates;
  this->SetNumberOfInputPorts(MESH + 1);
  this->SetNumberOfOutputPorts(2);
}

vtkSolverComparison::~vtkSolverComparison() = default;

vtkTable* vtkSolverComparison::GetOutput()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(0));
}

// Defines the methods that add a value to a list property and that clear the list; VTK has no macro for these.
#define LIST_OF_NUMBERS(type, add, removeAll, list) \
  void vtkSolverComparison::add(type value)         \
  {                                                 \
    this->Tried->list.push_back(value);             \
    this->Modified();                               \
  }                                                 \
  void vtkSolverComparison::removeAll()             \
  {                                                 \
    this->Tried->list.clear();                      \
    this->Modified();                               \
  }
LIST_OF_NUMBERS(int, AddDirections, RemoveAllDirections, directionsPerFace)
LIST_OF_NUMBERS(int, AddMapResolution, RemoveAllMapResolutions, mapResolutions)
LIST_OF_NUMBERS(int, AddCoarsening, RemoveAllCoarsenings, coarsenings)
LIST_OF_NUMBERS(int, AddOrders, RemoveAllOrders, orders)
LIST_OF_NUMBERS(int, AddPhotonCount, RemoveAllPhotonCounts, photonCounts)
LIST_OF_NUMBERS(int, AddTerms, RemoveAllTerms, terms)
LIST_OF_NUMBERS(int, AddIntegratorOrder, RemoveAllIntegratorOrders, integratorOrders)
LIST_OF_NUMBERS(double, AddStepSize, RemoveAllStepSizes, stepSizes)
LIST_OF_NUMBERS(double, AddOctreeTolerance, RemoveAllOctreeTolerances, octreeTolerances)
LIST_OF_NUMBERS(int, AddSupersamplingFactor, RemoveAllSupersamplingFactors, supersamplings)
LIST_OF_NUMBERS(int, AddFilterSize, RemoveAllFilterSizes, filterSizes)
#undef LIST_OF_NUMBERS

int vtkSolverComparison::FillInputPortInformation(int port, vtkInformation* information)
{
  if (port != MESH)
  {
    return this->Superclass::FillInputPortInformation(port, information);
  }
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSolverComparison::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkTable" : "vtkImageData");
  return 1;
}

tyndall::ComparisonSettings vtkSolverComparison::Settings(const tyndall::ComparedScene& scene) const
{
  using tyndall::ComparedMethod;
  const std::pair<bool, ComparedMethod> methods[] = {
    { this->LightPropagationMaps, ComparedMethod::LightPropagationMaps },
    { this->ConstantSource, ComparedMethod::ConstantSource },
    { this->AsPublished, ComparedMethod::Published },
    { this->AsPublishedSequential, ComparedMethod::PublishedSequential },
    { this->DiscreteOrdinates, ComparedMethod::DiscreteOrdinates },
    { this->LatticeBoltzmann, ComparedMethod::LatticeBoltzmann },
    { this->Photons, ComparedMethod::Photons },
    { this->AdaptivePhotons, ComparedMethod::AdaptivePhotons },
    { this->PublishedPhotons, ComparedMethod::PublishedPhotons },
    { this->MonteCarlo, ComparedMethod::MonteCarlo },
    { this->PhotonsThenMaps, ComparedMethod::PhotonsThenMaps },
    { scene.mesh != nullptr, ComparedMethod::Voxelizer },
    { this->Pictures, ComparedMethod::Pictures },
  };
  tyndall::ComparisonSettings settings;
  settings.methods.clear();
  for (const auto& [on, method] : methods)
  {
    if (on)
    {
      settings.methods.push_back(method);
    }
  }
  settings.tried = *this->Tried;
  tyndall::ComparedSettings& tried = settings.tried;
  tried.previews = this->Previews;
  tried.tolerance = this->Tolerance;
  tried.monteCarloReference = static_cast<tyndall::MonteCarloReference>(this->MonteCarloReference);
  if (this->AllSamplers)
  {
    using tyndall::Sampler;
    tried.samplers = { Sampler::Hammersley, Sampler::Halton, Sampler::Jittered, Sampler::Grid, Sampler::Random };
  }
  settings.repeats = this->Repeats;
  settings.timeBudget = this->TimeBudget;
  settings.acceptedError = this->AcceptedError;
  settings.estimates = this->EstimateError;
  return settings;
}

int vtkSolverComparison::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({});
  tyndall::WorkOnSubdomains work; // on the first rank only: work on other ranks would distort the timings
  work.port = MEDIUM;
  work.others = { REFERENCE };
  work.work = [&](const tyndall::PieceBlocks&, vtkInformationVector** inputs) {
    if (tyndall::IsFirstPiece(request, outputs))
    {
      this->Compare(inputs, outputs);
    }
    return true;
  };
  return tyndall::Guarded(this, request, given, outputs, work);
}

void vtkSolverComparison::Compare(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const tyndall::RefractiveInput read = tyndall::ReadRefractiveMedium(this, vtkImageData::GetData(inputs[MEDIUM]));
  tyndall::ComparedScene scene;
  scene.medium = read.input.medium;
  scene.ior = read.ior;
  scene.levels = read.Levels();
  scene.periodic = { this->PeriodicX, this->PeriodicY, this->PeriodicZ };
  tyndall::IlluminationInput shining = this->ReadAllIllumination(inputs, read.input.Emits());
  const std::array<tyndall::Rgb, 6>& faces = shining.illumination.faces;
  scene.suitsEmitter = !shining.isDefaultSky && faces == std::array<tyndall::Rgb, 6>();
  scene.illumination = std::move(shining.illumination);
  const std::optional<tyndall::VoxelizedMaterials> mesh =
    ReadMesh(vtkPolyData::GetData(inputs[MESH]), vtkImageData::GetData(inputs[MEDIUM]), read, tyndall::OwnAxesOf(this));
  scene.mesh = mesh ? &*mesh : nullptr;
  this->TakeCamera(scene);
  const std::optional<tyndall::ReferenceLight> reference = ReadReference(vtkImageData::GetData(inputs[REFERENCE]));
  tyndall::Comparison comparison = tyndall::CompareSolvers(*tyndall::Device::Find(this->Device), scene,
    this->Settings(scene), reference ? &*reference : nullptr, tyndall::MonitorOf(this));
  TellOfDefaultSky(shining, comparison.leftOut);
  Write(comparison, this->GetOutput());
  this->TellOfIgnored(comparison, vtkImageData::GetData(inputs[MEDIUM]));
  this->Note(comparison);
  Write(std::move(comparison.reference), reference.has_value(), vtkImageData::GetData(outputs, REFERENCE_OUTPUT));
  for (const std::string& warning : comparison.warnings)
  {
    vtkWarningMacro(<< warning);
  }
}

/// Sets the camera of the compared pictures from the filter's properties. If position and focal point are the same,
/// there is no camera, and no pictures are compared.
void vtkSolverComparison::TakeCamera(tyndall::ComparedScene& scene)
{
  const tyndall::Camera camera = tyndall::CameraSetOn(this);
  if (camera.position != camera.focalPoint)
  {
    scene.camera = tyndall::InOwnAxes(camera, tyndall::OwnAxesOf(this));
  }
  std::copy_n(this->ImageSize, 2, scene.imageSize.begin());
}

/// Warns, also in field data, if the medium's refractive index is not 1 everywhere and a compared method ignores it.
void vtkSolverComparison::TellOfIgnored(const tyndall::Comparison& comparison, vtkImageData* medium)
{
  // Light propagation maps and discrete ordinates, the methods up to DiscreteOrdinates, ignore the refractive index.
  const bool ofMaps = std::any_of(comparison.rows.begin(), comparison.rows.end(),
    [](const auto& row) { return row.method <= tyndall::ComparedMethod::DiscreteOrdinates; });
  const std::vector<std::string> ignored =
    tyndall::IgnoredIndex(ofMaps && tyndall::IsUnusual(this, tyndall::RefractiveIndex, medium, "ior", 1.0f));
  if (!ignored.empty())
  {
    tyndall::AddFact(this->GetOutput(), tyndall::IgnoredFact, ignored);
    vtkWarningMacro("Light of maps and ordinates does not depend on the medium's " << ignored.front() << ".");
  }
}

void vtkSolverComparison::Note(const tyndall::Comparison& comparison)
{
  this->ReferenceText = comparison.reference.text;
  const Row* const recommended = tyndall::RecommendedOf(comparison.rows);
  this->Recommended = InWords(recommended);
  this->RecommendedFilters = recommended ? recommended->filters : "";
  this->DeviceName = comparison.device;
  tyndall::NoteLeftOut(this, tyndall::Lines(comparison.leftOut));
}

void vtkSolverComparison::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(LightPropagationMaps, ConstantSource, AsPublished, AsPublishedSequential, DiscreteOrdinates,
    LatticeBoltzmann, Photons, AdaptivePhotons, PublishedPhotons, MonteCarlo, PhotonsThenMaps, Previews, Pictures,
    CameraPosition, CameraFocalPoint, CameraViewUp, CameraViewAngle, ImageSize, AllSamplers, MonteCarloReference,
    Repeats, TimeBudget, AcceptedError, ReferenceText, Recommended, RecommendedFilters, DeviceName);
  const tyndall::ComparedSettings& tried = *this->Tried;
  tyndall::PrintMembers(os, indent,
    "Directions, MapResolutions, Coarsenings, Orders, PhotonCounts, Terms, IntegratorOrders, StepSizes, "
    "OctreeTolerances, SupersamplingFactors, FilterSizes",
    tried.directionsPerFace, tried.mapResolutions, tried.coarsenings, tried.orders, tried.photonCounts, tried.terms,
    tried.integratorOrders, tried.stepSizes, tried.octreeTolerances, tried.supersamplings, tried.filterSizes);
  tyndall::PrintRun(os, indent, this);
}
