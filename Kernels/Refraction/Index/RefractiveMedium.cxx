#include "Refraction/Index/RefractiveMedium.h"

#include "Device/Defines.h"
#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexField.h"
#include "Refraction/Index/IndexRange.h"
#include "Refraction/Voxelization/MaterialsShared.h"
#include "Refraction/Voxelization/MeshChecks.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace tyndall
{
namespace
{
constexpr std::size_t WorkGroup = 256;
constexpr double ShortestEdge = 1e-18; ///< of a voxel, length
}

void Check(const Material& material, const std::string& name)
{
  Require(material.n >= LeastIndex && material.n <= LargestIndex,
    name + " has the refractive index " + Text("%.6g", material.n) +
      "; it must be finite and above 0, from 1e-6 to 1e6.");
  for (int c = 0; c < 3; ++c)
  {
    const double least = std::min(material.sigma_a[c], material.sigma_s[c]);
    const double sum = material.sigma_a[c] + material.sigma_s[c];
    Require(least >= 0.0 && sum <= LargestExtinction,
      name +
        " has an absorption or scattering coefficient that is negative or not finite, or both add up to more than "
        "1e37: " +
        Text("%.6g", material.sigma_a[c]) + " and " + Text("%.6g", material.sigma_s[c]) + ".");
  }
  Require(std::abs(static_cast<float>(material.g)) < 1.0f,
    name + " has the mean cosine " + std::to_string(material.g) + "; it must lie between -1 and 1.");
}

namespace
{
void CheckPerturbation(const Perturbation& perturbation, const std::vector<Solid>& solids)
{
  Require(perturbation.size > 0.0 && std::isfinite(perturbation.size),
    "The noise's size is " + std::to_string(perturbation.size) + "; it must be a positive length.");
  Require(perturbation.scattering >= 0.0 && perturbation.scattering <= 1.0,
    "The noise of scattering is " + std::to_string(perturbation.scattering) + "; it must lie in [0, 1].");
  for (const Solid& solid : solids)
  {
    Require(perturbation.index >= 0.0 && perturbation.index < solid.material.n,
      "The noise of the index is " + std::to_string(perturbation.index) +
        "; it must not be negative, and be less than " + std::to_string(solid.material.n) +
        ", the refractive index of " + solid.name + ".");
  }
}

/// Quantities of an area or a volume of voxels are in single precision: 1/edge^2 has to be.
void CheckSpacing(const Grid& grid)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double edge = grid.spacing[axis];
    Require(edge >= ShortestEdge && edge <= 1.0 / ShortestEdge,
      "The voxels' edge along " + std::string(1, "xyz"[axis]) + " is " + Text("%.6g", edge) +
        "; it must be from 1e-18 to 1e18, or fluence (W/length^2) is beyond single precision. Scale the mesh, "
        "and the box with it: use another unit of length.");
  }
}

void CheckSettings(const RefractiveMediumSettings& settings, const std::vector<Solid>& solids)
{
  Medium box;
  box.grid = settings.grid;
  Check(box);
  CheckSpacing(settings.grid);
  Check(settings.voxelization);
  CheckFilterSize(settings.filterSize);
  Require(!solids.empty(), "There is no mesh.");
  Check(settings.outside, "The outside");
  for (const Solid& solid : solids)
  {
    Check(solid.material, solid.name);
  }
  CheckPerturbation(settings.perturbation, solids);
}

