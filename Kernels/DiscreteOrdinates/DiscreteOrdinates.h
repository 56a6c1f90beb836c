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
/// Solves for the radiance along D directions in every voxel by discrete ordinates with anisotropic scattering (Z. Gong
/// et al., Interactive rendering of multiple scattering in participating media using separable phase functions).
///
/// The default scheme is conservative (numerics.md, Eqs. (D7) to (D12)): an exponential step, stable and positive for
/// any optical thickness of a voxel; scattering by the N terms of a SeparablePhaseFunction that keeps power and mean
/// cosine exactly, after removal of its forward peak; uncollided light of lamps along exact rays, whose first
/// scattering is exact in angle. It is of first order in the voxel edges for oblique directions. The published scheme
/// is explicit, and unstable if sigma_t times a voxel edge is above 1; `doubts` then says so.
///
/// The iteration is source iteration, with the radiance of all directions in memory. For media that scatter light many
/// times it is the accelerated iteration of light propagation maps, with sweeps by weighted diamond differences
/// (OrdinatesTransport.h). Without acceleration, a mean cosine that varies by voxel is replaced by its mean weighted by
/// sigma_s; `doubts` says so.
///
/// Channels are solved in sequence; a row of `convergence` is the sum over channels.
///
/// A decomposed grid is swept in a pipeline over ranks (PipelinedSweep.h); conservative scheme only. The light of each
/// order equals that of a serial solve to rounding. Collective.
///
/// @param medium  of this rank's block, on the grid domain.OwnGrid(); not read if that is empty
/// @param illumination, settings  the same on all ranks
/// @param kept  light of the previous solve, used as first guess and replaced by the light of this solve (KeptLight.h);
///   null: no first guess, and no light is kept. Null on all ranks or on none. Used and kept by SolveBySweptOrdinates()
///   (OrdinatesTransport.h)
/// @return light of this rank's block; balance, face powers and convergence are of the whole grid
/// @throws InvalidInput  from Check(medium), Check(illumination); if settings are out of range; for the published
///   scheme, if faces reflect or there are several ranks; if inputs differ between ranks, or the blocks have a cyclic
///   sweep order
/// @throws DeviceError  if the buffers do not fit; states the bytes needed before allocating any
/// @throws Aborted  if the monitor aborts the solve
LightField SolveDiscreteOrdinates(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const OrdinatesSettings& settings, const Monitor& monitor = {},
  KeptLight* kept = nullptr);
}
