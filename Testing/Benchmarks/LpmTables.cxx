#include "LpmTables.h"

#include "LpmTargets.h"
#include "Measure.h"
#include "Report.h"

#include <algorithm>
#include <cstdio>

namespace bench
{
namespace
{
double NsPerUpdate(const Case& result, double secondsOfOrder)
{
  return 1e9 * secondsOfOrder / result.updates;
}

bool OnDevice(const Figures& figures)
{
  return figures.method == Conservative || figures.method == Parallel;
}

/// Threads that a method keeps busy.
int Cores(const Case& result, const Figures& figures)
{
  return figures.method == Sequential ? 1 : result.cores;
}

/// Of the conservative solver: what it does in a second of the cores' time over what they can do.
struct Shares
{
  double operations = NotMeasured, flops = NotMeasured, bytes = NotMeasured;
};

Shares SharesOf(const Case& result, const Figures& figures)
{
  if (figures.method != Conservative)
  {
    return {};
  }
  const double seconds = figures.Medians().orderCore / result.cores / result.updates;
  return { result.work.operations / seconds / result.limits.multiplyAdds,
    result.work.flops / seconds / (2.0 * result.limits.multiplyAdds),
    result.work.bytes / seconds / result.limits.bytes };
}

void PrintMethod(const Case& result, const Figures& figures)
{
  JsonLine line;
  line.Add("bench", "lpm").Add("case", result.scene).Add("method", figures.method).Add("grid", result.grid);
  if (!figures.failure.empty())
  {
    line.Add("failure", figures.failure).Print();
    return;
  }
  const Times times = figures.Medians();
  const Shares shares = SharesOf(result, figures);
  line.Add("channels", result.channels)
    .Add("directions_per_face", DirectionsPerFace)
    .Add("seconds", times.wall)
    .Add("core_seconds", times.core)
    .Add("seconds_per_order", times.orderWall)
    .Add("core_seconds_per_order", times.orderCore)
    .Add("repetitions", static_cast<double>(figures.runs.size()))
    .Add("iterations", figures.orders)
    .Add("ns_per_update", NsPerUpdate(result, times.orderWall))
    .Add("core_ns_per_update", NsPerUpdate(result, times.orderCore) / Cores(result, figures))
    .Add("peak_bytes", OnDevice(figures) ? figures.deviceBytes : figures.processBytes)
    .Add("process_peak_bytes", figures.processBytes)
    .Add("balance", figures.balance)
    .Add("operation_share", shares.operations)
    .Add("flop_share", shares.flops)
    .Add("bandwidth_share", shares.bytes)
    .Add("error_l2", figures.errorL2)
    .Add("error_max", figures.errorMax);
  if (!figures.comparedWith.empty())
  {
    line.Add("error_against", figures.comparedWith);
  }
  const Figures* conservative = result.Find(Conservative);
  if (conservative && conservative != &figures)
  {
    const Comparison whole = Ratio(conservative, &figures, false);
    const Comparison order = Ratio(conservative, &figures, true);
    line.Add("ratio", whole.wall).Add("core_ratio", whole.core);
    line.Add("ratio_per_order", order.wall).Add("core_ratio_per_order", order.core).Add("against", Conservative);
  }
  line.Add("load", LoadAverage()).Print();
}

std::vector<std::string> MethodRow(const Case& result, const Figures& figures)
{
  if (!figures.failure.empty())
  {
    return { result.scene + " " + result.grid, figures.method, "fails" };
  }
  const Times times = figures.Medians();
  const Figures* conservative = result.Find(Conservative);
  const Comparison whole = Ratio(&figures, conservative, false);
  const Comparison order = Ratio(&figures, conservative, true);
  const auto megabytes = [](double bytes) { return Text("%.0f", bytes / 1e6); };
  return { result.scene + " " + result.grid, figures.method, std::to_string(figures.runs.size()),
    Text("%.4f", times.wall), Text("%.4f", times.core), Text("%.4f", times.orderWall),
    Text("%.3f", NsPerUpdate(result, times.orderWall)),
    Text("%.3f", NsPerUpdate(result, times.orderCore) / Cores(result, figures)), Text("%.2f", whole.wall),
    Text("%.2f", whole.core), Text("%.2f", order.core), OnDevice(figures) ? megabytes(figures.deviceBytes) : "-",
    megabytes(figures.processBytes), Text("%.1e", figures.balance), Text("%.1e", figures.errorL2) };
}

void PrintFigures(const std::vector<Case>& cases)
{
  Table table({ "case", "method", "runs", "seconds", "core s", "s/order", "ns/update", "core ns", "x conservative",
    "core x", "order x", "device MB", "process MB", "balance", "RMSE" });
  for (const Case& result : cases)
  {
    for (const Figures& figures : result.figures)
    {
      table.Add(MethodRow(result, figures));
    }
  }
  table.Print("Medians; 25 directions a face, 3 orders");
  std::printf("  seconds: the whole call on the wall; core s: of all threads together. s/order: all but the first.\n"
              "  ns/update: an order, a voxel, direction and channel; core ns: from core seconds over the cores used.\n"
              "  x conservative: times of the conservative solver's whole call; core x: in core seconds; order x: an "
              "order in core seconds.\n"
              "  RMSE of fluence: parallel against sequential.\n");
}

void PrintShares(const std::vector<Case>& cases)
{
  Table table({ "case", "", "operations", "flops", "bytes", "cached", "operations %", "flops %", "bandwidth %" });
  for (const Case& result : cases)
  {
    const Figures* conservative = result.Find(Conservative);
    if (conservative && conservative->failure.empty())
    {
      const Shares shares = SharesOf(result, *conservative);
      table.Add(
        { result.scene + " " + result.grid, "", Text("%.1f", result.work.operations), Text("%.1f", result.work.flops),
          Text("%.2f", result.work.bytes), Text("%.1f", result.work.cached), Text("%.0f", 100.0 * shares.operations),
          Text("%.0f", 100.0 * shares.flops), Text("%.0f", 100.0 * shares.bytes) });
    }
  }
  const MachineLimits& limits = cases.front().limits;
  char title[200];
  std::snprintf(title, sizeof(title),
    "Conservative: work per update, and share of this machine's limits (%.0f Gflop/s by multiply-adds, %.1f GB/s by "
    "triad)",
    2e-9 * limits.multiplyAdds, 1e-9 * limits.bytes);
  table.Print(title);
  std::printf(
    "  Counted in the kernels' texts (SweepWork.h); time from core seconds. operations: any arithmetic is one, at\n"
    "  the rate of multiply-adds; bytes: volumes once a sweep each way; cached: loads and stores of rays and "
    "planes.\n");
}
}

const Figures* Case::Find(const std::string& method) const
{
  const auto found =
    std::find_if(this->figures.begin(), this->figures.end(), [&](const Figures& row) { return row.method == method; });
  return found == this->figures.end() || !found->failure.empty() ? nullptr : &*found;
}

Comparison Ratio(const Figures* slow, const Figures* fast, bool ofOrder)
{
  if (!slow || !fast)
  {
    return {};
  }
  const Times a = slow->Medians();
  const Times b = fast->Medians();
  return ofOrder ? Comparison{ a.orderWall / b.orderWall, a.orderCore / b.orderCore }
                 : Comparison{ a.wall / b.wall, a.core / b.core };
}

void PrintJson(const tyndall::Device& device, const MachineLimits& limits)
{
  JsonLine()
    .Add("bench", "lpm")
    .Add("case", "machine")
    .Add("method", "limits")
    .Add("device", device.Name())
    .Add("cores", device.ComputeUnits())
    .Add("vector", device.KernelWidth(1))
    .Add("flops_per_second", 2.0 * limits.multiplyAdds)
    .Add("bytes_per_second", limits.bytes)
    .Add("load", LoadAverage())
    .Print();
}

void PrintJson(const Case& result)
{
  for (const Figures& figures : result.figures)
  {
    PrintMethod(result, figures);
  }
}

void PrintTables(const std::vector<Case>& cases)
{
  PrintFigures(cases);
  PrintShares(cases);
  PrintTargets(cases);
  std::printf(
    "\nLoad average at the end: %.1f on %d cores. Above 1 others were at work: believe core seconds, not the wall.\n",
    LoadAverage(), cases.front().cores);
}
}
