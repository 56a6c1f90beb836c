#include "LpmTargets.h"

#include "Report.h"

#include <cmath>

namespace bench
{
namespace
{
/// A figure on the wall and the same from core seconds; figures that have nothing to do with time are the same in both.
struct Target
{
  std::string what;
  bool atLeast; ///< else at most
  double limit;
  Comparison figure;
};

std::string Verdict(const Target& target, double figure)
{
  if (!std::isfinite(figure))
  {
    return "-";
  }
  return (target.atLeast ? figure >= target.limit : figure <= target.limit) ? "yes" : "NO";
}

std::string Colours(const Case& result)
{
  return result.channels == 3 ? "RGB" : "grey";
}

/// What every case has to meet.
void AddForAll(std::vector<Target>& targets, const Case& result)
{
  const std::string name = result.scene + " " + result.grid;
  if (const Figures* parallel = result.Find(Parallel); parallel && std::isfinite(parallel->errorL2))
  {
    targets.push_back(
      { name + ": RMSE of parallel against sequential", false, 1e-4, { parallel->errorL2, parallel->errorL2 } });
  }
  if (const Figures* conservative = result.Find(Conservative))
  {
    targets.push_back(
      { name + ": conservative, energy balance", false, 1e-5, { conservative->balance, conservative->balance } });
  }
}

void AddSpeed(std::vector<Target>& targets, const Case& result)
{
  const Figures* conservative = result.Find(Conservative);
  if (!conservative)
  {
    return;
  }
  const std::string name = Colours(result) + " " + result.grid + ": ";
  const Times times = conservative->Medians();
  const double ns = 1e9 / result.updates;
  if (result.edge == 64 || result.edge == 128)
  {
    targets.push_back({ name + "conservative, ns an update", false, 0.35,
      { ns * times.orderWall, ns * times.orderCore / result.cores } });
    targets.push_back({ name + "conservative / parallel as published, whole call", true, result.edge == 64 ? 5.0 : 3.0,
      Ratio(result.Find(Parallel), conservative, false) });
    if (result.channels == 3)
    {
      targets.push_back({ name + "conservative, the paper's case, s", false, result.edge == 64 ? 0.15 : 1.1,
        { times.wall, times.core / result.cores } });
    }
  }
  if (const Figures* sequential = result.Find(Sequential))
  {
    Comparison ratio = Ratio(sequential, conservative, false);
    ratio.core *= result.cores; // the one runs on one core, the other on all
    targets.push_back({ name + "conservative / sequential as published, whole call", true, 40.0, ratio });
  }
  if (result.edge == 256 && result.channels == 3)
  {
    targets.push_back({ name + "conservative, device memory, GB", false, 1.0,
      { 1e-9 * conservative->deviceBytes, 1e-9 * conservative->deviceBytes } });
  }
}
}

void PrintTargets(const std::vector<Case>& cases)
{
  std::vector<Target> targets;
  for (const Case& result : cases)
  {
    if (result.random)
    {
      AddSpeed(targets, result);
    }
    AddForAll(targets, result);
  }
  Table table({ "target", "", "limit", "wall", "met", "cores", "met" });
  for (const Target& target : targets)
  {
    table.Add({ target.what, target.atLeast ? ">=" : "<=", Text("%.3g", target.limit), Text("%.3g", target.figure.wall),
      Verdict(target, target.figure.wall), Text("%.3g", target.figure.core), Verdict(target, target.figure.core) });
  }
  table.Print("Targets. wall: as measured; cores: from core seconds, as if nobody else used the machine");
}
}
