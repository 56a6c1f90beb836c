#include "PhotonRuns.h"
#include "PhotonTables.h"

namespace bench
{
using namespace tyndall;

namespace
{
struct Marched
{
  PhotonTimes times;
  PhotonLight light;
};

Marched March(Device& device, const PaperScene& scene, int runs)
{
  Marched result;
  PhotonMarcher marcher = scene.Marcher(device);
  device.ResetPeak();
  result.times = Repeat(device, runs, [&] {
    result.light = marcher.March(scene.photons);
    return result.light.secondsMarching;
  });
  return result;
}

/// The first `count` of a device's compute units, as a device.
std::shared_ptr<Device> PartOf(Device& whole, int count)
{
  const auto handle = whole.Queue().getInfo<CL_QUEUE_DEVICE>();
  const cl_device_partition_property properties[] = { CL_DEVICE_PARTITION_BY_COUNTS, count,
    CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0 };
  std::vector<cl::Device> parts;
  cl::Device(handle).createSubDevices(properties, &parts);
  return std::make_shared<Device>(cl::Platform(handle.getInfo<CL_DEVICE_PLATFORM>()), parts.at(0));
}
}

void Scale(const PhotonBench& bench)
{
  const std::vector<std::size_t> counts = bench.quick
    ? std::vector<std::size_t>{ 10000 }
    : std::vector<std::size_t>{ 10000, 31000, PaperPhotons, 400000, 1000000 };
  Table table({ "grid", "photons", "ms", "core ms", "ns a photon and edge voxel", "deposits/s", "of bandwidth" });
  for (const int edge : bench.quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 })
  {
    PaperScene scene = BallInFog(edge);
    scene.Voxelize(bench.device);
    scene.Group();
    for (const std::size_t count : counts)
    {
      scene.Emit(count);
      const auto [times, light] = March(bench.device, scene, bench.quick ? 1 : 3);
      PrintMarch("scaling", "conservative, octree", scene, bench.device, times, light, bench.limits.bytes);
      table.Add({ std::to_string(edge) + "^3", std::to_string(count), Text("%.1f", 1e3 * times.seconds),
        Text("%.1f", 1e3 * times.coreSeconds), Text("%.3f", 1e9 * times.seconds / count / edge),
        Text("%.2e", light.deposits / times.seconds),
        Text("%.2f", BytesOfDeposits(light) / times.seconds / bench.limits.bytes) });
    }
  }
  table.Print("Marching, by photons and voxels");
}

void ScaleThreads(const PhotonBench& bench)
{
  if (!bench.device.IsCpu())
  {
    return; // a GPU's units cannot be had by number
  }
  PaperScene scene = BallInFog(bench.quick ? 32 : 128);
  scene.Voxelize(bench.device);
  scene.Group();
  scene.Emit(bench.quick ? 10000 : PaperPhotons);
  Table table({ "threads", "", "ms", "speed-up" });
  double one = 0.0;
  for (int threads = 1; threads <= bench.device.ComputeUnits(); threads *= 2)
  {
    const std::shared_ptr<Device> part = PartOf(bench.device, threads);
    const auto [times, light] = March(*part, scene, bench.quick ? 1 : 7);
    PrintMarch("threads", std::to_string(threads) + " threads", scene, *part, times, light, bench.limits.bytes);
    one = threads == 1 ? times.seconds : one;
    table.Add({ std::to_string(threads), "", Text("%.1f", 1e3 * times.seconds), Text("%.2f", one / times.seconds) });
  }
  table.Print("Marching " + std::to_string(scene.photons.size()) + " photons, by threads (parts of the device)");
}
}
