#include "LightPropagation/Emission/UncollidedEmission.h"

#include "Distribution/BoxExchange.h"
#include "LightPropagation/Emission/EmissionRays.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/NarrowLight.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double Empty = 1e-4; ///< maximum optical thickness of an empty voxel
/// Largest number of voxels of a grid in which emission from empty voxels is swept separately.
constexpr std::size_t MostVoxels = std::size_t(1) << 21;
constexpr int FewestPerEdge = 12;      ///< minimum number of directions along the edge of a cube's face
constexpr double RaysOfVoxel = 2304.0; ///< approximate number of rays per voxel along all directions of a cube's face
/// Maximum number of rays, summed over all voxels and all directions of a cube's face; at least one per voxel and
/// direction is traced.
constexpr double RaysOfGrid = 64e6;
}

UncollidedEmission::UncollidedEmission(EmissionPeak peak, double error)
  : Peak(std::move(peak))
  , Error(error)
{
}

SweepTally UncollidedEmission::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  std::optional<NarrowLight> light;
  Deposit deposit = volume.deposit;
  volume.domain.Collective([&] {
    if (volume.basis)
    {
      light.emplace(volume, true);
      deposit = light->To();
    }
  });
  UncollidedVolume apart = volume;
  apart.deposit = deposit;
  const SweepTally tally = volume.domain.IsSerial() ? this->Put(apart, monitor) : this->PutOnRanks(apart, monitor);
  if (light)
  {
    light->AddAlongFlux();
  }
  return tally;
}

SweepTally UncollidedEmission::Put(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    return DepositEmission(volume.device, ofChannels, first, this->Peak, this->Error, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}

namespace
{
/// Extinction of the whole domain in the layout `whole`, from that of this rank's block. Collective.
std::vector<float> WholeExtinction(const UncollidedVolume& volume, const VolumeLayout& whole)
{
  const Domain& domain = volume.domain;
  const int extinctions = whole.sharedExtinction ? 1 : whole.channels;
  const std::size_t voxels = domain.Own().VoxelCount();
  std::vector<float> block, all(whole.FloatsOf(extinctions), 0.0f);
  domain.Collective([&] { block = volume.sigma_t.Read(); });
  for (int c = 0; c < extinctions; ++c)
  {
    const auto begin = block.begin() + static_cast<std::ptrdiff_t>(volume.layout.ExtinctionFirst(c));
    const std::vector<float> values =
      ValuesOfGrid(domain.Comm(), domain.Partition(), { begin, begin + static_cast<std::ptrdiff_t>(voxels) }, 1);
    std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(whole.ExtinctionFirst(c)));
  }
  return all;
}

/// Adds the elements of an array over the whole domain that belong to this rank's voxels to an array over this rank's
/// block. Each channel and voxel has `parts` values.
void AddOwn(const UncollidedVolume& volume, const VolumeLayout& whole, int parts, const Buffer<float>& from,
  const Buffer<float>& to)
{
  const VoxelBox& own = volume.domain.Own();
  const std::vector<float> found = from.Read();
  std::vector<float> sums = to.Read();
  for (int part = 0; part < parts * whole.channels; ++part)
  {
    for (std::size_t i = 0; i < own.VoxelCount(); ++i)
    {
      sums[part * volume.layout.Stride() + i] += found[part * whole.Stride() + whole.grid.IndexOf(own.VoxelAt(i))];
    }
  }
  to.CopyFrom(Buffer<float>(volume.device, sums, "the light of what shines"), 0, sums.size());
  volume.device.Finish(); // the copy must end before its source is released
}

/// For each power of the tally, the largest value of any rank. The values differ by rounding if ranks have different
/// devices. Collective.
SweepTally LargestOf(const Domain& domain, const SweepTally& own)
{
  std::vector<double> powers(own.onTheWay.begin(), own.onTheWay.end());
  for (const Rgb& face : own.out)
  {
    powers.insert(powers.end(), face.begin(), face.end());
  }
  powers = domain.Max(powers);
  SweepTally all;
  std::copy_n(powers.begin(), 3, all.onTheWay.begin());
  for (std::size_t face = 0; face < all.out.size(); ++face)
  {
    std::copy_n(powers.begin() + static_cast<std::ptrdiff_t>(3 * (face + 1)), 3, all.out[face].begin());
  }
  return all;
}
}

