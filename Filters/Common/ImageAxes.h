#pragma once

#include "Lights/Lights.h"

#include "vtkSmartPointer.h"

#include <array>
#include <optional>
#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkInformationVector;

/// Images whose axes are permuted, mirrored or rotated relative to the world axes.
namespace tyndall
{
/// Axes of an image that are a signed permutation of the world axes, due to a direction matrix, a negative spacing, or
/// both.
struct AxisWays
{
  std::array<int, 3> world = { 0, 1, 2 }; ///< world axis (0 to 2) along which each image axis lies
  /// For each image axis: whether it points in the negative direction of its world axis.
  std::array<bool, 3> down = { false, false, false };
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 }; ///< spacing along each world axis, above 0

  bool AreAlike() const; ///< whether the image axes are the world axes
  /// Converts the image's extent to the extent of the aligned image, whose indices increase along the world axes.
  std::array<int, 6> Extent(const int* ofImage) const;
};

/// Finds the signed permutation of an image's axes.
/// @param direction  direction matrix, 9 numbers; null: the unit matrix
/// @return no value if an axis is oblique, or if a spacing is 0 or not finite
std::optional<AxisWays> WaysOf(const double* spacing, const double* direction);

/// Permutes an image's cells and points so that its axes are the world axes; every value keeps its position in the
/// world. Returns the image itself if it is aligned already, or if its axes are oblique.
vtkSmartPointer<vtkImageData> Aligned(vtkImageData* image);

/// Returns an image with the same cells and positive spacings: signs of negative spacings move to the direction matrix.
vtkSmartPointer<vtkImageData> WithSpacingsAbove0(vtkImageData* image);

/// Medium axes: the axes of an image whose direction matrix is a rotation by other than right angles, mirrored or not.
/// A filter works in these axes (WholeInputs.h): there the medium has the unit matrix as direction and the same origin,
/// and lights, photons, cameras and vectors of the inputs are rotated into them. Outputs are rotated back to the
/// scene's axes.
struct OwnAxes
{
  using Vec = std::array<double, 3>;

  Vec origin = { 0.0, 0.0, 0.0 }; ///< the image's origin, whose coordinates are the same in medium and scene axes
  /// Unit vectors of the medium axes in scene coordinates, one per row.
  Rotation axes = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
  /// Direction matrix of the image, for positive spacings.
  std::array<double, 9> direction = { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };

  bool AreThoseOfScene() const { return this->direction == OwnAxes().direction; }
  bool AreMirrored() const;
  Vec Place(const Vec& inScene) const;
  Vec Way(const Vec& inScene) const;
  Vec PlaceInScene(const Vec& place) const;
  Vec WayInScene(const Vec& way) const;

  std::vector<double> Words() const;
  static OwnAxes From(const std::vector<double>& words);
};

/// The medium axes of an image.
/// @return the scene's axes for rotations by right angles, for a matrix that is no rotation (which GridOf refuses), or
///   if the image is null or empty
OwnAxes OwnAxesOf(vtkImageData* image);

/// The medium axes in which a filter works, as recorded by NoteOwnAxes before the work starts; the scene's axes if none
/// are recorded.
OwnAxes OwnAxesOf(vtkAlgorithm* filter);
void NoteOwnAxes(vtkAlgorithm* filter, const OwnAxes& axes);

/// Transforms an image from the scene to the medium axes. Vectors among its arrays are rotated: net_flux,
/// mean_direction, ior_gradient, the array that the filter reads from input port `port` as mean direction, and
/// directions in field data.
vtkSmartPointer<vtkImageData> InOwnAxes(vtkImageData* image, const OwnAxes& axes, vtkAlgorithm* filter, int port);

/// Transforms an output image from the medium axes back to the scene axes.
/// @param given  the filter's input in scene axes; its arrays replace their rotated copies in the output; may be null
void PutIntoScene(vtkImageData* output, const OwnAxes& axes, vtkImageData* given);

/// Transforms all outputs of a filter to the scene axes, except pictures and photons. Filters write photons in scene
/// axes.
void PutIntoScene(vtkAlgorithm* filter, const OwnAxes& axes, vtkInformationVector* outputs, vtkImageData* given);
}
