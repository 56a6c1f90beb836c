#include "Viewing/Rays/ViewInfos.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Viewing/Backdrop/BackdropTables.h"
#include "Viewing/Scene/ViewChecks.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 16;            ///< longest path of a ray, in units of the sum of the box's edges
constexpr double BentStretch = 4.0;         ///< voxels between checks whether rays still bend
constexpr double SurfacePrecision = 1.0e-3; ///< voxels

/// Largest depth of the box's corners along the view axis.
double FarDepth(const Grid& grid, const glm::dvec3& eye, const glm::dvec3& forward)
{
  double farDepth = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(
      corner & 1 ? grid.Length(0) : 0.0, corner & 2 ? grid.Length(1) : 0.0, corner & 4 ? grid.Length(2) : 0.0);
    farDepth = std::max(farDepth, glm::dot(at - eye, forward));
  }
  return farDepth;
}
}

ViewInfo ViewInfoOf(
  const Camera& camera, const ViewSettings& settings, const ViewTraits& traits, const GridBlock* block)
{
  const Grid& grid = block ? block->whole : traits.grid;
  const auto axes = Axes(camera);
  CheckDistance(camera, grid);
  const glm::dvec3 inverseSpacing = 1.0 / Vector(grid.spacing);
  const glm::dvec3 eye = Vector(camera.position) - Vector(grid.origin);
  const glm::dvec3 forward = Vector(axes[2]);
  const double halfHeight = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double aspect =
    camera.aspect > 0.0 ? camera.aspect : static_cast<double>(settings.imageSize[0]) / settings.imageSize[1];
  ViewInfo view = {};
  view.eye = Float4(eye * inverseSpacing, camera.parallelProjection ? 1.0 : 0.0);
  view.forward = Float4(forward, 0.0);
  view.right = Float4(halfHeight * aspect * Vector(axes[0]), camera.shift[0]);
  view.up = Float4(halfHeight * Vector(axes[1]), camera.shift[1]);
  view.inverseSpacing = Float4(inverseSpacing, 0.0);
  view.marching = Float4({ settings.stepSize, settings.minimumTransmittance, FarDepth(grid, eye, forward) }, 0.0);
  view.picture = Int4({ settings.imageSize[0], settings.imageSize[1], 0 });
  view.size = Int4(traits.grid.size);
  if (block)
  {
    view.block = BlockInfoOf(*block);
  }
  view.phase = traits.phase.parameters;
  return view;
}

OpticsInfo OpticsInfoOf(const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* ofWhole)
{
  const Grid& grid = traits.grid;
  const double index = traits.SurfaceIndex(settings);
  const int face = std::max(settings.tableFace, 0);
  const std::array<int, 3>& size = ofWhole ? ofWhole->block.whole.size : grid.size;
  const double edges = 1.0 * size[0] + size[1] + size[2];
  const double halvings = std::log2(settings.stepSize / SurfacePrecision);
  OpticsInfo optics = {};
  optics.spacing = Float4(Vector(grid.spacing), 0.0);
  optics.surface = Float4({ index * index, settings.surfaceReflectance, VoxelsBesideSurface }, 0.0);
  optics.table = Float4(Vector(settings.tableColor), settings.tableReflectance);
  optics.face = Int4({ face / 2, face % 2, FaceSize(grid, face)[0] });
  optics.flip = { { face / 2 == 0 ? -1.0f : 1.0f, face / 2 == 1 ? -1.0f : 1.0f, face / 2 == 2 ? -1.0f : 1.0f, 0.0f } };
  optics.limits = Int4({ static_cast<int>(std::min(1e9, std::ceil(RoundsAtMost * edges / settings.stepSize))),
    static_cast<int>(std::clamp(BentStretch / settings.stepSize, 1.0, 1e3)),
    static_cast<int>(std::ceil(std::max(halvings, 1.0))) });
  if (ofWhole)
  {
    optics.knownFirst = Int4(ofWhole->known.first);
    optics.knownSize = Int4(ofWhole->known.size);
  }
  return optics;
}
}
