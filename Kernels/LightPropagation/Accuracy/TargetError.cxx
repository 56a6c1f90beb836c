#include "LightPropagation/Accuracy/TargetError.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Light/ChannelReduction.h"
#include "Light/KeptLight.h"
#include "Light/Quality.h"
#include "LightPropagation/Accuracy/DirectionForecast.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Problem/SceneChecks.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double Aim = 0.95;          ///< Goal: estimated error at which the search ends, as a fraction of the target
constexpr double DirectionPart = 0.9; ///< angular error that is allowed, as a fraction of Goal
/// At least this fraction of Goal (the error at which the search ends) is allowed for the angular error, even if the
/// error due to voxel size leaves less. Voxels are halved only if the error due to voxel size exceeds the same fraction
/// of Goal.
constexpr double LeastRoom = 0.3;
/// More directions do not help if the error due to voxel size alone is above this multiple of Goal, the error at which
/// the search ends.
constexpr double MuchTooCoarse = 1.5;
constexpr double TolerancePart = 0.3;
constexpr double LooseTolerance = 1e-2;
/// If the error of uncollided light is above this fraction of the total angular error, one more solve measures it
/// separately.
constexpr double MuchUncollided = 0.3;
constexpr int Few = 9, More = 25;
constexpr double LeastEmissionError = 0.005;

/// Fluence of a solve on the coarse grid, and the settings of that solve.
struct CoarseLight
{
  PropagationSettings settings;
  std::vector<float> fluence;

  /// Whether a solve with `others` would give the same fluence on the coarse grid as this solve.
  bool Has(const PropagationSettings& others) const
  {
    return others.directionsPerFace == this->settings.directionsPerFace && others.uncollidedDirections == 0 &&
      others.mapResolution == this->settings.mapResolution && others.staggeredRays == this->settings.staggeredRays;
  }
};

/// Search of SolveToTargetError() for the cheapest solve that meets the target error. Collective: all ranks take the
/// same steps.
class TargetSearch
{
public:
  TargetSearch(const SceneBlock& scene, const PropagationSettings& settings, double target, const Monitor& monitor,
    const PropagationSolver& solve, const ErrorOrders& orders)
    : TheScene(scene)
    , Asked(settings)
    , Goal(Aim * target)
    , Target(target)
    , TheMonitor(monitor)
    , Solver(solve)
    , Orders(orders)
    , Blocks(scene.domain.Comm(), scene.domain.Partition())
    , Coarse(Blocks, scene)
  {
    const PropagationSettings byDefault;
    SetUnlessChosen(this->Asked.tolerance, byDefault.tolerance, std::min(LooseTolerance, TolerancePart * this->Goal));
    SetUnlessChosen(this->Asked.emissionError, byDefault.emissionError,
      std::clamp(target, LeastEmissionError, byDefault.emissionError));
  }

  TargetLight Run()
  {
    this->LookAtDirections();
    this->SolveAlong(this->CheapestWithin(this->Goal), 0.12, 0.4);
    if (this->Light.relativeError > this->Goal)
    {
      this->TryBetterDirections();
    }
    if (this->Light.relativeError > this->Goal)
    {
      this->TryHalves();
    }
    return this->Finish(std::move(this->Light));
  }

private:
  LightField Count(const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor)
  {
    ++this->Solves;
    return this->Solver(scene, settings, monitor);
  }

  LightField OnCoarse(PropagationSettings settings, double from, double to)
  {
    settings.netFlux = false;
    settings.facePower = false;
    settings.storeMoments = false;
    settings.storedDirections = 1;
    settings.adaptDirections = false;
    return this->Count(this->Coarse.Scene(), settings, OfPart(this->TheMonitor, from, to));
  }

  /// Cheapest settings with an angular error below `room`, the error that is allowed for directions.
  PropagationSettings CheapestWithin(double room) const
  {
    return this->Forecast->Cheapest(this->Asked, DirectionPart * room, this->Orders.mostDirections);
  }

