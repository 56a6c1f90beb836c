#pragma once

#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Buffer.h"

#include <vector>

namespace tyndall
{
/// Sizes, in floats, of the buffers that all batches share.
struct PublishedSizes
{
  std::size_t rays = 0, escaped = 0, carried = 0, contributions = 0, boundary = 0;
};

/// Schedule of the published algorithm: batches of directions, their paths through the grid as tables of voxel
/// crossings, and the memory they need.
class PublishedPlan
{
public:
  /// A launch: some of the crossings in one plane.
  struct Launch
  {
    int plane, first, count;
    bool add; ///< to the deposits of earlier launches in the plane
  };

  /// Path of a batch through the volume on one of the N x N sub-maps ("divide the LPM into N smaller sub-LPM", section
  /// 5).
  struct Pass
  {
    std::vector<Launch> launches;
    int end = 0; ///< index of its crossings for end_rays
    std::size_t carriedFirst = 0;
  };

  /// Directions of one cube face whose rays are propagated together, and their rows in T.
  struct Batch
  {
    int first = 0, count = 0; ///< directions
    cl_int firstCoefficient = 0;
    std::size_t carriedFirst = 0;
    std::vector<MapGeometry> maps;
    std::vector<Pass> passes;
    Buffer<PublishedCrossing> crossings; ///< of all passes
    int Layout() const { return this->maps[0].axis == 0 ? 1 : 0; }
    const MapGeometry& Map() const { return this->maps[0]; } ///< first map; all have the same axes and sizes
  };

  /// @param model, volumes  must outlive this
  /// @param temporaryBytes  limit on the memory of T; 0: the memory left on the device
  PublishedPlan(Device& device, const Grid& grid, const PublishedModel& model, const PropagationSettings& settings,
    const PublishedVolumes& volumes, std::size_t temporaryBytes);

  std::vector<Batch> batches;
  Buffer<float> coefficients; ///< [batch][moment][direction], times the map's density
  PublishedSizes sizes;

  int SubMaps() const { return this->Settings.mapResolution * this->Settings.mapResolution; }
  int RayRow(const Batch& batch) const;                ///< floats of a row of a ray map
  std::size_t CarriedStride(const Batch& batch) const; ///< floats stored of one direction's map, all channels

  /// Makes the passes of an order. Rays that wrap around a periodic axis start at another position in their voxels in
  /// each order.
  void MakePasses(Batch& batch, int order) const;
  /// Path of a ray of a map.
  GridWalk Walk(const MapGeometry& map, int subMap, int order) const;

private:
  using CrossingsByPlane = std::vector<std::vector<std::vector<PublishedCrossing>>>; ///< [plane][voxel in it]

  int DirectionsPerBatch(std::size_t temporaryBytes) const;
  std::size_t LargestLayout() const;
  double LargestRayMap() const;
  void MakeBatches(int perBatch);
  void MeasureBuffers(int perBatch);
  void AppendCoefficients(Batch& batch, std::vector<float>& to) const;
  void WalkThrough(const Batch& batch, int i, int subMap, int order, CrossingsByPlane& byPlane,
    std::vector<PublishedCrossing>& ends) const;

  Device& TheDevice;
  Grid TheGrid;
  const PublishedModel& Model;
  PropagationSettings Settings;
  const PublishedVolumes& Volumes;
};
}
