#include "Photons/Emission/PhotonSources.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Photons/Emission/PhotonPlane.h"
#include "Photons/Emission/SampleSequence.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Marching/PhotonPacking.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace tyndall
{
namespace
{
/// Two unit vectors perpendicular to a unit vector and to each other (Duff et al. 2017).
std::array<glm::dvec3, 2> Across(const glm::dvec3& n)
{
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return { glm::dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::dvec3(b, sign + n.y * n.y * a, -n.y) };
}

/// Unit vector at a given angle to a unit axis.
/// @param versine  1 - cosine of the angle, which keeps the digits of a small angle
/// @param turn     azimuth around the axis, in full turns
glm::dvec3 Around(const glm::dvec3& axis, double versine, double turn)
{
  const std::array<glm::dvec3, 2> across = Across(axis);
  const double cosine = 1.0 - versine, sine = std::sqrt(std::max(versine * (2.0 - versine), 0.0));
  return axis * cosine + across[0] * (sine * std::cos(2.0 * Pi * turn)) +
    across[1] * (sine * std::sin(2.0 * Pi * turn));
}

PhotonSource Directional(const Grid& grid, const Light& light)
{
  const glm::dvec3 direction = Vector(DirectionOf(light));
  const auto plane = std::make_shared<PhotonPlane>(grid, direction);
  return { 0,
    [=](const PhotonSample& u) {
      return Shot{ plane->At(u[0], u[1]), direction, Times(light.power, plane->Area()) };
    },
    true };
}

PhotonSource Point(const Grid& grid, const Light& light)
{
  const auto view = std::make_shared<LampView>(grid, Vector(light.position));
  return { 0,
    [=](const PhotonSample& u) {
      return Shot{ view->Lamp(), view->Direction(u[0], u[1]), Times(light.power, view->SolidAngle() / (4.0 * Pi)) };
    },
    true };
}

PhotonSource Spot(const Grid& grid, const Light& light)
{
  const glm::dvec3 axis = Vector(DirectionOf(light));
  const double cone = 1.0 / AxialIntensity(light);
  const auto view = std::make_shared<LampView>(grid, Vector(light.position));
  const bool fromCone = view->SolidAngle() > cone;
  const Rgb power = fromCone ? light.power : Times(light.power, view->SolidAngle() / cone);
  return { 0, [=](const PhotonSample& u) -> std::optional<Shot> {
            const glm::dvec3 direction =
              fromCone ? Around(axis, cone / (2.0 * Pi) * u[0], u[1]) : view->Direction(u[0], u[1]);
            const bool isThere = fromCone
              ? view->Enters(direction)
              : AngleFromAxis(light, { direction.x, direction.y, direction.z }) <= HalfAngle(light);
            return isThere ? std::optional<Shot>({ view->Lamp(), direction, power }) : std::nullopt;
          } };
}

/// Mean of the ratio of a photon's power to its light's power, and mean of the square of this ratio.
struct Moments
{
  double mean = 0.0, square = 0.0;
};

/// Estimates the Moments of a light's photons from `samples` samples.
/// @param power  W, power of the light
/// @param shoot  maps a sample to a photon; empty if it yields none
template <class Shoot>
Moments MomentsOf(int samples, const Rgb& power, const Shoot& shoot)
{
  const SampleSequence sequence(Sampler::Halton, samples);
  Moments moments;
  for (int i = 0; i < samples; ++i)
  {
    const std::optional<Shot> shot = shoot(sequence[i]);
    const double part = shot ? Sum(shot->power) / Sum(power) : 0.0;
    moments.mean += part / samples;
    moments.square += part * part / samples;
  }
  return moments;
}

/// A face of the volume, with a map from the unit square to its points.
struct FaceOfGrid
{
  const Grid& grid;
  int axis;
  bool up;

  double Area() const
  {
    const int b = (this->axis + 1) % 3, c = (this->axis + 2) % 3;
    return this->grid.size[b] * this->grid.spacing[b] * this->grid.size[c] * this->grid.spacing[c];
  }
  glm::dvec3 At(double u, double v) const
  {
    glm::dvec3 point;
    for (int a = 0; a < 3; ++a)
    {
      const double part = a == this->axis ? (this->up ? 1.0 : 0.0) : a == (this->axis + 1) % 3 ? u : v;
      point[a] = this->grid.origin[a] + part * this->grid.size[a] * this->grid.spacing[a];
    }
    return point;
  }
};

/// Photons of a rectangular light: samples points on the rectangle, then directions to those faces of the volume that
/// are visible from each point.
PhotonSource RectangleByPlaces(const Grid& grid, const Light& light)
{
  const glm::dvec3 middle = Vector(light.position);
  const glm::dvec3 normal = Vector(DirectionOf(light));
  const auto edges = RectangleEdges(light);
  return { 0, [=](const PhotonSample& u) -> std::optional<Shot> {
            const LampView view(grid, middle + Vector(edges[0]) * (u[2] - 0.5) + Vector(edges[1]) * (u[3] - 0.5));
            const glm::dvec3 direction =
              view.Outside() ? view.Direction(u[0], u[1]) : Around(normal, 1.0 - std::sqrt(1.0 - u[0]), u[1]);
            const double cosine = glm::dot(direction, normal);
            if (cosine <= 0.0 || !view.Enters(direction))
            {
              return {};
            }
            return Shot{ view.Lamp(), direction,
              view.Outside() ? Times(light.power, cosine * view.SolidAngle() / Pi) : light.power };
          } };
}

/// Photons of a rectangular light that is large as seen from the volume, so that most of its points contribute almost
/// nothing. Samples points on the faces of the volume, then directions in the solid angle of the rectangle as seen from
/// each point. For the part of the rectangle inside the volume, samples points on that part.
class RectangleByFaces
{
public:
  RectangleByFaces(const Grid& grid, const Light& light)
    : TheGrid(grid)
    , Power(light.power)
    , Middle(Vector(light.position))
    , Normal(Vector(DirectionOf(light)))
    , First(Vector(RectangleEdges(light)[0]))
    , Second(Vector(RectangleEdges(light)[1]))
    , Area(light.size[0] * light.size[1])
  {
    const std::vector<glm::dvec2> within = this->InVolume();
    if (within.size() > 2)
    {
      this->Within.emplace(within);
    }
    this->SetShares();
  }

  std::optional<Shot> Shoot(const PhotonSample& u) const
  {
    if (this->Shares[Parts] == 0.0)
    {
      return {};
    }
    double along;
    const int part = FindStep(this->Shares.data(), Parts, u[0], along);
    const double share = (this->Shares[part + 1] - this->Shares[part]) / this->Shares[Parts];
    std::optional<Shot> shot = this->ShootFrom(part, { along, u[1], u[2], u[3] });
    if (shot)
    {
      shot->power = Times(shot->power, 1.0 / share);
    }
    return shot;
  }

private:
  /// Number of surfaces on which photons start: the six faces, and the part of the rectangle inside the volume
  static constexpr int Parts = 7;

  std::optional<Shot> ShootFrom(int part, const PhotonSample& u) const
  {
    return part < 6 ? this->ThroughFace(part, u) : this->FromWithin(u);
  }

  std::optional<Shot> ThroughFace(int face, const PhotonSample& u) const
  {
    const FaceOfGrid at = { this->TheGrid, face / 2, face % 2 == 1 };
    const glm::dvec3 point = at.At(u[0], u[1]);
    if (glm::dot(point - this->Middle, this->Normal) <= 0.0)
    {
      return {};
    }
    constexpr double inaccurateBelow = 1e-4;
    const SphericalRectangle seen(
      point, this->Middle - 0.5 * (this->First + this->Second), this->First, this->Second, inaccurateBelow);
    const glm::dvec3 from = seen.At(u[2], u[3]);
    const glm::dvec3 direction = glm::normalize(point - from);
    const double cosine = at.up ? -direction[at.axis] : direction[at.axis];
    if (!(cosine > 0.0) || (this->Within && !LampView(this->TheGrid, from).Outside()))
    {
      return {};
    }
    return Shot{ point, direction,
      Times(this->Power, cosine * seen.SolidAngleBy(from) * at.Area() / (Pi * this->Area)) };
  }

  std::optional<Shot> FromWithin(const PhotonSample& u) const
  {
    const glm::dvec2 place = this->Within ? this->Within->At(u[0], u[1]) : glm::dvec2(0.0);
    const LampView view(this->TheGrid, this->Middle + this->First * place.x + this->Second * place.y);
    const glm::dvec3 direction = Around(this->Normal, 1.0 - std::sqrt(1.0 - u[2]), u[3]);
    if (!this->Within || view.Outside() || !view.Enters(direction))
    {
      return {};
    }
    return Shot{ view.Lamp(), direction, Times(this->Power, this->Within->Area()) };
  }

  /// Corners of the part of the rectangle that LampView counts as inside the volume, relative to the rectangle's
  /// centre, as fractions of the rectangle's edge vectors; empty if no part is inside.
  std::vector<glm::dvec2> InVolume() const
  {
    std::vector<glm::dvec2> corners = { { -0.5, -0.5 }, { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } };
    for (int face = 0; face < 6; ++face)
    {
      const int axis = face / 2;
      const double low = this->TheGrid.origin[axis], length = this->TheGrid.Length(axis);
      const double sign = face % 2 == 1 ? -1.0 : 1.0, border = face % 2 == 1 ? low + length : low;
      const auto depth = [&](const glm::dvec2& at) {
        return sign * (this->Middle[axis] - border + this->First[axis] * at.x + this->Second[axis] * at.y) +
          LampView::Slack * length;
      };
      corners = Clipped(corners, depth);
    }
    return corners;
  }

  /// Divides the samples among the six faces and the part of the rectangle inside the volume, in proportion to the root
  /// mean square power of their photons, which minimises the variance of the sum.
  void SetShares()
  {
    constexpr int samples = 512;
    // Smallest fraction of the samples for a face, or for the part of the rectangle inside the volume, if light may
    // start there, even if all its test samples had no power
    constexpr double least = 0.01;
    std::array<double, Parts> shares = {};
    double sum = 0.0;
    for (int part = 0; part < Parts; ++part)
    {
      const auto shoot = [&](const PhotonSample& u) { return this->ShootFrom(part, u); };
      shares[part] = std::sqrt(MomentsOf(samples, this->Power, shoot).square);
      sum += shares[part];
    }
    for (int part = 0; part < Parts; ++part)
    {
      const bool mayShine = part < 6 ? this->SeesFace(part) : this->Within.has_value();
      this->Shares[part + 1] = this->Shares[part] + (mayShine ? std::max(shares[part], least * sum) : 0.0);
    }
  }

  /// Whether part of the face is in front of the rectangle, and part of the rectangle in front of the face.
  bool SeesFace(int face) const
  {
    const FaceOfGrid at = { this->TheGrid, face / 2, face % 2 == 1 };
    bool lit = false, seen = false;
    for (int corner = 0; corner < 4; ++corner)
    {
      const double u = corner % 2, v = corner / 2;
      lit = lit || glm::dot(at.At(u, v) - this->Middle, this->Normal) > 0.0;
      const glm::dvec3 from = this->Middle + this->First * (u - 0.5) + this->Second * (v - 0.5) - at.At(0.0, 0.0);
      seen = seen || (at.up ? from[at.axis] : -from[at.axis]) > 0.0;
    }
    return lit && seen;
  }

  Grid TheGrid;
  Rgb Power;
  glm::dvec3 Middle, Normal, First, Second;
  double Area;
  /// Part of the rectangle that is inside the volume, its corners relative to the rectangle's centre, as fractions of
  /// the rectangle's edge vectors; empty: the rectangle is outside
  std::optional<ConvexPolygon> Within;
  /// Cumulative shares of the samples: six faces, then the part of the rectangle inside the volume; with a leading
  /// zero.
  std::array<double, Parts + 1> Shares = {};
};

/// Mean square of the photons' powers, divided by the square of their mean. 1 if all photons reach the volume with the
/// same power; infinite if none reaches it.
double Unevenness(const Grid& grid, const PhotonSource& source, const Rgb& power)
{
  constexpr int samples = 1024;
  const Moments moments = MomentsOf(samples, power, [&](const PhotonSample& u) {
    const std::optional<Shot> shot = source.shoot(u);
    return shot && Land(grid, *shot) ? shot : std::nullopt;
  });
  return moments.mean > 0.0 ? moments.square / (moments.mean * moments.mean) : std::numeric_limits<double>::infinity();
}

PhotonSource Rectangle(const Grid& grid, const Light& light)
{
  constexpr double worthIt = 4.0;
  PhotonSource byPlaces = RectangleByPlaces(grid, light);
  const double shortest = std::min({ grid.Length(0), grid.Length(1), grid.Length(2) });
  if (std::max(light.size[0], light.size[1]) <= shortest || Sum(light.power) == 0.0)
  {
    return byPlaces;
  }
  const double unevenness = Unevenness(grid, byPlaces, light.power);
  if (unevenness <= worthIt)
  {
    return byPlaces;
  }
  const auto faces = std::make_shared<RectangleByFaces>(grid, light);
  const PhotonSource byFaces = { 0, [faces](const PhotonSample& u) { return faces->Shoot(u); } };
  return worthIt * Unevenness(grid, byFaces, light.power) < unevenness ? byFaces : byPlaces;
}

PhotonSource DiffuseFace(const Grid& grid, int face, const Rgb& radiance)
{
  const int axis = face / 2;
  const bool up = face % 2 == 1;
  glm::dvec3 inwards(0.0);
  inwards[axis] = up ? -1.0 : 1.0;
  return { -2, [=](const PhotonSample& u) {
            const FaceOfGrid at = { grid, axis, up };
            return Shot{ at.At(u[0], u[1]), Around(inwards, 1.0 - std::sqrt(1.0 - u[2]), u[3]),
              Times(radiance, Pi * at.Area()) };
          } };
}

/// Photons of the environment and the sky: samples directions by the power that each direction sends onto the volume.
class Sky
{
public:
  Sky(const Grid& grid, const Environment& environment, const Rgb& sky)
    : TheGrid(grid)
    , Picture(environment)
    , Constant(sky)
    , Width(environment.Empty() ? 64 : environment.width)
    , Height(environment.Empty() ? 32 : environment.height)
    , Pixels(this->Width, this->Height, this->Weights())
  {
  }

  std::optional<Shot> Shoot(const PhotonSample& u) const
  {
    if (this->Pixels.Total() == 0.0)
    {
      return {};
    }
    const DensityTable::Place at = this->Pixels.At(u[3], u[2]);
    const double bottom = this->CosineBelow(at.row), top = this->CosineBelow(at.row + 1);
    const double cosine = bottom + at.along * (top - bottom);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double azimuth = 2.0 * Pi * (at.column + at.across) / this->Width;
    const glm::dvec3 seen =
      Vector(this->Picture.ToScene({ sine * std::cos(azimuth), sine * std::sin(azimuth), cosine }));

    const double angle = 2.0 * Pi / this->Width * (top - bottom);
    const double density = this->Pixels.WeightOf(at.column, at.row) / (this->Pixels.Total() * angle);
    return Shot{ this->OnOutline(seen, u), -seen, Times(this->Radiance(seen), this->Outline(seen) / density) };
  }

private:
  double CosineBelow(int row) const { return -std::cos(Pi * row / this->Height); }

  Rgb Radiance(const glm::dvec3& seen) const
  {
    const Rgb picture = this->Picture.Empty() ? Rgb{} : Lookup(this->Picture, { seen.x, seen.y, seen.z });
    return { picture[0] + this->Constant[0], picture[1] + this->Constant[1], picture[2] + this->Constant[2] };
  }

  double FaceOutline(int axis, const glm::dvec3& seen) const
  {
    return FaceOfGrid{ this->TheGrid, axis, true }.Area() * std::abs(seen[axis]);
  }

  double Outline(const glm::dvec3& seen) const
  {
    return this->FaceOutline(0, seen) + this->FaceOutline(1, seen) + this->FaceOutline(2, seen);
  }

  /// A point on one of the three faces that light from the direction `seen` reaches, uniform over the projected area.
  glm::dvec3 OnOutline(const glm::dvec3& seen, const PhotonSample& u) const
  {
    double wanted = u[0] * this->Outline(seen);
    int axis = 0;
    while (axis < 2 && wanted >= this->FaceOutline(axis, seen))
    {
      wanted -= this->FaceOutline(axis, seen);
      ++axis;
    }
    const double part = std::min(wanted / std::max(this->FaceOutline(axis, seen), 1e-300), 1.0);
    return FaceOfGrid{ this->TheGrid, axis, seen[axis] > 0.0 }.At(part, u[1]);
  }

  /// Sampling weights of the pixels: radiance of the bilinear image, times solid angle, times the volume's area
  /// projected along the pixel's direction.
  std::vector<double> Weights() const
  {
    std::vector<double> weights(static_cast<std::size_t>(this->Width) * this->Height);
    const auto brightness = [&](int i, int j) {
      if (this->Picture.Empty())
      {
        return Sum(this->Constant);
      }
      const int row = std::min(std::max(j, 0), this->Height - 1);
      const int column = (i + this->Width) % this->Width;
      const float* pixel = this->Picture.radiance.data() + 3 * (static_cast<std::size_t>(row) * this->Width + column);
      return double(pixel[0]) + pixel[1] + pixel[2] + Sum(this->Constant);
    };
    for (int j = 0; j < this->Height; ++j)
    {
      for (int i = 0; i < this->Width; ++i)
      {
        double sum = 0.0;
        for (int k = 0; k < 9; ++k)
        {
          sum += (k % 3 == 1 ? 6.0 : 1.0) * (k / 3 == 1 ? 6.0 : 1.0) / 64.0 * brightness(i + k % 3 - 1, j + k / 3 - 1);
        }
        const double polar = Pi * (1.0 - (j + 0.5) / this->Height);
        const double azimuth = 2.0 * Pi * (i + 0.5) / this->Width;
        const glm::dvec3 seen = Vector(this->Picture.ToScene(
          { std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar) }));
        weights[static_cast<std::size_t>(j) * this->Width + i] =
          sum * this->Outline(seen) * (this->CosineBelow(j + 1) - this->CosineBelow(j));
      }
    }
    return weights;
  }

  Grid TheGrid;
  Environment Picture;
  Rgb Constant;
  int Width, Height;
  DensityTable Pixels;
};
}

