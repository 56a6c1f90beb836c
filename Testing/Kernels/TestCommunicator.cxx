#include "Device/Errors.h"
#include "Distribution/RanksInThreads.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace tyndall;

TEST(Communicator, DeliversMessagesOfATagInTheirOrder)
{
  RunInThreads(3, [](Communicator& ranks) {
    const int next = (ranks.Rank() + 1) % 3, before = (ranks.Rank() + 2) % 3;
    ranks.Send(next, 7, std::vector<float>{ 1.0f, 2.0f });
    ranks.Send(next, 8, std::vector<float>{ 3.0f });
    ranks.Send(next, 7, std::vector<float>{});
    EXPECT_EQ(ranks.Receive<float>(before, 8), std::vector<float>{ 3.0f });
    EXPECT_EQ(ranks.Receive<float>(before, 7), (std::vector<float>{ 1.0f, 2.0f }));
    EXPECT_TRUE(ranks.Receive<float>(before, 7).empty());
    EXPECT_EQ(ranks.Sent().messages, 3u);
    EXPECT_EQ(ranks.Sent().bytes, 12u);
  });
}

TEST(Communicator, DeliversWhatARankSendsToItself)
{
  const auto sendToItself = [](Communicator& ranks) {
    ranks.Send(ranks.Rank(), 7, std::vector<float>{ 1.0f, 2.0f });
    ranks.Send(ranks.Rank(), 7, std::vector<float>{ 3.0f });
    EXPECT_EQ(ranks.Receive<float>(ranks.Rank(), 7), (std::vector<float>{ 1.0f, 2.0f }));
    EXPECT_EQ(ranks.Receive<float>(ranks.Rank(), 7), std::vector<float>{ 3.0f });
    EXPECT_EQ(ranks.Sent().messages, 0u);
  };
  SingleRank alone;
  sendToItself(alone);
  RunInThreads(2, sendToItself);
}

TEST(Communicator, GivesAllRanksTheSameSumsAndLargestValues)
{
  RunInThreads(4, [](Communicator& ranks) {
    const double own = ranks.Rank() + 1.0;
    EXPECT_EQ(ranks.Sum({ own, 0.5 }), (std::vector<double>{ 10.0, 2.0 }));
    EXPECT_EQ(ranks.Largest({ own, -own }), (std::vector<double>{ 4.0, -1.0 }));
  });
}

TEST(Communicator, ThrowsOnAllRanksWhatOneThrows)
{
  RunInThreads(3, [](Communicator& ranks) {
    ranks.Together([] {});
    try
    {
      ranks.Together([&] { Require(ranks.Rank() != 1, "no medium"); });
      ADD_FAILURE() << "rank " << ranks.Rank() << " goes on";
    }
    catch (const InvalidInput& error)
    {
      EXPECT_EQ(error.what(), std::string("On rank 1: no medium"));
    }
    try
    {
      ranks.Together([&] { throw DeviceError("no device"); });
      ADD_FAILURE() << "rank " << ranks.Rank() << " goes on";
    }
    catch (const DeviceError& error)
    {
      EXPECT_EQ(error.what(), std::string("no device")); // on all of them
    }
    EXPECT_THROW(ranks.Together([&] {
      if (ranks.Rank() == 2)
      {
        throw Aborted();
      }
    }),
      Aborted);
  });
}

TEST(Communicator, GivesUpWaitingForARankThatIsGone)
{
  const auto work = [](Communicator& ranks) {
    if (ranks.Rank() == 0)
    {
      ranks.Receive<float>(1, 0);
    }
  };
  EXPECT_THROW(RunInThreads(2, work, 0.2), std::runtime_error);
}
