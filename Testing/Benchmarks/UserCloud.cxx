#include "UserCloud.h"

#include "Measure.h"
#include "Report.h"

#include "../Kernels/CloudPictures.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <thread>

using namespace tyndall;

namespace bench
{
namespace
{
/// Two independent pictures of one view by Monte Carlo.
struct Reference
{
  std::vector<double> first, second;
  double seconds;
};

Reference ReferenceOf(const cloud_pictures::Setup& setup, const cloud_pictures::View& view, int paths)
{
  const int threads = std::max(1u, std::thread::hardware_concurrency());
  const double start = WallSeconds();
  Reference reference;
  reference.first = cloud_pictures::ByMonteCarlo(setup, view, paths, 1, threads);
  reference.second = cloud_pictures::ByMonteCarlo(setup, view, paths, 2, threads);
  reference.seconds = WallSeconds() - start;
  return reference;
}
}

void ShowUserCloud(Device& device, int edge, int paths)
{
  cloud_pictures::Setup setup;
  setup.edge = edge;
  std::vector<Reference> references;
  for (const cloud_pictures::View& view : cloud_pictures::Views)
  {
    references.push_back(ReferenceOf(setup, view, paths));
    std::printf("Monte Carlo, %s: %.1f s\n", view.name, references.back().seconds);
  }
  Table table({ "cloud", "method", "picture", "RMS, %", "noise, %", "mean, %", "s", "sweeps" });
  double isotropicSeconds = 0.0;
  for (const cloud_pictures::Method& method : cloud_pictures::Methods)
  {
    cloud_pictures::LitCloud cloud(setup, method);
    device.ResetPeak();
    const double start = WallSeconds();
    cloud.Solve(device);
    const double seconds = WallSeconds() - start;
    isotropicSeconds = method.g == 0.0 ? seconds : isotropicSeconds;
    for (std::size_t v = 0; v < references.size(); ++v)
    {
      const cloud_pictures::View& view = cloud_pictures::Views[v];
      const double viewing = WallSeconds();
      const std::vector<double> picture = cloud.Picture(device, view);
      const double viewed = WallSeconds() - viewing;
      const cloud_pictures::Errors errors =
        cloud_pictures::ErrorsOf(picture, references[v].first, references[v].second);
      const std::string grid = std::to_string(edge) + "^3";
      JsonLine()
        .Add("bench", "cloud")
        .Add("case", std::string("user's cloud, ") + view.name)
        .Add("method", method.name)
        .Add("grid", grid)
        .Add("seconds", seconds)
        .Add("peak_bytes", static_cast<double>(device.PeakBytes()))
        .Add("seconds_view", viewed)
        .Add("iterations", static_cast<double>(cloud.Light().convergence.size()))
        .Add("error_rms", errors.rms)
        .Add("error_mean", errors.mean)
        .Add("noise_rms", errors.noise)
        .Add("ratio", isotropicSeconds > 0.0 ? seconds / isotropicSeconds : NAN)
        .Add("against", "g = 0")
        .Print();
      table.Add({ grid, method.name, view.name, Text("%.2f", 100.0 * errors.rms), Text("%.2f", 100.0 * errors.noise),
        Text("%+.2f", 100.0 * errors.mean), Text("%.2f", seconds), std::to_string(cloud.Light().convergence.size()) });
    }
  }
  table.Print("A user's cloud (tau 50 through the middle, albedo 0.9999, g 0.85, sun and sky): pictures against Monte "
              "Carlo.\nRMS over the picture relative to its mean, without the noise of Monte Carlo (from two halves)");
}
}
