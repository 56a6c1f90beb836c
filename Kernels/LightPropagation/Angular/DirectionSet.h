#pragma once

#include "Lights/Lights.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// A direction of propagation and the solid angle it stands for.
struct Direction
{
  std::array<double, 3> omega = { 0.0, 0.0, 1.0 }; ///< unit vector, the way the light travels
  double weight = 0.0;                             ///< sr; all weights of a set add up to 4 pi
};

/// Directions through the n x n cells of the six faces of a cube, face by face in the order -x, +x, -y, +y, -z, +z (the
/// face the direction points through), cells row by row.
struct DirectionSet
{
  int cellsPerEdge = 0;              ///< n
  bool equiangular = false;          ///< cells of equal angle seen from the centre (else of equal size on the face)
  std::vector<Direction> directions; ///< 6 n n

  int PerFace() const { return this->cellsPerEdge * this->cellsPerEdge; }
};

/// As published (Gruson et al. 2012, section 3.1; Fattal 2009): cells of equal size on the cube's faces, all directions
/// with the same weight. Such a set does not converge to the integral over directions as n grows (1.6% error).
/// @param perFace  directions per face, a square number, else InvalidInput
DirectionSet PublishedDirections(int perFace);

/// Cells of equal angle, weighed by solid angle. By its symmetry the set integrates 1, omega and omega omega exactly.
/// The half-range flux of a diffuse face, int |omega_x| = 2 pi, is off by 1.2% with 25 directions per face and by 0.2%
/// with 100; weights corrected to make it (and omega_x^4) exact were tried and lose more than they gain: the
/// transmission of diffuse light through slabs, 2 E3(tau), had five to ten times the error.
/// The set is unchanged by every rotation and mirroring of the cube, to the last bit.
/// @param perFace  directions per face, a square number, else InvalidInput that calls it `name`
DirectionSet EquiangularDirections(int perFace, const std::string& name = "DirectionsPerFace");

/// What a set carries of the flux of even light through a face, over the exact pi: the kink of |mu| at grazing
/// directions makes it
/// 0.9875 with 25 directions per face, 1.0019 with 100. Light that enters is off by as much.
double HalfRangeFlux(const DirectionSet& set);

/// Which direction's cell holds `omega` (any length but 0).
int Nearest(const DirectionSet& set, const std::array<double, 3>& omega);

/// Radiance that enters along each direction from environment and sky: the mean over the direction's cell, so that a
/// uniform environment enters unchanged. W / (length^2 sr)
std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky);
}
