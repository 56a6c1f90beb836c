#include "StressChecks.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bench
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// The quantities of `energy_balance`.
enum Balance
{
  Entered,
  Emitted,
  Absorbed,
  Escaped,
  LeftOver
};

/// One solver's light in one scene, channel by channel.
class LightChecks
{
public:
  LightChecks(
    const StressSolver& solver, const StressCase& stressCase, const StressOutcome& outcome, const StressOutcome* twin)
    : Solver(solver)
    , Case(stressCase)
    , Scene(stressCase.scene)
    , Outcome(outcome)
    , Twin(twin)
    , Published(solver.Is(bench::Published))
    , Rebuilt(solver.family == StressFamily::Rebuilt)
  {
  }

  std::vector<StressCheck> All()
  {
    this->Numbers();
    if (this->Rebuilt)
    {
      this->Conserves();
    }
    else if (!this->Solver.Is(Preview) && this->Solver.family != StressFamily::Steps)
    {
      this->Energy();
    }
    if (this->Solver.IsGrid() && !this->Published)
    {
      this->Bounds();
      this->Exact();
    }
    if (this->Case.beam && !this->Published && !this->Rebuilt)
    {
      this->Beam();
    }
    if (this->Twin && this->TwinHolds())
    {
      this->SameAsTwin();
    }
    if (this->Solver.family == StressFamily::Octree)
    {
      this->Levels();
    }
    return std::move(this->Found);
  }

  std::vector<StressCheck> OfPhotons()
  {
    this->Found = this->Outcome.checks;
    this->Entering();
    return std::move(this->Found);
  }

private:
  void Add(const char* name, double value, double atMost) { this->Found.push_back({ name, value, atMost }); }

  double Fact(Balance which, int c) const
  {
    const std::size_t i = static_cast<std::size_t>(which * this->Outcome.channels + c);
    return i < this->Outcome.balance.size() ? this->Outcome.balance[i] : std::nan("");
  }
  double In(int c) const { return this->Fact(Entered, c) + this->Fact(Emitted, c); }

  double Largest(const std::vector<float>& values) const
  {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  }

  /// The worst channel of what `deviation` finds; 0 in the dark.
  double Worst(const std::function<double(int)>& deviation) const
  {
    double worst = 0.0;
    for (int c = 0; c < this->Outcome.channels; ++c)
    {
      const double one = this->In(c) == 0.0 ? 0.0 : deviation(c);
      worst = one <= worst ? worst : one; // NaN stays
    }
    return worst;
  }

