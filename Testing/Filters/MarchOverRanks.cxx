// vtkPhotonMarcher in a pipeline that MPI ranks run together: with Decomposition BLOCKS each has its piece of the
// medium, and of the light what it has where each has the whole, bit for bit. Run by mpiexec; a program by itself.

#include "vtkPhotonMarcher.h"

#include "Device/Device.h"
#include "Device/Errors.h"

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageAlgorithm.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMPIController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace
{
constexpr int Size[3] = { 17, 12, 9 };

/// A medium that makes the piece that it is asked for.
class Waves : public vtkImageAlgorithm
{
public:
  static Waves* New();
  vtkTypeMacro(Waves, vtkImageAlgorithm);
  vtkIdType CellsMade = 0; ///< last

protected:
  Waves() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const output = outputs->GetInformationObject(0);
    const int whole[6] = { 0, Size[0], 0, Size[1], 0, Size[2] };
    output->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
    output->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const information = outputs->GetInformationObject(0);
    vtkImageData* const image = vtkImageData::GetData(information);
    int e[6];
    information->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), e);
    image->SetExtent(e);
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

/// Light of a rank's piece.
struct Piece
{
  std::array<int, 6> extent = {};
  std::vector<double> fluence, direction, balance;
  vtkIdType cellsOfMedium = 0;
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

Piece March(vtkMPIController* controller, int decomposition, int ghosts)
{
  vtkNew<Waves> medium;
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputConnection(medium->GetOutputPort());
  marcher->SetPhotonsData(Photons());
  marcher->SetDecomposition(decomposition);
  marcher->UpdatePiece(controller->GetLocalProcessId(), controller->GetNumberOfProcesses(), ghosts);
  vtkImageData* const light = vtkImageData::SafeDownCast(marcher->GetOutputDataObject(0));
  Piece piece;
  std::copy_n(light->GetExtent(), 6, piece.extent.begin());
  piece.fluence = ValuesOf(light->GetCellData()->GetArray("fluence"));
  piece.direction = ValuesOf(light->GetCellData()->GetArray("mean_direction"));
  piece.balance = ValuesOf(light->GetFieldData()->GetArray("energy_balance"));
  piece.cellsOfMedium = medium->CellsMade;
  return piece;
}

bool Expect(bool holds, const char* what, int rank)
{
  if (!holds)
  {
    std::cerr << "rank " << rank << ": " << what << "\n";
  }
  return holds;
}

bool HasTheSameLight(vtkMPIController* controller, int ghosts)
{
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  const Piece whole = March(controller, vtkPhotonMarcher::WHOLE, ghosts);
  const Piece block = March(controller, vtkPhotonMarcher::BLOCKS, ghosts);
  const vtkIdType all = vtkIdType(1) * Size[0] * Size[1] * Size[2];
  bool right = Expect(!whole.fluence.empty(), "no light", rank);
  right = Expect(block.extent == whole.extent, "another piece", rank) && right;
  right = Expect(block.fluence == whole.fluence, "another fluence", rank) && right;
  right = Expect(block.direction == whole.direction, "another mean_direction", rank) && right;
  right = Expect(block.balance == whole.balance && !block.balance.empty(), "another energy_balance", rank) && right;
  right = Expect(whole.cellsOfMedium == all, "had not the whole", rank) && right;
  right = Expect(ranks == 1 || ghosts > 0 || 2 * block.cellsOfMedium <= all + Size[1] * Size[2],
            "had more of the medium than its piece", rank) &&
    right;
  std::cout << "rank " << rank << " of " << ranks << ", " << ghosts << " ghost layers: " << block.cellsOfMedium
            << " cells of the medium instead of " << whole.cellsOfMedium << std::endl;
  return right;
}

/// What blocks cannot do is one error that names it.
bool NamesWhatItCannot(vtkMPIController* controller)
{
  struct Note : vtkCommand
  {
    static Note* New() { return new Note; }
    void Execute(vtkObject*, unsigned long, void* data) override { this->said += static_cast<const char*>(data); }
    std::string said;
  };
  vtkNew<Note> errors;
  vtkNew<Waves> medium;
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->AddObserver(vtkCommand::ErrorEvent, errors);
  marcher->SetInputConnection(medium->GetOutputPort());
  marcher->SetPhotonsData(Photons());
  marcher->SetDecomposition(vtkPhotonMarcher::BLOCKS);
  marcher->SetMaximumOrders(0);
  marcher->UpdatePiece(controller->GetLocalProcessId(), controller->GetNumberOfProcesses(), 0);
  return Expect(errors->said.find("scattered photons") != std::string::npos, errors->said.c_str(),
           controller->GetLocalProcessId()) &&
    Expect(vtkImageData::SafeDownCast(marcher->GetOutputDataObject(0))->GetNumberOfCells() == 0, "light",
      controller->GetLocalProcessId());
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  int end = EXIT_FAILURE;
  try
  {
    tyndall::Device::Find();
    const bool right = HasTheSameLight(controller, 0) & HasTheSameLight(controller, 1) & NamesWhatItCannot(controller);
    end = right ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const tyndall::DeviceError& error)
  {
    std::cerr << error.what() << "\n";
    end = std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return end;
}
