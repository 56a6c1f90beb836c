#pragma once

#include "Reconstruction/PhotonReconstruction.h"

namespace tyndall
{
bool NeedsCounts(ReconstructionSettings::Estimator estimator);
bool NeedsWeights(ReconstructionSettings::Estimator estimator); ///< of photons

/// @throws InvalidInput where a setting is out of its range
void Check(const ReconstructionSettings& settings);

/// That what the estimator needs is there.
/// @throws InvalidInput where it is not: says what
void CheckPresence(const NoisyLight& light, ReconstructionSettings::Estimator estimator);

/// Levels of the pyramid above a grid, where so many are asked for.
int LevelsOf(const Grid& grid, int levels);

/// A result whose arrays have their sizes.
ReconstructedLight MakeRoom(const NoisyLight& light, bool conservative);

void SayWhatIsLeftOut(const NoisyLight& light, ReconstructedLight& result);
}
