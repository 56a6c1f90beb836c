#include "LightPropagation/PlaneParallel/LayerStack.h"

#include "Numerics/Constants.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
/// Cache of the eigenmodes (LayerModes) of each kind of layer, and of the operators (LayerOperator) of each layer.
class Library
{
public:
  Library(const LayerStack& stack, const HalfRangeQuadrature& nodes, int order)
    : Stack(stack)
    , Nodes(nodes)
    , Order(order)
    , OfKinds(stack.kinds.size())
  {
  }

  const LayerModes& Modes(const StackLayer& layer)
  {
    std::unique_ptr<LayerModes>& modes = this->OfKinds[layer.kind];
    if (!modes)
    {
      modes = std::make_unique<LayerModes>(this->Stack.kinds[layer.kind], this->Nodes, this->Order);
    }
    return *modes;
  }

  const LayerOperator& Operator(const StackLayer& layer)
  {
    const auto key = std::make_pair(layer.kind, layer.depth);
    const auto found = this->Operators.find(key);
    return found != this->Operators.end()
      ? found->second
      : this->Operators.emplace(key, LayerOperator(this->Modes(layer), layer.depth)).first->second;
  }

private:
  const LayerStack& Stack;
  const HalfRangeQuadrature& Nodes;
  int Order;
  std::vector<std::unique_ptr<LayerModes>> OfKinds;
  std::map<std::pair<std::size_t, double>, LayerOperator> Operators;
};

/// Reflection operator of all layers below an interface, and the upward radiance that their sources emit through it.
struct Below
{
  Eigen::MatrixXd reflect;
  Eigen::VectorXd source;
};

class Adding
{
public:
  Adding(const LayerStack& stack, const StackLight& light, const HalfRangeQuadrature& nodes, int order)
    : Stack(stack)
    , Shining(light)
    , Nodes(nodes)
    , Order(order)
    , Found(stack, nodes, order)
    , Roots(Eigen::Map<const Eigen::VectorXd>(nodes.weights.data(), static_cast<Eigen::Index>(nodes.weights.size()))
              .cwiseSqrt())
    , Cosines(Eigen::Map<const Eigen::VectorXd>(nodes.cosines.data(), static_cast<Eigen::Index>(nodes.cosines.size())))
  {
    this->FollowBeams();
    this->FindSources();
  }

  StackSolution Solve()
  {
    this->GoUp();
    return this->SolveCg();
  }

private:
  void FollowBeams()
  {
    for (const StackBeam& beam : this->Shining.beams)
    {
      std::vector<double> at = BeamAtLayers(this->Stack, beam);
      const StackLayer& last = beam.fromTop ? this->Stack.layers.back() : this->Stack.layers.front();
      const double left = (beam.fromTop ? at.back() : at.front()) * std::exp(-last.depth / beam.cosine);
      (beam.fromTop ? this->BeamsAtBottom : this->BeamsAtTop) += beam.cosine * left;
      this->BeamsAt.push_back(std::move(at));
    }
  }

  void FindSources()
  {
    int degree = 0;
    for (const LayerScattering& kind : this->Stack.kinds)
    {
      degree = std::max(degree, static_cast<int>(kind.phase.moments.size()) - 1);
    }
    this->Legendre = LegendreAtNodes(this->Nodes, degree, this->Order);
    for (const StackBeam& beam : this->Shining.beams)
    {
      this->OfBeams.push_back(NormalisedLegendre(degree, this->Order, beam.cosine));
    }
    for (std::size_t i = 0; i < this->Stack.layers.size(); ++i)
    {
      this->Sources.push_back(this->SourceOf(i));
    }
  }

  LayerSource SourceOf(std::size_t i)
  {
    const StackLayer& layer = this->Stack.layers[i];
    LayerSource source(this->Roots.size());
    if (layer.emitted != 0.0 && this->Order == 0)
    {
      source.AddEmission(
        this->Found.Modes(layer), this->Found.Operator(layer), layer.depth, layer.emitted * this->Roots);
    }
    const LayerScattering& kind = this->Stack.kinds[layer.kind];
    for (std::size_t b = 0; b < this->Shining.beams.size() && kind.Albedo() > 0.0 && layer.depth > 0.0; ++b)
    {
      const StackBeam& beam = this->Shining.beams[b];
      if (this->BeamsAt[b][i] != 0.0)
      {
        Eigen::VectorXd along = this->FirstScattered(kind, this->OfBeams[b], 0),
                        askew = this->FirstScattered(kind, this->OfBeams[b], 1);
        source.AddBeam(this->Found.Modes(layer), this->Found.Operator(layer), layer.depth, beam.cosine, beam.fromTop,
          this->BeamsAt[b][i] * along, this->BeamsAt[b][i] * askew);
      }
    }
    return source;
  }

  /// First-collision source at the quadrature's nodes, times the square root of their weights, for a beam of irradiance
  /// 1: downward plus upward (parity 0), or forward minus backward with respect to the beam (parity 1).
  Eigen::VectorXd FirstScattered(const LayerScattering& kind, const std::vector<double>& ofBeam, int parity) const
  {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(this->Roots.size());
    const double azimuths = this->Order == 0 ? 1.0 : 2.0;
    for (std::size_t l = static_cast<std::size_t>(this->Order + parity); l < kind.phase.moments.size(); l += 2)
    {
      const double part = kind.Albedo() * azimuths / (2.0 * Pi) * (2.0 * l + 1.0) * kind.phase.moments[l] * ofBeam[l];
      sum += part * this->Legendre.col(static_cast<Eigen::Index>(l));
    }
    return sum;
  }

