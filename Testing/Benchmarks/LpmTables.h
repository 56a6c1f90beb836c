#pragma once

#include "LpmRuns.h"
#include "MachineLimits.h"
#include "SweepWork.h"

/// What TyndallBenchLpm prints.
namespace bench
{
constexpr const char* Sequential = "sequential as published";
constexpr const char* Parallel = "parallel as published";
constexpr const char* Conservative = "conservative";

constexpr int Orders = 3;
constexpr int DirectionsPerFace = 25;

/// All methods on one scene.
struct Case
{
  std::string scene, grid;
  int edge = 0;
  bool random = true; ///< else the CT scan
  int channels = 1;
  int cores = 1;        ///< of the device
  double updates = 0.0; ///< voxels, directions and channels of an order
  SweepWork work;       ///< of the conservative solver
  MachineLimits limits;
  std::vector<Figures> figures;

  const Figures* Find(const std::string& method) const; ///< null where it was not run
};

/// How a Figures' times compare. Core seconds over cores are what the wall would show if nobody else used the machine
/// and both cores were busy all the time; where others are at work they say more than the wall.
struct Comparison
{
  double wall = NotMeasured;
  double core = NotMeasured;
};
Comparison Ratio(const Figures* slow, const Figures* fast, bool ofOrder);

void PrintJson(const tyndall::Device& device, const MachineLimits& limits);
/// A line a method. Its `ratio` is how many times faster it is than `against`.
void PrintJson(const Case& result);
void PrintTables(const std::vector<Case>& cases);
}
