#pragma once

#include "LightPropagation/PlaneParallel/LayerResponse.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
struct StackLayer
{
  double depth = 0.0;   ///< optical thickness, without what goes straight on
  double emitted = 0.0; ///< radiance that its whole height sends out
  std::size_t kind = 0; ///< of LayerStack::kinds
};

/// Layers from top to bottom, in one channel.
struct LayerStack
{
  std::vector<LayerScattering> kinds;
  std::vector<StackLayer> layers;
};

/// Parallel light. Its azimuth is in the number that it counts by.
struct StackBeam
{
  double cosine = 1.0; ///< to the axis of the layers, above 0
  bool fromTop = true; ///< or from the bottom
  double irradiance =
    0.0; ///< of a plane across the beam, where it comes in; of order m > 0: times cos or sin of m azimuth
};

struct StackLight
{
  std::vector<StackBeam> beams;
  double radianceAtTop = 0.0, radianceAtBottom = 0.0; ///< that comes in, the same in all directions
  double albedoAtTop = 0.0, albedoAtBottom = 0.0;     ///< of Lambert's law, for what leaves
};

/// Scattered light of the layers, and diffuse light from outside: all but the beams.
struct StackSolution
{
  std::vector<LayerMeans> means;                ///< of each layer
  Eigen::VectorXd upAtTop, downAtBottom;        ///< what leaves
  Eigen::VectorXd downAtTop, upAtBottom;        ///< what comes in, reflected light too
  double beamsAtTop = 0.0, beamsAtBottom = 0.0; ///< W / length^2 that beams take out there
};

/// Of each layer, by beam: what is left of it where it comes in.
std::vector<double> BeamAtLayers(const LayerStack& stack, const StackBeam& beam);

/// Solves all layers at once, by adding them from the bottom (van de Hulst; numerics.md, Eqs. (P7), (P8)).
/// @param order  of the Fourier series in azimuth; of those above 0 beams are the only sources
StackSolution Solve(const LayerStack& stack, const StackLight& light, const HalfRangeQuadrature& nodes, int order);
}
