#pragma once

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;

/// What is asked of inputs before a filter works.
///
/// For filters that work on images: a port that takes vtkImageData alone refuses other data by an error of VTK's
/// executive for each pass of the pipeline, none of which says what to do. These ports take any data, and refuse them
/// once.
namespace tyndall
{
/// In FillInputPortInformation: the port is for images. Of blocks of images, vtkMultiBlockDataSet and the partitioned
/// datasets, the pipeline hands on one after the other. Those of adaptive meshes (AMR) overlap, so these are refused.
void TakeImages(vtkInformation* port);

/// The same of a filter without outputs, a writer, to which VTK does not hand on blocks one by one: they are refused.
void TakeOneImage(vtkInformation* port);

/// To be asked before a filter works; Guarded does.
/// @throws InvalidInput where a port for images has other data, with what to do about it
void RequireImages(vtkAlgorithm* filter);

/// The same for the arrays of all inputs, images or not: who reads an array that is shorter than its dataset reads
/// memory behind it. Guarded asks this, too, before anything reads them.
/// @throws InvalidInput where an array has not a value for each point, cell or row
void RequireWholeArrays(vtkAlgorithm* filter);

/// In RequestInformation of a filter whose output has the extent of its input: where the input has none, as data
/// that are no image, the output has a voxel, so that the pipeline asks the filter for it.
void TellSomeExtent(vtkInformationVector* inputs, vtkInformationVector* outputs);
}
