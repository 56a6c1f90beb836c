// TargetError against the best hand-made setting: true error and time.
// `./run bench target [tuning] [falls] [size 0.5] [scene 3]`
// Coverage of the errors that solvers estimate: `./run bench target coverage [maps | ordinates | lattice | pictures]`

#include "Measure.h"
#include "Program.h"
#include "Report.h"
#include "TargetCoverage.h"
#include "TargetFalls.h"
#include "TargetScenes.h"

#include "Light/Quality.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/PropagationQuality.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>

using namespace tyndall;

namespace bench
{
namespace
{
constexpr double Targets[] = { 0.05, 0.02, 0.01, 0.005 };
constexpr const char* LevelNames[] = { "draft", "default", "fine", "reference" };

/// A way to solve, its true error and its time.
struct Try
{
  std::string name;
  double error = 0.0, seconds = 0.0;
};

double ErrorOf(const std::vector<float>& found, const std::vector<float>& exact)
{
  double errors = 0.0, all = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const double error = static_cast<double>(found[i]) - exact[i];
    errors += error * error;
    all += static_cast<double>(exact[i]) * exact[i];
  }
  return std::sqrt(errors / all);
}

/// In voxels of half the edge, along so many directions that these leave a tenth of a percent.
std::vector<float> Exact(Device& device, const TargetScene& scene)
{
  const Grid& grid = scene.medium.grid;
  const DividedScene divided({ Domain(grid), scene.medium, scene.light }, DividedScene::Halves(grid, {}));
  PropagationSettings settings;
  settings.directionsPerFace = 400;
  settings.uncollidedDirections = 1600;
  settings.staggeredRays = true;
  settings.tolerance = 1e-5;
  settings.emissionError = 0.005;
  LightField light = SolveConservative(device, divided.Scene().medium, divided.Scene().illumination, settings);
  divided.Undo(light);
  return light.fluence;
}

/// Runs thrice after a first time that compiles, and takes the median.
double SecondsOf(const std::function<void()>& work, bool quick)
{
  work();
  std::vector<double> seconds;
  for (int i = 0; i < (quick ? 1 : 3); ++i)
  {
    const double start = WallSeconds();
    work();
    seconds.push_back(WallSeconds() - start);
  }
  return Median(seconds);
}

Try TrySettings(Device& device, const TargetScene& scene, const std::vector<float>& exact,
  const PropagationSettings& settings, const std::string& name, bool quick)
{
  Try tried = { name };
  LightField light;
  tried.seconds = SecondsOf([&] { light = SolveConservative(device, scene.medium, scene.light, settings); }, quick);
  tried.error = ErrorOf(light.fluence, exact);
  return tried;
}

/// A ladder that somebody would climb by hand.
std::vector<Try> ByHand(Device& device, const TargetScene& scene, const std::vector<float>& exact, bool quick)
{
  std::vector<Try> tries;
  const auto add = [&](int directions, int uncollided, int maps, double tolerance) {
    PropagationSettings settings;
    settings.directionsPerFace = directions;
    settings.uncollidedDirections = uncollided;
    settings.mapResolution = maps;
    settings.tolerance = tolerance;
    settings.staggeredRays = directions > 144;
    tries.push_back(TrySettings(device, scene, exact, settings,
      std::to_string(directions) + " directions, " + std::to_string(uncollided) + " unscattered, maps " +
        std::to_string(maps) + ", tolerance " + Text("%g", tolerance),
      quick));
  };
  const bool lit =
    std::any_of(scene.light.faces.begin(), scene.light.faces.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
  for (const int directions : { 4, 9, 16, 25, 49, 100 })
  {
    for (const double tolerance : { 1e-2, 1e-3 })
    {
      add(directions, 0, 1, tolerance);
      if (lit && directions < 49)
      {
        add(directions, 100, 1, tolerance);
        add(directions, 400, 1, tolerance);
        add(directions, 900, 1, tolerance);
      }
    }
  }
  add(25, 0, 2, 1e-3);
  add(256, lit ? 900 : 0, 1, 1e-3);
  return tries;
}

const Try* Best(const std::vector<Try>& tries, double target)
{
  const Try* best = nullptr;
  for (const Try& tried : tries)
  {
    best = tried.error <= target && (!best || tried.seconds < best->seconds) ? &tried : best;
  }
  return best;
}

/// How many of all are below their target, and within twice the best time.
struct Score
{
  int all = 0, below = 0, claimed = 0, claimedWrongly = 0, byHand = 0, within = 0;
};

std::string GridOf(const TargetScene& scene)
{
  const std::array<int, 3>& size = scene.medium.grid.size;
  return std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]);
}

