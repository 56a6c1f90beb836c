#include "DiscreteOrdinates/ChannelArrays.h"

#include "Device/Device.h"
#include "Device/HostThreads.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Conservative/BlockTransport.h"
#include "LightPropagation/Emission/UncollidedEmission.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall
{
ChannelArrays::ChannelArrays(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, bool netFlux)
  : TheMedium(scene.medium)
  , Voxels(scene.medium.grid.VoxelCount())
  , Layout{ scene.medium.grid, 1, true }
  , Faces(FaceLightOf(device, scene, angles.groups))
  , TheDevice(device)
  , Scene(scene)
  , Angles(angles)
{
  for (std::size_t i = 0; i < this->Voxels; ++i)
  {
    this->Absorption.push_back(scene.medium.sigma_a.At(i, scene.channel));
    this->Scattering.push_back(scene.medium.sigma_s.At(i, scene.channel));
    this->AnyScattering = this->AnyScattering || this->Scattering.back() > 0.0f;
    this->AnyEmission = this->AnyEmission || scene.medium.emission.At(i, scene.channel) > 0.0f;
  }
  this->SigmaT = this->Load("sigma_t", 1.0, this->ScatteredAway());
  this->SigmaS = this->Load("sigma_s", 0.0, this->ScatteredAway());
  this->Scale = Buffer<float>(device, this->Voxels, "the sources");
  this->Direct = Buffer<float>(device, this->Voxels, "fluence_direct");
  this->Light.order = Buffer<float>(device, this->Voxels, "fluence of an order");
  this->Light.fluence = Buffer<float>(device, this->Voxels, "fluence");
  this->Light.flux = Buffer<float>(device, netFlux ? 3 * this->Voxels : 0, "net_flux");
  this->Scale.Fill(1.0f);
  for (Buffer<float>* light : { &this->Direct, &this->Light.order, &this->Light.fluence, &this->Light.flux })
  {
    light->Fill(0.0f);
  }
}

/// Emission of a voxel, W / (length^3 sr), if the method that `emptyVoxels` selects transports it; else 0.
/// @param emptyVoxels  true: sweeps along the quadrature OfVacuum, which transport the emission of empty voxels if
///   OfVacuum is set; false: the method for all other emission
float ChannelArrays::EmissionOf(std::size_t voxel, bool emptyVoxels) const
{
  const double sigma_t = static_cast<double>(this->Absorption[voxel]) + this->Scattering[voxel];
  const bool apart = this->OfVacuum && VacuumEmission::IsEmpty(sigma_t, this->Layout.grid);
  return apart == emptyVoxels ? this->TheMedium.emission.At(voxel, this->Scene.channel) : 0.0f;
}

void ChannelArrays::TakeVacuumApart(PropagationSettings settings)
{
  const Grid& whole = this->Scene.domain.Whole();
  if (!VacuumEmission::IsApart(whole, settings))
  {
    return;
  }
  settings.netFlux = true; // the net flux yields the mean direction of uncollided light
  bool any = false;
  this->Scene.domain.Collective([&] {
    this->OfVacuum = VacuumEmission::DirectionsFor(whole, settings);
    for (std::size_t i = 0; i < this->Voxels; ++i)
    {
      any = any || this->EmissionOf(i, true) > 0.0f;
    }
  });
  if (!this->Scene.domain.Any(any))
  {
    this->OfVacuum.reset();
  }
}

double ChannelArrays::PartWithoutScattering() const
{
  constexpr std::size_t Block = AngularScattering::VoxelsAtATime;
  std::size_t empty = 0;
  for (std::size_t first = 0; first < this->Voxels; first += Block)
  {
    const auto begin = this->Scattering.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(Block, this->Voxels - first));
    empty += std::all_of(begin, end, [](float sigma_s) { return sigma_s == 0.0f; }) ? end - begin : 0;
  }
  return this->Voxels > 0 ? static_cast<double>(empty) / static_cast<double>(this->Voxels) : 0.0;
}

