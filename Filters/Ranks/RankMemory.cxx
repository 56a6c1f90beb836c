#include "Ranks/RankMemory.h"

#include "Common/AvailableMemory.h"
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

}

bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel)
{
  vtkInformation* const input = image->GetInformationObject(0);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  if (input && input->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  }
  double bytes = bytesOfVoxel;
  for (int axis = 0; axis < 3; ++axis)
  {
    bytes *= std::max(0, whole[2 * axis + 1] - whole[2 * axis]);
  }
  return EachAsksForItsPiece(request, outputs) && RanksOnThisMachine() * bytes > AvailableMemory();
}
}
