#include "LightPropagation/Distributed/BlockOnDevice.h"

#include "LightPropagation/Scattering/MomentScattering.h"

namespace tyndall
{
BlockOnDevice::BlockOnDevice(Device& device, Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings, const IncidentLight& incident)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Scene(scene)
  , Settings(settings)
  , Has(partition.blocks[communicator.Rank()].VoxelCount() > 0)
  , Layout({ partition.OwnGrid(communicator.Rank()), scene.channels, scene.sharedExtinction })
  , OnDevice(device, scene.medium, scene.Scattering(), this->Layout, { true, false })
  , Scattering(MakeScattering(device, this->Layout, this->OnDevice, scene.Scattering().Degree(), scene.traits.scatters))
  , Across(device, communicator, partition, this->Layout, settings.periodic)
{
  if (scene.Scattering().Degree() > 0 && this->Has)
  {
    this->Angular =
      std::make_unique<SweptMoments>(incident.Usual(), scene.medium.phase, scene.Scattering(), incident.Lamps());
  }
  const std::size_t moments = this->Layout.MomentFloats(this->Functions());
  const int beams = this->Angular ? this->Angular->Beams() : 0;
  this->Source = Buffer<float>(device, this->Layout.MomentFloats(this->Functions(), beams), "the scattered light");
  this->Path = Buffer<float>(device, moments, "the light gathered");
  this->Fluence = Buffer<float>(device, this->Layout.Floats(), "fluence");
  if (settings.netFlux)
  {
    this->Flux = Buffer<float>(device, this->Layout.Floats(3), "net_flux");
    this->Flux.Fill(0.0f);
  }
  if (Reflects(scene.illumination) || settings.facePower)
  {
    const bool spreads = !Reflects(scene.illumination);
    this->Faces = std::make_unique<FaceLight>(device, partition.whole, scene.channels,
      SweptPowerIn(partition.whole, settings.periodic, incident.Usual(), spreads), scene.illumination.faceAlbedo);
  }
  this->Source.Fill(0.0f);
  this->Path.Fill(0.0f);
  this->Fluence.Fill(0.0f);
}

int BlockOnDevice::Functions() const
{
  const int degree = this->Scene.Scattering().Degree();
  return (degree + 1) * (degree + 1);
}

Deposit BlockOnDevice::WholeDeposit() const
{
  return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr,
    this->Faces ? &this->Faces->Out() : nullptr, this->Faces && !this->Faces->Reflects() };
}

std::unique_ptr<SweepOperator> BlockOnDevice::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->Comm.Collective([&] {
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, this->Comm, this->Partition, this->Layout,
      this->OnDevice.SigmaT(), this->Settings.periodic, request, this->Workspace);
  });
  return sweep;
}

WarmStart::Scene SceneOf(const BlockOnDevice& block, const IncidentLight& incident)
{
  return { block.TheDevice, block.Layout, block.Scene.Scattering(), *block.Scattering, block.Settings, block.Fluence,
    block.Scene.traits.scatters, block.Functions(), static_cast<int>(incident.Usual().Set().directions.size()),
    block.Partition.whole, &block.Comm, block.Partition.blocks[block.Comm.Rank()] };
}
}
