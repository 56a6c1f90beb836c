#include "Viewing/Scene/ViewTraits.h"

#include "Device/Defines.h"
#include "Viewing/Scene/ViewChecks.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr double FilledAtMost = 0.25; ///< of bricks: samples at their faces are there twice, and take memory, too

void FindMoments(const PhaseOfMedium& phase, const SolvedLight& light, ViewTraits& traits)
{
  if (!traits.ShowsMoments())
  {
    return;
  }
  traits.momentChannels = light.scatteredMoments.components / ((traits.momentDegree + 1) * (traits.momentDegree + 1));
  traits.straightOnChannels = light.straightOn.components;
  traits.aureoleChannels = traits.shadowRays && !phase.Varies() ? traits.phase.channels : 0;
}

/// What the mode does not look at stays away.
std::array<int, 5> ComponentsRead(const std::array<Field, 5>& fields, const ViewTraits& traits)
{
  const bool shadows = traits.shadowRays;
  const bool single = traits.singleScatteringOnly;
  const bool all = !traits.leaveOut;
  const std::array<bool, 5> used = { all || traits.medium.absorbs, all || traits.medium.scatters,
    all || traits.medium.emits, !single && !traits.ShowsMoments(), shadows != single && !traits.ShowsMoments() };
  std::array<int, 5> components = {};
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    components[i] = used[i] && fields[i].values ? fields[i].components : 0;
  }
  return components;
}
}

int ShownDegree(const SolvedLight& light, const ViewSettings& settings)
{
  return light.scatteredMoments.values && !settings.singleScatteringOnly ? DegreeOf(light.scatteredMoments) : -1;
}

std::array<Field, 5> ViewedFields(const Medium& medium, const SolvedLight& light)
{
  return { medium.sigma_a, medium.sigma_s, medium.emission, light.fluence, light.fluenceDirect };
}

ViewTraits ViewTraitsOf(const Medium& medium, const FilledBricks& filled, const SolvedLight& light, const Field& ior,
  const ViewSettings& settings, int kernelWidth, const SharedScene* shared)
{
  ViewTraits traits;
  traits.grid = medium.grid;
  traits.packetWidth = settings.packetWidth > 0 ? settings.packetWidth : kernelWidth;
  traits.leaveOut = settings.leaveOut;
  traits.singleScatteringOnly = settings.singleScatteringOnly;
  traits.shadowRays = settings.shadowRays;
  traits.hasTable = settings.tableFace >= 0;
  traits.medium = TraitsOf(medium, filled);
  traits.largestSigmaT = static_cast<double>(filled.absorption.largest) + filled.scattering.largest;
  traits.phase = ViewedPhaseOf(medium.phase);
  traits.index = shared ? shared->index : IndexRangeOf(ior, medium.grid);
  traits.bends = !settings.leaveOut || traits.index.Varies();
  traits.bricks = SeenBricksOf(filled, traits.bends || !traits.SkipsBricks(settings));
  traits.momentDegree = ShownDegree(light, settings);
  FindMoments(medium.phase, light, traits);

  const bool anisotropic = traits.phase.formula != ViewedPhase::Even;
  traits.knowsFlow =
    anisotropic && light.meanDirection.values && light.fluence.values && !settings.shadowRays && !traits.ShowsMoments();
  traits.coloured = !settings.leaveOut || !traits.medium.greyExtinction || traits.straightOnChannels == 3 ||
    (shared && shared->coloured);
  // Beside directions of the light it does not pay to have sources by one channel.
  traits.grey = !traits.coloured && traits.medium.grey && !traits.knowsFlow && !traits.shadowRays &&
    !traits.ShowsMoments() && light.fluence.components == 1 && light.fluenceDirect.components == 1 &&
    (!traits.medium.emits || traits.medium.emission.IsGrey());
  for (int c = 0; c < traits.aureoleChannels; ++c)
  {
    traits.straightOn[c] = shared ? shared->straightOn[c] : LeastStraightOn(medium, light, c);
  }
  traits.sourcesDependOnCamera = (traits.shadowRays && anisotropic) || traits.ShowsMoments();
  traits.components = ComponentsRead(ViewedFields(medium, light), traits);
  // Not for shadow rays, nor for moments: what is found of these has the order of voxels.
  traits.bricked =
    !shared && traits.OnlyStraight() && traits.PacksOnce() && !traits.bricks.all && filled.FilledPart() <= FilledAtMost;
  return traits;
}

bool ViewTraits::Reflects(const ViewSettings& settings) const
{
  return this->bends && settings.surfaceReflection != SurfaceReflection::None &&
    this->SurfaceIndex(settings) > this->index.least && this->SurfaceIndex(settings) <= this->index.largest;
}

std::string ViewTraits::PacketOptions() const
{
  return Define("REAL_WIDTH", this->packetWidth) + this->SampleOptions();
}

std::string ViewTraits::SampleOptions() const
{
  return Define("COLOURED", this->coloured) + Define("GREY", this->grey) + Define("BRICKED", this->bricked);
}

ViewedComponents ViewTraits::Components() const
{
  const std::array<int, 5>& of = this->components;
  return { of[0], of[1], of[2], of[3], of[4], this->ReadsMeanCosines() ? this->phase.channels : 0,
    this->straightOnChannels, 0 };
}

std::string ViewTraits::PhaseOptions(bool needed) const
{
  return Define("PHASE", needed ? static_cast<int>(this->phase.formula) : 0) +
    Define("PHASE_CHANNELS", this->phase.channels) + Define("FLOW_WITH_G", this->FlowHasG()) +
    Define("VARIED_G", this->PacksCosines());
}
}
