#pragma once

#include "MachineLimits.h"

#include "Device/Device.h"

namespace bench
{
/// What the photons' tables are made with.
struct PhotonBench
{
  tyndall::Device& device;
  MachineLimits limits;
  bool quick;
};

void TimeStages(const PhotonBench& bench); ///< of Pfeuti's pipeline, beside his times
void TimeWays(const PhotonBench& bench);   ///< to march: integrators, octree, accumulation
void CompareOctrees(const PhotonBench& bench);
void LosePower(const PhotonBench& bench);       ///< what packing loses where photons crowd
void FollowLenses(const PhotonBench& bench);    ///< paths through Luneburg's lens and Maxwell's fish-eye
void TurnByPrism(const PhotonBench& bench);     ///< against Snell
void FocusLight(const PhotonBench& bench);      ///< by a ball of glass
void CompareSamplers(const PhotonBench& bench); ///< Pfeuti's Figure 4.1 and Table 4.1
void Scale(const PhotonBench& bench);           ///< in photons and voxels
void ScaleThreads(const PhotonBench& bench);
void ScatterPhotons(const PhotonBench& bench); ///< beside a plain program in C++
void ScatterInABall(const PhotonBench& bench); ///< of glass, beside solvers whose scattered light goes straight
}
