#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tyndall
{
namespace
{
/// How near a rectangle may be to the box, in its longer edges, for 16 points to do.
constexpr double FarEnough = 1.25;
constexpr double PartDistance = 2.0; ///< of voxels from the middle of a part that is not halved for them, in its radii
constexpr double PartsAcross = 64.0; ///< of one that lies along the box, at most
constexpr double Faint = 0.01;       ///< error of a point, of all light, for a part to be a point
constexpr double WideBeams = 1.5;    ///< of a rectangle as long as the box: in large grids its many points need no more
constexpr int ManyVoxels = 48;
constexpr std::size_t BeamsTogether = 1 << 18;

constexpr double BeamWidth = 0.5; ///< of a lamp's beams where they leave the box, voxels; a rectangle's: LampOnGrid.h
constexpr int RoundsAtMost = 64;  ///< that all power may go through one voxel, in fixed point
constexpr double OnBorder = 1e-6; ///< of the box's edges: so near to a face a lamp is on it, as for photons

/// Voxels from the grid's corner; on a face where it is next to it.
glm::dvec3 PlaceOf(const Grid& grid, const glm::dvec3& point)
{
  glm::dvec3 place = (point - Vector(grid.origin)) / Vector(grid.spacing);
  for (int a = 0; a < 3; ++a)
  {
    const double size = grid.size[a], end = std::round(place[a] / size) * size;
    place[a] = (end == 0.0 || end == size) && std::abs(place[a] - end) <= OnBorder * size ? end : place[a];
  }
  return place;
}

/// Part of the light of a point, or of a plane of this normal there, that meets a face of the box: by solid angle or,
/// with the cosine, by Lambert's formula for a polygon, of which the part before the plane counts.
double PartThrough(std::vector<glm::dvec3> corners, const glm::dvec3* normal)
{
  if (!normal)
  {
    const glm::dvec3 &a = corners[0], &b = corners[1], &c = corners[2], &d = corners[3];
    const auto triangle = [](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r) { // Van Oosterom, Strackee
      const double x = glm::length(p), y = glm::length(q), z = glm::length(r);
      return 2.0 *
        std::atan2(std::abs(glm::dot(p, glm::cross(q, r))),
          x * y * z + glm::dot(p, q) * z + glm::dot(q, r) * x + glm::dot(r, p) * y);
    };
    return (triangle(a, b, c) + triangle(a, c, d)) / (4.0 * Pi);
  }
  std::vector<glm::dvec3> before;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double from = glm::dot(a, *normal), to = glm::dot(b, *normal);
    if (from >= 0.0)
    {
      before.push_back(a);
    }
    if (from * to < 0.0)
    {
      before.push_back(a + (b - a) * (from / (from - to)));
    }
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i)
  {
    const glm::dvec3 &a = before[i], &b = before[(i + 1) % before.size()], across = glm::cross(a, b);
    const double sine = glm::length(across);
    sum += sine > 0.0 ? std::atan2(sine, glm::dot(a, b)) * glm::dot(across, *normal) / sine : 0.0;
  }
  return std::abs(sum) / (2.0 * Pi);
}

/// Part of a point's light, or of a plane's of this normal there, that enters the box: all of it inside.
/// @param place  voxels
double EnteringPart(
  const Grid& grid, const glm::dvec3& place, const glm::dvec3* normal, const std::array<bool, 3>& periodic = {})
{
  double part = 0.0, onFaces = 1.0;
  bool outside = false;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double size = grid.size[axis], away = face % 2 ? place[axis] - size : -place[axis];
    if (away == 0.0 && !periodic[axis])
    {
      onFaces *= normal ? 0.5 + (face % 2 ? -0.5 : 0.5) * (*normal)[axis] : 0.5;
    }
    if (away <= 0.0)
    {
      continue;
    }
    outside = true;
    std::vector<glm::dvec3> corners;
    for (const auto& [first, second] : { std::pair{ 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } })
    {
      glm::dvec3 corner;
      corner[axis] = face % 2 ? size : 0.0;
      corner[u] = first * grid.size[u];
      corner[v] = second * grid.size[v];
      corners.push_back((corner - place) * Vector(grid.spacing));
    }
    part += PartThrough(corners, normal);
  }
  return outside ? part : onFaces;
}

/// A rectangle, or a part of one. Lengths from the grid's corner.
struct Area
{
  glm::dvec3 middle;
  std::array<glm::dvec3, 2> half; ///< of its edges

