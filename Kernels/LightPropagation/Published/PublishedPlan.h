#pragma once

#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Buffer.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// Consecutive planes across an axis: all that a rank has of the grid for the sweeps along it (Distributed).
struct PublishedSlab
{
  int axis = 0, first = 0, planes = 0;
};

/// Floats of the buffers that all batches share.
struct PublishedSizes
{
  std::size_t rays = 0, escaped = 0, carried = 0, contributions = 0, boundary = 0;
  std::size_t left = 0; ///< of what leaves through the cells of faces, where they are counted
};

/// Which rays the published algorithm sends together, and where they go: directions in batches, their ways through the
/// grid as tables of voxel crossings, and how much memory all that takes.
class PublishedPlan
{
public:
  /// One launch: some of the crossings in one plane.
  struct Launch
  {
    int plane, first, count; ///< the plane counted from the first of the volumes
    bool add;                ///< to what earlier launches left in the plane
  };

  /// A batch's way through the volume on one of the N x N sub-maps ("divide the LPM into N smaller sub-LPM", section
  /// 5).
  struct Pass
  {
    std::vector<Launch> launches;
    int end = 0; ///< its crossings for end_rays
    std::size_t carriedFirst = 0;
  };

  /// Directions of one face whose rays go together, and their rows in T.
  struct Batch
  {
    int first = 0, count = 0; ///< directions
    cl_int firstCoefficient = 0;
    std::size_t carriedFirst = 0;
    std::vector<MapGeometry> maps;
    std::vector<Pass> passes;
    Buffer<PublishedCrossing> crossings; ///< of all passes
    int Layout() const { return this->maps[0].axis == 0 ? 1 : 0; }
    const MapGeometry& Map() const { return this->maps[0]; } ///< all have its axes and sizes
  };

  /// @param model, volumes  must stay
  /// @param temporaryBytes  most that T may take; 0: what is left on the device
  PublishedPlan(Device& device, const Grid& grid, const PublishedModel& model, const PropagationSettings& settings,
    const PublishedVolumes& volumes, std::size_t temporaryBytes);

  /// Of the maps along one axis, through a part of the grid: what rays have behind it is kept of one pass alone.
  /// @param grid  the whole
  /// @param volumes  of the slab
  PublishedPlan(Device& device, const Grid& grid, const PublishedSlab& slab, const PublishedModel& model,
    const PropagationSettings& settings, const PublishedVolumes& volumes, int perBatch);

  /// All of a face where they fit into what may be taken; at least one.
  static int DirectionsPerBatch(const Device& device, const Grid& grid, const PublishedModel& model,
    const PropagationSettings& settings, const PublishedVolumes& volumes, std::size_t temporaryBytes);

  std::vector<Batch> batches;
  Buffer<float> coefficients; ///< [batch][moment][direction], times the map's density
  PublishedSizes sizes;

  const Grid& Whole() const { return this->TheGrid; }
  int FirstPlane() const { return this->Slab ? this->Slab->first : 0; } ///< of those that the volumes have
  /// Whether maps go out of the grid behind the volumes' planes, or come into it ahead of them.
  bool Ends(const Batch& batch) const { return this->HasPlane(batch, batch.Map().planes - 1); }
  bool Begins(const Batch& batch) const { return this->HasPlane(batch, 0); }
  int Planes(const Batch& batch) const { return this->Slab ? this->Slab->planes : batch.Map().planes; }
  int SubMaps() const { return this->Settings.mapResolution * this->Settings.mapResolution; }
  int RayRow(const Batch& batch) const;                ///< floats of a row of a ray map
  std::size_t LeftStride(const Batch& batch) const;    ///< of what leaves one direction's map through cells, a channel
  std::size_t CarriedStride(const Batch& batch) const; ///< floats kept of one direction's map, all channels

  /// Rays that went on through a periodic axis are elsewhere in their voxels in each order.
  void MakePasses(Batch& batch, int order) const;
  /// The way of a ray of a map.
  GridWalk Walk(const MapGeometry& map, int subMap, int order) const;

private:
  using CrossingsByPlane = std::vector<std::vector<std::vector<PublishedCrossing>>>; ///< [plane][voxel in it]

  static double LargestRayMap(const Grid& grid, int width);
  void MakeBatches(int perBatch);
  void MakeRoomToCarry(Batch& batch);
  int PlaneInVolumes(const Batch& batch, int onTheWay) const;
  bool HasPlane(const Batch& batch, int onTheWay) const; ///< else it is another rank's
  void MeasureBuffers(int perBatch);
  void AppendCoefficients(Batch& batch, std::vector<float>& to) const;
  void WalkThrough(const Batch& batch, int i, int subMap, int order, CrossingsByPlane& byPlane,
    std::vector<PublishedCrossing>& ends) const;

  Device& TheDevice;
  Grid TheGrid;
  std::optional<PublishedSlab> Slab; ///< none: the whole grid
  const PublishedModel& Model;
  PropagationSettings Settings;
  const PublishedVolumes& Volumes;
};
}
