#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
/// Largest optical thickness, extinction times the smallest spacing, of a voxel whose medium is made of opacities.
constexpr double ThickestVoxel = 16.0;

/// Largest single-scattering albedo of a colour, for isotropic scattering.
constexpr double LargestAlbedo = 0.9999;

/// Extinction coefficient, 1/length, of a medium that has an opacity per unit distance:
/// min(-ln(1 - opacity) / unitDistance, largest).
/// @param opacity  in [0, 1]; 1 has the extinction `largest`; 0 and NaN have none
/// @param unitDistance  length over which a ray meets this opacity, > 0
/// @param largest  1/length
double ExtinctionOfOpacity(double opacity, double unitDistance, double largest);

/// Radiance that a half-space with isotropic scattering reflects along its normal if it is lit by a uniform radiance 1:
/// 1 - H(1, w) sqrt(1 - w), with Chandrasekhar's function H (numerics.md, Eq. (8f)). It increases from 0 to 1.
/// @param albedo  single-scattering albedo w, in [0, 1]
double NormalReflectance(double albedo);

/// Single-scattering albedo at which a half-space shows a colour along its normal, lit by a uniform radiance: inverse
/// of NormalReflectance, at most LargestAlbedo, and by similarity for a phase function that is not isotropic.
/// @param color  one channel, sRGB-encoded, in [0, 1]; values outside are clamped
/// @param g  mean cosine of the phase function, in (-1, 1)
double AlbedoOfColor(double color, double g);

/// A function of a scalar with several values, tabulated so that it is linear between nodes, and constant beyond the
/// first and the last. Means over an interval are exact for the tabulated function.
class CoefficientTable
{
public:
  /// Writes the function's values at a scalar.
  using Function = std::function<void(double scalar, double* values)>;

  /// Intervals between nodes are halved until the function's values at their eighths differ from the table's by at most
  /// 1e-3 of themselves plus 1e-6 of the largest value, at most 20 times.
  /// @param valueCount  values of the function, 1 to MostValues
  /// @param nodes  scalars at which the function has kinks, and any others, ascending; at least one
  CoefficientTable(const Function& function, int valueCount, const std::vector<double>& nodes);

  static constexpr int MostValues = 6;
  int ValueCount() const { return this->Count; }
  std::size_t NodeCount() const { return this->Nodes.size(); }

  /// Number of nodes between two scalars.
  int NodesBetween(double low, double high) const;

  /// Adds `weight` times the means of the values over the scalars between `from` and `to`, in either order, to `sums`.
  /// @param from, to  finite
  void AddMean(double from, double to, double weight, double* sums) const;

private:
  struct Node
  {
    double scalar;
    std::array<double, MostValues> values;
  };

  void Append(const Node& node);
  void AppendBetween(const Function& function, const Node& low, const Node& high, double smallest, int halvings);
  std::size_t IntervalOf(double scalar) const;
  void AddPart(std::size_t interval, double from, double to, double factor, double* sums) const;
  void Integrate();

  int Count;
  std::vector<double> Nodes;
  std::vector<double> Values;         ///< Count for each node
  std::vector<double> Integrals;      ///< Count for each node: integrals from the first node to this one
  std::vector<std::size_t> Intervals; ///< for each of equal parts of the nodes' range, the interval where it begins
};
}
