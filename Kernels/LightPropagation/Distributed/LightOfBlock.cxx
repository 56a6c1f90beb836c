#include "LightPropagation/Distributed/LightOfBlock.h"

#include "Device/DeviceWords.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/ShownLight.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
void TakeVoxels(const BlockOnDevice& block, LightField& light)
{
  light.fluence = Interleaved(block.Layout, block.Fluence, 1.0);
  for (float& fluence : light.fluence)
  {
    fluence = std::max(fluence, 0.0f); // what the last sweeps would have taken away
  }
  if (block.Settings.netFlux)
  {
    light.netFlux = Interleaved(block.Layout, block.Flux, 1.0 / block.Layout.grid.VoxelVolume());
  }
  for (const float fluence : light.fluence)
  {
    light.scatteredRadiance.push_back(static_cast<float>(fluence / (4.0 * Pi)));
  }
}

/// What is shown of scattered light, in the same form on all ranks.
void AddShown(const BlockOnDevice& block, const Buffer<float>& ofOrders, LightField& light)
{
  std::unique_ptr<ShownLight> shown;
  if (const AngularBasis* const basis = block.Basis())
  {
    std::size_t most = 0;
    for (const VoxelBox& other : block.Partition.blocks)
    {
      most = std::max(most, block.Layout.channels * other.VoxelCount());
    }
    shown = std::make_unique<ShownLight>(block.Scene.medium, block.Scene.Scattering(), *basis, block.Layout, most);
  }
  const bool coloured = OnAnyRank(block.Comm, shown && shown->HasColour());
  if (shown)
  {
    shown->TakeColour(coloured);
    shown->AddTo(light, block.TheDevice, ofOrders, block.Path);
  }
}

void SayWhatLightLacks(const BlockOnDevice& block, LightField& light)
{
  if (block.Scene.traits.scatters)
  {
    light.leftOut = block.Scene.Scattering().LeftOut();
  }
  if (block.Scene.given)
  {
    light.leftOut.emplace_back(left_out::OwnUncollided);
  }
  if (block.Scene.Scattering().Degree() > 0 && !block.StoresMoments())
  {
    light.leftOut.emplace_back(left_out::MomentsForPictures);
  }
}

void SayWhatSolveLacks(const BlockOnDevice& block, IterationScheme how, LightField& light)
{
  if (how == IterationScheme::SourceIteration)
  {
    light.leftOut.emplace_back("acceleration: few scattering orders do");
  }
  if (block.Scene.traits.emits && block.Settings.emissionError > 0.0)
  {
    light.leftOut.emplace_back("exact rays of small bright emission: the medium is spread over ranks");
  }
  if (!block.Settings.netFlux)
  {
    light.leftOut.emplace_back(left_out::NetFlux);
  }
}
}

LightField LightOfBlock(
  BlockOnDevice& block, const IncidentLight& incident, IterationResult&& found, IterationScheme how)
{
  LightField light;
  light.channels = block.Layout.channels;
  if (block.Has)
  {
    TakeVoxels(block, light);
    light.fluenceDirect = std::move(found.fluenceDirect);
  }
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  SayWhatLightLacks(block, light);
  if (block.StoresMoments())
  {
    AddShown(block, found.shown, light);
  }
  light.leftOut.insert(light.leftOut.end(), found.leftOut.begin(), found.leftOut.end());
  light.balance = found.ledger.Balance();
  light.facePowerOut = found.ledger.FacePowerOut();
  if (block.Faces)
  {
    light.facePower = block.Faces->PerArea(found.leftByCell);
  }
  light.surfaceRadiance = std::move(found.surfaceRadiance);
  light.convergence = found.convergence.All();
  light.directionsPerFace = block.Settings.directionsPerFace;
  light.halfRangeFlux = HalfRangeFlux(incident.OfBoundary().Set());
  light.uncollidedDirections = incident.FineBoundary() ? incident.Fine()->Set().PerFace() : 0;
  SayWhatSolveLacks(block, how, light);
  light.device = NameWithStreaming(block.TheDevice);
  return light;
}
}