  double Sum(const std::function<double(std::size_t)>& ofVoxel) const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < this->Scene.VoxelCount(); ++i)
    {
      sum += ofVoxel(i);
    }
    return sum;
  }
  double Fluence(std::size_t voxel, int c) const { return this->Outcome.fluence[voxel * this->Outcome.channels + c]; }
  int SceneChannel(int c) const { return std::min(c, this->Scene.channels - 1); }

  /// Nothing negative, nothing that is not a number.
  void Numbers()
  {
    const StressOutcome& o = this->Outcome;
    auto bad = static_cast<std::ptrdiff_t>(o.fluence.size() == this->Scene.VoxelCount() * o.channels ? 0 : 1);
    for (const std::vector<float>* field : { &o.fluence, &o.fluenceDirect, &o.fluenceError })
    {
      bad += std::count_if(field->begin(), field->end(), [](float x) { return !(x >= 0.0f && std::isfinite(x)); });
    }
    this->Add("bad_fluence", static_cast<double>(bad), 0.0);
    bad = 0;
    for (const std::vector<float>* field : { &o.netFlux, &o.directions })
    {
      bad += std::count_if(field->begin(), field->end(), [](float x) { return !std::isfinite(x); });
    }
    this->Add("bad_directions", static_cast<double>(bad), 0.0);
    bad = 0;
    // What lattices leave over, and iterations that begin warm or between faces that reflect, and what photons win or
    // lose by chance, is a difference: in Energy().
    const bool differs = this->Solver.IsOfLattice() || this->Solver.Is(Scattered | Warm | Reflecting | Preview);
    const auto signless =
      static_cast<std::ptrdiff_t>(differs ? static_cast<std::size_t>(LeftOver * o.channels) : o.balance.size());
    for (const auto& [begin, end] :
      { std::pair(o.balance.begin(), o.balance.begin() + std::min<std::ptrdiff_t>(signless, o.balance.size())),
        std::pair(o.facePowerOut.begin(), o.facePowerOut.end()) })
    {
      bad += std::count_if(begin, end, [](double x) { return !(x >= 0.0 && std::isfinite(x)); });
    }
    this->Add("bad_powers", static_cast<double>(bad), 0.0);
    double excess = 0.0;
    for (std::size_t i = 0; i < std::min(o.fluenceDirect.size(), o.fluence.size()); ++i)
    {
      excess = std::max(excess, static_cast<double>(o.fluenceDirect[i]) - o.fluence[i]);
    }
    this->Add("direct_above_all", excess == 0.0 ? 0.0 : excess / this->Largest(o.fluence), 1e-4);
  }

  /// Part of diffuse light through a face that a lattice lets in: of six links one, where it were a fourth; of eighteen
  /// all but half of each diagonal one along the face's edges, which crosses two faces at a time (numerics.md, 10 c).
  /// @param a, b  axes along the face
  double CarriedByLinks(int a, int b) const
  {
    const auto edges = [this](int axis) { return this->Scene.periodic[axis] ? 0.0 : 1.0 / this->Scene.cells[axis]; };
    return !this->Solver.IsOfLattice() || this->Solver.Is(bench::OfPhotons) ? 1.0
      : this->Solver.Is(SixLinks)                                           ? 2.0 / 3.0
                                                                            : 1.0 - (edges(a) + edges(b)) / 6.0;
  }

  /// Power that shines on the box, by the scene alone.
  /// Sky and faces by what the directions carry of them.
  double Shining(int c) const
  {
    const bool own = !this->Outcome.halfRangeFlux.empty() && !this->Solver.Is(bench::OfPhotons);
    const std::vector<double>& flux = this->Outcome.halfRangeFlux;
    const double carried = own ? flux[std::min<std::size_t>(c, flux.size() - 1)] : 1.0;
    const Vector& h = this->Scene.spacing;
    double area[3], power = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      area[axis] = this->Scene.cells[a] * h[a] * this->Scene.cells[b] * h[b];
      power += this->Scene.periodic[axis] ? 0.0
                                          : carried * this->CarriedByLinks(a, b) * Pi * area[axis] *
          (2.0 * this->Scene.sky[c] + this->Scene.faces[2 * axis] + this->Scene.faces[2 * axis + 1]);
    }
    for (const Lamp& lamp : this->Scene.lamps)
    {
      power += lamp.power[c] * (lamp.kind == Lamp::Sun ? area[2] : this->Case.lampsInside);
    }
    return power;
  }

  /// Four standard errors of the part of a spot's random photons that get into the box; other lamps aim at it.
  double ByChance() const
  {
    const double photons = static_cast<double>(PhotonsFor(this->Solver, this->Scene));
    const std::vector<Lamp>& lamps = this->Scene.lamps;
    return this->Solver.Is(AtRandom) && !lamps.empty() && lamps[0].kind == Lamp::Spot
      ? 4.0 * std::sqrt(std::max(0.0, 1.0 - this->Case.lampsInside) / photons)
      : 0.0;
  }

  void Entering()
  {
    if (this->Case.lampsInside < 0.0 || (this->Solver.Is(bench::OfPhotons) && !this->Outcome.warnings.empty()))
    {
      return; // not known, or photons have said that floats do not hold their light
    }
    // Lamps outside the box are seen by beams, and photons come by chance.
    const bool exact = this->Solver.IsGrid() && !this->Solver.Is(bench::OfPhotons | Unturned) &&
      std::all_of(
        this->Scene.lamps.begin(), this->Scene.lamps.end(), [](const Lamp& lamp) { return lamp.kind == Lamp::Sun; });
    this->Add("entered", this->Worst([&](int c) {
      return this->Shining(c) == 0.0 ? 0.0 : std::abs(this->Fact(Entered, c) / this->Shining(c) - 1.0);
    }),
      !exact                         ? std::max(1e-3, this->ByChance())
        : this->Solver.IsOfLattice() ? 1e-5 // of light that is handed over
                                     : 1e-6);
  }

  void Energy()
  {
    const bool photons = this->Solver.IsPhotons();
    const auto imbalance = [&](int c) {
      return (this->Fact(Absorbed, c) + this->Fact(Escaped, c) + this->Fact(LeftOver, c)) / this->In(c) - 1.0;
    };
    if (this->Published && this->Solver.family != StressFamily::Maps && !this->Solver.IsPhotons())
    {
      return; // explicit steps promise no more than to be stable
    }
    if (this->Published)
    {
      // The published deposit knows of scattering only: of what a voxel shines itself up to a quarter more is absorbed
      // and escapes.
      const double made = this->Scene.emission.empty() ? 1e-3 : 0.3;
      this->Add("energy_made", this->Solver.IsPhotons() ? 0.0 : this->Worst(imbalance), made);
      return;
    }
    this->Add("balance", this->Worst([&](int c) { return std::abs(imbalance(c)); }), 1e-4);
    if (this->Solver.EndsByTolerance())
    {
      this->Add("left_below_0", this->Worst([&](int c) { return -this->Fact(LeftOver, c) / this->In(c); }), 1e-4);
    }
    this->Entering();
    if (!photons && !this->Scene.emission.empty())
    {
      this->Add("emitted", this->Worst([&](int c) {
        const double emitted = 4.0 * Pi * this->Scene.VoxelVolume() *
          this->Sum([&](std::size_t i) { return this->Scene.At(this->Scene.emission, i, this->SceneChannel(c)); });
        return std::abs(this->Fact(Emitted, c) - emitted) / this->In(c);
      }),
        1e-4);
    }
    this->Add("escaped_by_faces", this->Worst([&](int c) {
      double out = 0.0;
      for (std::size_t i = c; i < this->Outcome.facePowerOut.size(); i += this->Outcome.channels)
      {
        out += this->Outcome.facePowerOut[i];
      }
      return std::abs(out - this->Fact(Escaped, c)) / this->In(c);
    }),
      1e-4);
    if (this->Solver.IsOfLattice() && !this->Solver.Is(ByOrders))
    {
      this->Add("left_over", this->Worst([&](int c) { return std::abs(this->Fact(LeftOver, c)) / this->In(c); }), 1e-4);
    }
    // Of photons that are followed to where they are first scattered, scattering takes away as well.
    const bool first = photons && !this->Solver.Is(Scattered);
    this->Add("absorbed_by_fluence", this->Worst([&](int c) {
      const int s = this->SceneChannel(c);
      const double lost = this->Scene.VoxelVolume() * this->Sum([&](std::size_t i) {
        const double sigma = static_cast<double>(this->Scene.At(this->Scene.absorption, i, s)) +
          (first ? this->Scene.At(this->Scene.scattering, i, s) : 0.0f);
        return sigma * this->Fluence(i, c);
      });
      return std::abs(lost - this->Fact(Absorbed, c)) / this->In(c);
    }),
      first || !photons ? 1e-3 : 0.02); // where they are scattered, both are found by chance
    if (photons)
    {
      this->Add("left_over",
        this->Outcome.warnings.empty() ? this->Worst([&](int c) { return this->Fact(LeftOver, c) / this->In(c); })
                                       : 0.0,
        0.01);
    }
  }

  void Conserves()
  {
    if (this->Published)
    {
      return;
    }
    double total = 0.0;
    for (const float fluence : this->Outcome.fluence)
    {
      total += fluence;
    }
    this->Add(
      "total_kept", this->Outcome.rawTotal == 0.0 ? total : std::abs(total / this->Outcome.rawTotal - 1.0), 1e-4);
  }

  void Bounds()
  {
    const std::vector<float>& fluence = this->Outcome.fluence;
    const std::vector<float>& flux = this->Outcome.netFlux;
    double excess = 0.0;
    for (std::size_t i = 0; 3 * i + 2 < flux.size() && i < fluence.size(); ++i)
    {
      excess = std::max<double>(excess, std::hypot(flux[3 * i], flux[3 * i + 1], flux[3 * i + 2]) - fluence[i]);
    }
    // A lattice's diagonal links are longer than those along axes, and all are gone in one step.
    const double longest = this->Solver.IsOfLattice() && !this->Solver.Is(SixLinks) ? std::sqrt(2.0) - 1.0 : 0.0;
    this->Add("flux_above_fluence", excess == 0.0 ? 0.0 : excess / this->Largest(fluence), longest + 1e-3);
    if (std::isfinite(this->Case.bound))
    {
      this->Add("above_bound", this->Largest(fluence) / (4.0 * Pi * this->Case.bound) - 1.0, 1e-3);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      if (this->Case.mirrored[axis])
      {
        this->Add(std::string("faces_" + std::string(1, "xyz"[axis])).c_str(), this->FaceAsymmetry(axis), 0.01);
        // Rays from small bright parts start in other places on the other side: 0.24% of the largest fluence was
        // measured.
        const double limit = this->Scene.emission.empty() ? 1e-3 : 5e-3;
        this->Add(std::string("mirrored_" + std::string(1, "xyz"[axis])).c_str(), this->Asymmetry(axis), limit);
      }
    }
    if (!this->Solver.Is(ByOrders | OwnTolerance | Preview))
    {
      this->Add("residual_by_tolerance", this->Outcome.warnings.empty() ? this->Outcome.residual : 0.0, 1.0);
    }
  }

  /// Of the power out through the two faces across an axis, in parts of what came in.
  double FaceAsymmetry(int axis) const
  {
    const std::size_t low = static_cast<std::size_t>(2 * axis * this->Outcome.channels);
    const std::vector<double>& out = this->Outcome.facePowerOut;
    return this->Worst(
      [&](int c) { return std::abs(out[low + c] - out[low + this->Outcome.channels + c]) / this->In(c); });
  }

  double Asymmetry(int axis) const
  {
    double worst = 0.0;
    const std::array<int, 3>& n = this->Scene.cells;
    for (int k = 0; k < n[2]; ++k)
    {
      for (int j = 0; j < n[1]; ++j)
      {
        for (int i = 0; i < n[0]; ++i)
        {
          std::array<int, 3> other = { i, j, k };
          other[axis] = n[axis] - 1 - other[axis];
          worst = std::max(worst,
            std::abs(this->Fluence(this->Scene.Voxel(i, j, k), 0) -
              this->Fluence(this->Scene.Voxel(other[0], other[1], other[2]), 0)));
        }
      }
    }
    return worst == 0.0 ? 0.0 : worst / this->Largest(this->Outcome.fluence);
  }

  /// What is known exactly. Orders that are not all done do not tell.
  void Exact()
  {
    const double left = this->Worst([&](int c) { return this->Fact(LeftOver, c) / this->In(c); });
    if (this->Solver.Is(ByOrders) && !(left < 1e-5))
    {
      return;
    }
    if (this->Case.furnace > 0.0)
    {
      double worst = 0.0;
      for (const float fluence : this->Outcome.fluence)
      {
        worst = std::max(worst, std::abs(fluence / (4.0 * Pi * this->Case.furnace) - 1.0));
      }
      // what a preview's tolerance and a target ask for
      this->Add("furnace", worst, this->Solver.Is(Preview) ? 0.1 : this->Solver.Is(OwnTolerance) ? 0.05 : 1e-3);
    }
    if (this->Case.middle > 0.0)
    {
      const std::array<int, 3>& n = this->Scene.cells;
      const double fluence = this->Fluence(this->Scene.Voxel(n[0] / 2, n[1] / 2, n[2] / 2), 0);
      // On 32 voxels it is within 2e-3 (LinearSource.OneShiningFaceIsASixthAtTheCentreOfACube); these few are a mean
      // free path each.
      this->Add("middle", std::abs(fluence / (4.0 * Pi * this->Case.middle) - 1.0), 5e-3);
    }
    const bool linear = !this->Solver.Is(ByOrders); // a constant source has no diffusion limit
    if (this->Case.transmitted >= 0.0 && linear)
    {
      const double part = this->Outcome.facePowerOut[5] / this->Fact(Entered, 0) * this->CarriedByLinks(0, 1);
      this->Add("transmitted", std::abs(part / this->Case.transmitted - 1.0), 0.02);
    }
    if (this->Case.pathInBox > 0.0 && !this->Solver.IsOfLattice()) // in vacuum diffusion knows no length
    {
      const double path =
        this->Scene.VoxelVolume() * this->Sum([&](std::size_t i) { return this->Fluence(i, 0); }) / this->In(0);
      // Upwind differences spread a beam aside, by first order in the voxel's edge: the published step loses 8.5% of
      // the way on 9 voxels, 3.1% on 27, 0.9% on 81 (limits.md).
      const bool upwind = this->Solver.family == StressFamily::Ordinates;
      this->Add("path_in_box", std::abs(path / this->Case.pathInBox - 1.0), upwind ? 0.1 : 0.03);
    }
  }

  /// A sun along -z through an absorber: means of exp(-tau) over voxels. Photons are spread within columns, and counted
  /// by layers.
  void Beam()
  {
    const bool photons = this->Solver.IsPhotons();
    const std::array<int, 3>& n = this->Scene.cells;
    std::vector<double> light(static_cast<std::size_t>(n[0] * n[1]), this->Scene.lamps[0].power[0]);
    std::vector<double> depth(light.size(), 0.0);
    const std::vector<float>& sigma = this->Scene.absorption;
    const bool even = std::all_of(sigma.begin(), sigma.end(), [&](float one) { return one == sigma[0]; });
    double worst = 0.0;
    for (int k = n[2] - 1; k >= 0; --k)
    {
      double layer = 0.0, foundLayer = 0.0, deepest = 0.0;
      for (std::size_t column = 0; column < light.size(); ++column)
      {
        const std::size_t voxel = static_cast<std::size_t>(k) * light.size() + column;
        const double tau = sigma[voxel] * this->Scene.spacing[2];
        const double mean = light[column] * (tau > 1e-12 ? -std::expm1(-tau) / tau : 1.0);
        const double found = this->Fluence(voxel, 0);
        if (!photons && (mean == 0.0 || mean > 1e-25))
        {
          const double error = mean == 0.0 ? found : std::abs(found / mean - 1.0) / (1.0 + depth[column]);
          worst = error <= worst ? worst : error;
        }
        layer += mean;
        foundLayer += found;
        light[column] *= std::exp(-tau);
        depth[column] += tau;
        deepest = std::max(deepest, depth[column]);
      }
      // Their fixed point ends some ten decades below the brightest.
      if (photons && layer > 1e-6 * static_cast<double>(light.size()))
      {
        const double error = std::abs(foundLayer / layer - 1.0) / (1.0 + deepest);
        worst = error <= worst ? worst : error;
      }
    }
    this->Add("beam", worst, !photons ? 1e-4 : even ? 1e-3 : 0.05);
  }

  bool TwinHolds() const
  {
    const bool colours = this->Case.twinChannel >= 0;
    // As published photons lose some of their power by chance, and mean cosines are not solved by similarity. To
    // lattices it is what diffuses that is similar, not the light that comes to them.
    const bool similar = this->Solver.IsOfMaps() && !this->Published;
    const bool known =
      this->Case.similarity ? similar : !(this->Solver.IsPhotons() && this->Published && !this->Rebuilt);
    const bool adds =
      this->Solver.IsGrid() && !this->Published; // photons of a lamp among others are not those of it alone
    return known && (adds || !this->Case.rest) &&
      !(colours && (this->Rebuilt || this->Solver.family == StressFamily::Octree));
  }

  void SameAsTwin()
  {
    const int channel = std::max(this->Case.twinChannel, 0);
    const std::size_t channels = static_cast<std::size_t>(this->Twin->channels); // as published: always three
    double worst = this->Twin->fluence.size() == channels * this->Scene.VoxelCount() ? 0.0 : std::nan("");
    const double largest = std::max(this->Largest(this->Twin->fluence), 1e-30); // that of lamps as published is none
    for (std::size_t i = 0; i < this->Scene.VoxelCount() && worst == worst; ++i)
    {
      const double error =
        std::abs(this->Fluence(i, channel) / this->Case.scale - this->Twin->fluence[channels * i]) / largest;
      worst = error <= worst ? worst : error;
    }
    this->Add("as_its_twin", worst, 1e-3);
  }

  /// Nodes as RefractionOctree's documentation has them.
  void Levels()
  {
    const std::array<int, 3>& n = this->Scene.cells;
    double broken = this->Outcome.levels.size() == this->Scene.VoxelCount() ? 0.0 : 1.0;
    for (std::size_t i = 0; i < this->Outcome.levels.size() && !this->Scene.index.empty(); ++i)
    {
      const int at[3] = { static_cast<int>(i) % n[0], static_cast<int>(i) / n[0] % n[1],
        static_cast<int>(i) / (n[0] * n[1]) };
      const int edge = 1 << static_cast<int>(this->Outcome.levels[i]);
      float least = 1e30f, most = 0.0f;
      for (int z = at[2] / edge * edge; z < std::min(n[2], (at[2] / edge + 1) * edge); ++z)
      {
        for (int y = at[1] / edge * edge; y < std::min(n[1], (at[1] / edge + 1) * edge); ++y)
        {
          for (int x = at[0] / edge * edge; x < std::min(n[0], (at[0] / edge + 1) * edge); ++x)
          {
            least = std::min(least, this->Scene.index[this->Scene.Voxel(x, y, z)]);
            most = std::max(most, this->Scene.index[this->Scene.Voxel(x, y, z)]);
          }
        }
      }
      broken += most - least > 0.01f ? 1.0 : 0.0;
    }
    this->Add("broken_nodes", broken, 0.0);
    this->Add("no_nodes", this->Outcome.nodes > 0.0 ? 0.0 : 1.0, 0.0);
  }

  const StressSolver& Solver;
  const StressCase& Case;
  const StressScene& Scene;
  const StressOutcome& Outcome;
  const StressOutcome* Twin;
  bool Published, Rebuilt;
  std::vector<StressCheck> Found;
};