  /// Solves on the coarse grid with few and with more directions, and initialises Forecast from these solutions.
  void LookAtDirections()
  {
    PropagationSettings settings = this->Asked;
    settings.uncollidedDirections = 0;
    settings.staggeredRays = false;
    settings.directionsPerFace = Few;
    const LightField few = this->OnCoarse(settings, 0.0, 0.03);
    this->AlongFew = { settings, few.fluence };
    settings.directionsPerFace = More;
    const LightField more = this->OnCoarse(settings, 0.03, 0.1);
    this->AlongMore = { settings, more.fluence };
    this->Forecast.emplace(this->TheScene.domain.Comm(), few, Few, more, More);
    if (this->MayHaveFinerUncollided())
    {
      settings.directionsPerFace = Few;
      settings.uncollidedDirections = More;
      const LightField between = this->OnCoarse(settings, 0.1, 0.12);
      if (between.uncollidedDirections > 0)
      {
        this->Forecast->Separate(this->TheScene.domain.Comm(), few, between, more);
      }
    }
  }

  /// Whether to measure the error of uncollided light separately: it is large, there are boundary sources, and the
  /// target needs many directions.
  bool MayHaveFinerUncollided() const
  {
    return this->Forecast->UncollidedPart() > MuchUncollided && ShinesThroughFaces(this->TheScene.illumination) &&
      this->CheapestWithin(this->Goal).directionsPerFace > More;
  }

  /// Solves on the scene's grid and, for the error estimate, on the coarse grid.
  /// @param from, to  range of the progress that these solves report
  void SolveAlong(const PropagationSettings& settings, double from, double to)
  {
    this->Used = settings;
    const double middle = from + 0.8 * (to - from);
    this->Light = this->Count(this->TheScene, settings, OfPart(this->TheMonitor, from, middle));
    const CoarseLight* const solved = this->AlongFew.Has(settings) ? &this->AlongFew
      : this->AlongMore.Has(settings)                              ? &this->AlongMore
                                                                   : nullptr;
    const CoarseLight& other = solved == &this->AlongMore ? this->AlongFew : this->AlongMore;
    const double error = this->Forecast->Error(settings);
    const double order =
      AnyHasPosition(this->TheScene.illumination.lights) ? this->Orders.ofTargetBesideLamps : this->Orders.ofTarget;
    if (!solved && this->IsMetAtMost(other.fluence, error, order))
    {
      return;
    }
    const std::vector<float> same = solved ? solved->fluence : this->OnCoarse(settings, middle, to).fluence;
    this->Parts = WriteErrorEstimate(this->Light, this->Blocks, same, other.fluence,
      this->Forecast->PartOfDifference(settings, other.settings), order);
  }

  /// Angular error that is allowed besides the error `inSpace` due to voxel size and the residual, so that the total is
  /// Goal (the error at which the search ends); 0 if it would be below the fraction LeastRoom of Goal.
  double RoomBeside(double inSpace) const
  {
    const double others = std::hypot(inSpace, this->Parts.residual);
    const double room = std::sqrt(std::max(0.0, this->Goal * this->Goal - others * others));
    return room < LeastRoom * this->Goal ? 0.0 : room;
  }

  /// Cheapest settings with an angular error of at most `room`; none if the current settings suffice, or if no settings
  /// have a smaller error.
  std::optional<PropagationSettings> BetterWithin(double room)
  {
    if (this->Parts.inDirections <= room)
    {
      return {};
    }
    this->Forecast->Correct(this->Parts.inDirections / this->Forecast->Error(this->Used));
    const PropagationSettings better = this->CheapestWithin(room);
    return this->Forecast->Error(better) < this->Forecast->Error(this->Used) ? std::optional(better) : std::nullopt;
  }

