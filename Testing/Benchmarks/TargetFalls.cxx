#include "TargetFalls.h"

#include "Report.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <cmath>

using namespace tyndall;

namespace bench
{
namespace
{
constexpr int Numbers[] = { 4, 9, 16, 25, 36, 49, 64, 81, 100, 256, 400 };
constexpr int Many = 900, ManyUncollided = 2500;

std::vector<float> Along(Device& device, const TargetScene& scene, int directions, int uncollided)
{
  PropagationSettings settings;
  settings.directionsPerFace = directions;
  settings.uncollidedDirections = uncollided;
  settings.staggeredRays = directions > 100;
  settings.tolerance = 1e-5;
  settings.emissionError = 0.005;
  return SolveConservative(device, scene.medium, scene.light, settings).fluence;
}

/// What one of two solves is off, relative, root mean square; and the cosine between the errors of both as vectors.
struct Errors
{
  double one = 0.0, cosine = 0.0;
};

Errors Compare(const std::vector<float>& one, const std::vector<float>& other, const std::vector<float>& exact)
{
  double ones = 0.0, others = 0.0, product = 0.0, all = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const double truth = exact[i], first = one[i] - truth, second = other[i] - truth;
    ones += first * first;
    others += second * second;
    product += first * second;
    all += truth * truth;
  }
  return { std::sqrt(ones / all), product / std::sqrt(ones * others) };
}

void AddRow(Table& table, const TargetScene& scene, const char* what, const std::vector<std::vector<float>>& found,
  const std::vector<float>& exact)
{
  std::vector<std::string> row = { scene.name, what };
  const std::vector<float>& along9 = found[1];
  const double error9 = Compare(along9, along9, exact).one;
  row.push_back(Text("%.2f", 100.0 * error9));
  for (const std::vector<float>& fluence : found)
  {
    row.push_back(Text("%.3f", Compare(fluence, along9, exact).one / error9));
  }
  row.push_back(Text("%.2f", Compare(along9, found[3], exact).cosine));
  table.Add(row);
}
}

void PrintFalls(Device& device, const std::vector<TargetScene>& scenes)
{
  std::vector<std::string> heads = { "scene", "light", "9, %" };
  for (const int number : Numbers)
  {
    heads.push_back(std::to_string(number));
  }
  heads.emplace_back("cosine 9, 25");
  Table table(heads);
  for (const TargetScene& scene : scenes)
  {
    const std::vector<float> exact = Along(device, scene, Many, ManyUncollided);
    std::vector<std::vector<float>> both, scattered, uncollided;
    for (const int number : Numbers)
    {
      both.push_back(Along(device, scene, number, 0));
      scattered.push_back(Along(device, scene, number, ManyUncollided));
      uncollided.push_back(Along(device, scene, 100, number));
    }
    AddRow(table, scene, "all", both, exact);
    AddRow(table, scene, "scattered", scattered, exact);
    AddRow(table, scene, "unscattered", uncollided, Along(device, scene, 100, ManyUncollided));
  }
  table.Print("Errors along so many directions a face, over those along 9");
}
}
