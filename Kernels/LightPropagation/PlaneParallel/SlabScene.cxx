#include "LightPropagation/PlaneParallel/SlabScene.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tyndall
{
namespace
{
/// Transmittance exp(-depth) of a layer (`left`), and mean transmittance within it (`mean`).
struct FallOff
{
  explicit FallOff(double depth)
    : mean(depth > 1e-8 ? -std::expm1(-depth) / depth : 1.0 - 0.5 * depth)
    , left(std::exp(-depth))
  {
  }

  double mean, left;
};

/// Integral over the cosine of `values`, multiplied by the cosine if `cosine` is set, and by the sine if `sine` is set.
/// The values are given at the quadrature's nodes and contain the square root of the node's weight as a factor.
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

/// Calls act(layer, irradiance) for each layer. The irradiance is that of a beam, perpendicular to the beam, averaged
/// over the layer.
template <class Act>
void ForLayersOf(const LayerStack& stack, const StackBeam& beam, const Act& act)
{
  const std::vector<double> at = BeamAtLayers(stack, beam);
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    act(i, at[i] * FallOff(stack.layers[i].depth / beam.cosine).mean);
  }
}

/// Matrix that projects radiance at the quadrature's nodes, given as amplitudes of its Fourier series in azimuth, onto
/// each spherical harmonic of the scene axes (rows). Columns: [node][down, up][order 0, then cos and sin of orders 1,
/// 2, ...].
Eigen::MatrixXd Projection(const SlabScene& scene, const HalfRangeQuadrature& nodes, int degree, int orders)
{
  const auto count = static_cast<int>(nodes.cosines.size());
  const int series = 1 + 2 * orders, around = 2 * (degree + orders) + 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero((degree + 1) * (degree + 1), 2 * count * series);
  for (int n = 0; n < 2 * count; ++n)
  {
    const double mu = nodes.cosines[n / 2], sine = std::sqrt(1.0 - mu * mu);
    for (int turn = 0; turn < around; ++turn)
    {
      const double azimuth = 2.0 * Pi * turn / around;
      std::array<double, 3> omega;
      omega[scene.Along()] = n % 2 == 0 ? mu : -mu;
      omega[(scene.Along() + 1) % 3] = sine * std::cos(azimuth);
      omega[(scene.Along() + 2) % 3] = sine * std::sin(azimuth);
      const std::vector<double> harmonics = SphericalHarmonics(degree, omega);
      const Eigen::VectorXd there =
        Eigen::Map<const Eigen::VectorXd>(harmonics.data(), static_cast<Eigen::Index>(harmonics.size()));
      for (int s = 0; s < series; ++s)
      {
        const int m = (s + 1) / 2;
        const double wave = s % 2 == 1 ? std::cos(m * azimuth) : s > 0 ? std::sin(m * azimuth) : 1.0;
        matrix.col(n * series + s) += 2.0 * Pi / around * std::sqrt(nodes.weights[n / 2]) * wave * there;
      }
    }
  }
  return matrix;
}

/// Amplitudes of the Fourier series of one layer's mean radiance, in the order of the columns of Projection().
Eigen::VectorXd Amplitudes(const SlabColumn& column, std::size_t layer, int series)
{
  const Eigen::Index count = column.even.means[layer].sum.size();
  Eigen::VectorXd all(2 * count * series);
  for (int s = 0; s < series; ++s)
  {
    const StackSolution& of = s == 0 ? column.even : column.slanting[(s - 1) / 2][(s - 1) % 2];
    const LayerMeans& means = of.means[layer];
    for (Eigen::Index n = 0; n < count; ++n)
    {
      all[2 * n * series + s] = 0.5 * (means.sum[n] + means.flux[n]);
      all[(2 * n + 1) * series + s] = 0.5 * (means.sum[n] - means.flux[n]);
    }
  }
  return all;
}
}

