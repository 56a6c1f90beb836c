#include "LightPropagation/ThickVoxels/VoxelResponse.h"

#include "LightPropagation/PlaneParallel/LayerResponse.h"
#include "LightPropagation/ThickVoxels/OctantSourcesShared.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tyndall
{
namespace
{
constexpr int Nodes = 10;              ///< number of quadrature nodes per hemisphere
constexpr double LeastAlbedo = 1e-3;   ///< smallest albedo, since the response is divided by it
constexpr double LeastAbsorbed = 1e-5; ///< smallest tabulated value of 1 - albedo
/// Maximum of the coefficient beta. In layers without absorption beta is arbitrary, because all power leaves them
/// anyway.
constexpr double MostAlike = 1.0;

/// Response of a layer to incident power 1 at its top: power that leaves through the top, power that leaves through the
/// bottom, uncollided power among the latter, and number of collisions per unit of power.
struct Response
{
  double reflected, transmitted, straight, collisions;
};

class Layer
{
public:
  Layer(const LayerModes& modes, const HalfRangeQuadrature& nodes, double depth)
    : Modes(modes)
    , Depth(depth)
    , Operator(modes, depth)
    , Roots(Nodes)
    , Powers(Nodes)
  {
    for (int i = 0; i < Nodes; ++i)
    {
      this->Roots[i] = std::sqrt(nodes.weights[i]);
      this->Powers[i] = 2.0 * Pi * nodes.cosines[i] * this->Roots[i];
      this->Straight += 2.0 * nodes.cosines[i] * nodes.weights[i] * std::exp(-depth / nodes.cosines[i]);
    }
  }

  Response OfDiffuse() const
  {
    const Eigen::VectorXd in = this->Roots / this->Powers.dot(this->Roots);
    const Eigen::VectorXd up = this->Operator.reflect * in, down = this->Operator.transmit * in;
    return { this->Powers.dot(up), this->Powers.dot(down), this->Straight,
      this->Collisions(LayerSource(Nodes), in, up, down) };
  }

  /// Response of the layer to first collisions in it of total power 1 whose density is proportional to exp(-fall z) at
  /// optical depth z.
  Response OfFalling(double albedo, double fall) const
  {
    const double lost = -std::expm1(-fall * this->Depth);
    LayerSource source(Nodes);
    source.AddBeam(this->Modes, this->Operator, this->Depth, 1.0 / fall, true,
      albedo * fall / lost / (2.0 * Pi) * this->Roots, Eigen::VectorXd::Zero(Nodes));
    return { this->Powers.dot(source.up), this->Powers.dot(source.down), 0.0,
      1.0 + this->Collisions(source, Eigen::VectorXd::Zero(Nodes), source.up, source.down) };
  }

  double StraightPart() const { return this->Straight; } ///< transmittance of uncollided isotropic light, 2 E_3(depth)

private:
  double Collisions(const LayerSource& source, const Eigen::VectorXd& downAtTop, const Eigen::VectorXd& upAtTop,
    const Eigen::VectorXd& downAtBottom) const
  {
    const LayerMeans means =
      MeansOf(this->Modes, source, this->Depth, downAtTop, upAtTop, downAtBottom, Eigen::VectorXd::Zero(Nodes));
    return 2.0 * Pi * this->Depth * this->Roots.dot(means.sum);
  }

  const LayerModes& Modes;
  double Depth, Straight = 0.0;
  LayerOperator Operator;
  Eigen::VectorXd Roots, Powers;
};

/// Factor that reduces the response of thin voxels, since light incident from neighbouring voxels is not entirely
/// isotropic (fitted to slabs of equal voxels).
double AmongOthers(double depth)
{
  return 1.0 - 0.45 * std::exp(-2.0 * depth);
}
}

VoxelResponse::VoxelResponse()
  : diffuse(ResponseValues)
  , falling(static_cast<std::size_t>(ResponseValues) * ResponseProfiles)
{
  const HalfRangeQuadrature nodes(Nodes);
  for (int a = 0; a < ResponseAlbedos; ++a)
  {
    const double root = static_cast<double>(a) / (ResponseAlbedos - 1);
    const double absorbed = std::clamp(root * root, LeastAbsorbed, 1.0 - LeastAlbedo), albedo = 1.0 - absorbed;
    const LayerModes modes({ absorbed, DeltaM(std::vector<double>{ 1.0, 0.0 }) }, nodes, 0);
    for (int d = 0; d < ResponseDepths; ++d)
    {
      const double depth = std::exp2(FirstDepth + 0.5 * d);
      const Layer layer(modes, nodes, depth);
      const double lost = 1.0 - layer.StraightPart(), leaves = lost / (4.0 * depth), part = AmongOthers(depth);
      const Response even = layer.OfDiffuse();
      // scattered power that leaves the layer, all orders
      const double scattered = even.reflected + even.transmitted - even.straight;
      const double kept = std::max(lost - scattered, 1e-6);
      const double alike =
        std::clamp((scattered - 2.0 * leaves * albedo * even.collisions) / (albedo * lost * kept), 0.0, MostAlike);
      float* const values = this->diffuse.data() + ResponseParts * (a * ResponseDepths + d);
      values[0] = static_cast<float>(part * (even.reflected - even.transmitted + even.straight) / (albedo * lost));
      values[1] = static_cast<float>(part * alike);
      values[2] = static_cast<float>(lost);
      for (int p = 0; p < ResponseProfiles; ++p)
      {
        const Response found = layer.OfFalling(albedo, std::exp2(FirstProfile + 0.5 * p));
        const double out = found.reflected + found.transmitted;
        const double beyond = 2.0 * leaves * albedo * found.collisions - albedo * alike * lost * out;
        float* const here = this->falling.data() + p * ResponseValues + ResponseParts * (a * ResponseDepths + d);
        here[0] = static_cast<float>(part * (found.reflected - found.transmitted) / (albedo * lost));
        here[1] = static_cast<float>(part * (out - beyond) / (albedo * lost));
      }
    }
  }
}
}
