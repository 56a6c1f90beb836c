#include "LightPropagation/Angular/DirectionSet.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Eigenvalues>
#include <vector>

namespace tyndall
{
namespace
{
/// Tabulated orbits of a fitted quadrature. Weights are relative to the weight 4 pi / (number of directions) of a
/// uniform quadrature (numerics.md, Eq. (16a)).
struct FittedSet
{
  int perFace;
  std::vector<DirectionOrbit> orbits;
};

const std::vector<FittedSet>& FittedSets()
{
  // clang-format off
  static const std::vector<FittedSet> sets = {
  { 9,
    {
      { 0.0, 0.0, 1.432710276633, 0.00374 },
      { 0.297032884030, 0.637446040955, 0.945911215421, -0.00374 },
    } },
  { 16,
    {
      { 0.218396425934, 0.218396425934, 1.344708932060, 0.00254 },
      { 0.596508597386, 0.596508597386, 1.395466977797, 0.00300 },
      { 0.053270521082, 0.749164075077, 0.629912045071, -0.00554 },
    } },
  { 25,
    {
      { 0.0, 0.0, 1.038656103312, -0.00366 },
      { 0.168867115483, 0.318307264566, 1.003088761088, 0.00028 },
      { 0.093286362535, 0.708283733235, 0.836512814257, 0.00039 },
      { 0.492365876129, 0.732865960442, 1.155566411741, 0.00299 },
    } },
  { 36,
    {
      { 0.104217097935, 0.104217097935, 1.055573346091, -0.00224 },
      { 0.273551551561, 0.386208692080, 1.071476897203, 0.00125 },
      { 0.029066777105, 0.521165569950, 0.825981809964, 0.00259 },
      { 0.569853676999, 0.792125054823, 1.067939906274, -0.00068 },
      { 0.229539333709, 0.824737377430, 1.006814713513, -0.00093 },
    } },
  { 49,
    {
      { 0.0, 0.0, 1.012011440988, -0.00216 },
      { 0.100786002404, 0.228626940341, 0.974852289714, -0.00018 },
      { 0.137933860122, 0.434923156683, 1.009705194118, -0.00027 },
      { 0.343575187795, 0.492292707701, 1.073605790196, 0.00067 },
      { 0.044241847299, 0.750601596534, 0.881386739535, 0.00117 },
      { 0.644233450633, 0.795652566456, 0.989143177837, 0.00022 },
      { 0.318896639551, 0.811414796307, 1.069805378476, 0.00055 },
    } },
  { 64,
    {
      { 0.068480446449, 0.164557886926, 0.934144803957, -0.00079 },
      { 0.261460969784, 0.356926447553, 0.989234873776, 0.00039 },
      { 0.095889100681, 0.388115803939, 1.011367355607, -0.00026 },
      { 0.198764251906, 0.578513755134, 0.998921686323, -0.00042 },
      { 0.429423928825, 0.612650888362, 0.983172662297, -0.00080 },
      { 0.679075933893, 0.775564707220, 1.049672572073, 0.00071 },
      { 0.025188417947, 0.790143826612, 1.008702047655, 0.00208 },
      { 0.342393118090, 0.865502191340, 1.024783998313, -0.00091 },
    } },
  { 100,
    {
      { 0.029885395676, 0.152941072422, 0.999892424658, 0.00029 },
      { 0.152728431096, 0.279119758995, 0.996320526407, 0.00023 },
      { 0.051419673599, 0.349493496226, 0.998133467444, 0.00023 },
      { 0.268558911856, 0.360427764627, 1.008238691271, 0.00012 },
      { 0.203667754143, 0.519095119037, 1.000818445034, -0.00057 },
      { 0.394708746704, 0.569593539913, 1.001931733646, -0.00027 },
      { 0.0, 0.599932826437, 0.997096056864, 0.00024 },
      { 0.522216947655, 0.661235121809, 0.996330123453, 0.00056 },
      { 0.109938077096, 0.675831127521, 0.996438262176, 0.00048 },
      { 0.275711024247, 0.730667974102, 1.001685319108, -0.00036 },
      { 0.713658361464, 0.816630650912, 1.000705551474, -0.00011 },
      { 0.465099865353, 0.901302473413, 0.992690935126, -0.00044 },
      { 0.132323711527, 0.914446298698, 1.008266491771, -0.00041 },
    } },
  };
  // clang-format on
  return sets;
}

/// The 1, 4 or 8 points (s, t) of one face of the cube, -1 to 1, through which the directions of an orbit pass.
std::vector<std::array<double, 2>> TangentsOf(const DirectionOrbit& orbit)
{
  std::vector<std::array<double, 2>> all;
  for (const std::array<double, 2>& one :
    { std::array<double, 2>{ orbit.across, orbit.along }, { orbit.along, orbit.across } })
  {
    for (const double signS : { -1.0, 1.0 })
    {
      for (const double signT : { -1.0, 1.0 })
      {
        const std::array<double, 2> tangents = { one[0] == 0.0 ? 0.0 : signS * one[0],
          one[1] == 0.0 ? 0.0 : signT * one[1] };
        if (std::find(all.begin(), all.end(), tangents) == all.end())
        {
          all.push_back(tangents);
        }
      }
    }
  }
  return all;
}

DirectionSet Build(const FittedSet& fitted)
{
  DirectionSet set;
  set.cellsPerEdge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(fitted.perFace))));
  set.orbits = fitted.orbits;
  double all = 0.0;
  for (const DirectionOrbit& orbit : set.orbits)
  {
    all += orbit.weight * static_cast<double>(TangentsOf(orbit).size());
  }
  std::vector<double> weights;
  for (DirectionOrbit& orbit : set.orbits)
  {
    orbit.weight *= 4.0 * Pi / (6.0 * all);
    for (const std::array<double, 2>& tangents : TangentsOf(orbit))
    {
      set.tangents.push_back(tangents);
      weights.push_back(orbit.weight);
    }
  }
  for (int face = 0; face < 6; ++face)
  {
    for (std::size_t i = 0; i < set.tangents.size(); ++i)
    {
      set.directions.push_back({ DirectionThroughFace(face, set.tangents[i][0], set.tangents[i][1]), weights[i] });
    }
  }
  return set;
}
}

