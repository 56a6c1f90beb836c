#include "RefractiveMedium.h"

#include "../Medium/Medium.h"
#include "IndexField.h"
#include "MeshChecks.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr std::size_t WorkGroup = 256;
constexpr std::size_t ChunkVoxels = std::size_t(4) << 20; ///< whose coefficients are on the device at a time

void Demand(bool holds, const std::string& what)
{
  if (!holds)
  {
    throw InvalidInput(what);
  }
}

void CheckMaterial(const Material& material, const std::string& name)
{
  Demand(material.n > 0.0 && std::isfinite(material.n),
    name + " has the refractive index " + std::to_string(material.n) + "; it must be finite and above 0.");
  for (int c = 0; c < 3; ++c)
  {
    const double least = std::min(material.sigma_a[c], material.sigma_s[c]);
    const double sum = material.sigma_a[c] + material.sigma_s[c];
    Demand(least >= 0.0 && std::isfinite(sum),
      name + " has an absorption or scattering coefficient that is negative or not finite.");
  }
  Demand(std::abs(material.g) < 1.0,
    name + " has the mean cosine " + std::to_string(material.g) + "; it must lie between -1 and 1.");
}

void CheckPerturbation(const Perturbation& perturbation, const std::vector<Solid>& solids)
{
  Demand(perturbation.size > 0.0 && std::isfinite(perturbation.size),
    "The noise's size is " + std::to_string(perturbation.size) + "; it must be a positive length.");
  Demand(perturbation.scattering >= 0.0 && perturbation.scattering <= 1.0,
    "The noise of scattering is " + std::to_string(perturbation.scattering) + "; it must lie in [0, 1].");
  for (const Solid& solid : solids)
  {
    Demand(perturbation.index >= 0.0 && perturbation.index < solid.material.n,
      "The noise of the index is " + std::to_string(perturbation.index) +
        "; it must not be negative, and be less than " + std::to_string(solid.material.n) +
        ", the refractive index of " + solid.name + ".");
  }
}

void CheckSettings(const RefractiveMediumSettings& settings, const std::vector<Solid>& solids)
{
  Medium box;
  box.grid = settings.grid;
  Check(box);
  Check(settings.voxelization);
  CheckFilterSize(settings.filterSize);
  Demand(!solids.empty(), "There is no mesh.");
  CheckMaterial(settings.outside, "The outside");
  for (const Solid& solid : solids)
  {
    CheckMaterial(solid.material, solid.name);
  }
  CheckPerturbation(settings.perturbation, solids);
}

bool IsGrey(const Material& material)
{
  const auto grey = [](const Rgb& rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; };
  return grey(material.sigma_a) && grey(material.sigma_s);
}

double MeanOf(const Rgb& rgb)
{
  return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

/// Give materials one g. @return whether they had several
bool ShareMeanCosine(std::vector<Material*> materials, double& shared)
{
  materials.erase(std::remove_if(materials.begin(), materials.end(),
                    [](const Material* material) { return MeanOf(material->sigma_s) == 0.0; }),
    materials.end());
  if (materials.empty())
  {
    return false;
  }
  shared = materials[0]->g;
  const bool same =
    std::all_of(materials.begin(), materials.end(), [&](const Material* material) { return material->g == shared; });
  if (same)
  {
    return false;
  }
  double sum = 0.0;
  double weight = 0.0;
  for (const Material* material : materials)
  {
    sum += material->g * MeanOf(material->sigma_s);
    weight += MeanOf(material->sigma_s);
  }
  shared = sum / weight;
  for (Material* material : materials)
  {
    for (double& coefficient : material->sigma_s)
    {
      coefficient *= (1.0 - material->g) / (1.0 - shared);
    }
  }
  return true;
}

cl_float4 Float4(const std::array<double, 3>& values)
{
  return { { static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]), 0.0f } };
}

