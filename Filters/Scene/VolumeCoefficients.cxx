#include "Scene/VolumeCoefficients.h"

#include "Device/Errors.h"
#include "Medium/Classification.h"
#include "Numerics/Legendre.h"
#include "Numerics/NumberText.h"
#include "Numerics/Srgb.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tyndall
{
namespace
{
/// Adds the scalars of a function's nodes, vtkPiecewiseFunction or vtkColorTransferFunction, within a range.
template <int ValuesOfNode, class Function>
void AddNodes(Function* function, const ScalarRange& range, std::vector<double>& nodes)
{
  for (int i = 0; i < function->GetSize(); ++i)
  {
    double node[ValuesOfNode];
    function->GetNodeValue(i, node);
    if (node[0] > range[0] && node[0] < range[1])
    {
      nodes.push_back(node[0]);
    }
  }
}

/// Transfer functions of one component.
struct Functions
{
  Functions(vtkVolumeProperty* property, int component)
    : Opacity(property->GetScalarOpacity(component))
    , Gray(property->GetColorChannels(component) == 1 ? property->GetGrayTransferFunction(component) : nullptr)
    , Colors(this->Gray ? nullptr : property->GetRGBTransferFunction(component))
    , UnitDistance(property->GetScalarOpacityUnitDistance(component))
  {
    Require(this->UnitDistance > 0.0 && std::isfinite(this->UnitDistance),
      "The unit distance of the scalar opacity is " + Text("%g", this->UnitDistance) +
        "; it must be positive: the length over which a ray meets the opacity.");
  }

  /// The colour, sRGB-encoded. As vtkVolume does, it interpolates between nodes also if the colour map is discretised
  /// or categorical.
  void ColorAt(double scalar, double* rgb) const
  {
    if (this->Gray)
    {
      std::fill_n(rgb, 3, this->Gray->GetValue(scalar));
      return;
    }
    this->Colors->GetTable(scalar, scalar, 1, rgb);
  }

  std::vector<double> Nodes(const ScalarRange& range) const
  {
    std::vector<double> nodes = { range[0], range[1] };
    AddNodes<4>(this->Opacity, range, nodes);
    if (this->Gray)
    {
      AddNodes<4>(this->Gray, range, nodes);
    }
    else
    {
      AddNodes<6>(this->Colors, range, nodes);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  bool IsGrey(const ScalarRange& range) const
  {
    const std::vector<double> nodes = this->Nodes(range);
    return this->Gray || std::all_of(nodes.begin(), nodes.end(), [&](double scalar) {
      double rgb[3];
      this->ColorAt(scalar, rgb);
      const auto [low, high] = std::minmax({ rgb[0], rgb[1], rgb[2] });
      return high - low < 1e-3; // color spaces round
    });
  }

  vtkPiecewiseFunction* Opacity;
  vtkPiecewiseFunction* Gray;
  vtkColorTransferFunction* Colors;
  double UnitDistance;
};

double ExtinctionAt(const VolumeAppearance& appearance, const Functions& functions, double scalar)
{
  return appearance.factor *
    ExtinctionOfOpacity(
      functions.Opacity->GetValue(scalar), functions.UnitDistance, ThickestVoxel / appearance.shortestSpacing);
}

/// What a channel's colour stands for: albedo, or radiance that a thick medium emits.
double MeaningOf(const VolumeAppearance& appearance, double color, int channel)
{
  return appearance.colorIsEmission ? DecodeSrgb(std::clamp(color, 0.0, 1.0))
                                    : AlbedoOfColor(color, appearance.g[channel]);
}

/// Writes the coefficients of an extinction and of what its colour stands for, one per channel.
void Write(const VolumeCoefficients& of, double extinction, const double* meaning, double weight, double* sums)
{
  if (of.IsEmission)
  {
    sums[0] += weight * extinction;
  }
  for (int c = 0; c < of.Channels; ++c)
  {
    sums[of.IsEmission ? 1 + c : c] += weight * extinction * meaning[c];
    if (!of.IsEmission)
    {
      sums[of.Channels + c] += weight * extinction * (1.0 - meaning[c]);
    }
  }
}

/// One component, or the weighted sum of several independent ones.
class IndependentCoefficients : public VolumeCoefficients
{
public:
  IndependentCoefficients(const VolumeAppearance& appearance, const std::vector<ScalarRange>& ranges)
  {
    this->IsEmission = appearance.colorIsEmission;
    std::vector<Functions> functions;
    for (std::size_t i = 0; i < ranges.size(); ++i)
    {
      functions.emplace_back(appearance.property, static_cast<int>(i));
      this->Channels = functions[i].IsGrey(ranges[i]) ? this->Channels : 3;
      this->Weights.push_back(ranges.size() > 1 ? appearance.property->GetComponentWeight(static_cast<int>(i)) : 1.0);
    }
    // A mean cosine by channel makes three albedos of a grey colour.
    this->Channels = IsGrey(appearance.g) || this->IsEmission ? this->Channels : 3;
    for (std::size_t i = 0; i < ranges.size(); ++i)
    {
      const auto coefficients = [&](double scalar, double* values) {
        double rgb[3], meaning[3];
        functions[i].ColorAt(scalar, rgb);
        for (int c = 0; c < 3; ++c)
        {
          meaning[c] = MeaningOf(appearance, rgb[c], c);
        }
        std::fill_n(values, this->ValueCount(), 0.0);
        Write(*this, ExtinctionAt(appearance, functions[i], scalar), meaning, 1.0, values);
      };
      this->Tables.emplace_back(coefficients, this->ValueCount(), functions[i].Nodes(ranges[i]));
    }
  }

  int KinksBetween(const double* low, const double* high) const override
  {
    int kinks = 0;
    for (std::size_t i = 0; i < this->Tables.size(); ++i)
    {
      kinks += this->Tables[i].NodesBetween(low[i], high[i]);
    }
    return kinks;
  }

  void AddMean(const double* from, const double* to, double weight, double* sums) const override
  {
    for (std::size_t i = 0; i < this->Tables.size(); ++i)
    {
      this->Tables[i].AddMean(from[i], to[i], weight * this->Weights[i], sums);
    }
  }

private:
  std::vector<CoefficientTable> Tables; ///< for each component
  std::vector<double> Weights;
};

/// Opacity by the last component; colour by the first of two, or in the first three of four.
class DependentCoefficients : public VolumeCoefficients
{
public:
  DependentCoefficients(const VolumeAppearance& appearance, const std::vector<ScalarRange>& ranges)
    : Direct(ranges.size() == 4)
  {
    this->IsEmission = appearance.colorIsEmission;
    const Functions functions(appearance.property, 0);
    this->Channels = !this->Direct && functions.IsGrey(ranges[0]) && IsGrey(appearance.g) ? 1 : 3;
    this->Opacity.emplace([&](double scalar, double* value) { *value = ExtinctionAt(appearance, functions, scalar); },
      1, functions.Nodes(ranges.back()));
    const auto meaning = [&](double scalar, double* values) {
      double rgb[3] = { scalar / 255.0, scalar / 255.0, scalar / 255.0 };
      if (!this->Direct)
      {
        functions.ColorAt(scalar, rgb);
      }
      for (int c = 0; c < 3; ++c)
      {
        values[c] = MeaningOf(appearance, rgb[c], c);
      }
    };
    this->Meaning.emplace(meaning, 3, this->Direct ? std::vector<double>{ 0.0, 255.0 } : functions.Nodes(ranges[0]));
  }

  /// At least 1: a product of linear functions is not linear.
  int KinksBetween(const double* low, const double* high) const override
  {
    int kinks = 1;
    for (int i = 0; i < (this->Direct ? 4 : 2); ++i)
    {
      const bool isOpacity = i == (this->Direct ? 3 : 1);
      kinks += (isOpacity ? this->Opacity : this->Meaning)->NodesBetween(low[i], high[i]);
    }
    return kinks;
  }

  /// Gauss quadrature of three points: the coefficients are products of functions of two components.
  void AddMean(const double* from, const double* to, double weight, double* sums) const override
  {
    static const GaussLegendre quadrature(3);
    const int last = this->Direct ? 3 : 1;
    const auto at = [&](int component, double part) {
      return from[component] + part * (to[component] - from[component]);
    };
    for (std::size_t point = 0; point < quadrature.points.size(); ++point)
    {
      double extinction = 0.0, meaning[3] = {};
      const double part = 0.5 + 0.5 * quadrature.points[point];
      const double opaque = at(last, part);
      this->Opacity->AddMean(opaque, opaque, 1.0, &extinction);
      for (int c = 0; c < (this->Direct ? 3 : 1); ++c)
      {
        const double color = at(c, part);
        double all[3] = {};
        this->Meaning->AddMean(color, color, 1.0, all);
        std::copy(all + c, all + 3, meaning + c);
      }
      Write(*this, extinction, meaning, 0.5 * weight * quadrature.weights[point], sums);
    }
  }

private:
  bool Direct;                             ///< whether the first three components are the colour itself
  std::optional<CoefficientTable> Opacity; ///< extinction
  std::optional<CoefficientTable> Meaning; ///< what the colour stands for, 3 values
};
}

std::unique_ptr<VolumeCoefficients> CoefficientsOf(
  const VolumeAppearance& appearance, const std::vector<ScalarRange>& ranges)
{
  vtkVolumeProperty* const property = appearance.property;
  const std::size_t components = ranges.size();
  Require(property->GetTransferFunctionMode() == vtkVolumeProperty::TF_1D,
    "The volume property has transfer functions of two dimensions, which are not supported: call "
    "SetTransferFunctionModeTo1D, with functions of the scalars alone.");
  for (std::size_t i = 0; i < components; ++i)
  {
    const int component = static_cast<int>(i);
    Require(!property->HasGradientOpacity(component) || property->GetDisableGradientOpacity(component),
      "The volume property has a gradient opacity, which is not supported: call DisableGradientOpacityOn.");
  }
  if (components == 1 || property->GetIndependentComponents())
  {
    Require(components <= 4,
      "The scalars have " + std::to_string(components) +
        " components; independent ones may be 4 at most. Choose the magnitude or one component by VectorMode.");
    return std::make_unique<IndependentCoefficients>(appearance, ranges);
  }
  Require(components == 2 || components == 4,
    "The scalars have " + std::to_string(components) +
      " components that depend on each other; there must be 2 (colour, opacity) or 4 (red, green, blue, opacity).");
  return std::make_unique<DependentCoefficients>(appearance, ranges);
}
}
