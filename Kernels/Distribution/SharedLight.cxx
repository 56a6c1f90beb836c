#include "Distribution/SharedLight.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace tyndall
{
namespace
{
/// Calls visit(number) for each floating-point scalar of a LightField, in a fixed order.
template <class Visit>
void ForNumbers(LightField& light, const Visit& visit)
{
  const auto ofColor = [&visit](Rgb& rgb) { std::for_each(rgb.begin(), rgb.end(), visit); };
  EnergyBalance& balance = light.balance;
  for (Rgb* const rgb : { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped, &balance.leftOver })
  {
    ofColor(*rgb);
  }
  std::for_each(light.facePowerOut.begin(), light.facePowerOut.end(), ofColor);
  visit(light.halfRangeFlux);
  for (ConvergenceRow& row : light.convergence)
  {
    for (double* const number :
      { &row.seconds, &row.residual, &row.change, &row.absorbed, &row.escaped, &row.leftOver })
    {
      visit(*number);
    }
  }
}

/// Calls visit(number) for each integer scalar of a LightField, in a fixed order.
template <class Visit>
void ForWholeNumbers(LightField& light, const Visit& visit)
{
  for (int* const number :
    { &light.channels, &light.polarNodes, &light.directionsPerFace, &light.uncollidedDirections })
  {
    visit(*number);
  }
  for (ConvergenceRow& row : light.convergence)
  {
    visit(row.iteration);
  }
  std::for_each(light.sweepsSaved.begin(), light.sweepsSaved.end(), visit);
}

std::vector<std::string> ShareLines(Communicator& communicator, bool found, const std::vector<std::string>& lines)
{
  std::string joined;
  for (const std::string& line : lines)
  {
    joined += line + "\n";
  }
  std::istringstream words(WordsOfAny(communicator, found ? joined : std::string()));
  std::vector<std::string> shared;
  for (std::string line; std::getline(words, line);)
  {
    shared.push_back(line);
  }
  return shared;
}

/// Whether the lights that the ranks kept come from the same solve: compares the first-scattered power and the ratio of
/// successive iterations, which each rank stores with its light and which are those of the whole domain.
bool IsOfOneSolve(Communicator& communicator, const KeptLight& kept)
{
  std::vector<double> values(kept.firstScattered.begin(), kept.firstScattered.end());
  values.insert(values.end(), kept.rate.begin(), kept.rate.end());
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(-values[i]);
  }
  const std::vector<double> largest = communicator.Largest(values);
  bool same = true;
  for (std::size_t i = 0; i < count; ++i)
  {
    same = same && largest[i] == -largest[count + i];
  }
  return same;
}
}

void ShareFigures(Communicator& communicator, bool found, LightField& light)
{
  const auto count = [](const auto& list) { return static_cast<double>(list.size()); };
  const std::vector<double> counts =
    communicator.Largest({ found ? count(light.convergence) : 0.0, found ? count(light.sweepsSaved) : 0.0 });
  if (!found)
  {
    light = {};
    light.channels = 0;
    light.convergence.resize(static_cast<std::size_t>(counts[0]));
    light.sweepsSaved.resize(static_cast<std::size_t>(counts[1]));
  }
  std::vector<double> numbers;
  const auto add = [&](auto number) { numbers.push_back(found ? static_cast<double>(number) : 0.0); };
  ForNumbers(light, add);
  ForWholeNumbers(light, add);
  numbers = communicator.Sum(numbers);
  auto next = numbers.begin();
  ForNumbers(light, [&](double& number) { number = *next++; });
  ForWholeNumbers(light, [&](int& number) { number = static_cast<int>(*next++); });
  light.device = WordsOfAny(communicator, found ? light.device : std::string());
  light.doubts.clear();
  light.leftOut = ShareLines(communicator, found, light.leftOut);
}

void ShareLeftOut(const Domain& domain, LightField& light)
{
  light.leftOut = ShareLines(domain.Comm(), !domain.IsEmpty(), light.leftOut);
}

std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot)
{
  const std::string words = WordsOfAny(communicator, whyNot);
  const bool same = IsOfOneSolve(communicator, kept);
  return !words.empty() ? words : same ? std::string() : "the ranks have it of different solves";
}
}
