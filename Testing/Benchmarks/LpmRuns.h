#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Light/LightField.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

/// Methods side by side on one scene.
namespace bench
{
constexpr double NotMeasured = std::numeric_limits<double>::quiet_NaN();

struct Method
{
  std::string name;
  int repetitions = 1;
  bool warmUp = true;       ///< run once before, so that kernels are compiled and caches are filled
  std::string comparedWith; ///< the method whose fluence is the reference for this one's; empty: none
  std::function<tyndall::LightField(const tyndall::Monitor&)> solve;
};

/// Times of one run. An order's are the mean of all orders but the first, which waits for upload and compilation.
struct Times
{
  double wall = NotMeasured, core = NotMeasured; ///< s; core seconds are added up over the threads
  double orderWall = NotMeasured, orderCore = NotMeasured;
};

struct Figures
{
  std::string method, comparedWith;
  std::vector<Times> runs;
  int orders = 0;
  double deviceBytes = NotMeasured;  ///< largest total of the device's buffers
  double processBytes = NotMeasured; ///< largest growth of the process, which holds a CPU device's buffers too
  double balance = NotMeasured;
  double errorL2 = NotMeasured;  ///< root mean square difference of fluence from `comparedWith`, over that one's
  double errorMax = NotMeasured; ///< largest difference, over the root mean square fluence
  std::string failure;           ///< why there are no runs

  Times Medians() const;
};

/// A B C A B C ...: what else the machine does falls on all methods alike.
std::vector<Figures> RunInterleaved(tyndall::Device& device, const std::vector<Method>& methods, int orders);
}
