#include "LightPropagation/Conservative/BlockTransport.h"

namespace tyndall
{
BlockTransport::BlockTransport(Device& device, const Domain& domain, const VolumeLayout& layout,
  const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic)
  : TheDevice(device)
  , TheDomain(domain)
  , Layout(layout)
  , SigmaT(sigma_t)
  , Periodic(periodic)
{
  if (!domain.IsSerial())
  {
    this->Across = std::make_unique<AcrossFaces>(device, domain.Comm(), domain.Partition(), layout, periodic);
  }
}

std::unique_ptr<SweepOperator> BlockTransport::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->TheDomain.Collective([&] {
    if (this->TheDomain.IsSerial())
    {
      sweep = SweepOfDevice(this->TheDevice, this->Layout, this->SigmaT, this->Periodic, request, this->Workspace);
      return;
    }
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, this->TheDomain.Comm(), this->TheDomain.Partition(),
      this->Layout, this->SigmaT, this->Periodic, request, this->PipelineWorkspace);
  });
  return sweep;
}

BeyondFaces BlockTransport::FetchBeyond(const Buffer<float>& byFaces)
{
  return this->Across ? this->Across->Fetch(byFaces) : BeyondFaces();
}

UncollidedVolume BlockTransport::VolumeOf(const Deposit& deposit, const AngularBasis* basis)
{
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  UncollidedVolume volume = { this->TheDevice, this->TheDomain, this->Layout, this->SigmaT, this->Periodic, sweeps,
    deposit, basis, nullptr };
  if (!this->TheDomain.IsSerial())
  {
    volume.fetchBeyond = [this](const Buffer<float>& byFaces) { return this->FetchBeyond(byFaces); };
  }
  return volume;
}
}
