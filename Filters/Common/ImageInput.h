#pragma once

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;

/// For filters that work on images. A port that takes vtkImageData alone refuses other data by an error of VTK's
/// executive for each pass of the pipeline, none of which says what to do. These ports take any dataset, and refuse it
/// once.
namespace tyndall
{
/// In FillInputPortInformation: the port is for images.
void TakeImages(vtkInformation* port);

/// To be asked before a filter works; Guarded does.
/// @throws InvalidInput where a port for images has another dataset, with what to do about it
void RequireImages(vtkAlgorithm* filter);

/// In RequestInformation of a filter whose output has the extent of its input: where the input has none, as a dataset
/// that is no image, the output has a voxel, so that the pipeline asks the filter for it.
void TellSomeExtent(vtkInformationVector* inputs, vtkInformationVector* outputs);
}
