#include "DiscreteOrdinates/AngularScattering.h"

#include "Device/Batches.h"
#include "Device/Device.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
constexpr std::size_t GroupSize = 64; ///< work-items per work-group
/// number of work-items in the first launch; the measured run time determines that of later launches
constexpr std::size_t FirstBatch = 512;

int RowsOf(int terms, bool netFlux, int width)
{
  return PartsOf(1 + terms + (netFlux ? 3 : 0), width);
}
}

AngularScattering::AngularScattering(Device& device, const OrdinateGroups& groups, const SeparablePhaseFunction& phase,
  PairSums sums, bool positive, bool netFlux, std::size_t voxels, bool skips)
  : TheDevice(device)
  , Sums(sums)
  , Positive(positive)
  , NetFlux(netFlux)
  , Skips(skips)
  , GroupCount(groups.Count())
  , TermCount(sums == PairSums::Terms ? phase.Terms() : 0)
  , Width(device.KernelWidth(8, 16, 8))
  , Rows(RowsOf(this->TermCount, netFlux, this->Width))
  , Voxels(voxels)
{
  const std::size_t all = RoundUp(voxels, VoxelsAtATime * GroupSize);
  this->Moments = Buffer<float>(device, all * this->Rows * this->Width, "moments of the radiance");
  this->LoadTables(groups, phase);
}

std::size_t AngularScattering::Floats(const OrdinateGroups& groups, std::size_t voxels)
{
  return groups.Lanes() * OrdinateStride(voxels) + VoxelsAtATime * GroupSize * OrdinateLanes;
}

std::size_t AngularScattering::Bytes(const OrdinateGroups& groups, int terms, PairSums sums, std::size_t voxels)
{
  const std::size_t moments = sums == PairSums::Terms ? RoundUp<std::size_t>(terms + 4, 16) : 16;
  const std::size_t tables = sums == PairSums::Terms ? groups.Lanes() * terms : groups.Lanes() * groups.Lanes();
  return sizeof(float) * (RoundUp(voxels, VoxelsAtATime * GroupSize) * moments + tables);
}

void AngularScattering::LoadTables(const OrdinateGroups& groups, const SeparablePhaseFunction& phase)
{
  const int moments = this->Rows * this->Width;
  std::vector<float> weights(groups.Lanes() * moments, 0.0f);
  for (int g = 0; g < groups.Count(); ++g)
  {
    const OrdinateGroup& group = groups.All()[g];
    for (int lane = 0; lane < OrdinateLanes; ++lane)
    {
      float* of = weights.data() + (g * OrdinateLanes + lane) * moments;
      const double angle = groups.Weight(g, lane);
      of[0] = static_cast<float>(angle);
      for (int k = 0; k < this->TermCount; ++k)
      {
        of[1 + k] = static_cast<float>(angle * phase.Eigenvalue(k) * phase.Factor(group.direction[lane], k));
      }
      for (int a = 0; a < 3 && this->NetFlux; ++a)
      {
        of[1 + this->TermCount + a] = static_cast<float>(angle * groups.Of(g, lane).omega[a]);
      }
      if (lane < group.count)
      {
        this->Lanes.push_back({ g, lane });
      }
    }
  }
  this->Weights = Buffer<float>(this->TheDevice, weights, "the directions");
  this->Angles = Buffer<float>(
    this->TheDevice, groups.Table([&](int g, int lane) { return groups.Weight(g, lane); }), "the directions");
  this->LoadPhase(groups, phase);
}

/// Makes the device arrays of the factors by which the scattering source along each direction is computed. The lane of
/// a direction is its place among the eight directions of its group. PairSums::Terms: factors of the terms,
/// [group][term][lane]; PairSums::Matrix: the matrix, [group][incident direction][lane]; PairSums::Passes: the rows of
/// the matrix, one array each.
void AngularScattering::LoadPhase(const OrdinateGroups& groups, const SeparablePhaseFunction& phase)
{
  const auto ofMatrix = [&](int to, std::size_t from) -> double {
    const int g = static_cast<int>(from / OrdinateLanes), lane = static_cast<int>(from % OrdinateLanes);
    const std::size_t row = static_cast<std::size_t>(to) * phase.DirectionCount();
    return phase.Matrix()[row + groups.All()[g].direction[lane]] * groups.Weight(g, lane);
  };
  const bool byTerms = this->Sums == PairSums::Terms;
  const int parts = byTerms ? this->TermCount : this->Sums == PairSums::Matrix ? static_cast<int>(groups.Lanes()) : 0;
  const std::vector<float> spread = groups.Table(parts, [&](int g, int part, int lane) -> double {
    const int to = groups.All()[g].direction[lane];
    return byTerms ? phase.Factor(to, part) : ofMatrix(to, part);
  });
  for (std::size_t i = 0; i < this->Lanes.size() && this->Sums == PairSums::Passes; ++i)
  {
    const int to = groups.All()[this->Lanes[i][0]].direction[this->Lanes[i][1]];
    std::vector<float> row;
    for (std::size_t from = 0; from < groups.Lanes(); ++from)
    {
      row.push_back(static_cast<float>(ofMatrix(to, from)));
    }
    this->MatrixRows.emplace_back(this->TheDevice, row, "the phase function");
  }
  this->Spread = Buffer<float>(this->TheDevice, spread, "the phase function");
}

