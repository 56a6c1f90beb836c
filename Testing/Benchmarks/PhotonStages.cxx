#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/PlyFile.h"

#include "Reference/PfeutiTimes.h"
#include "Viewing/MediumRayCaster.h"

#include <cstdio>
#include <fstream>

namespace bench
{
using namespace tyndall;

namespace
{
class StageTable
{
public:
  StageTable(const PhotonBench& bench, const PaperScene& scene)
    : Bench(bench)
    , Scene(scene)
    , Rows({ "stage", "", "ms", "core ms", "paper ms" })
  {
  }

  void Time(const std::string& name, double paper, const std::function<double()>& run)
  {
    const PhotonTimes times = Repeat(this->Bench.device, this->Bench.quick ? 1 : 7, run);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double paperSeconds = paper > 0.0 ? 1e-3 * paper : none;
    PhotonLine("stages", name, this->Scene.settings.grid)
      .Add("scene", this->Scene.name)
      .Add("seconds", times.seconds)
      .Add("core_seconds", times.coreSeconds)
      .Add("paper_seconds", paperSeconds)
      .Print();
    this->Rows.Add({ name, "", Text("%.1f", 1e3 * times.seconds), Text("%.1f", 1e3 * times.coreSeconds),
      Text("%.0f", 1e3 * paperSeconds) });
  }

  void Print(const std::string& title) const { this->Rows.Print(title); }

private:
  const PhotonBench& Bench;
  const PaperScene& Scene;
  Table Rows;
};

struct View
{
  const char* name;
  bool bends;
  bool reflects; ///< surfaces by Fresnel's formula, and a table below
  double g;
};

/// Pictures of 800x600 of what the photons left.
void TimeViewing(
  const PhotonBench& bench, const PaperScene& scene, const PhotonLight& light, double paper, StageTable& table)
{
  const View views[] = { { "straight rays", false, false, 0.0 }, { "refraction", true, false, 0.0 },
    { "refraction, reflecting surface and table", true, true, 0.0 }, { "refraction, g = 0.5", true, false, 0.5 } };
  for (const View& view : views)
  {
    for (const double step : { 0.5, 1.0 })
    {
      Medium medium = scene.Medium();
      medium.phase = PhaseFunction::HenyeyGreenstein(view.g);
      ViewSettings settings;
      settings.imageSize = bench.quick ? std::array<int, 2>{ 80, 60 } : std::array<int, 2>{ 800, 600 };
      settings.stepSize = step;
      settings.surfaceReflection = view.reflects ? SurfaceReflection::Fresnel : SurfaceReflection::None;
      settings.tableFace = view.reflects ? 4 : -1;
      const Field fluence = { light.light.fluence.data(), light.light.channels };
      const SolvedLight solved = { fluence, fluence, { light.meanDirection.data(), 3 } };
      const Camera camera = FrameGrid(medium.grid, 4.0 / 3.0);
      const Field index = view.bends ? scene.Index() : Field{};
      if (step < 1.0)
      {
        table.Time("first picture of new light, " + std::string(view.name), 0.0, [&] {
          return Timed(
            [&] { MediumRayCaster(bench.device, medium, solved, scene.light, settings, index).Render(camera); });
        });
      }
      MediumRayCaster caster(bench.device, medium, solved, scene.light, settings, index);
      table.Time("viewing, " + std::string(view.name) + Text(", step %g", step), view.bends ? paper : 0.0,
        [&] { return Timed([&] { caster.Render(camera); }); });
    }
  }
}

void TimeStagesOf(const PhotonBench& bench, PaperScene& scene, const PfeutiPasses& paper)
{
  Device& device = bench.device;
  StageTable table(bench, scene);
  table.Time("voxelisation", paper.voxelisation, [&] { return Timed([&] { scene.Voxelize(device); }); });
  table.Time("octree", paper.octree, [&] { return Timed([&] { scene.Group(); }); });
  table.Time("generation", paper.generation, [&] { return Timed([&] { scene.Emit(paper.photons); }); });
  PhotonMarcher marcher = scene.Marcher(device);
  table.Time("marching", paper.marching, [&] { return marcher.March(scene.photons).secondsMarching; });
  table.Time("marching with sorting and copies", paper.marching, [&] { return marcher.March(scene.photons).seconds; });
  table.Time("preparing the medium to march", 0.0, [&] { return Timed([&] { scene.Marcher(device); }); });
  TimeViewing(bench, scene, marcher.March(scene.photons), paper.viewing, table);
  table.Print(
    "Stages, " + scene.name + ", " + std::to_string(paper.photons) + " photons, pictures of 800x600 (paper: GTX 260)");
}
}

void TimeStages(const PhotonBench& bench)
{
  const int edge = bench.quick ? 32 : 128;
  PaperScene ball = BallInFog(edge);
  TimeStagesOf(bench, ball, PfeutiPassesOf("ball", "reference"));
  const std::string file = std::string(TYNDALL_FETCHED_DATA) + "/armadillo.ply";
  if (std::ifstream(file).good())
  {
    PaperScene armadillo = MeshInFog("armadillo", ReadPly(file), edge);
    TimeStagesOf(bench, armadillo, PfeutiPassesOf("armadillo", "reference"));
  }
  else
  {
    std::fprintf(stderr, "There is no %s: left out (./run bench fetches it)\n", file.c_str());
  }
}
}