  /// Solves on the scene's grid again, with more directions, if the angular error is too large. This comes before
  /// halving voxels, which takes far longer; besides, the estimated error due to voxel size is too large while the
  /// angular error is large.
  void TryBetterDirections()
  {
    const double room = std::max(this->RoomBeside(this->Parts.inSpace), LeastRoom * this->Goal);
    if (this->Parts.inSpace > MuchTooCoarse * this->Goal)
    {
      return;
    }
    if (const std::optional<PropagationSettings> better = this->BetterWithin(room))
    {
      this->SolveAlong(*better, 0.4, 0.6);
    }
  }

  /// Computes an upper estimate of the error without a further solve. Attributes the whole difference from a coarse
  /// solution, which has another number of directions, to voxel size, and adds the predicted angular error. Stores the
  /// result as error estimate of the light.
  /// @param other  fluence of the coarse solution
  /// @param error  predicted angular error
  /// @param order  order of convergence in voxel size
  /// @return whether the error is at most Goal; the search then ends without a separate estimate of the error due to
  ///   voxel size
  bool IsMetAtMost(const std::vector<float>& other, double error, double order)
  {
    ErrorParts parts = WriteErrorEstimate(this->Light, this->Blocks, other, other, 0.0, order);
    parts.inDirections = error;
    const double all = std::sqrt(this->Light.relativeError * this->Light.relativeError + error * error);
    const double scale = this->Light.relativeError > 0.0 ? all / this->Light.relativeError : 1.0;
    for (float& value : this->Light.fluenceError)
    {
      value *= static_cast<float>(scale);
    }
    this->Light.relativeError = all;
    this->Parts = parts;
    return all <= this->Goal;
  }

  /// Ratio of the error due to voxel size to that error with voxels of half the edge length; 4 for light propagation
  /// maps.
  double FallInHalves() const { return std::pow(2.0, this->Orders.inSpace); }

  /// Solves with voxels of half the edge length, if this is predicted to reduce the error due to voxel size enough.
  void TryHalves()
  {
    const double room = this->RoomBeside(this->Parts.inSpace / this->FallInHalves());
    if (room == 0.0 || this->Parts.inSpace <= LeastRoom * this->Goal)
    {
      return;
    }
    if (const std::optional<PropagationSettings> better = this->BetterWithin(room))
    {
      this->Used = *better;
      this->Parts.inDirections = this->Forecast->Error(*better);
    }
    if (this->Parts.inDirections <= room)
    {
      this->Divide();
    }
  }

  void Divide()
  {
    std::optional<DividedScene> divided;
    LightField light;
    const Domain& domain = this->TheScene.domain;
    domain.Collective(
      [&] { divided.emplace(this->TheScene, DividedScene::Halves(domain.Whole(), this->Asked.periodic)); });
    try
    {
      light = this->Count(divided->Scene(), this->Used, OfPart(this->TheMonitor, 0.6, 1.0));
    }
    catch (const DeviceError& error) // thrown on all ranks, e.g. if memory is short
    {
      this->WhyNot = std::string(" Voxels of half the edge were tried: ") + error.what();
      return;
    }
    divided->Undo(light);
    this->InHalves = true;
    this->EstimateOfDivided(light);
    this->Light = std::move(light);
  }

