#include "StressFilters.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkMediumRayCaster.h"
#include "vtkMeshVoxelizer.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"

#include <algorithm>
#include <cmath>

namespace bench
{
namespace
{
constexpr double ManyScatterings = 300.0; ///< of a photon: from here on there are fewer photons
constexpr double MostScatterings = 1e5;

using Family = StressFamily;

/// An option of one class of filters; others of a chain do not know it.
template <class Filter, class Act>
std::function<void(vtkAlgorithm*)> With(Act act)
{
  return [act](vtkAlgorithm* algorithm) {
    if (auto* const filter = Filter::SafeDownCast(algorithm))
    {
      act(filter);
    }
  };
}

void Nothing(vtkAlgorithm*) {}

/// Rows of the solvers on grids and of photons, each with options of its own.
std::vector<StressSolver> OwnRows()
{
  using Maps = vtkLightPropagationMaps;
  using Ordinates = vtkDiscreteOrdinates;
  using Lattice = vtkLatticeBoltzmannLighting;
  using Emitter = vtkPhotonEmitter;
  using Marcher = vtkPhotonMarcher;
  using Rebuilder = vtkPhotonReconstruction;
  return {
    { "maps", Family::Maps },
    { "maps, all", Family::Maps, 0, With<Maps>([](auto* maps) { maps->SetLeaveOut(false); }), "maps" },
    { "maps, moments", Family::Maps, Moments },
    { "maps, orders", Family::Maps, ByOrders },
    { "maps, linear", Family::Maps, 0, With<Maps>([](auto* maps) { maps->SetSource(Maps::LINEAR); }) },
    { "maps, octants", Family::Maps, 0, With<Maps>([](auto* maps) { maps->SetSource(Maps::OCTANTS); }) },
    { "maps, staggered", Family::Maps, 0, With<Maps>([](auto* maps) { maps->SetStaggeredRays(true); }) },
    { "maps, fine", Family::Maps, 0, With<Maps>([](auto* maps) { maps->SetQuality(Maps::FINE); }) },
    { "maps, target", Family::Maps, OwnTolerance, With<Maps>([](auto* maps) { maps->SetTargetError(0.05); }) },
    { "maps, parallel", Family::Maps, Published },
    { "maps, sequential", Family::Maps, Published,
      With<Maps>([](auto* maps) { maps->SetAlgorithm(Maps::SEQUENTIAL); }) },
    { "steps", Family::Steps, Published, Nothing, "maps, parallel" },
    { "ordinates", Family::Ordinates, ByOrders },
    { "ordinates, accelerated", Family::Ordinates },
    { "ordinates, accelerated, all", Family::Ordinates, 0, With<Ordinates>([](auto* all) { all->SetLeaveOut(false); }),
      "ordinates, accelerated" },
    { "ordinates, all", Family::Ordinates, ByOrders, With<Ordinates>([](auto* all) { all->SetLeaveOut(false); }),
      "ordinates" },
    { "ordinates, target", Family::Ordinates, OwnTolerance,
      With<Ordinates>([](auto* ordinates) { ordinates->SetTargetError(0.05); }) },
    { "ordinates, matrix", Family::Ordinates, ByOrders,
      With<Ordinates>([](auto* matrix) { matrix->SetScattering(Ordinates::MATRIX); }) },
    { "ordinates, spiral", Family::Ordinates, ByOrders | Unturned,
      With<Ordinates>([](auto* spiral) { spiral->SetSpiralDirections(150); }) },
    { "ordinates, published", Family::Ordinates, Published | Unturned,
      With<Ordinates>([](auto* own) { own->SetScattering(Ordinates::SINGULAR_VALUES); }) },
    { "lattice", Family::Lattice },
    { "lattice, all", Family::Lattice, 0, With<Lattice>([](auto* all) { all->SetLeaveOut(false); }), "lattice" },
    { "lattice of 6", Family::Lattice, SixLinks },
    { "lattice, steps", Family::Lattice, ByOrders },
    { "lattice, blocks", Family::Lattice, ByOrders | Unturned,
      With<Lattice>([](auto* blocks) { blocks->SetBlockSize(4); }) },
    { "lattice, interleaved", Family::Lattice, ByOrders | OfPhotons,
      With<Lattice>([](auto* turns) { turns->SetInterleaved(true); }) },
    { "lattice, published", Family::Lattice, Published },
    { "photons", Family::Photons },
    { "photons, all orders", Family::Photons, Scattered },
    { "photons, errors", Family::Photons, Scattered, With<Marcher>([](auto* marcher) { marcher->SetErrorBatches(8); }),
      "photons, all orders" },
    { "photons, all", Family::Photons, 0, With<Marcher>([](auto* marcher) { marcher->SetLeaveOut(false); }),
      "photons" },
    { "photons, Yoshida", Family::Photons, 0, With<Marcher>([](auto* marcher) { marcher->SetIntegratorOrder(4); }) },
    { "photons, bricks", Family::Photons, 0,
      With<Marcher>([](auto* marcher) { marcher->SetEmptySpace(Marcher::BY_BRICK); }) },
    { "photons, published", Family::Photons, Published },
    { "rebuilt", Family::Rebuilt },
    { "rebuilt, all", Family::Rebuilt, 0, With<Rebuilder>([](auto* all) { all->SetLeaveOut(false); }), "rebuilt" },
    { "rebuilt, published", Family::Rebuilt, Published },
    { "rebuilt, nearest", Family::Rebuilt, 0,
      With<Rebuilder>([](auto* nearest) { nearest->SetScheme(Rebuilder::NEAREST_PHOTONS); }) },
    { "octree", Family::Octree },
    { "octree, all", Family::Octree, 0, With<vtkRefractionOctree>([](auto* all) { all->SetLeaveOut(false); }),
      "octree" },
    { "emitter", Family::Emission },
    { "emitter, random", Family::Emission, AtRandom,
      With<Emitter>([](auto* emitter) { emitter->SetSampler(Emitter::RANDOM); }) },
    { "emitter, importance", Family::Emission, ByImportance },
    { "importance", Family::Importance },
  };
}

/// Rows of meshes and pictures.
std::vector<StressSolver> MeshAndViewRows()
{
  using Mesh = vtkMeshVoxelizer;
  using View = vtkMediumRayCaster;
  const auto glass = With<View>([](auto* view) {
    view->SetSurfaceReflection(View::FIXED);
    view->SetSurfaceReflectance(0.3);
  });
  return {
    { "mesh", Family::Mesh },
    { "mesh, fine", Family::Mesh, 0, With<Mesh>([](auto* mesh) { mesh->SetSupersamplingFactor(8); }) },
    { "mesh, noise", Family::Mesh, Noisy, With<Mesh>([](auto* mesh) { mesh->SetIndexNoise(0.1); }) },
    { "view", Family::View },
    { "view, all", Family::View, 0, With<View>([](auto* view) { view->SetLeaveOut(false); }), "view" },
    { "view, estimate", Family::View, 0, With<View>([](auto* view) { view->SetEstimateError(true); }), "view" },
    { "view, draft", Family::View, 0, With<View>([](auto* view) { view->SetQuality(View::DRAFT); }) },
    { "view, fine", Family::View, 0, With<View>([](auto* view) { view->SetQuality(View::FINE); }) },
    { "view, shadow rays", Family::View, 0, With<View>([](auto* view) { view->SetShadowRays(true); }) },
    { "view, bent", Family::View, Bent },
    { "view, surface", Family::View, Bent | Reflecting, glass },
  };
}

/// Options that all solvers on grids have, runs on ranks and on devices that are taken as GPUs.
void AddSharedRows(std::vector<StressSolver>& rows)
{
  using Solver = vtkScatteringSolver;
  const auto estimate = With<Solver>([](auto* solver) { solver->SetEstimateError(true); });
  for (const auto& [name, family, traits] : { std::tuple("maps", Family::Maps, 0u),
         std::tuple("ordinates", Family::Ordinates, unsigned(ByOrders)), std::tuple("lattice", Family::Lattice, 0u) })
  {
    const std::string solver = name;
    rows.push_back({ solver + ", given light", family, traits | OfPhotons, Nothing, "" });
    rows.push_back({ solver + ", reflecting", family, traits | Reflecting, Nothing, "" });
    rows.push_back({ solver + ", preview", family, traits | Preview, Nothing, "" });
    rows.push_back({ solver + ", estimate", family, traits, estimate, solver });
  }
  rows.push_back(
    { "maps, warm", Family::Maps, Warm, With<vtkLightPropagationMaps>([](auto* s) { s->SetWarmStart(true); }) });
  rows.push_back({ "ordinates, warm", Family::Ordinates, ByOrders | Warm,
    With<vtkDiscreteOrdinates>([](auto* s) { s->SetWarmStart(true); }) });
  const std::vector<StressSolver> serial = rows;
  const auto isOneOf = [](const std::string& name, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* one) { return name == one; });
  };
  for (StressSolver row : serial)
  {
    if (isOneOf(row.name,
          { "maps", "maps, moments", "ordinates", "ordinates, accelerated", "lattice", "lattice of 6", "photons",
            "photons, all orders" }))
    {
      row.like = row.name;
      row.name += ", 3 ranks";
      row.traits |= Ranks;
      rows.push_back(row);
    }
  }
  for (StressSolver row : serial)
  {
    if (isOneOf(row.name,
          { "maps", "maps, moments", "maps, parallel", "steps", "ordinates", "ordinates, published", "lattice",
            "lattice, blocks", "photons", "photons, all orders", "rebuilt", "octree", "importance", "mesh", "view",
            "view, bent" }))
    {
      row.like.clear();
      row.name += ", as a GPU";
      row.traits |= AsGpu;
      rows.push_back(row);
    }
  }
}
}

