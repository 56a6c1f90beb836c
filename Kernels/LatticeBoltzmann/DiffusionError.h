#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ResampledScene.h"

namespace tyndall
{
/// Estimates the error of lattice light, which is that of the diffusion approximation: sets fluenceError and
/// relativeError from solves on a grid of half the voxels per axis, one by light propagation maps with few directions
/// and, if the coarse voxels are cubes, one by the lattice (numerics.md, Eq. (L17)). The estimate does not include the
/// noise of photons. Collective.
/// @param scene  the scene that was solved. If it has a refractive index, which light propagation maps do not support,
///   the coarse solves ignore it: the estimate is then that of the same medium without refraction
/// @param ofPhotons  whether the uncollided light is that of photons, which is taken from light.fluenceDirect
/// @param light  light of the conservative scheme
/// @throws InvalidInput  if there is a refractive index and the coarse voxels are no cubes
/// @throws the exceptions of SolveConservative and SolveLatticeBoltzmann
void EstimateDiffusionError(Device& device, const SceneBlock& scene, const LatticeSettings& settings, bool ofPhotons,
  const Monitor& monitor, LightField& light);

/// Adds a warning to `doubts` of light whose estimated error is above a target. It names the solvers that reach the
/// target, since no setting of the lattice reduces the error of diffusion.
/// @param target  relative error; 0: none
void JudgeTarget(double target, LightField& light);
}
