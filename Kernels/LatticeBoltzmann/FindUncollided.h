#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"

namespace tyndall
{
/// Uncollided light by known voxel: that of another solver if given, else that of lamps and environment by light
/// propagation maps. Diffuse sky and face light is excluded; it is incident on the lattice itself. Collective.
Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor);

/// Adds net flux and first moments, if asked for, to uncollided light that is given as an image with mean directions.
/// @param firstMoments  whether first moments are asked for
void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments);
}