const std::vector<StressSolver>& StressSolvers()
{
  static const std::vector<StressSolver> rows = [] {
    std::vector<StressSolver> made = OwnRows();
    const std::vector<StressSolver> more = MeshAndViewRows();
    made.insert(made.end(), more.begin(), more.end());
    AddSharedRows(made);
    for (StressSolver& row : made)
    {
      row.set = row.set ? row.set : Nothing;
    }
    return made;
  }();
  return rows;
}

/// How often a photon is scattered, about, until it is absorbed or has left: as often as its mean way through the box
/// has mean free paths, or the square of the box or the thickest voxel if it begins inside.
double ScatteringsOf(const StressScene& scene)
{
  double scatters = 0.0, removes = 0.0, thickest = 0.0, area = 0.0, longest = 0.0, edge = 0.0;
  for (std::size_t i = 0; i < scene.VoxelCount() * static_cast<std::size_t>(scene.channels); ++i)
  {
    const double one = scene.scattering.empty() ? 0.0 : scene.scattering[i];
    scatters += one;
    thickest = std::max(thickest, one);
    removes += one + (scene.absorption.empty() ? 0.0 : scene.absorption[i]);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    area += 2.0 * scene.cells[a] * scene.spacing[a] * scene.cells[b] * scene.spacing[b];
    longest = std::max(longest, scene.cells[axis] * scene.spacing[axis]);
    edge = std::max(edge, scene.spacing[axis]);
  }
  const double mean = scatters / static_cast<double>(scene.VoxelCount() * static_cast<std::size_t>(scene.channels));
  const double volume = static_cast<double>(scene.VoxelCount()) * scene.VoxelVolume();
  const bool inside =
    std::any_of(scene.lamps.begin(), scene.lamps.end(), [](const Lamp& lamp) { return lamp.kind != Lamp::Sun; });
  const double across = std::max(mean * longest, 0.5 * thickest * edge);
  const double way = inside ? across * std::max(1.0, across) : mean * 4.0 * volume / area;
  return scatters > 0.0 ? std::min(way, removes / std::max(removes - scatters, 1e-30)) : 0.0;
}

