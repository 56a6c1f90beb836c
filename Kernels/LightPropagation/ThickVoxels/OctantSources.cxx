#include "LightPropagation/ThickVoxels/OctantSources.h"

#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/ThickVoxels/VoxelResponse.h"
#include "Medium/VoxelSums.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Optical thickness above which a voxel is thick. Without sources by octant, thinner voxels scatter at most 1% too
/// little light back through the faces where it entered.
constexpr double Thick = 0.2;
/// Optical thickness above which a voxel is thick if the settings leave the choice open. Without sources by octant,
/// thinner voxels scatter up to 2% too little light back; with them, an order takes two to three times as long.
constexpr double ThickUnasked = 0.25;
/// Minimum fraction of thick voxels among the scattering ones, if the settings leave the choice open: if fewer are
/// thick, they are walls, and computing sources for all voxels costs too much.
constexpr double Many = 0.25;
/// Optical thickness above which a voxel is opaque: the light that escapes from it is too small, compared with the
/// light scattered in it, for single precision.
constexpr double Opaque = 1e4;

/// Counts of voxels over all channels, from which OctantSources::Matter() decides whether to use sources by octant.
struct ThickVoxels
{
  double scattering = 0.0, thick = 0.0; ///< number of scattering voxels, and of thick ones among these
  double thickest = 0.0;                ///< largest transport optical thickness along a voxel's longest edge
};

/// Counts the thick voxels of all ranks. Collective.
ThickVoxels Count(const PropagationProblem& problem)
{
  const Grid& grid = problem.TheGrid();
  const TruncatedScattering& scattering = problem.Scattering();
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  ThickVoxels voxels;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    const auto scatters = [&](std::size_t i) { return scattering.SigmaS(i, c) > 0.0f; };
    voxels.scattering += SumOverVoxels(grid, [&](std::size_t i) { return scatters(i) ? 1.0 : 0.0; });
    voxels.thick += SumOverVoxels(
      grid, [&](std::size_t i) { return scatters(i) && scattering.SigmaT(i, c) * longest > ThickUnasked ? 1.0 : 0.0; });
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      voxels.thickest = std::max<double>(voxels.thickest, longest * problem.TheMedium().TransportSigmaT(i, c));
    }
  }
  const Domain& domain = problem.TheDomain();
  const std::vector<double> sums = domain.Sum(std::vector<double>{ voxels.scattering, voxels.thick });
  return { sums[0], sums[1], domain.Max(voxels.thickest) };
}
}

bool OctantSources::AreThick(const PropagationProblem& problem)
{
  return problem.TheDomain().Any(AnyVoxelIsThickerThan(Thick, problem.TheMedium()));
}

bool OctantSources::Matter(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  const bool asked = settings.source == PropagationSource::Octants;
  const bool automatic = settings.source == PropagationSource::Automatic && settings.maximumOrders == 0 &&
    settings.acceleration == PropagationAcceleration::Automatic;
  if (!(asked || automatic) || !problem.Traits().scatters || problem.Scattering().Degree() > 0 ||
    settings.firstMoments || settings.maximumOrders == 1)
  {
    return false;
  }
  const ThickVoxels voxels = Count(problem);
  const bool wanted =
    asked ? voxels.thickest > Thick : voxels.scattering > 0.0 && voxels.thick >= Many * voxels.scattering;
  return wanted && voxels.thickest <= Opaque;
}

OctantSources::OctantSources(const Scene& scene)
  : The(scene)
{
  Device& device = scene.device;
  const VolumeLayout& layout = scene.layout;
  const auto byFaces = [&] {
    Buffer<float> buffer(device, layout.Floats(6), "light at the faces of thick voxels");
    buffer.Fill(0.0f);
    return buffer;
  };
  this->OfSweep = byFaces();
  this->Incoming = byFaces();
  this->Found = Buffer<float>(device, layout.Floats(8), "light of thick voxels by octant");
  this->Found.Fill(0.0f);
  const VoxelResponse response;
  this->Diffuse = Buffer<float>(device, response.diffuse, "the response of thick voxels");
  this->Falling = Buffer<float>(device, response.falling, "the response of thick voxels");
  if (scene.lamps)
  {
    this->OfLamps = byFaces();
    this->MomentsOfLamp = byFaces();
    this->PathOfLamp = Buffer<float>(device, layout.Floats(), "light of lamps");
    this->PathOfLamp.Fill(0.0f);
  }
}

