#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr int PointsPerEdge = 4;  ///< of a rectangle
constexpr double BeamWidth = 0.5; ///< of a lamp's beams where they leave the box, voxels; a rectangle's: twice
constexpr int RoundsAtMost = 64;  ///< that all power may go through one voxel, in fixed point
constexpr double OnBorder =
  1e-6; ///< of the box's edges: a lamp as near to a face is on it, as for photons (PhotonPlane.h)
}

LampOnGrid::LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
  : Lamp(light)
  , TheGrid(grid)
  , Periodic(periodic)
{
}

glm::dvec3 LampOnGrid::PlaceOf(const glm::dvec3& point) const
{
  glm::dvec3 place;
  for (int a = 0; a < 3; ++a)
  {
    const double size = this->TheGrid.size[a];
    place[a] = (point[a] - this->TheGrid.origin[a]) / this->TheGrid.spacing[a];
    place[a] = std::abs(place[a]) <= OnBorder * size ? 0.0
      : std::abs(place[a] - size) <= OnBorder * size ? size
                                                     : place[a];
  }
  return place;
}

glm::dvec3 LampOnGrid::Middle() const
{
  return this->PlaceOf(Vector(this->Lamp.position));
}

std::vector<glm::dvec3> LampOnGrid::Points() const
{
  if (this->Lamp.type != LightType::Rectangle)
  {
    return { this->Middle() };
  }
  const std::array<std::array<double, 3>, 2> edges = RectangleEdges(this->Lamp);
  std::vector<glm::dvec3> points;
  for (int j = 0; j < PointsPerEdge; ++j)
  {
    for (int i = 0; i < PointsPerEdge; ++i)
    {
      points.push_back(this->PlaceOf(Vector(this->Lamp.position) +
        Vector(edges[0]) * ((i + 0.5) / PointsPerEdge - 0.5) + Vector(edges[1]) * ((j + 0.5) / PointsPerEdge - 0.5)));
    }
  }
  return points;
}

std::vector<glm::dvec3> LampOnGrid::PointsOf(const Pass& pass) const
{
  return pass.begin == 0 ? this->Points() : std::vector<glm::dvec3>{ this->Middle() };
}

bool LampOnGrid::IsInside(const glm::dvec3& point) const
{
  bool inside = true;
  for (int a = 0; a < 3; ++a)
  {
    const double size = this->TheGrid.size[a];
    inside = inside && (this->Periodic[a] ? point[a] >= 0.0 && point[a] <= size : point[a] > 0.0 && point[a] < size);
  }
  return inside;
}

bool LampOnGrid::FollowsAll(const glm::dvec3& point) const
{
  return this->IsInside(point) ||
    (this->Lamp.type == LightType::Spot && SeesAllOfCone(this->TheGrid, this->Lamp, point));
}

/// Of a point's power, by the solid angles of the faces that it sees; 0 where that is not known.
double LampOnGrid::EnteringPart() const
{
  if (this->Lamp.type != LightType::Point)
  {
    return 0.0;
  }
  const glm::dvec3 point = this->Middle();
  double angle = 0.0;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto reach = [&](int a, double end) { return (end - point[a]) * this->TheGrid.spacing[a]; };
    const double near = face % 2 ? -reach(axis, this->TheGrid.size[axis]) : reach(axis, 0.0);
    if (near <= 0.0)
    {
      continue;
    }
    for (int corner = 0; corner < 4; ++corner)
    {
      const double a = reach(u, corner & 1 ? this->TheGrid.size[u] : 0.0);
      const double b = reach(v, corner & 2 ? this->TheGrid.size[v] : 0.0);
      const double seen = std::atan2(a * b, near * std::sqrt(a * a + b * b + near * near));
      angle += corner == 0 || corner == 3 ? seen : -seen;
    }
  }
  return angle / (4.0 * Pi);
}

double LampOnGrid::Correction(const LampShares& shares) const
{
  const std::vector<glm::dvec3> points = this->Points();
  const bool all =
    std::all_of(points.begin(), points.end(), [this](const glm::dvec3& point) { return this->FollowsAll(point); });
  if (all && shares.shone > 0.0)
  {
    return 1.0 / shares.shone;
  }
  const double entering = this->EnteringPart(), found = std::accumulate(shares.in.begin(), shares.in.end(), 0.0);
  return entering > 0.0 && found > 0.0 ? entering / found : this->Share();
}

/// By the ball around the box; a power of two.
double LampOnGrid::Share() const
{
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

std::vector<BeamRow> LampOnGrid::Rows(const glm::dvec3& point, const Pass& pass) const
{
  const double width = this->Lamp.type == LightType::Rectangle ? 2.0 * BeamWidth : BeamWidth;
  return Beams(this->TheGrid, this->Periodic, this->Lamp, point, width, pass);
}

LampInfo LampOnGrid::Describe(double part, const VoxelBox& stored, const VoxelBox& followed) const
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
  info.intensity = static_cast<float>(AxialIntensity(this->Lamp) * part / this->Share());
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
      " -DTHIN=" + FloatLiteral(ThinForFirstMoments));
}
}
