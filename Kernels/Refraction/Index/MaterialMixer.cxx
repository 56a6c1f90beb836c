#include "Refraction/Index/MaterialMixer.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <string>

namespace tyndall
{
namespace
{
constexpr std::size_t WorkGroup = 256;

MaterialInfo MaterialOf(const Material& material)
{
  MaterialInfo info = {};
  info.absorption = Float4(Vector(material.sigma_a));
  info.scattering = Float4(Vector(material.sigma_s));
  info.n = static_cast<float>(material.n);
  info.g = static_cast<float>(material.g);
  return info;
}
}

MaterialMixer::MaterialMixer(Device& device, const std::vector<Solid>& solids, const RefractiveMediumSettings& settings,
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

void MaterialMixer::Take(const SamplesInside& inside)
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

void MaterialMixer::Begin(std::size_t voxels)
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

void MaterialMixer::Add(const SamplesInside& inside)
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

void MaterialMixer::End(const SamplesInside& inside)
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

MaterialSlab MaterialMixer::SlabOf(const SamplesInside& inside) const
{
  const Grid& grid = this->Settings.grid;
  return { Float4(Vector(grid.origin)), Float4(Vector(grid.spacing)), inside.first, inside.length, inside.stride,
    this->Box.size[0], this->Box.size[1], this->Box.first[0], this->Box.first[1], this->Box.first[2],
    this->SamplesOfVoxel() };
}

float MaterialMixer::SamplesOfVoxel() const
{
  const int edge = this->Settings.voxelization.samples;
  return static_cast<float>(edge * edge * edge * UnitsOfSample(edge));
}

void MaterialMixer::Launch(cl::Kernel& kernel, const SamplesInside& inside)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(RoundUp(inside.length, WorkGroup), inside.runs), cl::NDRange(WorkGroup, 1));
}

void MaterialMixer::Copy(const Buffer<float>& from, const SamplesInside& inside, int components, std::vector<float>& to)
{
  const std::size_t bytes = inside.length * components * sizeof(float);
  for (std::size_t run = 0; run < inside.runs; ++run)
  {
    this->TheDevice.Queue().enqueueReadBuffer(
      from.Handle(), CL_TRUE, run * bytes, bytes, to.data() + (inside.first + run * inside.stride) * components);
  }
}
}
