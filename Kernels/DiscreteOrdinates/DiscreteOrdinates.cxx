#include "DiscreteOrdinates/DiscreteOrdinates.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesTransport.h"
#include "DiscreteOrdinates/Published/PublishedOrders.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/LightSources.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/GridAxes.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// A scene in the units in which the solver computes (PropagationProblem), and the number of channels that are solved.
struct SolvedScene
{
  const Domain& domain;
  const Medium& medium; ///< medium of this rank's block
  const MediumTraits& traits;
  const Illumination& shining;
  int channels;
  int directionsPerFace;
  bool muchThinner;           ///< whether the grid is much thinner along one axis (IsMuchThinnerAlongOneAxis)
  const BoundaryLight* faces; ///< as in OrdinatesScene; `shining` is without these faces
  int facesDegree;            ///< as in OrdinatesScene
};

std::vector<std::string> Words(
  const SolvedScene& scene, const FarLight& far, bool scattersEvenly, const OrdinatesSettings& settings)
{
  std::vector<std::string> words;
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      words.emplace_back(text);
    }
  };
  const MediumTraits& traits = scene.traits;
  const auto isDark = [&](int channel) { return !IncomingOf(far, scene.shining, channel); };
  say(scene.shining.uncollided.IsThere(), left_out::OwnUncollided);
  if (settings.leaveOut)
  {
    say(scattersEvenly && traits.scatters, left_out::Isotropic);
    say(!traits.scatters, left_out::NoScattering);
    say(!traits.absorbs, left_out::NoAbsorption);
    say(!traits.emits, left_out::NoEmission);
    say(!scene.faces && isDark(0) && isDark(1) && isDark(2), left_out::DarkOutside);
    say(scene.shining.lights.empty() && far.peaks.empty(), left_out::NoLights);
    say(!Reflects(scene.shining), left_out::BlackFaces);
  }
  const bool asked = settings.acceleration == PropagationAcceleration::Automatic && settings.maximumOrders == 0;
  if (traits.scatters && asked && !IsPublished(settings) && settings.seriesAfter == 0)
  {
    const bool may = IteratesAsMaps(settings, scattersEvenly) && !scene.shining.uncollided.IsThere();
    words.emplace_back(may ? left_out::Acceleration : left_out::SpiralAcceleration);
  }
  say(!settings.netFlux, left_out::NetFlux);
  return words;
}

/// Solves for the light of all channels, one after the other. Collective.
/// @return light in the units of `scene`
LightField SolveChannels(
  Device& device, const SolvedScene& scene, const OrdinatesSettings& settings, const Monitor& monitor)
{
  const Domain& domain = scene.domain;
  const FarLight far = FarLightOf(scene.shining, scene.directionsPerFace, settings);
  LightField light;
  light.channels = scene.channels;
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    thickest = std::max(thickest, domain.Max(ThickestStep(scene.medium, c)));
    const PhaseFunction function = FunctionOf(domain, scene.medium, c);
    const OrdinatesAngles angles = { OrdinateGroups(far.directions),
      SeparableOf(function, far.directions, settings, scene.muchThinner || settings.seriesAfter > 0), function };
    domain.Collective([&] { CheckMemory(device, scene.medium.grid, angles, settings, scene.facesDegree); });
    const OrdinatesScene ofChannel = { domain, scene.medium, c, LampsOf(far, scene.shining, c),
      IncomingOf(far, scene.shining, c), scene.faces, scene.facesDegree, FaceAlbedoOf(scene.shining, c),
      UncollidedOf(scene.shining, c), scene.traits.filled };
    const Monitor part = OfPart(monitor, static_cast<double>(c) / light.channels, (c + 1.0) / light.channels);
    const OrdinatesResult found = IsPublished(settings)
      ? SolvePublishedOrders(device, ofChannel, angles, settings, part)
      : SolveSweptOrders(device, ofChannel, angles, settings, part);
    domain.Collective([&] { TakeChannel(light, found, c); });
    if (c == 0)
    {
      light.leftOut = Words(scene, far, angles.phase.Terms() == 1, settings);
    }
    AddMissing(light.leftOut, found.leftOut);
  }
  DescribeLight(light, device, far, scene.faces);
  light.doubts = DoubtsOf(settings, thickest, domain.Any(!domain.IsEmpty() && scene.medium.phase.Varies()));
  Judge(settings, domain, scene.medium, light);
  if (!IsPublished(settings) && settings.seriesAfter > 0 &&
    light.convergence.size() >= static_cast<std::size_t>(settings.seriesAfter))
  {
    light.leftOut.push_back("orders: those after " + std::to_string(settings.seriesAfter) + " are a geometric series");
  }
  return light;
}