bool IsEven(const std::vector<float>& values)
{
  return std::all_of(values.begin(), values.end(), [&](float value) { return value == values[0]; });
}

std::vector<StressCheck> CheckView(const StressSolver& solver, const StressScene& scene, const StressOutcome& outcome)
{
  std::vector<StressCheck> found;
  double bad = outcome.radiance.empty() || outcome.through.empty() ? 1.0 : 0.0;
  for (const std::vector<float>* picture : { &outcome.radiance, &outcome.through, &outcome.alpha })
  {
    bad += std::count_if(picture->begin(), picture->end(), [](float x) { return !(x >= 0.0f && std::isfinite(x)); });
  }
  bad += std::count_if(outcome.alpha.begin(), outcome.alpha.end(), [](float alpha) { return alpha > 1.0f; });
  found.push_back({ "bad_numbers", bad, 0.0 });
  if (scene.emission == scene.absorption)
  {
    double worst = 0.0;
    for (const float radiance : outcome.radiance)
    {
      worst = std::max(worst, std::abs(radiance - 1.0));
    }
    // Steps of half a voxel do not resolve an index that steps from voxel to voxel.
    found.push_back({ "furnace", worst, scene.index.empty() ? 5e-3 : 0.02 });
  }
  if (!solver.Is(Reflecting) && IsEven(scene.absorption) && IsEven(scene.scattering) && scene.channels == 1 &&
    scene.index.empty() &&
    *std::max_element(scene.spacing.begin(), scene.spacing.end()) <= 2.0 *
        *std::min_element(scene.spacing.begin(), scene.spacing.end())) // or a soft ball of glass bends rays out of it
  {
    const double tau =
      (static_cast<double>(scene.absorption[0]) + scene.scattering[0]) * scene.cells[2] * scene.spacing[2];
    double mean = 0.0;
    for (const float radiance : outcome.through)
    {
      mean += radiance / static_cast<double>(outcome.through.size());
    }
    // Rays that bend are a little longer.
    found.push_back({ "through", std::abs(mean - std::exp(-tau)), 0.02 });
  }
  found.push_back({ "through_above_1",
    outcome.through.empty() ? 0.0 : *std::max_element(outcome.through.begin(), outcome.through.end()) - 1.0, 1e-3 });
  return found;
}
}