const OctantSources::Crossings& OctantSources::CrossingsOf(const SweptDirections& along)
{
  const auto known = this->Patterns.find(&along);
  if (known != this->Patterns.end())
  {
    return known->second;
  }
  const PropagationSettings& settings = this->The.settings;
  const Grid& grid = this->The.whole;
  const CrossingPattern pattern =
    FindCrossingPattern(grid, along.Set(), along.RaysPerEdge(), along.Starts(), settings.periodic);
  Crossings found = { Buffer<float>(this->The.device, pattern.values, "the pattern of rays"), pattern.first,
    HalfRange(along.Set(), 0) };
  return this->Patterns.emplace(&along, std::move(found)).first->second;
}

void OctantSources::TakeIncoming(const SweptDirections& along)
{
  if (this->IsEmpty())
  {
    return;
  }
  const Crossings& crossings = this->CrossingsOf(along);
  cl::Kernel take = this->The.device.Kernel("take_incoming", kernel_source::OctantSources);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    OctantSourceInfo info = this->InfoOf(c);
    for (int axis = 0; axis < 3; ++axis)
    {
      const PlaneAxes across = AcrossAxis(axis);
      const int low = std::min(across.u, across.v), high = std::max(across.u, across.v);
      info.pattern[2 * axis] = crossings.first[2 * axis] + this->The.block.first[low];
      info.pattern[2 * axis + 1] = crossings.first[2 * axis + 1] + this->The.block.first[high];
    }
    info.perRadiance = static_cast<float>(crossings.perRadiance);
    With(take, info, this->OfSweep, crossings.values, this->Incoming, cl_int(!this->CameIn));
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(n[1], n[2], 6));
  }
  this->CameIn = true;
}

void OctantSources::TakeLamp(const Buffer<float>& allPath)
{
  if (this->IsEmpty())
  {
    return;
  }
  cl::Kernel add = this->The.device.Kernel("add_lamp", kernel_source::OctantSources);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    With(add, this->InfoOf(c), this->The.medium.SigmaT(), this->The.medium.SigmaS(), this->PathOfLamp,
      this->MomentsOfLamp, this->Falling, this->OfLamps, allPath);
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(n[0], n[1], n[2]));
  }
  this->LampsShine = true;
}

void OctantSources::Find(const Buffer<float>& source, const BeyondFaces& beyond)
{
  if (this->IsEmpty())
  {
    return;
  }
  cl::Kernel find = this->The.device.Kernel("find_octant_sources", kernel_source::OctantSources);
  const Buffer<float>& lamps = this->LampsShine ? this->OfLamps : this->Found;
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    OctantSourceInfo info = this->InfoOf(c);
    info.beyond = beyond.info;
    for (cl_int& periodic : info.periodic)
    {
      // If `beyond` is given, it also holds the incident radiance of voxels across periodic axes
      periodic = periodic && !beyond.values;
    }
    With(find, info, this->The.medium.SigmaT(), this->The.medium.SigmaS(), source, this->Diffuse, this->Incoming,
      beyond.values ? *beyond.values : this->Incoming, lamps, cl_int(this->LampsShine), this->Found, cl_ulong(c));
    const std::array<int, 3>& n = this->The.layout.grid.size;
    this->The.device.Queue().enqueueNDRangeKernel(find, cl::NullRange, cl::NDRange(n[1], n[2]));
  }
  this->CameIn = false;
  this->LampsShine = false;
}

OctantSourceInfo OctantSources::InfoOf(int channel) const
{
  const Grid& grid = this->The.layout.grid;
  OctantSourceInfo info = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    info.size[axis] = grid.size[axis];
    info.periodic[axis] = this->The.settings.periodic[axis];
    info.spacing[axis] = static_cast<float>(grid.spacing[axis]);
    // An axis with a single, periodic voxel has no sources by octant: light does not vary along it, and one swept
    // direction may represent itself and its mirror image.
    info.leftOut[axis] = this->The.whole.size[axis] == 1 && this->The.settings.periodic[axis];
  }
  info.firstT = this->The.layout.ExtinctionFirst(channel);
  info.first = channel * this->The.layout.Stride();
  info.stride = this->The.layout.Stride();
  return info;
}
}
