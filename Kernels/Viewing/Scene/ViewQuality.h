#pragma once

#include "Light/Quality.h"
#include "Viewing/Scene/ViewSettings.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Settings of a quality: the step of rays and the samples of rectangular lights, as far as `settings` has them at
/// their default values.
ViewSettings AtQuality(Quality quality, ViewSettings settings);

/// "Name = value" of each setting that a quality may choose.
std::vector<std::string> Words(const ViewSettings& settings);
}
