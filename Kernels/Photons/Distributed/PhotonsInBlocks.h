#pragma once

#include "Photons/Distributed/TurnsInBlocks.h"
#include "Photons/Marching/PhotonMarcher.h"

namespace tyndall
{
/// PhotonMarcher, constructed from a communicator and a partition in place of a Domain.
class PhotonMarcherInBlocks : public PhotonMarcher
{
public:
  PhotonMarcherInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels = nullptr)
    : PhotonMarcher(device, Domain(communicator, partition), medium, ior, settings, levels)
  {
  }
};
}
