#include "LightPropagation/Accuracy/PreviewLight.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Problem/SceneChecks.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Halves the number of voxels along each axis once, and again while the grid has more than PreviewVoxels voxels.
/// @param may  function that returns whether a grid may be halved
template <class May>
Grid Halved(Grid grid, const May& may)
{
  for (bool first = true; may(grid) && (first || grid.VoxelCount() > PreviewVoxels); first = false)
  {
    grid = Coarsening(grid).Coarse();
  }
  return grid;
}

std::string SizeOf(const Grid& grid)
{
  return std::to_string(grid.size[0]) + " x " + std::to_string(grid.size[1]) + " x " + std::to_string(grid.size[2]);
}

/// A decomposed scene on the coarse grid, gathered on the first rank that has fine voxels. Constructor and Spread() are
/// collective.
class SceneOnFirst
{
public:
  /// @param blocks  decomposition of the coarse grid; must outlive this object
  /// @param own  scene of this rank's coarse voxels, with values in the same fields on all ranks; not read on a rank
  ///   without coarse voxels
  /// @param fine  medium of this rank's subdomain, which provides the phase function of the domain
  SceneOnFirst(const CoarseBlocks& blocks, const SceneBlock& own, const Medium& fine);
  SceneOnFirst(const SceneOnFirst&) = delete;
  SceneOnFirst& operator=(const SceneOnFirst&) = delete;

  /// Whether this rank has the gathered scene.
  bool IsHere() const { return this->Here; }
  /// The gathered scene; valid only on the rank where IsHere() is true.
  SceneBlock Scene() const { return { Domain(this->TheMedium.grid), this->TheMedium, this->Light, this->Index }; }

  /// Distributes the light that the gathered scene's rank computed: fluence and its uncollided part to the owners of
  /// the coarse voxels, and global data (balance, powers, convergence, messages) to all ranks.
  void Spread(LightField& light) const;

private:
  Field Gathered(const Field& own, int components, std::vector<float>& values) const;

  const CoarseBlocks& Blocks;
  const bool Here;
  /// Box of gathered coarse voxels, by rank: the whole coarse grid on one rank, empty on the other ranks
  std::vector<VoxelBox> Boxes;
  Medium TheMedium;
  Illumination Light;
  Field Index;
  std::array<std::vector<float>, 7> Arrays;
};

SceneOnFirst::SceneOnFirst(const CoarseBlocks& blocks, const SceneBlock& own, const Medium& fine)
  : Blocks(blocks)
  , Here(IsFirstThatHas(blocks.Comm(), blocks.Fine()))
  , TheMedium(fine)
  , Light(own.illumination)
  , Index(own.index)
{
  const std::vector<VoxelBox>& owned = blocks.Fine().blocks;
  const auto first = std::find_if(owned.begin(), owned.end(), [](const VoxelBox& box) { return box.VoxelCount() > 0; });
  this->Boxes.resize(owned.size());
  this->Boxes[first - owned.begin()] = { {}, blocks.Coarse().whole.size };

  this->TheMedium.grid = blocks.Coarse().whole;
  Field g = own.medium.phase.Varies() ? own.medium.phase.G() : Field();
  const std::array<std::pair<Field, Field*>, 7> fields = { { { own.medium.sigma_a, &this->TheMedium.sigma_a },
    { own.medium.sigma_s, &this->TheMedium.sigma_s }, { own.medium.emission, &this->TheMedium.emission }, { g, &g },
    { own.illumination.uncollided.fluence, &this->Light.uncollided.fluence },
    { own.illumination.uncollided.meanDirection, &this->Light.uncollided.meanDirection },
    { own.index, &this->Index } } };
  std::vector<double> components;
  for (const auto& [from, to] : fields)
  {
    components.push_back(blocks.HasOwn() && from.values ? from.components : 0.0);
  }
  components = blocks.Comm().Largest(components);
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    *fields[i].second = this->Gathered(fields[i].first, static_cast<int>(components[i]), this->Arrays[i]);
  }
  if (this->Here && g.values)
  {
    this->TheMedium.phase = fine.phase.WithG(g);
  }
}

