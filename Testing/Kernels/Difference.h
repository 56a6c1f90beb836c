#pragma once

#include "Light/LightField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

/// Largest difference of two arrays of one size.
inline double LargestDifference(const std::vector<float>& a, const std::vector<float>& b)
{
  EXPECT_EQ(a.size(), b.size());
  double difference = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    difference = std::max(difference, std::abs(static_cast<double>(a[i]) - b[i]));
  }
  return difference;
}

/// Sum of the differences over that of `b`.
inline double SumOfDifferences(const std::vector<float>& a, const std::vector<float>& b)
{
  EXPECT_EQ(a.size(), b.size());
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    difference += std::abs(static_cast<double>(a[i]) - b[i]);
    sum += std::abs(b[i]);
  }
  return difference == 0.0 ? 0.0 : difference / sum;
}

inline void ExpectFiniteAndNotNegative(const std::vector<float>& values)
{
  for (const float value : values)
  {
    ASSERT_TRUE(std::isfinite(value));
    ASSERT_GE(value, 0.0f);
  }
}

/// The largest difference over the largest value of `b`.
inline double RelativeDifference(const std::vector<float>& a, const std::vector<float>& b)
{
  double largest = 0.0;
  for (float value : b)
  {
    largest = std::max<double>(largest, std::abs(value));
  }
  const double difference = LargestDifference(a, b);
  return difference == 0.0 ? 0.0 : difference / largest;
}

/// Root of the mean squared difference over that of `b`; where that is 0, of the difference itself.
inline double RelativeRmse(const std::vector<float>& a, const std::vector<float>& b)
{
  EXPECT_EQ(a.size(), b.size());
  double differences = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    differences += std::pow(static_cast<double>(a[i]) - b[i], 2);
    squares += std::pow(static_cast<double>(b[i]), 2);
  }
  return std::sqrt(squares > 0.0 ? differences / squares : differences);
}

/// Expects that a channel of the light of several has fluence and absorbed power of this channel alone, to 1e-4.
inline void ExpectChannel(const tyndall::LightField& all, int channel, const tyndall::LightField& alone)
{
  ASSERT_EQ(all.fluence.size(), all.channels * alone.fluence.size());
  const float largest = *std::max_element(alone.fluence.begin(), alone.fluence.end());
  for (std::size_t i = 0; i < alone.fluence.size(); ++i)
  {
    ASSERT_NEAR(all.fluence[all.channels * i + channel] / largest, alone.fluence[i] / largest, 1e-4);
  }
  EXPECT_NEAR(all.balance.absorbed[channel] / alone.balance.absorbed[0], 1.0, 1e-4);
}
