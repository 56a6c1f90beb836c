#pragma once

#include "Lights/Lights.h"
#include "Numerics/Direction.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Orbit of a direction, i.e. all its images under the rotations and reflections of the cube. Seen from the cube's
/// centre, these directions pass through the points (+-across, +-along) and (+-along, +-across) of each face, whose
/// edges are at -1 and 1.
struct DirectionOrbit
{
  /// Coordinates, on a face of the cube, of one of the points through which directions of the orbit pass: 0 <= across
  /// <= along < 1.
  double across = 0.0, along = 0.0;
  double weight = 0.0; ///< weight of each direction of the orbit, sr
  /// Offset that Nearest() adds to the cosine of the angle to a direction of this orbit, so that the solid angle of
  /// each cell equals the weight of its direction.
  double reach = 0.0;
};

/// Quadrature with directions through the n x n cells of each of a cube's six faces. Directions are ordered by the face
/// through which they point, -x, +x, -y, +y, -z, +z, and within a face by cell, row by row.
struct DirectionSet
{
  int cellsPerEdge = 0; ///< number n of cells along the edge of a cube's face
  /// Whether cells subtend equal angles at the cube's centre; false: cells have equal size on the face.
  bool equiangular = false;
  std::vector<Direction> directions; ///< 6 n n directions with weights in sr
  /// Orbits (sets of directions that are equivalent by symmetry), in FittedDirections only; otherwise empty. With
  /// orbits, cells do not form a grid: the cell of a direction of the quadrature consists of all directions nearest to
  /// it (see Nearest).
  std::vector<DirectionOrbit> orbits = {};
  /// Points (s, t) of a face of the cube, -1 to 1, through which the directions of that face pass; empty without
  /// orbits.
  std::vector<std::array<double, 2>> tangents = {};

  int PerFace() const { return this->cellsPerEdge * this->cellsPerEdge; }
};

/// The published quadrature (Gruson et al. 2012, section 3.1; Fattal 2009): cells of equal size on the cube's faces,
/// all directions with the same weight. Its sums do not converge to integrals as n grows: the half-range flux is 1.6%
/// too large with 25 directions per face, and 3.1% too large in the limit (numerics.md, section 3).
/// @param perFace  directions per face
/// @throws InvalidInput if `perFace` is no square number, or above 4096
DirectionSet PublishedDirections(int perFace);

/// Quadrature with cells of equal angle, weighted by solid angle (numerics.md, Eqs. (15), (16)). It integrates 1, omega
/// and omega omega exactly; half-range integrals have an error, see HalfRangeFlux. It is invariant under every rotation
/// and reflection of the cube, to the last bit.
/// @param perFace  directions per face
/// @param name  name of the parameter in the error's text
/// @throws InvalidInput if `perFace` is no square number, or above 4096
DirectionSet EquiangularDirections(int perFace, const std::string& name = "DirectionsPerFace");

/// Quadrature of the conservative scheme: nodes and weights are fitted so that the transmission of diffuse light
/// through slabs of optical thickness 0.1 to 5 and the half-range flux are accurate to 0.04% with 25 directions per
/// face (numerics.md, Eq. (16a)), to 0.7% with 9. It integrates 1, omega and omega omega exactly and has the symmetry
/// of EquiangularDirections, to the last bit. With 16, 36 and 64 directions per face, no direction has a cosine of 0 to
/// an axis. Fitted sets exist for 9, 16, 25, 36, 49, 64 and 100 directions per face; for other numbers the result is
/// that of EquiangularDirections.
/// @param perFace  directions per face
/// @param name  name of the parameter in the error's text
/// @throws InvalidInput if `perFace` is no square number, or above 4096
DirectionSet FittedDirections(int perFace, const std::string& name = "DirectionsPerFace");

/// FittedDirections(), or EquiangularDirections() for voxels over a hundred times longer along one axis than along
/// another. In non-absorbing media of such voxels (spacing 1, 1, 1000), solves do not converge with either quadrature.
/// With fitted directions they can end with errors of 50% and a small error estimate; with equiangular directions they
/// report that they did not converge.
DirectionSet DirectionsForVoxels(int perFace, const std::array<double, 3>& spacing);

/// Half-range flux of isotropic light through a face of the cube, summed over the quadrature, relative to the exact
/// value pi (numerics.md, Eq. (17)): 0.9875 (equiangular) or 0.99992 (fitted) with 25 directions per face. The power of
/// incident diffuse light is wrong by this factor.
double HalfRangeFlux(const DirectionSet& set);

/// Unit vector from the cube's centre through a point of face `face`.
/// @param s, t  coordinates of the point, -1 to 1, along the two axes that follow the axis of the face's normal
///   cyclically
std::array<double, 3> DirectionThroughFace(int face, double s, double t);

/// Index of the direction of `set` whose cell contains `omega` (of any length except 0).
int Nearest(const DirectionSet& set, const std::array<double, 3>& omega);

/// Incident radiance of environment and sky in each direction of `set`, W / (length^2 sr). It is the mean over the
/// direction's cell, so that a uniform environment remains uniform.
std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky);
}
