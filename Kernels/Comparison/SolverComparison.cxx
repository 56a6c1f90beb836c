#include "Comparison/SolverComparison.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
std::string SizeOf(const Grid& grid)
{
  return std::to_string(grid.size[0]) + "x" + std::to_string(grid.size[1]) + "x" + std::to_string(grid.size[2]);
}

/// Copies values of one channel to three channels if `wanted` is three.
/// @param has  channels of `values`
std::vector<float> InChannels(std::vector<float> values, int has, int wanted)
{
  if (has == wanted)
  {
    return values;
  }
  std::vector<float> inAll(values.size() * 3);
  for (std::size_t i = 0; i < inAll.size(); ++i)
  {
    inAll[i] = values[i / 3];
  }
  return inAll;
}

/// Computes errors. Results are first transferred to the coarser of two grids, the scene's and the reference's.
class Comparator
{
public:
  Comparator(const Grid& scene, const ReferenceLight& reference)
    : SceneGrid(scene)
    , Reference(reference)
    , ToReference(FactorsBetween(scene, reference.grid))
    , IsThere(!reference.fluence.empty() || !reference.fluenceDirect.empty())
  {
    const std::optional<Factors> fromReference = FactorsBetween(reference.grid, scene);
    Require(this->ToReference || fromReference,
      "The reference has " + SizeOf(reference.grid) + " voxels, the medium " + SizeOf(scene) +
        ". They must fill the same box, with a whole number of voxels of one in each of the other. Resample the "
        "reference.");
    this->Fluence = this->AsCompared(reference.fluence, fromReference);
    this->FluenceDirect = this->AsCompared(reference.fluenceDirect, fromReference);
  }

  /// Whether the reference includes the quantity that a method computes. True if there is no reference, since runs are
  /// then only timed.
  bool Has(ComparedMethod method) const { return !this->IsThere || !this->For(QuantityOf(method)).empty(); }

  /// Fluence of the reference in the scene's voxels, for pictures; empty if it is not known.
  std::vector<float> Seen() const
  {
    std::vector<float> seen = this->Fluence;
    if (this->ToReference && !seen.empty())
    {
      seen = Repeated(seen.data(), this->Reference.channels, this->Reference.grid, *this->ToReference);
    }
    std::replace_if(
      seen.begin(), seen.end(), [](float value) { return std::isnan(value); }, 0.0f);
    return seen;
  }

  /// Errors of the light of a run; NaN without a reference.
  RelativeErrors ErrorsOf(const LightField& light, const ComparedRun& run) const
  {
    const ComparedQuantity quantity = QuantityOf(run.method);
    if (!this->IsThere)
    {
      return { ComparisonRow::Unknown, ComparisonRow::Unknown, ComparisonRow::Unknown };
    }
    if (quantity == ComparedQuantity::Radiance)
    {
      return tyndall::ErrorsOf(light.fluence, this->Reference.radiance);
    }
    const std::optional<Factors> coarsening = FactorsBetween(this->SceneGrid, run.grid);
    std::vector<float> values = Repeated(light.fluence.data(), light.channels, run.grid, *coarsening);
    if (this->ToReference)
    {
      values = Averaged(values.data(), light.channels, this->SceneGrid, *this->ToReference);
    }
    const int channels = std::max(light.channels, this->Reference.channels);
    return tyndall::ErrorsOf(InChannels(std::move(values), light.channels, channels),
      InChannels(this->For(quantity), this->Reference.channels, channels));
  }

private:
  const std::vector<float>& For(ComparedQuantity quantity) const
  {
    return quantity == ComparedQuantity::FluenceDirect ? this->FluenceDirect : this->Fluence;
  }

  std::vector<float> AsCompared(const std::vector<float>& values, const std::optional<Factors>& fromReference) const
  {
    return this->ToReference || values.empty()
      ? values
      : Averaged(values.data(), this->Reference.channels, this->Reference.grid, *fromReference);
  }

  Grid SceneGrid;
  const ReferenceLight& Reference;
  /// number of voxels of the scene's grid per voxel of the reference's grid, along each axis; no value if the
  /// reference's grid is finer
  std::optional<Factors> ToReference;
  bool IsThere = false;
  std::vector<float> Fluence, FluenceDirect;
};

