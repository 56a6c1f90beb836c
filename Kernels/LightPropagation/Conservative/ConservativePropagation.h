#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Light propagation maps as they should be: the method of Fattal (2009) and Gruson et al. (2012), with
///  - conservative deposit: what a ray loses, its voxel gains (path integrals by phi1; no division by sigma_t);
///  - EquiangularDirections;
///  - lights, and what is small and bright in the environment, as a first-collision source: their unscattered light is
///    followed along exact rays, not through the directions;
///  - what else comes in from outside along more directions until it is first scattered, if uncollidedDirections are
///    given;
///  - propagation and collection in one, so that memory is (2 source, path, fluence, sigma_s) arrays and the maps.
///
/// Isotropic scattering. A medium with mean cosine g is solved as the isotropic medium with sigma_s (1 - g) (similarity
/// relation: same diffusion, same absorption); leftOut says so.
///
/// @throws InvalidInput  what Check(medium), Check(illumination) say, or settings out of range
/// @throws DeviceError  if the buffers do not fit
/// @throws Aborted  when the monitor says so
LightField SolveConservative(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {});
}
