#pragma once

#include "Comparison/ConvergedLight.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// Means over independent sets of photons, per voxel and channel, and standard errors of these means.
class MeansOfSets
{
public:
  /// Adds the light of one set of photons.
  /// @param channels  1 or 3; light of one channel is used for all channels
  void Add(const std::vector<float>& values, int channels);

  int Count() const { return this->Sets; }
  int Channels() const { return this->OfVoxel; } ///< largest number of channels of any set that was added
  std::vector<float> Values() const;

  /// Sum of the squared standard errors of the means over voxels and channels; needs at least two sets.
  double Variance() const;
  double SumOfSquares() const; ///< sum of the squared means over voxels and channels
  /// Relative standard error: ratio of the root mean squares of the standard errors and of the means.
  double RelativeError() const;

  /// Lower estimate of the squared error of other light on the same voxels, at least 0. It is the squared distance of
  /// that light from the means, minus the part of it that is expected from the photons' noise alone, minus twice the
  /// standard deviation of this part.
  double SquaredErrorOf(const std::vector<float>& other, int channels) const;

private:
  void Widen(int channels);

  std::vector<double> Sums, Squares;
  int Sets = 0, OfVoxel = 1;
};

/// Reference by photons without a filter, in sixteen to sixty-four independent sets; ReferenceLight::text states the
/// standard error. If ComparedSettings::scattersReference is set, photons are scattered until they are absorbed or
/// leave. If `monitor` throws TimeIsUp after four or more sets, the sets so far are the result.
/// @param set  photons per set
/// @param seconds  time that sets beyond sixteen may take, by NominalSeconds
/// @param maps  light propagation maps whose uncollided light is used if it does not differ significantly from that of
///   the photons; null: none
ReferenceLight ReferenceOfPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  std::size_t set, double seconds, const LightField* maps, const Monitor& monitor);

/// Forecast of whether Monte Carlo photons give a better reference than the compared methods within a given time.
struct PhotonForecast
{
  static constexpr double PartOfTime = 0.5; ///< fraction of the available time that the forecast may take

  bool beats = false;
  /// Number of photons per set, for sixteen sets. With this number the standard error is a tenth of the error of the
  /// light propagation maps, unless the time allows only fewer photons.
  std::size_t photonsOfASet = 0;
  std::string why; ///< explanation for the user, with the errors of photons and maps
  /// The finest light propagation maps that are compared; no value if they take too long or do not fit the device.
  std::optional<LightField> maps;
};

/// Compares a few photons with the finest light propagation maps on the scene's own grid. The squared error of the maps
/// is taken as the mean square of the difference, minus the photons' variance, minus twice the standard deviation of
/// this variance. Photons are forecast to be better in two cases: if with as many photons as the time allows the
/// standard error is at most a third of the maps' error, or if even maps of few directions take more than a quarter of
/// the time. All times are NominalSeconds.
/// @param seconds  time for forecast and reference together
PhotonForecast ForecastOfPhotons(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor);
}
