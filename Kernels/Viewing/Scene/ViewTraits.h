#pragma once

#include "Medium/FilledBricks.h"
#include "Medium/Traits.h"
#include "PhaseFunction/PhaseOfMedium.h"
#include "Refraction/Index/IndexField.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Bricks that rays must sample: the filled ones and their neighbours, into which interpolation between voxel centres
/// reaches. All other bricks are treated as empty.
struct SeenBricks
{
  std::array<int, 3> count = { 0, 0, 0 };
  std::vector<unsigned char> seen; ///< 1 or 0 for each brick, x fastest
  bool all = true;                 ///< all bricks are seen
};

/// @param everywhere  do not skip empty bricks: all bricks are seen
SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere);

/// How the kernels evaluate the medium's phase function (Samples/PhaseFunction.cl): by a formula where one exists for
/// light with angular spread about its mean direction, else by a table.
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
  int channels = 1;    ///< 3 if the channels scatter differently
  bool varies = false; ///< g varies by voxel
  PhaseInfo parameters = {};
};

ViewedPhase ViewedPhaseOf(const PhaseOfMedium& phase);

/// Tables for the formulas Schlick and Rows; empty for others.
std::vector<float> RowsOf(const ViewedPhase& viewed, const PhaseOfMedium& phase);

/// The light's angular moments, as they are shown.
struct ShownMoments
{
  int degree = -1; ///< -1: moments are not shown
  int channels = 0, straightOnChannels = 0;
  int aureoleChannels = 0; ///< channels of the table of repeated forward scattering; 0: none
  /// smallest fraction of scattering treated as unscattered, per channel
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 };
};

/// Features of a scene that pictures depend on: what varies, is coloured or depends on the camera. Determined once;
/// kernels are compiled for them. Independent of the settings that MediumRayCaster::Adopt changes.
struct ViewTraits
{
  Grid grid;
  int packetWidth = 1; ///< rays marched together
  bool leaveOut = true;
  bool singleScatteringOnly = false;
  bool shadowRays = false; ///< there are lamps, and their light is computed by shadow rays
  bool hasTable = false;

  MediumTraits medium;
  SeenBricks bricks;
  bool bricked = false;       ///< samples are stored in bricks, because few bricks are filled
  double largestSigmaT = 0.0; ///< upper bound of sigma_t, 1/length
  ViewedPhase phase;
  IndexRange index;
  bool bends = false; ///< the refractive index varies

  ShownMoments moments;
  bool knowsFlow = false;             ///< the mean direction is known and the phase function is anisotropic
  bool coloured = false;              ///< extinction differs between the channels
  bool grey = false;                  ///< neither extinction nor source differ between the channels
  bool sourcesDependOnCamera = false; ///< the light that voxels send depends on the direction to the camera
  std::array<int, 5> components = {}; ///< components of each of ViewedFields on the device; 0: not read

  bool ShowsMoments() const { return this->moments.degree >= 0; }
  bool ShowsBeams() const { return this->ShowsMoments() && this->shadowRays; }
  /// Whether emission is packed separately, because it is not multiplied by the phase function.
  bool GlowsApart() const { return (this->knowsFlow || this->ShowsMoments()) && this->components[2] > 0; }
  /// Whether the mean direction is stored multiplied by g; g is then the same for all channels.
  bool FlowHasG() const
  {
    return this->phase.channels == 1 &&
      (this->phase.formula == ViewedPhase::HenyeyGreenstein || this->phase.formula == ViewedPhase::Schlick);
  }
  bool PacksCosines() const { return this->knowsFlow && this->phase.varies && !this->FlowHasG(); }
  /// What is packed of the light's mean direction: the kernels' option FLOW, see ScatteredLight.cl.
  int Flow() const { return !this->knowsFlow ? 0 : this->FlowHasG() ? 2 : this->PacksCosines() ? 3 : 1; }
  /// Whether the phase function is evaluated for light of a known direction.
  bool ReadsPhase() const { return this->knowsFlow || this->shadowRays; }
  bool ReadsMeanCosines() const { return this->ReadsPhase() && this->phase.varies; } ///< g by voxel
  /// Whether all rays are straight; these have their own kernel.
  bool OnlyStraight() const { return !this->bends && !this->hasTable; }

  /// Whether samples are independent of the camera, so that they are packed only once.
  bool PacksOnce() const { return !this->sourcesDependOnCamera && !this->shadowRays; }

  double SurfaceIndex(const ViewSettings& settings) const
  {
    return settings.surfaceIndex > 0.0 ? settings.surfaceIndex : 0.5 * (this->index.least + this->index.largest);
  }
  ViewedComponents Components() const;
  bool Reflects(const ViewSettings& settings) const;
  bool SkipsBricks(const ViewSettings& settings) const { return settings.skipEmptyBricks && this->leaveOut; }

  // Compiler options of the kernels.
  std::string PacketOptions() const;
  std::string SampleOptions() const; ///< for the kernels that pack samples
  /// @param needed  whether the phase function is evaluated in this kernel
  std::string PhaseOptions(bool needed) const;
};

/// Degree of the angular moments that are shown; -1: none.
/// @throws InvalidInput as DegreeOf
int ShownDegree(const SolvedLight& light, const ViewSettings& settings);

/// Absorption, scattering, emission, fluence and fluenceDirect, in the order of ViewTraits::components.
std::array<Field, 5> ViewedFields(const Medium& medium, const SolvedLight& light);

/// @param filled    the medium's bricks
/// @param settings  with shadowRays only if there are lamps
/// @param ior       refractive index; null: constant
/// @param kernelWidth  packet width that is fastest on the device
/// @param shared       properties of the whole domain, if the medium is one of several blocks
ViewTraits ViewTraitsOf(const Medium& medium, const FilledBricks& filled, const SolvedLight& light, const Field& ior,
  const ViewSettings& settings, int kernelWidth, const SharedScene* shared = nullptr);
}
