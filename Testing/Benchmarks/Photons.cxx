// Photons through a refractive medium: the stages of Pfeuti's reference pipeline beside his times, what accumulation
// costs and saves, how paths and light converge, and what the samplers are worth. How to read it: "seconds" is wall
// time, the median of several runs; "core_seconds" is processor time over the device's compute units, which other
// programs at work hardly change.
//
//   TyndallBenchPhotons [--quick] [stages] [marching] [octree] [power] [lenses] [prism] [focus] [samplers] [scaling]
//   [threads] [scattering] [ball]

#include "MachineLimits.h"
#include "Measure.h"
#include "PhotonRuns.h"
#include "PhotonTables.h"
#include "Program.h"

using namespace bench;

namespace
{
void RunAll(tyndall::Device& device, const Arguments& arguments)
{
  const PhotonBench bench = { device, MeasureLimits(device, !arguments.quick), arguments.quick };
  PhotonLine("machine", device.Name())
    .Add("bytes_per_second", bench.limits.bytes)
    .Add("threads", device.ComputeUnits())
    .Add("load", LoadAverage())
    .Print();
  const std::pair<const char*, void (*)(const PhotonBench&)> tables[] = { { "stages", TimeStages },
    { "marching", TimeWays }, { "octree", CompareOctrees }, { "power", LosePower }, { "lenses", FollowLenses },
    { "prism", TurnByPrism }, { "focus", FocusLight }, { "samplers", CompareSamplers }, { "scaling", Scale },
    { "threads", ScaleThreads }, { "scattering", ScatterPhotons }, { "ball", ScatterInABall } };
  for (const auto& [name, make] : tables)
  {
    if (arguments.Asks(name))
    {
      make(bench);
    }
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
