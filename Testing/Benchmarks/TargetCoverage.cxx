#include "TargetCoverage.h"

#include "Measure.h"
#include "Report.h"
#include "TargetScenes.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesError.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Medium/BoxFaces.h"
#include "Medium/Coarsening.h"
#include "Viewing/PictureError.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

using namespace tyndall;

namespace bench
{
namespace
{
constexpr const char* PicturesName = "pictures";

/// A solver by its name, with or without an estimate of its error.
struct CoveredSolver
{
  std::string name;
  bool needsCubes;
  std::function<LightField(const SceneBlock& scene, bool estimate)> solve;
};

SceneBlock BlockOf(const TargetScene& scene)
{
  return { Domain(scene.medium.grid), scene.medium, scene.light };
}

std::vector<CoveredSolver> SolversOn(Device& device)
{
  const PropagationSolver maps = [&device](const SceneBlock& scene, const PropagationSettings& how, const Monitor&) {
    return SolveConservative(device, scene.domain, scene.medium, scene.illumination, how);
  };
  return { { "maps", false,
             [maps](const SceneBlock& scene, bool estimate) {
               return estimate ? SolveWithErrorEstimate(scene, {}, {}, maps) : maps(scene, {}, {});
             } },
    { "ordinates", false,
      [&device](const SceneBlock& scene, bool estimate) {
        return estimate ? EstimateOrdinates(device, scene, {})
                        : SolveDiscreteOrdinates(device, scene.domain, scene.medium, scene.illumination, {});
      } },
    { "lattice", true, [&device](const SceneBlock& scene, bool estimate) {
       LightField light =
         SolveLatticeBoltzmann(device, scene.domain, scene.medium, scene.index, scene.illumination, {});
       if (estimate)
       {
         EstimateDiffusionError(device, scene, {}, false, {}, light);
       }
       return light;
     } } };
}

/// Light propagation maps in voxels of half the edge, along many directions; forward peaks by moments of high degree.
LightField Exact(Device& device, const SceneBlock& scene)
{
  const DividedScene divided(scene, DividedScene::Halves(scene.domain.Whole(), {}));
  PropagationSettings settings;
  const bool forwards = !scene.medium.phase.IsIsotropic();
  settings.directionsPerFace = forwards ? 144 : 400;
  settings.uncollidedDirections = 1600;
  settings.angularDegree = forwards ? 9 : -1;
  settings.staggeredRays = true;
  settings.tolerance = 1e-5;
  settings.emissionError = 0.005;
  settings.storeMoments = true;
  LightField light = SolveConservative(device, divided.Scene().medium, divided.Scene().illumination, settings);
  divided.Undo(light);
  return light;
}

/// A picture of a scene lit by the maps, by the number of the scene from another side, as a field of pixels.
class CoveredPicture
{
public:
  CoveredPicture(Device& device, const TargetScene& scene, std::size_t number)
    : TheDevice(device)
    , Scene(scene)
    , Of(FrameGrid(
        scene.medium.grid, 4.0 / 3.0, 30.0, { std::cos(2.4 * number), std::sin(2.4 * number), std::sin(1.7 * number) }))
  {
    this->Settings.imageSize = { 160, 120 };
    PropagationSettings maps;
    maps.storeMoments = true;
    const PropagationSolver solve = [&device](const SceneBlock& block, const PropagationSettings& how, const Monitor&) {
      return SolveConservative(device, block.domain, block.medium, block.illumination, how);
    };
    this->Light = SolveWithErrorEstimate(BlockOf(scene), maps, {}, solve);
  }

  Grid Pixels() const
  {
    Grid pixels;
    pixels.size = { this->Settings.imageSize[0], this->Settings.imageSize[1], 1 };
    return pixels;
  }

  LightField Render(bool estimate) const
  {
    const SolvedLight light = this->Seen(this->Light);
    MediumRayCaster caster(this->TheDevice, this->Scene.medium, light, this->Scene.light, this->Settings);
    Picture picture = caster.Render(this->Of);
    if (estimate)
    {
      PictureErrorCasters(this->TheDevice, this->Scene.medium, light, this->Scene.light, this->Settings)
        .Estimate(picture, this->Of);
    }
    LightField pixels;
    pixels.channels = 3;
    pixels.fluence = OnMedium(picture, picture.radiance);
    pixels.fluenceError = OnMedium(picture, picture.error);
    pixels.relativeError = Norm(pixels.fluenceError) / Norm(pixels.fluence);
    return pixels;
  }

