// Thick media: what the accelerated solve costs beside scattering orders one after the other.
//
//   TyndallBenchThick [--quick] [--sizes 64,128,256] [--tau 5,20,100,1000] [--albedo 0.9,0.99,1]
//     [--media homogeneous,blocks,log-normal] [--repetitions N] [--plain-at-most ORDERS]
//
// A line a scene:
//   seconds          of the whole solve by default, the median; `iterations` its rows
//   order_seconds    of a plain scattering order of the same scene, in the same run
//   correction       what a row takes beyond a plain order, in plain orders
//   set_up           what the first row takes beyond the others, in plain orders
//   plain_seconds    without acceleration, where it is expected to take no more orders than asked for
//   ratio            seconds over plain_seconds (or over the plain orders that are expected, times order_seconds)
//   bytes_a_voxel    of the device

#include "Measure.h"
#include "Program.h"
#include "Report.h"
#include "ThickScenes.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>

using namespace bench;
using namespace tyndall;

namespace
{
struct Options
{
  std::vector<double> sizes = { 64, 128, 256 }, tau = { 5, 20, 100, 1000 }, albedo = { 0.9, 0.99, 1.0 };
  std::vector<ThickMedium> media = { ThickMedium::Homogeneous, ThickMedium::Blocks, ThickMedium::LogNormal };
  int repetitions = 3;
  double plainAtMost = 150.0; ///< orders
};

std::vector<std::string> Words(const std::string& text)
{
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');)
  {
    words.push_back(word);
  }
  return words;
}

std::vector<double> Numbers(const std::string& text)
{
  std::vector<double> numbers;
  for (const std::string& word : Words(text))
  {
    numbers.push_back(std::atof(word.c_str()));
  }
  return numbers;
}

std::vector<ThickMedium> Media(const std::string& text)
{
  const std::map<std::string, ThickMedium> names = { { "homogeneous", ThickMedium::Homogeneous },
    { "blocks", ThickMedium::Blocks }, { "log-normal", ThickMedium::LogNormal } };
  std::vector<ThickMedium> media;
  for (const std::string& word : Words(text))
  {
    media.push_back(names.at(word));
  }
  return media;
}

Options OptionsOf(const Arguments& arguments)
{
  Options options;
  if (arguments.quick)
  {
    options.sizes = { 16 };
    options.tau = { 20 };
    options.albedo = { 0.99 };
    options.repetitions = 1;
  }
  for (std::size_t i = 0; i + 1 < arguments.words.size(); i += 2)
  {
    const std::string &word = arguments.words[i], &value = arguments.words[i + 1];
    if (word == "--sizes")
    {
      options.sizes = Numbers(value);
    }
    else if (word == "--tau")
    {
      options.tau = Numbers(value);
    }
    else if (word == "--albedo")
    {
      options.albedo = Numbers(value);
    }
    else if (word == "--media")
    {
      options.media = Media(value);
    }
    else if (word == "--repetitions")
    {
      options.repetitions = std::max(1, std::atoi(value.c_str()));
    }
    else if (word == "--plain-at-most")
    {
      options.plainAtMost = std::atof(value.c_str());
    }
    else
    {
      throw std::runtime_error("TyndallBenchThick: what is " + word + "? See the top of Thick.cxx.");
    }
  }
  return options;
}

struct Run
{
  double seconds = 0.0, row = 0.0, setUp = 0.0; ///< of all, of one row but the first, of the first beyond that
  int rows = 0;
  double bytes = 0.0;
};

Run Solve(Device& device, const ThickScene& scene, const PropagationSettings& settings)
{
  device.ResetPeak();
  const double start = WallSeconds();
  const LightField light = SolveConservative(device, scene.medium, scene.light, settings);
  Run run;
  run.seconds = WallSeconds() - start;
  run.rows = static_cast<int>(light.convergence.size());
  run.bytes = static_cast<double>(device.PeakBytes());
  const auto& rows = light.convergence;
  run.row = rows.size() > 1 ? (rows.back().seconds - rows.front().seconds) / (static_cast<double>(rows.size()) - 1.0)
                            : rows.back().seconds;
  run.setUp = rows.front().seconds - run.row;
  return run;
}

/// Of each figure the median; of rows, which are the same each time, the last.
Run Medians(const std::vector<Run>& runs)
{
  const auto of = [&](double Run::*figure) {
    std::vector<double> values;
    std::transform(runs.begin(), runs.end(), std::back_inserter(values), [&](const Run& run) { return run.*figure; });
    return Median(values);
  };
  return { of(&Run::seconds), of(&Run::row), of(&Run::setUp), runs.back().rows, of(&Run::bytes) };
}

void Compare(Device& device, const ThickScene& scene, const Options& options)
{
  PropagationSettings plain;
  plain.acceleration = PropagationAcceleration::None;
  plain.source = PropagationSource::Constant;
  PropagationSettings fewOrders = plain;
  fewOrders.maximumOrders = 6;
  const double expected = OrdersNeeded(PropagationProblem(scene.medium, scene.light, plain, {}));
  std::vector<Run> accelerated, orders, all;
  for (int round = -1; round < options.repetitions; ++round) // in turns; the first compiles
  {
    const Run byDefault = Solve(device, scene, {});
    const Run six = Solve(device, scene, fewOrders);
    if (round >= 0)
    {
      accelerated.push_back(byDefault);
      orders.push_back(six);
    }
    if (round >= 0 && expected <= options.plainAtMost)
    {
      all.push_back(Solve(device, scene, plain));
    }
  }
  const Run fast = Medians(accelerated), order = Medians(orders);
  const double plainSeconds = all.empty() ? order.seconds + order.row * (expected - 6.0) : Medians(all).seconds;
  const int edge = scene.medium.grid.size[0];
  JsonLine line;
  line.Add("bench", "thick")
    .Add("case", scene.name)
    .Add("method", "conservative, default")
    .Add("grid", GridText(edge))
    .Add("seconds", fast.seconds)
    .Add("iterations", fast.rows)
    .Add("order_seconds", order.row)
    .Add("correction", (fast.row - order.row) / order.row)
    .Add("set_up", fast.setUp / order.row)
    .Add("expected_orders", std::min(expected, 1e9));
  if (!all.empty())
  {
    line.Add("plain_seconds", Medians(all).seconds).Add("plain_iterations", Medians(all).rows);
  }
  line.Add("ratio", fast.seconds / plainSeconds)
    .Add("against", all.empty() ? "plain orders, forecast" : "plain orders")
    .Add("ns_a_voxel", 1e9 * fast.seconds / static_cast<double>(scene.medium.grid.VoxelCount()))
    .Add("bytes_a_voxel", fast.bytes / static_cast<double>(scene.medium.grid.VoxelCount()))
    .Add("peak_bytes", fast.bytes)
    .Print();
}

void RunAll(Device& device, const Arguments& arguments)
{
  const Options options = OptionsOf(arguments);
  for (const double size : options.sizes)
  {
    for (const ThickMedium kind : options.media)
    {
      for (const double tau : options.tau)
      {
        for (const double albedo : options.albedo)
        {
          Compare(device, ThickScene(kind, static_cast<int>(size), tau, albedo), options);
        }
      }
    }
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
