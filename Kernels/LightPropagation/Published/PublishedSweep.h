#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedVolumes.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Sizes, in floats, of the buffers of PublishedSweep, which all batches share.
struct PublishedSizes
{
  std::size_t rays = 0, escaped = 0, carried = 0, contributions = 0, boundary = 0;
};

/// Schedule of the published algorithm: batches of directions, the paths of their rays through the grid as tables of
/// voxel crossings, and the memory that these tables need.
class PublishedPlan
{
public:
  /// One launch of cross_voxels(): a range of crossings in one plane of voxels.
  struct Launch
  {
    int plane, first, count;
    bool add; ///< whether deposits are added to those of earlier launches in this plane
  };

  /// Path of a batch's rays of one sub-map through the volume. Rays start at N x N positions within their voxels; the
  /// rays that start at the same position form a sub-map ("divide the LPM into N smaller sub-LPM", section 5 of the
  /// paper).
  struct Pass
  {
    std::vector<Launch> launches;
    int end = 0; ///< index in Batch::crossings of the first of the entries that end_rays() reads, one per direction
    std::size_t carriedFirst = 0;
  };

  /// Directions of one cube face whose rays are propagated together. The temporary buffers T hold the deposits of all
  /// of them.
  struct Batch
  {
    int first = 0, count = 0; ///< range of directions
    cl_int firstCoefficient = 0;
    std::size_t carriedFirst = 0;
    std::vector<MapGeometry> maps;
    std::vector<Pass> passes;
    Buffer<PublishedCrossing> crossings; ///< voxel crossings of all passes
    int Layout() const { return this->maps[0].axis == 0 ? 1 : 0; }
    /// Map of the first direction; all maps have the same axes and sizes.
    const MapGeometry& Map() const { return this->maps[0]; }
  };

  /// @param model, volumes  must outlive this object
  /// @param temporaryBytes  limit on the memory of the temporary buffers T; 0: the memory left on the device
  PublishedPlan(Device& device, const Grid& grid, const PublishedModel& model, const PropagationSettings& settings,
    const PublishedVolumes& volumes, std::size_t temporaryBytes);

  std::vector<Batch> batches;
  Buffer<float> coefficients; ///< coefficients of moments times MapGeometry::density, [batch][moment][direction]
  PublishedSizes sizes;

  int SubMaps() const { return this->Settings.mapResolution * this->Settings.mapResolution; }
  int RayRow(const Batch& batch) const; ///< floats per row of a ray map
  /// Number of floats per direction for the radiance of rays that wrap around the marching axis into the next order, in
  /// all channels and sub-maps.
  std::size_t CarriedStride(const Batch& batch) const;

  /// Makes the passes of a batch for scattering order `order`; a pass traces the rays of one sub-map. Passes differ
  /// between orders if rays wrap around a periodic axis, because these rays start each order at another position in
  /// their voxels.
  void MakePasses(Batch& batch, int order) const;
  /// Path of the rays of a sub-map (those that start at the same position within their voxels) in a scattering order.
  GridWalk Walk(const MapGeometry& map, int subMap, int order) const;

private:
  /// Voxel crossings of a batch's rays of one sub-map: [plane][index of the crossing within the plane][direction].
  using CrossingsByPlane = std::vector<std::vector<std::vector<PublishedCrossing>>>;

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

/// Ray propagation of the published algorithm on the device: the rays of a batch of directions cross the grid and write
/// their deposits to the temporary buffers T, which are then collected into the moments of the order.
class PublishedSweep
{
public:
  using Batch = PublishedPlan::Batch;
  using Pass = PublishedPlan::Pass;

  /// @param volumes, plan, model  must outlive this object
  PublishedSweep(Device& device, const PublishedVolumes& volumes, const PublishedPlan& plan,
    const PublishedModel& model, const PropagationSettings& settings);

  /// Sets the incident radiance of a batch's directions.
  /// @param incident  whether boundary light is incident (first order only); its power is counted in `tally`
  void Begin(const Batch& batch, bool incident, SweepTally& tally);

  /// Traces rays through all planes: for each direction, one ray per voxel of the first plane. Adds escaped power to
  /// `tally`.
  /// @param emits   whether the source U is nonzero in any voxel
  /// @param report  receives the completed fraction of the pass
  void Send(
    const Batch& batch, const Pass& pass, bool emits, SweepTally& tally, const std::function<void(double)>& report);

  /// Adds the temporary buffers T (deposits of the rays) of a batch to the moments of the order.
  /// @param begins  whether this is the first batch of a memory layout, which overwrites the moments
  void Collect(const Batch& batch, bool begins);

  /// Temporary buffers T: deposits of the rays over sigma_s, length W / (length^2 sr), [direction of the
  /// batch][channel][volume]
  Buffer<float> Contributions;

private:
  void MakeKernels();
  PublishedMap Describe(const Batch& batch) const;
  std::vector<float> IncidentRadiance(const Batch& batch) const;
  void TallyIncident(const Batch& batch, SweepTally& tally) const;
  void TallyEscaped(const Batch& batch, SweepTally& tally) const;
  void CrossPlanes(const Batch& batch, const Pass& pass, const PublishedMap& info, bool emits,
    const std::function<void(double)>& report);
  void Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local);

  Device& TheDevice;
  const PublishedVolumes& Volumes;
  const PublishedPlan& Plan;
  const PublishedModel& Model;
  std::array<bool, 3> Periodic;
  int Channels;
  Buffer<float> Rays, Escaped, Boundary;
  Buffer<float> Carried; ///< radiance of the rays that wrap around the marching axis into the next order
  cl::Kernel StartRays, CrossVoxels[2], EndRays, AddDirections;
};
}
