#include "vtkMeshVoxelizer.h"

#include "Common/Failure.h"
#include "Common/LightTransportData.h"
#include "Common/PhaseFunctionData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Refraction/Index/RefractiveMedium.h"
#include "Scene/MeshSolids.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <utility>

namespace
{
using tyndall::Material;
using tyndall::RefractiveMedium;
using tyndall::Rgb;
using tyndall::Solid;
using tyndall::Triple;

const char* const DefaultNumbers = "material_id";
constexpr std::size_t NumbersOfMaterial = 9;

/// Name of the cell array of material numbers. The default array is selected by an empty name or, in ParaView's panel,
/// "(by name)".
/// @throws InvalidInput if the selected array is a point array, or if no mesh has it and it is not the default array
std::string NumbersArray(vtkMeshVoxelizer* filter, const std::vector<vtkPolyData*>& meshes)
{
  vtkInformation* chosen = filter->GetInputArrayInformation(0);
  const std::string name = chosen->Has(vtkDataObject::FIELD_NAME()) ? chosen->Get(vtkDataObject::FIELD_NAME()) : "";
  if (name.empty() || name == "(by name)")
  {
    return DefaultNumbers;
  }
  if (chosen->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_POINTS)
  {
    throw tyndall::InvalidInput(
      "The numbers of materials are to be '" + name + "' of points; they must be an array of cells.");
  }
  const auto hasIt = [&](vtkPolyData* mesh) { return mesh->GetCellData()->HasArray(name.c_str()) != 0; };
  tyndall::Require(name == DefaultNumbers || meshes.empty() || !std::none_of(meshes.begin(), meshes.end(), hasIt),
    (meshes.size() == 1 ? "The mesh has" : "The meshes have") + std::string(" no cell array '") + name +
      "' with numbers of materials. Cell arrays: " + tyndall::NamesOf(meshes.front()->GetCellData()) + ".");
  return name;
}

std::vector<vtkPolyData*> MeshesOf(vtkInformationVector* inputs)
{
  std::vector<vtkPolyData*> meshes;
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    meshes.push_back(vtkPolyData::GetData(inputs, i));
    if (meshes.back()->GetNumberOfCells() == 0)
    {
      tyndall::StopIfUpstreamFailed(meshes.back());
    }
  }
  return meshes;
}

bool IsOn(const double bounds[6])
{
  return std::any_of(bounds, bounds + 6, [](double bound) { return bound != 0.0; });
}

tyndall::Grid GridIn(const double bounds[6], const int size[3])
{
  tyndall::Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = bounds[2 * axis];
    const double high = bounds[2 * axis + 1];
    if (!(low < high))
    {
      throw tyndall::InvalidInput("ModelBounds reach from " + tyndall::Text("%g", low) + " to " +
        tyndall::Text("%g", high) + " along " + std::string(1, "xyz"[axis]) +
        "; the latter must be larger. All 0: a box around the meshes.");
    }
    grid.size[axis] = size[axis];
    grid.origin[axis] = low;
    grid.spacing[axis] = (high - low) / std::max(size[axis], 1);
  }
  return grid;
}

double LongestEdge(const tyndall::Grid& grid)
{
  return std::max({ grid.Length(0), grid.Length(1), grid.Length(2) });
}

/// Scattering coefficients outside the meshes, 1/length: OutsideScattering or, if that is below 0, coefficients for
/// which the box's longest edge has a scattering optical thickness of 0.5. Rays of light are then visible, but little
/// attenuated.
Rgb OutsideScattering(const double asked[3], const tyndall::Grid& grid)
{
  const bool automatic = std::all_of(asked, asked + 3, [](double value) { return value < 0.0; });
  const double edge = LongestEdge(grid); // 0 for a grid without voxels, for which the voxelizer throws
  const double suiting = edge > 0.0 ? 0.5 / edge : 0.0;
  return automatic ? Rgb{ suiting, suiting, suiting } : Triple(asked);
}