/// Light of faces along rays of its own until its first collision (LightSources::FineBoundary), scattered in angular
/// moments up to the degree of the terms of the phase function, or that which the directions resolve. Only if the terms
/// are spherical harmonics: the light is then scattered as if it were swept.
class LightOfFaces
{
public:
  /// Collective. @param problem  must outlive this
  LightOfFaces(const PropagationProblem& problem, const OrdinatesSettings& settings)
    : Layout{ problem.TheGrid(), problem.Channels(), true }
  {
    const PropagationSettings& how = problem.Settings();
    if (IsPublished(settings) || settings.scattering != OrdinatesScattering::SphericalHarmonics ||
      settings.spiralDirections > 0 || !ResolvesTerms(how, settings.terms))
    {
      return;
    }
    const DirectionSet set = DirectionsForVoxels(how.directionsPerFace, problem.Whole().spacing);
    const UncollidedDirections finer = UncollidedDirectionsFor(problem, set, IterationScheme::SourceIteration);
    if (finer.perFace == 0)
    {
      return;
    }
    this->MomentsDegree =
      DegreeOf(problem, MostDegree(EquiangularDirections(how.directionsPerFace), DegreeOfTerm(settings.terms - 1)));
    problem.TheDomain().Collective([&] {
      this->Usual.emplace(problem.Whole(), how, set, RayStarts::Middle);
      this->Sources.emplace(problem, false, this->Layout, *this->Usual, finer);
    });
  }

  const BoundaryLight* Boundary() const { return this->Sources ? this->Sources->FineBoundary.get() : nullptr; }
  int Degree() const { return this->Boundary() ? this->MomentsDegree : -1; } ///< OrdinatesScene::facesDegree

private:
  /// Largest moment of the phase function without its peak that hardly changes the light.
  static constexpr double Negligible = 0.02;

  /// Highest degree, 1 to `most`, of which the phase function of any channel, without the peak beyond `most`
  /// (numerics.md, Eq. (D6)), has a moment.
  static int DegreeOf(const PropagationProblem& problem, int most)
  {
    int degree = std::min(1, most);
    for (int c = 0; c < problem.Channels(); ++c)
    {
      const std::vector<double> moments = FunctionOf(problem.TheDomain(), problem.TheMedium(), c).Moments(most + 1);
      const double peak = std::max(moments[most + 1], 0.0);
      for (int l = 0; l <= most; ++l)
      {
        degree = std::abs(moments[l] - peak) > Negligible * (1.0 - peak) ? std::max(degree, l) : degree;
      }
    }
    return static_cast<int>(problem.TheDomain().Max(degree));
  }

  const VolumeLayout Layout;
  int MomentsDegree = 0;
  std::optional<SweptDirections> Usual;
  std::optional<LightSources> Sources;
};

/// Checks conditions that PropagationProblem does not check. Collective.
void CheckOrdinates(const Domain& domain, const Medium& medium, const Illumination& illumination,
  const OrdinatesSettings& settings, bool warm)
{
  domain.Collective([&] {
    Check(settings);
    if (IsPublished(settings))
    {
      Require(domain.IsSerial(), "Blocks cannot be solved as published: take the conservative scheme.");
      CheckPublishedFaces(illumination);
    }
    Require(domain.IsEmpty() || medium.grid.size == domain.OwnGrid().size,
      "The medium of rank " + std::to_string(domain.Rank()) + " does not have the size of its block.");
  });
  Communicator& comm = domain.Comm();
  RequireSame(comm, "WarmStart", true, { warm ? 1.0 : 0.0 });
  RequireSame(comm, "settings of the ordinates", true,
    { 1.0 * static_cast<int>(settings.scattering), 1.0 * settings.spiralDirections, 1.0 * settings.terms });
}

/// Uncollided light given by another solver. If any rank has such light, a rank with an empty block gets an image of
/// one value that is never read, so that all ranks take part in the same collective calls.
UncollidedImage UncollidedKnown(const Domain& domain, const UncollidedImage& own)
{
  static const float nothing = 0.0f;
  const bool any = domain.Any(!domain.IsEmpty() && own.IsThere());
  UncollidedImage image;
  image.fluence = any ? Field{ &nothing, 1 } : Field();
  return domain.IsEmpty() ? image : own;
}
}

LightField SolveDiscreteOrdinates(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const OrdinatesSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  CheckOrdinates(domain, medium, illumination, settings, kept != nullptr);
  const PropagationProblem problem(domain, medium, illumination, AsPropagation(settings));
  std::optional<LightField> swept =
    SolveBySweptOrdinates(device, { domain, medium, illumination, {}, kept }, settings, problem, monitor);
  if (swept)
  {
    return std::move(*swept);
  }
  Illumination shining = problem.Shining();
  shining.uncollided = UncollidedKnown(domain, shining.uncollided);
  const LightOfFaces faces(problem, settings);
  shining.faces = faces.Boundary() ? std::array<Rgb, 6>() : shining.faces;
  LightField light = SolveChannels(device,
    { problem.TheDomain(), problem.TheMedium(), problem.Traits(), shining, problem.Channels(),
      problem.Settings().directionsPerFace, problem.IsMuchThinner(), faces.Boundary(), faces.Degree() },
    settings, monitor);
  if (kept)
  {
    light.leftOut.push_back(WordsOfWarmStart(IsPublished(settings)
        ? NotBegunAsPublished
        : "sources that terms of the phase function make negative are set to 0 order by order, from darkness on"));
    Keep({}, false, light, *kept);
  }
  domain.Collective([&] { problem.Undo(light); });
  light.faceAlbedo = illumination.faceAlbedo;
  WarnAboutInputLight(domain, illumination, light);
  ShareLeftOut(domain, light);
  return light;
}
}
