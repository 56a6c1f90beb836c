#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

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

/// Settings for a quality level: directions, tolerance and, if scattering is anisotropic, terms of the phase function.
/// Only settings that have their default values are changed. The number of directions is limited so that one channel of
/// their radiance on the whole grid takes at most half of the smallest memory of all ranks. Collective.
/// @param medium  of this rank's block
/// @param memory  of this rank's device
OrdinatesSettings AtQuality(
  const Domain& domain, Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory);

/// "Name = value" of each setting that a quality level may choose and that has an effect: spiralDirections instead of
/// directionsPerFace if set, no terms with the full matrix.
std::vector<std::string> Words(const OrdinatesSettings& settings);
/// The same with the settings actually used: slabs are solved with more directions (UnvaryingAxes.h).
std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light);
}
