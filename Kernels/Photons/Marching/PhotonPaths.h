#pragma once

#include "Photons/Marching/MarchMedium.h"

namespace tyndall
{
/// What PhotonMarcher::Paths does.
std::vector<PhotonPath> TracePaths(
  const MarchMedium& medium, const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen);
}