/// Reason why the quantity that a method computes cannot be compared; empty if it can be compared.
std::string WhyNotComparable(ComparedMethod method, const Comparator& comparator)
{
  return comparator.Has(method)                             ? ""
    : QuantityOf(method) == ComparedQuantity::FluenceDirect ? "the reference has no 'fluence_direct'"
                                                            : "the reference has no 'fluence'";
}

/// Reason why a method is not compared on a scene; empty if it is compared.
std::string WhyNot(ComparedMethod method, const ComparedScene& scene, const Comparator& comparator)
{
  const bool lattice = method == ComparedMethod::LatticeBoltzmann;
  const std::string whyNotComparable = WhyNotComparable(method, comparator);
  if (method == ComparedMethod::Pictures)
  {
    return scene.seen.values ? "" : "the reference has no 'fluence'";
  }
  if (lattice && !HasCubicVoxels(scene.medium.grid))
  {
    return "its voxels have to be cubes";
  }
  // These methods need photons: the photon methods, and lattice runs with a varying refractive index, whose uncollided
  // light is computed by photons.
  if (IsOfPhotons(method) || method == ComparedMethod::PhotonsThenMaps || (lattice && scene.BendsLight()))
  {
    const std::string why = scene.WhyNotByPhotons(QuantityOf(method) == ComparedQuantity::Fluence);
    return why.empty() ? whyNotComparable : why;
  }
  const bool published = method == ComparedMethod::Published || method == ComparedMethod::PublishedSequential;
  return scene.BendsLight()     ? "it does not bend light, and the index of this medium varies"
    : !whyNotComparable.empty() ? whyNotComparable
    : published                 ? WhyNotPublished(scene.medium, scene.illumination)
                                : "";
}

/// The runs of one method, cheapest first, and the index of the next one.
struct Lane
{
  std::vector<ComparedRun> runs;
  std::size_t next = 0;
  double secondsOfCost = 0.0; ///< seconds per unit of ComparedRun::cost, by the last run with all orders

  bool Done() const { return this->next == this->runs.size(); }
};

/// Run time of a setting, seconds: the smallest of all its runs, which other load on the machine affects least.
struct RunTime
{
  static constexpr double Endless = std::numeric_limits<double>::infinity();
  double wall = Endless, core = Endless;
  int runs = 0;

  void Add(const RunTime& run)
  {
    *this = { std::min(this->wall, run.wall), std::min(this->core, run.core), this->runs + 1 };
  }
};

/// Executes and times runs, and adds their rows to the comparison.
class Runner
{
public:
  Runner(Device& device, const ComparisonSettings& settings, const Comparator& comparator, Comparison& result)
    : TheDevice(device)
    , Settings(settings)
    , TheComparator(comparator)
    , Result(result)
  {
  }

  /// Executes the next run of a method.
  /// @param left  time that the run may take, seconds
  void RunNext(Lane& lane, double left, const Monitor& monitor)
  {
    const ComparedRun& run = lane.runs[lane.next++];
    if (left <= 0.0 || (run.allOrders && lane.secondsOfCost * run.cost > left))
    {
      this->LeaveOut(run, "was not begun, for its time was not left");
      ++this->Late;
      return;
    }
    double seconds = left;
    try
    {
      seconds = this->Run(run, left, PartUntil(this->TheDevice, this->TheDevice.Now() + left, monitor, 0.0, 1.0));
    }
    catch (const TimeIsUp&)
    {
      this->LeaveOut(run, "was stopped when its time was up");
      ++this->Late;
    }
    catch (const DeviceError& error)
    {
      this->LeaveOut(run, error.what());
      return;
    }
    lane.secondsOfCost = run.allOrders ? seconds / run.cost : lane.secondsOfCost;
  }

