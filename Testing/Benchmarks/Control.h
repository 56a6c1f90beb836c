#pragma once

#include "ControlSweep.h"

#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <vector>

/// What hand-written C++ makes of the fused sweep on two cores: the yardstick for the OpenCL kernels
/// (SolveConservative). The same rays (RayPattern), bundles with shared transmittance, rows of rays that move by whole
/// voxels, a pipeline of up to three stages, conservative deposit, the same balance. Two threads march towards each
/// other from the ends of an axis.
///
/// Only what the benchmark needs: an open box whose edges are multiples of 16 voxels, one sigma_t for all channels, no
/// emission, no net flux, light from the sky alone, a fixed number of orders.
namespace control
{
/// The sets of instructions that this program was compiled for and this processor has, AVX2 first; empty on others.
std::vector<Kernels> KernelsHere();

/// @param polynomials  where a row's voxels are all thin, find the mean length of a ray by a polynomial of sigma_t;
/// else by
///   an exponential everywhere
tyndall::LightField Solve(const Kernels& kernels, bool polynomials, const tyndall::Medium& medium,
  const tyndall::Illumination& illumination, const tyndall::PropagationSettings& settings,
  const tyndall::Monitor& monitor = {});
}