std::vector<cl_uchar> ChannelArrays::EmptyBlocks(const VoxelBox& within) const
{
  std::vector<cl_uchar> empty(this->Voxels / OrdinateBlock + 1, 0);
  InThreads(this->Voxels / OrdinateBlock, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
    {
      empty[block] = 1;
      for (std::size_t i = block * OrdinateBlock; i < (block + 1) * OrdinateBlock && empty[block]; ++i)
      {
        const std::array<int, 3> at = within.Within(this->Layout.grid.VoxelAt(i));
        bool is = this->Absorption[i] == 0.0f && this->Scattering[i] == 0.0f;
        for (int axis = 0; axis < 3; ++axis)
        {
          is = is && at[axis] >= 0 && at[axis] < within.size[axis];
        }
        empty[block] = is ? 1 : 0;
      }
    }
  });
  return empty;
}

void ChannelArrays::LookAtAllRanks()
{
  this->AnyScattering = this->Scene.domain.Any(this->AnyScattering);
  this->AnyEmission = this->Scene.domain.Any(this->AnyEmission);
}

Buffer<float> ChannelArrays::Load(const char* what, double absorbed, double scattered) const
{
  const auto value = [&](std::size_t i, int) {
    return static_cast<float>(absorbed * this->Absorption[i] + scattered * this->Scattering[i]);
  };
  return PlanarOnDevice(this->TheDevice, this->Layout, 1, value, what);
}

std::size_t ChannelArrays::Bytes(const Grid& grid, bool netFlux)
{
  // 9 floats per voxel, of which 3 are for lamps
  const std::size_t ofVoxels = grid.VoxelCount() * (9 + (netFlux ? 3 : 0));
  return sizeof(float) * (ofVoxels + 2 * BoxFaceCellCount(grid));
}

void ChannelArrays::AddLamps(
  const Buffer<float>& source, const std::array<bool, 3>& periodic, OrdinatesResult& result, const Monitor& monitor)
{
  if (this->Scene.lamps.empty() && !this->Scene.uncollided.IsThere() && !this->OfVacuum)
  {
    return;
  }
  std::optional<LampScattering> scattering;
  Buffer<float> sigma_t, sigma_s, path;
  std::optional<BlockTransport> transport;
  this->Scene.domain.Collective([&] {
    scattering.emplace(this->TheDevice, this->Layout.grid, this->Angles.groups, this->Angles.function);
    sigma_t = this->Load("sigma_t", 1.0, 1.0);
    sigma_s = this->Load("sigma_s", 0.0, 1.0);
    path = Buffer<float>(this->TheDevice, this->Layout.Floats(), "the light of a lamp");
    transport.emplace(this->TheDevice, this->Scene.domain, this->Layout, sigma_t, periodic);
  });
  const UncollidedVolume volume =
    transport->VolumeOf({ &path, nullptr, nullptr, nullptr, this->Faces ? &this->Faces->Out() : nullptr }, nullptr);
  const LampTarget target = { source, this->Scale, this->Direct, this->Light };
  const double all = static_cast<double>(this->Scene.lamps.size() + (this->OfVacuum ? 1 : 0));
  for (std::size_t i = 0; i < this->Scene.lamps.size(); ++i)
  {
    this->Scene.domain.Collective([&] { path.Fill(0.0f); });
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    this->CountLamp(UncollidedLamp(this->Scene.lamps[i]).AddTo(volume, ofLamp), result.ledger);
    this->Scene.domain.Collective([&] { scattering->Add(this->Scene.lamps[i], path, sigma_s, target); });
  }
  if (this->OfVacuum)
  {
    this->Scene.domain.Collective([&] { path.Fill(0.0f); });
    const Monitor ofVacuum = OfPart(monitor, (all - 1.0) / all, 1.0);
    this->CountLamp(this->AddVacuum(volume, *scattering, sigma_s, target, ofVacuum), result.ledger);
  }
  if (this->Scene.uncollided.IsThere())
  {
    this->AddGiven(*scattering, sigma_s, source, result);
  }
}