  Area(const Light& light, const Grid& grid)
    : middle(Vector(light.position) - Vector(grid.origin))
  {
    const std::array<std::array<double, 3>, 2> edges = RectangleEdges(light);
    this->half = { 0.5 * Vector(edges[0]), 0.5 * Vector(edges[1]) };
  }

  double Longer() const { return 2.0 * std::max(glm::length(this->half[0]), glm::length(this->half[1])); }
  double Radius() const { return std::hypot(glm::length(this->half[0]), glm::length(this->half[1])); }
  double Size() const { return 4.0 * glm::length(this->half[0]) * glm::length(this->half[1]); }

  glm::dvec3 At(double a, double b) const { return this->middle + a * this->half[0] + b * this->half[1]; }

  /// Its halves, across the longer edge; quarters where that is not much longer, so that turned scenes have the same.
  std::vector<Area> Parts() const
  {
    constexpr double muchLonger = 1.5;
    const double lengths[] = { glm::length(this->half[0]), glm::length(this->half[1]) };
    const bool first = lengths[0] * muchLonger > lengths[1], second = lengths[1] * muchLonger > lengths[0];
    std::vector<Area> parts;
    for (int i = 0; i < (first ? 2 : 1) * (second ? 2 : 1); ++i)
    {
      Area part = *this;
      part.half[0] *= first ? 0.5 : 1.0;
      part.half[1] *= second ? 0.5 : 1.0;
      const bool upper[] = { i % 2 == 1, first ? i / 2 == 1 : i % 2 == 1 };
      part.middle += (first ? (upper[0] ? 1.0 : -1.0) : 0.0) * part.half[0];
      part.middle += (second ? (upper[1] ? 1.0 : -1.0) : 0.0) * part.half[1];
      parts.push_back(part);
    }
    return parts;
  }

  /// Gauss's points.
  std::array<glm::dvec3, 4> Points() const
  {
    constexpr double g = 0.577350269189626;
    return { this->At(-g, -g), this->At(g, -g), this->At(-g, g), this->At(g, g) };
  }
};

glm::dvec3 EndOf(const Grid& grid)
{
  return { grid.Length(0), grid.Length(1), grid.Length(2) };
}

/// Mean of the part of a rectangle's light that enters the box.
double EnteringPart(const Grid& grid, const Area& area, const glm::dvec3& normal, int depth)
{
  constexpr int deepest = 10; // of what lies on both sides of a face
  constexpr double small = 0.4;
  const double radius = area.Radius();
  const glm::dvec3 end = EndOf(grid), nearest = glm::clamp(area.middle, glm::dvec3(0.0), end);
  const double distance = glm::distance(area.middle, nearest);
  double within = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a)
  {
    const double across = std::abs(area.half[0][a]) + std::abs(area.half[1][a]);
    within = std::min({ within, area.middle[a] - across, end[a] - area.middle[a] - across });
  }
  if (within > 0.0)
  {
    return 1.0;
  }
  if (depth < deepest && distance - radius < radius / small)
  {
    const std::vector<Area> parts = area.Parts();
    double sum = 0.0;
    for (const Area& part : parts)
    {
      sum += EnteringPart(grid, part, normal, depth + 1) / static_cast<double>(parts.size());
    }
    return sum;
  }
  double sum = 0.0;
  for (const glm::dvec3& point : area.Points())
  {
    sum += 0.25 * EnteringPart(grid, PlaceOf(grid, point + Vector(grid.origin)), &normal);
  }
  return sum;
}

/// A near rectangle in parts: each voxel has the light of parts that are small beside their distance from it, which
/// together are all of the rectangle.
class RectangleParts
{
public:
  RectangleParts(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light)
    : TheGrid(grid)
    , Periodic(periodic)
    , Whole(light, grid)
    , Normal(Vector(DirectionOf(light)))
  {
    const double along = std::max({ grid.size[0], grid.size[1], grid.size[2] });
    const double voxel = std::cbrt(grid.spacing[0] * grid.spacing[1] * grid.spacing[2]);
    this->Finest = voxel * std::max(1.0, along / PartsAcross);
    this->Divide(this->Whole, { this->Whole.middle, std::numeric_limits<double>::infinity() });
  }

