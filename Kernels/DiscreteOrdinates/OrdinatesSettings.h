#pragma once

#include "LightPropagation/PropagationSettings.h"

#include <array>

namespace tyndall
{
/// The spatial scheme.
enum class OrdinatesScheme
{
  Published = 0,   ///< one explicit step along each direction in an iteration (Gong et al., Eqs. (7) and (9))
  Conservative = 1 ///< a sweep along each direction by exponentials, which keeps the power (numerics.md, Eq. (D10))
};

/// How radiance is scattered between directions.
enum class OrdinatesScattering
{
  Matrix = 0,            ///< every pair of directions: D x D multiplications a voxel
  SingularValues = 1,    ///< N + N for each direction, as published
  SphericalHarmonics = 2 ///< the same by degrees: exact moments, made without a factorisation
};

/// Settings of SolveDiscreteOrdinates; the names are those of the filter's properties.
struct OrdinatesSettings
{
  OrdinatesScheme scheme = OrdinatesScheme::Conservative;
  OrdinatesScattering scattering = OrdinatesScattering::SphericalHarmonics;
  int directionsPerFace = 25; ///< directions per cube face, a square number; more of them for slabs
  int spiralDirections = 0;   ///< any number from 16 on, on a spiral instead; 0: those of the cube
  int terms = 25;             ///< of the phase function; at most as many as there are directions
  int maximumOrders = 0;      ///< scattering orders (as published: steps) at most; 0: until the tolerance is met
  double tolerance = 1e-4;    ///< relative error of fluence at which to stop, > 0
  int seriesAfter = 0;        ///< orders after so many (conservative) go on as the last one fell; 0: all are swept
  std::array<bool, 3> periodic = { false, false, false }; ///< light leaving an axis returns on the other side
  bool netFlux = false;                                   ///< compute net_flux too
  bool leaveOut = true;                                   ///< what the scene does not need
};

/// @throws InvalidInput where a number is out of its range (numbers of directions are looked at by the direction sets)
void Check(const OrdinatesSettings& settings);

bool IsPublished(const OrdinatesSettings& settings);

/// The settings of light propagation maps for the same scene: units, channels and axes are found alike.
PropagationSettings AsPropagation(const OrdinatesSettings& settings);
}
