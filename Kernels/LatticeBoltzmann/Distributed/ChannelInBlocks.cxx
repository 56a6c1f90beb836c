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
}

ChannelInBlocks::ChannelInBlocks(Device& device, Communicator& communicator, const LatticeSceneInBlocks& scene,
  const LatticeSettings& settings, const Uncollided& direct, int channel)
  : TheDevice(device)
  , Comm(communicator)
  , Scene(scene)
  , Settings(settings)
  , OfKnown(InKnownVoxels(settings))
  , Direct(direct)
  , Channel(channel)
  , Box(scene.Box())
{
  communicator.Collective(
    [&] { this->Voxels.emplace(scene.OfKnown(), scene.known.index, this->OfKnown, direct, channel); });
  this->ReduceGlobals();
  communicator.Collective([&] {
    if (scene.has)
    {
      this->Photons.emplace(device, this->Box, this->OfKnown, *this->Voxels);
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
  else
  {
    SteadyInBlocks system(this->TheDevice, this->Comm, this->Scene.partition, this->Box, this->Settings, *this->Voxels,
      this->Photons ? &*this->Photons : nullptr);
    this->Fluence = SteadyLattice(this->Box, this->Settings, *this->Voxels, system).Solve(monitor, this->Rows);
  }
}

void ChannelInBlocks::AddTo(LightField& light)
{
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
