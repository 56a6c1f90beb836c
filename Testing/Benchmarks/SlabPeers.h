#pragma once

#include <string>
#include <vector>

namespace bench
{
/// A plane-parallel slab for programs of other people.
struct PeerCase
{
  double tau, albedo, g; ///< Henyey and Greenstein
  std::string light;     ///< diffuse, mu1, mu05 (a beam's cosine)
};

struct PeerAnswer
{
  std::string program; ///< with its version
  std::size_t number;  ///< of the case
  double reflectance, transmittance, seconds;
};

/// What disortpp and PythonicDISORT of PyPI say, run by Peers/slab_peers.py in a virtual environment that is made at
/// the first run. Empty where there is no python3 or PyPI cannot be reached; then it says so.
std::vector<PeerAnswer> AskPeers(const std::vector<PeerCase>& cases);
}