cl::Kernel AngularScattering::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::AngularScattering,
    Define("REAL_WIDTH", this->Width) + Define("GROUPS", this->GroupCount) + Define("TERMS", this->TermCount) +
      Define("ROWS", this->Rows) + Define("FLUX", this->NetFlux) + Define("POSITIVE", this->Positive));
}

/// Range of voxels of a launch that begins at index `voxel`. If `lit` is not null, blocks of voxels outside this box
/// are skipped.
ScatteringVoxels AngularScattering::VoxelsFrom(std::size_t voxel, const Grid* grid, const VoxelBox* lit) const
{
  ScatteringVoxels at = {};
  at.voxels = this->Voxels;
  at.stride = OrdinateStride(this->Voxels);
  at.begin = voxel;
  at.skips = this->Skips;
  for (int axis = 0; axis < 2 && lit; ++axis)
  {
    (axis == 0 ? at.width : at.height) = grid->size[axis];
    at.first[axis] = lit->first[axis];
    at.last[axis] = lit->first[axis] + lit->size[axis] - 1;
  }
  return at;
}

void AngularScattering::Scatter(const Buffer<float>& radiance, const Buffer<float>& sigma_s,
  const Buffer<float>& source, const Buffer<float>& scale, const OrdinatesLight& light, const Monitor& monitor,
  const Buffer<cl_uchar>* empty, const Grid* grid, const VoxelBox* lit) const
{
  if (this->Sums == PairSums::Passes)
  {
    this->Gather(radiance, light, {});
    this->ScatterByPasses(radiance, sigma_s, source, monitor);
    return;
  }
  cl::Kernel scatter = this->Kernel(this->Sums == PairSums::Terms ? "scatter_terms" : "scatter_matrix");
  const std::size_t layer = lit ? static_cast<std::size_t>(grid->size[0]) * grid->size[1] : 0;
  const std::size_t from = lit ? lit->first[2] * layer / (VoxelsAtATime * GroupSize) * (VoxelsAtATime * GroupSize) : 0;
  const std::size_t end = lit ? (lit->first[2] + lit->size[2]) * layer : this->Voxels;
  Batches batches;
  batches.count = RoundUp(PartsOf(end - from, VoxelsAtATime), GroupSize);
  batches.first = FirstBatch;
  batches.whole = GroupSize;
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t begin, std::size_t size) {
    ScatteringVoxels at = this->VoxelsFrom(from + begin * VoxelsAtATime, grid, lit);
    at.hasSums = empty != nullptr;
    With(scatter, radiance, source, this->Moments, this->Weights, this->Spread, this->Angles, sigma_s, light.order,
      light.fluence, light.flux, scale, empty ? empty->Handle() : sigma_s.Handle(), at);
    Launch(this->TheDevice, scatter, cl::NDRange(size), cl::NDRange(GroupSize));
  });
}

void AngularScattering::ScatterByPasses(const Buffer<float>& radiance, const Buffer<float>& sigma_s,
  const Buffer<float>& source, const Monitor& monitor) const
{
  cl::Kernel along = this->Kernel("scatter_along");
  Batches batches;
  batches.count = this->Lanes.size();
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t begin, std::size_t size) {
    for (std::size_t i = begin; i < begin + size; ++i)
    {
      With(along, radiance, source, this->MatrixRows[i], sigma_s, cl_int(this->Lanes[i][0]), cl_int(this->Lanes[i][1]),
        cl_ulong(OrdinateStride(this->Voxels)));
      Launch(this->TheDevice, along, cl::NDRange(this->Voxels));
    }
  });
}

void AngularScattering::Gather(const Buffer<float>& radiance, const OrdinatesLight& light, const Monitor& monitor) const
{
  cl::Kernel gather = this->Kernel("gather_light");
  Batches batches;
  batches.count = RoundUp(PartsOf(this->Voxels, VoxelsAtATime), GroupSize);
  batches.first = FirstBatch;
  batches.whole = GroupSize;
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t begin, std::size_t size) {
    With(gather, radiance, this->Moments, this->Weights, light.order, light.fluence, light.flux,
      this->VoxelsFrom(begin * VoxelsAtATime));
    Launch(this->TheDevice, gather, cl::NDRange(size), cl::NDRange(GroupSize));
  });
}
}
