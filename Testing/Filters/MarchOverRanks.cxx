// vtkPhotonEmitter and vtkPhotonMarcher in a pipeline that MPI ranks run together: with Decomposition BLOCKS each has
// its piece of the medium and its share of the photons, and of the light what it has where each has the whole: bit for
// bit, or of the published scheme to what its packing loses. So it is where the medium is turned by a direction matrix,
// which vtkLightPropagationMaps then solves by pieces, too. Run by mpiexec; a program by itself.

#include "OverRanks.h"

#include "vtkLightPropagationMaps.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkRefractionOctree.h"
#include "vtkSun.h"

#include "Device/Device.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageAlgorithm.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace
{
using test::Expect;

constexpr int Size[3] = { 17, 12, 9 };
constexpr double Turned[9] = { 0.48, -0.8, 0.36, 0.64, 0.6, 0.48, 0.6, 0.0, -0.8 }; ///< and mirrored

/// A medium that makes the piece that it is asked for.
class Waves : public vtkImageAlgorithm
{
public:
  static Waves* New();
  vtkTypeMacro(Waves, vtkImageAlgorithm);
  vtkIdType CellsMade = 0; ///< last
  bool IsTurned = false;

protected:
  Waves() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const output = outputs->GetInformationObject(0);
    const int whole[6] = { 0, Size[0], 0, Size[1], 0, Size[2] };
    output->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
    output->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    const double origin[3] = { 0.0, 0.0, 0.0 }, spacing[3] = { 1.0, 1.0, 1.0 };
    output->Set(vtkDataObject::ORIGIN(), origin, 3);
    output->Set(vtkDataObject::SPACING(), spacing, 3);
    if (this->IsTurned)
    {
      output->Set(vtkDataObject::DIRECTION(), Turned, 9);
    }
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const information = outputs->GetInformationObject(0);
    vtkImageData* const image = vtkImageData::GetData(information);
    int e[6];
    information->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), e);
    image->SetExtent(e);
    if (this->IsTurned)
    {
      image->SetDirectionMatrix(Turned);
    }
    this->CellsMade = image->GetNumberOfCells();
    vtkNew<vtkFloatArray> arrays[3];
    const char* const names[3] = { "sigma_a", "sigma_s", "ior" };
    for (int z = e[4]; z < e[5]; ++z)
    {
      for (int y = e[2]; y < e[3]; ++y)
      {
        for (int x = e[0]; x < e[1]; ++x)
        {
          const double wave = std::sin(0.7 * x) * std::sin(0.5 * y) * std::sin(0.9 * z);
          arrays[0]->InsertNextValue(static_cast<float>(0.02 * (1.0 + wave)));
          arrays[1]->InsertNextValue(static_cast<float>(0.05 * (1.0 - wave)));
          arrays[2]->InsertNextValue(static_cast<float>(1.2 + 0.1 * wave));
        }
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      arrays[i]->SetName(names[i]);
      image->GetCellData()->AddArray(arrays[i]);
    }
    return 1;
  }
};
vtkStandardNewMacro(Waves);

/// From the middle of each voxel of a face, aslant.
vtkSmartPointer<vtkPolyData> Photons()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> directions, powers;
  directions->SetName("direction");
  directions->SetNumberOfComponents(3);
  powers->SetName("power");
  for (int i = 0; i < Size[1] * Size[2]; ++i)
  {
    points->InsertNextPoint(0.0, i % Size[1] + 0.5, i / Size[1] + 0.5);
    directions->InsertNextTuple3(0.8, i % 2 == 0 ? 0.6 : -0.6, 0.0);
    powers->InsertNextValue(1.0f);
  }
  vtkNew<vtkPolyData> photons;
  photons->SetPoints(points);
  photons->GetPointData()->AddArray(directions);
  photons->GetPointData()->AddArray(powers);
  return photons;
}

/// Where a scene's octree comes from.
enum class Octree
{
  None,
  InPieces, ///< a filter, of which each rank has its piece
  Whole,    ///< all of it, on each rank
  Elsewhere ///< the same, of a box beside the medium
};

/// How photons are marched.
struct Asked
{
  const char* name;
  int orders = 1, ghosts = 0, paths = 0, batches = 1;
  bool emits = false;                           ///< photons are vtkPhotonEmitter's; else all ranks have the same
  double precision = 0.0;                       ///< of powers, over what entered
  int decomposition = vtkPhotonMarcher::BLOCKS; ///< that is compared with the whole
  Octree octree = Octree::None;
  int integrator = 2;
  int scheme = vtkPhotonMarcher::CONSERVATIVE;
  double packing = 0.0; ///< what it may lose of a voxel's light, over the largest
  bool turned = false;  ///< the medium
};

