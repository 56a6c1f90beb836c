#pragma once

#include "Light/Quality.h"
#include "Lights/UncollidedImage.h"

#include <array>
#include <vector>

namespace tyndall
{
struct Grid;

enum class LightType
{
  Directional = 0, ///< parallel light through all of space
  Point = 1,
  Spot = 2,      ///< a point that shines evenly into a cone
  Rectangle = 3, ///< shines from one side, Lambertian
};

/// One light, as a row of the LightRig's polydata.
struct Light
{
  LightType type = LightType::Directional;
  std::array<double, 3> position = { 0.0, 0.0, 0.0 };   ///< of the point, or the rectangle's centre
  std::array<double, 3> direction = { 0.0, 0.0, -1.0 }; ///< in which the light travels; any length but 0
  Rgb power = { 1.0, 1.0, 1.0 }; ///< W; for a directional light W/length^2 through a plane across `direction`
  std::array<double, 2> size = { 0.0, 0.0 }; ///< edges of a rectangle
  double angle = 0.0; ///< full opening angle of a spot; of a rectangle, by which its edges are turned; degrees
  /// Of a rectangle, how finely solvers on a grid divide it, 0.7 to 3; at 1 uncollided light is within 2% (root mean
  /// square) in voxels of a third of a mean free path (numerics.md, section 5.3).
  double fineness = 1.0;
};

/// A rotation, mirrored or not: rows of an orthogonal matrix.
using Rotation = std::array<std::array<double, 3>, 3>;

/// Radiance that comes from infinitely far away, W / (length^2 sr): a picture in latitude-longitude layout, and how it
/// stands in the scene. In the picture's own axes z is up: pixel (i, j) of width x height looks along azimuth
/// 2 pi (i + 1/2) / width about +z from +x, polar angle pi (1 - (j + 1/2) / height) from +z; so row 0 is the nadir.
/// Pixels stay as they are however it stands, so that none loses power.
struct Environment
{
  int width = 0; ///< 0: there is no environment
  int height = 0;
  std::vector<float> radiance; ///< 3 * width * height, RGB interleaved
  /// What is seen along d in the scene is in the picture along toPicture * d.
  Rotation toPicture = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };

  bool Empty() const { return this->width == 0; }
  std::array<double, 3> ToPicture(const std::array<double, 3>& inScene) const;
  std::array<double, 3> ToScene(const std::array<double, 3>& inPicture) const;
};

/// Everything that shines on a medium from outside (and the lights inside it).
struct Illumination
{
  std::vector<Light> lights;
  Environment environment;
  Rgb sky = { 0.0, 0.0, 0.0 }; ///< radiance from every direction alike, W / (length^2 sr), added to the environment
  /// Diffuse radiance entering through -x, +x, -y, +y, -z, +z, W / (length^2 sr), added to the others.
  std::array<Rgb, 6> faces = {};
  /// Part, 0 to 1, of what leaves through each face that comes back where it left, spread as by a matt surface
  /// (Lambert), beside what shines in through the face.
  std::array<Rgb, 6> faceAlbedo = {};
  UncollidedImage uncollided; ///< light that was found already as far as it is not scattered, beside the others
};

/// The unit vector along which a light shines, whatever the length of its `direction`; 0 where that is 0.
std::array<double, 3> DirectionOf(const Light& light);

/// Divides rectangles as finely as a quality asks for.
void SetFineness(std::vector<Light>& lights, Quality quality);

/// W per steradian of a lamp of 1 W along its axis; 0 of a directional light, which has none.
double AxialIntensity(const Light& lamp);

/// The angle between a light's direction and `way`, which may have any length.
double AngleFromAxis(const Light& light, const std::array<double, 3>& way);
/// Half of the opening angle of a spot, radians.
double HalfAngle(const Light& spot);

/// The lights as they shine on a box: a lamp further away than 1e5 of its longest edges is a directional light of the
/// irradiance that it has in the middle of the box (0 where it shines elsewhere). A spot the border of whose cone
/// crosses the box stays what it is, and so does a rectangle that is large for its distance.
/// @throws InvalidInput where such a spot is so far away that it cannot be aimed
std::vector<Light> SeenFrom(const Grid& grid, std::vector<Light> lights);

/// The edges of a rectangular light as vectors: the first is horizontal (across z and the direction; along x where the
/// direction is vertical), then turned by `angle`; the second is the direction x the first.
std::array<std::array<double, 3>, 2> RectangleEdges(const Light& light);

/// Mean radiance the environment has where it is looked at along `direction` of the scene (from the viewer outwards;
/// the light travels the other way), bilinear between pixels.
Rgb Lookup(const Environment& environment, const std::array<double, 3>& direction);

/// The same environment standing otherwise: its up (+z) along axis `up` of the scene (0, 1, 2: x, y, z; the other axes
/// follow in their cyclic order), then turned by `degrees` about that axis.
Environment Turned(const Environment& environment, int up, double degrees);
/// The same turned, or mirrored: what was seen along d is seen along rotation * d.
/// @throws InvalidInput where that is no orthogonal matrix
Environment Turned(const Environment& environment, const Rotation& rotation);

/// Whether anything of it shines: has a power or a radiance above 0.
bool Shines(const Illumination& illumination);
/// Whether a face, the sky or an environment lets light in that comes from everywhere, not from lamps.
bool ShinesThroughFaces(const Illumination& illumination);

/// Whether some face gives back light.
bool Reflects(const Illumination& illumination);

/// @throws InvalidInput where a face that gives back light lies across a periodic axis, which has none
void CheckFaceAlbedo(const Illumination& illumination, const std::array<bool, 3>& periodic);

/// @throws InvalidInput where a light has a zero direction, an angle out of range, a power that is negative or beyond
///   float, no size; an environment has a negative or infinite pixel (names the first); a sky or a face a radiance that
///   is negative or beyond float, a face an albedo that is not from 0 to 1
void Check(const Illumination& illumination);
}
