// A sweep of a grid that is spread over ranks by blocks: what it sends and keeps, counted on ranks that are threads;
// and how it goes on with up to a thousand ranks, played through with the schedule that the sweep itself follows.
//
//   TyndallBenchScaleModel [--quick] [counted] [model]
//
//   counted  1 to 8 ranks: bytes and messages a sweep and rank, beside those that the schedule foretells and the
//            surface of the blocks; memory a rank; what cutting a sweep into octants costs a rank by itself
//   model    up to 1000 ranks, at the cost of a ray that was measured: how busy ranks are, and how long repeated sweeps
//            of whole blocks (block-Jacobi) take until light has come through all of them

#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "../Kernels/RanksInThreads.h"

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepInMemory.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

using namespace bench;
using namespace tyndall;

namespace
{
constexpr int DirectionsPerFace = 25;
constexpr std::array<bool, 3> open = { false, false, false };

/// Of a network between machines.
constexpr double SecondsOfMessage = 5e-6;
constexpr double SecondsOfFloat = 4.0 / 5e9;

std::vector<AxisBundles> RaysOf(const Grid& grid)
{
  const DirectionSet set = FittedDirections(DirectionsPerFace);
  std::vector<AxisBundles> rays;
  for (int axis = 0; axis < 3; ++axis)
  {
    rays.push_back({ axis, BundlesAlong(axis, grid, open, set, 1) });
  }
  return rays;
}

Grid Cube(int edge)
{
  Grid grid;
  grid.size = { edge, edge, edge };
  return grid;
}

/// An even medium on a grid that shines, and where its light goes.
struct Volume
{
  Volume(Device& device, const Grid& grid)
    : layout({ grid, 1, true })
    , sigma_t(device, layout.Floats(), "sigma_t")
    , source(device, layout.Floats(), "source")
    , path(device, layout.Floats(), "path")
  {
    sigma_t.Fill(0.05f);
    source.Fill(1.0f);
    path.Fill(0.0f);
  }
  SweepRequest Request(const Grid& whole) const { return { { &path, nullptr, nullptr, nullptr }, RaysOf(whole) }; }

  VolumeLayout layout;
  Buffer<float> sigma_t, source, path;
};

/// What one rank of a sweep sends and takes.
struct RankCount
{
  double messages = 0.0, bytes = 0.0, memory = 0.0, seconds = 0.0;
};

/// What a sweep over ranks takes, by rank.
struct Counted
{
  std::vector<RankCount> ranks;
  double foretoldMessages = 0.0, foretoldBytes = 0.0;
  double Most(double RankCount::*what) const
  {
    double most = 0.0;
    for (const RankCount& rank : ranks)
    {
      most = std::max(most, rank.*what);
    }
    return most;
  }
  double All(double RankCount::*what) const
  {
    double all = 0.0;
    for (const RankCount& rank : ranks)
    {
      all += rank.*what;
    }
    return all;
  }
};

/// One rank after the other makes its arrays, so that the device's count tells what they are; then all sweep.
Counted SweepOverRanks(Device& device, const Grid& grid, int ranks)
{
  const BlockPartition partition = BlockPartition::Even(grid, ranks);
  Counted counted;
  counted.ranks.resize(ranks);
  std::mutex guard;
  RunInThreads(ranks, [&](Communicator& communicator) {
    const int rank = communicator.Rank();
    std::unique_ptr<Volume> volume;
    BlockWorkspace workspace;
    std::unique_ptr<SweepInBlocks> sweep;
    {
      const std::lock_guard<std::mutex> lock(guard);
      const std::size_t before = device.BytesInUse();
      volume = std::make_unique<Volume>(device, partition.OwnGrid(rank));
      const std::array<bool, 3> open = {};
      sweep = std::make_unique<SweepInBlocks>(
        device, communicator, partition, volume->layout, volume->sigma_t, open, volume->Request(grid), workspace);
      counted.ranks[rank].memory = static_cast<double>(device.BytesInUse() - before + sweep->FaceBytes());
    }
    sweep->Apply(&volume->source, {}, {}); // compiles
    const Communicator::Traffic before = communicator.Sent();
    const double start = WallSeconds();
    sweep->Apply(&volume->source, {}, {});
    counted.ranks[rank].seconds = WallSeconds() - start;
    counted.ranks[rank].messages = static_cast<double>(communicator.Sent().messages - before.messages);
    counted.ranks[rank].bytes = static_cast<double>(communicator.Sent().bytes - before.bytes);
    if (rank == 0)
    {
      // Each set of rays is told by a float whether it is dark; sums and agreements are three words to each and back.
      const double agreements = 2.0 * 3.0 * (ranks - 1);
      const SweepSchedule& schedule = sweep->Schedule();
      counted.foretoldMessages = static_cast<double>(schedule.Messages()) + agreements;
      counted.foretoldBytes = 4.0 * static_cast<double>(schedule.Values() + schedule.Messages());
    }
  });
  return counted;
}

double SecondsInMemory(Device& device, const Grid& grid)
{
  const Volume volume(device, grid);
  SweepWorkspace workspace;
  SweepInMemory sweep(device, volume.layout, volume.sigma_t, open, volume.Request(grid), workspace);
  sweep.Apply(&volume.source, {}, {});
  const double start = WallSeconds();
  sweep.Apply(&volume.source, {}, {});
  return WallSeconds() - start;
}

/// Cells of a block's faces that are not the grid's, of the rank that has most.
double InnerSurface(const BlockPartition& partition)
{
  double most = 0.0;
  for (const VoxelBox& block : partition.blocks)
  {
    double cells = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double ofFace = static_cast<double>(block.VoxelCount()) / std::max(1, block.size[axis]);
      cells += ofFace * ((block.first[axis] > 0) + (EndOf(block, axis) < partition.whole.size[axis]));
    }
    most = std::max(most, cells);
  }
  return most;
}

