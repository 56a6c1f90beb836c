#pragma once

#include "Device/Device.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Boundary light from far away, along the directions of a solve.
struct FarLight
{
  std::vector<Direction> directions;
  std::vector<Rgb> radiance; ///< by direction, W / (length^2 sr)
  std::vector<Light> peaks;  ///< peaks of the environment
};

/// @param perFace  directions per cube face used in the solve
FarLight FarLightOf(const Illumination& shining, int perFace, const OrdinatesSettings& settings);

/// Phase function of a channel. If its mean cosine varies by voxel, the mean weighted by sigma_s is used. Collective.
PhaseFunction FunctionOf(const Domain& domain, const Medium& medium, int channel);

/// Warnings about properties of the medium that make the light inaccurate.
/// @param thickestStep  largest ThickestStep of all channels
std::vector<std::string> DoubtsOf(const OrdinatesSettings& settings, double thickestStep, bool cosineVaries);

/// Face albedo with the value of one channel in all three.
std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel);
UncollidedImage UncollidedOf(const Illumination& shining, int channel);

SeparablePhaseFunction SeparableOf(
  const PhaseFunction& function, const std::vector<Direction>& directions, const OrdinatesSettings& settings);

/// @throws DeviceError if the solve does not fit the device; the message states the memory needed
void CheckMemory(Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Boundary radiance of a channel; empty if there is none. `far` and `shining` must outlive the result.
IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel);

/// Lamps of the scene and peaks of the environment, with the power of one channel in all three.
std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel);

/// Stores the light of one channel in `light`.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel);

/// Sets the derived quantities of `light`, in the units of the solver.
void DescribeLight(LightField& light, const Device& device, const FarLight& far);

/// Checks convergence and, except for the published scheme, the energy balance (Convergence.h). Collective.
/// @param medium  of this rank, as solved
/// @throws InvalidInput if the energy balance is off
void Judge(
  const OrdinatesSettings& settings, bool diverged, const Domain& domain, const Medium& medium, LightField& light);
}
