#include "LightPropagation/Emission/UncollidedEmission.h"

#include "LightPropagation/Emission/EmissionRays.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/NarrowLight.h"

#include <algorithm>
#include <cmath>
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
  if (!volume.basis)
  {
    return this->Put(volume, monitor);
  }
  const NarrowLight light(volume, true);
  UncollidedVolume apart = volume;
  apart.deposit = light.To();
  const SweepTally tally = this->Put(apart, monitor);
  light.AddAlongFlux();
  return tally;
}

SweepTally UncollidedEmission::Put(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    return DepositEmission(volume.device, ofChannels, first, this->Peak, this->Error, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
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
