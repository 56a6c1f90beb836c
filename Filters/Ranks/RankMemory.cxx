#include "Ranks/RankMemory.h"

#include "Common/AvailableMemory.h"

#include "vtkMultiProcessController.h"

#include <cstdlib>

namespace tyndall
{
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

bool FitsOnEach(int processes, double bytes)
{
  return processes * bytes <= AvailableMemory();
}
}
