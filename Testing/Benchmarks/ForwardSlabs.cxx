#include "ForwardSlabs.h"

#include "Measure.h"
#include "Report.h"
#include "SlabPeers.h"

#include "../Kernels/MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <vector>

using namespace tyndall;

namespace bench
{
namespace
{
constexpr double Goal = 3e-3, GoalOfThickWhite = 2e-3; ///< the second: tau 10, albedo 1, g 0.9
const std::map<std::string, double> Cosines = { { "mu1", 1.0 }, { "mu05", 0.5 } };

struct Powers
{
  double reflected, transmitted;
};

struct Slab
{
  PeerCase is;
  std::optional<Powers> reference;
  std::string source = "adding-doubling";

  std::string Name() const
  {
    return "g " + Text("%g", this->is.g) + ", " + this->is.light + ", tau " + Text("%g", this->is.tau) + ", albedo " +
      Text("%g", this->is.albedo);
  }
  double Goal() const
  {
    return this->is.tau == 10.0 && this->is.albedo == 1.0 && this->is.g == 0.9 ? GoalOfThickWhite : bench::Goal;
  }
};

struct Answer
{
  std::string method;
  int layers = 0, sweeps = 0;
  double seconds = 0.0, balance = NAN;
  Powers is = {};
};

/// Worst error by mean cosine, light and method.
struct Worst
{
  double error = -1.0;
  std::string name;
  bool good = true;
  double seconds = 0.0; ///< the sum
  int count = 0;
};

/// tau 0.1 and more of the table, and a mean cosine that it has not, with disortpp's answers as the reference.
std::vector<Slab> Slabs(bool quick)
{
  std::vector<Slab> slabs;
  for (const ReferenceRow& row : ReadReference("slab_forward"))
  {
    const double tau = row["tau"];
    const double g = row["g"];
    if (tau < 0.1 || g == 0.95 || (quick && (g != 0.9 || row["omega"] != 1.0 || tau > 1.0)))
    {
      continue;
    }
    for (const std::string light : { "diffuse", "mu1", "mu05" })
    {
      slabs.push_back({ { tau, row["omega"], g, light }, Powers{ row["R_" + light], row["T_" + light] } });
      if (g == 0.85 && !quick)
      {
        slabs.push_back({ { tau, row["omega"], 0.75, light }, std::nullopt, "disortpp" });
      }
    }
  }
  return slabs;
}

/// Layers of optical thickness 0.1 at most, but no more than 4096.
int LayersOf(double tau)
{
  int layers = 32;
  while (layers < 4096 && tau / layers > 0.1)
  {
    layers *= 2;
  }
  return layers;
}

Answer Solve(Device& device, const Slab& slab, int degree)
{
  Answer answer = { degree == 0 ? "similarity" : "moments", LayersOf(slab.is.tau) };
  const double sigma_t = slab.is.tau / answer.layers;
  Scene scene({ 1, 1, answer.layers }, static_cast<float>(sigma_t * (1.0 - slab.is.albedo)),
    static_cast<float>(sigma_t * slab.is.albedo));
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(slab.is.g);
  scene.settings.periodic = { true, true, false };
  scene.settings.angularDegree = degree;
  const auto cosine = Cosines.find(slab.is.light);
  if (cosine == Cosines.end())
  {
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  }
  else
  {
    scene.ShineAlong({ std::sqrt(1.0 - cosine->second * cosine->second), 0.0, cosine->second });
  }
  const double start = WallSeconds();
  const LightField light = scene.Solve(device);
  answer.seconds = WallSeconds() - start;
  answer.sweeps = static_cast<int>(light.convergence.size());
  answer.balance = light.balance.RelativeError(light.channels);
  const double enters = cosine == Cosines.end() ? Pi : cosine->second;
  answer.is = { light.facePowerOut[4][0] / enters, light.facePowerOut[5][0] / enters };
  return answer;
}

void Print(const Slab& slab, const Answer& answer, double errorR, double errorT)
{
  JsonLine line;
  line.Add("bench", "slab")
    .Add("case", slab.Name())
    .Add("method", answer.method)
    .Add("grid", answer.layers > 0 ? "1x1x" + std::to_string(answer.layers) : "1 layer, 32 streams")
    .Add("seconds", answer.seconds);
  if (answer.sweeps > 0)
  {
    line.Add("iterations", answer.sweeps).Add("layer_tau", slab.is.tau / answer.layers);
  }
  line.Add("balance", answer.balance)
    .Add("reflectance", answer.is.reflected)
    .Add("transmittance", answer.is.transmitted)
    .Add("error_reflectance", errorR)
    .Add("error_transmittance", errorT)
    .Add("error_max", std::max(std::abs(errorR), std::abs(errorT)))
    .Add("against", slab.source)
    .Print();
}

using Summary = std::map<std::vector<std::string>, Worst>;

void Compare(const Slab& slab, const Answer& answer, Summary& summary)
{
  if (!slab.reference || answer.method.rfind(slab.source, 0) == 0)
  {
    return;
  }
  const double errorR = answer.is.reflected - slab.reference->reflected;
  const double errorT = answer.is.transmitted - slab.reference->transmitted;
  Print(slab, answer, errorR, errorT);
  const double error = std::max(std::abs(errorR), std::abs(errorT));
  Worst& worst = summary[{ Text("%5.2f", slab.is.g), slab.is.light, answer.method }];
  worst.good = worst.good && error <= slab.Goal();
  worst.seconds += answer.seconds;
  ++worst.count;
  if (!(error <= worst.error))
  {
    worst.error = error;
    worst.name = "tau " + Text("%g", slab.is.tau) + ", albedo " + Text("%g", slab.is.albedo);
  }
}

/// Answers of other people's programs, by slab. What disortpp says is the reference where there is none.
std::vector<std::vector<Answer>> PeersOf(std::vector<Slab>& slabs)
{
  std::vector<PeerCase> cases;
  std::transform(slabs.begin(), slabs.end(), std::back_inserter(cases), [](const Slab& slab) { return slab.is; });
  std::vector<std::vector<Answer>> answers(slabs.size());
  for (const PeerAnswer& peer : AskPeers(cases))
  {
    const Powers is = { peer.reflectance, peer.transmittance };
    answers[peer.number].push_back({ peer.program, 0, 0, peer.seconds, NAN, is });
    Slab& slab = slabs[peer.number];
    if (!slab.reference && peer.program.rfind(slab.source, 0) == 0)
    {
      slab.reference = is;
    }
  }
  return answers;
}
}

void PrintForwardSlabs(Device& device, bool quick)
{
  std::vector<Slab> slabs = Slabs(quick);
  const std::vector<std::vector<Answer>> peers =
    quick ? std::vector<std::vector<Answer>>(slabs.size()) : PeersOf(slabs);
  Summary summary;
  for (const int degree : { -1, 0 })
  {
    Solve(device, slabs.front(), degree); // compiles
  }
  for (std::size_t i = 0; i < slabs.size(); ++i)
  {
    if (!slabs[i].reference)
    {
      continue;
    }
    for (const int degree : { -1, 0 })
    {
      Compare(slabs[i], Solve(device, slabs[i], degree), summary);
    }
    for (const Answer& answer : peers[i])
    {
      Compare(slabs[i], answer, summary);
    }
  }
  Table table({ "g", "light", "method", "worst error", "of slab", "all good", "mean s" });
  for (const auto& [key, worst] : summary)
  {
    table.Add({ key[0], key[1], key[2], Text("%.5f", worst.error), worst.name, worst.good ? "yes" : "no",
      Text("%.2g", worst.seconds / worst.count) });
  }
  table.Print(
    "Slabs that scatter forwards, 1x1xN voxels, N = 32 to 4096 with optical thickness of at most 0.1 each (tau 1000:\n"
    "0.24), settings by default: the largest error of reflectance and transmittance, tau 0.1 to 1000, albedo 0.5 to 1\n"
    "against adding-doubling (g 0.75: disortpp); good is 0.003, and 0.002 of tau 10, albedo 1, g 0.9");
}
}
