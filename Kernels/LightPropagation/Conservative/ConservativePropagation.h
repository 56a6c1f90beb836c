#pragma once

#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Light propagation maps with the energy kept: the method of Fattal (2009) and Gruson et al. (2012), with
///  - conservative deposit: what a ray loses, its voxel gains (numerics.md, Eqs. (23) to (27)); no division by sigma_t;
///  - FittedDirections;
///  - lights, and what is small and bright in environment and emission, as a first-collision source along exact rays;
///  - what else comes in from outside along more directions until it is first scattered, if uncollidedDirections are
///    given;
///  - source iteration, or diffusion acceleration where light is scattered many times (numerics.md, sections 6, 7);
///  - propagation and collection in one: memory is some five arrays (sigma_t, sigma_s, source, path, fluence) and the
///    maps.
///
/// A medium with g other than 0 is solved in angular moments up to a degree, settings.angularDegree, and what its phase
/// function scatters beyond them goes straight on (delta-M, numerics.md, section 2.2); leftOut says so.
///
/// @param kept  the light of the last solve is the first guess of this one, and the light of this one is left there
/// (KeptLight.h); null: begins in the dark, and keeps nothing
/// @throws InvalidInput  what Check(medium), Check(illumination) say, or settings out of range
/// @throws DeviceError  if the buffers do not fit
/// @throws Aborted  when the monitor says so
LightField SolveConservative(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {}, KeptLight* kept = nullptr);
}