/// Adds the uncollided light that empty voxels emit, and its first-collision source, which is computed from the mean
/// direction of this light in each voxel.
/// @param volume  medium, and the deposit of the sweep; on entry the deposit has path integrals only, all 0
SweepTally ChannelArrays::AddVacuum(UncollidedVolume volume, const LampScattering& scattering,
  const Buffer<float>& sigma_s, const LampTarget& target, const Monitor& monitor) const
{
  Buffer<float> flux;
  std::optional<VacuumEmission> emission;
  this->Scene.domain.Collective([&] {
    flux = Buffer<float>(this->TheDevice, this->Layout.Floats(3), "the net flux of what empty voxels emit");
    flux.Fill(0.0f);
    emission.emplace(
      *this->OfVacuum, Planar(this->Layout, 1, [&](std::size_t i, int) { return this->EmissionOf(i, true); }));
  });
  volume.deposit.flux = &flux;
  const SweepTally tally = emission->AddTo(volume, monitor);
  this->Scene.domain.Collective([&] {
    const std::vector<float> paths = volume.deposit.path->Read(), fluxes = flux.Read();
    std::vector<float> ways(3 * this->Voxels + 1, 0.0f);
    for (std::size_t i = 0; i < 3 * this->Voxels; ++i)
    {
      const float path = paths[i / 3];
      ways[i] = path > 0.0f ? fluxes[i % 3 * this->Layout.Stride() + i / 3] / path : 0.0f;
    }
    scattering.AddAlong(Buffer<float>(this->TheDevice, ways, "mean directions"), *volume.deposit.path, sigma_s, target);
  });
  return tally;
}

void ChannelArrays::AddFaces(
  const Buffer<float>& radiance, const std::array<bool, 3>& periodic, EnergyLedger& ledger, const Monitor& monitor)
{
  const BoundaryLight* faces = this->Scene.faces;
  if (!faces)
  {
    return;
  }
  std::optional<AngularBasis> basis;
  std::optional<BlockTransport> transport;
  Buffer<float> moments;
  this->Scene.domain.Collective([&] {
    basis.emplace(DirectionSet{ 0, false, this->Angles.groups.TheDirections() }, this->Scene.facesDegree);
    moments = Buffer<float>(this->TheDevice, this->Layout.MomentFloats(basis->Count()), "the light of faces");
    moments.Fill(0.0f);
    transport.emplace(this->TheDevice, this->Scene.domain, this->Layout, this->SigmaT, periodic);
  });
  const int c = this->Scene.channel;
  const SweepTally tally = SweepAlong(
    transport->VolumeOf({ &moments }, this->Voxels > 0 ? &*basis : nullptr), faces->Along(),
    [&](int d) { return faces->IsLit(d); }, nullptr,
    [&](int d, int face) {
      return Rgb{ faces->Incoming(d, face)[c], 0.0, 0.0 };
    },
    monitor);
  this->CountLamp(tally, ledger);
  this->Scene.domain.Collective([&] { this->Spread(*basis, moments, radiance); });
}

/// Adds light given by the angular moments of its path integrals to the radiance of all directions.
void ChannelArrays::Spread(const AngularBasis& basis, const Buffer<float>& moments, const Buffer<float>& radiance) const
{
  if (this->Voxels == 0)
  {
    return;
  }
  const OrdinateGroups& groups = this->Angles.groups;
  const double perPath = 1.0 / (4.0 * Pi * this->Layout.grid.VoxelVolume());
  std::vector<std::vector<double>> at;
  for (const Direction& direction : groups.TheDirections())
  {
    at.push_back(basis.At(direction.omega));
  }
  const Buffer<float> functions(this->TheDevice,
    groups.Table(
      basis.Count(), [&](int g, int k, int lane) { return perPath * at[groups.All()[g].direction[lane]][k]; }),
    "the angular functions");
  cl::Kernel spread =
    this->TheDevice.Kernel("spread_moments", kernel_source::UpwindSweep, Define("REAL_WIDTH", OrdinateLanes));
  With(spread, this->Layout.Places(basis.Count()), cl_int(0), cl_int(0), cl_ulong(this->Layout.Stride()), moments,
    functions, radiance, cl_ulong(OrdinateStride(this->Voxels)), cl_int(1));
  Launch(this->TheDevice, spread, cl::NDRange(this->Voxels, groups.Count()));
  this->TheDevice.Finish(); // the kernel reads `functions`, which is destroyed on return
}