std::vector<StressCheck> CheckOutcome(
  const StressSolver& solver, const StressCase& stressCase, const StressOutcome& outcome, const StressOutcome* twin)
{
  return solver.IsView()                      ? CheckView(solver, stressCase.scene, outcome)
    : solver.family == StressFamily::Emission ? LightChecks(solver, stressCase, outcome, nullptr).OfPhotons()
    : solver.IsStage()                        ? outcome.checks
                                              : LightChecks(solver, stressCase, outcome, twin).All();
}

StressCheck CheckTurned(
  const StressCase& stressCase, const StressOutcome& outcome, const CubeTurn& turn, const StressOutcome& turned)
{
  const std::vector<float> expected = turn.Field(outcome.fluence, stressCase.scene.cells, outcome.channels);
  double worst = expected.size() == turned.fluence.size() ? 0.0 : std::nan(""), largest = 0.0;
  double squares = 0.0, all = 0.0;
  for (std::size_t i = 0; i < std::min(expected.size(), turned.fluence.size()); ++i)
  {
    const double error = std::abs(static_cast<double>(expected[i]) - turned.fluence[i]);
    worst = error <= worst ? worst : error;
    largest = std::max<double>(largest, expected[i]);
    squares += error * error;
    all += static_cast<double>(expected[i]) * expected[i];
  }
  // Where next to nothing gets into an opaque box, rounding of what shines on it is all that there is: the scale is
  // also that.
  const std::array<int, 3>& n = stressCase.scene.cells;
  const Vector& h = stressCase.scene.spacing;
  double surface = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    surface += 2.0 * n[a] * h[a] * n[b] * h[b];
  }
  largest = std::max(largest, outcome.balance.empty() ? 0.0 : outcome.balance[0] / surface);
  // Accelerated iterations end where rounding leads them, within the error that they tell: that is a root mean square.
  const double told = StressTightTolerance * (outcome.residual + turned.residual);
  const double error = told > 1e-5 ? std::sqrt(squares / std::max(all, 1e-300)) : worst / std::max(largest, 1e-300);
  return { "as_its_turned_self", worst == 0.0 ? 0.0 : error, std::max(1e-5, told) };
}

