#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "Reference/PfeutiTimes.h"

#include <cmath>

namespace bench
{
using namespace tyndall;

namespace
{
struct NamedSampler
{
  Sampler sampler;
  const char* name;
};
constexpr NamedSampler Samplers[] = { { Sampler::Hammersley, "Hammersley" }, { Sampler::Halton, "Halton" },
  { Sampler::Jittered, "jittered" }, { Sampler::Grid, "grid" }, { Sampler::Random, "random" } };

/// The light of a hundred times as many photons.
struct Reference
{
  std::vector<float> fluence;
  double ownError = 0.0; ///< as two of them with other photons differ, over the root of 2
};

Reference MakeReference(PaperScene& scene, PhotonMarcher& marcher, std::size_t count)
{
  Reference reference;
  scene.Emit(count, Sampler::Halton, 11);
  const std::vector<float> other = marcher.March(scene.photons).light.fluence;
  scene.Emit(count, Sampler::Hammersley);
  reference.fluence = marcher.March(scene.photons).light.fluence;
  const double difference = RelativeL2(other, reference.fluence);
  reference.ownError = difference / std::sqrt(2.0);
  PhotonLine("samplers", "reference", scene.settings.grid)
    .Add("photons", static_cast<double>(scene.photons.size()))
    .Add("error_l2", reference.ownError)
    .Print();
  return reference;
}
}

void CompareSamplers(const PhotonBench& bench)
{
  const std::vector<std::size_t> counts = bench.quick
    ? std::vector<std::size_t>{ 1000, 4000 }
    : std::vector<std::size_t>{ 1000, 3000, 10000, 30000, PaperPhotons };
  PaperScene scene = BallInFog(bench.quick ? 16 : 128);
  scene.Voxelize(bench.device);
  scene.Group();
  PhotonMarcher marcher = scene.Marcher(bench.device);
  const Reference reference = MakeReference(scene, marcher, 100 * counts.back());

  std::vector<std::string> headings = { "sampler", "" };
  for (const std::size_t count : counts)
  {
    headings.push_back(std::to_string(count));
  }
  headings.insert(headings.end(), { "order", "marching ms", "with sorting", "paper ms" });
  Table table(headings);
  for (const NamedSampler& sampler : Samplers)
  {
    std::vector<std::string> row = { sampler.name, "" };
    std::vector<double> errors;
    PhotonTimes times, whole;
    for (const std::size_t count : counts)
    {
      scene.Emit(count, sampler.sampler, 1);
      PhotonLight light;
      std::vector<double> seconds;
      times = Repeat(bench.device, bench.quick ? 1 : 5, [&] {
        light = marcher.March(scene.photons);
        return light.secondsMarching;
      });
      errors.push_back(RelativeL2(light.light.fluence, reference.fluence));
      row.push_back(Text("%.4f", errors.back()));
      whole.seconds = light.seconds;
      PhotonLine("samplers", sampler.name, scene.settings.grid)
        .Add("photons", static_cast<double>(count))
        .Add("error_l2", errors.back())
        .Add("seconds", times.seconds)
        .Add("core_seconds", times.coreSeconds)
        .Print();
    }
    const double ratio = static_cast<double>(counts.back()) / static_cast<double>(counts.front());
    row.push_back(Text("%.2f", ObservedOrder(errors.front(), errors.back(), ratio)));
    row.push_back(Text("%.1f", 1e3 * times.seconds));
    row.push_back(Text("%.1f", 1e3 * whole.seconds));
    row.push_back(PfeutiMarchingTimes(sampler.name));
    table.Add(row);
  }
  table.Print("Relative L2 error of fluence by photons, against a hundred times the largest number of them (whose own "
              "error is\n" +
    Text("%.5f", reference.ownError) +
    "), the order in 1 / photons, and times of the largest number (paper: GTX 260, Table 4.1)");
}
}