  std::vector<LampPoint> Points;

private:
  /// Distances of the box's voxels from a point, at least and at most.
  std::array<double, 2> Distances(const glm::dvec3& point) const
  {
    const glm::dvec3 end = EndOf(this->TheGrid);
    double least = 0.0, most = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const double first = 0.5 * this->TheGrid.spacing[a], last = end[a] - first;
      const double nearest = this->Periodic[a] ? 0.0 : point[a] - std::clamp(point[a], first, last);
      const double farthest = this->Periodic[a] ? std::numeric_limits<double>::infinity()
                                                : std::max(std::abs(point[a] - first), std::abs(point[a] - last));
      least = std::hypot(least, nearest);
      most = std::hypot(most, farthest);
    }
    return { least, most };
  }

  /// Solid angle of the rectangle from a point before it.
  double SolidAngle(const glm::dvec3& eye) const
  {
    std::vector<glm::dvec3> corners;
    for (const auto& [a, b] : { std::pair{ -1.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 1.0 }, { -1.0, 1.0 } })
    {
      corners.push_back(this->Whole.At(a, b) - eye);
    }
    return 4.0 * Pi * PartThrough(corners, nullptr);
  }

  /// Whether a part adds so little to the light of the box that one point stands for it.
  bool IsFaint(const Area& part) const
  {
    const glm::dvec3 eye = glm::clamp(part.middle, glm::dvec3(0.0), EndOf(this->TheGrid)), way = eye - part.middle;
    const double distance = glm::length(way), cosine = glm::dot(way, this->Normal) / distance;
    if (!(distance > part.Radius()) || !(cosine > 0.0))
    {
      return false;
    }
    const double square = distance * distance, edge = part.Longer();
    return part.Size() * cosine / square * (edge * edge / square) < Faint * this->SolidAngle(eye);
  }

  void Divide(const Area& part, const LampPoint::Sphere& whole)
  {
    const std::array<double, 2> distances = this->Distances(part.middle);
    const bool faint = this->IsFaint(part);
    const double from = PartDistance * part.Radius();
    const bool undivided = faint || part.Longer() <= this->Finest * (1.0 + 1e-9) || distances[0] >= from;
    const LampPoint::Sphere own = { part.middle, undivided ? 0.0 : from };
    if (undivided || distances[1] >= from)
    {
      this->Add(part, own, whole, faint);
    }
    if (!undivided)
    {
      for (const Area& half : part.Parts())
      {
        this->Divide(half, own);
      }
    }
  }

  void Add(const Area& part, const LampPoint::Sphere& own, const LampPoint::Sphere& whole, bool faint)
  {
    const std::array<glm::dvec3, 4> all = part.Points();
    const std::vector<glm::dvec3> points =
      faint ? std::vector<glm::dvec3>{ part.middle } : std::vector<glm::dvec3>(all.begin(), all.end());
    for (const glm::dvec3& point : points)
    {
      const double share = part.Size() / this->Whole.Size() / static_cast<double>(points.size());
      this->Points.push_back({ PlaceOf(this->TheGrid, point + Vector(this->TheGrid.origin)), share, own, whole,
        whole.radius + glm::distance(point, whole.middle) });
    }
  }

  const Grid& TheGrid;
  const std::array<bool, 3>& Periodic;
  Area Whole;
  glm::dvec3 Normal;
  double Finest; ///< edge of a part
};

/// Distance between a rectangle and the box, by the nearest point of each in turn.
double DistanceToBox(const Area& area, const Grid& grid)
{
  glm::dvec3 at = area.middle, inBox = at;
  for (int i = 0; i < 100; ++i)
  {
    inBox = glm::clamp(at, glm::dvec3(0.0), EndOf(grid));
    at = area.middle;
    for (const glm::dvec3& half : area.half)
    {
      at += half * std::clamp(glm::dot(inBox - area.middle, half) / glm::dot(half, half), -1.0, 1.0);
    }
  }
  return glm::distance(at, inBox);
}
}

LampOnGrid::LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
  : Lamp(light)
  , TheGrid(grid)
  , Periodic(periodic)
{
  LampPoint middle;
  middle.place = PlaceOf(grid, Vector(light.position));
  this->Centre = { middle };
  this->Points = this->Centre;
  if (light.type == LightType::Point)
  {
    this->Entering = EnteringPart(grid, middle.place, nullptr, periodic);
  }
  if (light.type == LightType::Rectangle)
  {
    this->DivideRectangle();
  }
}