tyndall::RefractiveMediumSettings SettingsOf(vtkMeshVoxelizer* filter, const std::vector<Solid>& solids)
{
  tyndall::RefractiveMediumSettings settings;
  const int* size = filter->GetSampleDimensions();
  settings.grid = IsOn(filter->GetModelBounds())
    ? GridIn(filter->GetModelBounds(), size)
    : tyndall::GridAround(solids, { size[0], size[1], size[2] }, filter->GetMargin(), filter->GetFilterSize());
  settings.outside = { filter->GetOutsideIndex(), Triple(filter->GetOutsideAbsorption()),
    OutsideScattering(filter->GetOutsideScattering(), settings.grid), filter->GetOutsideMeanCosine() };
  const double noiseSize = filter->GetNoiseSize() == 0.0 ? LongestEdge(settings.grid) / 8.0 : filter->GetNoiseSize();
  settings.perturbation = { filter->GetIndexNoise(), filter->GetScatteringNoise(), noiseSize,
    static_cast<std::uint32_t>(filter->GetNoiseSeed()) };
  settings.voxelization.samples = filter->GetSupersamplingFactor();
  settings.filterSize = filter->GetFilterSize();
  settings.leaveOut = filter->GetLeaveOut();
  return settings;
}

/// Voxels that the pipeline requests from this rank.
struct AskedVoxels
{
  tyndall::VoxelBox made; ///< requested voxels with ghost cells; empty if there are more ranks than voxels
  tyndall::VoxelBox own;
  bool ofWhole = false; ///< whether all ranks together request the complete grid
};

/// Voxels of an extent of points, clamped to the grid; an extent of one point along an axis has one layer of voxels.
tyndall::VoxelBox VoxelsOf(const std::array<int, 6>& extent, const tyndall::Grid& grid)
{
  tyndall::VoxelBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int low = std::clamp(extent[2 * axis], 0, grid.size[axis] - 1);
    box.first[axis] = low;
    box.size[axis] = std::clamp(extent[2 * axis + 1], low + 1, grid.size[axis]) - low;
  }
  return box;
}

/// Voxels that the pipeline requests from this rank.
/// @param output  information of the output, with the update extent and piece
/// @param divided  whether each rank requests its own piece
AskedVoxels VoxelsAskedFor(vtkInformation* output, const tyndall::Grid& grid, bool divided)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  std::array<int, 6> update;
  output->Get(Pipeline::UPDATE_EXTENT(), update.data());
  const tyndall::AskedPiece piece = tyndall::AskedPieceOf(output, update);
  AskedVoxels asked;
  if (!piece.IsEmpty())
  {
    asked.made = VoxelsOf(piece.withGhosts, grid);
    asked.own = VoxelsOf(piece.own, grid);
  }
  const bool all = VoxelsOf(update, grid).VoxelCount() == grid.VoxelCount();
  asked.ofWhole = all && (divided || output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) <= 1);
  return asked;
}

void Pack(const tyndall::RefractiveMediumSettings& settings, const tyndall::VoxelBox& box,
  tyndall::RefractiveMedium&& medium, vtkImageData* output)
{
  const tyndall::Grid& grid = settings.grid;
  const auto end = [&](int axis) { return box.first[axis] + box.size[axis]; };
  output->SetExtent(box.first[0], end(0), box.first[1], end(1), box.first[2], end(2));
  output->SetOrigin(grid.origin.data());
  output->SetSpacing(grid.spacing.data());
  tyndall::AddCells(output, "occupancy", std::move(medium.occupancy), 1);
  const bool constant = medium.ior.empty();
  if (constant)
  {
    // Writes the constant index, for filters that require the array `ior`
    medium.ior.assign(box.VoxelCount(), static_cast<float>(settings.outside.n));
  }
  tyndall::AddCells(output, "ior", std::move(medium.ior), 1);
  if (!constant)
  {
    tyndall::AddCells(output, "ior_gradient", std::move(medium.iorGradient), 3);
  }
  tyndall::AddCells(output, "sigma_a", std::move(medium.sigma_a), medium.components);
  tyndall::AddCells(output, "sigma_s", std::move(medium.sigma_s), medium.components);
  output->GetCellData()->SetActiveScalars("occupancy");
  tyndall::PhaseDescription phase;
  phase.g.fill(medium.g);
  phase.gByVoxel = !medium.gByVoxel.empty();
  tyndall::WritePhaseDescription(output, phase);
  if (phase.gByVoxel)
  {
    tyndall::AddCells(output, "g", std::move(medium.gByVoxel), medium.components);
  }
  tyndall::AddFact(output, "left_out", medium.leftOut);
  tyndall::AddFact(output, "device", std::vector<std::string>{ medium.device });
}
}

