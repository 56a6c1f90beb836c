#include "Distribution/SharedMedium.h"

#include "Device/Errors.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

namespace tyndall
{
namespace
{
/// Whether numbers are the same on all ranks. Collective.
bool AreSame(Communicator& communicator, std::vector<double> values, bool has = true)
{
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(-values[i]);
  }
  if (!has)
  {
    std::fill(values.begin(), values.end(), -std::numeric_limits<double>::infinity());
  }
  const std::vector<double> largest = communicator.Largest(values);
  for (std::size_t i = 0; i < count; ++i)
  {
    if (largest[i] != -largest[count + i])
    {
      return false;
    }
  }
  return true;
}

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
  ofColor(light.halfRangeFlux);
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
}

void RequireSame(Communicator& communicator, const char* what, bool has, std::vector<double> values)
{
  Require(AreSame(communicator, std::move(values), has),
    std::string("The ranks that share the medium disagree about ") + what + ": give every piece the same.");
}

void RequireSame(Communicator& communicator, const BlockPartition& partition)
{
  std::vector<double> numbers;
  for (int axis = 0; axis < 3; ++axis)
  {
    numbers.push_back(partition.whole.size[axis]);
    numbers.push_back(partition.whole.spacing[axis]);
    numbers.push_back(partition.whole.origin[axis]);
    for (const VoxelBox& block : partition.blocks)
    {
      numbers.push_back(block.first[axis]);
      numbers.push_back(block.size[axis]);
    }
  }
  RequireSame(communicator, "the grid or its blocks", true, numbers);
}

bool IsFirstThatHas(const Communicator& communicator, const BlockPartition& partition)
{
  const auto has = [](const VoxelBox& block) { return block.VoxelCount() > 0; };
  const std::vector<VoxelBox>& blocks = partition.blocks;
  return std::find_if(blocks.begin(), blocks.end(), has) - blocks.begin() == communicator.Rank();
}

void AgreeOnMeanCosine(Communicator& communicator, bool has, const Field& g, Medium& medium)
{
  const bool given = has && g.values;
  MeanCosineRange range;
  communicator.Collective(
    [&] { range = given ? MeanCosineRange(g, medium.sigma_s, medium.grid.VoxelCount()) : range; });
  std::vector<double> ends(range.greatest.begin(), range.greatest.end());
  std::transform(range.least.begin(), range.least.end(), std::back_inserter(ends), std::negate<double>());
  ends = communicator.Largest(ends);
  std::copy_n(ends.begin(), 3, range.greatest.begin());
  std::transform(ends.begin() + 3, ends.end(), range.least.begin(), std::negate<double>());
  communicator.Collective([&] {
    if (given)
    {
      medium.phase = PhaseByVoxel(medium.phase.OfChannel(0), g, range);
    }
  });
}

MediumTraits TraitsOfAll(Communicator& communicator, MediumTraits traits)
{
  const std::vector<double> any = communicator.Largest({ traits.absorbs ? 1.0 : 0.0, traits.scatters ? 1.0 : 0.0,
    traits.emits ? 1.0 : 0.0, traits.grey ? 0.0 : 1.0, traits.greyExtinction ? 0.0 : 1.0 });
  traits.absorbs = any[0] > 0.0;
  traits.scatters = any[1] > 0.0;
  traits.emits = any[2] > 0.0;
  traits.grey = any[3] == 0.0;
  traits.greyExtinction = any[4] == 0.0;
  return traits;
}

SceneChannels ChannelsOfAll(const Domain& domain, const SceneChannels& here)
{
  SceneChannels all = here;
  if (domain.IsSerial())
  {
    return all;
  }
  const std::size_t ranks = domain.Partition().blocks.size(), own = domain.Rank();
  std::vector<double> colours(3 * ranks, 0.0); // colour of the light of each rank, r g b; (0, 0, 0): none
  if (!here.colour.IsBlack())
  {
    const Rgb relative = here.colour.Relative();
    std::copy(relative.begin(), relative.end(), colours.begin() + static_cast<std::ptrdiff_t>(3 * own));
  }
  colours = domain.Sum(colours);
  all.colour = {};
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    all.colour.Add(Rgb{ colours[3 * rank], colours[3 * rank + 1], colours[3 * rank + 2] });
  }
  if (domain.Any(!here.colour.IsOne()))
  {
    all.colour.AddNone();
  }
  all.given = static_cast<int>(domain.Max(here.given));
  all.one = !domain.Any(!here.one) && all.colour.IsOne();
  return all;
}

void SumOverRanks(const Domain& domain, const std::vector<Rgb*>& powers)
{
  std::vector<double> values;
  for (const Rgb* power : powers)
  {
    values.insert(values.end(), power->begin(), power->end());
  }
  values = domain.Sum(values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    (*powers[i / 3])[i % 3] = values[i];
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
  // All ranks must have kept the same values of the whole domain: the first-scattered power, and the ratio of
  // successive iterations.
  std::vector<double> values(kept.firstScattered.begin(), kept.firstScattered.end());
  values.insert(values.end(), kept.rate.begin(), kept.rate.end());
  const bool same = AreSame(communicator, std::move(values));
  return !words.empty() ? words : same ? std::string() : "the ranks have it of different solves";
}
}
