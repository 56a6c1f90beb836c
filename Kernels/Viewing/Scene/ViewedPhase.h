#pragma once

#include "PhaseFunction/PhaseOfMedium.h"
#include "Viewing/Scene/ViewShared.h"

#include <vector>

namespace tyndall
{
/// How the ray caster's kernels evaluate a medium's phase function (Samples/PhaseFunction.cl): by a formula where there
/// is one for light that is spread about its mean direction, else by a table.
struct ViewedPhase
{
  enum Formula ///< the kernels' PHASE
  {
    Even = 0,
    HenyeyGreenstein = 1,
    Schlick = 2,
    TwoLobes = 3,
    Rayleigh = 4,
    Rows = 5
  };

  Formula formula = Even;
  int channels = 1;    ///< 3 where they scatter differently
  bool varies = false; ///< g is that of the voxel
  PhaseInfo parameters = {};
};

ViewedPhase ViewedPhaseOf(const PhaseOfMedium& phase);

/// The tables of Schlick and Rows; empty for others.
std::vector<float> RowsOf(const ViewedPhase& viewed, const PhaseOfMedium& phase);
}
