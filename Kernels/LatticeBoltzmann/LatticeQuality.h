#pragma once

#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/Quality.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Settings of a quality: links of the lattice and tolerance, as far as `settings` has them at their default values.
/// What diffusion itself is off by no level takes away.
LatticeSettings AtQuality(Quality quality, LatticeSettings settings);

/// "Name = value" of each setting that a quality may choose.
std::vector<std::string> Words(const LatticeSettings& settings);
}
