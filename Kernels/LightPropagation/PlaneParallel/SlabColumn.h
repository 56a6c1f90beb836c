#pragma once

#include "LightPropagation/PlaneParallel/SlabScene.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Light of one column of voxels in one channel; all columns are equal. Arrays by layer; W per unit area of the layers.
class SlabColumn
{
public:
  /// @param orders  highest order of the Fourier series in azimuth to solve; 1 is needed for the flux along the layers
  SlabColumn(const SlabScene& scene, int channel, const HalfRangeQuadrature& nodes, int degree, int orders);

  std::vector<double> fluence, direct;          ///< W / length^2
  std::array<std::vector<double>, 3> flux;      ///< along the axis of the layers and the next two axes
  std::array<double, 2> out = {}, entered = {}; ///< at top and bottom; out is before reflection
  double absorbed = 0.0, emitted = 0.0;
  std::array<double, 2> escaped = {}; ///< after reflection
  LayerStack stack;
  StackSolution even;                                 ///< azimuthal order 0
  std::vector<std::array<StackSolution, 2>> slanting; ///< azimuthal orders 1, 2, ..., [cos, sin]

private:
  void AddBeams(const SlabScene& scene, const StackLight& light, int channel);
  void AddDiffuse(const StackLight& light, const LayerStack& unscattered, const HalfRangeQuadrature& nodes);
  void SumUp(const SlabScene& scene, const StackLight& light, const HalfRangeQuadrature& nodes, int channel);
};
}