  /// Executes the quick runs again, all in turn, so that other load on the machine at one time affects no row alone.
  /// The quickest have most turns. Ends early if the device fails.
  /// @param end  time of the device's clock at which the budget is spent
  void RepeatQuick(double end, const Monitor& monitor)
  {
    constexpr double quick = 0.05, enough = 0.25; // seconds, of a run and of all turns of a row
    constexpr std::size_t turns = 25;
    const Monitor watch = PartUntil(this->TheDevice, end, monitor, 1.0, 1.0);
    LightField light;
    const std::size_t rows = this->Executed.size();
    try
    {
      for (std::size_t i = 0; i < turns * rows; ++i)
      {
        ComparisonRow& row = this->Result.rows[i % rows];
        const double had = row.seconds * static_cast<double>(i / rows);
        if (row.seconds < quick && had < enough && this->TheDevice.Now() + row.seconds < end)
        {
          const RunTime time = this->Timed(*this->Executed[i % rows], light, watch);
          row.seconds = std::min(row.seconds, time.wall);
          row.coreSeconds = std::min(row.coreSeconds, time.core); // stays unknown
        }
      }
    }
    catch (const TimeIsUp&) // all rows have their times
    {
    }
    catch (const DeviceError&)
    {
    }
  }

  int RunsLeftForTime() const { return this->Late; }

private:
  void LeaveOut(const ComparedRun& run, const std::string& why)
  {
    this->Result.leftOut.push_back(std::string(NameOf(run.method)) + ", " + run.setting + ": " + why);
  }

  RunTime Timed(const ComparedRun& run, LightField& light, const Monitor& monitor)
  {
    const double start = this->TheDevice.Now(), core = CoreSeconds();
    light = run.solve(false, monitor);
    return { this->TheDevice.Now() - start, CoreSeconds() - core, 1 };
  }

  /// Runs a setting repeatedly. The time of a run that compiled kernels is left out, unless the time limit allows no
  /// other run.
  /// @param left  time that all repeats may take, seconds
  /// @param light  receives the light
  RunTime TimeOf(const ComparedRun& run, double left, LightField& light, const Monitor& monitor)
  {
    constexpr double partForRepeats = 0.2;
    const double end = this->TheDevice.Now() + left;
    const std::size_t made = KernelsMade();
    const RunTime first = this->Timed(run, light, monitor);
    RunTime time;
    if (made == KernelsMade())
    {
      time = first;
    }
    try
    {
      if (time.runs == 0 && this->TheDevice.Now() + first.wall <= end)
      {
        time = this->Timed(run, light, monitor);
      }
      while (
        time.runs > 0 && time.runs < this->Settings.repeats && (time.runs + 1.0) * time.wall <= partForRepeats * left)
      {
        time.Add(this->Timed(run, light, monitor));
      }
    }
    catch (const TimeIsUp&) // the time is up, but at least one run is complete
    {
    }
    if (time.runs == 0)
    {
      this->LeaveOut(run, "its seconds are those of a run that compiled kernels; there was no time for another");
      time = first;
    }
    return time;
  }

  /// Executes a run with its repeats, and adds its row to the comparison.
  /// @return run time, seconds
  double Run(const ComparedRun& run, double left, const Monitor& monitor)
  {
    this->TheDevice.ResetPeak();
    const std::size_t before = this->TheDevice.BytesInUse();
    LightField light;
    const RunTime time = this->TimeOf(run, left, light, monitor);
    const bool host = run.method == ComparedMethod::PublishedSequential;
    ComparisonRow row;
    row.method = run.method;
    row.setting = run.setting;
    row.filters = run.filters;
    row.grid = run.grid;
    row.seconds = time.wall;
    row.coreSeconds = host || this->TheDevice.IsCpu() ? time.core : ComparisonRow::Unknown;
    row.peakBytes = host ? ComparisonRow::Unknown : static_cast<double>(this->TheDevice.PeakBytes() - before);
    this->Compare(row, run, light);
    this->Estimate(row, run, light, monitor);
    this->Result.rows.push_back(std::move(row));
    this->Executed.push_back(&run);
    return time.wall;
  }

  void Compare(ComparisonRow& row, const ComparedRun& run, const LightField& light) const
  {
    const RelativeErrors errors = this->TheComparator.ErrorsOf(light, run);
    row.errorL2 = errors.l2;
    row.errorMax = errors.max;
    row.errorRelative = errors.relative;
    const bool isPicture = QuantityOf(run.method) == ComparedQuantity::Radiance;
    row.balance = isPicture ? ComparisonRow::Unknown : light.balance.RelativeError(light.channels);
    row.iterations = std::max<int>(1, static_cast<int>(light.convergence.size()));
    row.powerIn = Sum(light.balance.entered) + Sum(light.balance.emitted);
    std::transform(light.facePowerOut.begin(), light.facePowerOut.end(), row.facePowerOut.begin(), Sum);
  }

