#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Problem/PropagationProblem.h"

#include <optional>

namespace tyndall
{
/// Whether the iteration of light propagation maps supports these settings. It does not support the published scheme,
/// the extrapolated series of a preview, directions on a spiral, or anisotropic scattering by terms other than
/// spherical harmonics.
bool IteratesAsMaps(const OrdinatesSettings& settings, bool isIsotropic);

/// Solves a scene with the iteration of light propagation maps. Uncollided light is computed as for these maps, except
/// for light of the box's faces with DSA. All other light is swept by discrete ordinates (UpwindSweep.h). Isotropic
/// scattering is solved by source iteration or diffusion synthetic acceleration (SourceIteration.h,
/// DiffusionAcceleration.h), whichever is predicted to be faster. If uncollided light is given by another solver,
/// source iteration is used, since DSA would overestimate the scattering of this light. Anisotropic scattering is
/// solved here only if many orders are needed: by DSA, in spherical harmonics up to the largest degree L with (L + 1)^2
/// <= `settings.terms`. Collective. Other parameters as for SolveDiscreteOrdinates().
/// @param even  problem of the scene with isotropic scattering, by AsPropagation(settings)
/// @return no value if the scene is to be solved by source iteration on the radiance of all directions (SweptOrders)
///   instead
std::optional<LightField> SolveBySweptOrdinates(Device& device, const SceneBlock& scene,
  const OrdinatesSettings& settings, const PropagationProblem& even, const Monitor& monitor);

/// Whether SolveDiscreteOrdinates() accelerates the solve of a scene. Collective.
bool AreAccelerated(Device& device, const SceneBlock& scene, const OrdinatesSettings& settings);
}
