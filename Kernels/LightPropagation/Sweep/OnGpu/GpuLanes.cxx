#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"

#include "Device/Device.h"
#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
SweepLane LaneOf(const SweepPlan& plan, int way)
{
  SweepLane lane = {};
  lane.planes = plan.plane;
  lane.axis = plan.axes.axis;
  lane.backward = way;
  lane.patternPlanes = plan.PatternPlanes();
  lane.around = plan.periodic[plan.axes.axis];
  lane.periodicU = plan.periodic[plan.axes.u];
  lane.periodicV = plan.periodic[plan.axes.v];
  lane.bundles = static_cast<int>(plan.bundles.size());
  lane.rays = static_cast<int>(plan.eachWay.radiance) / plan.channels;
  lane.positions = std::max(plan.plane.sizeU, plan.plane.sizeV);
  return lane;
}

std::size_t SideFloats(const SweepLane& lane)
{
  return Count(lane.planes.sizeU) + lane.planes.sizeV + 1;
}

std::vector<float> FunctionsAlong(const SweepPlan& plan, int way, const AngularValues& angular)
{
  std::vector<float> functions;
  for (const Bundle& bundle : plan.bundles)
  {
    for (const Member& member : bundle.members)
    {
      const int direction = way == 0 ? member.direction : member.opposite;
      for (int k = 0; k < angular.Functions() + angular.Beams(); ++k)
      {
        const double value = direction < 0 ? 0.0
          : k < angular.Functions()        ? angular.functions[direction][k]
                                           : angular.beams[direction][k - angular.Functions()];
        functions.push_back(static_cast<float>(value));
      }
    }
  }
  return functions;
}

GpuLanes::GpuLanes(const Device& device, const SweepVolume& volume, std::vector<AxisBundles> rays,
  const std::array<bool, 3>& periodic, bool atOnce)
  : channels(volume.channels)
  , functionCount(volume.angular ? volume.angular->Functions() : 1)
  , floatsOfDeposit(functionCount + (volume.deposit.flux ? 3 : 0) + (volume.deposit.partialCurrents ? 6 : 0))
{
  SweepDescription sweep = Describe(volume, periodic);
  sweep.faceIn = false; // incident radiance per cell of the faces is added by the class LaneFaces, not by the plan
  std::stable_partition(rays.begin(), rays.end(), [&](const AxisBundles& along) { return !periodic[along.axis]; });
  for (const AxisBundles& along : rays)
  {
    if (!along.bundles.empty())
    {
      this->plans.emplace_back(device, sweep, along);
    }
  }
  for (const SweepPlan& plan : this->plans)
  {
    this->LayPlan(plan, volume.angular);
  }
  this->LayBatches(atOnce);
  for (LaneBatch& batch : this->batches)
  {
    batch.hasArrays = !device.Streams() && (batch.around || batch.count > 1);
    this->Place(batch, volume.stride);
  }
}

/// Appends a plan's bundles (sets of symmetric directions) to `bundles`, and the moves and segments of their rays in
/// each plane to `crossings`. Adds a lane (the rays that march in one sense along the axis) for each sense of marching.
void GpuLanes::LayPlan(const SweepPlan& plan, const AngularValues* angular)
{
  const int firstBundle = static_cast<int>(this->bundles.size());
  const int firstCrossing = static_cast<int>(this->crossings.size());
  this->bundles.insert(this->bundles.end(), plan.bundleRows.begin(), plan.bundleRows.end());
  const std::vector<CrossingInfo> rows = plan.Crossings(0, plan.CrossingPlanes());
  this->crossings.insert(this->crossings.end(), rows.begin(), rows.end());
  for (int way = 0; way < 2; ++way)
  {
    if (way == 0 ? plan.forward : plan.backward)
    {
      this->LayLane(plan, way, firstBundle, firstCrossing);
      if (angular)
      {
        const std::vector<float> along = FunctionsAlong(plan, way, *angular);
        this->functions.insert(this->functions.end(), along.begin(), along.end());
      }
    }
  }
}

/// Adds a lane for the rays of a plan that march in one sense; the indices of its maps and deposits are set in Place().
void GpuLanes::LayLane(const SweepPlan& plan, int way, int firstBundle, int firstCrossing)
{
  SweepLane lane = LaneOf(plan, way);
  lane.firstBundle = firstBundle;
  lane.crossings = firstCrossing + plan.PlanesBefore(way) * lane.bundles;
  lane.firstRay = this->rays;
  lane.escaped = this->escaped;
  this->lanes.push_back(lane);
  this->PlanOfLane.push_back(&plan - this->plans.data());
  const int number = static_cast<int>(this->lanes.size()) - 1;
  this->rays += lane.rays;
  this->escaped += this->SideRows(number) * lane.positions;
  this->ends.push_back(this->endRows);
  this->endRows += this->EndRows(number);
  this->sides.push_back(this->sideRows);
  this->sideRows += this->SideRows(number);
}

void GpuLanes::LayBatches(bool atOnce)
{
  for (std::size_t i = 0; i < this->lanes.size(); ++i)
  {
    const bool around = this->lanes[i].around != 0;
    const bool joins = atOnce && !this->batches.empty() && this->batches.back().around == around &&
      (!around || this->batches.back().plan == this->PlanOfLane[i]);
    if (!joins)
    {
      this->batches.push_back({ static_cast<int>(i), 0, around, this->PlanOfLane[i] });
    }
    ++this->batches.back().count;
  }
}

/// Sets where the maps and arrays of a batch's lanes begin in the buffers, and updates the maximum sizes over all
/// batches. A batch is a group of lanes (rays of one sense along an axis) that cross planes in the same launches.
void GpuLanes::Place(LaneBatch& batch, std::size_t stride)
{
  for (int i = 0; i < batch.count; ++i)
  {
    SweepLane& lane = this->lanes[batch.first + i];
    lane.map = batch.maps;
    lane.sides = batch.sides;
    batch.sides += Count(lane.rays) * this->channels * lane.patternPlanes * SideFloats(lane);
    lane.deposit = batch.hasArrays ? i * this->channels * stride : 0;
    lane.path = this->functionCount * lane.deposit;
    batch.maps += Count(lane.rays) * this->channels * lane.planes.sizeU * lane.planes.sizeV;
  }
  std::size_t& most = batch.around ? this->mostMapsAround : this->mostMapsOpen;
  most = std::max(most, batch.maps);
  if (batch.hasArrays)
  {
    this->mostWithArrays = std::max(this->mostWithArrays, batch.count);
    this->mostAround = batch.around ? std::max(this->mostAround, batch.count) : this->mostAround;
  }
}

std::size_t GpuLanes::ArrayFloats(std::size_t stride) const
{
  // Rounding errors of the path integrals, for compensated summation
  const std::size_t lost = Count(this->mostAround) * this->functionCount;
  return (Count(this->mostWithArrays) * this->floatsOfDeposit + lost) * this->channels * stride;
}

std::string GpuLanes::Options() const
{
  return Define("CHANNELS", this->channels) + Define("FUNCTIONS", this->functionCount);
}

std::size_t GpuLanes::EndRows(int lane) const
{
  return Count(this->lanes[lane].rays) * this->channels * this->lanes[lane].planes.sizeV;
}

std::size_t GpuLanes::SideRows(int lane) const
{
  return std::size_t{ 4 } * this->lanes[lane].patternPlanes * this->channels;
}
}
