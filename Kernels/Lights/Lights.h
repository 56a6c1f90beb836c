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
  Directional = 0, ///< parallel beam from infinity that illuminates the complete box
  Point = 1,
  Spot = 2,      ///< point source that emits uniformly into a cone
  Rectangle = 3, ///< rectangle that emits as a Lambertian surface, on one side
};

/// One light source other than sky, faces and environment: a row of the LightRig's polydata.
struct Light
{
  LightType type = LightType::Directional;
  std::array<double, 3> position = { 0.0, 0.0, 0.0 };   ///< position of a point light or spot, or centre of a rectangle
  std::array<double, 3> direction = { 0.0, 0.0, -1.0 }; ///< direction in which the light travels; any length but 0
  /// power, W. For a directional light: irradiance of a plane normal to `direction`, W / length^2
  Rgb power = { 1.0, 1.0, 1.0 };
  std::array<double, 2> size = { 0.0, 0.0 }; ///< edge lengths of a rectangle
  double angle = 0.0; ///< full opening angle of a spot, or rotation of a rectangle's edges about `direction`, degrees
  /// Fineness with which grid solvers subdivide a rectangle, 0.7 to 3. At 1 the error of the uncollided light is at
  /// most 2% (root mean square) if a voxel is a third of a mean free path (numerics.md, section 5.3).
  double fineness = 1.0;
};

/// A rotation, or a rotation with a reflection: the rows of an orthogonal matrix.
using Rotation = std::array<std::array<double, 3>, 3>;

/// Environment map: radiance incident from infinity, W / (length^2 sr), as a latitude-longitude picture with an
/// orientation in the scene. In the picture's own axes z is up, and row 0 is the nadir. Pixel (i, j) of width x height
/// is seen at the azimuth 2 pi (i + 1/2) / width, measured about +z from +x, and at the polar angle pi (1 - (j + 1/2) /
/// height) from +z. A rotation changes the orientation only; pixels are not resampled, so that no power is lost.
struct Environment
{
  int width = 0; ///< pixels per row; 0: there is no environment
  int height = 0;
  std::vector<float> radiance; ///< pixels, W / (length^2 sr), 3 * width * height, RGB interleaved, row by row
  /// Maps a direction of the scene to the picture's axes.
  Rotation toPicture = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };

  bool Empty() const { return this->width == 0; }
  std::array<double, 3> ToPicture(const std::array<double, 3>& inScene) const;
  std::array<double, 3> ToScene(const std::array<double, 3>& inPicture) const;
};

/// All light sources: boundary sources (environment, sky, faces) and lights outside or inside the box.
struct Illumination
{
  std::vector<Light> lights;
  Environment environment;
  Rgb sky = { 0.0, 0.0, 0.0 }; ///< isotropic incident radiance, W / (length^2 sr), added to the environment
  /// Diffuse incident radiance at the faces -x, +x, -y, +y, -z, +z, W / (length^2 sr), added to environment and sky.
  std::array<Rgb, 6> faces = {};
  /// Albedo of each face, 0 to 1: the fraction of the outgoing partial current that the face reflects diffusely
  /// (Lambertian) at the point where the light leaves, in addition to the face's boundary source.
  std::array<Rgb, 6> faceAlbedo = {};
  UncollidedImage uncollided; ///< uncollided light computed by another solver, in addition to the other sources
};

/// Unit vector along which a light travels; 0 if Light::direction is 0.
std::array<double, 3> DirectionOf(const Light& light);

/// Sets the fineness with which rectangular lights are subdivided to the value for a quality setting.
void SetFineness(std::vector<Light>& lights, Quality quality);

/// Radiant intensity on the axis, W / sr, of a lamp of 1 W; 0 for a directional light.
double AxialIntensity(const Light& lamp);

/// Angle between a light's direction and `way`, a vector of any length, radians.
double AngleFromAxis(const Light& light, const std::array<double, 3>& way);
/// Half the opening angle of a spot, radians.
double HalfAngle(const Light& spot);

/// Lights as seen from a box. A lamp further away than 1e5 times the box's longest edge becomes a directional light
/// with the lamp's irradiance at the box's centre (0 if the lamp does not illuminate it). Unchanged are spots whose
/// cone boundary crosses the box, and rectangles that are large relative to their distance.
/// @throws InvalidInput if such a spot is so far away that its direction cannot be resolved
std::vector<Light> SeenFrom(const Grid& grid, std::vector<Light> lights);

/// Edges of a rectangular light as vectors. The first edge is horizontal (normal to z and to the direction; along x if
/// the direction is vertical), then rotated by `angle` about the direction. The second edge is the cross product of the
/// direction and the first.
std::array<std::array<double, 3>, 2> RectangleEdges(const Light& light);

/// Radiance of the environment, W / (length^2 sr), interpolated bilinearly between pixels. `direction` is the direction
/// of view in the scene, outwards from the viewer, opposite to the propagation of the light.
Rgb Lookup(const Environment& environment, const std::array<double, 3>& direction);

/// Reorients an environment: its up direction (+z) becomes axis `up` of the scene (0, 1, 2: x, y, z). The other axes
/// follow in cyclic order. Then the environment is rotated by `degrees` about that axis.
Environment Turned(const Environment& environment, int up, double degrees);
/// Rotates or mirrors an environment: the radiance that was seen along d is then seen along rotation * d.
/// @throws InvalidInput if `rotation` is not orthogonal
Environment Turned(const Environment& environment, const Rotation& rotation);

/// Whether any of the lights is at a finite distance, not a parallel beam. The light field is steep next to such a
/// light.
bool AnyHasPosition(const std::vector<Light>& lights);

/// Whether any light source has a power or radiance above 0.
bool Shines(const Illumination& illumination);
/// Whether there is a boundary source other than lamps: faces, sky or environment.
bool ShinesThroughFaces(const Illumination& illumination);

/// Whether any face reflects (has an albedo above 0).
bool Reflects(const Illumination& illumination);

/// Checks the albedos of faces.
/// @throws InvalidInput if a reflecting face lies across a periodic axis, which has no faces
void CheckFaceAlbedo(const Illumination& illumination, const std::array<bool, 3>& periodic);

/// Checks all light sources.
/// @throws InvalidInput if a light has a zero direction, an angle out of range, no size, or a power that is negative or
///   beyond float; if an environment has a negative or infinite pixel (names the first); if the radiance of the sky or
///   a face is negative or beyond float; if a face's albedo is outside [0, 1]
void Check(const Illumination& illumination);
}
