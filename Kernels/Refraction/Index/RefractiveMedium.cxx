#include "Refraction/Index/RefractiveMedium.h"

#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/BoxExchange.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexField.h"
#include "Refraction/Voxelization/VoxelizationShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double ShortestEdge = 1e-18; ///< minimum edge of a voxel, in units of length
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
    name + " has the mean cosine " + Text("%g", material.g) + "; it must lie between -1 and 1.");
}

namespace
{
void CheckPerturbation(const Perturbation& perturbation, const std::vector<Solid>& solids)
{
  Require(perturbation.size > 0.0 && std::isfinite(perturbation.size),
    "The noise's size is " + Text("%g", perturbation.size) + "; it must be a positive length.");
  Require(perturbation.scattering >= 0.0 && perturbation.scattering <= 1.0,
    "The noise of scattering is " + Text("%g", perturbation.scattering) + "; it must lie in [0, 1].");
  for (const Solid& solid : solids)
  {
    Require(perturbation.index >= 0.0 && perturbation.index < solid.material.n,
      "The noise of the index is " + Text("%g", perturbation.index) + "; it must not be negative, and be less than " +
        Text("%g", solid.material.n) + ", the refractive index of " + solid.name + ".");
  }
}

/// Checks that 1/edge^2 of a voxel is representable in float, in which its areas and volumes are computed.
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

/// Checks that machine and device have enough memory.
/// @param size          number of voxels along each axis of the box that is voxelised
/// @param coefficients  numbers per voxel for sigma_a, sigma_s and, if it varies, g
/// @param indexVaries   whether n varies, so that it is smoothed and differentiated
void CheckMemory(const Device& device, const RefractiveMediumSettings& settings, const std::array<int, 3>& size,
  int coefficients, bool indexVaries)
{
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
    throw DeviceError(box + " needs " + Text("%.0f", onDevice * voxels) + " bytes on " + device.Name() +
      ", which can give " + std::to_string(static_cast<std::size_t>(most)) +
      ". Ask for fewer voxels, or use a device with more memory.");
  }
}

bool IsGrey(const Material& material)
{
  return tyndall::IsGrey(material.sigma_a) && tyndall::IsGrey(material.sigma_s);
}

/// Whether scattering materials differ in their mean cosines.
/// @param g  output: common mean cosine, if the materials do not differ; unchanged if nothing scatters
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

/// Whether n is the same in all solids and outside.
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