/// @param coefficients  of a voxel: sigma_a, sigma_s and, where it varies, g
/// @param indexVaries   whether there is an index to smooth and take the gradient of
void CheckMemory(const Device& device, const RefractiveMediumSettings& settings, int coefficients, bool indexVaries)
{
  const std::array<int, 3>& size = settings.grid.size;
  const double voxels = static_cast<double>(size[0]) * size[1] * size[2];
  const int ofResult = static_cast<int>(sizeof(float)) * (1 + coefficients + (indexVaries ? 4 : 0));
  const int onDevice = static_cast<int>(sizeof(float)) * (indexVaries && settings.filterSize > 1 ? 2 : 1);
  const std::string box = "A box of " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
    std::to_string(size[2]) + " voxels (SampleDimensions)";
  RequireHostMemory((ofResult + (device.IsCpu() ? onDevice : 0)) * voxels,
    box + ", " + std::to_string(ofResult) + " bytes each and " + std::to_string(onDevice) + " on the device,",
    "Ask for fewer voxels.");
  const double left = static_cast<double>(device.MemoryLimit() - device.BytesInUse());
  const double most = std::min(left, static_cast<double>(device.AllocationLimit()) * onDevice / sizeof(float));
  if (onDevice * voxels > most)
  {
    char bytes[64];
    std::snprintf(bytes, sizeof(bytes), "%.0f bytes on ", onDevice * voxels);
    throw DeviceError(box + " needs " + bytes + device.Name() + ", which can give " +
      std::to_string(static_cast<std::size_t>(most)) + ". Ask for fewer voxels, or use a device with more memory.");
  }
}

bool IsGrey(const Material& material)
{
  const auto grey = [](const Rgb& rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; };
  return grey(material.sigma_a) && grey(material.sigma_s);
}

/// Whether materials that scatter have different mean cosines.
/// @param g  where they have not, the one they have; unchanged where none scatters
bool MeanCosineVaries(const std::vector<const Material*>& materials, double& g)
{
  const Material* first = nullptr;
  for (const Material* material : materials)
  {
    const bool scatters = *std::max_element(material->sigma_s.begin(), material->sigma_s.end()) > 0.0;
    if (scatters && first && material->g != first->g)
    {
      return true;
    }
    first = scatters && !first ? material : first;
  }
  g = first ? first->g : g;
  return false;
}

/// Mixes the materials in each voxel, slab by slab.
class Mixer
{
public:
  /// @param variedG  whether materials that scatter have different mean cosines
  /// @param index    filled with n, not smoothed
  Mixer(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings, bool variedG,
    Buffer<float>& index, RefractiveMedium& result)
    : TheDevice(device)
    , Solids(solids)
    , Settings(settings)
    , VariedG(variedG)
    , Index(index)
    , Result(result)
  {
    const bool noise = settings.perturbation.index > 0.0 || settings.perturbation.scattering > 0.0;
    const std::string options =
      Define("CHANNELS", result.components) + Define("NOISE", noise) + Define("VARIED_G", variedG);
    this->AddObject = device.Kernel("add_object", kernel_source::Materials, options);
    this->AddOutside = device.Kernel("add_outside", kernel_source::Materials, options);
    const std::size_t voxels = settings.grid.VoxelCount();
    result.occupancy.resize(voxels);
    result.sigma_a.resize(voxels * result.components);
    result.sigma_s.resize(voxels * result.components);
    result.gByVoxel.resize(variedG ? voxels * result.components : 0);
    index.Fill(0.0f);
  }

  /// What CountSamplesInside hands out.
  void Take(const SamplesInside& inside)
  {
    if (inside.mesh + 1 == this->Solids.size())
    {
      this->Begin(inside.VoxelCount());
    }
    this->Add(inside);
    if (inside.mesh == 0)
    {
      this->End(inside);
    }
  }

private:
  void Begin(std::size_t voxels)
  {
    if (this->Covered.Size() < voxels)
    {
      const std::size_t values = voxels * this->Result.components;
      this->Covered = Buffer<float>(this->TheDevice, voxels, "occupancy");
      this->SigmaA = Buffer<float>(this->TheDevice, values, "sigma_a");
      this->SigmaS = Buffer<float>(this->TheDevice, values, "sigma_s");
      this->G = Buffer<float>(this->TheDevice, this->VariedG ? values : 0, "g");
    }
    this->Covered.Fill(0.0f);
    this->SigmaA.Fill(0.0f);
    this->SigmaS.Fill(0.0f);
    if (this->VariedG)
    {
      this->G.Fill(0.0f);
    }
  }

