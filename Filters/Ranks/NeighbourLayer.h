#pragma once

#include "vtkSmartPointer.h"

class vtkImageData;
class vtkMultiProcessController;

namespace tyndall
{
/// Pieces of an image, one a rank, each with a layer of its neighbours' cells, flagged as duplicates: made by VTK, from
/// those that have them as their own. Ranks send each other what lies at the faces of their pieces, and no rank gets
/// more. All ranks have to call it.
/// @param piece  may be null or without cells
/// @return null, on all ranks, where this VTK cannot do so (that before 9.2), or where arrays of pieces differ
vtkSmartPointer<vtkImageData> WithNeighbourLayer(vtkMultiProcessController* ranks, vtkImageData* piece);
}
