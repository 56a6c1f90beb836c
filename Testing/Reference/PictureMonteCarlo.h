#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// A box of a medium whose sigma_t is known at voxel centres and linear between them, constant from the outermost
/// centres to the box's faces; its lower corner at (0, 0, 0). Scatters by Henyey and Greenstein's function. A sun and
/// an even sky shine on it.
struct LitVolume
{
  std::array<int, 3> size = { 1, 1, 1 };
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };
  std::vector<float> sigma_t; ///< 1/length, x fastest
  double albedo = 1.0;
  double g = 0.0;
  std::array<double, 3> sunTravels = { 0.0, 0.0, -1.0 }; ///< unit vector
  double sunIrradiance = 0.0;                            ///< W / length^2 across its direction
  double skyRadiance = 0.0;                              ///< W / (length^2 sr), also behind the medium
  int mostScatterings = 100000;                          ///< light that was scattered more often is left out
};

struct ViewRay
{
  std::array<double, 3> from, along; ///< `along` a unit vector
};

/// Radiance that comes against each ray, W / (length^2 sr), by paths that are followed backwards from the eye: free
/// paths by Woodcock's null collisions (1965), the sun by the transmittance to it from every collision, estimated
/// without bias by ratio tracking (Novak, Selle and Jarosz 2014). Shares no code with the project's solvers.
/// @param paths  of each ray
/// @return one number a ray; the same for the same seed, on any number of threads
std::vector<double> PictureByMonteCarlo(
  const LitVolume& volume, const std::vector<ViewRay>& rays, int paths, std::uint64_t seed, int threads);
