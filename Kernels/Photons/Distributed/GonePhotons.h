#pragma once

#include "Device/Buffer.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
constexpr std::size_t MarchedBetweenBlocks = 262144; ///< photons of a launch: 30 MiB of those that go on

/// Room on a device for photons that a launch of a kernel puts, in any order, where they go on in other blocks.
template <class OnItsWay>
class GonePhotons
{
public:
  /// @param marched  photons of a launch at most
  GonePhotons(Device& device, std::size_t marched)
    : Photons(device, marched, "photons into other blocks")
    , Count(device, 1, "number of photons into other blocks")
  {
  }

  const Buffer<OnItsWay>& Room() const { return this->Photons; }
  const Buffer<cl_int>& Number() const { return this->Count; }
  void Empty() { this->Count.Fill(0); } ///< before a launch
  /// After it.
  void AppendTo(std::vector<OnItsWay>& all) const
  {
    const std::size_t before = all.size(), more = static_cast<std::size_t>(this->Count.Read().front());
    all.resize(before + more);
    this->Photons.Read(all.data() + before, more);
  }

private:
  Buffer<OnItsWay> Photons;
  Buffer<cl_int> Count;
};
}
