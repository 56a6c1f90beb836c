#pragma once

class vtkInformation;
class vtkInformationVector;

namespace tyndall
{
/// Whether ranks that choose work on pieces of an image: it has more voxels than 64^3. Less each rank has done sooner
/// than ranks say to each other what crosses between them. The environment variable TYNDALL_PIECES_FROM is another
/// number of voxels. A rank that its source tells of no voxels holds none anyway, and leaves it to the others.
bool IsWorthPieces(vtkInformationVector* image);

/// In RequestUpdateExtent or RequestData: whether each rank asks for its piece, and the whole of an image, once for
/// each rank of this machine, does not fit in what it has available now (AvailableMemory.h). Ranks may differ in it.
/// @param image  of the input's port
/// @param bytesOfVoxel  that a rank takes which works on the whole
bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel);
}