bool MayRefuse(const StressSolver& solver, const StressCase& stressCase, const std::string& error)
{
  const std::string& name = solver.name;
  const auto [least, most] = std::minmax_element(stressCase.scene.spacing.begin(), stressCase.scene.spacing.end());
  if (solver.IsOfLattice() && *least < *most && error.find("voxels have to be cubes") != std::string::npos)
  {
    return true;
  }
  const std::vector<float>& scattering = stressCase.scene.scattering;
  const double h = *least;
  const bool white = std::any_of(scattering.begin(), scattering.end(), [&](float sigma) { return h * sigma > 1e10; });
  if (solver.IsOfLattice() && white && error.find("the lattice's numbers hold up to 1e10") != std::string::npos)
  {
    return true;
  }
  if (solver.family == StressFamily::Ordinates && solver.Is(Published) && std::abs(stressCase.scene.g) > 0.9 &&
    error.find("where the phase function scatters no more than comes") != std::string::npos)
  {
    return true;
  }
  return std::any_of(stressCase.refusals.begin(), stressCase.refusals.end(), [&](const Refusal& refusal) {
    const bool ofPhotons = refusal.method == "photons" &&
      (solver.Is(OfPhotons) || solver.family == StressFamily::Emission || solver.family == StressFamily::Importance);
    return (ofPhotons || name.compare(0, refusal.method.size(), refusal.method) == 0) &&
      error.find(refusal.words) != std::string::npos;
  });
}
}
