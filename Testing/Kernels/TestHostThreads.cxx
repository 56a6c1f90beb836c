// Passes over arrays on all of the host's cores.
#include "Device/HostThreads.h"
#include "ErrorWords.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

using namespace tyndall;

TEST(HostThreads, PartsAreTheWholeOnce)
{
  for (const std::size_t count : { 0, 1, 2, 5, 1000, 100003 })
  {
    for (const std::size_t least : { 0, 1, 3, 400, 1000000 })
    {
      std::vector<int> times(count, 0);
      InThreads(count, least, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
        {
          ++times[i];
        }
      });
      EXPECT_EQ(times, std::vector<int>(count, 1)) << count << " by " << least;
    }
  }
}

TEST(HostThreads, FirstFailureIsThrownWhenAllHaveEnded)
{
  std::vector<int> seen(64, 0);
  const std::string words = ErrorWords<std::runtime_error>([&] {
    InThreads(seen.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
      {
        seen[i] = 1;
      }
      throw std::runtime_error(std::to_string(begin));
    });
  });
  EXPECT_EQ(words, "0");
  EXPECT_EQ(seen, std::vector<int>(64, 1));
}

TEST(HostThreads, SumsAreThoseOfPiecesInTurn)
{
  constexpr std::size_t count = 10007, piece = 64;
  const auto term = [](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
    {
      sum += 1.0 / (1.0 + static_cast<double>(i));
    }
    return sum;
  };
  double inTurn = 0.0;
  for (std::size_t begin = 0; begin < count; begin += piece)
  {
    inTurn += term(begin, std::min(begin + piece, count));
  }
  EXPECT_EQ(SumInThreads(count, piece, term), inTurn);
  EXPECT_EQ(SumInThreads(0, piece, term), 0.0);
}