SweepTally UncollidedEmission::PutOnRanks(const UncollidedVolume& volume, const Monitor& monitor) const
{
  VolumeLayout whole = volume.layout;
  whole.grid = volume.domain.Whole();
  const std::vector<float> extinction = WholeExtinction(volume, whole);
  SweepTally tally;
  volume.domain.Collective([&] {
    // Ranks without voxels also trace the rays, because every rank holds the light at the faces of the whole domain.
    const Buffer<float> sigma_t(volume.device, extinction, "sigma_t of the whole domain");
    Buffer<float> path(volume.device, whole.Floats(), "the light of what shines");
    Buffer<float> flux(volume.device, volume.deposit.flux ? whole.Floats(3) : 0, "its net flux");
    path.Fill(0.0f);
    flux.Fill(0.0f);
    UncollidedVolume all = { volume.device, volume.domain, whole, sigma_t, volume.periodic, volume.makeSweep, {} };
    all.deposit.path = &path;
    all.deposit.flux = volume.deposit.flux ? &flux : nullptr;
    all.deposit.faceOut = volume.deposit.faceOut; // of the whole domain on every rank
    tally = this->Put(all, monitor);
    AddOwn(volume, whole, 1, path, *volume.deposit.path);
    if (volume.deposit.flux)
    {
      AddOwn(volume, whole, 3, flux, *volume.deposit.flux);
    }
  });
  return LargestOf(volume.domain, tally);
}

bool VacuumEmission::IsApart(const Grid& whole, const PropagationSettings& settings)
{
  return settings.emissionError > 0.0 && whole.VoxelCount() <= MostVoxels;
}

bool VacuumEmission::IsEmpty(double sigma_t, const Grid& grid)
{
  return sigma_t * *std::max_element(grid.spacing.begin(), grid.spacing.end()) <= Empty;
}

/// Uses an even number of directions along the edge of a cube's face: then no direction is parallel to an axis, which
/// may be periodic.
std::unique_ptr<const SweptDirections> VacuumEmission::DirectionsFor(
  const Grid& whole, const PropagationSettings& settings)
{
  const int asked = static_cast<int>(std::lround(std::sqrt(static_cast<double>(settings.directionsPerFace))));
  const int edge = std::max(FewestPerEdge, asked + asked % 2), perFace = edge * edge;
  // Along a periodic axis each ray crosses the grid many times
  const bool around = settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
  const double rays = around ? perFace : std::min(RaysOfVoxel, RaysOfGrid / static_cast<double>(whole.VoxelCount()));
  PropagationSettings finer = settings;
  finer.mapResolution = std::max(settings.mapResolution, static_cast<int>(std::sqrt(rays / perFace)));
  return std::make_unique<SweptDirections>(whole, finer, EquiangularDirections(perFace), RayStarts::Staggered);
}

VacuumEmission::VacuumEmission(const SweptDirections& along, std::vector<float> emission)
  : Along(along)
  , Emission(std::move(emission))
{
}

SweepTally VacuumEmission::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  Buffer<float> source;
  volume.domain.Collective([&] {
    const int functions = volume.basis ? volume.basis->Count() : 1;
    source = Buffer<float>(volume.device, volume.layout.MomentFloats(functions), "what empty voxels emit");
    source.Fill(0.0f);
    source.Write(this->Emission.data(), this->Emission.size() - SweepPadding);
  });
  return SweepAlong(
    volume, this->Along, [](int) { return true; }, &source, {}, monitor);
}
}
