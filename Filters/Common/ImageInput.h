#pragma once

#include "Common/ImageAxes.h"

#include "vtkSmartPointer.h"

#include <initializer_list>
#include <string>
#include <vector>

class vtkPolyData;
class vtkAlgorithm;
class vtkDataObject;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;

/// Input ports for images, and checks of inputs before a filter works.
///
/// A port that accepts only vtkImageData refuses other data by an error of VTK's executive in each pass of the
/// pipeline, none of which says what to do. These ports accept any data, and refuse them once with advice.
namespace tyndall
{
/// In FillInputPortInformation: the port is for images. The pipeline runs the filter once for each block of a
/// vtkMultiBlockDataSet or partitioned dataset. Blocks of adaptive meshes (AMR) overlap, so these are refused.
void TakeImages(vtkInformation* port);

/// The same for a writer, which VTK does not run once for each block: blocks are refused.
void TakeOneImage(vtkInformation* port);

/// In FillInputPortInformation or FillOutputPortInformation: the image is a picture without a place in the scene, so
/// that it is not rotated along with a medium (OwnAxes).
void TakePictures(vtkInformation* port);

bool TakesPictures(vtkInformation* port);
bool IsForImagesOfScene(vtkInformation* port); ///< for images, not for pictures

/// In FillInputPortInformation: the image is read as voxels, by these arrays.
/// @param chosen  default names of those that SetInputArrayToProcess chooses, by number; "": the active scalars
/// @param named   further ones, with fixed names; AnyArray: all, if there are none of these
void ReadsVoxels(
  vtkInformation* port, std::initializer_list<const char*> chosen, std::initializer_list<const char*> named = {});
constexpr const char* AnyArray = "";
struct VoxelArrays
{
  std::vector<std::string> chosen, named; ///< none: the port is not read as voxels
};
VoxelArrays VoxelArraysOf(vtkInformation* port);

/// Whether a filter reads voxels around an image's points (PropertyRange.h, tyndallPointDataMacro): it reads point
/// arrays and no cell arrays. An image at another port than the medium's, 0, with as many points as a medium whose
/// cells are read is read as cells, too.
/// @param averaged  set to the names of point arrays that are averaged to cells
bool AreAroundPoints(vtkAlgorithm* filter, int port, vtkImageData* image, std::vector<std::string>* averaged = nullptr);

/// An image with a voxel around each point: point arrays become its cell arrays, cell arrays are dropped. One point
/// along an axis is one voxel.
vtkSmartPointer<vtkImageData> PointsAsVoxels(vtkImageData* points);

/// Records which point arrays a filter averages because it reads cell arrays beside them.
void NoteAveraged(vtkAlgorithm* filter, const std::vector<std::string>& arrays);
/// Adds them as a line to the settings used.
void AddAveraged(vtkAlgorithm* filter, std::vector<std::string>& settings);

/// In ProcessRequest of a filter in which light goes from voxel to voxel, for each request: warns once an update if
/// VTK's pipeline is to run the filter for each block of a composite input. RequestData sees only the blocks. With
/// several ranks the first one warns, of its blocks.
void WarnOfBlocks(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs);

/// Called before a filter works, by Guarded.
/// @throws InvalidInput if a port for images has other data, with advice
void RequireImages(vtkAlgorithm* filter);

/// Called by Guarded before anything reads arrays: one that is shorter than its dataset would be read beyond its end.
/// @throws InvalidInput if an array has not a value for each point, cell or row
void RequireWholeArrays(vtkAlgorithm* filter);

/// In RequestInformation of a filter whose output has the voxels of its input at a port: announces their extent, with
/// aligned axes, and one voxel more along each axis if they are around points, as far as that is known. If the input
/// has no extent, as data that are no image, it announces one voxel, so that the pipeline runs the filter.
void TellVoxels(vtkAlgorithm* filter, int port, vtkInformationVector* inputs, vtkInformationVector* outputs);

// What vtkGhostType of an input image means.
//
// Hidden cells (HIDDENCELL, and as everywhere in VTK cells with a hidden point, HIDDENPOINT) are empty: every array
// read of them is 0, their refractive index 1, in all filters (ReadCells, ReadChosenCells). Their values may be
// anything, also NaN, which is what ResampleToImage leaves outside of its input.
//
// Duplicates (DUPLICATECELL) are cells that another rank has, too. In an image that one process has as a whole they are
// part of the medium like others, and their power counts once. If ranks run a filter together, each is taken from the
// rank that owns it (WholeInputs.h). If the output is divided otherwise, as one process streams it, each piece would be
// solved with cells of its neighbours, and their power would count twice: that is refused.
//
// Hidden and duplicate lights and photons are left out: every rank asks for all of them, so that the one that a
// duplicate repeats is there.

/// A number for each cell, not 0 if it is hidden; empty: none is.
std::vector<unsigned char> HiddenCells(vtkImageData* image);

/// Numbers of the points that count, in their order.
std::vector<long long> PointsThatCount(vtkPolyData* data);

/// @throws InvalidInput where an input image has duplicate cells and more than one piece of the output is asked for,
///   unless the filter works cell by cell
void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs);
}
