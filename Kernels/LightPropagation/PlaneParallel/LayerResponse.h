#pragma once

#include "LightPropagation/PlaneParallel/LayerModes.h"

#include <Eigen/Core>

namespace tyndall
{
/// What a uniform layer sends back of the light that comes in at either side, and lets through. Vectors are over the
/// nodes, radiance times the square root of the weight.
struct LayerOperator
{
  /// @param depth  optical thickness
  LayerOperator(const LayerModes& modes, double depth);

  Eigen::MatrixXd reflect, transmit;
};

/// What sources inside a layer bring about when nothing comes in from outside.
struct LayerSource
{
  Eigen::VectorXd up, down;     ///< what leaves at the top and at the bottom
  Eigen::VectorXd meanA, meanB; ///< means over depth of the modes' amplitudes (LayerModes), of the part of them that is
                                ///< dark, as a sum of both directions, at top and bottom

  explicit LayerSource(Eigen::Index nodes);

  /// Light that is sent out evenly in depth.
  /// @param emitted  radiance that the layer's whole height sends out at each node, both ways alike
  void AddEmission(const LayerModes& modes, const LayerOperator& layer, double depth, const Eigen::VectorXd& emitted);

  /// What a beam is first scattered into, per mean free path.
  /// @param cosine  of the beam, above 0; it comes in at the top, or else at the bottom
  /// @param sum, difference  of what is scattered on along its way, and back, where the beam comes in
  void AddBeam(const LayerModes& modes, const LayerOperator& layer, double depth, double cosine, bool fromTop,
    const Eigen::VectorXd& sum, const Eigen::VectorXd& difference);

private:
  void AddEnds(const LayerModes& modes, const LayerOperator& layer, const Eigen::VectorXd& bAtEntry,
    const Eigen::VectorXd& bAtExit, bool fromTop);
};

/// Means over a layer.
struct LayerMeans
{
  Eigen::VectorXd sum;  ///< of radiance down and up
  Eigen::VectorXd flux; ///< of radiance down less radiance up
};

/// @param downAtTop, ...  radiance at its two sides
LayerMeans MeansOf(const LayerModes& modes, const LayerSource& source, double depth, const Eigen::VectorXd& downAtTop,
  const Eigen::VectorXd& upAtTop, const Eigen::VectorXd& downAtBottom, const Eigen::VectorXd& upAtBottom);
}