  void Add(const SamplesInside& inside)
  {
    MaterialInfo material = MaterialOf(this->Solids[inside.mesh].material);
    const Perturbation& noise = this->Settings.perturbation;
    material.indexNoise = static_cast<float>(noise.index);
    material.scatteringNoise = static_cast<float>(noise.scattering);
    material.frequency = static_cast<float>(1.0 / noise.size);
    material.seed = noise.seed;
    With(this->AddObject, this->SlabOf(inside), material, inside.counts, this->Covered, this->Index, this->SigmaA,
      this->SigmaS, this->G);
    this->Launch(this->AddObject, inside);
  }

  void End(const SamplesInside& inside)
  {
    With(this->AddOutside, this->SlabOf(inside), MaterialOf(this->Settings.outside), this->Covered, this->Index,
      this->SigmaA, this->SigmaS, this->G);
    this->Launch(this->AddOutside, inside);
    this->Copy(this->Covered, inside, 1, this->Result.occupancy);
    this->Copy(this->SigmaA, inside, this->Result.components, this->Result.sigma_a);
    this->Copy(this->SigmaS, inside, this->Result.components, this->Result.sigma_s);
    if (this->VariedG)
    {
      this->Copy(this->G, inside, this->Result.components, this->Result.gByVoxel);
    }
  }

  static MaterialInfo MaterialOf(const Material& material)
  {
    MaterialInfo info = {};
    info.absorption = Float4(Vector(material.sigma_a));
    info.scattering = Float4(Vector(material.sigma_s));
    info.n = static_cast<float>(material.n);
    info.g = static_cast<float>(material.g);
    return info;
  }

  MaterialSlab SlabOf(const SamplesInside& inside) const
  {
    const Grid& grid = this->Settings.grid;
    return { Float4(Vector(grid.origin)), Float4(Vector(grid.spacing)), inside.first, inside.length, inside.stride,
      grid.size[0], grid.size[1], this->SamplesOfVoxel() };
  }

  float SamplesOfVoxel() const
  {
    const int edge = this->Settings.voxelization.samples;
    return static_cast<float>(edge * edge * edge * UnitsOfSample(edge));
  }

  void Launch(cl::Kernel& kernel, const SamplesInside& inside)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(RoundUp(inside.length, WorkGroup), inside.runs), cl::NDRange(WorkGroup, 1));
  }

  void Copy(const Buffer<float>& from, const SamplesInside& inside, int components, std::vector<float>& to)
  {
    const std::size_t bytes = inside.length * components * sizeof(float);
    for (std::size_t run = 0; run < inside.runs; ++run)
    {
      this->TheDevice.Queue().enqueueReadBuffer(
        from.Handle(), CL_TRUE, run * bytes, bytes, to.data() + (inside.first + run * inside.stride) * components);
    }
  }

  Device& TheDevice;
  const std::vector<Solid>& Solids;
  const RefractiveMediumSettings& Settings;
  const bool VariedG;
  Buffer<float>& Index;
  RefractiveMedium& Result;
  Buffer<float> Covered, SigmaA, SigmaS, G; ///< of a slab
  cl::Kernel AddObject, AddOutside;
};

/// Whether nothing inside differs in n from the outside.
bool IndexIsEven(const std::vector<Solid>& solids, const RefractiveMediumSettings& settings)
{
  return settings.perturbation.index == 0.0 && std::all_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.material.n == settings.outside.n;
  });
}

std::vector<MeshTopology> CheckMeshes(
  const std::vector<Solid>& solids, const RefractiveMediumSettings& settings, const Monitor& monitor)
{
  std::vector<MeshTopology> topologies;
  for (const Solid& solid : solids)
  {
    Report(monitor, static_cast<double>(topologies.size()) / solids.size());
    topologies.push_back(CheckClosed(solid.mesh, solid.name, settings.grid, settings.voxelization.samples));
  }
  return topologies;
}

