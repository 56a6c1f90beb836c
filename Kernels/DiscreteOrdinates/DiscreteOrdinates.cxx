#include "DiscreteOrdinates/DiscreteOrdinates.h"

#include "DiscreteOrdinates/OrdinatesParts.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/PublishedOrders.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double SlowestRate = 1.0 - 1e-6; ///< of orders, that is told the next solve

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

std::vector<std::string> DoubtsOf(const PropagationProblem& problem, const OrdinatesSettings& settings)
{
  std::vector<std::string> doubts;
  double thickest = 0.0;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    thickest = std::max(thickest, ThickestStep(problem.TheMedium(), c));
  }
  if (IsPublished(settings) && thickest > 1.0)
  {
    doubts.push_back("Explicit steps as published are not stable where sigma_t times the step, the shortest edge of a "
                     "voxel, is above 1: here it is up to " +
      Text("%.3g", thickest) +
      ". Radiance becomes negative, and above 2 it grows without end. Choose the conservative scheme, or finer "
      "voxels.");
  }
  if (problem.TheMedium().phase.Varies())
  {
    doubts.emplace_back(DoubtOfVaryingCosine);
  }
  return doubts;
}

LightKind KindOf(const PropagationProblem& problem, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  const Grid& grid = problem.TheGrid();
  return { IsPublished(settings) ? "discrete ordinates as published" : "discrete ordinates", grid.size, grid.spacing,
    problem.Channels(), angles.phase.Terms(), angles.phase.DirectionCount(), settings.periodic };
}

std::string WhyNotWarm(
  const KeptLight& kept, const LightKind& kind, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  if (!IsPublished(settings) && !CanBeginWarm(angles, settings))
  {
    return "sources that terms of the phase function make negative are set to 0 order by order, from darkness on";
  }
  return WhyNotBegun(kept, kind, settings.maximumOrders);
}

/// One channel's part of kept light.
OrdinatesGuess GuessOf(const KeptLight& kept, bool begins, int channel, int channels)
{
  OrdinatesGuess guess;
  guess.keeps = true;
  if (begins)
  {
    const auto values = static_cast<std::ptrdiff_t>(kept.scattered.size()) / channels;
    guess.values.assign(kept.scattered.begin() + channel * values, kept.scattered.begin() + (channel + 1) * values);
    guess.firstScattered = kept.firstScattered[channel];
    guess.rate = kept.rate[channel];
  }
  return guess;
}

void TakeLeft(KeptLight& left, const OrdinatesResult& found, const OrdinatesSettings& settings, int channel)
{
  left.scattered.insert(left.scattered.end(), found.left.begin(), found.left.end());
  left.firstScattered[channel] = found.firstScattered;
  left.rate[channel] = settings.maximumOrders > 0 ? 0.0 : std::min(found.rate, SlowestRate);
}

}

LightField SolveDiscreteOrdinates(Device& device, const Medium& medium, const Illumination& illumination,
  const OrdinatesSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  Check(settings);
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  const FarLight far = FarLightOf(problem.Shining(), problem.Settings().directionsPerFace, settings);
  OrdinatesSettings solved = settings;
  solved.periodic = problem.Settings().periodic;
  LightField light;
  light.channels = problem.Channels();
  light.doubts = DoubtsOf(problem, settings);
  bool diverged = false;
  std::string whyNot;
  KeptLight left;
  for (int c = 0; c < light.channels; ++c)
  {
    const PhaseFunction function = FunctionOf(problem.TheMedium(), c, nullptr);
    const OrdinatesAngles angles = { OrdinateGroups(far.directions), SeparableOf(function, far.directions, settings),
      function };
    CheckMemory(device, problem.TheGrid(), angles, settings);
    OrdinatesScene scene = { problem.TheMedium(), c, LampsOf(far, problem.Shining(), c),
      IncomingOf(far, problem.Shining(), c), FaceAlbedoOf(problem.Shining(), c), UncollidedOf(problem.Shining(), c),
      {} };
    if (kept)
    {
      left.kind = c == 0 ? KindOf(problem, angles, settings) : left.kind;
      const std::string why = WhyNotWarm(*kept, left.kind, angles, settings);
      whyNot = whyNot.empty() ? why : whyNot;
      scene.guess = GuessOf(*kept, why.empty(), c, light.channels);
    }
    const Monitor ofChannel = OfPart(monitor, static_cast<double>(c) / light.channels, (c + 1.0) / light.channels);
    const OrdinatesResult found = IsPublished(settings) ? SolvePublishedOrders(device, scene, angles, solved, ofChannel)
                                                        : SolveSweptOrders(device, scene, angles, solved, ofChannel);
    TakeChannel(light, found, c);
    TakeLeft(left, found, settings, c);
    diverged = diverged || found.diverged;
    light.leftOut = c == 0 ? Words(problem, far, angles) : light.leftOut;
  }
  DescribeLight(light, device, far);
  light.faceAlbedo = illumination.faceAlbedo;
  if (kept)
  {
    left.fromDarkness = kept->fromDarkness;
    left.scattered = diverged ? std::vector<float>() : std::move(left.scattered);
    light.leftOut.push_back(WordsOfWarmStart(whyNot));
    Keep(std::move(left), whyNot.empty(), light, *kept);
  }
  if (!IsPublished(settings) && settings.seriesAfter > 0 &&
    light.convergence.size() >= static_cast<std::size_t>(settings.seriesAfter))
  {
    light.leftOut.push_back("orders: those after " + std::to_string(settings.seriesAfter) + " are a geometric series");
  }
  problem.Undo(light);
  Judge(settings, diverged, light);
  DoubtGivenLight(illumination, light);
  return light;
}
}
