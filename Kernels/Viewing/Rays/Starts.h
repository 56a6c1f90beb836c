#pragma once

#include <vector>

namespace tyndall
{
/// What comes through the blocks before one that is to be looked at again, 3 per pixel of the picture; 0 where nothing
/// is looked for. Empty: nowhere.
struct Starts
{
  std::vector<float> transmittance, seen; ///< as Picture's transmittance and sceneTransmittance

  bool IsEmpty() const { return this->seen.empty(); }
};
}
