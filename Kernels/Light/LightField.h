#pragma once

#include "Lights/Lights.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace tyndall
{
/// Energy balance, W per channel (grey media fill channel 0 only): entered + emitted = absorbed + escaped + leftOver,
/// up to rounding and the energy error of the scheme.
struct EnergyBalance
{
  Rgb entered = {};  ///< power that enters through the box's faces and from lights inside it
  Rgb emitted = {};  ///< power emitted by the medium
  Rgb absorbed = {}; ///< power absorbed by the medium
  Rgb escaped = {};  ///< power that leaves through the box's faces, less the power they reflect
  Rgb leftOver = {}; ///< power scattered, or reflected by a face, but not yet propagated when the solver stopped

  /// Relative error of the balance: |entered + emitted - absorbed - escaped - leftOver| / (entered + emitted), in the
  /// worst channel; 0 without light.
  double RelativeError(int channels) const;
};

inline double EnergyBalance::RelativeError(int channels) const
{
  double worst = 0.0;
  for (int c = 0; c < channels; ++c)
  {
    const double in = this->entered[c] + this->emitted[c];
    const double out = this->absorbed[c] + this->escaped[c] + this->leftOver[c];
    const double error = in > 0.0 ? std::abs(in - out) / in : std::abs(out);
    worst = error <= worst || std::isnan(worst) ? worst : error; // returns NaN if any channel is NaN
  }
  return worst;
}

/// A row of the `convergence` table: one scattering order, or one sweep if source iteration is accelerated.
struct ConvergenceRow
{
  int iteration = 0;
  double seconds = 0.0; ///< time since the start of the solve, s
  /// Estimate of the relative error that the solver would have if it stopped after this row: ratio of the scattered
  /// light not yet propagated to all scattered light (numerics.md, Eqs. (43), (73)). 1 after the first row unless it is
  /// the last, since one order does not show the rate of convergence.
  double residual = 0.0;
  /// Relative change of the light by this iteration. Much smaller than the error if light is scattered very often.
  double change = 0.0;
  double absorbed = 0.0; ///< power absorbed so far, W, summed over channels
  double escaped = 0.0;
  double leftOver = 0.0;
};

/// Report of a solve on its accuracy, convergence and settings, for the domain.
struct SolveReport
{
  /// Estimated root-mean-square error of the fluence, relative to the root mean square of the fluence. 0: not
  /// requested; NaN: not known.
  double relativeError = 0.0;
  /// Half-range flux of the quadrature used for boundary sources (DirectionSet.h), by channel; 0: there is none.
  Rgb halfRangeFlux = {};
  std::vector<ConvergenceRow> convergence;
  /// Number of sweeps that the initial guess saved, for each convergence row. It is the number of the row at which the
  /// last solve without a guess reached the same residual, minus the number of this row. 0 if this solve had no guess.
  /// Empty if no warm start was requested (KeptLight.h).
  std::vector<int> sweepsSaved;
  bool converged = true; ///< whether the last residual is at most the tolerance, or all requested orders were computed
  std::vector<std::string> doubts; ///< warnings about the result, one sentence each
  /// Number of polar quadrature nodes of a plane-parallel solve (PropagationSettings::polarNodes); 0: rays were traced
  /// through voxels.
  int polarNodes = 0;
  /// Number of directions per face of the cube, if the solver chose this number (PropagationSettings::adaptDirections).
  int directionsPerFace = 0;
  /// Directions per face of the cube for uncollided boundary light; 0: the same number as directionsPerFace.
  int uncollidedDirections = 0;
  std::vector<std::string> leftOut; ///< parts of the computation that the scene did not need (LeftOut.h)
  int solves = 1;                   ///< number of solves, including those on coarser grids (TargetError.h)
  /// Text "Name = value" for each setting that the quality determines (Quality.h).
  std::vector<std::string> settingsUsed;
  std::string device;
};

/// The light in a medium, as every solver returns it. Arrays are over the grid's voxels, x fastest, channels
/// interleaved; an array that was not requested is empty.
struct LightField : SolveReport
{
  int channels = 1;
  std::vector<float> fluence;       ///< fluence, W / length^2, `channels` per voxel
  std::vector<float> fluenceDirect; ///< fluence of uncollided light, W / length^2, `channels` per voxel
  /// First moments of collisions of lamps' uncollided light (numerics.md, Eq. (37)), 6 * channels per voxel: for
  /// channels 0, 1, 2 one value per face -x, +x, ... +z. A value is the distance of the mean collision position from
  /// the voxel's centre towards the face, 0 to 1/2 voxel, times the uncollided fluence, W / length^2. Empty: not
  /// requested.
  std::vector<float> firstMoments;
  std::vector<float> fluenceError; ///< estimated standard error of the fluence, W / length^2, `channels` per voxel
  double errorLength = 0.0;        ///< mean length over which errors of the fluence have the same sign; 0: not known
  /// Net flux, W / length^2, 3 * channels per voxel: (x, y, z) of channel 0, 1, 2.
  std::vector<float> netFlux;
  /// In-scattered radiance, W / (length^2 sr), channels * storedDirections per voxel.
  std::vector<float> scatteredRadiance;
  std::vector<std::array<double, 3>>
    storedDirections; ///< directions of scatteredRadiance; a single (0, 0, 0) if it is isotropic
  /// Angular moments of the in-scattered radiance by outgoing direction, W / (length^2 sr), [voxel][(degree +
  /// 1)^2][channel]. They are the coefficients of the spherical harmonics of Numerics/Legendre.h times sqrt(4 pi), so
  /// that the first is the mean. Light first scattered from lampsApart is not included, nor is the fraction straightOn
  /// of scattering that is treated as unscattered. 0 in voxels that do not scatter; empty if scattering is isotropic or
  /// the moments were not requested.
  std::vector<float> scatteredMoments;
  /// Fraction of scattered light that is treated as unscattered (delta-M; numerics.md, Eq. (8a)); 1 or 3 per voxel.
  std::vector<float> straightOn;
  std::vector<Light> lampsApart; ///< lamps whose first-collision source is not included in scatteredMoments
  /// Outgoing radiance at the box's faces, W / (length^2 sr), [cell][cosine][channel] for the polar cosines
  /// SurfaceCosines (BoxFaces.h); empty if no boundary voxel is optically thick, or if the solver did not compute this
  /// radiance; NaN in channels of which, solved alone, this holds.
  std::vector<float> surfaceRadiance;
  /// Estimated standard error of surfaceRadiance, same layout; empty or NaN: not known.
  std::vector<float> surfaceError;
  EnergyBalance balance;
  /// Net power that escapes through faces -x, +x, -y, +y, -z, +z, W: the power that leaves, minus the power that the
  /// faces reflect.
  std::array<Rgb, 6> facePowerOut = {};
  /// Outgoing partial current in the cells of the box's faces, W / length^2, [cell][channel] (BoxFaces.h), before
  /// reflection; empty if it was not requested and no face reflects.
  std::vector<float> facePower;
  std::array<Rgb, 6> faceAlbedo = {}; ///< fraction of facePower that is reflected (Illumination::faceAlbedo)
};
}
