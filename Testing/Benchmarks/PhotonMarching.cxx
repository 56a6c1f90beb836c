#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/PhotonScene.h"

#include "Photons/Published/PublishedPhotons.h"

#include <algorithm>

namespace bench
{
using namespace tyndall;

namespace
{
std::vector<std::string> Row(
  const std::string& name, const PhotonTimes& times, const PhotonLight& light, double bandwidth)
{
  const double bytes = BytesOfDeposits(light) / times.seconds;
  return { name, "", Text("%.1f", 1e3 * times.seconds), Text("%.1f", 1e3 * times.coreSeconds),
    std::to_string(light.steps), Text("%.2e", light.deposits / times.seconds), Text("%.1f", 1e-9 * bytes),
    Text("%.2f", bytes / bandwidth), Text("%.1e", light.light.balance.RelativeError(light.light.channels)) };
}

PaperScene Ready(const PhotonBench& bench, int edge)
{
  PaperScene scene = BallInFog(edge);
  scene.Voxelize(bench.device);
  scene.Group();
  scene.Emit(PaperPhotons);
  for (std::size_t i = 0; i < scene.photons.size(); ++i)
  {
    scene.photons[i].batch = static_cast<std::int32_t>(i % 2);
  }
  return scene;
}
}

namespace
{
/// What adaptive photons do first: few of them, into coarse cells.
void TimePilots(const PhotonBench& bench, const PaperScene& paper)
{
  PaperScene scene = paper;
  scene.Emit(bench.quick ? 256 : 4096);
  PhotonMarcher marcher = scene.Marcher(bench.device);
  Table table({ "pilot photons", "", "ms", "core ms" });
  const auto time = [&](const std::string& name, const std::function<double()>& run) {
    const PhotonTimes times = Repeat(bench.device, bench.quick ? 1 : 15, run);
    PhotonLine("pilots", name, scene.settings.grid)
      .Add("photons", static_cast<double>(scene.photons.size()))
      .Add("seconds", times.seconds)
      .Add("core_seconds", times.coreSeconds)
      .Print();
    table.Add({ name, "", Text("%.2f", 1e3 * times.seconds), Text("%.2f", 1e3 * times.coreSeconds) });
  };
  const std::vector<std::array<int, 2>> origins(scene.photons.size(), { 7, 9 });
  time("gathered in 16^3 cells", [&] { return marcher.Gather(scene.photons, origins, { 16, 16, 16 }).seconds; });
  time("marched into all voxels", [&] { return marcher.March(scene.photons).seconds; });
  table.Print("Pilot photons, with sorting and copies");
}
}

void TimeWays(const PhotonBench& bench)
{
  Device& device = bench.device;
  const PaperScene scene = Ready(bench, bench.quick ? 32 : 128);
  Table table({ "marching", "", "ms", "core ms", "steps", "deposits/s", "GB/s", "of bandwidth", "balance" });
  const auto way = [&](const std::string& name, const std::function<PhotonLight()>& march) {
    PhotonLight light;
    device.ResetPeak();
    const PhotonTimes times = Repeat(device, bench.quick ? 1 : 7, [&] {
      light = march();
      return light.secondsMarching;
    });
    PrintMarch("marching", name, scene, device, times, light, bench.limits.bytes);
    table.Add(Row(name, times, light, bench.limits.bytes));
    return times.seconds;
  };
  const auto conservative = [&](const std::string& name, const MarchSettings& settings, bool octree) {
    PhotonMarcher marcher = scene.Marcher(device, settings, octree);
    return way(name, [&] { return marcher.March(scene.photons); });
  };
  MarchSettings settings;
  conservative("conservative, octree", settings, true);
  conservative("conservative, voxel by voxel", settings, false);
  settings.counts = true;
  conservative("conservative, octree, counts", settings, true);
  settings.batches = true;
  conservative("conservative, octree, counts, 2 batches", settings, true);
  settings.counts = false;
  conservative("conservative, octree, 2 batches", settings, true);
  settings.batches = false;
  settings.order = 4;
  conservative("conservative, order 4, octree", settings, true);
  settings.order = 2;
  settings.sums = MarchSettings::Sums::Shared;
  conservative("conservative, shared sums (atomics)", settings, true);
  way("as published", [&] {
    return MarchPublished(device, Domain(scene.Medium().grid), scene.Medium(), scene.Index(),
      scene.octree.levels.data(), scene.photons, { false });
  });
  PaperScene straight = scene;
  std::fill(straight.voxels.ior.begin(), straight.voxels.ior.end(), 1.0f);
  TimePilots(bench, scene);
  PhotonMarcher marcher = straight.Marcher(device, {}, false);
  way("conservative, constant index", [&] { return marcher.March(straight.photons); });
  table.Print("Marching 122000 photons; GB/s: what their deposits move, beside the machine's bandwidth of " +
    Text("%.1f GB/s", 1e-9 * bench.limits.bytes));
}

void CompareOctrees(const PhotonBench& bench)
{
  PaperScene scene = Ready(bench, bench.quick ? 32 : 128);
  Table table({ "tolerance", "", "steps", "of all", "ms", "core ms", "error L2" });
  const auto march = [&](PhotonMarcher marcher, PhotonLight& light) {
    return Repeat(bench.device, bench.quick ? 1 : 5, [&] {
      light = marcher.March(scene.photons);
      return light.secondsMarching;
    });
  };
  PhotonLight whole;
  const auto add = [&](const std::string& name, const PhotonTimes& times, const PhotonLight& light) {
    const double error = RelativeL2(light.light.fluence, whole.light.fluence);
    const double part = static_cast<double>(light.steps) / static_cast<double>(whole.steps);
    PhotonLine("octree", name, scene.settings.grid)
      .Add("seconds", times.seconds)
      .Add("core_seconds", times.coreSeconds)
      .Add("steps", static_cast<double>(light.steps))
      .Add("ratio", part)
      .Add("against", "voxel by voxel")
      .Add("error_l2", error)
      .Print();
    table.Add({ name, "", std::to_string(light.steps), Text("%.3f", part), Text("%.1f", 1e3 * times.seconds),
      Text("%.1f", 1e3 * times.coreSeconds), Text("%.2e", error) });
  };
  const PhotonTimes all = march(scene.Marcher(bench.device, {}, false), whole);
  add("voxel by voxel", all, whole);
  for (const double tolerance :
    bench.quick ? std::vector<double>{ 0.01 } : std::vector<double>{ 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1 })
  {
    scene.Group(tolerance);
    PhotonLight light;
    const PhotonTimes times = march(scene.Marcher(bench.device), light);
    add(Text("tolerance %g", tolerance), times, light);
  }
  table.Print("Octree: steps, times and fluence against marching voxel by voxel, ball, 122000 photons");
}

namespace
{
void AddLoss(Table& table, const char* where, PhotonScene& scene, Device& device, const std::vector<Photon>& photons)
{
  PackingLoss loss;
  const std::uint8_t* levels = scene.levels.empty() ? nullptr : scene.levels.data();
  const PhotonLight published = MarchPublished(
    device, Domain(scene.Medium().grid), scene.Medium(), scene.Index(), levels, photons, { false }, &loss);
  const PhotonLight conservative = scene.March(device, photons);
  const double count = static_cast<double>(photons.size());
  const double givenUp = static_cast<double>(loss.givenUp) / static_cast<double>(loss.deposits);
  const double publishedError = published.light.balance.RelativeError(3);
  const double conservativeError = conservative.light.balance.RelativeError(conservative.light.channels);
  PhotonLine("power", "as published", scene.medium.grid)
    .Add("scene", where)
    .Add("photons", count)
    .Add("lost", loss.Relative())
    .Add("given_up", givenUp)
    .Add("balance", publishedError)
    .Print();
  PhotonLine("power", "conservative", scene.medium.grid)
    .Add("scene", where)
    .Add("photons", count)
    .Add("balance", conservativeError)
    .Print();
  table.Add({ where, Text("%.0f", count), Text("%.1f %%", 100.0 * loss.Relative()), Text("%.2f %%", 100.0 * givenUp),
    Text("%.1e", publishedError), Text("%.1e", conservativeError) });
}
}

void LosePower(const PhotonBench& bench)
{
  Table table({ "scene", "photons", "published: lost", "given up", "published: balance", "conservative: balance" });
  PhotonScene narrow({ 3, 3, 3 }, 1.0, 1.5, 0.05f, 0.15f);
  for (const std::size_t count :
    bench.quick ? std::vector<std::size_t>{ 1000 } : std::vector<std::size_t>{ 1000, 10000, 100000, 1000000 })
  {
    Photon photon;
    photon.position = { -1.5, 0.1, 0.1 };
    photon.direction = { 1.0f, 0.0f, 0.0f };
    photon.power.fill(1.0f / static_cast<float>(count));
    AddLoss(table, "all through one voxel", narrow, bench.device, std::vector<Photon>(count, photon));
  }
  const PaperScene paper = Ready(bench, bench.quick ? 32 : 128);
  PhotonScene ball(1);
  ball.medium.grid = paper.settings.grid;
  ball.sigma_a = paper.voxels.sigma_a;
  ball.sigma_s = paper.voxels.sigma_s;
  ball.ior = paper.voxels.ior;
  ball.levels = paper.octree.levels;
  AddLoss(table, "ball in fog", ball, bench.device, paper.photons);
  table.Print("Power: what the published packing loses of what was deposited, deposits given up after ten tries (what "
              "else is lost\n"
              "was too small beside what the voxel held), and the balance: (in - out) / in");
}
}