DirectionSet FittedDirections(int perFace, const std::string& name)
{
  for (const FittedSet& fitted : FittedSets())
  {
    if (fitted.perFace == perFace)
    {
      return Build(fitted);
    }
  }
  return EquiangularDirections(perFace, name);
}

DirectionSet DirectionsForVoxels(int perFace, const std::array<double, 3>& spacing)
{
  constexpr double Longer = 100.0;
  const auto [least, most] = std::minmax_element(spacing.begin(), spacing.end());
  return *most > Longer * *least ? EquiangularDirections(perFace) : FittedDirections(perFace);
}

namespace
{

/// The environment is sampled on a grid of cells on each cube face. This is the minimum number of such cells along a
/// face's edge, if the cells of the quadrature do not form a grid.
constexpr int FewestParts = 48;
/// A point on the border between the cells of two directions is replaced by two points, displaced to either side by
/// this relative distance, so that each direction gets half of its light.
constexpr double BorderTolerance = 1e-9;
/// In KeepFlux(), modes of the matrix whose eigenvalue is below this fraction of the largest eigenvalue are omitted.
constexpr double LeastMode = 1e-3;

int CellsPerEdge(int perFace, const std::string& name)
{
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(std::max(perFace, 0)))));
  if (n < 1 || n * n != perFace || n > 64)
  {
    throw InvalidInput(name + " is " + std::to_string(perFace) +
      "; directions fill a square grid on each face: choose 1, 4, 9, 16, 25, 36, ... at most 4096.");
  }
  return n;
}

