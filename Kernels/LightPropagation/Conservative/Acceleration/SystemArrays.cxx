#include "LightPropagation/Conservative/Acceleration/SystemArrays.h"

#include "LightPropagation/Scattering/ScatteringOperator.h"

namespace tyndall
{
namespace
{
constexpr int OfDegreesToOne = 4; ///< number of angular functions of degrees 0 and 1
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

SystemArrays::SystemArrays(TransportParts& parts)
  : Parts(parts)
  , TheBlock(parts.TheDomain(), parts.Problem.Settings().periodic, parts.Layout.channels, parts.Layout.sharedExtinction)
  , Coefficients(parts, this->TheBlock)
  , OfPath(this->TheBlock, parts.Functions())
{
}

void SystemArrays::Give(const std::vector<float>& uncollided)
{
  TransportParts& parts = this->Parts;
  const int channels = parts.Layout.channels;
  const char* what = "the diffusion system";
  const char* currents = "the power from voxel to voxel";
  parts.TheDomain().Collective([&] {
    this->TheGiven = Buffer<float>(parts.TheDevice, parts.Source.Read(), "the light given");
    parts.DarkenBeams(); // the first sweep does not carry the first-collision source of beams
    parts.Path.Write(uncollided.data());
    if (!parts.IsEmpty())
    {
      parts.Scattering->AddFirstScattered(parts.WholeDeposit(), this->TheGiven);
    }
    this->GivenFlux =
      Buffer<float>(parts.TheDevice, this->OfPath.Any() ? parts.Layout.Floats(3) : 0, "the net flux given");
    this->GivenFlux.Fill(0.0f);
    if (parts.Basis)
    {
      AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), this->TheGiven, this->GivenFlux);
    }
    this->TheCurrents = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), currents);
  });
  this->GivenWithGhosts = { parts.TheDevice, this->TheBlock, this->TheGiven, channels, what };
  this->GivenWithGhosts.FillOwn();
  if (this->OfPath.Any())
  {
    this->GivenFluxWithGhosts = { parts.TheDevice, this->TheBlock, this->GivenFlux, 3 * channels, what };
    this->GivenFluxWithGhosts.Fill();
  }
  this->SourceWithGhosts = { parts.TheDevice, this->TheBlock, parts.Source, channels, what };
  this->CurrentsWithGhosts = { parts.TheDevice, this->TheBlock, this->TheCurrents, 6 * channels, currents };
  this->OfPath.Allocate(parts.TheDevice, what);
}

void SystemArrays::TakeSwept()
{
  this->OfPath.Spread(this->Parts.Path);
  this->CurrentsWithGhosts.Fill();
}

void SystemArrays::ChangePath(const std::function<void(const Buffer<float>& path)>& step)
{
  this->Parts.TheDomain().Collective([&] { step(this->OfPath.Values(this->Parts.Path)); });
  this->OfPath.TakeFirstDegree(this->Parts.Path);
}

void SystemArrays::ChangeSource(const std::function<void()>& step)
{
  this->Parts.TheDomain().Collective(step);
  this->SourceWithGhosts.TakeOwn();
}

DiffusionSystem::Arrays SystemArrays::OfChannel(int c, const UncollidedLight& light, const Buffer<float>* faces) const
{
  const TransportParts& parts = this->Parts;
  const VolumeLayout& held = this->TheBlock.WithGhosts();
  const GhostedMedium& medium = this->Coefficients;
  DiffusionSystem::Arrays arrays = { held.Stride(), held.ExtinctionFirst(c), c * held.Stride(),
    &medium.sigma_t.Values(), &medium.Swept(), &medium.sigma_a.Values(), &medium.sigma_s.Values(),
    &this->GivenWithGhosts.Values(), this->OfPath.Places(), c,
    this->OfPath.Any() ? &this->GivenFluxWithGhosts.Values() : nullptr, &this->SourceWithGhosts.Values(),
    &this->OfPath.Values(parts.Path), &this->CurrentsWithGhosts.Values(), light.Passes() ? &light.Passed() : nullptr,
    light.Passes() ? &light.OfLamps() : nullptr, faces };
  for (int face = 0; face < 6; ++face)
  {
    arrays.albedo[face] = parts.Faces ? parts.Faces->Albedo()[face][c] : 0.0;
  }
  return arrays;
}
}
