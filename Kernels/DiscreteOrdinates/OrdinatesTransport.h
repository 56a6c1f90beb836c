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
/// Whether the iteration of light propagation maps can solve a scene, if scattering is isotropic or not: not by the
/// published scheme, the series of a preview, directions of a spiral, and anisotropic scattering by terms other than
/// spherical harmonics.
bool IteratesAsMaps(const OrdinatesSettings& settings, bool isIsotropic);

/// Solves a scene with the iteration of light propagation maps, and their uncollided light, in source iteration also
/// that of faces; all other light is swept by discrete ordinates (UpwindSweep.h). Isotropic scattering is solved by
/// source iteration or diffusion synthetic acceleration (SourceIteration.h, DiffusionAcceleration.h), whichever is
/// predicted to be faster; but light of another solver is not accelerated, since DSA would overestimate its scattering.
/// Anisotropic scattering is solved by acceleration alone, where many orders are needed, in spherical harmonics up to
/// the degree that `settings.terms` contain. Collective. Other parameters as for SolveDiscreteOrdinates().
/// @param even  problem of the scene with isotropic scattering, by AsPropagation(settings)
/// @return no value: source iteration between directions is to be used
std::optional<LightField> SolveBySweptOrdinates(Device& device, const SceneBlock& scene,
  const OrdinatesSettings& settings, const PropagationProblem& even, const Monitor& monitor, KeptLight* kept);

/// Whether SolveDiscreteOrdinates() accelerates the solve of a scene. Collective.
bool AreAccelerated(Device& device, const SceneBlock& scene, const OrdinatesSettings& settings);
}