/// Coordinate, -1 to 1, of a point on the edge of a cube's face that is divided into n cells. The point is
/// twicePosition / 2 cells from the edge's lower end; the face is at distance 1 from the cube's centre. Exactly odd
/// about the edge's middle.
double Tangent(bool equiangular, int n, double twicePosition)
{
  const double fromMiddle = (twicePosition - n) / n; // in [-1, 1]
  const double magnitude = std::abs(fromMiddle);
  const double tangent = magnitude == 1.0 ? 1.0 : equiangular ? std::tan(magnitude * (Pi / 4.0)) : magnitude;
  return std::copysign(tangent, fromMiddle);
}

/// Solid angle of the rectangle [0, s] x [0, t] in a plane at distance 1, sr.
double CornerSolidAngle(double s, double t)
{
  return std::atan2(s * t, std::sqrt(1.0 + s * s + t * t));
}

double SolidAngle(double s0, double s1, double t0, double t1)
{
  return CornerSolidAngle(s1, t1) - CornerSolidAngle(s0, t1) - CornerSolidAngle(s1, t0) + CornerSolidAngle(s0, t0);
}

/// Index, among a face's directions, of the direction whose cell contains the point (s, t) of the face, both from -1
/// to 1. Used for quadratures whose cells do not form a grid. By symmetry, the nearest direction of each orbit
/// (directions that are equivalent by symmetry) is in the same eighth of the face as the point.
int NearestOnFace(const DirectionSet& set, double s, double t)
{
  const bool exchanged = std::abs(s) > std::abs(t);
  const double across = std::abs(exchanged ? t : s), along = std::abs(exchanged ? s : t);
  const double length = std::sqrt(1.0 + (s * s + t * t));
  const DirectionOrbit* nearest = nullptr;
  double most = -1.0;
  for (const DirectionOrbit& orbit : set.orbits)
  {
    const double ofOrbit = std::sqrt(1.0 + (orbit.across * orbit.across + orbit.along * orbit.along));
    const double reached = (1.0 + across * orbit.across + along * orbit.along) / (length * ofOrbit) + orbit.reach;
    if (reached > most)
    {
      most = reached;
      nearest = &orbit;
    }
  }
  const std::array<double, 2> there = { std::copysign(exchanged ? nearest->along : nearest->across, s),
    std::copysign(exchanged ? nearest->across : nearest->along, t) };
  return static_cast<int>(std::find(set.tangents.begin(), set.tangents.end(), there) - set.tangents.begin());
}

using Faces = Eigen::Matrix<double, 6, 1>;

/// Cosines of a direction with the outward normals of the cube's six faces; 0 where negative.
Faces Cosines(const std::array<double, 3>& omega)
{
  Faces cosines = Faces::Zero();
  for (int axis = 0; axis < 3; ++axis)
  {
    cosines[2 * axis + (omega[axis] > 0.0 ? 1 : 0)] = std::abs(omega[axis]);
  }
  return cosines;
}

/// Integrals of an environment's radiance over the cells of a quadrature.
struct Seen
{
  std::vector<Rgb> sum;           ///< integral of radiance over each direction's cell, W / length^2
  std::vector<double> solidAngle; ///< solid angle of each direction's cell, sr
  /// Flux density through the cube's faces in the direction of travel, W / length^2.
  std::array<Rgb, 6> flux = {};
  /// flux density through the cube's faces in a uniform environment of radiance 1, sr
  std::array<double, 6> cosines = {};

  explicit Seen(const DirectionSet& set)
    : sum(set.directions.size(), Rgb{})
    , solidAngle(set.directions.size(), 0.0)
  {
  }

  /// @param omega  direction of travel of the light
  void Add(int direction, const std::array<double, 3>& omega, double weight, const Rgb& radiance)
  {
    this->solidAngle[direction] += weight;
    for (int c = 0; c < 3; ++c)
    {
      this->sum[direction][c] += weight * radiance[c];
    }
    const Faces through = weight * Cosines(omega);
    for (int face = 0; face < 6; ++face)
    {
      this->cosines[face] += through[face];
      for (int c = 0; c < 3; ++c)
      {
        this->flux[face][c] += through[face] * radiance[c];
      }
    }
  }
};

