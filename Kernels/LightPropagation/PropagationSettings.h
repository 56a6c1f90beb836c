#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// Distribution of the emission and scattering source within a voxel.
enum class PropagationSource
{
  Automatic, ///< Linear with acceleration; without it Octants if many voxels are optically thick, else Constant
  Constant,  ///< constant within a voxel, as published
  Linear,    ///< linear between voxel centres (numerics.md, section 7): accurate at any optical thickness
  /// Linear with acceleration; with plain source iteration, an additional source in each octant of directions:
  /// optically thick voxels emit more through the faces through which light entered (numerics.md, section 6.5).
  /// Accurate for any absorption, at two to three times the time per order.
  Octants
};

/// Iteration scheme for the sum over scattering orders.
enum class PropagationAcceleration
{
  Automatic, ///< source iteration if a few tens of orders suffice, else DSA
  None       ///< source iteration, as published
};

constexpr int HighestAngularDegree = 15; ///< largest PropagationSettings::angularDegree

/// Settings of the light propagation solvers; the names are those of the filter's properties.
struct PropagationSettings
{
  int directionsPerFace = 25; ///< directions per cube face, a square number: 1, 4, 9, 16, 25, ...
  /// Whether to use more directions for slabs (GridAxes.h); false: exactly directionsPerFace.
  bool adaptDirections = true;
  /// Number of polar cosines per hemisphere for plane-parallel media (PlaneParallelPropagation.h); 0: 16, or 20 if
  /// scattering is anisotropic.
  int polarNodes = 0;
  /// Directions per cube face, a square number, for uncollided light of boundary sources, sky and environment
  /// (BoundaryLight.h); 0: as many as for scattered light; -1: as many as increase the predicted time of the solve by
  /// at most half, if they reduce the error (LightSources.h).
  int uncollidedDirections = -1;
  /// Whether light is swept along rays; false: scattered light and light of the sky are swept by discrete ordinates
  /// (OrdinatesTransport.h), but light of faces along rays, because ordinates would smear its edges.
  bool alongRays = true;
  /// Whether rays of each direction start at a different position within a voxel (RayBundles.h). With more than 100
  /// uncollidedDirections, rays of uncollided light always do, unless the solve is accelerated. With at least 144
  /// directions per face this reduces the error by up to half; with fewer it can double the error.
  bool staggeredRays = false;
  int mapResolution = 1;   ///< number of rays per voxel edge and direction, 1 to 16
  int maximumOrders = 0;   ///< limit on scattering orders (DSA: sweeps); 0: iterate to the tolerance
  double tolerance = 1e-4; ///< relative error of fluence at which iterations stop, > 0
  std::array<bool, 3> periodic = { false, false, false }; ///< periodic axes: rays wrap around
  /// Degree of the angular moments in which scattering is represented; -1: chosen from the phase function, tolerance,
  /// number of directions and device memory (AngularDegree.h); 0: isotropic scattering with sigma_s (1 - g), the
  /// similarity relation
  int angularDegree = -1;
  /// Whether to store the angular moments of scattered light (LightField::scatteredMoments), from which pictures are
  /// rendered. No effect at degree 0.
  bool storeMoments = true;
  /// Number of directions in which scattered radiance is stored: 1 (mean), 6 (faces), or more.
  int storedDirections = 1;
  PropagationSource source = PropagationSource::Automatic;
  PropagationAcceleration acceleration = PropagationAcceleration::Automatic; ///< ignored if maximumOrders is set
  bool netFlux = false; ///< whether to compute net_flux, which takes more time
  /// Whether to store the first moments of the first collisions of lamp light within voxels (LightField::firstMoments).
  /// Ignored with acceleration.
  bool firstMoments = false;
  bool facePower = false; ///< whether to store the power that leaves through each cell of the box's faces
  /// Approximate relative error by voxel of uncollided light from localised emission, which is traced along exact rays
  /// (EmissionRays.h). About one voxel in twenty may exceed it. 0.005 takes five to ten times as long as the default,
  /// and smaller values gain nothing; 0: localised emission is not traced separately
  double emissionError = 0.02;
  /// Bytes of device memory that the solve may use; 0: nine tenths of the available memory. If the arrays over voxels
  /// do not fit, they stay in host memory and are streamed, with bit-identical results.
  std::size_t memoryBudget = 0;
  /// Whether to omit computations that the scene does not need; false: compute all, to measure the saving.
  bool leaveOut = true;

  /// Whether any axis is periodic.
  bool IsPeriodic() const { return this->periodic[0] || this->periodic[1] || this->periodic[2]; }
};

/// Checks that numbers are in their ranges (numbers of directions are checked by the direction sets).
/// @throws InvalidInput if one is not
void Check(const PropagationSettings& settings);
/// @throws InvalidInput if maximumOrders is negative or tolerance is not positive
void CheckOrders(int maximumOrders, double tolerance);
}
