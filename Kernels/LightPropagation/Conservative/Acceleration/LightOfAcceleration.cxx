// What AccelerationInBlocks.h finds: its light and where the power went, of the last sweep and the systems' solution.

#include "LightPropagation/Conservative/Acceleration/AccelerationInBlocks.h"
#include "LightPropagation/Conservative/Acceleration/SurfaceInBlocks.h"
#include "LightPropagation/Conservative/NegativeFluence.h"
#include "LightPropagation/Diffusion/FluxLimit.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
void AccelerationInBlocks::TakeDirect()
{
  const VolumeLayout& own = this->Layout;
  std::vector<float> direct;
  this->TheDomain.Collective([&] {
    if (this->Parts.IsEmpty())
    {
      return;
    }
    std::vector<float> values = this->Parts.Path.Read();
    const double volume = own.grid.VoxelVolume();
    for (std::size_t i = 0; i < values.size() && i < this->UncollidedFluence.size(); ++i)
    {
      values[i] = std::max(static_cast<float>(values[i] / volume + this->UncollidedFluence[i]), 0.0f);
    }
    this->Parts.Fluence.Write(values.data());
    this->FluenceDirect = Interleaved(own, this->Parts.Fluence, 1.0);
    values.resize(own.Floats());
    direct = std::move(values);
  });
  if (this->Warm.Keeps())
  {
    this->Warm.Prepare(direct);
  }
}

void AccelerationInBlocks::CountLight()
{
  this->Ledger = this->OfUncollided;
  std::vector<bool> lit(this->Layout.channels, false);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    double entered = 0.0;
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      entered += this->Tally.in[face][c];
      ofSweep[face] = this->Tally.out[face][c];
      this->Ledger.Enter(c, this->Tally.in[face][c]);
    }
    if (!(this->VoxelPower(c) > 0.0))
    {
      continue; // dark: never solved for
    }
    this->Ledger.Absorb(c, this->Systems[c]->Absorbed());
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(entered, ofSweep);
    lit[c] = true;
    for (int face = 0; face < 6 && !this->Faces; ++face)
    {
      this->Ledger.Escape(c, face, outflow[face]);
    }
  }
  if (this->Faces)
  {
    this->Faces->TakeLeaving(lit);
    this->Faces->OfBox().Count(this->Ledger);
  }
}

/// As DiffusionAcceleration does.
void AccelerationInBlocks::WriteFluence()
{
  const VolumeLayout& own = this->Layout;
  for (int c = 0; c < own.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->VoxelPower(c));
    }
  }
  this->CountLight();
  const std::vector<float> fluence = this->FluenceOfSystems();
  this->TheDomain.Collective([&] {
    if (this->Parts.IsEmpty())
    {
      return;
    }
    this->Parts.Fluence.Write(fluence.data());
    if (this->Parts.Flux.Size() > 0)
    {
      std::vector<float> all = this->Parts.Flux.Read();
      const std::vector<float> found = this->FluxOfSystems();
      std::transform(all.begin(), all.end(), found.begin(), all.begin(), std::plus<float>());
      this->Parts.Flux.Write(all.data());
      LimitFlux(own, fluence, this->Parts.Flux);
    }
  });
}

/// @return with uncollided light, [channel][stride]
std::vector<float> AccelerationInBlocks::FluenceOfSystems()
{
  const VolumeLayout& own = this->Layout;
  std::vector<float> fluence, path;
  this->TheDomain.Collective([&] {
    if (this->Parts.IsEmpty())
    {
      return;
    }
    path = this->Parts.Path.Read();
    fluence.resize(own.Floats(), 0.0f);
    for (int c = 0; c < own.channels; ++c)
    {
      const std::vector<double> solved = this->Systems[c]->Found();
      std::copy(solved.begin(), solved.end(), fluence.begin() + static_cast<std::ptrdiff_t>(c * own.Stride()));
    }
  });
  const Halo around(this->TheDomain.Comm(), this->TheDomain.Partition(), this->Settings.periodic, 1);
  MakeFluence(
    this->TheDomain.Comm(), around, own, this->TheMedium.sigma_a, fluence, std::move(path), this->UncollidedFluence);
  return fluence;
}

/// The moments of degree 1 have less of the pattern of rays than the powers through faces.
std::vector<float> AccelerationInBlocks::FluxOfSystems() const
{
  if (this->Moments.Any())
  {
    return this->FluxOf(this->Parts.Path);
  }
  Buffer<float> flux(this->Parts.TheDevice, this->Block.WithGhosts().Floats(3), "net_flux");
  flux.Fill(0.0f);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    if (this->VoxelPower(c) > 0.0)
    {
      this->Systems[c]->AddFlux(flux);
    }
  }
  return this->Block.TakeOwn(flux, 3 * this->Layout.channels);
}

std::vector<double> AccelerationInBlocks::LeftByCell() const
{
  const BoundaryLight& boundary = (*this->Parts.UsualBoundary);
  return this->Faces->LeftByCell(boundary.Shines() ? boundary.IncomingPower() : std::array<Rgb, 6>{}, this->TheMedium);
}

std::vector<float> AccelerationInBlocks::FindSurfaceRadiance() const
{
  if (!this->LinearSource)
  {
    return {};
  }
  const VolumeLayout& own = this->Layout;
  std::vector<SurfacePowers> powers;
  this->TheDomain.Collective([&] {
    for (int c = 0; c < own.channels && !this->Parts.IsEmpty(); ++c)
    {
      powers.push_back(this->VoxelPower(c) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers());
      powers.back().lamps = this->Parts.Lamps.empty() ? nullptr : this->UncollidedFluence.data() + c * own.Stride();
    }
  });
  return SurfaceRadianceInBlocks(this->TheDomain.Comm(), this->TheDomain.Partition(), this->TheMedium,
    this->Settings.periodic, own.channels, this->Parts.Lamps, powers);
}
}