/// Voxelises the meshes into everything but what comes of the smoothed index.
void FillVoxels(Device& device, const std::vector<Solid>& solids, const std::vector<MeshTopology>& topologies,
  const RefractiveMediumSettings& settings, Mixer& mixer, const Monitor& monitor, RefractiveMedium& result)
{
  std::vector<OrientedMesh> meshes;
  for (std::size_t s = 0; s < solids.size(); ++s)
  {
    meshes.push_back({ &solids[s].mesh, Orientation(topologies[s]) });
  }
  const std::vector<WindingNumbers> windings = CountSamplesInside(
    device, settings.grid, meshes, settings.voxelization, [&](const SamplesInside& inside) { mixer.Take(inside); },
    monitor);
  for (std::size_t s = 0; s < solids.size(); ++s)
  {
    const std::vector<std::string> odd =
      Oddities(topologies[s], windings[s], solids[s].name, settings.grid, settings.voxelization.samples);
    result.warnings.insert(result.warnings.end(), odd.begin(), odd.end());
  }
}

void CheckPointsOf(const Solid& solid)
{
  try
  {
    CheckPoints(solid.mesh);
  }
  catch (const InvalidInput& error)
  {
    throw InvalidInput(solid.name + " cannot be used. " + error.what());
  }
}

/// What there is of meshes that have no extent, for a message.
std::string WithoutExtent(const std::vector<Solid>& solids)
{
  std::string text;
  for (const Solid& solid : solids)
  {
    const std::size_t triangles = solid.mesh.triangles.size();
    const std::size_t edges = triangles > 0 ? Examine(solid.mesh).boundaryEdges : 0;
    text += " " + solid.name + " has " + std::to_string(triangles) + " triangles and " + std::to_string(edges) +
      " boundary edges.";
  }
  return text;
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
  for (const Solid& solid : solids)
  {
    CheckPointsOf(solid);
  }
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
    Require(size[axis] >= 1,
      "The grid is to have " + std::to_string(size[axis]) + " voxels along " + std::string(1, "xyz"[axis]) +
        "; it needs at least one.");
  }
  Require(longest > 0.0, "There is no mesh, or none with an extent, to put a box around." + WithoutExtent(solids));
  Require(std::isfinite(longest), "The meshes reach further than a number can say. Scale them.");
  Require(margin >= 0.0 && std::isfinite(margin),
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
  Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings, const Monitor& monitor)
{
  const auto start = std::chrono::steady_clock::now();
  CheckSettings(settings, solids);
  RefractiveMedium result;
  result.device = device.Name();
  std::vector<const Material*> materials = { &settings.outside };
  for (const Solid& solid : solids)
  {
    materials.push_back(&solid.material);
  }
  const bool variedG = MeanCosineVaries(materials, result.g);
  const bool grey = std::all_of(materials.begin(), materials.end(), [](const Material* m) { return IsGrey(*m); });
  result.components = grey ? 1 : 3;
  const bool even = IndexIsEven(solids, settings);
  CheckMemory(device, settings, (variedG ? 3 : 2) * result.components, !even);

  const std::vector<MeshTopology> topologies = CheckMeshes(solids, settings, OfPart(monitor, 0.0, 0.2));
  Buffer<float> index(device, settings.grid.VoxelCount(), "ior");
  Mixer mixer(device, solids, settings, variedG, index, result);
  FillVoxels(device, solids, topologies, settings, mixer, OfPart(monitor, 0.2, 0.8), result);

  const bool empty =
    std::all_of(result.occupancy.begin(), result.occupancy.end(), [](float part) { return part == 0.0f; });
  if (empty)
  {
    result.warnings.push_back("Nothing of the box is inside a mesh, or what is falls between its samples. Compare the "
                              "box with the meshes' bounds.");
  }
  if (empty || even)
  {
    result.leftOut.push_back(
      "smoothing of n, ior_gradient: the refractive index is " + std::to_string(settings.outside.n) + " everywhere");
  }
  else
  {
    AddIndex(device, index, settings, OfPart(monitor, 0.8, 1.0), result);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}
}
