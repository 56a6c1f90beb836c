#pragma once

#include "LightPropagation/PlaneParallel/LayerModes.h"

#include <Eigen/Core>

namespace tyndall
{
/// Reflection and transmission operators of a uniform layer, the same from both sides. Vectors are over the nodes:
/// radiance times the square root of the weight.
struct LayerOperator
{
  /// @param depth  optical thickness
  LayerOperator(const LayerModes& modes, double depth);

  Eigen::MatrixXd reflect, transmit;
};

/// Response of a layer to internal sources, without incident light.
struct LayerSource
{
  Eigen::VectorXd up, down;     ///< outgoing at the top and at the bottom
  Eigen::VectorXd meanA, meanB; ///< means over depth of the mode amplitudes (LayerModes), for the
                                ///< solution with a = 0 at top and bottom

  explicit LayerSource(Eigen::Index nodes);

  /// Adds emission that is uniform in depth.
  /// @param emitted  radiance that the whole layer emits at each node, the same up and down
  void AddEmission(const LayerModes& modes, const LayerOperator& layer, double depth, const Eigen::VectorXd& emitted);

  /// Adds the first-collision source of a beam, per mean free path.
  /// @param cosine  of the beam, > 0
  /// @param fromTop  the beam enters at the top; false: at the bottom
  /// @param sum, difference  sum and difference of forward and backward first-scattered light, where the beam enters
  void AddBeam(const LayerModes& modes, const LayerOperator& layer, double depth, double cosine, bool fromTop,
    const Eigen::VectorXd& sum, const Eigen::VectorXd& difference);

private:
  void AddEnds(const LayerModes& modes, const LayerOperator& layer, const Eigen::VectorXd& bAtEntry,
    const Eigen::VectorXd& bAtExit, bool fromTop);
};

/// Means over the depth of a layer.
struct LayerMeans
{
  Eigen::VectorXd sum;  ///< of downward plus upward radiance
  Eigen::VectorXd flux; ///< of downward minus upward radiance
};

/// @param downAtTop, ...  radiance at both boundaries of the layer
LayerMeans MeansOf(const LayerModes& modes, const LayerSource& source, double depth, const Eigen::VectorXd& downAtTop,
  const Eigen::VectorXd& upAtTop, const Eigen::VectorXd& downAtBottom, const Eigen::VectorXd& upAtBottom);
}