  /// Operator of Lambertian reflection, from outgoing to reflected radiance at the quadrature's nodes; 0 for azimuthal
  /// orders above 0.
  Eigen::MatrixXd Lambert(double albedo) const
  {
    return this->Order == 0
      ? Eigen::MatrixXd(2.0 * albedo * this->Roots * this->Roots.cwiseProduct(this->Cosines).transpose())
      : Eigen::MatrixXd::Zero(this->Roots.size(), this->Roots.size());
  }
  /// Radiance at the quadrature's nodes, times the square root of their weights, that is incident from outside, plus
  /// that of beams reflected by the boundary.
  /// @param irradiance  power of the beams at the boundary, W / length^2
  Eigen::VectorXd ComesIn(double radiance, double albedo, double irradiance) const
  {
    return this->Order == 0 ? Eigen::VectorXd((radiance + albedo / Pi * irradiance) * this->Roots)
                            : Eigen::VectorXd::Zero(this->Roots.size());
  }

  void GoUp()
  {
    const std::size_t count = this->Stack.layers.size();
    this->UpOfDown.resize(count);
    this->UpOfSources.resize(count);
    this->Under.resize(count + 1);
    const StackLight& light = this->Shining;
    this->Under[count] = { this->Lambert(light.albedoAtBottom),
      this->ComesIn(light.radianceAtBottom, light.albedoAtBottom, this->BeamsAtBottom) };
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(this->Roots.size(), this->Roots.size());
    for (std::size_t i = count; i-- > 0;)
    {
      const Below& below = this->Under[i + 1];
      const LayerOperator& layer = this->Found.Operator(this->Stack.layers[i]);
      const LayerSource& source = this->Sources[i];
      const Eigen::PartialPivLU<Eigen::MatrixXd> between(one - below.reflect * layer.reflect);
      this->UpOfDown[i] = between.solve(below.reflect * layer.transmit);
      this->UpOfSources[i] = between.solve(below.reflect * source.down + below.source);
      this->Under[i] = { layer.reflect + layer.transmit * this->UpOfDown[i],
        source.up + layer.transmit * this->UpOfSources[i] };
    }
  }

  StackSolution SolveCg()
  {
    const StackLight& light = this->Shining;
    const Eigen::MatrixXd above = this->Lambert(light.albedoAtTop);
    const Eigen::VectorXd in = this->ComesIn(light.radianceAtTop, light.albedoAtTop, this->BeamsAtTop);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(this->Roots.size(), this->Roots.size());
    Eigen::VectorXd down =
      (one - above * this->Under[0].reflect).partialPivLu().solve(in + above * this->Under[0].source);
    Eigen::VectorXd up = this->Under[0].reflect * down + this->Under[0].source;
    StackSolution solution;
    solution.upAtTop = up;
    solution.downAtTop = down;
    for (std::size_t i = 0; i < this->Stack.layers.size(); ++i)
    {
      const StackLayer& layer = this->Stack.layers[i];
      const LayerOperator& passes = this->Found.Operator(layer);
      const Eigen::VectorXd nextUp = this->UpOfDown[i] * down + this->UpOfSources[i];
      const Eigen::VectorXd nextDown = passes.transmit * down + passes.reflect * nextUp + this->Sources[i].down;
      solution.means.push_back(
        MeansOf(this->Found.Modes(layer), this->Sources[i], layer.depth, down, up, nextDown, nextUp));
      down = nextDown;
      up = nextUp;
    }
    solution.downAtBottom = down;
    solution.upAtBottom = up;
    solution.beamsAtTop = this->BeamsAtTop;
    solution.beamsAtBottom = this->BeamsAtBottom;
    return solution;
  }

  const LayerStack& Stack;
  const StackLight& Shining;
  const HalfRangeQuadrature& Nodes;
  int Order;
  Library Found;
  Eigen::VectorXd Roots, Cosines;
  Eigen::MatrixXd Legendre;
  std::vector<std::vector<double>> BeamsAt, OfBeams;
  /// Power of the beams that reaches the top and the bottom from inside, W / length^2
  double BeamsAtTop = 0.0, BeamsAtBottom = 0.0;
  std::vector<LayerSource> Sources;
  /// Reflection and emitted light of all layers below each interface; interfaces from the top.
  std::vector<Below> Under;
  /// [layer]: operator from downward radiance above a layer to upward radiance below it
  std::vector<Eigen::MatrixXd> UpOfDown;
  std::vector<Eigen::VectorXd> UpOfSources;
};
}

std::vector<double> BeamAtLayers(const LayerStack& stack, const StackBeam& beam)
{
  std::vector<double> at(stack.layers.size());
  double depth = 0.0;
  for (std::size_t n = 0; n < at.size(); ++n)
  {
    const std::size_t i = beam.fromTop ? n : at.size() - 1 - n;
    at[i] = beam.irradiance * std::exp(-depth / beam.cosine);
    depth += stack.layers[i].depth;
  }
  return at;
}

StackSolution Solve(const LayerStack& stack, const StackLight& light, const HalfRangeQuadrature& nodes, int order)
{
  return Adding(stack, light, nodes, order).Solve();
}
}