namespace
{
/// A solver's own scattering is seen in media with mean cosines: all of those by the plain rows, some by the others.
bool ConcernsForward(const StressSolver& row, const StressCase& stressCase)
{
  const bool similar = row.name == "maps" && stressCase.scene.g == 0.5; // scattering by the similarity relation
  const bool plain = row.name == "maps, moments" || row.name == "ordinates" || similar;
  return plain || (stressCase.quick && (row.Is(Moments) || row.family == Family::Ordinates));
}

bool ConcernsView(const StressSolver& row, const StressCase& stressCase)
{
  const StressScene& scene = stressCase.scene;
  const bool thin = *std::min_element(scene.cells.begin(), scene.cells.end()) < 3; // no room for a ball of glass
  return !(thin && row.Is(Bent)) &&
    (stressCase.furnace > 0.0 || !scene.index.empty() || scene.g != 0.0 || stressCase.row == "colours 1e6 apart" ||
      stressCase.row == "hot voxel in vacuum" || (stressCase.row == "power" && !scene.emission.empty()));
}
}

std::size_t PhotonsFor(const StressSolver& solver, const StressScene& scene)
{
  const double many = solver.Is(Scattered) ? std::max(1.0, ScatteringsOf(scene) / ManyScatterings) : 1.0;
  return std::max<std::size_t>(100, static_cast<std::size_t>(StressPhotons / many));
}