/// Gathers a field of coarse voxels from all ranks on the first rank.
Field SceneOnFirst::Gathered(const Field& own, int components, std::vector<float>& values) const
{
  if (components == 0)
  {
    return {};
  }
  std::vector<float> ofBlock;
  if (this->Blocks.HasOwn())
  {
    const std::size_t voxels = this->Blocks.Own().Coarse().VoxelCount();
    ofBlock.assign(own.values, own.values + voxels * static_cast<std::size_t>(components));
  }
  values = ValuesInBox(this->Blocks.Comm(), this->Blocks.Coarse(), this->Boxes, ofBlock, components);
  return { this->Here ? values.data() : nullptr, components };
}

void SceneOnFirst::Spread(LightField& light) const
{
  Communicator& others = this->Blocks.Comm();
  ShareFigures(others, this->Here, light);
  const BlockPartition onFirst = { this->Blocks.Coarse().whole, this->Boxes };
  for (std::vector<float>* const values : { &light.fluence, &light.fluenceDirect })
  {
    if (OnAnyRank(others, !values->empty()))
    {
      *values = ValuesInBox(others, onFirst, this->Blocks.Coarse().blocks, *values, light.channels);
    }
  }
}

void RequireSame(const SceneBlock& scene, const PropagationSettings& alike)
{
  RequireSame(scene.domain, scene.medium, scene.illumination, alike);
  RequireSame(scene.domain.Comm(), "whether there is a refractive index", !scene.domain.IsEmpty(),
    { scene.index.values ? 1.0 : 0.0 });
}

/// Converts the light of the coarse grid to the preview that users see: interpolates it to this rank's fine voxels.
LightField Shown(LightField&& found, const CoarseBlocks& blocks)
{
  LightField light;
  light.channels = found.channels;
  light.fluence = blocks.Seen().Refine(blocks.SeenOf(found.fluence, found.channels), found.channels);
  if (OnAnyRank(blocks.Comm(), !found.fluenceDirect.empty()))
  {
    light.fluenceDirect = blocks.Seen().Refine(blocks.SeenOf(found.fluenceDirect, found.channels), found.channels);
  }
  light.balance = found.balance;
  light.facePowerOut = found.facePowerOut;
  static_cast<SolveReport&>(light) = std::move(found);
  light.doubts.clear(); // the accuracy of a preview is not assessed
  light.converged = true;
  light.leftOut.insert(light.leftOut.begin(),
    "detail: a preview, of " + SizeOf(blocks.Coarse().whole) + " of " + SizeOf(blocks.Fine().whole) +
      " voxels, few directions");
  return light;
}
}

Grid PreviewGrid(const Grid& grid)
{
  return Halved(grid, [](const Grid&) { return true; });
}

Grid CubicPreviewGrid(const Grid& grid)
{
  return Halved(grid, [](const Grid& halved) {
    return std::all_of(halved.size.begin(), halved.size.end(), [](int voxels) { return voxels % 2 == 0; });
  });
}

PropagationSettings SettingsOfPreview(PropagationSettings settings)
{
  settings.directionsPerFace = std::min(settings.directionsPerFace, PreviewDirections);
  settings.uncollidedDirections = 0;
  settings.adaptDirections = false;
  settings.angularDegree = 0;
  settings.storeMoments = false;
  settings.emissionError = 0.0;
  settings.storedDirections = 1;
  settings.netFlux = false;
  settings.tolerance = std::max(settings.tolerance, PreviewTolerance);
  return settings;
}

LightField SolvePreview(const SceneBlock& scene, const PropagationSettings& alike, const Grid& coarse,
  const PreviewSolver& solve, std::size_t small)
{
  const Domain& domain = scene.domain;
  RequireSame(scene, alike);
  const CoarseBlocks blocks(domain.Comm(), domain.Partition(), coarse);
  const CoarseScene averages(blocks, scene);
  if (coarse.VoxelCount() > small)
  {
    return Shown(solve(averages.Scene()), blocks);
  }
  const SceneOnFirst first(blocks, averages.Scene(), scene.medium);
  LightField found;
  domain.Collective([&] {
    if (first.IsHere())
    {
      found = solve(first.Scene());
    }
  });
  first.Spread(found);
  return Shown(std::move(found), blocks);
}
}