std::vector<OrientedMesh> Oriented(const std::vector<Solid>& solids, const std::vector<MeshTopology>& topologies)
{
  std::vector<OrientedMesh> meshes;
  for (std::size_t s = 0; s < solids.size(); ++s)
  {
    meshes.push_back({ &solids[s].mesh, Orientation(topologies[s]) });
  }
  return meshes;
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

/// Describes the solids whose meshes have no extent, for a message.
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

/// Properties of a medium that follow from its materials alone, without the geometry.
struct Composition
{
  bool grey = true;       ///< whether no material has colour
  bool variedG = false;   ///< whether scattering materials differ in their mean cosines
  bool skipsIndex = true; ///< whether n is not smoothed, because it is the same in all solids and outside
  double g = 0.0;         ///< common mean cosine of the scattering materials, if they do not differ
};

Composition CompositionOf(const std::vector<Solid>& solids, const RefractiveMediumSettings& settings)
{
  std::vector<const Material*> materials = { &settings.outside };
  for (const Solid& solid : solids)
  {
    materials.push_back(&solid.material);
  }
  Composition composition;
  composition.variedG = MeanCosineVaries(materials, composition.g);
  composition.grey = std::all_of(materials.begin(), materials.end(), [](const Material* m) { return IsGrey(*m); });
  composition.skipsIndex = settings.leaveOut && IndexIsEven(solids, settings);
  return composition;
}

MaterialInfo MaterialOf(const Material& material)
{
  MaterialInfo info = {};
  info.absorption = Float4(Vector(material.sigma_a));
  info.scattering = Float4(Vector(material.sigma_s));
  info.n = static_cast<float>(material.n);
  info.g = static_cast<float>(material.g);
  return info;
}

constexpr std::size_t WorkGroup = 256; ///< size of work-groups of the kernels of Materials.cl

/// Computes the mean of the materials in each voxel of a box of the grid, slab by slab: a slab is the set of voxel rows
/// whose samples CountSamplesInside holds at a time.
class MaterialMixer
{
public:
  /// Allocates the arrays of `result`, and sets `index` to 0. Keeps references to all arguments except `box`.
  /// @param variedG  whether the scattering materials differ in their mean cosines
  /// @param index    output: n in the box's voxels, before smoothing
  /// @param result   output: occupancy, coefficients and g of the box's voxels
  MaterialMixer(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
    const VoxelBox& box, bool variedG, Buffer<float>& index, RefractiveMedium& result)
    : TheDevice(device)
    , Solids(solids)
    , Settings(settings)
    , Box(box)
    , VariedG(variedG)
    , Index(index)
    , Result(result)
  {
    const bool noise = settings.perturbation.index > 0.0 || settings.perturbation.scattering > 0.0;
    const std::string options =
      Define("CHANNELS", result.components) + Define("NOISE", noise) + Define("VARIED_G", variedG);
    this->AddObject = device.Kernel("add_object", kernel_source::Materials, options);
    this->AddOutside = device.Kernel("add_outside", kernel_source::Materials, options);
    const std::size_t voxels = box.VoxelCount();
    result.occupancy.resize(voxels);
    result.sigma_a.resize(voxels * result.components);
    result.sigma_s.resize(voxels * result.components);
    result.gByVoxel.resize(variedG ? voxels * result.components : 0);
    index.Fill(0.0f);
  }

  /// Callback of CountSamplesInside: adds the material of one solid to the voxels of one slab, the part of the box that
  /// is processed at a time.
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

  MaterialSlab SlabOf(const SamplesInside& inside) const
  {
    const Grid& grid = this->Settings.grid;
    const int edge = this->Settings.voxelization.samples;
    return { Float4(Vector(grid.origin)), Float4(Vector(grid.spacing)), inside.first, inside.length, inside.stride,
      this->Box.size[0], this->Box.size[1], this->Box.first[0], this->Box.first[1], this->Box.first[2],
      static_cast<float>(edge * edge * edge * UnitsOfSample(edge)) };
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
  const VoxelBox Box;
  const bool VariedG;
  Buffer<float>& Index;
  RefractiveMedium& Result;
  /// Covered fraction, coefficients and g of the voxels of one slab, the part of the box that is computed at a time.
  Buffer<float> Covered, SigmaA, SigmaS, G;
  cl::Kernel AddObject, AddOutside;
};

/// The box `part` with the halo on which its values depend. The halo is half the width of the filter, one voxel for the
/// gradient, and one voxel because the counts of samples inside solids are not exact in the outermost voxels of a box.
VoxelBox BoxAround(const VoxelBox& part, const RefractiveMediumSettings& settings, bool skipsIndex)
{
  return Grown(part, skipsIndex ? 1 : settings.filterSize / 2 + 2, settings.grid);
}

/// Crops the arrays of a medium over the box `box` to the box `part`.
void Keep(const VoxelBox& part, const VoxelBox& box, RefractiveMedium& medium)
{
  if (part.VoxelCount() == box.VoxelCount())
  {
    return;
  }
  const auto keep = [&](std::vector<float>& values, int components) {
    values = values.empty() ? std::vector<float>() : PartOf(values, box, part, components);
  };
  keep(medium.occupancy, 1);
  keep(medium.ior, 1);
  keep(medium.iorGradient, 3);
  keep(medium.sigma_a, medium.components);
  keep(medium.sigma_s, medium.components);
  keep(medium.gByVoxel, medium.components);
}

double SumOfPart(const std::vector<float>& occupancy, const PartOfBox& part)
{
  const bool all = part.own.VoxelCount() == part.made.VoxelCount();
  const std::vector<float> own = all ? std::vector<float>() : PartOf(occupancy, part.made, part.own, 1);
  const std::vector<float>& summed = all ? occupancy : own;
  return std::accumulate(summed.begin(), summed.end(), 0.0);
}

/// Voxelises a part of the box; the part must have at least one voxel.
void Fill(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const PartOfBox& part, const Composition& composition, const Monitor& monitor, VoxelizedPart& result)
{
  RefractiveMedium& medium = result.medium;
  const VoxelBox box = BoxAround(part.made, settings, composition.skipsIndex);
  CheckMemory(device, settings, box.size, (composition.variedG ? 3 : 2) * medium.components, !composition.skipsIndex);
  Grid grid = settings.grid;
  grid.size = box.size;
  Buffer<float> index(device, grid.VoxelCount(), "ior");
  MaterialMixer mixer(device, solids, settings, box, composition.variedG, index, medium);
  result.findings.windings = CountSamplesInside(
    device, settings.grid, { box, part.own }, Oriented(solids, result.topologies), settings.voxelization,
    [&](const SamplesInside& inside) { mixer.Take(inside); }, OfPart(monitor, 0.0, 0.8));
  if (!composition.skipsIndex)
  {
    SmoothIndex(device, grid, settings.filterSize, index);
    medium.ior = index.Read();
    medium.iorGradient = IndexGradient(device, grid, index, OfPart(monitor, 0.8, 1.0));
  }
  Keep(part.made, box, medium);
  const double inside = SumOfPart(medium.occupancy, part);
  result.findings.empty = inside == 0.0;
  result.findings.volume = settings.grid.VoxelVolume() * inside;
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
    "The margin is " + Text("%g", margin) + "; it must be finite and not negative.");

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

VoxelizedPart VoxelizePart(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
  const PartOfBox& part, const Monitor& monitor)
{
  const auto start = std::chrono::steady_clock::now();
  CheckSettings(settings, solids);
  VoxelizedPart result;
  result.medium.device = device.Name();
  const Composition composition = CompositionOf(solids, settings);
  result.medium.g = composition.g;
  result.medium.components = composition.grey ? 1 : 3;
  result.topologies = CheckMeshes(solids, settings, OfPart(monitor, 0.0, 0.2));
  result.findings.windings.resize(solids.size());
  if (part.made.VoxelCount() > 0)
  {
    Fill(device, solids, settings, part, composition, OfPart(monitor, 0.2, 1.0), result);
  }
  result.medium.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

RefractiveMedium Concluded(VoxelizedPart&& part, const VoxelFindings& all, const std::vector<Solid>& solids,
  const RefractiveMediumSettings& settings)
{
  RefractiveMedium medium = std::move(part.medium);
  for (std::size_t s = 0; s < solids.size(); ++s)
  {
    const std::vector<std::string> odd =
      Oddities(part.topologies[s], all.windings[s], solids[s].name, settings.grid, settings.voxelization.samples);
    medium.warnings.insert(medium.warnings.end(), odd.begin(), odd.end());
  }
  if (all.empty)
  {
    medium.warnings.push_back("Nothing of the box is inside a mesh, or what is falls between its samples. Compare the "
                              "box with the meshes' bounds.");
  }
  if (settings.leaveOut && (all.empty || IndexIsEven(solids, settings)))
  {
    medium.ior.clear();
    medium.iorGradient.clear();
    medium.leftOut.push_back(
      "smoothing of n, ior_gradient: the refractive index is " + Text("%g", settings.outside.n) + " everywhere");
  }
  return medium;
}

RefractiveMedium Voxelize(
  Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings, const Monitor& monitor)
{
  const VoxelBox box = { {}, settings.grid.size };
  VoxelizedPart all = VoxelizePart(device, solids, settings, { box, box }, monitor);
  const VoxelFindings findings = all.findings;
  return Concluded(std::move(all), findings, solids, settings);
}

VoxelFindings FindingsOfAll(Communicator& communicator, const VoxelFindings& own)
{
  constexpr std::size_t Words = 9;
  const auto ranks = static_cast<std::size_t>(communicator.Ranks()),
             rank = static_cast<std::size_t>(communicator.Rank());
  const std::size_t ofRank = 2 + Words * own.windings.size();
  std::vector<double> said(ofRank * ranks, 0.0);
  double* to = said.data() + ofRank * rank;
  *to++ = own.empty ? 1.0 : 0.0;
  *to++ = own.volume;
  for (const WindingNumbers& windings : own.windings)
  {
    *to++ = static_cast<double>(windings.oddSamples);
    *to++ = windings.lowest;
    *to++ = windings.highest;
    to = std::copy(windings.firstOddSample.begin(), windings.firstOddSample.end(), to);
    to = std::copy(windings.firstOddNumber.begin(), windings.firstOddNumber.end(), to);
  }
  said = communicator.Sum(said);
  VoxelFindings all;
  all.windings.resize(own.windings.size());
  const double* from = said.data();
  for (std::size_t r = 0; r < ranks; ++r)
  {
    all.empty = *from++ != 0.0 && all.empty;
    all.volume += *from++;
    for (WindingNumbers& windings : all.windings)
    {
      WindingNumbers others;
      others.oddSamples = static_cast<std::size_t>(*from++);
      others.lowest = static_cast<int>(*from++);
      others.highest = static_cast<int>(*from++);
      std::copy_n(from, 3, others.firstOddSample.begin());
      std::transform(
        from + 3, from + 6, others.firstOddNumber.begin(), [](double number) { return static_cast<int>(number); });
      from += 6;
      windings.Add(others);
    }
  }
  return all;
}
}
