#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// How the light that a voxel sends out is spread over it.
enum class PropagationSource
{
  Automatic, ///< linear where orders are accelerated, by octant where many voxels are thick, else constant
  Constant,  ///< as published
  Linear,    ///< from voxel centre to voxel centre (numerics.md, section 7): right however thick voxels are
  /// Linear where orders are accelerated; where they are added up one by one thick voxels shine back more through faces
  /// that light came in through (section 6.5): right however much they absorb, at two to three times the time of an
  /// order.
  Octants
};

/// How scattering orders are added up.
enum class PropagationAcceleration
{
  Automatic, ///< one after the other where a few tens do, else by a diffusion system between sweeps
  None       ///< one after the other, as published
};

/// Settings of the light propagation solvers; the names are those of the filter's properties.
struct PropagationSettings
{
  int directionsPerFace = 25;  ///< directions per cube face, a square number: 1, 4, 9, 16, 25, ...
  bool adaptDirections = true; ///< more of them for slabs (UnvaryingAxes.h); false: directionsPerFace
  /// Cosines of half of all directions that layers are solved with (PlaneParallel/IsPlaneParallel.h); 0: 16,
  /// or 20 where light is not scattered evenly.
  int polarNodes = 0;
  /// Directions per cube face, a square number, of the unscattered light of shining faces, sky and environment
  /// (UncollidedBoundary.h); 0: the same as for scattered light; -1: as many as cost about a quarter more at most,
  /// where they gain (UncollidedDirections.h).
  int uncollidedDirections = -1;
  /// Rays of each direction start in a place of their own within a voxel (RayBundles.h); those of more than 100
  /// uncollidedDirections always, unless the solve is accelerated. From 144 directions a face on up to half the error,
  /// with fewer up to twice.
  bool staggeredRays = false;
  int mapResolution = 1;   ///< map points per voxel edge, 1 to 16
  int maximumOrders = 0;   ///< scattering orders (accelerated: sweeps) at most; 0: until the tolerance is met
  double tolerance = 1e-4; ///< relative error of fluence at which to stop, > 0
  std::array<bool, 3> periodic = { false, false, false }; ///< rays leaving an axis return on the other side
  /// Degree of the angular moments in which light is scattered; -1: as many as the phase function asks for, the
  /// tolerance, the directions and the device's memory (AngularDegree.h); 0: scattering is isotropic with
  /// sigma_s (1 - g), the similarity relation
  int angularDegree = -1;
  /// Keep the moments of what is scattered, where light is scattered in moments: pictures are made of them
  /// (LightField::scatteredMoments).
  bool storeMoments = true;
  int storedDirections = 1; ///< directions kept for scattered radiance: 1 (isotropic), 6 (faces), or more
  PropagationSource source = PropagationSource::Automatic;
  PropagationAcceleration acceleration = PropagationAcceleration::Automatic; ///< not where maximumOrders is given
  bool netFlux = false;                                                      ///< compute net_flux too: it costs
  /// Keep where in voxels lamps' light is first lost (LightField::firstMoments); not where orders are accelerated.
  bool firstMoments = false;
  bool facePower = false; ///< keep the power that leaves through each cell of the box's faces
  /// Relative error, voxel by voxel, of the unscattered light of small bright parts of the medium, which is followed
  /// along exact rays (EmissionRays.h), about: a twentieth of the voxels may be off by more; 0.005 costs five to ten
  /// times as much, and less than that gains nothing; 0: not followed
  double emissionError = 0.02;
  /// Bytes of the device's memory that may be taken; 0: nine tenths of what it has. Where the arrays over all voxels do
  /// not fit they lie in host memory, and are streamed: the same light, bit for bit.
  std::size_t memoryBudget = 0;
  bool leaveOut = true; ///< what the scene does not need; false: all is computed, to see what leaving out saves
};

/// @throws InvalidInput where a number is out of its range (numbers of directions are looked at by the direction sets)
void Check(const PropagationSettings& settings);
}
