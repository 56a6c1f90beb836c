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

/// Of an input or an output port, in FillInputPortInformation or FillOutputPortInformation: its image is a picture that
/// has no place in the scene, so that it is not turned along with a medium (OwnAxes).
void TakePictures(vtkInformation* port);

bool TakesPictures(vtkInformation* port);
bool IsForImagesOfScene(vtkInformation* port); ///< for images, not for pictures

/// Also in FillInputPortInformation: the image is read as voxels, by these arrays.
/// @param chosen  default names of those that SetInputArrayToProcess chooses, by number; "": the active scalars
/// @param named   others, which have no other names; AnyArray: all, where there are none of these
void ReadsVoxels(
  vtkInformation* port, std::initializer_list<const char*> chosen, std::initializer_list<const char*> named = {});
constexpr const char* AnyArray = "";
struct VoxelArrays
{
  std::vector<std::string> chosen, named; ///< none: the port is not read as voxels
};
VoxelArrays VoxelArraysOf(vtkInformation* port);

/// Whether the voxels that a filter reads of an image are around its points (PropertyRange.h, tyndallPointDataMacro):
/// it reads arrays of points, and none of cells. An image at another port than the medium's, 0, that has the points of
/// a medium of which the cells are read has voxels there, too.
/// @param averaged  where arrays of points are read, and voxels are cells: the names of those
bool AreAroundPoints(vtkAlgorithm* filter, int port, vtkImageData* image, std::vector<std::string>* averaged = nullptr);

/// An image with a voxel around each point: arrays of points are its arrays of cells, those of cells are left out.
/// Where an image has one point along an axis it has one voxel.
vtkSmartPointer<vtkImageData> PointsAsVoxels(vtkImageData* points);

/// That a filter averages arrays of points, for they meet others of cells; none: it does not.
void NoteAveraged(vtkAlgorithm* filter, const std::vector<std::string>& arrays);
/// Adds the same as a line to the settings used.
void AddAveraged(vtkAlgorithm* filter, std::vector<std::string>& settings);

/// In ProcessRequest of a filter in which light goes from voxel to voxel, with each request: warns, once with each
/// update, where VTK's pipeline is to run the filter for one block of a composite input after another. RequestData sees
/// the blocks alone. Where there are several ranks the first one warns, of its blocks.
void WarnOfBlocks(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs);

/// To be asked before a filter works; Guarded does.
/// @throws InvalidInput where a port for images has other data, with what to do about it
void RequireImages(vtkAlgorithm* filter);

/// The same for the arrays of all inputs, images or not: who reads an array that is shorter than its dataset reads
/// memory behind it. Guarded asks this, too, before anything reads them.
/// @throws InvalidInput where an array has not a value for each point, cell or row
void RequireWholeArrays(vtkAlgorithm* filter);

/// In RequestInformation of a filter whose output has the voxels of its input at a port: where the input has no extent,
/// as data that are no image, the output has a voxel, so that the pipeline asks the filter for it. Where voxels are
/// around points, as far as is known before the image, the output has one more than there are between them; its axes
/// are aligned.
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
