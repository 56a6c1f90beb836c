#pragma once

#include "LightPropagation/PlaneParallel/SlabScene.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The light of one column in one channel, of which all columns have the same. By layer; W, per area across the layers.
class SlabColumn
{
public:
  /// @param orders  of the Fourier series in azimuth that are found, 0 to that; 1 for the flux along the layers
  SlabColumn(const SlabScene& scene, int channel, const HalfRangeQuadrature& nodes, int degree, int orders);

  std::vector<double> fluence, direct;          ///< W / length^2
  std::array<std::vector<double>, 3> flux;      ///< along the axis of the layers, and the two next
  std::array<double, 2> out = {}, entered = {}; ///< at top and bottom; out before a face gives back its part
  double absorbed = 0.0, emitted = 0.0;
  std::array<double, 2> escaped = {}; ///< less what faces give back
  LayerStack stack;
  StackSolution even;                                 ///< of order 0
  std::vector<std::array<StackSolution, 2>> slanting; ///< of orders 1, 2, ..., by cos and sin

private:
  void AddBeams(const SlabScene& scene, const StackLight& light, int channel);
  void AddDiffuse(const StackLight& light, const LayerStack& unscattered, const HalfRangeQuadrature& nodes);
  void SumUp(const SlabScene& scene, const StackLight& light, const HalfRangeQuadrature& nodes, int channel);
};
}