namespace
{
/// Thickest voxel along its shortest edge, mean free paths.
/// @param cosine  mean cosine of scattering, for what is solved by the similarity relation
double ThickestOf(const StressScene& scene, double cosine = 0.0)
{
  double thickest = 0.0;
  for (std::size_t i = 0; i < scene.absorption.size(); ++i)
  {
    const double scatters = scene.scattering.empty() ? 0.0 : (1.0 - cosine) * scene.scattering[i];
    thickest = std::max(thickest, scatters + scene.absorption[i]);
  }
  return thickest * *std::min_element(scene.spacing.begin(), scene.spacing.end());
}
}

bool Concerns(const StressSolver& row, const StressCase& stressCase)
{
  const StressScene& scene = stressCase.scene;
  const bool wraps = scene.periodic[0] || scene.periodic[1] || scene.periodic[2];
  const bool shone = (!scene.lamps.empty() || scene.sky != Vector{}) && !wraps && // by what makes photons
    scene.faces == std::array<double, 6>{};
  if (row.Is(Scattered))
  {
    return shone && ScatteringsOf(scene) <= MostScatterings;
  }
  const double thickest = ThickestOf(scene, row.IsOfLattice() ? std::min(scene.g, 0.0) : 0.0);
  if (row.Is(Published) && (row.family == Family::Ordinates || row.IsOfLattice()) && !(thickest < 1.0))
  {
    return false; // steps as published are not stable there, and say so
  }
  if (row.IsPhotons() || row.Is(OfPhotons) || row.family == Family::Emission || row.family == Family::Importance)
  {
    return shone && !stressCase.forward;
  }
  if (stressCase.forward || row.Is(Moments))
  {
    return stressCase.forward && ConcernsForward(row, stressCase);
  }
  if (row.family == Family::Mesh)
  {
    return scene.lamps.size() == 1 && scene.index.empty() && scene.channels == 1;
  }
  return row.IsView() ? ConcernsView(row, stressCase) : !(wraps && row.family == Family::Steps);
}

StressCase CaseFor(const StressSolver& row, StressCase asked)
{
  if (row.Is(Reflecting) && row.IsGrid())
  {
    asked.scene = ShoneUpon(asked.scene, 1.0 - StressAlbedo);
    for (std::shared_ptr<StressScene>* scene : { &asked.twin, &asked.rest })
    {
      if (*scene)
      {
        *scene = std::make_shared<StressScene>(ShoneUpon(**scene, 1.0 - StressAlbedo));
      }
    }
  }
  if (row.Is(Reflecting | OfPhotons | Preview))
  {
    asked.beam = false;
    asked.pathInBox = 0.0;
    asked.transmitted = -1.0;
  }
  if (row.Is(OfPhotons | Preview))
  {
    asked.middle = 0.0;
    asked.mirrored = {};
    asked.bound = std::numeric_limits<double>::infinity();
  }
  if (row.Is(Unturned))
  {
    asked.mirrored = {};
  }
  if (row.IsOfLattice() && row.Is(ByOrders)) // which need not be steady
  {
    asked.furnace = asked.middle = 0.0;
    asked.transmitted = -1.0;
    asked.mirrored = {};
  }
  // What goes along a periodic axis through nothing never ends, and nothing enters along it (limits.md).
  const std::array<bool, 3>& periodic = asked.scene.periodic;
  if (row.IsOfLattice() && (periodic[0] || periodic[1] || periodic[2]) && ThickestOf(asked.scene) == 0.0)
  {
    asked.furnace = 0.0;
  }
  if (row.Is(Published) && asked.row.compare(0, 8, "far lamp") == 0) // whose lamps are suns alone
  {
    asked.twin.reset();
  }
  if (row.Is(OfPhotons))
  {
    asked.furnace = 0.0;
    if (asked.similarity || asked.twinChannel >= 0 || asked.rest)
    {
      asked.twin.reset();
    }
  }
  return asked;
}
}
