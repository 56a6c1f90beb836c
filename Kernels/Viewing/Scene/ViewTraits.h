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
/// Bricks that rays must sample: filled bricks and their neighbours, into which interpolation between voxel centres
/// reaches. Rays treat all other bricks as empty.
struct SeenBricks
{
  std::array<int, 3> count = { 0, 0, 0 };
  std::vector<unsigned char> seen; ///< flag of each brick, x fastest: 1 if rays must sample it, else 0
  bool all = true;                 ///< whether rays must sample all bricks
};

/// Finds the bricks that rays must sample.
/// @param everywhere  whether to sample all bricks, empty ones included
SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere);

/// How kernels evaluate the medium's phase function (Samples/PhaseFunction.cl): by a formula where one exists for light
/// that is spread about its mean direction, else by a table.
struct ViewedPhase
{
  enum Formula ///< formulas, with the values of the kernels' macro PHASE
  {
    Even = 0,
    HenyeyGreenstein = 1,
    Schlick = 2,
    TwoLobes = 3,
    Rayleigh = 4,
    Rows = 5
  };

  Formula formula = Even;
  int channels = 1;    ///< 3 if the phase function differs between the channels, else 1
  bool varies = false; ///< whether g varies by voxel
  PhaseInfo parameters = {};
};

ViewedPhase ViewedPhaseOf(const PhaseOfMedium& phase);

/// Tables of the phase function for the formulas Schlick and Rows; empty for others.
std::vector<float> RowsOf(const ViewedPhase& viewed, const PhaseOfMedium& phase);

/// Angular moments of the light as the picture uses them.
struct ShownMoments
{
  int degree = -1; ///< degree of the angular moments; -1: moments are not shown
  int channels = 0, straightOnChannels = 0;
  /// Number of channels of the tables of repeated forward scattering (AureoleTable in SeenSources.h); 0: no tables.
  int aureoleChannels = 0;
  /// Per channel, smallest fraction of scattering that the solver treats as unscattered.
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 };
};

/// Features of a scene for which kernels are compiled: whether properties vary, differ between the channels or depend
/// on the camera. Determined once per scene; independent of the settings that MediumRayCaster::Adopt changes.
struct ViewTraits
{
  Grid grid;
  int packetWidth = 1; ///< number of rays marched together
  bool leaveOut = true;
  bool singleScatteringOnly = false;
  bool shadowRays = false; ///< whether there are lamps, whose light is computed by shadow rays
  bool hasTable = false;

  MediumTraits medium;
  SeenBricks bricks;
  bool bricked = false;       ///< whether samples are stored in bricks, because few bricks are filled
  double largestSigmaT = 0.0; ///< upper bound of sigma_t in the medium, 1/length
  ViewedPhase phase;
  IndexRange index;
  bool bends = false; ///< whether the refractive index varies

  ShownMoments moments;
  bool knowsFlow = false; ///< whether the mean direction is known and the phase function is anisotropic
  bool coloured = false;  ///< whether extinction differs between the channels
  bool grey = false;      ///< whether neither extinction nor source differs between the channels
  /// Whether the light that voxels emit and scatter depends on the direction to the camera.
  bool sourcesDependOnCamera = false;
  /// Components of sigma_a, sigma_s, emission, fluence and fluenceDirect (ViewedFields) on the device; 0: not read.
  std::array<int, 5> components = {};

  bool ShowsMoments() const { return this->moments.degree >= 0; }
  bool ShowsBeams() const { return this->ShowsMoments() && this->shadowRays; }
  /// Whether emission is packed separately from scattered light. This is necessary if scattered light is multiplied by
  /// the phase function, since emission is not.
  bool GlowsApart() const { return (this->knowsFlow || this->ShowsMoments()) && this->components[2] > 0; }
  /// Whether the light's mean direction is packed multiplied by the mean cosine g; g is then equal for all channels.
  bool FlowHasG() const
  {
    return this->phase.channels == 1 &&
      (this->phase.formula == ViewedPhase::HenyeyGreenstein || this->phase.formula == ViewedPhase::Schlick);
  }
  bool PacksCosines() const { return this->knowsFlow && this->phase.varies && !this->FlowHasG(); }
  /// Value of the kernels' macro FLOW, which says how the light's mean direction is packed, see ScatteredLight.cl.
  int Flow() const { return !this->knowsFlow ? 0 : this->FlowHasG() ? 2 : this->PacksCosines() ? 3 : 1; }
  /// Whether the phase function is evaluated, for light whose mean direction is known or for lamps.
  bool ReadsPhase() const { return this->knowsFlow || this->shadowRays; }
  bool ReadsMeanCosines() const { return this->ReadsPhase() && this->phase.varies; } ///< whether g by voxel is read
  /// Whether all rays are straight and do not meet a table; StraightView.cl marches these.
  bool OnlyStraight() const { return !this->bends && !this->hasTable; }

  /// Whether packed samples are independent of the camera and of shadow rays, so that they are packed only once.
  bool PacksOnce() const { return !this->sourcesDependOnCamera && !this->shadowRays; }

  double SurfaceIndex(const ViewSettings& settings) const
  {
    return settings.surfaceIndex > 0.0 ? settings.surfaceIndex : 0.5 * (this->index.least + this->index.largest);
  }
  ViewedComponents Components() const;
  bool Reflects(const ViewSettings& settings) const;
  bool SkipsBricks(const ViewSettings& settings) const { return settings.skipEmptyBricks && this->leaveOut; }

  // Compiler options for kernels, in the form "-DNAME=value".
  std::string PacketOptions() const;
  std::string SampleOptions() const; ///< options of the kernels that pack samples
  /// Options that define PHASE and PHASE_CHANNELS (PhaseFunction.cl) and FLOW (ScatteredLight.cl).
  /// @param needed  whether the kernel evaluates the phase function
  std::string PhaseOptions(bool needed) const;
};

/// Degree of the angular moments that pictures show; -1: they show none.
/// @throws InvalidInput for a wrong number of components, as DegreeOf
int ShownDegree(const SolvedLight& light, const ViewSettings& settings);

/// Absorption, scattering, emission, fluence and fluenceDirect of a scene, in the order of ViewTraits::components.
std::array<Field, 5> ViewedFields(const Medium& medium, const SolvedLight& light);

/// Determines the features of a scene.
/// @param filled    filled bricks of the medium
/// @param settings  its shadowRays must be false if there are no lamps
/// @param ior       refractive index; null: constant
/// @param kernelWidth  packet width that is fastest on the device
/// @param shared       properties of the whole domain, if the medium is one of several blocks; else null
ViewTraits ViewTraitsOf(const Medium& medium, const FilledBricks& filled, const SolvedLight& light, const Field& ior,
  const ViewSettings& settings, int kernelWidth, const SharedScene* shared = nullptr);
}
