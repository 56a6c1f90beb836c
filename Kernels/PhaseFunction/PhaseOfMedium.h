#pragma once

#include "Device/HostThreads.h"
#include "Medium/Field.h"
#include "PhaseFunction/PhaseFunction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tyndall
{
/// Phase function of a medium: one function for all voxels and channels, one per channel, or one kind of function with
/// a mean cosine by voxel (e.g. a mixture of droplets and haze).
class PhaseOfMedium
{
public:
  PhaseOfMedium() = default; ///< creates an isotropic phase function for all voxels and channels
  /// Implicit conversion: one phase function for all voxels and channels.
  PhaseOfMedium(const PhaseFunction& ofAll);
  explicit PhaseOfMedium(const std::array<PhaseFunction, 3>& ofChannels);
  /// One kind of function with a mean cosine by voxel.
  /// @param kind  a kind with one mean cosine (PhaseFunction::WithMeanCosine), else InvalidInput is thrown
  /// @param g  mean cosine by voxel, which replaces that of `kind`; not owned
  PhaseOfMedium(const PhaseFunction& kind, const Field& g);

  /// Phase function of a channel. Requires that g does not vary by voxel.
  const PhaseFunction& OfChannel(int channel) const { return this->Functions[channel]; }
  const Field& G() const { return this->ByVoxel; } ///< mean cosine by voxel; has no values if g does not vary
  bool Varies() const { return this->ByVoxel.values != nullptr; }

  /// Whether scattering is isotropic. False if g varies by voxel, even if all its values are 0.
  bool IsIsotropic() const { return !this->Varies() && this->Functions[0].IsIsotropic() && !this->HasColour(); }
  bool HasColour() const;
  double MeanCosine(std::size_t voxel, int channel) const
  {
    return this->Varies() ? this->ByVoxel.At(voxel, channel) : this->MeanCosines[channel];
  }
  /// Phase function of a voxel in a channel.
  PhaseFunction At(std::size_t voxel, int channel) const;
  /// The same kind of phase function with other mean cosines `g` by voxel, which may be on another grid.
  PhaseOfMedium WithG(const Field& g) const { return PhaseOfMedium(this->Functions[0], g); }
  /// Phase function for a scene that is solved in one channel: all channels have the function of `channel`.
  PhaseOfMedium Seen(int channel) const;

private:
  std::array<PhaseFunction, 3> Functions;
  std::array<double, 3> MeanCosines = {};
  Field ByVoxel;
};

// Mean cosines by voxel are used only in voxels that scatter. In other voxels they may have any value, even NaN.

/// Smallest and largest mean cosine g of the voxels that scatter, by channel; infinity and minus infinity for a channel
/// in which no voxel scatters.
struct MeanCosineRange
{
  MeanCosineRange()
  {
    this->least.fill(std::numeric_limits<double>::infinity());
    this->greatest.fill(-std::numeric_limits<double>::infinity());
  }
  /// Computes the range of g over the voxels that scatter.
  /// @param g, sigma_s  fields over `voxels` voxels
  MeanCosineRange(const Field& g, const Field& sigma_s, std::size_t voxels)
    : MeanCosineRange()
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        if (sigma_s.At(i, c) > 0.0f)
        {
          this->least[c] = std::min<double>(this->least[c], g.At(i, c));
          this->greatest[c] = std::max<double>(this->greatest[c], g.At(i, c));
        }
      }
    }
  }

  bool IsEven() const ///< whether g is uniform in each channel
  {
    bool even = true;
    for (std::size_t c = 0; c < 3; ++c)
    {
      even = even && this->least[c] >= this->greatest[c];
    }
    return even;
  }

  std::array<double, 3> least, greatest;
};

/// Phase function of a medium with g by voxel. If all voxels that scatter have the same g, it is one function per
/// channel, otherwise a function by voxel. A channel in which no voxel scatters has the g of another channel.
/// @param kind  a kind with one mean cosine (PhaseFunction::WithMeanCosine), else InvalidInput is thrown
/// @param range  range of g in the domain; `g` itself may cover a subdomain
inline PhaseOfMedium PhaseByVoxel(const PhaseFunction& kind, const Field& g, const MeanCosineRange& range)
{
  if (!range.IsEven())
  {
    return PhaseOfMedium(kind, g);
  }
  double any = 0.0;
  for (const double cosine : range.least)
  {
    any = std::isfinite(cosine) ? cosine : any;
  }
  std::array<PhaseFunction, 3> functions;
  std::transform(range.least.begin(), range.least.end(), functions.begin(),
    [&](double cosine) { return kind.WithMeanCosine(std::isfinite(cosine) ? cosine : any); });
  return PhaseOfMedium(functions);
}

/// Replaces mean cosines outside (-1, 1), which checks would reject, in voxels that do not scatter.
/// @return g with such values replaced by 0; empty if there are none to replace
inline std::vector<float> WithoutUnusedCosines(const Field& g, const Field& sigma_s, std::size_t voxels)
{
  const auto components = static_cast<std::size_t>(g.components);
  const std::size_t count = g.values ? voxels * components : 0;
  const auto isUnused = [&](std::size_t i) {
    const auto scatters = [&](int channel) { return sigma_s.At(i / components, channel) > 0.0f; };
    const bool used = components == 3 ? scatters(static_cast<int>(i % 3)) : scatters(0) || scatters(1) || scatters(2);
    return !used && !(std::abs(g.values[i]) < 1.0f);
  };
  if (!AnyInThreads(count, isUnused))
  {
    return {};
  }
  std::vector<float> used(g.values, g.values + count);
  for (std::size_t i = 0; i < count; ++i)
  {
    used[i] = isUnused(i) ? 0.0f : used[i];
  }
  return used;
}
}