std::optional<Photon> Land(const Grid& grid, const Shot& shot)
{
  std::array<double, 3> position, direction;
  for (int a = 0; a < 3; ++a)
  {
    position[a] = (shot.from[a] - grid.origin[a]) / grid.spacing[a];
    direction[a] = shot.direction[a] / grid.spacing[a];
  }
  if (!MoveOnto(grid, position, direction))
  {
    return {};
  }
  Photon photon;
  for (int a = 0; a < 3; ++a)
  {
    photon.position[a] = grid.origin[a] + position[a] * grid.spacing[a];
    photon.direction[a] = static_cast<float>(shot.direction[a]);
    photon.power[a] = static_cast<float>(shot.power[a]);
  }
  return photon;
}

std::vector<PhotonSource> PhotonSourcesOf(const Grid& grid, const Illumination& illumination)
{
  std::vector<PhotonSource> sources;
  const std::vector<Light> lights = SeenFrom(grid, illumination.lights);
  for (std::size_t i = 0; i < lights.size(); ++i)
  {
    const Light& light = lights[i];
    sources.push_back(light.type == LightType::Directional ? Directional(grid, light)
        : light.type == LightType::Point                   ? Point(grid, light)
        : light.type == LightType::Spot                    ? Spot(grid, light)
                                                           : Rectangle(grid, light));
    sources.back().light = static_cast<int>(i);
  }
  if (!illumination.environment.Empty() || Sum(illumination.sky) > 0.0)
  {
    const auto sky = std::make_shared<Sky>(grid, illumination.environment, illumination.sky);
    sources.push_back({ EnvironmentLight, [sky](const PhotonSample& u) { return sky->Shoot(u); } });
  }
  for (int face = 0; face < 6; ++face)
  {
    if (Sum(illumination.faces[face]) > 0.0)
    {
      sources.push_back(DiffuseFace(grid, face, illumination.faces[face]));
    }
  }
  return sources;
}
}
