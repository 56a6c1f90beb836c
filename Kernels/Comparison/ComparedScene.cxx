#include "Comparison/ComparedScene.h"

#include "Device/Errors.h"
#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
std::optional<Factors> CoarseningBy(int factor, const Grid& grid)
{
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    factors[axis] = grid.size[axis] == 1 ? 1 : factor;
    if (grid.size[axis] % factors[axis] != 0)
    {
      return std::nullopt;
    }
  }
  return factors;
}

Grid Coarsened(const Grid& fine, const Factors& factors)
{
  Grid coarse = fine;
  for (int axis = 0; axis < 3; ++axis)
  {
    coarse.size[axis] = fine.size[axis] / factors[axis];
    coarse.spacing[axis] = fine.spacing[axis] * factors[axis];
  }
  return coarse;
}

std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse)
{
  constexpr double part = 1e-3;
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(fine.origin[axis] - coarse.origin[axis]);
    const double high = std::abs(fine.origin[axis] + fine.Length(axis) - coarse.origin[axis] - coarse.Length(axis));
    if (fine.size[axis] % coarse.size[axis] != 0 || std::max(low, high) > part * fine.spacing[axis])
    {
      return std::nullopt;
    }
    factors[axis] = fine.size[axis] / coarse.size[axis];
  }
  return factors;
}

std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors)
{
  return Coarsening(fine, Coarsened(fine, factors)).Average(values, components);
}

bool ComparedScene::BendsLight() const
{
  const float* const ior = this->ior.values;
  return ior && std::any_of(ior, ior + this->medium.grid.VoxelCount(), [=](float index) { return index != ior[0]; });
}

bool ComparedScene::Emits() const
{
  const Field& emission = this->medium.emission;
  const std::size_t count = this->medium.grid.VoxelCount() * static_cast<std::size_t>(emission.components);
  return emission.values &&
    std::any_of(emission.values, emission.values + count, [](float value) { return value > 0.0f; });
}

std::string ComparedScene::WhyNotByPhotons(bool all) const
{
  const bool goesRound = this->periodic[0] || this->periodic[1] || this->periodic[2];
  return !Shines(this->illumination)      ? "photons are made of lights, and nothing shines on this medium"
    : this->Emits()                       ? "photons are made of lights, and this medium emits"
    : goesRound                           ? "photons do not return on the other side of periodic axes"
    : all && Reflects(this->illumination) ? "photons do not come back from faces that give back light"
                                          : "";
}

namespace
{
constexpr double Alike = 1e-5; ///< largest relative difference of the coefficients of one material

/// Indices of the voxels that have this occupancy.
std::vector<std::size_t> VoxelsWith(float occupancy, const Grid& grid, const Field& occupancies)
{
  std::vector<std::size_t> voxels;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    if (occupancies.At(i, 0) == occupancy)
    {
      voxels.push_back(i);
    }
  }
  return voxels;
}

/// The value that all voxels of a material have in a channel.
double OnlyValueOf(const Field& field, int channel, const std::vector<std::size_t>& voxels, const char* name)
{
  const float first = field.At(voxels.front(), channel);
  for (std::size_t voxel : voxels)
  {
    if (std::abs(field.At(voxel, channel) - first) > Alike * std::abs(first))
    {
      throw InvalidInput(std::string("The Mesh is of one material, and so is what is outside of it; but voxels of the "
                                     "medium that are entirely on one side of it differ in ") +
        name + ". Disconnect Mesh, or voxelise one mesh without noise.");
    }
  }
  return first;
}

Material MaterialIn(const Medium& medium, const std::vector<std::size_t>& voxels)
{
  Material material;
  for (int channel = 0; channel < 3; ++channel)
  {
    material.sigma_a[channel] = OnlyValueOf(medium.sigma_a, channel, voxels, "sigma_a");
    material.sigma_s[channel] = OnlyValueOf(medium.sigma_s, channel, voxels, "sigma_s");
  }
  material.g = medium.phase.MeanCosine(voxels.front(), 0);
  return material;
}
}

VoxelizedMaterials MaterialsOf(const Medium& medium, const Field& ior, const Field& occupancy, TriangleMesh&& mesh)
{
  const std::vector<std::size_t> inside = VoxelsWith(1.0f, medium.grid, occupancy),
                                 outside = VoxelsWith(0.0f, medium.grid, occupancy);
  Require(!inside.empty() && !outside.empty(),
    "No voxel of the medium is entirely inside, or none is entirely outside the Mesh, so that its "
    "material is not known. Use smaller voxels.");
  VoxelizedMaterials materials = { { "The mesh", std::move(mesh), MaterialIn(medium, inside) },
    MaterialIn(medium, outside) };
  CheckClosed(materials.inside.mesh, materials.inside.name, medium.grid, VoxelizationSettings().samples);
  if (ior.values)
  {
    // The index is smoothed across the surface, so the indices of the two materials are its extremes.
    const auto less = [&](std::size_t a, std::size_t b) { return ior.values[a] < ior.values[b]; };
    const auto in = std::minmax_element(inside.begin(), inside.end(), less);
    const auto out = std::minmax_element(outside.begin(), outside.end(), less);
    const bool denser = ior.values[*in.second] > ior.values[*out.first];
    materials.inside.material.n = ior.values[denser ? *in.second : *in.first];
    materials.outside.n = ior.values[denser ? *out.first : *out.second];
  }
  return materials;
}

namespace
{
RefractiveMediumSettings SettingsOn(
  const ComparedScene& scene, int refinement, const VoxelizationSettings& voxelization, int filterSize)
{
  RefractiveMediumSettings settings;
  settings.grid = Refined(scene.medium.grid, { refinement, refinement, refinement });
  settings.outside = scene.mesh->outside;
  settings.voxelization = voxelization;
  settings.filterSize = filterSize;
  return settings;
}
}

VoxelizedScene::VoxelizedScene(Device& device, const ComparedScene& scene, int refinement,
  const VoxelizationSettings& voxelization, int filterSize, const Monitor& monitor)
  : Voxelized(scene)
{
  const RefractiveMediumSettings settings = SettingsOn(scene, refinement, voxelization, filterSize);
  this->Voxels = Voxelize(device, { scene.mesh->inside }, settings, monitor);
  this->Voxelized.medium.grid = settings.grid;
  this->Voxelized.medium.sigma_a = { this->Voxels.sigma_a.data(), this->Voxels.components };
  this->Voxelized.medium.sigma_s = { this->Voxels.sigma_s.data(), this->Voxels.components };
  this->Voxelized.ior = { this->Voxels.ior.empty() ? nullptr : this->Voxels.ior.data() };
  this->Voxelized.levels = nullptr;
  if (!this->Voxels.gByVoxel.empty())
  {
    this->Voxelized.medium.phase = scene.medium.phase.WithG({ this->Voxels.gByVoxel.data(), this->Voxels.components });
  }
}
}