/// What a rank has of the light.
struct Piece
{
  std::array<int, 6> extent = {};
  std::map<std::string, std::vector<double>> arrays;
  std::vector<double> balance, paths, counts; ///< counts: deposits and steps
  vtkIdType cellsOfMedium = 0, photons = 0, photonsOfAll = 0;
};

std::vector<double> ValuesOf(vtkDataArray* array)
{
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    values.push_back(array->GetVariantValue(i).ToDouble());
  }
  return values;
}

/// Ends, numbers of photons, and corners with what is left there.
std::vector<double> ValuesOf(vtkPolyData* paths)
{
  std::vector<double> values;
  for (vtkDataArray* array : { paths->GetLines()->GetOffsetsArray(), paths->GetCellData()->GetArray("photon"),
         paths->GetPoints() ? paths->GetPoints()->GetData() : nullptr, paths->GetPointData()->GetArray("power_left") })
  {
    const std::vector<double> more = ValuesOf(array);
    values.insert(values.end(), more.begin(), more.end());
  }
  return values;
}

/// Where photons are marched through a medium of its own for the emitter, so that each is asked for what it needs.
struct Scene
{
  Scene(vtkMPIController* ranks, const Asked& asked, int decomposition)
    : Ranks(ranks)
  {
    this->Medium->IsTurned = this->Box->IsTurned = asked.turned;
    if (asked.emits)
    {
      this->Emitter->SetInputConnection(this->Box->GetOutputPort());
      this->Emitter->SetSkyColor(1.0, 2.0, 0.5);
      this->Emitter->SetPhotonCount(999);
      this->Emitter->SetBatches(asked.batches);
      this->Marcher->SetPhotonsConnection(this->Emitter->GetOutputPort());
    }
    else
    {
      this->Marcher->SetPhotonsData(Photons());
    }
    this->Levels->SetInputConnection(this->Medium->GetOutputPort());
    this->Levels->SetTolerance(0.1);
    if (asked.octree == Octree::InPieces)
    {
      this->Marcher->SetOctreeConnection(this->Levels->GetOutputPort());
    }
    if (asked.octree == Octree::Whole || asked.octree == Octree::Elsewhere)
    {
      this->Levels->Update();
      vtkNew<vtkImageData> levels;
      levels->ShallowCopy(this->Levels->GetOutputDataObject(0));
      if (asked.octree == Octree::Elsewhere)
      {
        levels->SetOrigin(Size[0], 0.0, 0.0);
      }
      this->Marcher->SetOctreeData(levels);
      this->Medium->CellsMade = 0;
    }
    this->Marcher->SetInputConnection(this->Medium->GetOutputPort());
    this->Marcher->SetDecomposition(decomposition);
    this->Marcher->SetScheme(asked.scheme);
    this->Marcher->SetMaximumOrders(asked.orders);
    this->Marcher->SetIntegratorOrder(asked.integrator);
    this->Marcher->SetErrorBatches(4);
    this->Marcher->SetPathCount(asked.paths);
  }
  vtkImageData* Update(int ghosts = 0)
  {
    this->Marcher->UpdatePiece(this->Ranks->GetLocalProcessId(), this->Ranks->GetNumberOfProcesses(), ghosts);
    return vtkImageData::SafeDownCast(this->Marcher->GetOutputDataObject(0));
  }

  vtkMPIController* Ranks;
  vtkNew<Waves> Medium, Box;
  vtkNew<vtkRefractionOctree> Levels;
  vtkNew<vtkPhotonEmitter> Emitter;
  vtkNew<vtkPhotonMarcher> Marcher;
};

Piece March(vtkMPIController* controller, const Asked& asked, int decomposition)
{
  Scene scene(controller, asked, decomposition);
  vtkImageData* const light = scene.Update(asked.ghosts);
  Piece piece;
  std::copy_n(light->GetExtent(), 6, piece.extent.begin());
  for (const char* name : { "fluence", "fluence_direct", "fluence_error", "fluence_batches", "mean_direction" })
  {
    piece.arrays[name] = ValuesOf(light->GetCellData()->GetArray(name));
  }
  piece.balance = ValuesOf(light->GetFieldData()->GetArray("energy_balance"));
  piece.paths = ValuesOf(vtkPolyData::SafeDownCast(scene.Marcher->GetOutputDataObject(1)));
  piece.counts = { 1.0 * scene.Marcher->GetDeposits(), 1.0 * scene.Marcher->GetSteps() };
  piece.cellsOfMedium = std::max(scene.Medium->CellsMade, scene.Box->CellsMade);
  piece.photons = scene.Emitter->GetOutput()->GetNumberOfPoints();
  piece.photonsOfAll = scene.Emitter->GetPhotons();
  return piece;
}

