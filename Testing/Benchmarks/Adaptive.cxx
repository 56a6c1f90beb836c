// Photons sent where they are needed: error of fluence against run time, for photons spread evenly, for Pfeuti's
// adaptive pipeline as published and for ours, on his three scenes; what equal error costs each; his Table 4.2 beside
// our passes; and what a scene costs that has nothing to gain. All passes count: pilot photons and map, generation,
// marching, reconstruction. The medium is on the device before any way begins.
//
//   TyndallBenchAdaptive [--quick] [ball] [cube] [armadillo] [even]

#include "AdaptiveRuns.h"
#include "Measure.h"
#include "Program.h"

#include "../Kernels/PlyFile.h"

#include "Reference/PfeutiTimes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

using namespace bench;
using namespace tyndall;

namespace
{
constexpr double PhotonsGoal = 0.4, TimeGoal = 0.7; ///< of photons spread evenly, at equal error

/// A way's errors and times by photons, in the order of the photons.
struct Curve
{
  Way way;
  std::vector<double> photons, seconds, errors;

  /// The error of a number of photons that was run.
  double At(double count) const
  {
    return this->errors[static_cast<std::size_t>(
      std::find(this->photons.begin(), this->photons.end(), count) - this->photons.begin())];
  }

  /// What `values` are where the error is `wanted`: straight between points in logarithms. NaN: it is not among them.
  double At(double wanted, const std::vector<double>& values) const
  {
    for (std::size_t i = 1; i < this->errors.size(); ++i)
    {
      if (this->errors[i] <= wanted && this->errors[i - 1] > wanted)
      {
        const double part = std::log(this->errors[i - 1] / wanted) / std::log(this->errors[i - 1] / this->errors[i]);
        return values[i - 1] * std::pow(values[i] / values[i - 1], part);
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

JsonLine AdaptiveLine(const PaperScene& scene, const std::string& method)
{
  const int edge = scene.settings.grid.size[0];
  const std::string size = std::to_string(edge);
  return JsonLine()
    .Add("bench", "adaptive")
    .Add("case", scene.name)
    .Add("method", method)
    .Add("grid", size + "x" + size + "x" + size);
}

/// Part of the voxels brighter than a tenth of the median whose error is within two standard errors.
double Honest(const WayLight& light, const std::vector<float>& reference)
{
  std::vector<float> sorted = reference;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const float lit = 0.1f * sorted[sorted.size() / 2];
  std::size_t all = 0, within = 0;
  for (std::size_t i = 0; i < reference.size() && !light.fluenceError.empty(); ++i)
  {
    if (reference[i] > lit)
    {
      ++all;
      within += std::abs(light.fluence[i] - reference[i]) <= 2.0f * light.fluenceError[i] ? 1 : 0;
    }
  }
  return all > 0 ? static_cast<double>(within) / static_cast<double>(all) : std::numeric_limits<double>::quiet_NaN();
}

/// The mean of two runs with other photons; what they differ by tells its own error.
std::vector<float> MakeReference(tyndall::Device& device, PaperScene& scene, std::size_t photons)
{
  PhotonMarcher marcher = scene.Marcher(device);
  scene.Emit(photons, Sampler::Halton, 11);
  const std::vector<float> other = marcher.March(scene.photons).light.fluence;
  scene.Emit(photons, Sampler::Hammersley, 12);
  std::vector<float> fluence = marcher.March(scene.photons).light.fluence;
  AdaptiveLine(scene, "reference")
    .Add("photons", 2.0 * static_cast<double>(photons))
    .Add("error_l2", 0.5 * RelativeL2(other, fluence))
    .Print();
  std::transform(
    fluence.begin(), fluence.end(), other.begin(), fluence.begin(), [](float a, float b) { return 0.5f * (a + b); });
  return fluence;
}

/// A bench of one scene.
class SceneBench
{
public:
  SceneBench(tyndall::Device& device, PaperScene& scene, bool quick)
    : Device(device)
    , Scene(scene)
    , Quick(quick)
    , Most(quick ? 2000 : PaperPhotons)
    , Runner(device, scene)
  {
    scene.Voxelize(device);
    scene.Group();
    this->Reference = MakeReference(device, scene, (quick ? 10 : 100) * this->Most);
  }

  /// Errors and times of each way by photons, then what equal error costs.
  void Compare()
  {
    std::vector<Curve> curves;
    Table table({ "way", "", "photons", "error", "honest", "pilot", "generation", "marching", "reconstr.", "all ms" });
    for (const Way way :
      { Way::Published, Way::Smoothed, Way::Uniform, Way::Reconstructed, Way::AdaptivePublished, Way::Adaptive })
    {
      curves.push_back(this->Follow(way, table));
    }
    table.Print("Error of fluence (relative L2) against run time, " + this->Scene.name +
      "; \"honest\": part of the lit voxels within two of fluence_error");
    this->PrintEqualError(curves);
    this->TakeTurns(curves.back(), curves[2]);
  }

private:
  Curve Follow(Way way, Table& table)
  {
    Curve curve = { way, {}, {}, {} };
    for (const double part : { 1.0 / 16, 1.0 / 8, 1.0 / 5, 0.3, 0.4, 0.6, 1.0, 2.0 })
    {
      const auto photons = static_cast<std::size_t>(part * this->Most);
      const WayLight light = this->Runner.Time(way, photons, this->Quick ? 1 : 5);
      const double error = RelativeL2(light.fluence, this->Reference), honest = Honest(light, this->Reference);
      const Passes& passes = light.passes;
      curve.photons.push_back(static_cast<double>(photons));
      curve.seconds.push_back(passes.Whole());
      curve.errors.push_back(error);
      AdaptiveLine(this->Scene, NameOf(way))
        .Add("photons", static_cast<double>(photons))
        .Add("seconds", passes.Whole())
        .Add("peak_bytes", static_cast<double>(this->Device.PeakBytes()))
        .Add("error_l2", error)
        .Add("within_two_errors", honest)
        .Print();
      table.Add(
        { NameOf(way), "", Text("%.0f", static_cast<double>(photons)), Text("%.4f", error), Text("%.3f", honest),
          Text("%.1f", 1e3 * passes.pilot), Text("%.1f", 1e3 * passes.generation), Text("%.1f", 1e3 * passes.marching),
          Text("%.1f", 1e3 * passes.reconstruction), Text("%.1f", 1e3 * passes.Whole()) });
    }
    return curve;
  }

  void PrintEqualError(const std::vector<Curve>& curves) const
  {
    const auto uniform =
      std::find_if(curves.begin(), curves.end(), [](const Curve& curve) { return curve.way == Way::Uniform; });
    const double error = uniform->At(static_cast<double>(this->Most)), seconds = uniform->At(error, uniform->seconds);
    Table table({ "way", "", "photons", "part", "ms", "part", "speed-up" });
    for (const Curve& curve : curves)
    {
      const double photons = curve.At(error, curve.photons), time = curve.At(error, curve.seconds);
      AdaptiveLine(this->Scene, NameOf(curve.way))
        .Add("against", "uniform")
        .Add("error_l2", error)
        .Add("photons", photons)
        .Add("photons_ratio", photons / this->Most)
        .Add("seconds", time)
        .Add("ratio", time / seconds)
        .Print();
      table.Add({ NameOf(curve.way), "", Text("%.0f", photons), Text("%.2f", photons / this->Most),
        Text("%.0f", 1e3 * time), Text("%.2f", time / seconds), Text("%.2f", seconds / time) });
    }
    table.Print(this->Scene.name + ": at the error of " + std::to_string(this->Most) + " photons spread evenly, " +
      Text("%.4f", error) + Text("; goals of the adaptive way: %.2f of the photons", PhotonsGoal) +
      Text(" and %.2f of the time", TimeGoal));
  }

  /// The adaptive way at equal error, with photons spread evenly, in turns: what the machine does meanwhile meets both.
  void TakeTurns(const Curve& adaptive, const Curve& uniform)
  {
    const double most = static_cast<double>(this->Most);
    const double photons = adaptive.At(uniform.At(most), adaptive.photons);
    if (!(photons > 0.0))
    {
      return;
    }
    const auto count = static_cast<std::size_t>(1.02 * photons);
    std::vector<double> even, sent, ratios;
    double error = 0.0;
    for (int i = 0; i < (this->Quick ? 1 : 15); ++i)
    {
      even.push_back(this->Runner.Run(Way::Uniform, this->Most).passes.Whole());
      const WayLight light = this->Runner.Run(Way::Adaptive, count);
      sent.push_back(light.passes.Whole());
      ratios.push_back(sent.back() / even.back());
      error = RelativeL2(light.fluence, this->Reference);
    }
    AdaptiveLine(this->Scene, "adaptive, in turns with uniform")
      .Add("photons", static_cast<double>(count))
      .Add("error_l2", error)
      .Add("seconds", Median(sent))
      .Add("against", "uniform")
      .Add("against_seconds", Median(even))
      .Add("ratio", Median(ratios))
      .Print();
    std::printf("In turns, medians of %zu: %s %.1f ms, %.0f adaptive photons %.1f ms, error %.4f: %.2f of the time\n",
      ratios.size(), (std::to_string(this->Most) + " spread evenly").c_str(), 1e3 * Median(even),
      static_cast<double>(count), 1e3 * Median(sent), error, Median(ratios));
  }

  tyndall::Device& Device;
  PaperScene& Scene;
  bool Quick;
  std::size_t Most;
  WayRunner Runner;
  std::vector<float> Reference;
};

/// @param paperScene  the scene's name in Pfeuti's tables
void PrintPasses(WayRunner& runner, const PaperScene& scene, const std::string& paperScene, bool quick)
{
  const PfeutiPasses paperEven = PfeutiPassesOf(paperScene, "reference");
  const PfeutiPasses paper = PfeutiPassesOf(paperScene, "adaptive");
  Table table({ "pass", "", "even ms", "paper", "adaptive ms", "paper" });
  const std::size_t shrink = quick ? 100 : 1;
  const Passes even = runner.Time(Way::Uniform, paperEven.photons / shrink, quick ? 1 : 7).passes;
  const Passes adaptive = runner.Time(Way::Adaptive, paper.photons / shrink, quick ? 1 : 7).passes;
  const auto add = [&](const char* name, double ours, double theirs, double ours2, double theirs2) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    table.Add({ name, "", Text("%.1f", ours > 0.0 ? 1e3 * ours : none), Text("%.0f", theirs > 0.0 ? theirs : none),
      Text("%.1f", 1e3 * ours2), Text("%.0f", theirs2) });
    AdaptiveLine(scene, std::string("pass: ") + name)
      .Add("seconds", ours2)
      .Add("paper_seconds", 1e-3 * theirs2)
      .Add("even_seconds", ours > 0.0 ? ours : none)
      .Add("paper_even_seconds", theirs > 0.0 ? 1e-3 * theirs : none)
      .Print();
  };
  add("pilot photons and map", 0.0, 0.0, adaptive.pilot, paper.pilot);
  add("generation", even.generation, paperEven.generation, adaptive.generation, paper.generation);
  add("marching", even.marching, paperEven.marching, adaptive.marching, paper.marching);
  add("reconstruction", 0.0, 0.0, adaptive.reconstruction, paper.reconstruction);
  add("together", even.Whole(), paperEven.generation + paperEven.marching, adaptive.Whole(),
    paper.pilot + paper.generation + paper.marching + paper.reconstruction);
  table.Print("Passes, " + scene.name + ", " + std::to_string(paperEven.photons) + " photons spread evenly, " +
    std::to_string(paper.photons) + " adaptive ones (paper: GTX 260; below 1 ms is told as 1)");
}

/// What falling back to photons spread evenly costs where light is even.
void PrintFallBack(tyndall::Device& device, bool quick)
{
  PaperScene scene = EvenFog(quick ? 16 : 128);
  scene.Voxelize(device);
  WayRunner runner(device, scene);
  const std::size_t photons = quick ? 2000 : PaperPhotons;
  const Passes uniform = runner.Time(Way::Uniform, photons, quick ? 1 : 7).passes;
  const WayLight adaptive = runner.Time(Way::Adaptive, photons, quick ? 1 : 7);
  const double cost = adaptive.passes.pilot / uniform.Whole();
  AdaptiveLine(scene, "fall back to even photons")
    .Add("even", adaptive.importance.even ? 1.0 : 0.0)
    .Add("seconds", adaptive.passes.pilot)
    .Add("ratio", cost)
    .Add("against", "uniform")
    .Print();
  Table table({ "even fog", "", "ms" });
  table.Add({ "generation and marching of photons spread evenly", "", Text("%.1f", 1e3 * uniform.Whole()) });
  table.Add(
    { "pilot photons and map, which tell that nothing is gained", "", Text("%.1f", 1e3 * adaptive.passes.pilot) });
  table.Print(std::string("Fog alone under a sun: the light is found ") +
    (adaptive.importance.even ? "even" : "UNEVEN") +
    Text(", which costs %.1f%% more (goal: below 10%%)", 100.0 * cost));
}

void RunScene(tyndall::Device& device, PaperScene scene, const std::string& paperScene, bool quick)
{
  SceneBench(device, scene, quick).Compare();
  WayRunner runner(device, scene);
  PrintPasses(runner, scene, paperScene, quick);
}

void RunAll(tyndall::Device& device, const Arguments& arguments)
{
  const int edge = arguments.quick ? 32 : 128;
  if (arguments.Asks("ball"))
  {
    RunScene(device, BallInFog(edge), "ball", arguments.quick);
  }
  if (arguments.Asks("cube"))
  {
    RunScene(device, CubeInFog(edge), "cube", arguments.quick);
  }
  const std::string file = std::string(TYNDALL_FETCHED_DATA) + "/armadillo.ply";
  if (arguments.Asks("armadillo") && std::ifstream(file).good())
  {
    RunScene(device, MeshInFog("armadillo", ReadPly(file), edge), "armadillo", arguments.quick);
  }
  else if (arguments.Asks("armadillo"))
  {
    std::fprintf(stderr, "There is no %s: left out (./run bench fetches it)\n", file.c_str());
  }
  if (arguments.Asks("even"))
  {
    PrintFallBack(device, arguments.quick);
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
