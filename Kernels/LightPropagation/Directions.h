#pragma once

#include "../Lights/Lights.h"

#include <array>
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
  int cellsPerEdge = 0; ///< n
  bool equiangular = false; ///< cells of equal angle seen from the centre (else of equal size on the face)
  std::vector<Direction> directions; ///< 6 n n

  int PerFace() const { return this->cellsPerEdge * this->cellsPerEdge; }
};

/// As published (Gruson et al. 2012, section 3.1; Fattal 2009): cells of equal size on the cube's faces, all directions
/// with the same weight. Such a set does not converge to the integral over directions as n grows (1.6% error).
/// @param perFace  directions per face, a square number, else InvalidInput
DirectionSet PublishedDirections(int perFace);

/// Cells of equal angle, weighed by solid angle, the weights then corrected by the least relative change such that the set
/// integrates 1, omega, omega omega, omega_x^4 and the half-range flux |omega_x| exactly (as far as its
/// number of distinct weights allows: 1 and 4 directions per face have one weight; the first three always hold).
/// The set is unchanged by every rotation and mirroring of the cube, to the last bit.
DirectionSet SoundDirections(int perFace);

/// Which direction's cell holds `omega` (any length but 0).
int Nearest(const DirectionSet& set, const std::array<double, 3>& omega);

/// Radiance that enters along each direction from environment and sky: the mean over the direction's cell, so that a
/// uniform environment enters unchanged. W / (length^2 sr)
std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky);
}
