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
/// Whether the settings allow acceleration if scattering is isotropic or not. Not accelerated: the published scheme, a
/// given number of orders, directions of a spiral, and anisotropic scattering by other terms than spherical harmonics;
/// nor, whatever the settings, the light of another solver, whose scattering DSA overestimates.
bool MayAccelerate(const OrdinatesSettings& settings, bool isIsotropic);

/// Solves a scene by discrete ordinates with diffusion synthetic acceleration, if that is predicted to be faster than
/// source iteration: the iteration, the diffusion system and the uncollided light are those of light propagation maps
/// (DiffusionAcceleration.h), the sweeps weighted diamond differences (UpwindSweep.h; numerics.md, Eq. (D15)). The
/// phase function is represented by spherical harmonics up to the degree that `settings.terms` contain. Collective.
/// Other parameters as for SolveDiscreteOrdinates().
/// @param even  problem of the scene with isotropic scattering, by AsPropagation(settings)
/// @return no value: source iteration is to be used
std::optional<LightField> SolveAcceleratedOrdinates(Device& device, const SceneBlock& scene,
  const OrdinatesSettings& settings, const PropagationProblem& even, const Monitor& monitor, KeptLight* kept);

/// Whether SolveDiscreteOrdinates() accelerates the solve of a scene. Collective.
bool AreAccelerated(Device& device, const SceneBlock& scene, const OrdinatesSettings& settings);
}
