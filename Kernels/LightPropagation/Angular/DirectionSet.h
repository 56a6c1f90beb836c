#pragma once

#include "Lights/Lights.h"
#include "Numerics/Direction.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Directions through a cube's faces that turns and mirrorings of the cube make of one: tangents (+-across, +-along)
/// and (+-along, +-across).
struct DirectionOrbit
{
  double across = 0.0, along = 0.0; ///< 0 <= across <= along < 1
  double weight = 0.0;              ///< of each, sr
  double reach = 0.0;               ///< cosine that its cells have on others, so that they are as large as weights
};

/// Directions through the n x n cells of the six faces of a cube, face by face in the order -x, +x, -y, +y, -z, +z (the
/// face the direction points through), cells row by row.
struct DirectionSet
{
  int cellsPerEdge = 0;              ///< n
  bool equiangular = false;          ///< cells of equal angle seen from the centre (else of equal size on the face)
  std::vector<Direction> directions; ///< 6 n n
  /// Of FittedDirections; else empty. There cells are no grid: what is nearest a direction is its cell's (Nearest).
  std::vector<DirectionOrbit> orbits = {};
  std::vector<std::array<double, 2>> tangents = {}; ///< of a face's directions, where there are orbits

  int PerFace() const { return this->cellsPerEdge * this->cellsPerEdge; }
};

/// As published (Gruson et al. 2012, section 3.1; Fattal 2009): cells of equal size on the cube's faces, all directions
/// with the same weight. Sums over it do not tend to integrals as n grows: the half-range flux is 1.6% too large with
/// 25 directions a face and tends to 3.1% (numerics.md, section 3).
/// @param perFace  directions per face, a square number, else InvalidInput
DirectionSet PublishedDirections(int perFace);

/// Cells of equal angle, weighted by solid angle (numerics.md, Eqs. (15), (16)). The set integrates 1,
/// omega and omega omega exactly; half-range integrals are off, see HalfRangeFlux. It is unchanged by every rotation
/// and mirroring of the cube, to the last bit.
/// @param perFace  directions per face, a square number, else InvalidInput that calls it `name`
DirectionSet EquiangularDirections(int perFace, const std::string& name = "DirectionsPerFace");

/// The directions of the conservative scheme: nodes and weights for which the transmission of diffuse light through
/// slabs of optical thickness 0.1 to 5 and the half-range flux are right, to 0.04% with 25 (numerics.md, Eq. (16a)).
/// They integrate 1, omega and omega omega exactly and have the symmetry of EquiangularDirections, to the last bit.
/// With 9 they are right to 0.7%. 16, 36 and 64 have no cosine of 0. All other numbers but 49 and 100 are those of
/// EquiangularDirections.
/// @param perFace  directions per face, a square number, else InvalidInput that calls it `name`
DirectionSet FittedDirections(int perFace, const std::string& name = "DirectionsPerFace");

/// Fitted directions, but even ones for voxels over a hundred times longer along one axis than along another: in white
/// ones (spacing 1, 1, 1000) sweeps along fitted ones were seen to end half off with a small estimated error; along
/// even ones they do not converge either, but say so.
DirectionSet DirectionsForVoxels(int perFace, const std::array<double, 3>& spacing);

/// The flux of even light through a face as a set has it, over the exact pi (numerics.md, Eq. (17)): with 25 directions
/// 0.9875 (equal angles) or 0.99992 (fitted). The power of diffuse light that enters is off by this factor.
double HalfRangeFlux(const DirectionSet& set);

/// The direction through a face of the cube. @param s, t  tangents along the next axis, and the one after it
std::array<double, 3> DirectionThroughFace(int face, double s, double t);

/// Which direction's cell holds `omega` (any length but 0).
int Nearest(const DirectionSet& set, const std::array<double, 3>& omega);

/// Radiance that enters along each direction from environment and sky: the mean over the direction's cell, so that a
/// uniform environment enters unchanged. W / (length^2 sr)
std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky);
}
