#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// How emitted and scattered light is distributed within a voxel.
enum class PropagationSource
{
  Automatic, ///< linear with acceleration, by octant if many voxels are optically thick, else constant
  Constant,  ///< as published
  Linear,    ///< between voxel centres (numerics.md, section 7): accurate at any optical thickness
  /// Linear with acceleration. With plain source iteration, optically thick voxels emit more through the faces that
  /// light entered through (numerics.md, section 6.5): accurate for any absorption, at two to three times the time of
  /// an order.
  Octants
};

/// How the sum over scattering orders is computed.
enum class PropagationAcceleration
{
  Automatic, ///< source iteration if a few tens of orders suffice, else DSA
  None       ///< source iteration, as published
};

/// Settings of the light propagation solvers; the names are those of the filter's properties.
struct PropagationSettings
{
  int directionsPerFace = 25;  ///< directions per cube face, a square number: 1, 4, 9, 16, 25, ...
  bool adaptDirections = true; ///< use more for slabs (GridAxes.h); false: exactly directionsPerFace
  /// Number of polar cosines per hemisphere for plane-parallel media (PlaneParallelPropagation.h); 0: 16, or 20 if
  /// scattering is anisotropic.
  int polarNodes = 0;
  /// Directions per cube face, a square number, for uncollided light of boundary sources, sky and environment
  /// (BoundaryLight.h); 0: the same as for scattered light; -1: chosen so that the solve takes about a quarter
  /// longer at most, where this reduces the error (LightSources.h).
  int uncollidedDirections = -1;
  /// Offset the rays of each direction differently within a voxel (RayBundles.h). With more than 100
  /// uncollidedDirections uncollided light always does so, unless the solve is accelerated. From 144 directions a face
  /// on this reduces the error by up to half; with fewer it can double it.
  bool staggeredRays = false;
  int mapResolution = 1;   ///< map points per voxel edge, 1 to 16
  int maximumOrders = 0;   ///< limit on scattering orders (DSA: sweeps); 0: iterate to the tolerance
  double tolerance = 1e-4; ///< relative error of fluence at which iterations stop, > 0
  std::array<bool, 3> periodic = { false, false, false }; ///< rays wrap around these axes
  /// Degree of the angular moments in which scattering is represented; -1: chosen from the phase function, tolerance,
  /// number of directions and device memory (AngularDegree.h); 0: isotropic scattering with sigma_s (1 - g), the
  /// similarity relation
  int angularDegree = -1;
  /// Keep the angular moments of scattered light (LightField::scatteredMoments), from which pictures are rendered. No
  /// effect at degree 0.
  bool storeMoments = true;
  int storedDirections = 1; ///< directions in which scattered radiance is stored: 1 (isotropic), 6 (faces), or more
  PropagationSource source = PropagationSource::Automatic;
  PropagationAcceleration acceleration = PropagationAcceleration::Automatic; ///< ignored if maximumOrders is set
  bool netFlux = false; ///< also compute net_flux, which takes more time
  /// Keep the first moments of the first collisions of lamp light within voxels (LightField::firstMoments). Ignored
  /// with acceleration.
  bool firstMoments = false;
  bool facePower = false; ///< keep the power that leaves through each cell of the box faces
  /// Approximate relative error by voxel of uncollided light from localised emission, which is traced along exact rays
  /// (EmissionRays.h). About one voxel in twenty may exceed it. 0.005 takes five to ten times as long as the default,
  /// and smaller values gain nothing; 0: localised emission is not traced separately
  double emissionError = 0.02;
  /// Bytes of device memory that the solve may use; 0: nine tenths of the available memory. If the arrays over voxels
  /// do not fit, they stay in host memory and are streamed, with bit-identical results.
  std::size_t memoryBudget = 0;
  bool leaveOut = true; ///< skip work the scene does not need; false: compute all, to measure the saving

  bool IsPeriodic() const { return this->periodic[0] || this->periodic[1] || this->periodic[2]; } ///< along any axis
};

/// @throws InvalidInput if a number is out of range (numbers of directions are checked by the direction sets)
void Check(const PropagationSettings& settings);
}
