#include "DiscreteOrdinates/DiscreteOrdinates.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/PublishedOrders.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double SlowestRate = 1.0 - 1e-6; ///< of orders, that is told the next solve
constexpr int FacesPeaksAreSoughtFor = 25; ///< directions per face, where directions are on a spiral

bool IsPublished(const OrdinatesSettings& settings)
{
  return settings.scheme == OrdinatesScheme::Published;
}

/// What light propagation maps would be told of the same scene: units, channels and axes are found alike.
PropagationSettings AsPropagation(const OrdinatesSettings& settings)
{
  PropagationSettings as;
  as.directionsPerFace = settings.directionsPerFace;
  as.adaptDirections = !IsPublished(settings) && settings.spiralDirections == 0;
  as.source = IsPublished(settings) ? PropagationSource::Constant : PropagationSource::Automatic;
  as.maximumOrders = settings.maximumOrders;
  as.tolerance = settings.tolerance;
  as.periodic = settings.periodic;
  as.netFlux = settings.netFlux;
  as.leaveOut = settings.leaveOut;
  as.angularDegree = 0; // scatters by direction, not in moments
  return as;
}

/// Directions of one solve, and what comes along them from far away.
struct FarLight
{
  std::vector<Direction> directions;
  std::vector<Rgb> radiance; ///< by direction, W / (length^2 sr)
  std::vector<Light> peaks;  ///< of the environment
};

FarLight FarLightOf(const PropagationProblem& problem, const OrdinatesSettings& settings)
{
  const Illumination& shining = problem.Shining();
  const int perFace = problem.Settings().directionsPerFace;
  const bool spiral = settings.spiralDirections > 0;
  const DirectionSet cube = spiral ? EquiangularDirections(FacesPeaksAreSoughtFor)
    : IsPublished(settings)        ? PublishedDirections(perFace)
                                   : EquiangularDirections(perFace);
  const SplitEnvironment environment = Split(shining.environment, cube);
  FarLight far = { cube.directions, {}, environment.peaks };
  if (!spiral)
  {
    far.radiance = BoundaryRadiance(cube, environment.smooth, shining.sky);
    return far;
  }
  far.directions = IsPublished(settings) ? SpiralDirections(settings.spiralDirections)
                                         : WeightedSpiralDirections(settings.spiralDirections);
  for (const Direction& direction : far.directions)
  {
    const std::array<double, 3>& omega = direction.omega;
    const Rgb seen =
      environment.smooth.Empty() ? Rgb{} : Lookup(environment.smooth, { -omega[0], -omega[1], -omega[2] });
    far.radiance.push_back({ seen[0] + shining.sky[0], seen[1] + shining.sky[1], seen[2] + shining.sky[2] });
  }
  return far;
}

/// Of a mean cosine that varies by voxel the mean, weighted by what is scattered with it.
PhaseFunction FunctionOf(const Medium& medium, int channel)
{
  if (!medium.phase.Varies())
  {
    return medium.phase.OfChannel(channel);
  }
  double scattered = 0.0, forwards = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    scattered += medium.sigma_s.At(i, channel);
    forwards += static_cast<double>(medium.sigma_s.At(i, channel)) * medium.phase.MeanCosine(i, channel);
  }
  return medium.phase.OfChannel(channel).WithMeanCosine(scattered > 0.0 ? forwards / scattered : 0.0);
}

SeparablePhaseFunction SeparableOf(
  const PhaseFunction& function, const std::vector<Direction>& directions, const OrdinatesSettings& settings)
{
  const bool matrix = settings.scattering == OrdinatesScattering::Matrix;
  SeparableSettings separable;
  separable.factorisation = settings.scattering == OrdinatesScattering::SphericalHarmonics
    ? PhaseFactorisation::SphericalHarmonics
    : PhaseFactorisation::SingularValues;
  separable.terms = matrix ? static_cast<int>(directions.size()) : settings.terms;
  separable.repaired = !IsPublished(settings);
  separable.sampling = IsPublished(settings) ? PhaseSampling::PointValues : PhaseSampling::CellMeans;
  separable.truncatesPeak = !IsPublished(settings) && !matrix;
  return { function, directions, separable };
}

/// @throws DeviceError that says what is needed
void CheckMemory(Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  const std::size_t bytes =
    IsPublished(settings) ? BytesOfPublishedOrders(grid, angles, settings) : BytesOfSweptOrders(grid, angles, settings);
  const std::size_t radiance = sizeof(float) * AngularScattering::Floats(angles.groups, grid.VoxelCount());
  const std::size_t free = device.MemoryLimit() - device.BytesInUse();
  if (bytes <= free && radiance <= device.AllocationLimit())
  {
    return;
  }
  const auto mebibytes = [](std::size_t count) { return Text("%.0f", std::ceil(count / 1048576.0)) + " MiB"; };
  throw DeviceError("Discrete ordinates with " + std::to_string(angles.phase.DirectionCount()) + " directions need " +
    mebibytes(bytes) + " for this grid, " + mebibytes(radiance) +
    " of them in one piece, the radiance along all directions; " + device.Name() + " has " + mebibytes(free) +
    " left, " + mebibytes(device.AllocationLimit()) +
    " in one piece. Choose fewer directions, a coarser grid, or Light Propagation Maps.");
}

IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel)
{
  bool any = false;
  for (const Rgb& face : shining.faces)
  {
    any = any || face[channel] > 0.0;
  }
  for (const Rgb& radiance : far.radiance)
  {
    any = any || radiance[channel] > 0.0;
  }
  if (!any)
  {
    return {};
  }
  return [&far, &shining, channel](
           int direction, int face) { return far.radiance[direction][channel] + shining.faces[face][channel]; };
}

std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel)
{
  std::array<Rgb, 6> albedo = {};
  for (int face = 0; face < 6; ++face)
  {
    albedo[face].fill(shining.faceAlbedo[face][channel]);
  }
  return albedo;
}

UncollidedImage UncollidedOf(const Illumination& shining, int channel)
{
  UncollidedImage image = shining.uncollided;
  image.fluence.standsForAll = image.fluence.HasColour() ? channel : image.fluence.standsForAll;
  for (Rgb& face : image.escaped)
  {
    face.fill(face[channel]);
  }
  return image;
}

std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel)
{
  std::vector<Light> lamps;
  for (const std::vector<Light>* of : { &shining.lights, &far.peaks })
  {
    for (Light lamp : *of)
    {
      lamp.power = { lamp.power[channel], lamp.power[channel], lamp.power[channel] };
      if (lamp.power[0] > 0.0)
      {
        lamps.push_back(lamp);
      }
    }
  }
  return lamps;
}

void TakePowers(LightField& light, const EnergyLedger& ledger, int channel)
{
  const EnergyBalance& balance = ledger.Balance();
  light.balance.entered[channel] = balance.entered[0];
  light.balance.emitted[channel] = balance.emitted[0];
  light.balance.absorbed[channel] = balance.absorbed[0];
  light.balance.escaped[channel] = balance.escaped[0];
  light.balance.leftOver[channel] = balance.leftOver[0];
  for (int face = 0; face < 6; ++face)
  {
    light.facePowerOut[face][channel] = ledger.FacePowerOut()[face][0];
  }
}

/// A row of all channels: one that is done stays as it is.
void AddRows(std::vector<ConvergenceRow>& sum, const std::vector<ConvergenceRow>& rows, bool first)
{
  const ConvergenceRow last = sum.empty() ? ConvergenceRow() : sum.back();
  const std::size_t count = std::max(sum.size(), rows.size());
  while (sum.size() < count)
  {
    sum.push_back(last);
    sum.back().iteration = static_cast<int>(sum.size()) - 1;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    const ConvergenceRow& row = rows[std::min(i, rows.size() - 1)];
    sum[i].seconds += row.seconds;
    sum[i].residual = first ? row.residual : std::max(sum[i].residual, row.residual);
    sum[i].change = first ? row.change : std::max(sum[i].change, row.change);
    sum[i].absorbed += row.absorbed;
    sum[i].escaped += row.escaped;
    sum[i].leftOver += row.leftOver;
  }
}

/// Puts the light of a channel beside that of the others.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel)
{
  const std::size_t voxels = found.fluence.size();
  light.fluence.resize(voxels * light.channels);
  light.fluenceDirect.resize(voxels * light.channels);
  light.netFlux.resize(found.flux.size() * light.channels);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    light.fluence[i * light.channels + channel] = found.fluence[i];
    light.fluenceDirect[i * light.channels + channel] = found.direct[i];
    for (std::size_t a = 0; a < 3 && !found.flux.empty(); ++a)
    {
      light.netFlux[(i * light.channels + channel) * 3 + a] = found.flux[a * voxels + i];
    }
  }
  light.facePower.resize(std::max(light.facePower.size(), found.facePower.size() * light.channels), 0.0f);
  for (std::size_t cell = 0; cell < found.facePower.size(); ++cell)
  {
    light.facePower[cell * light.channels + channel] = found.facePower[cell];
  }
  TakePowers(light, found.ledger, channel);
  AddRows(light.convergence, found.convergence, channel == 0);
}

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
    doubts.push_back("The mean cosine g varies by voxel; discrete ordinates are solved with its mean, weighted by "
                     "sigma_s. Light Propagation Maps tell voxels apart.");
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

void Judge(const OrdinatesSettings& settings, bool diverged, LightField& light)
{
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  const bool isAsked = settings.maximumOrders > 0 || (settings.seriesAfter > 0 && !IsPublished(settings));
  light.converged = !diverged && (isAsked || residual <= settings.tolerance);
  if (diverged)
  {
    light.doubts.push_back("The light grows without end and was stopped after " +
      std::to_string(light.convergence.size()) + " steps: it has no meaning.");
  }
  else if (!light.converged)
  {
    light.doubts.push_back("The light has not converged: after " + std::to_string(light.convergence.size()) +
      " orders its estimated relative error is " + Text("%.3g", residual) + ", Tolerance is " +
      Text("%.3g", settings.tolerance) + ". Light Propagation Maps accelerate such media.");
  }
}
}

LightField SolveDiscreteOrdinates(Device& device, const Medium& medium, const Illumination& illumination,
  const OrdinatesSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  Check(settings);
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  const FarLight far = FarLightOf(problem, settings);
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
    const PhaseFunction function = FunctionOf(problem.TheMedium(), c);
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
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.halfRangeFlux = HalfRangeFlux({ 0, false, far.directions });
  light.faceAlbedo = illumination.faceAlbedo;
  light.device = device.Name();
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
