#pragma once

#include "Comparison/ConvergedLight.h"

#include <cstddef>
#include <optional>
#include <string>

namespace tyndall
{
/// Light of photons that are not filtered, in sixteen to sixty-four independent sets, of which its text says the
/// standard error; scattered until they end where ComparedSettings::scattersReference asks for it. Fewer sets, four at
/// least, where `monitor` throws TimeIsUp.
/// @param set  photons of a set
/// @param seconds  that sets beyond sixteen may take, by NominalSeconds
/// @param maps  whose unscattered light is taken where photons cannot tell it from theirs; null: none
ReferenceLight ReferenceOfPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  std::size_t set, double seconds, const LightField* maps, const Monitor& monitor);

/// Whether photons can beat the methods compared within a time.
struct PhotonForecast
{
  static constexpr double PartOfTime = 0.5; ///< of all, to forecast by

  bool beats = false;
  std::size_t photonsOfASet = 0; ///< of sixteen, for a tenth of what the maps are off by, or as many as the time allows
  std::string why;               ///< in words, with both errors
  std::optional<LightField> maps; ///< the finest that are tried; none where they take too long or do not fit
};

/// Looks at few photons, and at the finest maps that are tried on the scene's own grid. Of the mean square of their
/// difference the photons' variance is a part; the maps are off by the rest, less twice its standard deviation. The
/// standard error of as many photons as the time allows is to be at most a third of that. Where not even maps of few
/// directions take less than a quarter of the time, photons do. All times are NominalSeconds.
/// @param seconds  for forecast and reference together
PhotonForecast ForecastOfPhotons(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor);
}