  void Estimate(ComparisonRow& row, const ComparedRun& run, LightField& light, const Monitor& monitor) const
  {
    if (this->Settings.estimates && run.estimates)
    {
      try
      {
        light = run.solve(true, monitor);
      }
      catch (const TimeIsUp&) // the row is kept, without an estimated error
      {
        return;
      }
    }
    row.estimatedError = light.relativeError > 0.0 ? light.relativeError : ComparisonRow::Unknown;
  }

  Device& TheDevice;
  const ComparisonSettings& Settings;
  const Comparator& TheComparator;
  Comparison& Result;
  std::vector<const ComparedRun*> Executed; ///< runs of Result.rows
  int Late = 0;
};

/// The runs of all methods that the scene allows. If a method is left out, the reason is added to result.leftOut.
std::vector<Lane> LanesOf(Device& device, const ComparedScene& scene, const ComparisonSettings& settings,
  const Comparator& comparator, Comparison& result)
{
  std::vector<Lane> lanes;
  for (ComparedMethod method : settings.methods)
  {
    const std::string why = WhyNot(method, scene, comparator);
    if (why.empty())
    {
      lanes.push_back({ RunsOf(method, device, scene, settings.tried) });
    }
    else
    {
      result.leftOut.push_back(std::string(NameOf(method)) + ": " + why);
    }
  }
  return lanes;
}

/// Executes one run of each method in turn, so that other load on the machine affects all methods equally, and time
/// that one method does not need is left for the others.
/// @param end  time of the device's clock at which the budget is spent
/// @return number of executed runs
std::size_t RunInTurns(
  const Device& device, std::vector<Lane>& lanes, Runner& runner, double end, const Monitor& monitor)
{
  std::size_t count = 0, done = 0;
  for (const Lane& lane : lanes)
  {
    count += lane.runs.size();
  }
  while (done < count)
  {
    for (Lane& lane : lanes)
    {
      if (!lane.Done())
      {
        const auto active = std::count_if(lanes.begin(), lanes.end(), [](const Lane& other) { return !other.Done(); });
        const double share = (end - device.Now()) / static_cast<double>(active);
        runner.RunNext(lane, share, OfPart(monitor, 1.0 * done / count, (done + 1.0) / count));
        ++done;
      }
    }
  }
  return count;
}

/// Reference light, computed by ConvergedLight within half of the time budget. If the scene has a mesh, the reference
/// is computed from it. Empty, with a warning, if the machine is too slow for any reference.
/// @param budget  time budget of the comparison, seconds
ReferenceLight ReferenceWithin(Device& device, const ComparedScene& scene, const ComparedSettings& tried, double budget,
  std::vector<std::string>& warnings, const Monitor& monitor)
{
  constexpr std::size_t few = std::size_t(1) << 18; // voxels up to which edges a quarter as long fit most devices
  constexpr int samples = 16;
  const int refinement = scene.medium.grid.VoxelCount() <= few ? 4 : 2;
  const Monitor watch = PartUntil(device, device.Now() + 0.5 * budget, monitor, 0.0, 1.0);
  try
  {
    if (!scene.mesh)
    {
      return ConvergedLight(device, scene, tried, 0.5 * budget, watch);
    }
    VoxelizationSettings voxelization;
    voxelization.samples = samples;
    const VoxelizedScene fine(device, scene, refinement, voxelization, RefractiveMediumSettings().filterSize, watch);
    ReferenceLight reference = ConvergedLight(device, fine.Scene(), tried, 0.5 * budget, watch);
    reference.text += "; the mesh in voxels of 1/" + std::to_string(refinement) + " of the edge, supersampling " +
      std::to_string(samples);
    return reference;
  }
  catch (const TimeIsUp&)
  {
    warnings.push_back("No reference could be made in half of the " + Text("%g", budget) +
      " s of TimeBudget: runs are measured, and their errors are not known. Give more time, a smaller medium, or a "
      "reference of your own.");
    ReferenceLight none;
    none.grid = scene.medium.grid;
    return none;
  }
}