void CountSweeps(Device& device, const Grid& grid)
{
  Table table(
    { "grid", "ranks", "s", "MB a rank", "MB sent a rank", "foretold", "floats a cell", "messages", "foretold" });
  const double inMemory = SecondsInMemory(device, grid);
  for (const int ranks : { 1, 2, 3, 4, 8 })
  {
    const Counted counted = SweepOverRanks(device, grid, ranks);
    const double seconds = counted.Most(&RankCount::seconds), surface = InnerSurface(BlockPartition::Even(grid, ranks));
    const double bytes = counted.Most(&RankCount::bytes), memory = counted.Most(&RankCount::memory);
    const double all = counted.All(&RankCount::bytes), messages = counted.All(&RankCount::messages);
    table.Add({ GridText(grid.size[0]), std::to_string(ranks), Text("%.3f", seconds), Text("%.2f", memory / 1e6),
      Text("%.2f", bytes / 1e6), Text("%.3f", all > 0.0 ? counted.foretoldBytes / all : NAN),
      Text("%.1f", surface > 0.0 ? bytes / 4.0 / surface : NAN), Text("%.0f", messages),
      Text("%.0f", counted.foretoldMessages) });
    JsonLine()
      .Add("bench", std::string("scale_model"))
      .Add("case", std::string("counted"))
      .Add("method", std::string("sweep in blocks"))
      .Add("grid", GridText(grid.size[0]))
      .Add("ranks", ranks)
      .Add("seconds", seconds)
      .Add("ratio", seconds / inMemory)
      .Add("peak_bytes", memory)
      .Add("bytes_sent", bytes)
      .Add("bytes_sent_by_all", all)
      .Add("bytes_foretold", counted.foretoldBytes)
      .Add("inner_cells", surface)
      .Add("messages", messages)
      .Add("messages_foretold", counted.foretoldMessages)
      .Print();
  }
  table.Print("A sweep, " + std::to_string(DirectionsPerFace) + " directions a face, grey; in one memory " +
    Text("%.3f s", inMemory) + "; on all ranks together, or of the rank that has most");
}

void PlayThrough(Device& device, const Arguments& arguments)
{
  const Grid one = Cube(arguments.quick ? 16 : 32);
  const double nanoseconds = 1e9 * SweepOverRanks(device, one, 1).Most(&RankCount::seconds) /
    (6.0 * DirectionsPerFace * static_cast<double>(one.VoxelCount()));
  Table table({ "case", "ranks", "rays at once", "s", "busy", "MB sent", "messages", "block-Jacobi" });
  for (const bool weak : { true, false })
  {
    for (const int ranks : arguments.quick ? std::vector<int>{ 1, 8 } : std::vector<int>{ 1, 8, 64, 216, 512, 1000 })
    {
      // Of weak scaling 32^3 voxels a rank, of strong 256^3 on all.
      const int edge = weak ? static_cast<int>(std::lround(32.0 * std::cbrt(ranks))) : 256;
      for (const int mostRays : { 0, 2 })
      {
        const Grid grid = Cube(edge);
        const SweepSchedule schedule(BlockPartition::Even(grid, ranks), SortByOctant(RaysOf(grid), mostRays),
          { nanoseconds * 1e-9, 0.0, SecondsOfMessage, SecondsOfFloat });
        const double busy = schedule.BusyTime() / (ranks * schedule.Time());
        const double jacobi = schedule.BlocksInALine() * schedule.BusyTime() / ranks / schedule.Time();
        const char* name = weak ? "weak" : "strong";
        table.Add(
          { name, std::to_string(ranks), mostRays > 0 ? std::to_string(mostRays) : "all", Text("%.4f", schedule.Time()),
            Text("%.2f", busy), Text("%.1f", 4e-6 * static_cast<double>(schedule.Values())),
            Text("%.0f", static_cast<double>(schedule.Messages())), Text("%.1f", jacobi) });
        JsonLine()
          .Add("bench", std::string("scale_model"))
          .Add("case", std::string(name))
          .Add("method", std::string("played through"))
          .Add("grid", GridText(edge))
          .Add("ranks", ranks)
          .Add("rays_at_once", mostRays)
          .Add("seconds", schedule.Time())
          .Add("busy", busy)
          .Add("bytes_sent_by_all", 4.0 * static_cast<double>(schedule.Values()))
          .Add("messages", static_cast<double>(schedule.Messages()))
          .Add("jacobi_ratio", jacobi)
          .Print();
      }
    }
  }
  table.Print("A sweep played through, " + Text("%.2f", nanoseconds) +
    " ns a ray and voxel; block-Jacobi: the time of as many sweeps of whole blocks as light needs to come through, in "
    "that of this sweep");
}

void Run(Device& device, const Arguments& arguments)
{
  if (arguments.Asks("counted"))
  {
    for (const int edge : arguments.quick ? std::vector<int>{ 16 } : std::vector<int>{ 64, 128 })
    {
      CountSweeps(device, Cube(edge));
    }
  }
  if (arguments.Asks("model"))
  {
    PlayThrough(device, arguments);
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, Run);
}
