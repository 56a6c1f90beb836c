#include "LightPropagation/Published/PublishedPlan.h"

#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
PublishedPlan::PublishedPlan(Device& device, const Grid& grid, const PublishedModel& model,
  const PropagationSettings& settings, const PublishedVolumes& volumes, std::size_t temporaryBytes)
  : TheDevice(device)
  , TheGrid(grid)
  , Model(model)
  , Settings(settings)
  , Volumes(volumes)
{
  const int perBatch = this->DirectionsPerBatch(temporaryBytes);
  this->MakeBatches(perBatch);
  this->MeasureBuffers(perBatch);
}

/// Directions per batch: all of a cube face if they fit into the remaining memory; at least one.
int PublishedPlan::DirectionsPerBatch(std::size_t temporaryBytes) const
{
  const int perFace = this->Model.Directions().PerFace();
  const std::size_t one = this->LargestLayout() * sizeof(float);
  const double maps = 4.0; // two ray maps, and the same again for tables
  const std::size_t map =
    static_cast<std::size_t>(maps * this->Volumes.Channels() * sizeof(float) * this->LargestRayMap());
  const std::size_t taken = this->TheDevice.BytesInUse() + map * perFace;
  const std::size_t left = this->TheDevice.MemoryLimit() - std::min(taken, this->TheDevice.MemoryLimit());
  std::size_t most = std::min(left, this->TheDevice.AllocationLimit());
  most = temporaryBytes > 0 ? std::min(most, temporaryBytes) : most;
  return static_cast<int>(std::clamp<std::size_t>(most / one, 1, perFace));
}

std::size_t PublishedPlan::LargestLayout() const
{
  return std::max(this->Volumes.LayoutSize(0), this->Volumes.LayoutSize(1));
}

double PublishedPlan::LargestRayMap() const
{
  const Grid& grid = this->TheGrid;
  const int width = this->Volumes.Width;
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double u = grid.size[AcrossAxis(axis).u];
    const double v = grid.size[AcrossAxis(axis).v];
    largest = std::max(largest, (u + 3.0 * width) * (v + 2.0));
  }
  return largest;
}

void PublishedPlan::MakeBatches(int perBatch)
{
  const DirectionSet& set = this->Model.Directions();
  const int perFace = set.PerFace();
  std::vector<float> factors;
  for (int face = 0; face < 6; ++face)
  {
    for (int first = 0; first < perFace; first += perBatch)
    {
      Batch batch;
      batch.first = face * perFace + first;
      batch.count = std::min(perBatch, perFace - first);
      for (int i = batch.first; i < batch.first + batch.count; ++i)
      {
        batch.maps.emplace_back(this->TheGrid, this->Settings, set.directions[i], i, perFace);
      }
      if (this->Settings.periodic[batch.Map().axis])
      {
        batch.carriedFirst = this->sizes.carried;
        this->sizes.carried += this->CarriedStride(batch) * batch.count;
      }
      this->MakePasses(batch, 0);
      this->AppendCoefficients(batch, factors);
      this->batches.push_back(std::move(batch));
    }
  }
  this->coefficients = Buffer<float>(this->TheDevice, factors, "the scattering factors");
}

void PublishedPlan::MeasureBuffers(int perBatch)
{
  for (const Batch& batch : this->batches)
  {
    const std::size_t slots = static_cast<std::size_t>(batch.count) * this->Volumes.Channels();
    const std::size_t rows = batch.Map().sizeV;
    this->sizes.rays = std::max(this->sizes.rays, 2 * slots * (rows + 2) * this->RayRow(batch)); // two ray maps
    this->sizes.escaped = std::max(this->sizes.escaped, slots * (2 * rows + 1));
  }
  this->sizes.contributions = perBatch * this->LargestLayout();
  this->sizes.boundary = static_cast<std::size_t>(this->Model.Directions().PerFace()) * 3 * this->Volumes.Channels();
}

int PublishedPlan::RayRow(const Batch& batch) const
{
  return RoundUp(batch.Map().sizeU, this->Volumes.Width) + 2 * this->Volumes.Width;
}

std::size_t PublishedPlan::CarriedStride(const Batch& batch) const
{
  return static_cast<std::size_t>(batch.Map().sizeU) * batch.Map().sizeV * this->Volumes.Channels() * this->SubMaps();
}

void PublishedPlan::AppendCoefficients(Batch& batch, std::vector<float>& to) const
{
  batch.firstCoefficient = static_cast<cl_int>(to.size());
  for (int k = 0; k < this->Model.MomentCount(); ++k)
  {
    for (int i = 0; i < batch.count; ++i)
    {
      to.push_back(static_cast<float>(this->Model.Coefficient(k, batch.first + i) * batch.maps[i].density));
    }
  }
}

/// Crossings of all directions, by sub-map, plane and launch.
void PublishedPlan::MakePasses(Batch& batch, int order) const
{
  std::vector<PublishedCrossing> crossings;
  batch.passes.clear();
  for (int subMap = 0; subMap < this->SubMaps(); ++subMap)
  {
    CrossingsByPlane byPlane(batch.Map().planes);
    std::vector<PublishedCrossing> ends;
    for (int i = 0; i < batch.count; ++i)
    {
      this->WalkThrough(batch, i, subMap, order, byPlane, ends);
    }
    Pass pass;
    for (int plane = 0; plane < batch.Map().planes; ++plane)
    {
      for (std::size_t voxel = 0; voxel < byPlane[plane].size(); ++voxel)
      {
        const std::vector<PublishedCrossing>& together = byPlane[plane][voxel];
        pass.launches.push_back({ batch.Map().PlaneAt(plane), static_cast<int>(crossings.size()),
          static_cast<int>(together.size()), subMap > 0 || voxel > 0 });
        crossings.insert(crossings.end(), together.begin(), together.end());
      }
    }
    pass.end = static_cast<int>(crossings.size());
    crossings.insert(crossings.end(), ends.begin(), ends.end());
    pass.carriedFirst = batch.carriedFirst + subMap * (this->CarriedStride(batch) / this->SubMaps());
    batch.passes.push_back(std::move(pass));
  }
  batch.crossings = Buffer<PublishedCrossing>(this->TheDevice, crossings, "the table of voxel crossings");
}

GridWalk PublishedPlan::Walk(const MapGeometry& map, int subMap, int order) const
{
  return map.Walk(this->Settings.mapResolution, subMap, order);
}

/// Adds the crossings of direction i of the batch, and its end.
void PublishedPlan::WalkThrough(const Batch& batch, int i, int subMap, int order, CrossingsByPlane& byPlane,
  std::vector<PublishedCrossing>& ends) const
{
  const int source = this->Volumes.SourceSlot(batch.Layout(), this->Model.SourceOf(batch.first + i));
  GridWalk walk = this->Walk(batch.maps[i], subMap, order);
  int parity = 0;
  int plane = -1;
  std::size_t voxel = 0;
  while (walk.Next())
  {
    voxel = walk.plane == plane ? voxel + 1 : 0;
    plane = walk.plane;
    byPlane[plane].resize(std::max(byPlane[plane].size(), voxel + 1));
    byPlane[plane][voxel].push_back(
      { i, parity, walk.moveU, walk.moveV, source, static_cast<float>(walk.fraction * batch.maps[i].length) });
    parity = 1 - parity;
  }
  ends.push_back({ i, parity, 0, 0, 0, 0.0f });
}
}