/// Integrates an environment over the cells of a quadrature. The environment is sampled at the centres of sample cells
/// about half a pixel wide; a pixel spans the angle pi / height, a cell of the quadrature about pi / (2 n). The number
/// of sample cells along an edge is even, so that no centre is at a pole, where the azimuth is undefined.
Seen LookAround(const DirectionSet& set, const Environment& environment)
{
  const int n = set.cellsPerEdge;
  const bool grid = set.orbits.empty();
  // More sample cells are used if the quadrature's cells do not form a grid, since their borders then cut through
  // sample cells.
  const int fewest = grid ? 2 : 2 * ((FewestParts + n) / (2 * n));
  const int parts = std::max(2 * std::clamp((environment.height / n + 1) / 2, 1, 128), fewest);
  const bool equiangular = set.equiangular || !grid;
  const auto tangent = [&](double part) { return Tangent(equiangular, n * parts, 2.0 * part); };
  Seen seen(set);
  for (int face = 0; face < 6; ++face)
  {
    for (int b = 0; b < n * parts; ++b)
    {
      for (int a = 0; a < n * parts; ++a)
      {
        const double weight = SolidAngle(tangent(a), tangent(a + 1), tangent(b), tangent(b + 1));
        const double s = tangent(a + 0.5), t = tangent(b + 0.5);
        const std::array<double, 3> omega = DirectionThroughFace(face, s, t);
        const Rgb radiance = Lookup(environment, { -omega[0], -omega[1], -omega[2] });
        const int first = face * n * n;
        if (grid)
        {
          seen.Add(first + b / parts * n + a / parts, omega, weight, radiance);
        }
        else if (a == b || a + b == n * parts - 1) // on a border between eighths of the face: half to each side's cell
        {
          seen.Add(first + NearestOnFace(set, s * (1.0 + BorderTolerance), t), omega, 0.5 * weight, radiance);
          seen.Add(first + NearestOnFace(set, s, t * (1.0 + BorderTolerance)), omega, 0.5 * weight, radiance);
        }
        else
        {
          seen.Add(first + NearestOnFace(set, s, t), omega, weight, radiance);
        }
      }
    }
  }
  return seen;
}

/// Scales the radiance of each direction so that the flux through each face of the cube equals that of the environment,
/// up to the quadrature's half-range error. The factor of a direction is 1 + sum over faces of (coefficient of the
/// face) (cosine to its normal), limited to [0.5, 2]. The coefficients are chosen such that the factors are nearest to
/// 1 (numerics.md, Eq. (31a)).
void KeepFlux(const DirectionSet& set, const Seen& seen, std::vector<Rgb>& radiance)
{
  for (int c = 0; c < 3; ++c)
  {
    Faces missing = Faces::Zero();
    Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
    for (std::size_t d = 0; d < radiance.size(); ++d)
    {
      const Faces cosines = Cosines(set.directions[d].omega);
      for (int face = 0; face < 6; ++face)
      {
        const double mean = seen.flux[face][c] / seen.cosines[face];
        missing[face] += set.directions[d].weight * cosines[face] * (mean - radiance[d][c]);
      }
      products += set.directions[d].weight * radiance[d][c] * cosines * cosines.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> modes(products);
    Faces factors = Faces::Zero();
    for (int mode = 0; mode < 6; ++mode)
    {
      const double value = modes.eigenvalues()[mode];
      if (value > LeastMode * modes.eigenvalues()[5])
      {
        factors += modes.eigenvectors().col(mode) * (modes.eigenvectors().col(mode).dot(missing) / value);
      }
    }
    for (std::size_t d = 0; d < radiance.size(); ++d)
    {
      radiance[d][c] *= std::clamp(1.0 + factors.dot(Cosines(set.directions[d].omega)), 0.5, 2.0);
    }
  }
}

DirectionSet CubeDirections(int perFace, bool equiangular, const std::string& name)
{
  DirectionSet set;
  const int n = set.cellsPerEdge = CellsPerEdge(perFace, name);
  set.equiangular = equiangular;
  for (int face = 0; face < 6; ++face)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        set.directions.push_back(
          { DirectionThroughFace(face, Tangent(equiangular, n, 2 * i + 1), Tangent(equiangular, n, 2 * j + 1)),
            4.0 * Pi / (6.0 * n * n) });
      }
    }
  }
  return set;
}
}

