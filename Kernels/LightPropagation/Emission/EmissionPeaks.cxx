#include "LightPropagation/Emission/EmissionPeaks.h"

#include "Distribution/BoxExchange.h"
#include "Medium/VoxelBox.h"
#include "Medium/VoxelSums.h"

#include <array>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
/// Ratio of emission to absorbed incident light up to which a voxel counts as self-absorbing.
constexpr double Hides = 2.0;
constexpr double PartOfOne = 0.01; ///< minimum fraction of the medium's emitted power that each peak carries
constexpr std::size_t MostPeaks = 16;
constexpr double Widest = 0.125; ///< maximum width of a peak, relative to the box's longest edge
constexpr double Hidden = 4.6;   ///< optical length beyond which a peak is not visible (transmittance 1%)
constexpr double Opaque = 3e4;   ///< optical thickness of a voxel above which its emission is swept, not a peak
/// Distance from a peak, in widths of the peak, over which the surrounding medium must be transparent.
constexpr double Clear = 1.5;

using Voxel = std::array<int, 3>;

Voxel VoxelAt(const Grid& grid, std::size_t index)
{
  const std::size_t nx = static_cast<std::size_t>(grid.size[0]);
  const std::size_t ny = static_cast<std::size_t>(grid.size[1]);
  return { static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / (nx * ny)) };
}

std::size_t IndexOf(const Grid& grid, const Voxel& v)
{
  return (static_cast<std::size_t>(v[2]) * grid.size[1] + v[1]) * grid.size[0] + v[0];
}

/// Voxels that emit far more than the mean of all other voxels.
struct BrightVoxels
{
  std::vector<std::size_t> voxels; ///< indices of the bright voxels, ascending
  double limit = 0.0;              ///< brightness, W / (length^3 sr): emission above it belongs to a peak
  double all = 0.0;                ///< sum of the brightness of all voxels of the medium
  double Above(const Field& emission, std::size_t voxel) const
  {
    return EmissionBrightness(emission, voxel) - this->limit;
  }
};

BrightVoxels FindBright(const Medium& medium)
{
  BrightVoxels bright;
  const std::size_t voxels = medium.grid.VoxelCount();
  const std::size_t most = voxels / EmissionBrightPart;
  if (!medium.emission.values || most == 0)
  {
    return bright;
  }
  std::vector<double> sorted(voxels);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    sorted[i] = EmissionBrightness(medium.emission, i);
    bright.all += sorted[i];
  }
  std::nth_element(sorted.begin(), sorted.begin() + most, sorted.end(), std::greater<double>());
  // brightness of the brightest voxel that is not among the brightest 64th of the voxels; emission up to this value
  // occurs in too many voxels to be a peak
  const double next = sorted[most];
  double rest = 0.0;
  for (std::size_t i = most; i < voxels; ++i)
  {
    rest += sorted[i];
  }
  bright.limit = std::max(next, EmissionOutshines * rest / static_cast<double>(voxels - most));
  double above = 0.0;
  for (std::size_t i = 0; i < most; ++i)
  {
    above += std::max(0.0, sorted[i] - bright.limit);
  }
  if (above < EmissionPartOfAll * bright.all || above == 0.0)
  {
    return bright;
  }
  for (std::size_t i = 0; i < voxels; ++i)
  {
    if (bright.Above(medium.emission, i) > 0.0)
    {
      bright.voxels.push_back(i);
    }
  }
  return bright;
}

