#include "LightPropagation/Conservative/Acceleration/MomentsWithGhosts.h"

namespace tyndall
{
namespace
{
constexpr int OfDegreesToOne = 4; ///< number of functions of degrees 0 and 1
}

MomentsWithGhosts::MomentsWithGhosts(const BlockWithGhosts& block, int functions)
  : Block(block)
  , Own(block.Own().Places(functions))
  , Held(block.HasGhosts() ? block.WithGhosts().Places(functions > 1 ? OfDegreesToOne : 1) : this->Own)
{
}

void MomentsWithGhosts::Allocate(Device& device, const char* what)
{
  this->Block.TheDomain().Collective([&] {
    if (this->Block.HasGhosts())
    {
      this->Array = Buffer<float>(device, this->Block.WithGhosts().MomentFloats(this->Held.functions), what);
    }
  });
}

void MomentsWithGhosts::Spread(const Buffer<float>& own)
{
  this->Block.TheDomain().Collective([&] {
    if (this->Array.Size() == 0)
    {
      return;
    }
    const VolumeLayout& layout = this->Block.Own();
    const std::vector<float> from = own.Read();
    std::vector<float> to(this->Array.Size(), 0.0f);
    for (int c = 0; c < layout.channels; ++c)
    {
      for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
      {
        const std::size_t at = this->Block.PlaceOf(i);
        to[c * this->Block.WithGhosts().Stride() + at] = from[c * layout.Stride() + i];
        for (int function = 1; function < this->Held.functions; ++function)
        {
          to[VolumeLayout::MomentPlace(this->Held, function, c, at)] =
            from[VolumeLayout::MomentPlace(this->Own, function, c, i)];
        }
      }
    }
    this->Array.Write(to.data());
  });
}

void MomentsWithGhosts::TakeFirstDegree(Buffer<float>& own) const
{
  this->Block.TheDomain().Collective([&] {
    if (this->Array.Size() == 0)
    {
      return;
    }
    const VolumeLayout& layout = this->Block.Own();
    const std::vector<float> from = this->Array.Read();
    std::vector<float> to = own.Read();
    for (int c = 0; c < layout.channels; ++c)
    {
      for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
      {
        for (int function = 1; function < this->Held.functions; ++function)
        {
          to[VolumeLayout::MomentPlace(this->Own, function, c, i)] =
            from[VolumeLayout::MomentPlace(this->Held, function, c, this->Block.PlaceOf(i))];
        }
      }
    }
    own.Write(to.data());
  });
}

std::vector<double> MomentsWithGhosts::StateOf(
  int channel, const std::vector<float>& values, std::vector<double> fluence) const
{
  const std::size_t count = fluence.size();
  fluence.resize(this->Any() ? OfDegreesToOne * count : count, 0.0);
  for (std::size_t i = 0; this->Any() && i < this->Block.Own().grid.VoxelCount(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      fluence[(axis + 1) * count + this->Block.PlaceOf(i)] =
        values[VolumeLayout::MomentPlace(this->Own, FunctionAlong(axis), channel, i)];
    }
  }
  return fluence;
}
}
