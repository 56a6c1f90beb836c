#include "LightPropagation/Conservative/Acceleration/BeamsInThickBlocks.h"

#include "LightPropagation/Diffusion/LampPassing.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace tyndall
{
BeamsInThickBlocks::BeamsInThickBlocks(Device& device, Communicator& communicator, const BlockWithGhosts& block,
  std::size_t pathFloats, const Coefficients& medium)
  : TheDevice(device)
  , Comm(communicator)
  , Block(block)
  , TheMedium(medium)
{
  communicator.Collective([&] {
    const char* what = "light of lamps";
    this->OwnPath = Buffer<float>(device, pathFloats, what);
    this->OwnMoments = Buffer<float>(device, block.Own().Floats(6), what);
    const VolumeLayout& held = block.WithGhosts();
    for (Buffer<float>* array : { &this->Path, &this->PathOfAll, &this->InVoxels })
    {
      *array = Buffer<float>(device, held.Floats(), what);
    }
    for (Buffer<float>* array : { &this->FirstMoments, &this->ThroughFaces })
    {
      *array = Buffer<float>(device, held.Floats(6), what);
    }
    this->PathOfAll.Fill(0.0f);
    this->ThroughFaces.Fill(0.0f);
  });
}

SweepTally BeamsInThickBlocks::Add(
  std::size_t lamp, const LampAdder& add, Buffer<float>& path, const Deposit& more, const Monitor& monitor)
{
  this->Comm.Collective([&] {
    this->OwnPath.Fill(0.0f);
    this->OwnMoments.Fill(0.0f);
  });
  const SweepTally tally =
    add(lamp, { &this->OwnPath, more.flux, nullptr, &this->OwnMoments, more.faceOut, more.spreadsAside }, monitor);
  std::vector<float> lengths, moments;
  this->Comm.Collective([&] {
    lengths = this->OwnPath.Read();
    moments = this->OwnMoments.Read();
    std::vector<float> all = path.Read();
    std::transform(all.begin(), all.end(), lengths.begin(), all.begin(), std::plus<float>());
    path.Write(all.data());
  });
  const int channels = this->Block.Own().channels;
  this->Block.Spread(lengths, channels, this->Path);
  this->Block.SpreadWithGhosts(moments, 6 * channels, this->FirstMoments);
  this->Comm.Collective([&] {
    if (this->Block.Has())
    {
      this->PassFaces();
    }
  });
  return tally;
}

void BeamsInThickBlocks::PassFaces()
{
  const VolumeLayout& held = this->Block.WithGhosts();
  for (int c = 0; c < held.channels; ++c)
  {
    PassLampLight(this->TheDevice, held.grid, this->Block.Periodic(),
      { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(), &this->TheMedium.sigma_t, &this->TheMedium.sigma_a,
        &this->TheMedium.sigma_s, &this->TheMedium.swept, &this->Path, &this->FirstMoments, &this->ThroughFaces,
        &this->PathOfAll });
  }
}

/// What is first scattered, less what passes faces at once, in the block's voxels.
void BeamsInThickBlocks::Finish()
{
  const VolumeLayout& own = this->Block.Own();
  std::vector<float> passed, scattered;
  this->Comm.Collective([&] {
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
