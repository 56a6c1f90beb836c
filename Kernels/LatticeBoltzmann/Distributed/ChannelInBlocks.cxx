#include "LatticeBoltzmann/Distributed/ChannelInBlocks.h"

#include "LatticeBoltzmann/Distributed/DiffusionInBlocks.h"
#include "LatticeBoltzmann/Distributed/LinesInBlocks.h"
#include "LatticeBoltzmann/LatticeAccount.h"
#include "LatticeBoltzmann/Steady/SteadyLattice.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
namespace
{
/// As they are for a block and the voxels around it, which go on beyond periodic ends: none is seen from there.
LatticeSettings InKnownVoxels(LatticeSettings settings)
{
  settings.periodic = {};
  return settings;
}

LatticeSettings WithoutBlocks(LatticeSettings settings)
{
  settings.blockSize = 0;
  return settings;
}

/// The equations of a steady lattice whose blocks lie on several ranks.
class SteadyInBlocks : public SteadySystem
{
public:
  SteadyInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeSettings& settings, const LatticeVoxels& voxels, const Lattice* lattice)
    : Comm(communicator)
    , Lines(device, communicator, partition, box, settings, voxels, lattice)
    , Diffusion(device, communicator, partition, box, settings, voxels)
  {
  }

  Values Sweep(const Values& even, double shines, bool writes, const Monitor& monitor) override
  {
    return this->Lines.Sweep(even, shines, writes, monitor);
  }
  Values Diffuse(const Values& residual, double) override { return this->Diffusion.Solve(residual); }
  void Alone(const std::function<void()>& work) override { this->Comm.Collective(work); }
  Values Sum(const Values& ofRank) override { return this->Comm.Sum(ofRank); }

private:
  Communicator& Comm;
  LinesInBlocks Lines;
  DiffusionInBlocks Diffusion;
};

/// Where a lattice has the densities of a box of its voxels along one direction.
std::vector<cl_ulong> PlacesOf(const VoxelBox& box, const LatticeInfo& info, int direction)
{
  Grid grid;
  grid.size = box.size;
  std::vector<cl_ulong> places;
  for (std::size_t i = 0; i < box.VoxelCount(); ++i)
  {
    const std::array<int, 3> voxel = grid.VoxelAt(i);
    const auto at = [&](int axis) { return static_cast<cl_ulong>(box.first[axis] + voxel[axis]); };
    places.push_back(static_cast<cl_ulong>(direction) * info.stride + (at(2) + 1) * static_cast<cl_ulong>(info.layer) +
      (at(1) + 1) * static_cast<cl_ulong>(info.row) + at(0) + LatticeFirst);
  }
  return places;
}
}

ChannelInBlocks::ChannelInBlocks(Device& device, Communicator& communicator, const LatticeSceneInBlocks& scene,
  const LatticeSettings& settings, const Uncollided& direct, int channel)
  : TheDevice(device)
  , Comm(communicator)
  , Scene(scene)
  , Settings(settings)
  , OfKnown(InKnownVoxels(settings))
  , OfOwn(WithoutBlocks(this->OfKnown))
  , Direct(direct)
  , Channel(channel)
  , Box(scene.Box())
  , Stepped(scene.Stepped(settings, communicator.Rank()))
{
  communicator.Collective(
    [&] { this->Voxels.emplace(scene.OfKnown(), scene.known.index, this->OfKnown, direct, channel); });
  this->ReduceGlobals();
  communicator.Collective([&] {
    if (scene.has)
    {
      LatticeBox box = BoxOf(scene.around, this->Stepped);
      box.known = scene.scene.medium.grid;
      this->Photons.emplace(device, box, this->OfKnown, *this->Voxels);
    }
  });
}

