#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"

namespace tyndall
{
/// Uncollided light by known voxel: that of another solver if any is given, or else that of lamps and environment, by
/// light propagation maps. Diffuse light of sky and faces is incident on the lattice itself. Collective.
Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor);

/// Adds net flux and first moments, as far as they are asked for, to an image by known voxel with its mean directions.
/// @param firstMoments  are asked for
void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments);
}
