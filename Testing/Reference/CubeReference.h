#pragma once

#include <array>

/// Mean fluence of the voxels of a cube of side 1 cut into 10 x 10 x 10, x fastest, with their standard errors: own
/// Monte Carlo. Albedo 0.9, isotropic, black surroundings.
struct CubeVoxel
{
  double fluence, error;
};
using CubeReference = std::array<CubeVoxel, 1000>;

/// Optical thickness 1, diffuse light of flux 1 on face -z. Data/Reference/cube_fluence_tau1_w0.9_g0_diffuse.csv.
/// @throws std::runtime_error where the file is missing or is not of 10 x 10 x 10 voxels
CubeReference CubeInDiffuseLight();

/// Optical thickness 5, volume emission of power 1. Data/Reference/cube_fluence_tau5_w0.9_g0_volume.csv.
/// @throws std::runtime_error where the file is missing or is not of 10 x 10 x 10 voxels
CubeReference ShiningCube();

/// Parts of the diffuse light on one face of a cube that leave or stay, with their standard errors: own Monte Carlo.
struct CubePowers
{
  std::array<double, 4> part, error; ///< reflected, transmitted, through the four sides, absorbed
};

/// Data/Reference/cube_RTSA.csv, isotropic scattering. @throws std::runtime_error where the table does not have it
CubePowers CubePowersOf(double tau, double albedo);
