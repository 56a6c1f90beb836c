#include "Ranks/RankMemory.h"

#include "Common/AvailableMemory.h"
#include "Numerics/NumberText.h"
#include "Ranks/Ranks.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cstdlib>

namespace tyndall
{
namespace
{
constexpr double FewVoxels = 64.0 * 64.0 * 64.0;

/// Processes of this MPI run, as its launcher says; where it does not, those of VTK's global controller.
int RanksOnThisMachine()
{
  for (const char* said : { "OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "PMI_LOCAL_SIZE" }) // Open MPI, MPICH, PMI
  {
    if (const char* const text = std::getenv(said); text && std::atoi(text) > 0)
    {
      return std::atoi(text);
    }
  }
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  return all ? all->GetNumberOfProcesses() : 1;
}

/// That its source says there are.
double VoxelsOf(vtkInformationVector* image)
{
  vtkInformation* const input = image->GetInformationObject(0);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  if (input && input->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  }
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    voxels *= std::max(0, whole[2 * axis + 1] - whole[2 * axis]);
  }
  return voxels;
}
}

bool IsWorthPieces(vtkInformationVector* image)
{
  const char* const said = std::getenv("TYNDALL_PIECES_FROM");
  const double voxels = VoxelsOf(image);
  return voxels == 0.0 || voxels > (said ? NumberIn(said).value_or(0.0) : FewVoxels);
}

bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel)
{
  const double bytes = bytesOfVoxel * VoxelsOf(image);
  return EachAsksForItsPiece(request, outputs) && RanksOnThisMachine() * bytes > AvailableMemory();
}
}
