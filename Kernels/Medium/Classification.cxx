#include "Medium/Classification.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/Srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall
{
double ExtinctionOfOpacity(double opacity, double unitDistance, double largest)
{
  if (!(opacity > 0.0))
  {
    return 0.0;
  }
  return opacity < 1.0 ? std::min(-std::log1p(-opacity) / unitDistance, largest) : largest;
}

namespace
{
/// Chandrasekhar's function H(1, w) for isotropic scattering: ln H = -1/pi times the integral of ln(1 - w x cot x) over
/// x from 0 to pi/2 (D. W. N. Stibbs and R. E. Weir, "On the H-functions for isotropic scattering", MNRAS 119, 1959).
/// Points of the quadrature lie densely at 0, where the integrand is singular for w = 1.
double NormalH(double albedo)
{
  static const GaussLegendre quadrature(64);
  double integral = 0.0;
  for (std::size_t i = 0; i < quadrature.points.size(); ++i)
  {
    const double u = 0.5 + 0.5 * quadrature.points[i];
    const double x = 0.5 * Pi * u * u;
    integral += 0.5 * quadrature.weights[i] * Pi * u * std::log(1.0 - albedo * x / std::tan(x));
  }
  return std::exp(-integral / Pi);
}

/// NormalReflectance as a function of t = sqrt(1 - w), in equal steps; it decreases.
class ReflectanceTable
{
public:
  ReflectanceTable()
  {
    for (std::size_t i = 0; i < this->Colors.size(); ++i)
    {
      const double t = Darkest + (Brightest - Darkest) * static_cast<double>(i) / (this->Colors.size() - 1);
      this->Colors[i] = NormalReflectance(1.0 - t * t);
    }
  }

  double AlbedoOf(double color) const
  {
    const auto above = std::lower_bound(this->Colors.begin(), this->Colors.end(), color);
    if (above == this->Colors.begin())
    {
      return 0.0;
    }
    if (above == this->Colors.end())
    {
      return LargestAlbedo;
    }
    const double at = static_cast<double>(above - this->Colors.begin()) - (*above - color) / (*above - *(above - 1));
    const double t = Darkest + (Brightest - Darkest) * at / (this->Colors.size() - 1);
    return 1.0 - t * t;
  }

private:
  static constexpr double Darkest = 1.0;
  static inline const double Brightest = std::sqrt(1.0 - LargestAlbedo);
  std::array<double, 2049> Colors;
};
}

double NormalReflectance(double albedo)
{
  return 1.0 - NormalH(albedo) * std::sqrt(1.0 - albedo);
}

double AlbedoOfColor(double color, double g)
{
  static const ReflectanceTable table;
  const double isotropic = table.AlbedoOf(DecodeSrgb(std::clamp(color, 0.0, 1.0)));
  return isotropic / (1.0 - g + g * isotropic);
}

CoefficientTable::CoefficientTable(const Function& function, int valueCount, const std::vector<double>& nodes)
  : Count(valueCount)
{
  std::vector<Node> given;
  double largest = 0.0;
  for (const double scalar : nodes)
  {
    given.push_back({ scalar, {} });
    function(scalar, given.back().values.data());
    largest = std::max(largest, *std::max_element(given.back().values.begin(), given.back().values.end()));
  }
  this->Append(given[0]);
  for (std::size_t i = 1; i < given.size(); ++i)
  {
    if (given[i].scalar > given[i - 1].scalar)
    {
      this->AppendBetween(function, given[i - 1], given[i], 1e-6 * largest, 20);
    }
  }
  this->Integrate();
}

void CoefficientTable::Append(const Node& node)
{
  this->Nodes.push_back(node.scalar);
  this->Values.insert(this->Values.end(), node.values.begin(), node.values.begin() + this->Count);
}

/// Appends the nodes above `low`, up to and with `high`.
/// @param smallest  error of a value that is always accepted
/// @param halvings  how often the interval may be halved
void CoefficientTable::AppendBetween(
  const Function& function, const Node& low, const Node& high, double smallest, int halvings)
{
  constexpr int parts = 8;
  std::array<Node, parts + 1> inner; // the points that divide the interval, without its ends
  bool isClose = true;
  for (int k = 1; k < parts; ++k)
  {
    const double part = static_cast<double>(k) / parts;
    inner[k] = { low.scalar + part * (high.scalar - low.scalar), {} };
    function(inner[k].scalar, inner[k].values.data());
    for (int i = 0; i < this->Count; ++i)
    {
      const double error = std::abs(inner[k].values[i] - low.values[i] - part * (high.values[i] - low.values[i]));
      isClose = isClose && error <= 1e-3 * inner[k].values[i] + smallest;
    }
  }
  const Node& middle = inner[parts / 2];
  if (isClose || halvings == 0 || middle.scalar <= low.scalar || middle.scalar >= high.scalar)
  {
    this->Append(high);
    return;
  }
  this->AppendBetween(function, low, middle, smallest, halvings - 1);
  this->AppendBetween(function, middle, high, smallest, halvings - 1);
}

void CoefficientTable::Integrate()
{
  this->Integrals.assign(this->Values.size(), 0.0);
  for (std::size_t node = 1; node < this->Nodes.size(); ++node)
  {
    const double half = 0.5 * (this->Nodes[node] - this->Nodes[node - 1]);
    for (int i = 0; i < this->Count; ++i)
    {
      const std::size_t at = node * this->Count + i;
      this->Integrals[at] =
        this->Integrals[at - this->Count] + half * (this->Values[at] + this->Values[at - this->Count]);
    }
  }
  this->Intervals.resize(4 * this->Nodes.size() + 1);
  for (std::size_t part = 0; part < this->Intervals.size(); ++part)
  {
    const double scalar = this->Nodes.front() +
      (this->Nodes.back() - this->Nodes.front()) * static_cast<double>(part) / (this->Intervals.size() - 1);
    const auto above = std::upper_bound(this->Nodes.begin(), this->Nodes.end(), scalar);
    this->Intervals[part] = std::max<std::ptrdiff_t>(1, above - this->Nodes.begin()) - 1;
  }
}

/// Index of the node that begins the interval of a scalar between the first and the last node.
std::size_t CoefficientTable::IntervalOf(double scalar) const
{
  const std::size_t parts = this->Intervals.size() - 1;
  const double range = this->Nodes.back() - this->Nodes.front();
  const auto part = std::min(parts - 1, static_cast<std::size_t>((scalar - this->Nodes.front()) / range * parts));
  // Rounding may put the scalar into the part before or after its own.
  const auto first = this->Nodes.begin() + this->Intervals[part == 0 ? 0 : part - 1];
  const auto last =
    this->Nodes.begin() + std::min(this->Nodes.size() - 1, this->Intervals[std::min(parts, part + 2)] + 1);
  const auto above = std::upper_bound(first + 1, last, scalar);
  return static_cast<std::size_t>(above - this->Nodes.begin()) - 1;
}

/// Adds `factor` times the integrals from `from` to `to` within one interval, where the values are linear.
void CoefficientTable::AddPart(std::size_t interval, double from, double to, double factor, double* sums) const
{
  const double part = (0.5 * (from + to) - this->Nodes[interval]) / (this->Nodes[interval + 1] - this->Nodes[interval]);
  const double* const low = &this->Values[interval * this->Count];
  const double* const high = low + this->Count;
  for (int i = 0; i < this->Count; ++i)
  {
    sums[i] += factor * (low[i] + part * (high[i] - low[i]));
  }
}

int CoefficientTable::NodesBetween(double low, double high) const
{
  if (this->Nodes.size() == 1 || high <= this->Nodes.front() || low >= this->Nodes.back())
  {
    return 0;
  }
  const std::size_t first = this->IntervalOf(std::max(low, this->Nodes.front()));
  return high <= this->Nodes[first + 1]
    ? 0
    : static_cast<int>(this->IntervalOf(std::min(high, this->Nodes.back())) - first);
}

void CoefficientTable::AddMean(double from, double to, double weight, double* sums) const
{
  const double low = std::clamp(std::min(from, to), this->Nodes.front(), this->Nodes.back());
  const double high = std::clamp(std::max(from, to), this->Nodes.front(), this->Nodes.back());
  if (this->Nodes.size() == 1)
  {
    for (int i = 0; i < this->Count; ++i)
    {
      sums[i] += weight * this->Values[i];
    }
    return;
  }
  const std::size_t first = this->IntervalOf(low);
  const std::size_t last = high < this->Nodes[first + 1] ? first : this->IntervalOf(high);
  if (first == last)
  {
    this->AddPart(first, low, high, weight, sums);
    return;
  }
  const double perLength = weight / (high - low);
  this->AddPart(first, low, this->Nodes[first + 1], perLength * (this->Nodes[first + 1] - low), sums);
  this->AddPart(last, this->Nodes[last], high, perLength * (high - this->Nodes[last]), sums);
  const double* const begin = &this->Integrals[(first + 1) * this->Count];
  const double* const end = &this->Integrals[last * this->Count];
  for (int i = 0; i < this->Count; ++i)
  {
    sums[i] += perLength * (end[i] - begin[i]);
  }
}
}
