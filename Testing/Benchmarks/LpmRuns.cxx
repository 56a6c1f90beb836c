#include "LpmRuns.h"

#include "Measure.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace bench
{
namespace
{
using namespace tyndall;

/// Listens to a solver's progress to know how long the processor works on an order.
class OrderClock
{
public:
  explicit OrderClock(int orders)
    : Orders(orders)
  {
  }

  Monitor Listener()
  {
    return [this](double done) {
      this->Last = { done, CoreSeconds() };
      if (done * this->Orders < 1.0 + 1e-6 || this->First.done == 0.0)
      {
        this->First = this->Last;
      }
      return true;
    };
  }

  double CoreSecondsOfOrder() const
  {
    const double orders = (this->Last.done - this->First.done) * this->Orders;
    return orders > 0.5 ? (this->Last.core - this->First.core) / orders : NotMeasured;
  }

private:
  struct Sample
  {
    double done = 0.0, core = 0.0;
  };
  int Orders;
  Sample First, Last;
};

void Compare(Figures& figures, const std::vector<float>& fluence, const std::vector<float>& reference)
{
  if (fluence.size() != reference.size() || fluence.empty())
  {
    return;
  }
  double difference = 0.0;
  double size = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const double d = std::abs(static_cast<double>(fluence[i]) - reference[i]);
    difference += d * d;
    size += static_cast<double>(reference[i]) * reference[i];
    largest = std::max(largest, d);
  }
  figures.errorL2 = std::sqrt(difference / size);
  figures.errorMax = largest / std::sqrt(size / static_cast<double>(reference.size()));
}

/// One run, its times; the light if it is wanted for comparing.
LightField RunOnce(Device& device, const Method& method, int orders, Figures& figures, bool count)
{
  OrderClock clock(orders);
  device.ResetPeak();
  const PeakMemory memory;
  const double wall = WallSeconds();
  const double core = CoreSeconds();
  LightField light = method.solve(clock.Listener());
  if (!count)
  {
    return light;
  }
  Times times;
  times.wall = WallSeconds() - wall;
  times.core = CoreSeconds() - core;
  const std::vector<ConvergenceRow>& rows = light.convergence;
  if (rows.size() > 1)
  {
    times.orderWall = (rows.back().seconds - rows.front().seconds) / static_cast<double>(rows.size() - 1);
  }
  times.orderCore = clock.CoreSecondsOfOrder();
  figures.runs.push_back(times);
  figures.orders = static_cast<int>(rows.size());
  figures.deviceBytes = static_cast<double>(device.PeakBytes());
  figures.processBytes = memory.Bytes();
  figures.balance = light.balance.RelativeError(light.channels);
  return light;
}

bool IsReference(const std::vector<Method>& methods, const std::string& name)
{
  return std::any_of(methods.begin(), methods.end(), [&](const Method& method) { return method.comparedWith == name; });
}
}

Times Figures::Medians() const
{
  const auto median = [&](double Times::*member) {
    std::vector<double> values;
    for (const Times& times : this->runs)
    {
      values.push_back(times.*member);
    }
    return Median(values);
  };
  return { median(&Times::wall), median(&Times::core), median(&Times::orderWall), median(&Times::orderCore) };
}

std::vector<Figures> RunInterleaved(Device& device, const std::vector<Method>& methods, int orders)
{
  std::vector<Figures> all(methods.size());
  std::map<std::string, std::vector<float>> references;
  int rounds = 0;
  for (const Method& method : methods)
  {
    rounds = std::max(rounds, method.repetitions);
  }
  for (int round = -1; round < rounds; ++round)
  {
    for (std::size_t i = 0; i < methods.size(); ++i)
    {
      const Method& method = methods[i];
      Figures& figures = all[i];
      figures.method = method.name;
      if (!figures.failure.empty() || (round < 0 ? !method.warmUp : round >= method.repetitions))
      {
        continue;
      }
      try
      {
        LightField light = RunOnce(device, method, orders, figures, round >= 0);
        if (round == 0 && references.count(method.comparedWith) > 0)
        {
          figures.comparedWith = method.comparedWith;
          Compare(figures, light.fluence, references[method.comparedWith]);
        }
        if (round == 0 && IsReference(methods, method.name))
        {
          references[method.name] = std::move(light.fluence);
        }
      }
      catch (const DeviceError& error)
      {
        figures.failure = error.what(); // does not fit; the others may
        std::fprintf(stderr, "%s: %s\n", method.name.c_str(), error.what());
      }
    }
  }
  return all;
}
}
