// What AccelerationInBlocks.h finds: its light and where the power went, of the last sweep and the systems' solution.

#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Diffusion/FluxLimit.h"
#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"
#include "LightPropagation/Distributed/Balance/SurfaceInBlocks.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
void AccelerationInBlocks::TakeDirect()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> direct;
  this->The.others.Collective([&] {
    if (!this->Block.Has())
    {
      return;
    }
    std::vector<float> values = this->The.path.Read();
    const double volume = own.grid.VoxelVolume();
    for (std::size_t i = 0; i < values.size() && i < this->UncollidedFluence.size(); ++i)
    {
      values[i] = std::max(static_cast<float>(values[i] / volume + this->UncollidedFluence[i]), 0.0f);
    }
    this->The.fluence.Write(values.data());
    this->FluenceDirect = Interleaved(own, this->The.fluence, 1.0);
    values.resize(own.Floats());
    direct = std::move(values);
  });
  if (this->The.warm.Keeps())
  {
    this->The.warm.Prepare(direct);
  }
}

void AccelerationInBlocks::CountLight()
{
  this->The.ledger = this->OfUncollided;
  std::vector<bool> lit(this->The.layout.channels, false);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    double entered = 0.0;
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      entered += this->Tally.in[face][c];
      ofSweep[face] = this->Tally.out[face][c];
      this->The.ledger.Enter(c, this->Tally.in[face][c]);
    }
    if (!(this->VoxelPower(c) > 0.0))
    {
      continue; // dark: never solved for
    }
    this->The.ledger.Absorb(c, this->Systems[c]->Absorbed());
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(entered, ofSweep);
    lit[c] = true;
    for (int face = 0; face < 6 && !this->Faces; ++face)
    {
      this->The.ledger.Escape(c, face, outflow[face]);
    }
  }
  if (this->Faces)
  {
    this->Faces->TakeLeaving(lit);
    this->Faces->OfBox().Count(this->The.ledger);
  }
}

/// As DiffusionAcceleration does.
void AccelerationInBlocks::WriteFluence()
{
  const VolumeLayout& own = this->The.layout;
  for (int c = 0; c < own.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->VoxelPower(c));
    }
  }
  this->CountLight();
  const std::vector<float> fluence = this->FluenceOfSystems();
  this->The.others.Collective([&] {
    if (!this->Block.Has())
    {
      return;
    }
    this->The.fluence.Write(fluence.data());
    if (this->The.flux.Size() > 0)
    {
      std::vector<float> all = this->The.flux.Read();
      const std::vector<float> found = this->FluxOfSystems();
      std::transform(all.begin(), all.end(), found.begin(), all.begin(), std::plus<float>());
      this->The.flux.Write(all.data());
      LimitFlux(own, fluence, this->The.flux);
    }
  });
}

/// @return with uncollided light, [channel][stride]
std::vector<float> AccelerationInBlocks::FluenceOfSystems()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> fluence, path;
  this->The.others.Collective([&] {
    if (!this->Block.Has())
    {
      return;
    }
    path = this->The.path.Read();
    fluence.resize(own.Floats(), 0.0f);
    for (int c = 0; c < own.channels; ++c)
    {
      const std::vector<double> solved = this->Systems[c]->Found();
      std::copy(solved.begin(), solved.end(), fluence.begin() + static_cast<std::ptrdiff_t>(c * own.Stride()));
    }
  });
  const Halo around(this->The.others, this->The.partition, this->The.settings.periodic, 1);
  MakeFluence(
    this->The.others, around, own, this->The.scene.medium.sigma_a, fluence, std::move(path), this->UncollidedFluence);
  return fluence;
}

/// The moments of degree 1 have less of the pattern of rays than the powers through faces.
std::vector<float> AccelerationInBlocks::FluxOfSystems() const
{
  if (this->Moments.Any())
  {
    return this->FluxOf(this->The.path);
  }
  Buffer<float> flux(this->The.device, this->Block.WithGhosts().Floats(3), "net_flux");
  flux.Fill(0.0f);
  for (int c = 0; c < this->The.layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->AddFlux(flux);
    }
  }
  return this->Block.TakeOwn(flux, 3 * this->The.layout.channels);
}

std::vector<double> AccelerationInBlocks::LeftByCell() const
{
  const BoundaryLight& boundary = this->The.boundary;
  return this->Faces->LeftByCell(
    boundary.Shines() ? boundary.IncomingPower() : std::array<Rgb, 6>{}, this->The.scene.medium);
}

std::vector<float> AccelerationInBlocks::FindSurfaceRadiance() const
{
  if (!this->LinearSource)
  {
    return {};
  }
  const VolumeLayout& own = this->The.layout;
  std::vector<SurfacePowers> powers;
  this->The.others.Collective([&] {
    for (int c = 0; c < own.channels && this->Block.Has(); ++c)
    {
      powers.push_back(this->VoxelPower(c) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers());
      powers.back().lamps = this->The.lamps.empty() ? nullptr : this->UncollidedFluence.data() + c * own.Stride();
    }
  });
  return SurfaceRadianceInBlocks(this->The.others, this->The.partition, this->The.scene.medium,
    this->The.settings.periodic, own.channels, this->The.lamps, powers);
}
}