  /// Sets the error estimate of a solution with halved voxels. The error due to voxel size follows from the difference
  /// from the solution with the original voxels (Richardson); angular error, residual and errorLength are taken from
  /// the previous estimate.
  void EstimateOfDivided(LightField& light)
  {
    double errors = 0.0, all = 0.0;
    const double rest = std::hypot(this->Parts.inDirections, this->Parts.residual);
    const double part = 1.0 / (this->FallInHalves() - 1.0);
    light.errorLength = this->Light.errorLength;
    light.fluenceError.resize(light.fluence.size());
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      const double error =
        std::hypot(part * (static_cast<double>(light.fluence[i]) - this->Light.fluence[i]), rest * light.fluence[i]);
      light.fluenceError[i] = static_cast<float>(error);
      errors += error * error;
      all += static_cast<double>(light.fluence[i]) * light.fluence[i];
    }
    const std::vector<double> sums = this->TheScene.domain.Sum(std::vector<double>{ errors, all });
    light.relativeError = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
    this->Parts.inSpace = std::sqrt(std::max(0.0, light.relativeError * light.relativeError - rest * rest));
  }

  TargetLight Finish(LightField&& light)
  {
    TargetLight found;
    found.settings = this->Used;
    found.met = light.relativeError <= this->Target; // false if the estimate is NaN (not known)
    found.divided = this->InHalves;
    found.solves = this->Solves;
    found.seconds = this->TheScene.domain.Max(ClockSeconds() - this->Start);
    if (!found.met)
    {
      light.doubts.push_back(this->WordsOfMiss(light.relativeError, found));
    }
    found.light = std::move(light);
    return found;
  }

  std::string WordsOfMiss(double error, const TargetLight& found) const
  {
    const std::string cost = " after " + std::to_string(found.solves) + " solves in " + Text("%.3g", found.seconds) +
      " s, of which voxels leave " + Text("%.2g", this->Parts.inSpace) + ", directions " +
      Text("%.2g", this->Parts.inDirections) + ", orders that were not computed " + Text("%.2g", this->Parts.residual);
    return "TargetError " + Text("%g", this->Target) + " is not met: the error of fluence is estimated to be " +
      Text("%.2g", error) + cost + ". " +
      (this->Parts.inSpace > this->Parts.inDirections ? "Give the medium in smaller voxels"
                                                      : "Leave directions and tolerance at their default values") +
      ", or ask for less." + this->WhyNot;
  }

  const SceneBlock& TheScene;
  PropagationSettings Asked;
  double Goal, Target;
  const Monitor& TheMonitor;
  const PropagationSolver& Solver;
  const ErrorOrders& Orders;
  CoarseBlocks Blocks;
  CoarseScene Coarse;
  const double Start = ClockSeconds();

  std::optional<DirectionForecast> Forecast;
  PropagationSettings Used;
  CoarseLight AlongFew, AlongMore;
  LightField Light;
  ErrorParts Parts;
  bool InHalves = false;
  int Solves = 0;
  std::string WhyNot;
};
}

LightField SolveColours(const SceneBlock& scene, const Monitor& monitor,
  const std::function<LightField(const SceneBlock&, const Monitor&)>& solve)
{
  const Domain& domain = scene.domain;
  const bool coloured = domain.Any(!domain.IsEmpty() && !TraitsOf(scene.medium, true).grey);
  return coloured ? SolveEachColour(scene, monitor, solve) : solve(scene, monitor);
}

LightField SolveEachColour(const SceneBlock& scene, const Monitor& monitor,
  const std::function<LightField(const SceneBlock&, const Monitor&)>& solve)
{
  int solves = 0;
  LightField light = SolveOneByOne(monitor, scene.kept, [&](int c, const Monitor& ofColour, KeptLight* kept) {
    const OneChannelScene one(scene.medium, scene.illumination, c);
    LightField found = solve({ scene.domain, one.medium, one.light, scene.index, kept }, ofColour);
    solves += found.solves;
    return found;
  });
  light.solves = solves;
  return light;
}

LightField LightOf(TargetLight&& found, std::vector<std::string> settings)
{
  LightField light = std::move(found.light);
  light.settingsUsed = std::move(settings);
  light.settingsUsed.push_back("VoxelsDividedBy = " + std::to_string(found.divided ? 2 : 1));
  light.solves = found.solves;
  return light;
}

TargetLight SolveToTargetError(const SceneBlock& scene, const PropagationSettings& settings, double target,
  const Monitor& monitor, const PropagationSolver& solve, const ErrorOrders& orders)
{
  if (!(target > 0.0 && target < 1.0))
  {
    throw InvalidInput("TargetError is " + Text("%g", target) + "; it must be above 0 and below 1.");
  }
  Check(scene.domain, scene.medium, scene.illumination, settings); // the scene is checked before solves on coarse grids
  return TargetSearch(scene, settings, target, monitor, solve, orders).Run();
}
}
