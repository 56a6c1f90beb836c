#pragma once

class vtkInformation;
class vtkInformationVector;

namespace tyndall
{
/// Processes of this MPI run on this machine, as its launcher says; where it does not, those of VTK's global
/// controller.
int RanksOnThisMachine();

/// Whether each of as many processes can take memory on this machine, of what it has available now (AvailableMemory.h).
bool FitsOnEach(int processes, double bytes);

/// In RequestUpdateExtent or RequestData: whether each rank asks for its piece, and the whole of an image, once for
/// each rank of this machine, does not fit in its memory. Ranks may differ in it.
/// @param image  of the input's port
/// @param bytesOfVoxel  that a rank takes which works on the whole
bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel);
}
