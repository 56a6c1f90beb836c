#pragma once

#include "Device/Device.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Lights/Lights.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"
#include "Photons/Photons.h"

namespace tyndall
{
/// @throws InvalidInput what SolveLatticeBoltzmann says of medium, index and settings
void CheckLattice(const Medium& medium, const Field& ior, const LatticeSettings& settings);

/// Whether it matters where in voxels light is first scattered, and the scheme minds.
bool NeedsFirstMoments(const Medium& medium, const LatticeSettings& settings);

/// As the parts of other solvers that serve the lattice are asked for.
PropagationSettings AsPropagation(const LatticeSettings& settings);

/// @throws InvalidInput where an axis is periodic
void CheckPhotonsGoNotRound(const LatticeSettings& settings);

/// W that left through each face in three channels, which those of grey light are alike.
std::array<Rgb, 6> EscapedByChannel(const LightField& light);

/// Photons' light as uncollided light; its arrays are theirs.
UncollidedImage ImageOf(const PhotonLight& photons);

/// Hands on what photons' light is doubted for, and warns of photons that do not meet the medium.
/// @param all  number of photons, of all ranks
void DoubtPhotons(const PhotonLight& photons, std::size_t all, LightField& light);

/// Dark, in the channels that are solved.
LightField BeginLight(std::size_t voxels, int channels, const LatticeSettings& settings);

/// What light has beside fluence and balance, in the units of the solve.
/// @param anisotropic  the medium scatters, and unevenly
/// @param thickest  sigma_t h, of all voxels
void DescribeLight(
  LightField& light, const Device& device, bool anisotropic, const LatticeSettings& settings, double thickest);

/// Adds to what entered the W of uncollided light that entered and went nowhere.
void CountLost(const Rgb& lost, EnergyBalance& balance);

/// Whether it has converged, and what else is to be said of light in the user's units.
void JudgeLight(LightField& light, const Illumination& illumination, const LatticeSettings& settings);

/// What light has beside fluence and balance once all channels have been added: to the user's units, with what is to be
/// said of it.
/// @param thickest  sigma_t h, of all voxels
void FinishLight(LightField& light, const Device& device, const PropagationProblem& problem,
  const Illumination& illumination, const LatticeSettings& settings, double thickest);
}
