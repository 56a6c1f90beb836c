#include "DiscreteOrdinates/DiscreteOrdinates.h"

#include "DiscreteOrdinates/OrdinatesParts.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesWarmStart.h"
#include "DiscreteOrdinates/Published/PublishedOrders.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Published/PublishedModel.h"

#include <algorithm>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
std::vector<std::string> Words(const PropagationProblem& problem, const FarLight& far, const OrdinatesAngles& angles)
{
  std::vector<std::string> words;
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      words.emplace_back(text);
    }
  };
  const MediumTraits& traits = problem.Traits();
  say(problem.Shining().uncollided.IsThere(), left_out::OwnUncollided);
  if (problem.Settings().leaveOut)
  {
    say(angles.phase.Terms() == 1 && traits.scatters, left_out::Isotropic);
    say(!traits.scatters, left_out::NoScattering);
    say(!traits.absorbs, left_out::NoAbsorption);
    say(!traits.emits, left_out::NoEmission);
    say(!IncomingOf(far, problem.Shining(), 0) && !IncomingOf(far, problem.Shining(), 1) &&
        !IncomingOf(far, problem.Shining(), 2),
      left_out::DarkOutside);
    say(problem.Shining().lights.empty() && far.peaks.empty(), left_out::NoLights);
    say(!Reflects(problem.Shining()), left_out::BlackFaces);
  }
  say(!problem.Settings().netFlux, left_out::NetFlux);
  return words;
}

LightKind KindOf(const PropagationProblem& problem, const OrdinatesSettings& settings)
{
  LightKind kind;
  kind.size = problem.TheGrid().size;
  kind.spacing = problem.TheGrid().spacing;
  kind.channels = problem.Channels();
  kind.periodic = settings.periodic;
  return kind;
}
}

LightField SolveDiscreteOrdinates(Device& device, const Medium& medium, const Illumination& illumination,
  const OrdinatesSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  Check(settings);
  if (IsPublished(settings))
  {
    CheckPublishedFaces(illumination);
  }
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  const FarLight far = FarLightOf(problem.Shining(), problem.Settings().directionsPerFace, settings);
  OrdinatesSettings solved = settings;
  solved.periodic = problem.Settings().periodic;
  LightField light;
  light.channels = problem.Channels();
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    thickest = std::max(thickest, ThickestStep(problem.TheMedium(), c));
  }
  light.doubts = DoubtsOf(settings, thickest, problem.TheMedium().phase.Varies());
  bool diverged = false;
  OrdinatesWarmStart warm(kept, settings);
  for (int c = 0; c < light.channels; ++c)
  {
    const PhaseFunction function = FunctionOf(problem.TheMedium(), c, nullptr);
    const OrdinatesAngles angles = { OrdinateGroups(far.directions), SeparableOf(function, far.directions, settings),
      function };
    CheckMemory(device, problem.TheGrid(), angles, settings);
    const OrdinatesScene scene = { problem.TheMedium(), c, LampsOf(far, problem.Shining(), c),
      IncomingOf(far, problem.Shining(), c), FaceAlbedoOf(problem.Shining(), c), UncollidedOf(problem.Shining(), c),
      warm.Begin(c, KindOf(problem, settings), angles, nullptr) };
    const Monitor ofChannel = OfPart(monitor, static_cast<double>(c) / light.channels, (c + 1.0) / light.channels);
    const OrdinatesResult found = IsPublished(settings) ? SolvePublishedOrders(device, scene, angles, solved, ofChannel)
                                                        : SolveSweptOrders(device, scene, angles, solved, ofChannel);
    TakeChannel(light, found, c);
    warm.Take(found, c);
    diverged = diverged || found.diverged;
    light.leftOut = c == 0 ? Words(problem, far, angles) : light.leftOut;
  }
  DescribeLight(light, device, far);
  light.faceAlbedo = illumination.faceAlbedo;
  Judge(settings, diverged, problem.TheMedium(), nullptr, light);
  warm.Finish(light, kept);
  if (!IsPublished(settings) && settings.seriesAfter > 0 &&
    light.convergence.size() >= static_cast<std::size_t>(settings.seriesAfter))
  {
    light.leftOut.push_back("orders: those after " + std::to_string(settings.seriesAfter) + " are a geometric series");
  }
  problem.Undo(light);
  WarnAboutInputLight(illumination, light);
  return light;
}
}
