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
/// Directions of one solve, and the incident radiance from far away.
struct FarLight
{
  std::vector<Direction> directions;
  std::vector<Rgb> radiance; ///< by direction, W / (length^2 sr)
  std::vector<Light> peaks;  ///< of the environment
};

/// @param perFace  directions per face of a cube, as they are solved with
FarLight FarLightOf(const Illumination& shining, int perFace, const OrdinatesSettings& settings);

/// The phase function; of a mean cosine that varies by voxel, with the mean weighted by sigma_s. Collective.
PhaseFunction FunctionOf(const Domain& domain, const Medium& medium, int channel);

/// Properties of a medium that make the light doubtful.
/// @param thickestStep  ThickestStep of all channels
std::vector<std::string> DoubtsOf(const OrdinatesSettings& settings, double thickestStep, bool cosineVaries);

/// One channel's values in all three.
std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel);
UncollidedImage UncollidedOf(const Illumination& shining, int channel);

SeparablePhaseFunction SeparableOf(
  const PhaseFunction& function, const std::vector<Direction>& directions, const OrdinatesSettings& settings);

/// @throws DeviceError that says how much memory is needed
void CheckMemory(Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// `far` and `shining` must stay. Empty: no light is incident.
IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel);

/// Of the scene and of the environment, power of the channel in all three.
std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel);

/// Stores the light of a channel among all channels.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel);

/// Sets the derived quantities of light, before it is in the user's units.
void DescribeLight(LightField& light, const Device& device, const FarLight& far);

/// Whether it has converged, and, but as published, whether it balances (Convergence.h). Collective.
/// @param medium  solved, of this rank
/// @throws InvalidInput where it does not balance
void Judge(
  const OrdinatesSettings& settings, bool diverged, const Domain& domain, const Medium& medium, LightField& light);
}
