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
/// Directions of one solve, and what comes along them from far away.
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

/// Those of a channel in all three.
std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel);
UncollidedImage UncollidedOf(const Illumination& shining, int channel);

SeparablePhaseFunction SeparableOf(
  const PhaseFunction& function, const std::vector<Direction>& directions, const OrdinatesSettings& settings);

/// @throws DeviceError that says how much memory is needed
void CheckMemory(Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Sees `far` and `shining`, which must stay. Empty: nothing comes in.
IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel);

/// Of the scene and of the environment, power of the channel in all three.
std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel);

/// Puts the light of a channel beside that of the others.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel);

/// What light has beside fluence, before it is in the user's units.
void DescribeLight(LightField& light, const Device& device, const FarLight& far);

/// Whether it has converged, and, but as published, whether it balances (Convergence.h). Collective.
/// @param medium  solved, of this rank
/// @throws InvalidInput where it does not balance
void Judge(
  const OrdinatesSettings& settings, bool diverged, const Domain& domain, const Medium& medium, LightField& light);
}
