#include "Distribution/KeptInBlocks.h"

#include <vector>

namespace tyndall
{
namespace
{
/// Compares powers and rates of the domain, which are the same on all ranks that kept light of the same solve.
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

std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot)
{
  const std::string words = WordsOfAny(communicator, whyNot);
  const bool same = IsOfOneSolve(communicator, kept);
  return !words.empty() ? words : same ? std::string() : "the ranks have it of different solves";
}
}