/// Far from the box into quarters of four points each.
void LampOnGrid::DivideRectangle()
{
  const Area area(this->Lamp, this->TheGrid);
  this->Entering = EnteringPart(this->TheGrid, area, Vector(DirectionOf(this->Lamp)), 0);
  this->IsNear = DistanceToBox(area, this->TheGrid) < FarEnough * area.Longer();
  if (this->IsNear)
  {
    const bool many =
      area.Longer() >= std::max({ EndOf(this->TheGrid).x, EndOf(this->TheGrid).y, EndOf(this->TheGrid).z });
    const int along = std::max({ this->TheGrid.size[0], this->TheGrid.size[1], this->TheGrid.size[2] });
    this->Width = many && along >= ManyVoxels ? WideBeams : this->Width;
    this->Points = RectangleParts(this->TheGrid, this->Periodic, this->Lamp).Points;
    return;
  }
  this->Points.clear();
  Area quarter = area;
  quarter.half = { 0.5 * area.half[0], 0.5 * area.half[1] };
  for (int i = 0; i < 4; ++i)
  {
    quarter.middle = area.At(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5);
    for (const glm::dvec3& point : quarter.Points())
    {
      LampPoint sixteenth;
      sixteenth.place = PlaceOf(this->TheGrid, point + Vector(this->TheGrid.origin));
      sixteenth.share = 1.0 / 16.0;
      this->Points.push_back(sixteenth);
    }
  }
}

/// Whether its beams take all light: it is in the box, or a cone that leads into it.
bool LampOnGrid::FollowsAll() const
{
  const glm::dvec3 place = this->Centre[0].place;
  bool inside = this->Lamp.type != LightType::Rectangle;
  for (int a = 0; a < 3; ++a)
  {
    const double size = this->TheGrid.size[a];
    inside = inside && (this->Periodic[a] ? place[a] >= 0.0 && place[a] <= size : place[a] > 0.0 && place[a] < size);
  }
  return inside || (this->Lamp.type == LightType::Spot && SeesAllOfCone(this->TheGrid, this->Lamp, place));
}

LampFactors LampOnGrid::Factors(const LampShares& shares, double taken, double even) const
{
  if (this->FollowsAll() && shares.shone > 0.0)
  {
    return { 1.0 / shares.shone, 1.0 / shares.shone, 1.0 / shares.shone };
  }
  const double in = this->Entering > 0.0 && shares.In() > 0.0 ? this->Entering / shares.In() : this->Share();
  if (!this->IsNear)
  {
    return { in, in, in };
  }
  // The parts of a rectangle do not add up exactly: the larger of what the medium takes and what leaves makes up for it.
  const double share = this->Share(), left = share * (shares.Out() + even), kept = share * taken;
  const double square = kept * kept + left * left;
  const double rest = square > 0.0 ? (this->Entering - kept - left) / square : 0.0;
  return { in, share * (1.0 + rest * kept), share * (1.0 + rest * left) };
}

/// By the ball around the box; a power of two.
double LampOnGrid::Share() const
{
  if (this->IsNear)
  {
    return this->Entering > 0.0 ? std::exp2(std::ceil(std::log2(this->Entering))) : 1.0;
  }
  constexpr double ofNearBall = 1.1; // solid angle of a ball over pi (radius / distance)^2, from twice its radius on
  const Grid& grid = this->TheGrid;
  const double radius = 0.5 * std::hypot(grid.Length(0), grid.Length(1), grid.Length(2));
  glm::dvec3 way = Vector(grid.origin) - Vector(this->Lamp.position);
  for (int a = 0; a < 3; ++a)
  {
    way[a] += 0.5 * grid.Length(a);
  }
  const double ofLamp =
    this->Lamp.type == LightType::Rectangle ? 0.5 * std::hypot(this->Lamp.size[0], this->Lamp.size[1]) : 0.0;
  const double distance = glm::length(way) - ofLamp;
  if (distance < 2.0 * radius)
  {
    return 1.0;
  }
  const double part = radius / distance;
  const double share = ofNearBall * Pi * AxialIntensity(this->Lamp) * part * part;
  return share < 1.0 ? std::exp2(std::ceil(std::log2(share))) : 1.0;
}

std::vector<BeamRow> LampOnGrid::Rows(const Pass& pass, double factor, std::size_t first, std::size_t& next) const
{
  const double width = this->Lamp.type == LightType::Rectangle ? this->Width : BeamWidth;
  const std::vector<LampPoint>& points = this->PointsOf(pass);
  std::vector<BeamRow> rows;
  std::size_t beams = 0;
  for (next = first; next < points.size() && beams < BeamsTogether; ++next)
  {
    const LampPoint& point = points[next];
    for (BeamRow& row : Beams(this->TheGrid, this->Periodic, this->Lamp, point.place, width, pass, point.reach))
    {
      row.share = static_cast<float>(point.share * factor);
      for (int a = 0; a < 3; ++a)
      {
        row.part[a] = static_cast<float>(point.part.middle[a] / this->TheGrid.spacing[a]);
        row.whole[a] = static_cast<float>(point.whole.middle[a] / this->TheGrid.spacing[a]);
      }
      row.partFrom = static_cast<float>(point.part.radius * point.part.radius);
      row.wholeFrom = static_cast<float>(point.whole.radius * point.whole.radius);
      beams += row.count;
      rows.push_back(row);
    }
  }
  return rows;
}

