#include "LightPropagation/PlaneParallel/SlabColumn.h"

#include "Numerics/Constants.h"

#include <cmath>

namespace tyndall
{
namespace
{
/// Transmittance of a layer, and the mean of exp(-depth) over it.
struct FallOff
{
  explicit FallOff(double depth)
    : mean(depth > 1e-8 ? -std::expm1(-depth) / depth : 1.0 - 0.5 * depth)
    , left(std::exp(-depth))
  {
  }

  double mean, left;
};

/// Sum over nodes of weight, powers of the cosine and of the sine, and values that already contain the square root of
/// the weight.
double Integral(const HalfRangeQuadrature& nodes, const Eigen::VectorXd& values, bool cosine, bool sine)
{
  double sum = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    const double mu = nodes.cosines[i];
    sum += std::sqrt(nodes.weights[i]) * (cosine ? mu : 1.0) * (sine ? std::sqrt(1.0 - mu * mu) : 1.0) * values[i];
  }
  return sum;
}

/// Calls act(layer, mean irradiance perpendicular to the beam) for each layer.
template <class Act>
void ForLayersOf(const LayerStack& stack, const StackBeam& beam, const Act& act)
{
  const std::vector<double> at = BeamAtLayers(stack, beam);
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    act(i, at[i] * FallOff(stack.layers[i].depth / beam.cosine).mean);
  }
}
}

SlabColumn::SlabColumn(const SlabScene& scene, int channel, const HalfRangeQuadrature& nodes, int degree, int orders)
  : fluence(scene.Count())
  , direct(scene.Count())
  , stack(scene.StackOf(channel, degree))
{
  this->flux.fill(std::vector<double>(scene.Count()));
  const StackLight light = scene.LightOf(channel);
  this->even = Solve(this->stack, light, nodes, 0);
  for (int m = 1; m <= orders; ++m)
  {
    this->slanting.push_back({ Solve(this->stack, scene.BeamsOf(channel, m, false), nodes, m),
      Solve(this->stack, scene.BeamsOf(channel, m, true), nodes, m) });
  }
  for (std::size_t i = 0; i < scene.Count(); ++i)
  {
    this->fluence[i] = 2.0 * Pi * Integral(nodes, this->even.means[i].sum, false, false);
    this->flux[0][i] = 2.0 * Pi * Integral(nodes, this->even.means[i].flux, true, false);
    for (std::size_t along = 0; along < 2 && orders > 0; ++along)
    {
      this->flux[1 + along][i] = Pi * Integral(nodes, this->slanting[0][along].means[i].sum, false, true);
    }
  }
  this->AddBeams(scene, light, channel);
  this->AddDiffuse(light, scene.UnscatteredStackOf(channel), nodes);
  this->SumUp(scene, light, nodes, channel);
}

/// Adds the beams. In `fluence`, light scattered into the unscattered forward part belongs to the beam; in `direct` it
/// does not.
void SlabColumn::AddBeams(const SlabScene& scene, const StackLight& light, int channel)
{
  const LayerStack unscattered = scene.UnscatteredStackOf(channel);
  for (std::size_t b = 0; b < light.beams.size(); ++b)
  {
    const StackBeam& beam = light.beams[b];
    const std::array<double, 2> sideways = scene.Sideways(b);
    ForLayersOf(this->stack, beam, [&](std::size_t i, double mean) {
      this->fluence[i] += mean;
      this->flux[0][i] += (beam.fromTop ? beam.cosine : -beam.cosine) * mean;
      this->flux[1][i] += sideways[0] * mean;
      this->flux[2][i] += sideways[1] * mean;
    });
    ForLayersOf(unscattered, beam, [&](std::size_t i, double mean) { this->direct[i] += mean; });
    this->entered[beam.fromTop ? 0 : 1] += beam.cosine * beam.irradiance;
  }
}

/// Adds uncollided light of faces and emission, along the nodes.
void SlabColumn::AddDiffuse(const StackLight& light, const LayerStack& unscattered, const HalfRangeQuadrature& nodes)
{
  const std::size_t count = unscattered.layers.size();
  for (const bool fromTop : { true, false })
  {
    for (std::size_t n = 0; n < nodes.cosines.size(); ++n)
    {
      double radiance = fromTop ? light.radianceAtTop : light.radianceAtBottom;
      for (std::size_t step = 0; step < count; ++step)
      {
        const std::size_t i = fromTop ? step : count - 1 - step;
        const StackLayer& layer = unscattered.layers[i];
        const double depth = layer.depth / nodes.cosines[n], sent = layer.emitted / nodes.cosines[n];
        const FallOff falls(depth);
        const double meanSent = depth > 1e-4 ? (1.0 - falls.mean) / depth : 0.5 - depth / 6.0;
        this->direct[i] += 2.0 * Pi * nodes.weights[n] * (radiance * falls.mean + sent * meanSent);
        radiance = radiance * falls.left + sent * falls.mean;
      }
    }
  }
}

void SlabColumn::SumUp(const SlabScene& scene, const StackLight& light, const HalfRangeQuadrature& nodes, int channel)
{
  this->entered[0] += Pi * light.radianceAtTop;
  this->entered[1] += Pi * light.radianceAtBottom;
  this->out = { 2.0 * Pi * Integral(nodes, this->even.upAtTop, true, false) + this->even.beamsAtTop,
    2.0 * Pi * Integral(nodes, this->even.downAtBottom, true, false) + this->even.beamsAtBottom };
  this->escaped = { (1.0 - light.albedoAtTop) * this->out[0], (1.0 - light.albedoAtBottom) * this->out[1] };
  for (std::size_t i = 0; i < scene.Count(); ++i)
  {
    this->absorbed += scene.Absorbing(i, channel) * this->fluence[i];
    this->emitted += 4.0 * Pi * this->stack.layers[i].emitted;
  }
}
}
