#pragma once

#include "Lights/Lights.h"

#include "vtkSmartPointer.h"

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

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

/// Which way the axes of an image go where each goes along one of the world's, up or down: by a direction matrix, a
/// negative spacing, or both.
struct AxisWays
{
  std::array<int, 3> world = { 0, 1, 2 };             ///< axis of the world, of each axis of the image
  std::array<bool, 3> down = { false, false, false }; ///< of each axis of the image
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };  ///< of each axis of the world

  bool AreAlike() const;                               ///< those of the world already
  std::array<int, 6> Extent(const int* ofImage) const; ///< the same extent in numbers along the world's axes
};

/// @param direction  null: the unit matrix
/// @return nothing where axes go aslant, or a spacing is 0 or not finite
std::optional<AxisWays> WaysOf(const double* spacing, const double* direction);

/// The same image with axes along those of the world: its cells and points in another order, at the same places. Itself
/// where it has them already, or cannot have them.
vtkSmartPointer<vtkImageData> Aligned(vtkImageData* image);

/// The same image, cell for cell, with a spacing above 0 along each axis: where it is below, the direction matrix has
/// the axis the other way.
vtkSmartPointer<vtkImageData> WithSpacingsAbove0(vtkImageData* image);

/// The axes of an image that its direction matrix turns otherwise than by right angles, mirrored or not. A filter works
/// in these (WholeInputs.h): there its medium has the unit matrix and the origin that it has in the scene, and lights,
/// photons, cameras and vectors of inputs are turned into them. What filters give out is in the scene again.
struct OwnAxes
{
  using Vec = std::array<double, 3>;

  Vec origin = { 0.0, 0.0, 0.0 }; ///< of the image: the place that has the same coordinates in both
  Rotation axes = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };   ///< a row each, in the scene
  std::array<double, 9> direction = { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 }; ///< the matrix, spacings above 0

  bool AreThoseOfScene() const { return this->direction == OwnAxes().direction; }
  bool AreMirrored() const;
  Vec Place(const Vec& inScene) const;
  Vec Way(const Vec& inScene) const;
  Vec PlaceInScene(const Vec& place) const;
  Vec WayInScene(const Vec& way) const;

  std::vector<double> Words() const;
  static OwnAxes From(const std::vector<double>& words);
};

/// @return the scene's, too, where right angles turn the image, its matrix is that of no rotation (which GridOf
///   refuses), or it is null or empty
OwnAxes OwnAxesOf(vtkImageData* image);

/// Those in which a filter works, and saying so, before it does.
OwnAxes OwnAxesOf(vtkAlgorithm* filter);
void NoteOwnAxes(vtkAlgorithm* filter, const OwnAxes& axes);

/// An image of the scene as it lies in such axes, with vectors (net_flux, mean_direction, ior_gradient, what is chosen
/// for the mean direction by a filter that reads the port, and field data of directions) that are turned, too.
vtkSmartPointer<vtkImageData> InOwnAxes(vtkImageData* image, const OwnAxes& axes, vtkAlgorithm* filter, int port);

/// The other way round, of an image that a filter gives out.
/// @param given  what it was made of, as it is in the scene: arrays that were handed on are those of it; may be null
void PutIntoScene(vtkImageData* output, const OwnAxes& axes, vtkImageData* given);

/// Of all outputs of a filter but pictures, and photons, which are written in the scene. @param given  as above
void PutIntoScene(vtkAlgorithm* filter, const OwnAxes& axes, vtkInformationVector* outputs, vtkImageData* given);

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
}
