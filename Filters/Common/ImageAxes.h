#pragma once

#include "Lights/Lights.h"

#include "vtkSmartPointer.h"

#include <array>
#include <optional>
#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkInformationVector;

/// Axes of images: permuted, mirrored or rotated against those of the world.
namespace tyndall
{
/// The axes of an image that are a signed permutation of the world's: by a direction matrix, a negative spacing, or
/// both.
struct AxisWays
{
  std::array<int, 3> world = { 0, 1, 2 };             ///< axis of the world, of each axis of the image
  std::array<bool, 3> down = { false, false, false }; ///< of each axis of the image
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };  ///< of each axis of the world

  bool AreAlike() const;                               ///< those of the world already
  std::array<int, 6> Extent(const int* ofImage) const; ///< the same extent in numbers along the world's axes
};

/// @param direction  null: the unit matrix
/// @return nothing if an axis is oblique, or a spacing is 0 or not finite
std::optional<AxisWays> WaysOf(const double* spacing, const double* direction);

/// The image with axes along those of the world: its cells and points permuted, at the same places. The image itself if
/// it has them already, or cannot have them.
vtkSmartPointer<vtkImageData> Aligned(vtkImageData* image);

/// The image, cell for cell, with positive spacings: the direction matrix has the signs of negative ones.
vtkSmartPointer<vtkImageData> WithSpacingsAbove0(vtkImageData* image);

/// The axes of an image that its direction matrix rotates by other than right angles, mirrored or not. A filter works
/// in these (WholeInputs.h): there its medium has the unit matrix and the same origin, and lights, photons, cameras and
/// vectors of inputs are rotated into them. Outputs are in the scene's axes again.
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

/// @return the scene's for right angles, for a matrix that is no rotation (which GridOf refuses), or if the image is
///   null or empty
OwnAxes OwnAxesOf(vtkImageData* image);

/// The axes in which a filter works; set before it does.
OwnAxes OwnAxesOf(vtkAlgorithm* filter);
void NoteOwnAxes(vtkAlgorithm* filter, const OwnAxes& axes);

/// An image of the scene in such axes, with its vectors rotated: net_flux, mean_direction, ior_gradient, the array that
/// the filter reads from the port as mean direction, and field data of directions.
vtkSmartPointer<vtkImageData> InOwnAxes(vtkImageData* image, const OwnAxes& axes, vtkAlgorithm* filter, int port);

/// The inverse, for an output.
/// @param given  the filter's input in the scene, whose arrays replace rotated copies of them; may be null
void PutIntoScene(vtkImageData* output, const OwnAxes& axes, vtkImageData* given);

/// For all outputs of a filter but pictures, and photons, which are written in the scene.
void PutIntoScene(vtkAlgorithm* filter, const OwnAxes& axes, vtkInformationVector* outputs, vtkImageData* given);
}
