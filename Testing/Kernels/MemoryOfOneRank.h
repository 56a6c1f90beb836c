#pragma once

// Solves over ranks of which one has too little memory: for tests of what all then do.

#include "Device/Device.h"
#include "Device/Errors.h"
#include "Device/MemoryBudget.h"
#include "Distribution/RanksInThreads.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

/// By how many bytes more the array would have fit that words of Device say does not; 0: they say something else.
inline std::size_t BytesMissing(const std::string& words)
{
  std::size_t needed = 0, left = 0;
  const std::size_t numbers = words.find(": ", words.find("Not enough memory"));
  const bool found = numbers != std::string::npos &&
    std::sscanf(words.c_str() + numbers, ": %zu bytes are needed, %zu", &needed, &left) == 2;
  return found && needed > left ? needed - left : 0;
}

/// The last rank has too little memory for an array, for each array in turn that it has more in use with than ever
/// before: all ranks say so with the same words, and none waits for another.
/// @param bytes  that it has at first
/// @param solve  on the device of a rank
inline void ExpectToFailTogether(tyndall::Device& device, int ranks, std::size_t bytes,
  const std::function<void(tyndall::Device&, tyndall::Communicator&)>& solve)
{
  constexpr double Patience = 10.0; // seconds
  int failed = 0;
  for (std::size_t missing = 1; missing > 0; ++failed)
  {
    tyndall::MemoryBudget budget;
    budget.bytes = bytes;
    std::vector<std::string> said(static_cast<std::size_t>(ranks));
    const auto trySolve = [&](tyndall::Communicator& communicator) {
      try
      {
        tyndall::Device own(device, communicator.Rank() == ranks - 1 ? budget : tyndall::MemoryBudget());
        solve(own, communicator);
      }
      catch (const tyndall::DeviceError& error)
      {
        said[static_cast<std::size_t>(communicator.Rank())] = error.what();
      }
    };
    SCOPED_TRACE(std::to_string(bytes) + " bytes");
    ASSERT_NO_THROW(tyndall::RunInThreads(ranks, trySolve, Patience));
    EXPECT_EQ(said, std::vector<std::string>(said.size(), said[0]));
    missing = BytesMissing(said.back());
    EXPECT_EQ(said.back().empty(), missing == 0) << said.back();
    bytes += missing;
  }
  EXPECT_GT(failed, 5);
}