SlabScene::SlabScene(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
  : TheMedium(medium)
  , Shining(illumination)
  , Axis(AxisOfLayers(settings.periodic))
  , Isotropic(medium.phase.IsIsotropic())
{
  for (std::size_t i = 0; i < illumination.lights.size(); ++i)
  {
    const std::array<double, 3> d = DirectionOf(illumination.lights[i]);
    const double along = d[this->Axis];
    if (along != 0.0)
    {
      this->Directions.push_back({ along, d[(this->Axis + 1) % 3], d[(this->Axis + 2) % 3] });
      this->Entering.push_back(i);
    }
  }
}

double SlabScene::Across() const
{
  return this->TheMedium.grid.Length((this->Axis + 1) % 3) * this->TheMedium.grid.Length((this->Axis + 2) % 3);
}

std::size_t SlabScene::LayerOf(std::size_t voxel) const
{
  return voxel / this->TheMedium.grid.Strides()[this->Axis] % this->Count();
}

bool SlabScene::HasSlantingBeams() const
{
  return std::any_of(this->Directions.begin(), this->Directions.end(),
    [](const std::array<double, 3>& d) { return d[1] != 0.0 || d[2] != 0.0; });
}

LayerStack SlabScene::StackOf(int channel, int degree) const
{
  const Medium& medium = this->TheMedium;
  LayerStack stack;
  std::map<double, DeltaM> phases;                        // truncated phase functions (delta-M); key: mean cosine
  std::map<std::pair<double, double>, std::size_t> kinds; // index in LayerStack::kinds; key: absorption and mean cosine
  for (std::size_t i = 0; i < this->Count(); ++i)
  {
    const std::size_t voxel = this->VoxelOf(i);
    const double g = medium.phase.MeanCosine(voxel, channel), sigma_a = medium.sigma_a.At(voxel, channel);
    auto phase = phases.find(g);
    if (phase == phases.end())
    {
      phase = phases.emplace(g, this->PhaseOf(voxel, channel, degree)).first;
    }
    const double sigma_t = sigma_a + medium.sigma_s.At(voxel, channel) * (1.0 - phase->second.forward);
    const double absorbed = sigma_t > 0.0 ? sigma_a / sigma_t : 1.0;
    const auto kind = kinds.emplace(std::make_pair(absorbed, g), stack.kinds.size());
    if (kind.second)
    {
      stack.kinds.push_back({ absorbed, phase->second });
    }
    stack.layers.push_back(
      { sigma_t * this->Height(), medium.emission.At(voxel, channel) * this->Height(), kind.first->second });
  }
  return stack;
}

LayerStack SlabScene::UnscatteredStackOf(int channel) const
{
  LayerStack stack;
  for (std::size_t i = 0; i < this->Count(); ++i)
  {
    const std::size_t voxel = this->VoxelOf(i);
    const double sigma_t =
      static_cast<double>(this->TheMedium.sigma_a.At(voxel, channel)) + this->TheMedium.sigma_s.At(voxel, channel);
    stack.layers.push_back(
      { sigma_t * this->Height(), this->TheMedium.emission.At(voxel, channel) * this->Height(), 0 });
  }
  return stack;
}

DeltaM SlabScene::PhaseOf(std::size_t voxel, int channel, int degree) const
{
  const PhaseFunction phase = this->TheMedium.phase.At(voxel, channel);
  return phase.IsIsotropic() ? DeltaM(std::vector<double>{ 1.0, 0.0 }) : DeltaM(phase.Moments(degree + 1));
}

StackLight SlabScene::LightOf(int channel) const
{
  StackLight light = this->BeamsOf(channel, 0, false);
  const int top = 2 * this->Axis, bottom = top + 1;
  light.radianceAtTop = this->Shining.sky[channel] + this->Shining.faces[top][channel];
  light.radianceAtBottom = this->Shining.sky[channel] + this->Shining.faces[bottom][channel];
  light.albedoAtTop = this->Shining.faceAlbedo[top][channel];
  light.albedoAtBottom = this->Shining.faceAlbedo[bottom][channel];
  return light;
}

StackLight SlabScene::BeamsOf(int channel, int order, bool sine) const
{
  StackLight light;
  for (std::size_t b = 0; b < this->Entering.size(); ++b)
  {
    const std::array<double, 3>& d = this->Directions[b];
    const double azimuth = order * std::atan2(d[2], d[1]);
    const double power = this->Shining.lights[this->Entering[b]].power[channel];
    light.beams.push_back({ std::abs(d[0]), d[0] > 0.0,
      power *
        (sine           ? std::sin(azimuth)
            : order > 0 ? std::cos(azimuth)
                        : 1.0) });
  }
  return light;
}

double SlabScene::Absorbing(std::size_t layer, int channel) const
{
  return this->TheMedium.sigma_a.At(this->VoxelOf(layer), channel) * this->Height();
}

std::array<double, 2> SlabScene::Sideways(std::size_t beam) const
{
  return { this->Directions[beam][1], this->Directions[beam][2] };
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

/// Adds the beams' fluence, flux and incident power. In `fluence`, light scattered into the forward peak (delta-M)
/// belongs to the beam; in `direct` it does not.
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

/// Adds to `direct` the uncollided light of sky, faces and emission, integrated over the nodes (cosines) of the
/// quadrature.
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

std::vector<double> ScatteredMoments(
  const SlabScene& scene, const SlabColumn& column, const HalfRangeQuadrature& nodes, int degree)
{
  const auto orders = static_cast<int>(column.slanting.size());
  const Eigen::MatrixXd projection = Projection(scene, nodes, degree, orders);
  std::vector<double> moments;
  for (std::size_t i = 0; i < scene.Count(); ++i)
  {
    const Eigen::VectorXd found = projection * Amplitudes(column, i, 1 + 2 * orders);
    const DeltaM& phase = column.stack.kinds[column.stack.layers[i].kind].phase;
    for (Eigen::Index j = 0; j < found.size(); ++j)
    {
      const auto l = static_cast<std::size_t>(DegreeOfTerm(static_cast<int>(j)));
      const double moment = l < phase.moments.size() ? phase.moments[l] : 0.0;
      moments.push_back((1.0 - phase.forward) * moment * found[j] / std::sqrt(4.0 * Pi));
    }
  }
  return moments;
}
}
