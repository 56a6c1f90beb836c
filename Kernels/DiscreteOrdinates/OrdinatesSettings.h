#pragma once

#include "LightPropagation/PropagationSettings.h"

#include <array>

namespace tyndall
{
/// Spatial discretisation.
enum class OrdinatesScheme
{
  Published = 0,   ///< one explicit step along each direction per iteration (Gong et al., Eqs. (7) and (9))
  Conservative = 1 ///< exponential, energy-conserving sweep along each direction (numerics.md, Eq. (D10))
};

/// How radiance is scattered between directions.
enum class OrdinatesScattering
{
  Matrix = 0,            ///< every pair of directions: D x D multiplications per voxel
  SingularValues = 1,    ///< N + N multiplications per direction, as published
  SphericalHarmonics = 2 ///< same cost, by degrees: exact moments, no factorisation needed
};

/// Settings of SolveDiscreteOrdinates; the names are those of the filter's properties.
struct OrdinatesSettings
{
  OrdinatesScheme scheme = OrdinatesScheme::Conservative;
  OrdinatesScattering scattering = OrdinatesScattering::SphericalHarmonics;
  int directionsPerFace = 25; ///< directions per cube face, a square number; more are used for slabs
  int spiralDirections = 0;   ///< directions on a spiral instead, at least 16; 0: those of the cube
  int terms = 25;             ///< of the phase function; at most as many as there are directions
  int maximumOrders = 0;      ///< limit on scattering orders (published: steps); 0: iterate to the tolerance
  double tolerance = 1e-4;    ///< relative error of fluence at which iterations stop, > 0
  int seriesAfter = 0;        ///< sweep so many orders, extrapolate the rest geometrically (conservative); 0: off
  std::array<bool, 3> periodic = { false, false, false }; ///< light wraps around these axes
  bool netFlux = false;                                   ///< also compute net_flux
  bool leaveOut = true;                                   ///< skip work the scene does not need
};

/// @throws InvalidInput if a number is out of range (numbers of directions are checked by the direction sets)
void Check(const OrdinatesSettings& settings);

bool IsPublished(const OrdinatesSettings& settings);

/// Equivalent settings of light propagation maps, to determine units, channels and axes in the same way.
PropagationSettings AsPropagation(const OrdinatesSettings& settings);
}
