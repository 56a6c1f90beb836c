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
  Rgb entered = {};  ///< through the box's faces and from lights inside it
  Rgb emitted = {};  ///< by the medium itself
  Rgb absorbed = {}; ///< by the medium
  Rgb escaped = {};  ///< escaped power: out through the box's faces, less what they reflect
  Rgb leftOver = {}; ///< scattered, or reflected by a face, but not yet propagated when the solver stopped

  /// |entered + emitted - absorbed - escaped - leftOver| / (entered + emitted), of the worst channel; 0 without light
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
    worst = error <= worst || std::isnan(worst) ? worst : error; // NaN propagates
  }
  return worst;
}

/// A row of the `convergence` table: one scattering order, or one sweep if source iteration is accelerated.
struct ConvergenceRow
{
  int iteration = 0;
  double seconds = 0.0; ///< since the start of the solve
  /// Estimate of the relative error if the solver stops here: scattered light not yet propagated over all scattered
  /// light (numerics.md, Eqs. (43), (73)). 1 after the first row unless it is the last, since one order does not show
  /// the rate of convergence.
  double residual = 0.0;
  double change =
    0.0; ///< relative change of the light in this row; a poor measure of the error if light is scattered very often
  double absorbed = 0.0; ///< W so far, channels summed
  double escaped = 0.0;
  double leftOver = 0.0;
};

/// What a solve reports about itself, of the whole domain.
struct SolveReport
{
  /// Estimated error of the fluence: its root mean square over that of the fluence. 0: not asked for; NaN: not known.
  double relativeError = 0.0;
  /// Half-range flux of the quadrature used for boundary sources (DirectionSet.h); 0: there is none.
  double halfRangeFlux = 0.0;
  std::vector<ConvergenceRow> convergence;
  /// For each row, how many sweeps the initial guess saved: the row at which the last solve without a guess reached
  /// this residual, less this row's number; 0 if this solve had no guess. Empty: no warm start was asked for
  /// (KeptLight.h).
  std::vector<int> sweepsSaved;
  bool converged = true; ///< the last residual is at most the tolerance, or all orders that were asked for are done
  std::vector<std::string> doubts; ///< warnings about the result, one sentence each
  /// Polar quadrature nodes of a plane-parallel solve (PropagationSettings::polarNodes); 0: rays were traced through
  /// voxels.
  int polarNodes = 0;
  /// Directions per face that were used, if the solver chooses (PropagationSettings::adaptDirections).
  int directionsPerFace = 0;
  int uncollidedDirections = 0;     ///< directions per face for uncollided boundary light; 0: as directionsPerFace
  std::vector<std::string> leftOut; ///< parts of the computation that the scene did not need (LeftOut.h)
  int solves = 1;                   ///< number of solves, including those on coarser grids (TargetError.h)
  double secondsOfAll = 0.0;        ///< run time of all solves; 0 if there was only one, whose time is in `convergence`
  std::vector<std::string> settingsUsed; ///< "Name = value" for each setting chosen by the quality (Quality.h)
  std::string device;
};

/// The light in a medium, as every solver returns it. Arrays are over the grid's voxels, x fastest, channels
/// interleaved; an array that was not asked for is empty.
struct LightField : SolveReport
{
  int channels = 1;
  std::vector<float> fluence;       ///< W / length^2, `channels` per voxel
  std::vector<float> fluenceDirect; ///< uncollided part of the fluence
  /// First moments of collisions of lamps' uncollided light (numerics.md, Eq. (37)), 6 * channels per voxel: for
  /// channels 0, 1, 2 one value per face -x, +x, ... +z. Each is the distance, 0 to 1/2 voxel, of the mean collision
  /// place from the voxel's centre towards the face, times the uncollided fluence, W / length^2. Empty: not asked for.
  std::vector<float> firstMoments;
  std::vector<float> fluenceError;      ///< estimated standard error of the fluence
  std::vector<float> netFlux;           ///< W / length^2, 3 * channels per voxel: (x, y, z) of channel 0, 1, 2
  std::vector<float> scatteredRadiance; ///< W / (length^2 sr), channels * storedDirections per voxel
  std::vector<std::array<double, 3>>
    storedDirections; ///< directions of scatteredRadiance; a single (0, 0, 0) if it is isotropic
  /// Angular moments of the in-scattered radiance by outgoing direction, W / (length^2 sr): coefficients of the
  /// spherical harmonics of Numerics/SphericalHarmonics.h times sqrt(4 pi), [voxel][(degree + 1)^2][channel], so that
  /// the first is the mean. Excludes light first scattered from lampsApart, and the unscattered part given by
  /// straightOn. 0 where nothing is scattered; empty if scattering is isotropic or the moments were not asked for.
  std::vector<float> scatteredMoments;
  /// Fraction of scattered light that is treated as unscattered (delta-M; numerics.md, Eq. (8a)); 1 or 3 per voxel.
  std::vector<float> straightOn;
  std::vector<Light> lampsApart; ///< lamps whose first-collision source is not included in scatteredMoments
  /// Outgoing radiance at the box's faces, W / (length^2 sr), [cell][SurfaceCosines][channel] (BoxFaces.h); empty if no
  /// boundary voxel is optically thick, or it is not known.
  std::vector<float> surfaceRadiance;
  EnergyBalance balance;
  /// Net escaped power through -x, +x, -y, +y, -z, +z, W: what leaves less what the faces reflect.
  std::array<Rgb, 6> facePowerOut = {};
  /// Outgoing partial current in the cells of the box's faces, W / length^2, [cell][channel] (BoxFaces.h), before
  /// reflection; empty if it was not asked for and no face reflects.
  std::vector<float> facePower;
  std::array<Rgb, 6> faceAlbedo = {}; ///< fraction of facePower that is reflected (Illumination::faceAlbedo)
};
}
