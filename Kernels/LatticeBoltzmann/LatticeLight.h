#pragma once

#include "Device/Device.h"
#include "Distribution/Domain.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"
#include "Photons/Photons.h"

#include <array>

namespace tyndall
{
/// Checks conditions of the lattice solve that LatticeProblem does not check. Collective.
/// @throws InvalidInput under the conditions listed at SolveLatticeBoltzmann
void CheckLattice(const Domain& domain, const Medium& medium, const Field& ior, const LatticeSettings& settings);

/// Whether a voxel of this rank is so optically thick that the position of first scattering within it matters, and the
/// scheme takes it into account.
bool NeedsFirstMoments(const Medium& medium, const LatticeSettings& settings);

/// Checks that no axis is periodic.
/// @throws InvalidInput if an axis is periodic
void RequireOpenAxes(const LatticeSettings& settings);

/// Escaped power through each face, W, in three channels; equal in all three if `light` has one channel.
std::array<Rgb, 6> EscapedByChannel(const LightField& light);

/// The light of photons as an image of uncollided light, which refers to the arrays of `photons`.
UncollidedImage ImageOf(const PhotonLight& photons);

/// Adds the warnings of the photon march, and a warning about photons that miss the medium, to light.doubts.
/// @param all  number of photons on all ranks
void DoubtPhotons(const PhotonLight& photons, std::size_t all, LightField& light);

/// A LightField of zeros for the problem's voxels and channels.
LightField BeginLight(const LatticeProblem& problem, const LatticeSettings& settings);

/// Completes `light`: sums powers over ranks, checks the energy balance, converts to the user's units, and adds the
/// lists of what was left out and of warnings (LightField::leftOut, doubts). Collective.
/// @param illumination  as the user gave it
/// @param thickest  sigma_t h of the thickest voxel of all ranks
/// @param lost  incident power that neither collided nor escaped, on this rank (Uncollided::lost), W
void FinishLight(LightField& light, const Device& device, const LatticeProblem& problem,
  const Illumination& illumination, const LatticeSettings& settings, double thickest, const Rgb& lost = {});
}