struct vtkMeshVoxelizer::AddedMaterials
{
  std::vector<std::pair<double, Material>> InOrder; ///< materials with their numbers, in the order of addition
  std::vector<double> Numbers;                      ///< arguments given so far of an incomplete material

  /// Checks all materials.
  /// @throws InvalidInput if a material is incomplete or invalid
  void Check() const
  {
    if (!this->Numbers.empty())
    {
      throw tyndall::InvalidInput("The last material has " + std::to_string(this->Numbers.size()) +
        (this->Numbers.size() == 1 ? " number" : " numbers") + "; a material takes " +
        std::to_string(NumbersOfMaterial) +
        ": number, index, scattering red, green, blue, absorption red, green, blue, mean cosine.");
    }
    for (const auto& [number, material] : this->InOrder)
    {
      tyndall::Check(
        material, "Material " + std::to_string(tyndall::MaterialNumber(number, "The number of a material")));
    }
  }
};

vtkStandardNewMacro(vtkMeshVoxelizer);

vtkMeshVoxelizer::vtkMeshVoxelizer()
  : Added(new AddedMaterials)
{
  const tyndall::RefractiveMediumSettings defaults;
  this->SupersamplingFactor = defaults.voxelization.samples;
  this->FilterSize = defaults.filterSize;
  this->LeaveOut = defaults.leaveOut;
  // Replaces the default array of vtkImageAlgorithm, the active scalars, by `material_id`.
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, DefaultNumbers);
}

vtkMeshVoxelizer::~vtkMeshVoxelizer() = default;

void vtkMeshVoxelizer::AddMaterial(double number, double n, double scatteringR, double scatteringG, double scatteringB,
  double absorptionR, double absorptionG, double absorptionB, double g)
{
  this->Added->InOrder.push_back(
    { number, { n, { absorptionR, absorptionG, absorptionB }, { scatteringR, scatteringG, scatteringB }, g } });
  this->Modified();
}

void vtkMeshVoxelizer::AddMaterialNumber(double number)
{
  std::vector<double>& n = this->Added->Numbers;
  n.push_back(number);
  if (n.size() == NumbersOfMaterial)
  {
    this->AddMaterial(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]);
    n.clear();
  }
  this->Modified();
}

void vtkMeshVoxelizer::RemoveAllMaterials()
{
  this->Added->InOrder.clear();
  this->Added->Numbers.clear();
  this->Modified();
}

int vtkMeshVoxelizer::GetNumberOfMaterials() const
{
  return static_cast<int>(this->Added->InOrder.size());
}

int vtkMeshVoxelizer::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  information->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

int vtkMeshVoxelizer::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  tyndall::Grid grid; // default grid without ModelBounds: the meshes, which then determine the box, are not known yet
  tyndall::GuardedInformation(this, [&] {
    if (IsOn(this->ModelBounds))
    {
      grid = GridIn(this->ModelBounds, this->SampleDimensions);
    }
  });
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = 0;
    extent[2 * axis + 1] = std::max(this->SampleDimensions[axis], 1);
  }
  vtkInformation* information = outputs->GetInformationObject(0);
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), grid.origin.data(), 3);
  information->Set(vtkDataObject::SPACING(), grid.spacing.data(), 3);
  return 1;
}

int vtkMeshVoxelizer::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::AskForAll(request, inputs[0], outputs);
  return 1;
}

