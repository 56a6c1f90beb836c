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
/// Collective.
/// @throws InvalidInput what SolveLatticeBoltzmann says of its arguments
void CheckLattice(const Domain& domain, const Medium& medium, const Field& ior, const Illumination& illumination,
  const LatticeSettings& settings);

/// Whether a voxel is so thick that it matters where in it light is first scattered, and the scheme resolves that.
bool NeedsFirstMoments(const Medium& medium, const LatticeSettings& settings);

/// @throws InvalidInput if an axis is periodic
void RequireOpenAxes(const LatticeSettings& settings);

/// W escaped through each face, in three channels; those of grey light are equal.
std::array<Rgb, 6> EscapedByChannel(const LightField& light);

/// Photons' light as uncollided light; it refers to their arrays.
UncollidedImage ImageOf(const PhotonLight& photons);

/// Passes on warnings of the march, and warns of photons that miss the medium.
/// @param all  number of photons, of all ranks
void DoubtPhotons(const PhotonLight& photons, std::size_t all, LightField& light);

/// Dark light of the problem's voxels and channels.
LightField BeginLight(const LatticeProblem& problem, const LatticeSettings& settings);

/// Sums powers over ranks, checks the balance, returns to the user's units and adds `leftOut` and `doubts`. Collective.
/// @param illumination  as given
/// @param thickest  sigma_t h of the thickest voxel of all ranks
/// @param lost  W of uncollided light, on this rank, that entered and was deposited nowhere
void FinishLight(LightField& light, const Device& device, const LatticeProblem& problem,
  const Illumination& illumination, const LatticeSettings& settings, double thickest, const Rgb& lost = {});
}
