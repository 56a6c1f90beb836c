// What AccelerationInBlocks.h finds: its light and where the power went, of the last sweep and the systems' solution.

#include "LightPropagation/Diffusion/FluxLimit.h"
#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"
#include "LightPropagation/Distributed/Balance/SurfaceInBlocks.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
void AccelerationInBlocks::TakeDirect()
{
  const VolumeLayout& own = this->The.layout;
  std::vector<float> direct;
  this->The.others.Together([&] {
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

/// Where the system's solution is negative, the fluence of the last sweep stands.
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
  this->The.others.Together([&] {
    if (!this->Block.Has())
    {
      return;
    }
    const double perVolume = 1.0 / own.grid.VoxelVolume();
    const std::vector<float> path = this->The.path.Read();
    std::vector<float> fluence(path.size(), 0.0f);
    const bool withFlux = this->The.flux.Size() > 0;
    Buffer<float> flux(this->The.device, withFlux ? this->Block.WithGhosts().Floats(3) : 0, "net_flux");
    flux.Fill(0.0f);
    for (int c = 0; c < own.channels; ++c)
    {
      const std::vector<double> solved = this->Systems[c]->Found();
      for (std::size_t i = 0; i < solved.size(); ++i)
      {
        const std::size_t at = c * own.Stride() + i;
        const double found = solved[i] >= 0.0 ? solved[i] : path[at] * perVolume;
        fluence[at] = std::max(static_cast<float>(found + this->UncollidedFluence[at]), 0.0f);
      }
      if (withFlux && !this->Moments.Any() && this->VoxelPower(c) > 0.0)
      {
        this->Systems[c]->AddFlux(flux);
      }
    }
    this->The.fluence.Write(fluence.data());
    if (withFlux)
    {
      std::vector<float> all = this->The.flux.Read();
      // The moments of degree 1 have less of the pattern of rays than the powers through faces.
      const std::vector<float> found =
        this->Moments.Any() ? this->FluxOf(this->The.path) : this->Block.TakeOwn(flux, 3 * own.channels);
      std::transform(all.begin(), all.end(), found.begin(), all.begin(), std::plus<float>());
      this->The.flux.Write(all.data());
      LimitFlux(own, fluence, this->The.flux);
    }
  });
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
  this->The.others.Together([&] {
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