void TryTarget(Device& device, const TargetScene& scene, const std::vector<float>& exact, double target,
  const std::vector<Try>& byHand, bool quick, Table& table, Score& score)
{
  const PropagationSolver solve = [&](const SceneBlock& block, const PropagationSettings& settings,
                                    const Monitor& monitor) {
    return SolveConservative(device, block.domain, block.medium, block.illumination, settings, monitor);
  };
  TargetLight found;
  const double seconds = SecondsOf(
    [&] {
      found = SolveToTargetError({ Domain(scene.medium.grid), scene.medium, scene.light }, {}, target, {}, solve);
    },
    quick);
  const double error = ErrorOf(found.light.fluence, exact);
  const Try* const best = Best(byHand, target);
  const double ratio = best ? seconds / best->seconds : std::numeric_limits<double>::quiet_NaN();
  ++score.all;
  score.below += error <= target;
  score.claimed += found.met;
  score.claimedWrongly += found.met && error > target;
  score.byHand += best != nullptr;
  score.within += best && ratio <= 2.0;
  const std::string used = std::to_string(found.settings.directionsPerFace) + "/" +
    std::to_string(found.settings.uncollidedDirections) + (found.divided ? ", divided" : "");
  JsonLine()
    .Add("bench", "target")
    .Add("case", scene.name)
    .Add("method", "TargetError " + Text("%g", target))
    .Add("grid", GridOf(scene))
    .Add("seconds", seconds)
    .Add("error_l2", error)
    .Add("estimate", found.light.relativeError)
    .Add("met", found.met ? 1.0 : 0.0)
    .Add("solves", found.solves)
    .Add("used", used)
    .Add("against", best ? best->name : std::string("none"))
    .Add("hand_seconds", best ? best->seconds : std::numeric_limits<double>::quiet_NaN())
    .Add("ratio", ratio)
    .Print();
  table.Add({ scene.name, Text("%g", 100.0 * target), Text("%.2f", 100.0 * error),
    Text("%.2f", 100.0 * found.light.relativeError), found.met ? "yes" : "no", used, std::to_string(found.solves),
    Text("%.3f", seconds), best ? Text("%.3f", best->seconds) : "-", Text("%.2f", ratio) });
}

void TryLevels(Device& device, const TargetScene& scene, const std::vector<float>& exact, bool quick, Table& table)
{
  for (const Quality quality : { Quality::Draft, Quality::Default, Quality::Fine, Quality::Reference })
  {
    const PropagationSettings settings = AtQuality(Domain(scene.medium.grid), quality, {}, scene.medium, scene.light);
    const Try tried = TrySettings(device, scene, exact, settings, LevelNames[static_cast<int>(quality)], quick);
    JsonLine()
      .Add("bench", "target")
      .Add("case", scene.name)
      .Add("method", "Quality " + tried.name)
      .Add("grid", GridOf(scene))
      .Add("seconds", tried.seconds)
      .Add("error_l2", tried.error)
      .Print();
    table.Add({ scene.name, tried.name,
      std::to_string(settings.directionsPerFace) + "/" + std::to_string(settings.uncollidedDirections),
      Text("%.2f", 100.0 * tried.error), Text("%.3f", tried.seconds) });
  }
}

void RunAll(Device& device, bool quick, const std::vector<TargetScene>& scenes, const std::string& what)
{
  Table targets({ "scene", "target, %", "error, %", "estimate, %", "met", "directions", "solves", "s",
    "best by hand, s", "ratio" });
  Table levels({ "scene", "quality", "directions", "error, %", "s" });
  Score score;
  for (const TargetScene& scene : scenes)
  {
    const std::vector<float> exact = Exact(device, scene);
    TryLevels(device, scene, exact, quick, levels);
    const std::vector<Try> byHand = ByHand(device, scene, exact, quick);
    for (const double target : Targets)
    {
      TryTarget(device, scene, exact, target, byHand, quick, targets, score);
    }
  }
  levels.Print("Qualities, " + what);
  targets.Print("Target errors, " + what);
  std::printf(
    "\n%d of %d below their target; %d said to be met, of which %d wrongly; within twice the best time by hand "
    "%d of %d that a setting of the ladder meets\n",
    score.below, score.all, score.claimed, score.claimedWrongly, score.within, score.byHand);
}
}
}

int main(int argc, char* argv[])
{
  using namespace bench;
  return RunOnDevice(argc, argv, [](Device& device, const Arguments& arguments) {
    if (!arguments.words.empty() && arguments.words.front() == "coverage")
    {
      PrintCoverage(device, arguments.quick, arguments.words.size() > 1 ? arguments.words[1] : "");
      return;
    }
    const auto word = std::find(arguments.words.begin(), arguments.words.end(), "size");
    const bool sized = word != arguments.words.end() && word + 1 != arguments.words.end();
    const double size = sized ? std::atof((word + 1)->c_str()) : arguments.quick ? 0.2 : 1.0;
    const auto only = std::find(arguments.words.begin(), arguments.words.end(), "scene");
    const std::size_t one =
      only != arguments.words.end() && only + 1 != arguments.words.end() ? std::stoul(*(only + 1)) : 0;
    const bool tuning = !arguments.words.empty() && arguments.words.front() == "tuning";
    std::vector<TargetScene> scenes = tuning ? TuningScenes(size) : HeldOutScenes(size);
    if (one > 0 && one <= scenes.size())
    {
      std::rotate(scenes.begin(), scenes.begin() + static_cast<std::ptrdiff_t>(one - 1), scenes.end());
      scenes.erase(scenes.begin() + 1, scenes.end());
    }
    if (std::count(arguments.words.begin(), arguments.words.end(), "falls") > 0)
    {
      PrintFalls(device, scenes);
      return;
    }
    RunAll(device, arguments.quick, scenes, tuning ? "scenes tuned on" : "scenes held out");
  });
}
