#include "Photons/Scattering/ScatteringForecast.h"

#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tyndall
{
namespace
{
constexpr double ManyScatterings = 1e5;     ///< scatterings of a photon from which on a march is warned of
constexpr std::size_t MostExamined = 10000; ///< number of photons of a rank that are examined
/// Extrapolation length of Milne's problem, transport mean free paths: the distance from a box at which the diffuse
/// light inside, extrapolated, vanishes.
constexpr double Extrapolation = 0.7104;
/// Absorption optical depth at which a photon's power is so small that it ends by Russian roulette (ScatterPhotons.cl).
constexpr double DepthToEnd = 3.0;

/// Mean length of the path of a photon that diffuses in a slab, until it leaves or ends.
/// @param transport  transport coefficient, 1 / length
/// @param ends  probability per length that it ends by absorption
/// @param depth, thickness  of the photon and of the slab, length
double PathInSlab(double transport, double ends, double depth, double thickness)
{
  const double beyond = Extrapolation / transport, left = depth + beyond, right = thickness - depth + beyond;
  const double k = std::sqrt(3.0 * transport * ends);
  return k * (left + right) < 1e-4
    ? 1.5 * transport * left * right
    : std::expm1(-k * left) * std::expm1(-k * right) / (ends * (1.0 + std::exp(-k * (left + right))));
}

/// Four times the volume of a box, divided by its surface: the mean length of paths from face to face, whatever
/// scatters in it.
double MeanPath(const Grid& grid)
{
  const double x = grid.Length(0), y = grid.Length(1), z = grid.Length(2);
  return 2.0 * x * y * z / (x * y + y * z + z * x);
}
}

ScatteringForecast::ScatteringForecast(const Domain& domain, const Medium& medium)
{
  std::vector<double> sums(9, 0.0);
  const std::size_t voxels = domain.IsEmpty() ? 0 : medium.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      sums[c] += medium.sigma_s.At(i, c);
      sums[3 + c] += medium.TransportSigmaS(i, c);
      sums[6 + c] += medium.sigma_a.At(i, c);
    }
  }
  sums = domain.Sum(sums);
  for (double& sum : sums)
  {
    sum /= static_cast<double>(domain.Whole().VoxelCount());
  }
  std::copy_n(sums.begin(), 3, this->Scattering.begin());
  std::copy_n(sums.begin() + 3, 3, this->Transport.begin());
  std::copy_n(sums.begin() + 6, 3, this->Absorption.begin());
}

double ScatteringForecast::Scatterings(const Grid& whole, const Photon& photon, int channel) const
{
  const double scatters = this->Scattering[channel], transport = this->Transport[channel];
  if (scatters <= 0.0 || transport <= 0.0)
  {
    return 0.0;
  }
  const double ends = this->Absorption[channel] / DepthToEnd;
  double perLength = -2.0 * ends; // reciprocal of the path's length; each axis counts absorption
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = whole.Length(axis), start = photon.position[axis] - whole.origin[axis];
    const double depth = std::clamp(start + photon.direction[axis] / transport, 0.0, length);
    const double path = PathInSlab(transport, ends, depth, length);
    if (start <= 0.0 || start >= length)
    {
      // Light that enters through a face leaves by the sides, too, unless it is absorbed before.
      const double part = path / PathInSlab(transport, 0.0, depth, length);
      return scatters * path * std::pow(MeanPath(whole) / (2.0 * length), part);
    }
    perLength += 1.0 / path;
  }
  return scatters / perLength;
}

double ScatteringForecast::Scatterings(const Domain& domain, const std::vector<Photon>& share) const
{
  std::vector<double> sums(4, 0.0);
  const std::size_t stride = share.size() / MostExamined + 1;
  for (std::size_t i = 0; i < share.size(); i += stride)
  {
    for (int c = 0; c < 3; ++c)
    {
      sums[c] += this->Scatterings(domain.Whole(), share[i], c);
    }
    sums[3] += 1.0;
  }
  sums = domain.Sum(sums);
  return std::max({ sums[0], sums[1], sums[2] }) / std::max(sums[3], 1.0);
}

std::string ScatteringForecast::Warning(const Domain& domain, const std::vector<Photon>& share, int maximumOrders) const
{
  const double each = this->Scatterings(domain, share);
  const double followed = maximumOrders > 0 ? std::min(each, maximumOrders - 1.0) : each;
  const double all = followed * domain.Sum(static_cast<double>(share.size()));
  return followed > ManyScatterings ? "Each photon is scattered some " + Text("%.0e", followed) +
      " times before it leaves the medium or is absorbed, " + Text("%.0e", all) +
      " times in all, at some 1e7 a second and core. Take fewer photons, set MaximumOrders to 1 and "
      "compute scattered light by Light Propagation Maps (Uncollided Light), or use those alone."
                                    : "";
}
}