/// Mixes the materials in each voxel, some voxels at a time.
class Mixer
{
public:
  Mixer(Device& device, const RefractiveMediumSettings& settings, bool noise, int components)
    : TheDevice(device)
    , Settings(settings)
    , Components(components)
    , AtOnce(std::min(ChunkVoxels, settings.grid.VoxelCount()))
    , Covered(device, this->AtOnce, "occupancy")
    , SigmaA(device, this->AtOnce * components, "sigma_a")
    , SigmaS(device, this->AtOnce * components, "sigma_s")
  {
    const std::string options = "-DCHANNELS=" + std::to_string(components) + " -DNOISE=" + std::to_string(noise);
    const auto sources = { kernel_source::GradientNoise, kernel_source::Materials };
    this->AddObject = device.Kernel("add_object", sources, options);
    this->AddOutside = device.Kernel("add_outside", sources, options);
  }

  /// @param index  filled with n, not smoothed
  void Run(const std::vector<Solid>& solids, const Material& outside, const std::vector<Buffer<cl_ushort>>& inside,
    Buffer<float>& index, RefractiveMedium& result)
  {
    const std::size_t voxels = this->Settings.grid.VoxelCount();
    result.occupancy.resize(voxels);
    result.sigma_a.resize(voxels * this->Components);
    result.sigma_s.resize(voxels * this->Components);
    index.Fill(0.0f);
    for (std::size_t first = 0; first < voxels; first += this->AtOnce)
    {
      const std::size_t count = std::min(this->AtOnce, voxels - first);
      this->Mix(solids, outside, inside, index, first, count);
      this->Copy(this->Covered, result.occupancy, first, count);
      this->Copy(this->SigmaA, result.sigma_a, first * this->Components, count * this->Components);
      this->Copy(this->SigmaS, result.sigma_s, first * this->Components, count * this->Components);
    }
  }

private:
  void Mix(const std::vector<Solid>& solids, const Material& outside, const std::vector<Buffer<cl_ushort>>& inside,
    Buffer<float>& index, std::size_t first, std::size_t count)
  {
    const Perturbation& noise = this->Settings.perturbation;
    const Grid& grid = this->Settings.grid;
    const int edge = this->Settings.voxelization.samples;
    const float samples = static_cast<float>(edge * edge * edge);
    const cl_ulong begin = first;
    const cl_ulong number = count;
    this->Covered.Fill(0.0f);
    this->SigmaA.Fill(0.0f);
    this->SigmaS.Fill(0.0f);
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
      const Material& material = solids[s].material;
      With(this->AddObject, begin, number, inside[s], samples, static_cast<float>(material.n), Float4(material.sigma_a),
        Float4(material.sigma_s), static_cast<float>(noise.index), static_cast<float>(noise.scattering), noise.seed,
        static_cast<float>(1.0 / noise.size), Float4(grid.origin), Float4(grid.spacing), grid.size[0], grid.size[1],
        this->Covered, index, this->SigmaA, this->SigmaS);
      this->Launch(this->AddObject, count);
    }
    With(this->AddOutside, begin, number, samples, static_cast<float>(outside.n), Float4(outside.sigma_a),
      Float4(outside.sigma_s), this->Covered, index, this->SigmaA, this->SigmaS);
    this->Launch(this->AddOutside, count);
  }

  void Launch(cl::Kernel& kernel, std::size_t count)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange((count + WorkGroup - 1) / WorkGroup * WorkGroup), cl::NDRange(WorkGroup));
  }

  void Copy(const Buffer<float>& from, std::vector<float>& to, std::size_t first, std::size_t count)
  {
    this->TheDevice.Queue().enqueueReadBuffer(from.Handle(), CL_TRUE, 0, count * sizeof(float), to.data() + first);
  }

  Device& TheDevice;
  const RefractiveMediumSettings& Settings;
  int Components;
  std::size_t AtOnce;
  Buffer<float> Covered, SigmaA, SigmaS;
  cl::Kernel AddObject, AddOutside;
};

/// Whether nothing inside differs in n from the outside.
bool IndexIsEven(const std::vector<Solid>& solids, const RefractiveMediumSettings& settings)
{
  return settings.perturbation.index == 0.0 && std::all_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.material.n == settings.outside.n;
  });
}

/// Reports what is part of a longer work.
Monitor PartOf(const Monitor& monitor, double begin, double end)
{
  return [&monitor, begin, end](double done) { return !monitor || monitor(begin + done * (end - begin)); };
}

