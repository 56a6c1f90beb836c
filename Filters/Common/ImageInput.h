#pragma once

#include "Common/ImageAxes.h"

#include "vtkSmartPointer.h"

#include <initializer_list>
#include <string>
#include <vector>

class vtkPolyData;
class vtkAlgorithm;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;

/// Input ports for images, and checks of inputs before a filter works.
///
/// If a port accepted only vtkImageData, VTK's executive would report an error for other data in each pass of the
/// pipeline, without saying what to do. Ports declared here accept any data; RequireImages then reports one error with
/// advice.
namespace tyndall
{
/// In FillInputPortInformation: declares the port as one for images. The pipeline runs the filter once for each block
/// of a vtkMultiBlockDataSet or partitioned dataset. Adaptive meshes (AMR) are refused, since their blocks overlap.
void TakeImages(vtkInformation* port);

/// In FillInputPortInformation of a writer: declares the port as one for a single image. Composite data are refused,
/// because VTK does not run a writer once for each block.
void TakeOneImage(vtkInformation* port);

/// In FillInputPortInformation or FillOutputPortInformation: declares that the image is a picture without a position in
/// the scene. It is not rotated with the medium (OwnAxes).
void TakePictures(vtkInformation* port);

bool TakesPictures(vtkInformation* port);
/// Whether the port is for images that have a position in the scene, which pictures do not (TakePictures).
bool IsForImagesOfScene(vtkInformation* port);

/// In FillInputPortInformation: declares that the filter reads these arrays of the image as voxel values.
/// @param chosen  default names of the arrays that SetInputArrayToProcess selects, by index; "": the active scalars
/// @param named   names of further arrays that the filter reads; AnyArray: all arrays if none of the named ones exists
void ReadsVoxels(
  vtkInformation* port, std::initializer_list<const char*> chosen, std::initializer_list<const char*> named = {});
constexpr const char* AnyArray = "";
struct VoxelArrays
{
  /// Names of arrays, as passed to ReadsVoxels; both empty: the port is not read as voxels.
  std::vector<std::string> chosen, named;
};
VoxelArrays VoxelArraysOf(vtkInformation* port);

/// Whether a filter reads an image with one voxel around each point (PropertyRange.h, tyndallPointDataMacro), because
/// it reads point arrays and no cell arrays. If the filter reads cell arrays of the medium (port 0), an image at
/// another port with as many points along each axis has the voxels of the medium: its point arrays are averaged to
/// cells.
/// @param averaged  receives the names of point arrays that are averaged to cells
bool AreAroundPoints(vtkAlgorithm* filter, int port, vtkImageData* image, std::vector<std::string>* averaged = nullptr);

/// Makes an image with one voxel around each point: point arrays become cell arrays, cell arrays are dropped. An axis
/// with one point has one voxel.
vtkSmartPointer<vtkImageData> PointsAsVoxels(vtkImageData* points);
/// Whether an image was made by PointsAsVoxels.
bool AreMadeAroundPoints(vtkImageData* voxels);

/// Records the point arrays that a filter averages to cells because it reads cell arrays of the same image.
void NoteAveraged(vtkAlgorithm* filter, const std::vector<std::string>& arrays);
/// Appends the names recorded by NoteAveraged, as one line, to the settings for field data `settings_used`.
void AddAveraged(vtkAlgorithm* filter, std::vector<std::string>& settings);

/// Warns once per update if VTK's pipeline will run the filter separately for each block of a composite input. Called
/// in ProcessRequest, for each request (RequestData sees only single blocks), by filters in which light crosses voxels.
/// With several ranks only the first warns, about its own blocks.
void WarnOfBlocks(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs);

/// Checks that ports for images have images. Called by Guarded before a filter works.
/// @throws InvalidInput with advice if a port for images has data of another type
void RequireImages(vtkAlgorithm* filter);

/// Checks that arrays are as long as their dataset, so that no array is read beyond its end. Called by Guarded before
/// anything reads arrays.
/// @throws InvalidInput if an array does not have one tuple for each point, cell or row
void RequireWholeArrays(vtkAlgorithm* filter);

/// In RequestInformation of a filter whose output has the voxels of the input at `port`: announces the extent of these
/// voxels, along aligned axes. If point arrays will probably be read with one voxel around each point, the announced
/// extent is one larger along each axis. If the input is no image and has no extent, one voxel is announced so that the
/// pipeline runs the filter.
void TellVoxels(vtkAlgorithm* filter, int port, vtkInformationVector* inputs, vtkInformationVector* outputs);

// Meaning of the flags vtkGhostType of an input image:
//
// Hidden cells (HIDDENCELL, and as everywhere in VTK cells with a hidden point, HIDDENPOINT) are empty in all filters:
// every array is read as 0 there, the refractive index as 1 (ReadCells, ReadChosenCells). Their values may be anything,
// NaN included, which is what ResampleToImage writes outside of its input.
//
// Duplicates (DUPLICATECELL) are ghost cells that another rank owns. If one process has the complete image, duplicates
// are ordinary cells of the medium. If ranks run a filter together, each cell is taken from the rank that owns it
// (WholeInputs.h). Duplicates are an error if one process streams the output in pieces: each piece would be solved with
// cells of its neighbours, whose power would count twice.
//
// Hidden and duplicate lights and photons are skipped: every rank requests all lights and photons, so that the original
// of each duplicate is present.

/// Flag of each cell of an image, not 0 if the cell is hidden; empty if no cell is hidden.
std::vector<unsigned char> HiddenCells(vtkImageData* image);

/// Indices of the points that are neither hidden nor duplicates, ascending.
std::vector<long long> PointsThatCount(vtkPolyData* data);

/// Checks that streaming in pieces counts no cell twice.
/// @throws InvalidInput if an input image has duplicate cells and several pieces of the output are requested, unless
///   the filter works cell by cell
void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs);
}