/// Adds the uncollided light computed by another solver, and its first-collision source.
void ChannelArrays::AddGiven(
  const LampScattering& scattering, const Buffer<float>& sigma_s, const Buffer<float>& source, OrdinatesResult& result)
{
  UncollidedImage image = this->Scene.uncollided;
  const double size = this->Layout.grid.VoxelVolume();
  this->Scene.domain.Collective([&] {
    const Buffer<float> path = PlanarOnDevice(
      this->TheDevice, this->Layout, 1,
      [&](std::size_t i, int) { return static_cast<float>(size * image.fluence.At(i, this->Scene.channel)); },
      "the light given");
    std::vector<float> ways(3 * this->Voxels + 1, 0.0f);
    if (image.meanDirection.values)
    {
      std::copy_n(image.meanDirection.values, 3 * this->Voxels, ways.begin());
    }
    scattering.AddAlong(Buffer<float>(this->TheDevice, ways, "mean directions"), path, sigma_s,
      { source, this->Scale, this->Direct, this->Light });
  });
  const Domain& domain = this->Scene.domain;
  if (!IsFirstThatHas(domain.Comm(), domain.Partition()))
  {
    image.escaped = {}; // escaped powers are sums over ranks, which every rank holds: only one rank counts them
  }
  const SweepTally tally = TallyOf(image, this->TheMedium, this->Scene.channel, 1);
  this->CountLamp(SumOf(domain, tally), result.ledger);
}

void ChannelArrays::CountLamp(const SweepTally& tally, EnergyLedger& ledger)
{
  for (int face = 0; face < 6; ++face)
  {
    ledger.Enter(0, tally.in[face][0]);
    ledger.Escape(0, face, tally.out[face][0]);
  }
  this->GoingRound += tally.onTheWay[0];
}

ChannelArrays::Powers ChannelArrays::PowersOf(const std::vector<float>& values, bool lamps) const
{
  Powers powers;
  for (std::size_t i = 0; i < this->Voxels; ++i)
  {
    powers.absorbed += static_cast<double>(values[i]) * this->Absorption[i];
    powers.scattered += static_cast<double>(values[i]) * this->Scattering[i];
  }
  const double volume = this->Layout.grid.VoxelVolume();
  const std::vector<double> sums = this->Scene.domain.Sum(
    std::vector<double>{ powers.absorbed * volume, powers.scattered * volume * (lamps ? 1.0 : this->ScatteredAway()) });
  return { sums[0], sums[1] };
}

void ChannelArrays::EmitEvenly(const Buffer<float>& source, EnergyLedger& ledger) const
{
  double sum = 0.0;
  this->Scene.domain.Collective([&] {
    std::vector<float> emission(this->Voxels);
    for (std::size_t i = 0; i < this->Voxels; ++i)
    {
      emission[i] = this->EmissionOf(i, false);
      sum += this->TheMedium.emission.At(i, this->Scene.channel);
    }
    const Buffer<float> values(this->TheDevice, emission, "emission");
    cl::Kernel even = this->TheDevice.Kernel("even_source", kernel_source::UpwindSweep, Define("REAL_WIDTH", 8));
    With(even, source, values, cl_ulong(OrdinateStride(this->Voxels)));
    Launch(this->TheDevice, even, cl::NDRange(this->Voxels, this->Angles.groups.Count()));
    this->TheDevice.Finish(); // the kernel reads `values`, which is destroyed on return
  });
  ledger.Emit(0, 4.0 * Pi * this->Scene.domain.Sum(sum * this->Layout.grid.VoxelVolume()));
}

void ChannelArrays::Read(OrdinatesResult& result) const
{
  result.fluence = this->Light.fluence.Read();
  result.flux = this->Light.flux.Read();
}
}