/// Bit for bit, or so precise.
bool Same(const std::vector<double>& found, const std::vector<double>& wanted, double precision)
{
  const auto near = [&](double a, double b) { return std::abs(a - b) <= precision * wanted[0]; };
  return found.size() == wanted.size() && std::equal(found.begin(), found.end(), wanted.begin(), near);
}

bool SameArray(const std::vector<double>& found, const std::vector<double>& wanted, double packing)
{
  const double most = wanted.empty() ? 0.0 : *std::max_element(wanted.begin(), wanted.end());
  const auto near = [&](double a, double b) { return std::abs(a - b) <= packing * most; };
  return found.size() == wanted.size() && std::equal(found.begin(), found.end(), wanted.begin(), near);
}

bool HasTheSameLight(vtkMPIController* controller, const Asked& asked)
{
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  const Piece whole = March(controller, asked, vtkPhotonMarcher::WHOLE);
  const Piece block = March(controller, asked, asked.decomposition);
  const vtkIdType all = vtkIdType(1) * Size[0] * Size[1] * Size[2];
  const std::string name = asked.name;
  bool right = Expect(!whole.arrays.at("fluence").empty(), name + ": no light", rank);
  right = Expect(block.extent == whole.extent, name + ": another piece", rank) && right;
  for (const auto& [array, values] : whole.arrays)
  {
    right =
      Expect(SameArray(block.arrays.at(array), values, asked.packing), name + ": another " + array, rank) && right;
  }
  right = Expect(asked.orders == 1 || !whole.arrays.at("fluence_error").empty(), name + ": no error", rank) && right;
  right =
    Expect(asked.batches == 1 || !whole.arrays.at("fluence_batches").empty(), name + ": no batches", rank) && right;
  right = Expect(!block.balance.empty() && Same(block.balance, whole.balance, asked.precision),
            name + ": another energy_balance", rank) &&
    right;
  right = Expect(block.counts == whole.counts, name + ": other counts", rank) && right;
  right = Expect(block.paths == whole.paths && (rank > 0 || asked.paths == 0 || block.paths.size() > 20),
            name + ": other paths", rank) &&
    right;
  right = Expect(whole.cellsOfMedium == all, name + ": had not the whole", rank) && right;
  right = Expect(ranks == 1 || asked.ghosts > 0 || 2 * block.cellsOfMedium <= all + Size[1] * Size[2],
            name + ": had more of the medium than its piece", rank) &&
    right;
  if (asked.emits)
  {
    long own = static_cast<long>(block.photons), sum = 0;
    controller->AllReduce(&own, &sum, 1, vtkCommunicator::SUM_OP);
    right = Expect(sum == whole.photons && own <= whole.photons / ranks + 2 && block.photonsOfAll == sum,
              name + ": no share of the photons", rank) &&
      right;
  }
  std::cout << "rank " << rank << " of " << ranks << ", " << name << ": " << block.cellsOfMedium
            << " cells of the medium instead of " << whole.cellsOfMedium << std::endl;
  return right;
}

/// What blocks cannot do is one error that names it; on one rank the octree is simply another one.
bool NamesWhatItCannot(vtkMPIController* controller)
{
  vtkNew<test::Note> errors;
  Asked asked = { "errors" };
  asked.octree = Octree::Elsewhere;
  Scene scene(controller, asked, vtkPhotonMarcher::BLOCKS);
  scene.Marcher->AddObserver(vtkCommand::ErrorEvent, errors);
  vtkImageData* const light = scene.Update();
  const int rank = controller->GetLocalProcessId();
  const char* const why = controller->GetNumberOfProcesses() > 1 ? "an octree that lies in other pieces"
                                                                 : "Make the octree of the same medium";
  return Expect(errors->said.find(why) != std::string::npos, errors->said, rank) &&
    Expect(light->GetNumberOfCells() == 0, "light", rank);
}