std::array<double, 3> DirectionThroughFace(int face, double s, double t)
{
  const int axis = face / 2;
  const double scale = 1.0 / std::sqrt(1.0 + (s * s + t * t));
  std::array<double, 3> omega;
  omega[axis] = (face % 2 == 0 ? -1.0 : 1.0) * scale;
  omega[(axis + 1) % 3] = s * scale;
  omega[(axis + 2) % 3] = t * scale;
  return omega;
}

DirectionSet PublishedDirections(int perFace)
{
  return CubeDirections(perFace, false, "DirectionsPerFace");
}

DirectionSet EquiangularDirections(int perFace, const std::string& name)
{
  DirectionSet set = CubeDirections(perFace, true, name);
  const int n = set.cellsPerEdge;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    // Each weight is computed for the cell's mirror image in the first eighth of the face, so that the weights of cells
    // that are equivalent by symmetry agree to the last bit.
    const int i = static_cast<int>(d) % n;
    const int j = static_cast<int>(d) / n % n;
    const int u = std::min(std::max(i, n - 1 - i), std::max(j, n - 1 - j));
    const int v = std::max(std::max(i, n - 1 - i), std::max(j, n - 1 - j));
    set.directions[d].weight = SolidAngle(
      Tangent(true, n, 2 * u), Tangent(true, n, 2 * u + 2), Tangent(true, n, 2 * v), Tangent(true, n, 2 * v + 2));
  }
  return set;
}

double HalfRangeFlux(const DirectionSet& set)
{
  double flux = 0.0;
  for (const Direction& direction : set.directions)
  {
    flux += direction.weight * std::max(direction.omega[2], 0.0) / Pi;
  }
  return flux;
}

int Nearest(const DirectionSet& set, const std::array<double, 3>& omega)
{
  int axis = 0;
  for (int other = 1; other < 3; ++other)
  {
    axis = std::abs(omega[other]) > std::abs(omega[axis]) ? other : axis;
  }
  const int n = set.cellsPerEdge;
  const auto cell = [&](double tangent) {
    const double position = set.equiangular ? std::atan(tangent) * (4.0 / Pi) : tangent;
    return std::clamp(static_cast<int>((position + 1.0) * 0.5 * n), 0, n - 1);
  };
  const double depth = std::abs(omega[axis]);
  const int face = 2 * axis + (omega[axis] > 0.0 ? 1 : 0);
  if (!set.orbits.empty())
  {
    return face * set.PerFace() + NearestOnFace(set, omega[(axis + 1) % 3] / depth, omega[(axis + 2) % 3] / depth);
  }
  return (face * n + cell(omega[(axis + 2) % 3] / depth)) * n + cell(omega[(axis + 1) % 3] / depth);
}

std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky)
{
  std::vector<Rgb> radiance(set.directions.size(), Rgb{});
  if (!environment.Empty())
  {
    const Seen seen = LookAround(set, environment);
    for (std::size_t d = 0; d < radiance.size(); ++d)
    {
      for (int c = 0; c < 3; ++c)
      {
        radiance[d][c] = seen.sum[d][c] / seen.solidAngle[d];
      }
    }
    if (set.equiangular || !set.orbits.empty())
    {
      KeepFlux(set, seen, radiance);
    }
  }
  for (Rgb& one : radiance)
  {
    for (int c = 0; c < 3; ++c)
    {
      one[c] += sky[c];
    }
  }
  return radiance;
}
}
