#pragma once

#include "Lights/Lights.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Where the power went, W per channel (grey media fill channel 0 only).
/// entered + emitted = absorbed + escaped + leftOver, but for rounding and what a scheme loses.
struct EnergyBalance
{
  Rgb entered = {};  ///< through the box's faces and from lights inside it
  Rgb emitted = {};  ///< by the medium itself
  Rgb absorbed = {}; ///< by the medium
  Rgb escaped = {};  ///< through the box's faces, less what they give back
  Rgb leftOver = {}; ///< scattered but not propagated any more when the solver stopped; or given back by a face

  /// |entered + emitted - absorbed - escaped - leftOver| / (entered + emitted), the worst channel; 0 in the dark
  double RelativeError(int channels) const;
};

/// A row of the `convergence` table: one scattering order, or one sweep where orders are accelerated.
struct ConvergenceRow
{
  int iteration = 0;
  double seconds = 0.0; ///< since the start
  /// Estimate of the relative error that stopping here leaves: scattered light still to come over all of it
  /// (numerics.md, Eqs. (43), (73)). 1 after the first row where more is to come: one order does not show how fast they
  /// shrink.
  double residual = 0.0;
  double change = 0.0;   ///< of the light by this row, relative: says little where light is scattered very often
  double absorbed = 0.0; ///< W so far, channels summed
  double escaped = 0.0;
  double leftOver = 0.0;
};

/// The light in a medium, as every solver returns it. Arrays are over the grid's voxels, x fastest, channels
/// interleaved; an array that was not asked for is empty.
struct LightField
{
  int channels = 1;
  std::vector<float> fluence;       ///< W / length^2, `channels` per voxel
  std::vector<float> fluenceDirect; ///< its unscattered part
  /// Distance in voxels, 0 to 1/2, from the middle of a voxel towards its faces -x, +x, ... +z of the mean place where
  /// lamps' light is first lost, times the fluence of that light, W / length^2, 6 * channels a voxel: all faces of
  /// channel 0, 1, 2 (numerics.md, Eq. (37)); empty: not asked for.
  std::vector<float> firstMoments;
  std::vector<float> fluenceError;      ///< standard error of fluence, estimated
  std::vector<float> netFlux;           ///< W / length^2, 3 * channels per voxel: (x, y, z) of channel 0, 1, 2
  std::vector<float> scatteredRadiance; ///< W / (length^2 sr), channels * storedDirections a voxel
  std::vector<std::array<double, 3>> storedDirections; ///< of scatteredRadiance; one (0, 0, 0) where isotropic
  /// In-scattered radiance as a function of the direction that light goes on in, W / (length^2 sr), in the spherical
  /// harmonics of Numerics/SphericalHarmonics.h times sqrt(4 pi), [voxel][(degree + 1)^2][channel], so that the first
  /// is its mean. Without that of lampsApart. What goes straight on (straightOn) is no part of it. 0 where nothing is
  /// scattered; empty where scattering is isotropic, or it was not asked for.
  std::vector<float> scatteredMoments;
  /// Part of what is scattered that is taken as light that goes straight on (numerics.md, Eq. (8a)); 1 or 3 a voxel.
  std::vector<float> straightOn;
  std::vector<Light> lampsApart; ///< what scatteredMoments lack is what these lamps' light is scattered first
  /// W / (length^2 sr) that leaves through the box's faces, [cell][SurfaceCosines][channel] (BoxFaces.h); empty where
  /// no voxel there is thick, or it is not known
  std::vector<float> surfaceRadiance;
  /// Of fluence, estimated, root mean square over that of fluence; 0 where not asked for, NaN: not known.
  double relativeError = 0.0;
  EnergyBalance balance;
  /// W, through -x, +x, -y, +y, -z, +z, less what faces give back.
  std::array<Rgb, 6> facePowerOut = {};
  /// W / length^2 that leave through the cells of the box's faces, [cell][channel] (BoxFaces.h), before a face gives
  /// back its part; empty: not asked for, and no face reflects.
  std::vector<float> facePower;
  std::array<Rgb, 6> faceAlbedo = {}; ///< part of facePower that comes back (Illumination::faceAlbedo)
  /// Of the directions that light from outside came along (DirectionSet.h); 0: there are none.
  double halfRangeFlux = 0.0;
  std::vector<ConvergenceRow> convergence;
  /// Of each row, how many rows earlier its residual was reached than by the last solve that began in the dark: 0 where
  /// this one did, too. Empty: it was not to begin from kept light (KeptLight.h).
  std::vector<int> sweepsSaved;
  bool converged = true; ///< the last residual is at most the tolerance, or as many orders were done as were asked for
  std::vector<std::string> doubts; ///< what may be wrong with the light, a sentence each, for a warning
  int polarNodes = 0; ///< of a plane-parallel solve (PropagationSettings::polarNodes); 0: along rays through the voxels
  int directionsPerFace = 0;             ///< solved with, where a solver chooses (PropagationSettings::adaptDirections)
  int uncollidedDirections = 0;          ///< a face, of unscattered light from outside; 0: the same
  std::vector<std::string> leftOut;      ///< what the scene did not need, in words
  int solves = 1;                        ///< that it took, all together, those of coarser grids as well (TargetError.h)
  double secondsOfAll = 0.0;             ///< of these; 0: there is one, see convergence
  std::vector<std::string> settingsUsed; ///< "Name = value" of each setting that a quality chooses (Quality.h)
  std::string device;
};
}