/// Maps solve pieces of a turned medium: the light of the whole, with the matrix and vectors in the scene.
bool SolvesTurnedPieces(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  vtkSmartPointer<vtkImageData> light[2];
  for (const bool blocks : { false, true })
  {
    vtkNew<Waves> medium;
    medium->IsTurned = true;
    vtkNew<vtkSun> sun;
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputConnection(medium->GetOutputPort());
    maps->SetLightsConnection(sun->GetOutputPort());
    maps->SetNetFlux(true);
    maps->SetDecomposition(blocks ? vtkLightPropagationMaps::BLOCKS : vtkLightPropagationMaps::WHOLE);
    maps->UpdatePiece(rank, ranks, 0);
    light[blocks] = maps->GetOutput();
  }
  bool right = Expect(light[1]->GetNumberOfCells() > 0 && light[0]->GetNumberOfCells() == light[1]->GetNumberOfCells(),
    "no turned piece", rank);
  right = Expect(std::equal(Turned, Turned + 9, light[1]->GetDirectionMatrix()->GetData()) &&
              std::equal(Turned, Turned + 9, light[0]->GetDirectionMatrix()->GetData()),
            "light without the matrix", rank) &&
    right;
  for (const char* array : { "fluence", "net_flux" })
  {
    right = Expect(SameArray(ValuesOf(light[1]->GetCellData()->GetArray(array)),
                     ValuesOf(light[0]->GetCellData()->GetArray(array)), 1e-4),
              std::string("another ") + array + " of a turned piece", rank) &&
      right;
  }
  return right;
}

/// What the last rank stops while photons are scattered ends on all, without an error, and can be marched after that.
bool EndsTogether(vtkMPIController* controller)
{
  struct Stop : vtkCommand
  {
    static Stop* New() { return new Stop; }
    void Execute(vtkObject* caller, unsigned long, void* data) override
    {
      if (*static_cast<double*>(data) > 0.1) // scattered photons are on their way
      {
        static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
      }
    }
  };
  const int rank = controller->GetLocalProcessId();
  Scene scene(controller, { "abort", 0 }, vtkPhotonMarcher::BLOCKS);
  vtkNew<Stop> stop;
  if (rank == controller->GetNumberOfProcesses() - 1)
  {
    scene.Marcher->AddObserver(vtkCommand::ProgressEvent, stop);
  }
  bool right = Expect(scene.Update()->GetFieldData()->HasArray("aborted") != 0, "was not stopped", rank);
  right = Expect(scene.Update()->GetNumberOfCells() == 0, "light of a march that was stopped", rank) && right;
  scene.Marcher->RemoveObserver(stop);
  scene.Marcher->SetAbortExecute(0);
  scene.Marcher->SetSeed(2);
  return Expect(scene.Update()->GetNumberOfCells() > 0, "no light after that", rank) && right;
}
}

int main(int argc, char* argv[])
{
  return test::RunOverRanks(argc, argv, [](vtkMPIController* controller) {
    tyndall::Device::Find();
    bool right = true;
    const int automatic = vtkPhotonMarcher::AUTOMATIC_DECOMPOSITION;
    const Asked all[] = { { "photons that all have" }, { "with a ghost layer", 1, 1 }, { "with paths", 1, 0, 9 },
      { "scattered", 0, 1, 0, 1, false, 1e-9 }, { "emitted", 1, 0, 5, 1, true },
      { "emitted in batches", 1, 1, 0, 3, true }, { "emitted, scattered", 3, 0, 5, 1, true, 1e-9 },
      { "automatic", 1, 0, 5, 1, true, 0.0, automatic },
      { "automatic, with an octree", 1, 0, 5, 1, true, 0.0, automatic, Octree::InPieces },
      { "with an octree that all have, order 4", 1, 1, 0, 1, true, 0.0, vtkPhotonMarcher::BLOCKS, Octree::Whole, 4 },
      { "scattered, with an octree", 0, 1, 0, 1, false, 1e-9, automatic, Octree::InPieces },
      { "as published, with an octree", 1, 1, 0, 1, true, 1e-3, automatic, Octree::InPieces, 2,
        vtkPhotonMarcher::PUBLISHED, 0.01 },
      { "emitted, turned, with an octree", 3, 1, 5, 1, true, 1e-9, vtkPhotonMarcher::BLOCKS, Octree::InPieces, 2,
        vtkPhotonMarcher::CONSERVATIVE, 0.0, true } };
    for (const Asked& asked : all)
    {
      right = HasTheSameLight(controller, asked) && right;
    }
    right = SolvesTurnedPieces(controller) && right;
    right = NamesWhatItCannot(controller) && right;
    right = EndsTogether(controller) && right;
    return right;
  });
}