bool Compares(const ComparisonSettings& settings, ComparedMethod method)
{
  return std::find(settings.methods.begin(), settings.methods.end(), method) != settings.methods.end();
}

void Check(const ComparisonSettings& settings, const ComparedScene& scene)
{
  Check(settings.tried);
  Require(!settings.methods.empty(), "No method is chosen. Switch on at least one.");
  Require(settings.repeats >= 1 && settings.timeBudget > 0.0, "Repeats must be at least 1, TimeBudget above 0 s.");
  Require(settings.acceptedError > 0.0, "AcceptedError must be above 0.");
  Require(!Compares(settings, ComparedMethod::Pictures) || scene.camera,
    "Pictures are compared, but there is no camera: CameraPosition and CameraFocalPoint are the same "
    "point. Set them (the button Take Camera does), or switch Pictures off.");
  Require(
    !Compares(settings, ComparedMethod::Voxelizer) || scene.mesh, "Voxelisations are compared, but there is no mesh.");
}

/// Settings of the runs, with the reference that the compared methods need.
ComparedSettings TriedBy(const ComparisonSettings& settings)
{
  ComparedSettings tried = settings.tried;
  const std::vector<ComparedMethod>& methods = settings.methods;
  if (tried.monteCarloReference == MonteCarloReference::WhereItCanBeat &&
    std::all_of(methods.begin(), methods.end(), IsOfPhotons))
  {
    // The reference is not computed by photons: light propagation maps have no noise, and share no solver with the
    // compared photons.
    tried.monteCarloReference = MonteCarloReference::Never;
  }
  tried.scattersReference = tried.monteCarloReference == MonteCarloReference::Always ||
    std::any_of(methods.begin(), methods.end(), [](ComparedMethod method) {
      return method == ComparedMethod::MonteCarlo || method == ComparedMethod::LatticeBoltzmann ||
        method == ComparedMethod::PhotonsThenMaps || method == ComparedMethod::Pictures;
    });
  return tried;
}
}

RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference)
{
  double differences = 0.0, squares = 0.0, farthest = 0.0, largest = 0.0, relative = 0.0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    if (std::isnan(reference[i]))
    {
      continue;
    }
    const double difference = std::abs(static_cast<double>(light[i]) - reference[i]);
    differences += difference * difference;
    squares += static_cast<double>(reference[i]) * reference[i];
    if (reference[i] > 0.0f)
    {
      relative += std::pow(difference / reference[i], 2.0);
      ++lit;
    }
    // std::max would not propagate NaN.
    farthest = difference <= farthest ? farthest : difference;
    largest = std::max(largest, static_cast<double>(reference[i]));
  }
  return squares > 0.0 ? RelativeErrors{ std::sqrt(differences / squares), farthest / largest,
    std::sqrt(relative / static_cast<double>(lit)) }
                       : RelativeErrors{ ComparisonRow::Unknown, ComparisonRow::Unknown, ComparisonRow::Unknown };
}

void MarkPareto(std::vector<ComparisonRow>& rows)
{
  const auto beats = [](const ComparisonRow& a, const ComparisonRow& b) {
    return QuantityOf(a.method) == QuantityOf(b.method) && a.seconds <= b.seconds && a.errorL2 <= b.errorL2 &&
      (a.seconds < b.seconds || a.errorL2 < b.errorL2);
  };
  for (ComparisonRow& row : rows)
  {
    row.pareto = std::isfinite(row.errorL2) && std::isfinite(row.seconds) &&
      std::none_of(rows.begin(), rows.end(), [&](const ComparisonRow& other) { return beats(other, row); });
  }
}

