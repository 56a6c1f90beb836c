#pragma once

#include "LightPropagation/PlaneParallel/LayerResponse.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
struct StackLayer
{
  double depth = 0.0;   ///< optical thickness, without the unscattered forward part
  double emitted = 0.0; ///< radiance that the whole layer emits
  std::size_t kind = 0; ///< index into LayerStack::kinds
};

/// Layers from top to bottom, in one channel.
struct LayerStack
{
  std::vector<LayerScattering> kinds;
  std::vector<StackLayer> layers;
};

/// Parallel beam. Its azimuth enters through its irradiance.
struct StackBeam
{
  double cosine = 1.0;     ///< to the axis of the layers, above 0
  bool fromTop = true;     ///< false: from the bottom
  double irradiance = 0.0; ///< incident, perpendicular to the beam; of order m > 0: times cos or sin of m azimuth
};

struct StackLight
{
  std::vector<StackBeam> beams;
  double radianceAtTop = 0.0, radianceAtBottom = 0.0; ///< incident, isotropic
  double albedoAtTop = 0.0, albedoAtBottom = 0.0;     ///< Lambertian
};

/// Scattered light of the layers and diffuse boundary light; does not include the beams.
struct StackSolution
{
  std::vector<LayerMeans> means;                ///< of each layer
  Eigen::VectorXd upAtTop, downAtBottom;        ///< outgoing radiance
  Eigen::VectorXd downAtTop, upAtBottom;        ///< incident radiance, with reflected light
  double beamsAtTop = 0.0, beamsAtBottom = 0.0; ///< escaped power of the beams, W / length^2
};

/// Irradiance of a beam, perpendicular to it, where it enters each layer.
std::vector<double> BeamAtLayers(const LayerStack& stack, const StackBeam& beam);

/// Solves all layers by the adding method, from the bottom up (van de Hulst; numerics.md, Eqs. (P7), (P8)).
/// @param order  of the Fourier series in azimuth; orders above 0 have no sources except beams
StackSolution Solve(const LayerStack& stack, const StackLight& light, const HalfRangeQuadrature& nodes, int order);
}
