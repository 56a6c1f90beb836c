#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace tyndall
{
namespace
{
constexpr std::size_t BeamsTogether = 1 << 18;
/// Number of periodic images of a rectangular lamp, on either side of it, whose light in vacuum is integrated
/// analytically; fewer in a box that is periodic along all axes, where light never escapes.
constexpr int ImagesAside = 5, ImagesAsideWithoutFaces = 1;

/// Width of beams where they leave the box, voxels: for a point or spot lamp, for a rectangle, and for a rectangle that
/// is represented by at least ManyPoints points.
constexpr double BeamWidth = 0.5, BeamWidthOfRectangle = 1.0, BeamWidthOfMany = 1.4;
constexpr std::size_t ManyPoints = 64;
/// A voxel's fixed-point sum does not overflow as long as the lamp's full power crosses the voxel at most this number
/// of times.
constexpr int RoundsAtMost = 64;

/// Moves a rectangle that lies on a face normal to a periodic axis and emits out of the box to the opposite face, where
/// it emits into the box.
Light ShiningIn(Light light, const Grid& grid, const std::array<bool, 3>& periodic)
{
  if (light.type != LightType::Rectangle)
  {
    return light;
  }
  const Polygon corners = RectangleArea(light, grid).Corners();
  const glm::dvec3 normal = Vector(DirectionOf(light));
  for (int a = 0; a < 3; ++a)
  {
    const double end = normal[a] > 0.0 ? grid.Length(a) : 0.0;
    const bool lies = std::all_of(corners.begin(), corners.end(),
      [&](const glm::dvec3& corner) { return std::abs(corner[a] - end) <= OnBorder * grid.Length(a); });
    if (periodic[a] && lies)
    {
      light.position[a] += end > 0.0 ? -grid.Length(a) : grid.Length(a);
    }
  }
  return light;
}
}

LampOnGrid::LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
  : Lamp(ShiningIn(light, grid, periodic))
  , TheGrid(grid)
  , Periodic(periodic)
  , Entering(EnteringFraction(this->Lamp, grid, periodic))
{
  LampPoint middle;
  middle.place = PlaceOf(grid, Vector(this->Lamp.position));
  this->Centre = { middle };
  this->Points = this->Centre;
  if (light.type == LightType::Rectangle)
  {
    this->CountImages();
    this->Points = PointsOfRectangle(this->Lamp, grid, periodic);
  }
}

/// Sets the number of a rectangle's periodic images whose light in vacuum is integrated analytically; 0 unless the
/// rectangle is in the box.
void LampOnGrid::CountImages()
{
  const glm::dvec3 end = EndOf(this->TheGrid);
  const bool endless = this->Periodic[0] && this->Periodic[1] && this->Periodic[2];
  bool inside = true;
  for (const glm::dvec3& corner : RectangleArea(this->Lamp, this->TheGrid).Corners())
  {
    const glm::dvec3 aside = glm::abs(corner - 0.5 * end) - (0.5 + OnBorder) * end;
    inside = inside && std::max({ aside.x, aside.y, aside.z }) <= 0.0;
  }
  for (int a = 0; a < 3; ++a)
  {
    this->Images[a] = inside && this->Periodic[a] ? (endless ? ImagesAsideWithoutFaces : ImagesAside) : 0;
  }
}

/// Whether the traced beams carry all light of the lamp: it is in the box, or its cone lies within the box's solid
/// angle.
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
  if (this->Lamp.type != LightType::Rectangle)
  {
    return { in, in, in };
  }
  // The light of a rectangle's parts does not conserve energy exactly. The power that the medium removes and the power
  // that escapes are therefore corrected, the larger one by more (numerics.md, Eq. (34b)).
  const double share = this->Share(), left = share * (shares.Out() + even), kept = share * taken;
  const double square = kept * kept + left * left;
  if (!(square > 0.0))
  {
    return { 0.0, 0.0, 0.0 }; // no light reaches the box
  }
  const double rest = (in * shares.In() - kept - left) / square;
  return { in, share * (1.0 + rest * kept), share * (1.0 + rest * left) };
}

/// The share is the lamp's intensity times the solid angle of the sphere around the box, rounded up to a power of two.
/// For a rectangle it is instead the fraction of its light that enters the box, if that is known, rounded up in the
/// same way.
double LampOnGrid::Share() const
{
  if (this->Lamp.type == LightType::Rectangle && this->Entering > 0.0)
  {
    return std::exp2(std::ceil(std::log2(this->Entering)));
  }
  // Upper bound of the ratio of the solid angle of a sphere to pi (radius / distance)^2, at distances of at least twice
  // its radius
  constexpr double ofNearBall = 1.1;
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
  const double ofRectangle = this->Points.size() < ManyPoints ? BeamWidthOfRectangle : BeamWidthOfMany;
  const double width = this->Lamp.type == LightType::Rectangle ? ofRectangle / this->Lamp.fineness : BeamWidth;
  const double margin = 2.0 * this->Diagonal(); // margin for a beam's cross-section and a step
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
      const double from = point.part.radius, to = point.whole.radius, seen = std::max(from - margin, 0.0);
      row.partFrom = static_cast<float>(from * from);
      row.partSeen = static_cast<float>(seen * seen);
      row.wholeFrom = static_cast<float>(to * to);
      row.wholeSeen = static_cast<float>((to + margin) * (to + margin));
      beams += row.count;
      rows.push_back(row);
    }
  }
  return rows;
}

int LampOnGrid::SumsOfVacuum() const
{
  return this->Lamp.type != LightType::Rectangle                  ? 0
    : this->Periodic[0] || this->Periodic[1] || this->Periodic[2] ? 2
                                                                  : 1;
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
    info.period[a] = grid.size[a];
    info.images[a] = this->Images[a];
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
    info.images[a] = this->Images[a];
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

/// Largest scale at which sums of path integrals do not overflow. The path integral of the lamp's full power in a voxel
/// is at most the voxel's diagonal; RoundsAtMost times the diagonal is at most 2^60 units.
double LampOnGrid::UnitsPerLength() const
{
  return std::exp2(std::floor(std::log2(0x1p60 / (this->Diagonal() * RoundsAtMost))));
}

double LampOnGrid::Diagonal() const
{
  const std::array<double, 3>& h = this->TheGrid.spacing;
  return std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}

cl::Kernel LampOnGrid::Kernel(
  Device& device, const char* name, std::string_view source, const Deposit& deposit, bool inBlock) const
{
  return device.Kernel(name, source,
    Define("ATOMICS", HasAtomics(device)) + Define("LAMBERT", this->Lamp.type == LightType::Rectangle) +
      Define("CONE", this->Lamp.type == LightType::Spot) + Define("MOMENTS", deposit.firstMoments != nullptr) +
      Define("NET_FLUX", deposit.flux != nullptr) + Define("FACE_OUT", deposit.faceOut != nullptr) +
      Define("VACUUM", this->SumsOfVacuum() > 0) + Define("AROUND", this->SumsOfVacuum() > 1) +
      Define("IN_BLOCK", inBlock) + " -DTHIN=" + FloatLiteral(ThinForFirstMoments));
}
}