namespace
{
/// Finds the row to recommend for a quantity (MarkRecommended). Considers only rows whose run a user can repeat with
/// filters; null if there is none.
ComparisonRow* BestOf(std::vector<ComparisonRow>& rows, ComparedQuantity quantity, double acceptedError)
{
  const auto isBetter = [=](const ComparisonRow& a, const ComparisonRow& b) {
    const bool isEnough = a.errorL2 <= acceptedError;
    return isEnough != (b.errorL2 <= acceptedError) ? isEnough
      : isEnough                                    ? a.seconds < b.seconds
                                                    : a.errorL2 < b.errorL2;
  };
  ComparisonRow* best = nullptr;
  for (ComparisonRow& row : rows)
  {
    const bool counts = QuantityOf(row.method) == quantity && !row.filters.empty() && std::isfinite(row.errorL2);
    best = counts && (!best || isBetter(row, *best)) ? &row : best;
  }
  return best;
}

/// Changes the rows of pictures so that they show the light of the filters `light`.
void ShowLight(const std::string& light, std::vector<ComparisonRow>& rows)
{
  const auto last = std::count(light.begin(), light.end(), '|') + 1;
  for (ComparisonRow& row : rows)
  {
    if (QuantityOf(row.method) == ComparedQuantity::Radiance)
    {
      row.filters = light + " | " + row.filters + " Input=#" + std::to_string(last);
    }
  }
}
}

void MarkRecommended(std::vector<ComparisonRow>& rows, double acceptedError)
{
  for (const auto quantity : { ComparedQuantity::Fluence, ComparedQuantity::FluenceDirect, ComparedQuantity::Radiance })
  {
    ComparisonRow* const best = BestOf(rows, quantity, acceptedError);
    if (best)
    {
      best->recommended = true;
    }
    if (best && quantity == ComparedQuantity::Fluence)
    {
      ShowLight(best->filters, rows);
    }
  }
}

const ComparisonRow* RecommendedOf(const std::vector<ComparisonRow>& rows)
{
  for (const auto quantity : { ComparedQuantity::Radiance, ComparedQuantity::Fluence, ComparedQuantity::FluenceDirect })
  {
    const auto found = std::find_if(rows.begin(), rows.end(),
      [=](const ComparisonRow& row) { return row.recommended && QuantityOf(row.method) == quantity; });
    if (found != rows.end())
    {
      return &*found;
    }
  }
  return nullptr;
}

Comparison CompareSolvers(Device& device, const ComparedScene& given, const ComparisonSettings& settings,
  const ReferenceLight* reference, const Monitor& monitor)
{
  Check(settings, given);
  Check(given.medium);
  Check(given.illumination);
  const double end = device.Now() + settings.timeBudget;
  const double begun = reference ? 0.0 : 0.4; // progress that is reported when the runs begin, in [0, 1]
  Comparison result;
  result.device = device.Name();
  result.reference = reference ? *reference
                               : ReferenceWithin(device, given, TriedBy(settings), settings.timeBudget, result.warnings,
                                   OfPart(monitor, 0.0, begun));
  const Comparator comparator(given.medium.grid, result.reference);
  ComparedScene scene = given;
  const bool shows = Compares(settings, ComparedMethod::Pictures);
  const std::vector<float> seen = shows ? comparator.Seen() : std::vector<float>();
  if (!seen.empty())
  {
    scene.seen = { seen.data(), result.reference.channels };
    result.reference.radiance = ReferencePicture(device, scene, OfPart(monitor, begun, begun));
  }
  std::vector<Lane> lanes = LanesOf(device, scene, settings, comparator, result);
  Runner runner(device, settings, comparator, result);
  const std::size_t runs = RunInTurns(device, lanes, runner, end, OfPart(monitor, begun, 1.0));
  runner.RepeatQuick(end, OfPart(monitor, 1.0, 1.0));
  if (runner.RunsLeftForTime() > 0)
  {
    result.warnings.push_back("TimeBudget, " + Text("%g", settings.timeBudget) + " s, was over before " +
      std::to_string(runner.RunsLeftForTime()) + " of " + std::to_string(runs) +
      " runs were made; Left Out names them. Give more time, or compare fewer settings.");
  }
  std::stable_sort(result.rows.begin(), result.rows.end(),
    [](const ComparisonRow& a, const ComparisonRow& b) { return a.method < b.method; });
  MarkPareto(result.rows);
  MarkRecommended(result.rows, settings.acceptedError);
  return result;
}
}