int LampOnGrid::SumsOfVacuum() const
{
  return !this->IsNear ? 0 : this->Periodic[0] || this->Periodic[1] || this->Periodic[2] ? 2 : 1;
}

RectangleInfo LampOnGrid::DescribeRectangle(const VoxelBox& own) const
{
  RectangleInfo info = {};
  const Grid& grid = this->TheGrid;
  const std::array<std::array<double, 3>, 2> edges = RectangleEdges(this->Lamp);
  const glm::dvec3 axes[] = { glm::normalize(Vector(edges[0])), glm::normalize(Vector(edges[1])),
    Vector(DirectionOf(this->Lamp)) };
  const glm::dvec3 first(own.first[0], own.first[1], own.first[2]);
  const glm::dvec3 corner = Vector(grid.origin) + first * Vector(grid.spacing) - Vector(this->Lamp.position);
  for (int a = 0; a < 3; ++a)
  {
    info.corner[a] = static_cast<float>(glm::dot(corner, axes[a]));
    for (int b = 0; b < 3; ++b)
    {
      info.edges[a][b] = static_cast<float>(axes[a][b]);
    }
    info.size[a] = own.size[a];
    info.spacing[a] = static_cast<float>(grid.spacing[a]);
  }
  info.reach[0] = static_cast<float>(0.5 * this->Lamp.size[0]);
  info.reach[1] = static_cast<float>(0.5 * this->Lamp.size[1]);
  const double volume = grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
  info.path = static_cast<float>(volume / (Pi * this->Lamp.size[0] * this->Lamp.size[1] * this->Share()));
  info.scale = static_cast<float>(this->UnitsPerLength());
  return info;
}

LampInfo LampOnGrid::Describe(const VoxelBox& stored, const VoxelBox& followed) const
{
  LampInfo info = {};
  const Grid& grid = this->TheGrid;
  const std::array<double, 3> direction = DirectionOf(this->Lamp);
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = grid.size[a];
    info.first[a] = stored.first[a];
    info.stored[a] = stored.size[a];
    info.followed[a] = followed.first[a];
    info.followedEnd[a] = followed.first[a] + followed.size[a];
    info.periodic[a] = this->Periodic[a];
    info.spacing[a] = static_cast<float>(grid.spacing[a]);
    info.direction[a] = static_cast<float>(direction[a]);
  }
  info.intensity = static_cast<float>(AxialIntensity(this->Lamp) / this->Share());
  const double sine = std::sin(HalfAngle(this->Lamp));
  info.cosine = static_cast<float>(std::cos(HalfAngle(this->Lamp)));
  info.sineSquare = static_cast<float>(sine * sine);
  info.scale = static_cast<float>(this->UnitsPerLength());
  info.diagonal = static_cast<float>(this->Diagonal());
  for (int face = 0; face < 6; ++face)
  {
    const BoxFaceLayout layout = LayoutOfFace(grid, face);
    info.faceFirst[face] = static_cast<cl_int>(layout.first);
    std::copy(layout.step.begin(), layout.step.end(), info.faceStep[face / 2]);
  }
  return info;
}

/// No voxel can gather more than all power along its diagonal, once a round.
double LampOnGrid::UnitsPerLength() const
{
  return std::exp2(std::floor(std::log2(0x1p60 / (this->Diagonal() * RoundsAtMost))));
}

double LampOnGrid::Diagonal() const
{
  const std::array<double, 3>& h = this->TheGrid.spacing;
  return std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}

cl::Kernel LampOnGrid::Kernel(Device& device, const char* name, std::string_view source, const Deposit& deposit) const
{
  return device.Kernel(name, source,
    Define("ATOMICS", HasAtomics(device)) + Define("LAMBERT", this->Lamp.type == LightType::Rectangle) +
      Define("CONE", this->Lamp.type == LightType::Spot) + Define("MOMENTS", deposit.firstMoments != nullptr) +
      Define("NET_FLUX", deposit.flux != nullptr) + Define("FACE_OUT", deposit.faceOut != nullptr) +
      Define("VACUUM", this->SumsOfVacuum() > 0) + Define("AROUND", this->SumsOfVacuum() > 1) +
      " -DTHIN=" + FloatLiteral(ThinForFirstMoments));
}
}