  /// The picture of the exact light in the scene's voxels, by steps of a twentieth of a voxel.
  std::vector<float> Exact(const LightField& exact) const
  {
    ViewSettings fine = this->Settings;
    fine.stepSize = 0.05;
    fine.minimumTransmittance = 0.0;
    MediumRayCaster caster(this->TheDevice, this->Scene.medium, this->Seen(exact), this->Scene.light, fine);
    const Picture picture = caster.Render(this->Of);
    return OnMedium(picture, picture.radiance);
  }

private:
  /// Values of the pixels in which there is a medium, 0 elsewhere.
  static std::vector<float> OnMedium(const Picture& picture, std::vector<float> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = picture.alpha[i / 3] > 0.0f ? values[i] : 0.0f;
    }
    return values;
  }

  static double Norm(const std::vector<float>& values)
  {
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
  }

  SolvedLight Seen(const LightField& light) const
  {
    const std::size_t voxels = this->Scene.medium.grid.VoxelCount();
    const auto field = [&](const std::vector<float>& values, std::size_t tuples) {
      return Field{ values.empty() ? nullptr : values.data(), static_cast<int>(values.size() / tuples) };
    };
    SolvedLight seen;
    seen.fluence = field(light.fluence, voxels);
    seen.fluenceDirect = field(light.fluenceDirect, voxels);
    seen.fluenceError = field(light.fluenceError, voxels);
    seen.surface = field(light.surfaceRadiance.empty() ? this->Light.surfaceRadiance : light.surfaceRadiance,
      BoxFaceCellCount(this->Scene.medium.grid));
    seen.scatteredMoments = field(light.scatteredMoments, voxels);
    seen.straightOn = field(light.straightOn, voxels);
    seen.surfaceError = field(light.surfaceError, BoxFaceCellCount(this->Scene.medium.grid));
    seen.errorLength = light.errorLength;
    seen.lampsApart = light.lampsApart;
    seen.faceRadiance = this->Scene.light.faces;
    return seen;
  }

  Device& TheDevice;
  const TargetScene& Scene;
  Camera Of;
  ViewSettings Settings;
  LightField Light;
};

/// What a scene says of an estimate.
struct Covered
{
  double error = 0.0, estimate = 0.0; ///< root mean squares, relative to that of fluence
  double within = 0.0;                ///< part of the blocks whose error is below twice the estimate
  double blocks = 0.0;
};

/// @param exact  of 1 or 3 channels, as the light; blocks without light do not count
Covered Compare(const LightField& light, const std::vector<float>& exact, const Grid& grid)
{
  std::vector<float> off(exact.size());
  double errors = 0.0, all = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    off[i] = light.fluence[i] - exact[i];
    errors += static_cast<double>(off[i]) * off[i];
    all += static_cast<double>(exact[i]) * exact[i];
  }
  const Coarsening blocks(grid);
  const std::vector<float> errorsOfBlocks = blocks.Average(off.data(), light.channels);
  const std::vector<float> estimates = blocks.Average(light.fluenceError.data(), light.channels);
  const std::vector<float> lit = blocks.Average(exact.data(), light.channels);
  double within = 0.0, counted = 0.0;
  for (std::size_t i = 0; i < estimates.size(); ++i)
  {
    counted += lit[i] > 0.0f ? 1.0 : 0.0;
    within += lit[i] > 0.0f && std::abs(errorsOfBlocks[i]) <= 2.0f * estimates[i] ? 1.0 : 0.0;
  }
  return { std::sqrt(errors / all), light.relativeError, within / counted, counted };
}

/// Sums over the scenes of one solver.
struct Totals
{
  std::vector<double> within, ratios;
  double blocks = 0.0, blocksWithin = 0.0, seconds = 0.0, secondsWith = 0.0;
};