/// Reads the solids of all meshes, in the order of the inputs.
/// @throws InvalidInput if a mesh, its material numbers or a material is invalid
std::vector<Solid> vtkMeshVoxelizer::ReadSolids(vtkInformationVector** inputs)
{
  this->Added->Check();
  const Material inside = { this->InsideIndex, Triple(this->InsideAbsorption), Triple(this->InsideScattering),
    this->InsideMeanCosine };
  const auto materialOf = [&](int number) {
    const auto& added = this->Added->InOrder;
    const auto found =
      std::find_if(added.rbegin(), added.rend(), [number](const auto& material) { return material.first == number; });
    return found == added.rend() ? inside : found->second;
  };
  const std::vector<vtkPolyData*> meshes = MeshesOf(inputs[0]);
  const std::string numbers = NumbersArray(this, meshes);
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < meshes.size(); ++i)
  {
    const std::string name = meshes.size() == 1 ? "The mesh" : "Mesh " + std::to_string(i);
    std::vector<Solid> ofMesh = tyndall::SolidsOf(meshes[i], name, numbers, static_cast<int>(i), materialOf);
    std::move(ofMesh.begin(), ofMesh.end(), std::back_inserter(solids));
  }
  return solids;
}

void vtkMeshVoxelizer::Note(const RefractiveMedium& medium, double volume, const Rgb& outside)
{
  for (const std::string& warning : medium.warnings)
  {
    vtkWarningMacro(<< warning);
  }
  this->OccupiedVolume = volume;
  std::copy_n(outside.begin(), 3, this->UsedOutsideScattering);
  this->DeviceName = medium.device;
  tyndall::NoteLeftOut(this, tyndall::Lines(medium.leftOut));
}

int vtkMeshVoxelizer::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({}, 0.0, {});
  return tyndall::Guarded(this, request, given, outputs, [&](vtkInformationVector** inputs) {
    const bool divided = tyndall::EachAsksForItsPiece(request, outputs);
    const std::unique_ptr<tyndall::Communicator> communicator =
      tyndall::CommunicatorOf(divided ? tyndall::RanksTogether(request, outputs) : nullptr,
        [this] { return tyndall::IsStoppedByOthers(this); });
    vtkInformation* const asking = outputs->GetInformationObject(0);
    std::vector<Solid> solids;
    tyndall::RefractiveMediumSettings settings;
    AskedVoxels asked;
    tyndall::VoxelizedPart part;
    communicator->Collective([&] {
      solids = this->ReadSolids(inputs);
      settings = SettingsOf(this, solids);
      asked = VoxelsAskedFor(asking, settings.grid, divided);
      part = tyndall::VoxelizePart(
        *tyndall::Device::Find(this->Device), solids, settings, { asked.made, asked.own }, tyndall::MonitorOf(this));
    });
    tyndall::VoxelFindings all = tyndall::FindingsOfAll(*communicator, part.findings);
    all.empty = all.empty && asked.ofWhole;
    tyndall::RefractiveMedium medium = tyndall::Concluded(std::move(part), all, solids, settings);
    this->Note(medium, all.volume, settings.outside.sigma_s);
    vtkImageData* const output = vtkImageData::GetData(outputs);
    if (asked.made.VoxelCount() > 0)
    {
      Pack(settings, asked.made, std::move(medium), output);
    }
    tyndall::KeepWhatIsAskedFor(asking, output);
  });
}

void vtkMeshVoxelizer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(SampleDimensions, ModelBounds, Margin, InsideIndex, OutsideIndex, InsideScattering,
    OutsideScattering, InsideAbsorption, OutsideAbsorption, InsideMeanCosine, OutsideMeanCosine);
  os << indent << "Materials: " << this->GetNumberOfMaterials() << "\n";
  tyndallPrintMacro(IndexNoise, ScatteringNoise, NoiseSize, NoiseSeed, SupersamplingFactor, FilterSize, LeaveOut,
    Device, OccupiedVolume, UsedOutsideScattering, DeviceName);
  tyndall::PrintRun(os, indent, this);
}
