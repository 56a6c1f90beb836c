#pragma once

#include <array>
#include <cstdint>

/// A box of one medium, its lower corner at (0, 0, 0), which scatters by Henyey and Greenstein's function, in the sun.
/// What meets a face from within comes back in part, spread as by a matt surface.
struct WalledBox
{
  std::array<double, 3> edges = { 1.0, 1.0, 1.0 };
  double sigma_t = 0.0; ///< 1/length
  double albedo = 1.0;
  double g = 0.0;
  std::array<double, 6> faceAlbedo = {}; ///< -x, +x, -y, +y, -z, +z
  std::array<double, 3> sunTravels = { 0.0, 0.0, -1.0 };
};

/// Parts of the power that came in, and their standard errors.
struct PowersInBox
{
  std::array<double, 6> out = {}; ///< less what came back
  double absorbed = 0.0;
  std::array<double, 6> outError = {};
  double absorbedError = 0.0;
};

/// By photons followed from the sun on, one after the other. Shares no code with the project's solvers.
PowersInBox PowersByMonteCarlo(const WalledBox& box, int photons, std::uint64_t seed);