double SecondsOf(const std::function<LightField()>& solve, LightField& light)
{
  solve(); // compiles
  const double start = WallSeconds();
  light = solve();
  return WallSeconds() - start;
}

/// @param solve  light or picture on `grid`, with or without an estimate of its error
void Measure(const std::string& name, const TargetScene& scene, const Grid& grid,
  const std::function<LightField(bool estimate)>& solve, const std::vector<float>& exact, Totals& totals)
{
  LightField light;
  const double plain = SecondsOf([&] { return solve(false); }, light);
  const double with = SecondsOf([&] { return solve(true); }, light);
  const Covered found = Compare(light, exact, grid);
  const std::array<int, 3>& size = grid.size;
  JsonLine()
    .Add("bench", "target")
    .Add("case", scene.name)
    .Add("method", "estimate of " + name)
    .Add("grid", std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]))
    .Add("seconds", plain)
    .Add("seconds_with_estimate", with)
    .Add("error_l2", found.error)
    .Add("estimate", found.estimate)
    .Add("ratio", found.estimate / found.error)
    .Add("within_two", found.within)
    .Print();
  totals.blocks += found.blocks;
  totals.blocksWithin += found.within * found.blocks;
  totals.within.push_back(found.within);
  totals.ratios.push_back(found.estimate / found.error);
  totals.seconds += plain;
  totals.secondsWith += with;
}

std::vector<std::string> RowOf(const std::string& name, const Totals& totals)
{
  const auto withinTwo = static_cast<double>(
    std::count_if(totals.ratios.begin(), totals.ratios.end(), [](double ratio) { return ratio > 0.5 && ratio < 2.0; }));
  return { name, std::to_string(totals.ratios.size()), Text("%.1f", 100.0 * totals.blocksWithin / totals.blocks),
    Text("%.0f", 100.0 * *std::min_element(totals.within.begin(), totals.within.end())),
    Text("%.2f", Median(totals.ratios)), Text("%.2f", *std::min_element(totals.ratios.begin(), totals.ratios.end())),
    Text("%.2f", *std::max_element(totals.ratios.begin(), totals.ratios.end())),
    Text("%.0f", 100.0 * withinTwo / totals.ratios.size()), Text("%.2f", totals.seconds),
    Text("%.2f", totals.secondsWith) };
}
}

void PrintCoverage(Device& device, bool quick, const std::string& only)
{
  const std::vector<TargetScene> scenes = CoverageScenes(false), cubes = CoverageScenes(true);
  const std::vector<CoveredSolver> solvers = SolversOn(device);
  std::vector<Totals> totals(solvers.size() + 1);
  for (std::size_t i = 0; i < scenes.size(); i += quick ? 8 : 1)
  {
    const LightField exact = Exact(device, BlockOf(scenes[i]));
    const bool areCubes = scenes[i].medium.grid.spacing == cubes[i].medium.grid.spacing;
    for (std::size_t k = 0; k < solvers.size(); ++k)
    {
      if (!only.empty() && only != solvers[k].name)
      {
        continue;
      }
      const bool other = solvers[k].needsCubes && !areCubes;
      const TargetScene& scene = other ? cubes[i] : scenes[i];
      const auto solve = [&](bool estimate) { return solvers[k].solve(BlockOf(scene), estimate); };
      Measure(solvers[k].name, scene, scene.medium.grid, solve,
        other ? Exact(device, BlockOf(scene)).fluence : exact.fluence, totals[k]);
    }
    if (only.empty() || only == PicturesName)
    {
      const CoveredPicture picture(device, scenes[i], i);
      const auto render = [&](bool estimate) { return picture.Render(estimate); };
      Measure(PicturesName, scenes[i], picture.Pixels(), render, picture.Exact(exact), totals.back());
    }
  }
  Table table({ "solver", "scenes", "blocks within two, %", "least by scene, %", "estimate/error, median", "least",
    "largest", "scenes within a factor of 2, %", "s", "s with estimate" });
  for (std::size_t k = 0; k < totals.size(); ++k)
  {
    if (!totals[k].ratios.empty())
    {
      table.Add(RowOf(k < solvers.size() ? solvers[k].name : PicturesName, totals[k]));
    }
  }
  table.Print("Coverage of estimated errors");
}
}