/// What kernels leave out they do for all voxels of the grid, and what comes in depends on it.
void ChannelInBlocks::ReduceGlobals()
{
  LatticeVoxels& voxels = *this->Voxels;
  const bool has = this->Scene.has;
  const auto ends = std::minmax_element(voxels.squared.begin(), voxels.squared.end());
  const std::vector<double> all =
    this->Comm.Largest({ voxels.passesAll ? 0.0 : 1.0, has ? static_cast<double>(*ends.second) : 0.0,
      has ? 1.0 / static_cast<double>(*ends.first) : 0.0, voxels.thickest });
  voxels.passesAll = all[0] == 0.0;
  voxels.bends = static_cast<float>(all[1]) != static_cast<float>(1.0 / all[2]);
  voxels.thickest = all[3];
  voxels.TakeOutside(this->Scene.scene.illumination, this->Channel);
  if (this->Settings.scheme == LatticeScheme::Conservative)
  {
    const auto ofAll = [this](const std::vector<double>& sums) { return this->Comm.Sum(sums); };
    voxels.FindEndless(this->Scene.partition.whole, this->Settings.periodic, this->Box,
      this->Scene.partition.blocks[this->Comm.Rank()].first, ofAll);
    this->Comm.Collective([&] { voxels.CheckLightEnds(this->Box.known); });
  }
}

void ChannelInBlocks::Solve(const Monitor& monitor)
{
  if (this->Comm.Sum({ this->Voxels->Given() })[0] == 0.0)
  {
    this->Fluence.assign(this->Box.Count(), 0.0f);
  }
  else if (this->Settings.Solves())
  {
    SteadyInBlocks system(
      this->TheDevice, this->Comm, this->Scene.partition, this->Box, this->Settings, *this->Voxels, this->TheLattice());
    this->Fluence = SteadyLattice(this->Box, this->Settings, *this->Voxels, system).Solve(monitor, this->Rows);
  }
  else
  {
    this->Settle({}, monitor);
  }
}

SteppedInBlocks& ChannelInBlocks::Stepping()
{
  if (!this->Steps)
  {
    this->Steps.emplace(
      this->TheDevice, this->Comm, this->Scene.partition, this->Settings, this->Stepped, this->TheLattice());
  }
  return *this->Steps;
}

void ChannelInBlocks::Step(int steps)
{
  this->Stepping().Step(steps, 0.0, {});
}

void ChannelInBlocks::Shine()
{
  this->Voxels->Shine(this->Scene.OfKnown(), this->Direct, this->Channel);
  if (this->Photons)
  {
    this->Photons->Shine(this->Voxels->source);
  }
}

void ChannelInBlocks::Settle(const StepsBefore& before, const Monitor& monitor)
{
  this->Fluence = Settling(this->Stepping(), this->Settings).Run(before, monitor, this->Rows);
}

/// Of blocks that step by themselves: the lattice of all voxels that this rank steps gives way to one of its own ones.
void ChannelInBlocks::KeepOwn()
{
  VoxelBox own = this->Scene.around.Own();
  std::transform(own.first.begin(), own.first.end(), this->Stepped.first.begin(), own.first.begin(), std::minus<int>());
  std::vector<std::vector<float>> densities;
  const auto places = [&](int direction) {
    return Buffer<cl_ulong>(this->TheDevice, PlacesOf(own, this->Photons->Info(), direction), "the rank's voxels");
  };
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    densities.push_back(this->Photons->At(places(i), this->Photons->Densities()));
  }
  this->Photons.emplace(this->TheDevice, this->Box, this->OfOwn, *this->Voxels);
  own.first = {};
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    this->Photons->Put(densities[i], places(i), this->Photons->Densities());
  }
}

/// What leaves and flows is told by the rank's own voxels and what comes into them from around.
void ChannelInBlocks::EndSteps()
{
  this->Steps.reset();
  this->Comm.Collective([&] {
    if (this->Photons && this->Settings.blockSize > 0)
    {
      this->KeepOwn();
    }
  });
  SteppedInBlocks(
    this->TheDevice, this->Comm, this->Scene.partition, this->Settings, this->Scene.around.Own(), this->TheLattice())
    .FillAround();
}

void ChannelInBlocks::AddTo(LightField& light)
{
  if (!this->Settings.Solves())
  {
    this->EndSteps();
  }
  this->Comm.Collective([&] {
    if (this->Photons)
    {
      LatticeAccount(
        this->Scene.OfKnown(), this->Box, this->OfKnown, this->Direct, *this->Voxels, *this->Photons, this->Channel)
        .AddTo(light, this->Fluence);
    }
  });
  AddRows(this->Rows, light);
}
}
