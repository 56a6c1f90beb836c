#include "LightPropagation/Distributed/Balance/BeamsInThickBlocks.h"

#include "LightPropagation/Diffusion/LampPassing.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <array>
#include <functional>

namespace tyndall
{
BeamsInThickBlocks::BeamsInThickBlocks(Device& device, Communicator& communicator, const BlockWithGhosts& block,
  const VolumeLayout& whole, const std::array<bool, 3>& periodic, const Coefficients& medium)
  : TheDevice(device)
  , Others(communicator)
  , Block(block)
  , Whole(whole)
  , Periodic(periodic)
  , TheMedium(medium)
{
  communicator.Together([&] {
    const char* what = "light of lamps";
    this->OwnPath = Buffer<float>(device, block.Own().Floats(), what);
    this->OwnSixfold = Buffer<float>(device, block.Own().Floats(6), what);
    const VolumeLayout& held = block.WithGhosts();
    for (Buffer<float>* array : { &this->Path, &this->BeamPath, &this->PathOfAll, &this->InVoxels })
    {
      *array = Buffer<float>(device, held.Floats(), what);
    }
    for (Buffer<float>* array : { &this->Currents, &this->FirstMoments, &this->ThroughFaces })
    {
      *array = Buffer<float>(device, held.Floats(6), what);
    }
    this->PathOfAll.Fill(0.0f);
    this->ThroughFaces.Fill(0.0f);
  });
}

SweepTally BeamsInThickBlocks::Add(const Light& lamp, const SweepMaker& makeSweep, const NearLampAdder& addNear,
  Buffer<float>& path, const Deposit& more, const Monitor& monitor)
{
  if (Sum(lamp.power) == 0.0)
  {
    return {};
  }
  const bool parallel = lamp.type == LightType::Directional;
  this->OwnPath.Fill(0.0f);
  this->OwnSixfold.Fill(0.0f);
  const SweepTally tally = parallel
    ? this->FollowBeam(lamp, makeSweep, more, monitor)
    : addNear(
        lamp, { &this->OwnPath, more.flux, nullptr, &this->OwnSixfold, more.faceOut, more.spreadsAside }, monitor);
  std::vector<float> lengths, sixfold;
  this->Others.Together([&] {
    lengths = this->OwnPath.Read();
    sixfold = this->OwnSixfold.Read();
    std::vector<float> all = path.Read();
    std::transform(all.begin(), all.end(), lengths.begin(), all.begin(), std::plus<float>());
    path.Write(all.data());
  });
  const int channels = this->Block.Own().channels;
  this->Block.Spread(lengths, channels, parallel ? this->Path : this->BeamPath);
  this->Block.SpreadWithGhosts(sixfold, 6 * channels, parallel ? this->Currents : this->FirstMoments);
  this->Others.Together([&] {
    if (!this->Block.Has())
    {
      return;
    }
    if (parallel)
    {
      this->FindFirstMoments(lamp);
    }
    this->PassFaces();
  });
  return tally;
}

SweepTally BeamsInThickBlocks::FollowBeam(
  const Light& lamp, const SweepMaker& makeSweep, const Deposit& more, const Monitor& monitor)
{
  const Deposit ofBeam = { &this->OwnPath, more.flux, &this->OwnSixfold, nullptr, more.faceOut, more.spreadsAside };
  const UncollidedVolume rays = { this->TheDevice, this->Whole, this->TheMedium.sigma_t, this->Periodic, makeSweep,
    {} };
  return SweepBeam(rays, lamp, true, ofBeam, monitor);
}

/// Of a parallel beam, from its path and currents.
void BeamsInThickBlocks::FindFirstMoments(const Light& lamp)
{
  this->BeamPath.Fill(0.0f);
  this->FirstMoments.Fill(0.0f);
  const Deposit all = { &this->BeamPath, nullptr, nullptr, &this->FirstMoments };
  const UncollidedVolume volume = { this->TheDevice, this->Block.WithGhosts(), this->TheMedium.sigma_t,
    this->Block.Periodic(), {}, all };
  AddWithFirstMoments(volume, lamp, { &this->Path, nullptr, &this->Currents });
}

void BeamsInThickBlocks::PassFaces()
{
  const VolumeLayout& held = this->Block.WithGhosts();
  for (int c = 0; c < held.channels; ++c)
  {
    PassLampLight(this->TheDevice, held.grid, this->Block.Periodic(),
      { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(), &this->TheMedium.sigma_t, &this->TheMedium.sigma_a,
        &this->TheMedium.sigma_s, &this->TheMedium.sigma_t, &this->BeamPath, &this->FirstMoments, &this->ThroughFaces,
        &this->PathOfAll });
  }
}

/// What is first scattered, less what passes faces at once, in the block's voxels.
void BeamsInThickBlocks::Finish()
{
  const VolumeLayout& own = this->Block.Own();
  std::vector<float> passed, scattered;
  this->Others.Together([&] {
    passed = this->Block.TakeOwn(this->ThroughFaces, 6 * own.channels);
    const std::vector<float> lengths = this->Block.TakeOwn(this->PathOfAll, own.channels);
    scattered = this->Block.TakeOwn(this->TheMedium.sigma_s, own.channels);
    for (std::size_t at = 0; at < own.Values(); ++at)
    {
      const std::size_t c = at / own.Stride(), i = at % own.Stride();
      double power = static_cast<double>(scattered[at]) * lengths[at];
      for (std::size_t d = 0; d < 6; ++d)
      {
        power -= passed[(6 * c + d) * own.Stride() + i];
      }
      scattered[at] = static_cast<float>(power / (4.0 * Pi * own.grid.VoxelVolume()));
    }
  });
  this->Block.Spread(scattered, own.channels, this->InVoxels);
  this->Block.SpreadWithGhosts(passed, 6 * own.channels, this->ThroughFaces);
}
}
