#include "Device/Errors.h"
#include "Distribution/Communicator.h"
#include "ErrorWords.h"
#include "RanksInThreads.h"

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

namespace
{
/// As many numbers as the ranks say, and of them: none from rank 0 to itself.
std::vector<float> ParcelOf(int from, int to)
{
  return std::vector<float>(static_cast<std::size_t>(3 * from + to), 10.0f * from + to);
}

/// This rank among all.
void ExpectParcelsFrom(Communicator& ranks, const std::vector<int>& with)
{
  const std::vector<std::vector<float>> arrived = ranks.Exchange<float>(with, [&] {
    std::vector<std::vector<float>> parcels;
    for (const int to : with)
    {
      parcels.push_back(ParcelOf(ranks.Rank(), to));
    }
    return parcels;
  });
  ASSERT_EQ(arrived.size(), with.size());
  for (std::size_t i = 0; i < with.size(); ++i)
  {
    EXPECT_EQ(arrived[i], ParcelOf(with[i], ranks.Rank())) << "from rank " << with[i];
  }
}
}

TEST(Communicator, ExchangesParcelsOfAnyLengthWithItselfToo)
{
  SingleRank alone;
  ExpectParcelsFrom(alone, { 0 });
  ExpectParcelsFrom(alone, {});
  EXPECT_EQ(alone.Sent().messages, 0u);
  RunInThreads(4, [](Communicator& ranks) {
    ExpectParcelsFrom(ranks, { 2, 0, 3, 1 });
    const std::vector<int> twoPairs = { ranks.Rank() ^ 1 };
    ExpectParcelsFrom(ranks, ranks.Rank() < 2 ? twoPairs : std::vector<int>()); // nobody of the others
    ExpectParcelsFrom(ranks, twoPairs);
  });
}

TEST(Communicator, CountsParcelsForOthers)
{
  RunInThreads(3, [](Communicator& ranks) {
    ranks.Collective([] {});
    const Communicator::Traffic agreed = ranks.Sent();
    ExpectParcelsFrom(ranks, { 0, 1, 2 });
    const std::size_t own = static_cast<std::size_t>(ranks.Rank());
    EXPECT_EQ(ranks.Sent().messages, 2 * agreed.messages + 2u);
    EXPECT_EQ(ranks.Sent().bytes, 2 * agreed.bytes + (9 * own + 3 - 4 * own) * sizeof(float));
  });
}

TEST(Communicator, ExchangesNothingWhereOneCannotPack)
{
  RunInThreads(3, [](Communicator& ranks) {
    const auto pack = [&] {
      Require(ranks.Rank() != 1, "no room");
      return std::vector<std::vector<float>>(3);
    };
    EXPECT_THROW(ranks.Exchange<float>({ 0, 1, 2 }, pack), InvalidInput);
    EXPECT_THROW(
      ranks.Exchange<float>({ 0, 2 }, [] { return std::vector<std::vector<float>>(3); }), std::runtime_error);
    EXPECT_THROW(
      ranks.Exchange<float>({ 0, 0 }, [] { return std::vector<std::vector<float>>(2); }), std::runtime_error);
    EXPECT_THROW(ranks.Exchange<float>({ 3 }, [] { return std::vector<std::vector<float>>(1); }), std::runtime_error);
    ExpectParcelsFrom(ranks, { 0, 1, 2 });
  });
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
    ranks.Collective([] {});
    EXPECT_EQ(
      ErrorWords([&] { ranks.Collective([&] { Require(ranks.Rank() != 1, "no medium"); }); }), "On rank 1: no medium");
    EXPECT_EQ(ErrorWords<DeviceError>([&] { ranks.Collective([&] { throw DeviceError("no device"); }); }),
      "no device"); // on all of them
    EXPECT_THROW(ranks.Collective([&] {
      if (ranks.Rank() == 2)
      {
        throw Aborted();
      }
    }),
      Aborted);
  });
}

/// Which may be that another one is stopped; where no rank says why, that.
TEST(Communicator, ThrowsOnAllRanksWhereOneIsNotSentWhatItWaitsFor)
{
  for (const bool stopped : { true, false })
  {
    RunInThreads(3, [stopped](Communicator& ranks) {
      HeldFailure failure;
      failure.broken = ranks.Rank() == 0;
      const auto work = [&] {
        if (stopped && ranks.Rank() == 2)
        {
          throw Aborted();
        }
        failure.Throw();
      };
      try
      {
        ranks.Collective(work);
        ADD_FAILURE() << "rank " << ranks.Rank() << " goes on";
      }
      catch (const Aborted&)
      {
        EXPECT_TRUE(stopped);
      }
      catch (const std::runtime_error& error)
      {
        EXPECT_FALSE(stopped);
        EXPECT_NE(std::string(error.what()).find("On rank 0: Ranks were not sent"), std::string::npos) << error.what();
      }
    });
  }
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
