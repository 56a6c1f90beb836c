#pragma once

#include "Medium/FilledBricks.h"
#include "Medium/Traits.h"
#include "PhaseFunction/PhaseOfMedium.h"
#include "Refraction/Index/IndexRange.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Which bricks of a medium's grid rays have to look into: those that are filled, and their neighbours, into which
/// values between voxel centres reach. Of the voxels of the others it is enough that they hold nothing.
struct SeenBricks
{
  std::array<int, 3> count = { 0, 0, 0 };
  std::vector<unsigned char> seen; ///< 1 or 0 of each, x fastest
  bool all = true;                 ///< are
};

/// @param everywhere  rays do not leap over empty bricks: all are seen
SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere);

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

/// What of a scene varies, has colour or depends on the camera, as far as pictures show it. Found once; kernels are
/// compiled for it. Depends on none of the settings that MediumRayCaster::Adopt takes over.
struct ViewTraits
{
  Grid grid;
  int packetWidth = 1; ///< rays marched together
  bool leaveOut = true;
  bool singleScatteringOnly = false;
  bool shadowRays = false; ///< lamps shine, and their light is found by shadow rays
  bool hasTable = false;

  MediumTraits medium;
  SeenBricks bricks;
  bool bricked = false;       ///< samples stand by bricks: few are filled
  double largestSigmaT = 0.0; ///< at least the largest sigma_t, 1/length
  ViewedPhase phase;
  IndexRange index;
  bool bends = false; ///< the refractive index varies

  int momentDegree = -1; ///< of the light; -1: it is not shown by moments
  int momentChannels = 0, straightOnChannels = 0;
  int aureoleChannels = 0; ///< of light scattered forwards more than once; 0: it is not known
  bool knowsFlow = false;  ///< the light's direction is known and scattering depends on it
  bool coloured = false;   ///< extinction differs between channels
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 }; ///< least that goes straight on, of each channel
  bool grey = false;                                    ///< nor does the source
  bool sourcesDependOnCamera = false;                   ///< what voxels shine towards it
  std::array<int, 5> components = {};                   ///< on the device, of ViewedFields; 0 for what is not read

  bool ShowsMoments() const { return this->momentDegree >= 0; }
  bool ShowsBeams() const { return this->ShowsMoments() && this->shadowRays; }
  /// Emission is not scattered.
  bool GlowsApart() const { return (this->knowsFlow || this->ShowsMoments()) && this->components[2] > 0; }
  /// Whether the light's mean direction is kept times g, which then is that of all channels.
  bool FlowHasG() const
  {
    return this->phase.channels == 1 &&
      (this->phase.formula == ViewedPhase::HenyeyGreenstein || this->phase.formula == ViewedPhase::Schlick);
  }
  /// Whether light of a known direction is scattered.
  bool ReadsPhase() const { return this->knowsFlow || this->shadowRays; }
  bool ReadsMeanCosines() const { return this->ReadsPhase() && this->phase.varies; } ///< g by voxel
  bool PacksCosines() const { return this->knowsFlow && this->phase.varies && !this->FlowHasG(); }
  /// Rays that cannot but go straight on have a kernel of their own.
  bool OnlyStraight() const { return !this->bends && !this->hasTable; }

  /// Whether samples stay as they are, from every side.
  bool PacksOnce() const { return !this->sourcesDependOnCamera && !this->shadowRays; }

  double SurfaceIndex(const ViewSettings& settings) const
  {
    return settings.surfaceIndex > 0.0 ? settings.surfaceIndex : 0.5 * (this->index.least + this->index.largest);
  }
  ViewedComponents Components() const;
  bool Reflects(const ViewSettings& settings) const;
  bool SkipsBricks(const ViewSettings& settings) const { return settings.skipEmptyBricks && this->leaveOut; }

  // Options that kernels are compiled with.
  std::string PacketOptions() const;
  std::string SampleOptions() const; ///< of what packs samples
  /// @param needed  whether light has a direction where this is asked
  std::string PhaseOptions(bool needed) const;
};

/// Of the moments that a picture is made of; -1: of none.
/// @throws InvalidInput as DegreeOf
int ShownDegree(const SolvedLight& light, const ViewSettings& settings);

/// Absorption, scattering, emission, fluence and fluenceDirect: what ViewTraits::components counts.
std::array<Field, 5> ViewedFields(const Medium& medium, const SolvedLight& light);

/// @param filled    the medium's bricks
/// @param settings  with shadowRays only where lamps shine
/// @param ior       null: constant
/// @param kernelWidth  rays that the device marches together best
/// @param shared       where the medium is one of several blocks: what the whole has
ViewTraits ViewTraitsOf(const Medium& medium, const FilledBricks& filled, const SolvedLight& light, const Field& ior,
  const ViewSettings& settings, int kernelWidth, const SharedScene* shared = nullptr);
}
