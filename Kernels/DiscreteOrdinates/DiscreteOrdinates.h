#pragma once

#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Distribution/Domain.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include "Device/Device.h"
#include "Device/Monitor.h"

namespace tyndall
{
/// The radiance along D directions in every voxel, by iterations on the grid (Z. Gong et al., Interactive rendering of
/// multiple scattering in participating media using separable phase functions), with anisotropic scattering.
///
/// By default conservative (numerics.md, Eqs. (D7) to (D12)): a step by exponentials, stable and positive for any
/// optical thickness of a voxel; scattering by the N terms of a SeparablePhaseFunction that keeps power and mean cosine
/// exactly, its forward peak taken out; uncollided light of lamps along exact rays, first scattered exactly in angle.
/// First order in the voxels' edges where light goes askew. Or as published, explicit and unstable where sigma_t times
/// a voxel's edge is above 1: `doubts` says so.
///
/// Orders are added up one after the other without acceleration: thick media that absorb little take many. Radiance of
/// all directions is in memory at once. A mean cosine that varies by voxel is solved with its mean, weighted by
/// sigma_s; `doubts` says so.
///
/// Channels are solved one after the other; a row of `convergence` counts all of them.
///
/// A decomposed grid is swept in a pipeline over ranks (PipelinedSweep.h), the conservative scheme alone. The light is
/// that of one rank, order by order, to rounding. Collective.
///
/// @param medium  of this rank's block, on the grid that domain.OwnGrid() has; not read where that is empty
/// @param illumination, settings  the same on all ranks
/// @param kept  the light of the last solve is the first guess of this one, and the light of this one is left there
///   (KeptLight.h); null, on all ranks or none: begins in the dark, and keeps nothing. Conservative orders begin from
///   it where scattering is isotropic; as published orders always begin in the dark.
/// @return the light of the block; balance, face powers and convergence are of the whole grid
/// @throws InvalidInput  what Check(medium), Check(illumination) say, settings out of range, as published faces that
///   reflect or several ranks; where ranks disagree, or blocks wait for each other in a cycle
/// @throws DeviceError  if the buffers do not fit: says how many bytes are needed before it takes any
/// @throws Aborted  when the monitor says so
LightField SolveDiscreteOrdinates(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const OrdinatesSettings& settings, const Monitor& monitor = {},
  KeptLight* kept = nullptr);
}
