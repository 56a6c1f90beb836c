#pragma once

#include "LightPropagation/PlaneParallel/LayerResponse.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// One layer of a LayerStack.
struct StackLayer
{
  double depth = 0.0;   ///< optical thickness, without the forward peak (delta-M)
  double emitted = 0.0; ///< emission times height of the layer, W / (length^2 sr)
  std::size_t kind = 0; ///< index into LayerStack::kinds
};

/// Plane-parallel layers from top to bottom, in one channel; layers of one kind share absorption and phase function.
struct LayerStack
{
  std::vector<LayerScattering> kinds;
  std::vector<StackLayer> layers;
};

/// Parallel beam incident on the layers. Its azimuth enters through `irradiance`.
struct StackBeam
{
  double cosine = 1.0; ///< cosine of the angle between beam and axis of the layers, above 0
  bool fromTop = true; ///< whether the beam enters at the top; false: at the bottom
  /// Incident irradiance, perpendicular to the beam, W / length^2; in azimuthal order m > 0 multiplied by the cosine or
  /// sine of m times the azimuth.
  double irradiance = 0.0;
};

/// Light incident on a stack of layers, and reflection at its boundaries.
struct StackLight
{
  std::vector<StackBeam> beams;
  double radianceAtTop = 0.0, radianceAtBottom = 0.0; ///< incident isotropic radiance, W / (length^2 sr)
  double albedoAtTop = 0.0, albedoAtBottom = 0.0;     ///< Lambertian albedo of the boundaries
};

/// Scattered, emitted and diffuse boundary light of a stack of layers; the beams are not included.
struct StackSolution
{
  std::vector<LayerMeans> means; ///< mean radiance of each layer
  /// Outgoing radiance at the quadrature's nodes, times the square root of their weights
  Eigen::VectorXd upAtTop, downAtBottom;
  /// Incident radiance at the quadrature's nodes, including reflected light, times the square root of their weights
  Eigen::VectorXd downAtTop, upAtBottom;
  /// Power of the beams that reaches the boundary from inside, before reflection there, W / length^2
  double beamsAtTop = 0.0, beamsAtBottom = 0.0;
};

/// Irradiance of a beam, perpendicular to it, where it enters each layer, W / length^2.
std::vector<double> BeamAtLayers(const LayerStack& stack, const StackBeam& beam);

/// Solves for the light of all layers by the adding method, from the bottom up (van de Hulst 1980; numerics.md, Eqs.
/// (P7), (P8)).
/// @param order  order m of the Fourier series in azimuth; orders above 0 have no sources except beams
StackSolution Solve(const LayerStack& stack, const StackLight& light, const HalfRangeQuadrature& nodes, int order);
}