/// Sorts voxels into connected groups; voxels that share a face, an edge or a corner are connected.
std::vector<std::vector<std::size_t>> Groups(const Grid& grid, const std::vector<std::size_t>& voxels)
{
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> taken(voxels.size(), false);
  for (std::size_t seed = 0; seed < voxels.size(); ++seed)
  {
    if (taken[seed])
    {
      continue;
    }
    taken[seed] = true;
    std::vector<std::size_t> group = { voxels[seed] };
    for (std::size_t next = 0; next < group.size(); ++next)
    {
      const Voxel at = VoxelAt(grid, group[next]);
      for (int n = 0; n < 27; ++n)
      {
        const Voxel beside = { at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1 };
        bool inside = true;
        for (int a = 0; a < 3; ++a)
        {
          inside = inside && beside[a] >= 0 && beside[a] < grid.size[a];
        }
        const auto found =
          inside ? std::lower_bound(voxels.begin(), voxels.end(), IndexOf(grid, beside)) : voxels.end();
        const std::size_t place = found - voxels.begin();
        if (found != voxels.end() && *found == IndexOf(grid, beside) && !taken[place])
        {
          taken[place] = true;
          group.push_back(*found);
        }
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

/// A peak with the bounding box of a group of voxels; its emission is not set.
EmissionPeak BoxAround(const Grid& grid, const std::vector<std::size_t>& group)
{
  EmissionPeak peak;
  Voxel last = VoxelAt(grid, group[0]);
  peak.first = last;
  for (std::size_t voxel : group)
  {
    const Voxel at = VoxelAt(grid, voxel);
    for (int a = 0; a < 3; ++a)
    {
      peak.first[a] = std::min(peak.first[a], at[a]);
      last[a] = std::max(last[a], at[a]);
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    peak.size[a] = last[a] - peak.first[a] + 1;
  }
  return peak;
}

/// Whether the width of a peak is at most an eighth of the grid's longest edge.
bool IsSmall(const Grid& grid, const EmissionPeak& peak)
{
  return peak.Width(grid) <= Widest * std::max({ grid.Length(0), grid.Length(1), grid.Length(2) });
}

/// Optical lengths along straight lines through a medium.
class OpticalLength
{
public:
  explicit OpticalLength(const Medium& medium)
    : TheMedium(medium)
  {
  }

  /// @return optical length in each channel along `way` from a point (in voxels), over the length `reach` or until the
  ///   line leaves the box
  std::array<double, 3> Along(const std::array<double, 3>& from, const std::array<double, 3>& way, double reach) const
  {
    const Grid& grid = this->TheMedium.grid;
    const double step = 0.5 * std::min({ grid.spacing[0], grid.spacing[1], grid.spacing[2] });
    const int steps = static_cast<int>(std::min(std::ceil(reach / step), 10000.0));
    std::array<double, 3> length = {};
    for (int s = 0; s < steps; ++s)
    {
      Voxel at;
      for (int a = 0; a < 3; ++a)
      {
        at[a] = static_cast<int>(std::floor(from[a] + way[a] / grid.spacing[a] * reach * (s + 0.5) / steps));
        if (at[a] < 0 || at[a] >= grid.size[a])
        {
          return length;
        }
      }
      for (int c = 0; c < 3; ++c)
      {
        length[c] += this->TheMedium.TransportSigmaT(IndexOf(grid, at), c) * reach / steps;
      }
    }
    return length;
  }

private:
  const Medium& TheMedium;
};

/// Whether the medium around a peak is transparent in at least one direction and channel.
bool IsSeen(const Medium& medium, const EmissionPeak& peak)
{
  const Grid& grid = medium.grid;
  const OpticalLength optical(medium);
  std::array<double, 3> middle;
  for (int a = 0; a < 3; ++a)
  {
    middle[a] = peak.first[a] + 0.5 * peak.size[a];
  }
  double clearest = std::numeric_limits<double>::max();
  for (int n = 0; n < 27; ++n)
  {
    std::array<double, 3> way = { n % 3 - 1.0, n / 3 % 3 - 1.0, n / 9 - 1.0 };
    const double length = std::hypot(way[0], way[1], way[2]);
    if (length == 0.0)
    {
      continue;
    }
    double half = std::numeric_limits<double>::max(); // distance from the peak's centre to its border along `way`
    for (int a = 0; a < 3; ++a)
    {
      way[a] /= length;
      half = way[a] == 0.0 ? half : std::min(half, 0.5 * peak.size[a] * grid.spacing[a] / std::abs(way[a]));
    }
    const std::array<double, 3> inside = optical.Along(middle, way, half);
    const std::array<double, 3> outside = optical.Along(middle, way, half + Clear * peak.Width(grid));
    for (int c = 0; c < 3; ++c)
    {
      clearest = std::min(clearest, outside[c] - inside[c]);
    }
  }
  return clearest <= Hidden;
}

/// Whether a voxel around a peak scatters and is optically thick. Light of the peak is scattered close to the side
/// through which it enters such a voxel, and much of it returns through that side. If the light is traced along exact
/// rays (EmissionRays.h), its scattered light starts uniformly in the voxel instead; sweeps account for the side.
bool IsBesideThickScatterer(const Medium& medium, const EmissionPeak& peak)
{
  const Grid& grid = medium.grid;
  const double edge = std::max({ grid.spacing[0], grid.spacing[1], grid.spacing[2] });
  const double reach = Clear * peak.Width(grid);
  VoxelBox around;
  for (int a = 0; a < 3; ++a)
  {
    const int more = static_cast<int>(std::ceil(std::min(reach / grid.spacing[a], 1.0 * grid.size[a])));
    around.first[a] = std::max(peak.first[a] - more, 0);
    around.size[a] = std::min(peak.first[a] + peak.size[a] + more, grid.size[a]) - around.first[a];
  }
  const VoxelBox own = { peak.first, peak.size };
  bool thick = false;
  for (std::size_t i = 0; i < around.VoxelCount() && !thick; ++i)
  {
    const Voxel at = around.VoxelAt(i), within = own.Within(at);
    bool outside = false;
    for (int a = 0; a < 3; ++a)
    {
      outside = outside || within[a] < 0 || within[a] >= own.size[a];
    }
    for (int c = 0; outside && c < medium.Channels(); ++c)
    {
      thick = thick || edge * medium.TransportSigmaS(IndexOf(grid, at), c) > Hidden;
    }
  }
  return thick;
}

/// Whether any voxel of a group is so optically thick that light escaping from it cannot be resolved in single
/// precision.
bool IsOpaque(const Medium& medium, const std::vector<std::size_t>& group)
{
  const std::array<double, 3>& h = medium.grid.spacing;
  const double edge = std::max({ h[0], h[1], h[2] });
  return std::any_of(group.begin(), group.end(), [&](std::size_t voxel) {
    double sigma_t = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      sigma_t = std::max<double>(sigma_t, medium.TransportSigmaT(voxel, c));
    }
    return sigma_t * edge > Opaque;
  });
}

/// Whether every voxel of a group absorbs about as much of the incident light as it emits, in every channel.
bool IsSelfAbsorbing(const Medium& medium, const std::vector<std::size_t>& group, const Rgb& comesIn)
{
  return std::all_of(group.begin(), group.end(), [&](std::size_t voxel) {
    bool hides = true;
    for (int c = 0; c < 3; ++c)
    {
      const double absorbs = static_cast<double>(medium.sigma_a.At(voxel, c)) * comesIn[c];
      hides = hides && medium.emission.At(voxel, c) <= Hides * absorbs;
    }
    return hides;
  });
}

/// For each voxel of a group, moves the part of the emission that exceeds the limit to `peak`; the remainder stays in
/// `smooth`.
void Take(const Medium& medium, const BrightVoxels& bright, const std::vector<std::size_t>& group, EmissionPeak& peak,
  std::vector<float>& smooth)
{
  const std::size_t count = static_cast<std::size_t>(peak.size[0]) * peak.size[1] * peak.size[2];
  const Field& emission = medium.emission;
  const int components = emission.HasColour() ? 3 : 1;
  peak.emission.assign(3 * count, 0.0f);
  for (std::size_t voxel : group)
  {
    const Voxel at = VoxelAt(medium.grid, voxel);
    const std::size_t place =
      (static_cast<std::size_t>(at[2] - peak.first[2]) * peak.size[1] + at[1] - peak.first[1]) * peak.size[0] + at[0] -
      peak.first[0];
    const double kept = bright.limit / EmissionBrightness(emission, voxel);
    for (int c = 0; c < 3; ++c)
    {
      const float all = emission.At(voxel, c);
      const float stays = static_cast<float>(all * kept);
      peak.emission[c * count + place] = all - stays;
      if (c < components)
      {
        smooth[voxel * components + c] = stays;
      }
    }
  }
}
}

double EmissionBrightness(const Field& emission, std::size_t voxel)
{
  return (static_cast<double>(emission.At(voxel, 0)) + emission.At(voxel, 1) + emission.At(voxel, 2)) / 3.0;
}

SplitEmission Split(const Medium& medium, const Rgb& comesIn)
{
  struct Candidate
  {
    double power;
    std::vector<std::size_t> group;
    EmissionPeak peak;
  };
  const BrightVoxels bright = FindBright(medium);
  std::vector<Candidate> candidates;
  for (std::vector<std::size_t>& group : Groups(medium.grid, bright.voxels))
  {
    double power = 0.0;
    for (std::size_t voxel : group)
    {
      power += bright.Above(medium.emission, voxel);
    }
    if (power < PartOfOne * bright.all)
    {
      continue;
    }
    const EmissionPeak peak = BoxAround(medium.grid, group);
    if (IsSmall(medium.grid, peak) && !IsOpaque(medium, group) && IsSeen(medium, peak) &&
      !IsBesideThickScatterer(medium, peak) && !IsSelfAbsorbing(medium, group, comesIn))
    {
      candidates.push_back({ power, std::move(group), peak });
    }
  }
  std::stable_sort(
    candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.power > b.power; });
  candidates.resize(std::min(candidates.size(), MostPeaks));
  double power = 0.0;
  for (const Candidate& candidate : candidates)
  {
    power += candidate.power;
  }
  SplitEmission split;
  if (candidates.empty() || power < EmissionPartOfAll * bright.all)
  {
    return split;
  }
  split.components = medium.emission.HasColour() ? 3 : 1;
  split.smooth.resize(medium.grid.VoxelCount() * split.components);
  for (std::size_t i = 0; i < split.smooth.size(); ++i)
  {
    split.smooth[i] = medium.emission.At(i / split.components, static_cast<int>(i % split.components));
  }
  for (Candidate& candidate : candidates)
  {
    Take(medium, bright, candidate.group, candidate.peak, split.smooth);
    split.peaks.push_back(std::move(candidate.peak));
  }
  return split;
}

namespace
{
/// Histogram of the brightness of all ranks' voxels: number of voxels and sum of their brightness in each bin.
class BrightnessBins
{
public:
  BrightnessBins(const Domain& domain, const Medium& medium)
    : Counts(Bins, 0.0)
    , Sums(Bins, 0.0)
  {
    const std::size_t voxels = medium.emission.values ? medium.grid.VoxelCount() : 0;
    double brightest = 0.0;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      brightest = std::max(brightest, EmissionBrightness(medium.emission, i));
    }
    this->Brightest = domain.Max(brightest);
    for (std::size_t i = 0; i<voxels&& this->Brightest> 0.0; ++i)
    {
      const double brightness = EmissionBrightness(medium.emission, i);
      const std::size_t bin = this->BinOf(brightness);
      this->Counts[bin] += 1.0;
      this->Sums[bin] += brightness;
    }
    this->Counts = domain.Sum(this->Counts);
    this->Sums = domain.Sum(this->Sums);
  }

  /// Whether half of the emitted power may be emission of the brightest `most` voxels above the limit that Split()
  /// uses. This emission is overestimated: if one voxel of a bin is among the brightest, all voxels of that bin count.
  bool IsDominatedByFewVoxels(double most) const
  {
    double all = 0.0, bright = 0.0, counted = 0.0, voxels = 0.0;
    std::size_t end = 0; // one past the bin that contains the last of the brightest voxels
    for (std::size_t bin = 0; bin < Bins; ++bin)
    {
      all += this->Sums[bin];
      voxels += this->Counts[bin];
      if (counted < most)
      {
        counted += this->Counts[bin];
        bright += this->Sums[bin];
        end = bin + 1;
      }
    }
    const double limit = std::max(this->LowestOf(end - 1), EmissionOutshines * (all - bright) / voxels);
    double above = 0.0;
    for (std::size_t bin = 0; bin < end; ++bin)
    {
      above += std::max(0.0, this->Sums[bin] - limit * this->Counts[bin]);
    }
    return above > 0.0 && above >= EmissionPartOfAll * all;
  }

private:
  /// Number of bins, each an eighth of an octave wide; the last one holds all darker voxels.
  static constexpr std::size_t Bins = 512;
  static constexpr double PerOctave = 8.0;

  std::size_t BinOf(double brightness) const
  {
    const double octaves = brightness > 0.0 ? std::log2(this->Brightest / brightness) : 1e9;
    return static_cast<std::size_t>(std::clamp(octaves * PerOctave, 0.0, Bins - 1.0));
  }
  double LowestOf(std::size_t bin) const
  {
    return bin + 1 < Bins ? this->Brightest * std::exp2(-(bin + 1.0) / PerOctave) : 0.0;
  }

  std::vector<double> Counts, Sums;
  double Brightest = 0.0;
};
}

bool HasExactEmission(const PropagationProblem& problem)
{
  constexpr std::size_t MostOnRanks = std::size_t(1) << 24;
  const PropagationSettings& settings = problem.Settings();
  return settings.emissionError > 0.0 && !settings.IsPeriodic() &&
    (problem.TheDomain().IsSerial() || problem.Whole().VoxelCount() <= MostOnRanks);
}

SplitEmission SplitOfDomain(const PropagationProblem& problem, const Rgb& comesIn)
{
  const Domain& domain = problem.TheDomain();
  if (!HasExactEmission(problem) || !problem.Traits().emits)
  {
    return {};
  }
  if (domain.IsSerial())
  {
    return Split(problem.TheMedium(), comesIn);
  }
  if (!MayHaveEmissionPeaks(problem))
  {
    return {};
  }
  const Medium& own = problem.TheMedium();
  const int channels = problem.Channels();
  std::array<std::vector<float>, 3> values;
  const auto gather = [&](std::vector<float>& to, const auto& value) {
    std::vector<float> ofBlock(domain.Own().VoxelCount() * channels);
    for (std::size_t i = 0; i < ofBlock.size(); ++i)
    {
      ofBlock[i] = value(i / channels, static_cast<int>(i % channels));
    }
    to = ValuesOfGrid(domain.Comm(), domain.Partition(), ofBlock, channels);
    return Field{ to.data(), channels };
  };
  Medium all; // isotropic medium with the transport coefficients, the only ones that Split() uses
  all.grid = problem.Whole();
  all.sigma_a = gather(values[0], [&](std::size_t i, int c) { return own.sigma_a.At(i, c); });
  all.sigma_s = gather(values[1], [&](std::size_t i, int c) { return own.TransportSigmaS(i, c); });
  all.emission = gather(values[2], [&](std::size_t i, int c) { return own.emission.At(i, c); });
  SplitEmission split;
  domain.Collective([&] {
    split = Split(all, comesIn);
    split.smooth = split.peaks.empty() ? std::vector<float>()
                                       : PartOf(split.smooth, { {}, all.grid.size }, domain.Own(), split.components);
  });
  return split;
}

bool MayHaveEmissionPeaks(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  if (!problem.Traits().emits || settings.emissionError == 0.0 || settings.IsPeriodic())
  {
    return false;
  }
  const double most = std::floor(static_cast<double>(problem.Whole().VoxelCount()) / EmissionBrightPart);
  return most > 0.0 && BrightnessBins(problem.TheDomain(), problem.TheMedium()).IsDominatedByFewVoxels(most);
}
}