std::vector<std::string> CheckMeshes(
  Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings, const Monitor& monitor)
{
  std::vector<std::string> warnings;
  for (const Solid& solid : solids)
  {
    const MeshTopology topology = CheckClosed(solid.mesh, solid.name, settings.grid, settings.voxelization.samples);
    const std::vector<std::string> odd = Oddities(device, solid.mesh, topology, solid.name, settings.grid, monitor);
    warnings.insert(warnings.end(), odd.begin(), odd.end());
  }
  return warnings;
}

void AddIndex(Device& device, Buffer<float>& index, const RefractiveMediumSettings& settings, const Monitor& monitor,
  RefractiveMedium& result)
{
  SmoothIndex(device, settings.grid, settings.filterSize, index);
  result.ior = index.Read();
  result.iorGradient = IndexGradient(device, settings.grid, index, monitor);
}
}

Grid GridAround(const std::vector<Solid>& solids, const std::array<int, 3>& size, double margin, int filterSize)
{
  std::array<double, 3> low, high;
  low.fill(HUGE_VAL);
  high.fill(-HUGE_VAL);
  double longest = -HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const Solid& solid : solids)
    {
      for (const std::array<double, 3>& point : solid.mesh.points)
      {
        low[axis] = std::min(low[axis], point[axis]);
        high[axis] = std::max(high[axis], point[axis]);
      }
    }
    longest = std::max(longest, high[axis] - low[axis]);
    Demand(size[axis] >= 1, "The grid is to have " + std::to_string(size[axis]) + " voxels along " +
        std::string(1, "xyz"[axis]) + "; it needs at least one.");
  }
  Demand(longest > 0.0 && std::isfinite(longest), "There is no mesh, or none with an extent, to put a box around.");
  Demand(margin >= 0.0 && std::isfinite(margin),
    "The margin is " + std::to_string(margin) + "; it must be finite and not negative.");

  const int reach = filterSize / 2 + 1;
  double edge = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = high[axis] - low[axis];
    const int free = size[axis] - 2 * reach;
    edge = std::max({ edge, (length + 2.0 * margin * longest) / size[axis], length / (free > 0 ? free : size[axis]) });
  }
  Grid grid;
  grid.size = size;
  grid.spacing.fill(edge);
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.origin[axis] = 0.5 * (low[axis] + high[axis]) - 0.5 * edge * size[axis];
  }
  return grid;
}

RefractiveMedium Voxelize(
  Device& device, std::vector<Solid> solids, const RefractiveMediumSettings& settings, const Monitor& monitor)
{
  const auto start = std::chrono::steady_clock::now();
  CheckSettings(settings, solids);
  RefractiveMedium result;
  result.device = device.Name();
  result.warnings = CheckMeshes(device, solids, settings, PartOf(monitor, 0.0, 0.2));

  std::vector<const TriangleMesh*> meshes;
  Material outside = settings.outside;
  std::vector<Material*> materials = { &outside };
  for (Solid& solid : solids)
  {
    meshes.push_back(&solid.mesh);
    materials.push_back(&solid.material);
  }
  if (ShareMeanCosine(materials, result.g))
  {
    result.leftOut.push_back("a g of each material: there is one g, and sigma_s (1 - g) is that of the material");
  }
  const bool grey = std::all_of(materials.begin(), materials.end(), [](const Material* m) { return IsGrey(*m); });
  result.components = grey ? 1 : 3;

  const std::vector<Buffer<cl_ushort>> inside =
    CountSamplesInside(device, settings.grid, meshes, settings.voxelization, PartOf(monitor, 0.2, 0.6));
  Buffer<float> index(device, settings.grid.VoxelCount(), "ior");
  const bool noise = settings.perturbation.index > 0.0 || settings.perturbation.scattering > 0.0;
  Mixer(device, settings, noise, result.components).Run(solids, outside, inside, index, result);
  Report(monitor, 0.8);

  const bool empty =
    std::all_of(result.occupancy.begin(), result.occupancy.end(), [](float part) { return part == 0.0f; });
  if (empty)
  {
    result.warnings.push_back("Nothing of the box is inside a mesh, or what is falls between its samples. Compare the "
                              "box with the meshes' bounds.");
  }
  if (empty || IndexIsEven(solids, settings))
  {
    result.leftOut.push_back("ior, ior_gradient: the refractive index is " + std::to_string(outside.n) + " everywhere");
  }
  else
  {
    AddIndex(device, index, settings, PartOf(monitor, 0.8, 1.0), result);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}
}
