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
constexpr double Thick = 0.2; ///< mean free paths a voxel: thinner ones send back up to 1% too little
/// The same, from which on nobody has to ask for it: 2% too little, for two to three times the time of an order.
constexpr double ThickUnasked = 0.25;
constexpr double Many = 0.25; ///< of the voxels that scatter: few are walls, and all the others would pay for them
/// Mean free paths a voxel: what does not get out of thicker ones is so little beside what is scattered in them that
/// floats do not tell it.
constexpr double Opaque = 1e4;

/// Whether an automatic source is to be by octant.
bool MatterUnasked(const OctantSources::Voxels& voxels, const PropagationSettings& settings)
{
  return settings.source == PropagationSource::Automatic && settings.maximumOrders == 0 &&
    settings.acceleration == PropagationAcceleration::Automatic && voxels.scattering > 0.0 &&
    voxels.thick >= Many * voxels.scattering;
}
}

bool OctantSources::AreThick(const PropagationProblem& problem)
{
  return AnyVoxelIsThickerThan(Thick, problem.TheMedium());
}

OctantSources::Voxels OctantSources::Count(const Medium& medium, const TruncatedScattering& scattering, int channels)
{
  const Grid& grid = medium.grid;
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  Voxels voxels;
  for (int c = 0; c < channels; ++c)
  {
    const auto scatters = [&](std::size_t i) { return scattering.SigmaS(i, c) > 0.0f; };
    voxels.scattering += SumOverVoxels(grid, [&](std::size_t i) { return scatters(i) ? 1.0 : 0.0; });
    voxels.thick += SumOverVoxels(
      grid, [&](std::size_t i) { return scatters(i) && scattering.SigmaT(i, c) * longest > ThickUnasked ? 1.0 : 0.0; });
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      voxels.thickest = std::max(voxels.thickest, longest * medium.TransportSigmaT(i, c));
    }
  }
  return voxels;
}

bool OctantSources::Matter(
  const Voxels& voxels, const PropagationSettings& settings, bool scatters, int degree, bool otherSources)
{
  const bool wanted =
    settings.source == PropagationSource::Octants ? voxels.thickest > Thick : MatterUnasked(voxels, settings);
  return wanted && scatters && degree == 0 && !otherSources && !settings.firstMoments && settings.maximumOrders != 1 &&
    voxels.thickest <= Opaque;
}

bool OctantSources::Matter(const PropagationProblem& problem, bool otherSources)
{
  return Matter(Count(problem.TheMedium(), problem.Scattering(), problem.Channels()), problem.Settings(),
    problem.Traits().scatters, problem.Scattering().Degree(), otherSources);
}

OctantSources::OctantSources(Device& device, const PropagationProblem& problem, const VolumeLayout& layout,
  const MediumOnDevice& medium, bool lamps)
  : TheDevice(device)
  , Problem(problem)
  , Layout(layout)
  , TheMedium(medium)
{
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
  if (lamps)
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
  const PropagationSettings& settings = this->Problem.Settings();
  const Grid& grid = this->Layout.grid;
  const CrossingPattern pattern =
    FindCrossingPattern(grid, along.Set(), settings.mapResolution, along.Starts(), settings.periodic);
  double perRadiance = 0.0;
  for (int marching = 0; marching < 3; ++marching)
  {
    perRadiance += HalfRange(grid, along.Set(), 0, marching);
  }
  Crossings found = { Buffer<float>(this->TheDevice, pattern.values, "the pattern of rays"), pattern.first,
    perRadiance };
  return this->Patterns.emplace(&along, std::move(found)).first->second;
}

void OctantSources::TakeIncoming(const SweptDirections& along)
{
  const Crossings& crossings = this->CrossingsOf(along);
  cl::Kernel take = this->TheDevice.Kernel("take_incoming", kernel_source::OctantSources);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    OctantSourceInfo info = this->InfoOf(c);
    std::copy(crossings.first.begin(), crossings.first.end(), info.pattern);
    info.perRadiance = static_cast<float>(crossings.perRadiance);
    With(take, info, this->OfSweep, crossings.values, this->Incoming, cl_int(!this->CameIn));
    const std::array<int, 3>& n = this->Layout.grid.size;
    this->TheDevice.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(n[1], n[2], 6));
  }
  this->CameIn = true;
}

void OctantSources::TakeLamp(const Buffer<float>& allPath)
{
  cl::Kernel add = this->TheDevice.Kernel("add_lamp", kernel_source::OctantSources);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    With(add, this->InfoOf(c), this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), this->PathOfLamp,
      this->MomentsOfLamp, this->Falling, this->OfLamps, allPath);
    const std::array<int, 3>& n = this->Layout.grid.size;
    this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(n[0], n[1], n[2]));
  }
  this->LampsShine = true;
}

void OctantSources::Find(const Buffer<float>& source)
{
  cl::Kernel find = this->TheDevice.Kernel("find_octant_sources", kernel_source::OctantSources);
  const Buffer<float>& lamps = this->LampsShine ? this->OfLamps : this->Found;
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    With(find, this->InfoOf(c), this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), source, this->Diffuse,
      this->Incoming, lamps, cl_int(this->LampsShine), this->Found);
    const std::array<int, 3>& n = this->Layout.grid.size;
    this->TheDevice.Queue().enqueueNDRangeKernel(find, cl::NullRange, cl::NDRange(n[1], n[2]));
  }
  this->CameIn = false;
  this->LampsShine = false;
}

OctantSourceInfo OctantSources::InfoOf(int channel) const
{
  const Grid& grid = this->Layout.grid;
  OctantSourceInfo info = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    info.size[axis] = grid.size[axis];
    info.periodic[axis] = this->Problem.Settings().periodic[axis];
    info.spacing[axis] = static_cast<float>(grid.spacing[axis]);
    // One of a direction and its mirror image may stand for both.
    info.leftOut[axis] = grid.size[axis] == 1 && this->Problem.Settings().periodic[axis];
  }
  info.firstT = this->Layout.ExtinctionFirst(channel);
  info.first = channel * this->Layout.Stride();
  info.stride = this->Layout.Stride();
  return info;
}
}
