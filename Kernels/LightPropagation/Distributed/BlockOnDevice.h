#pragma once

#include "Device/Buffer.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Distributed/IncidentLight.h"
#include "LightPropagation/Distributed/Sweep/AcrossFaces.h"
#include "LightPropagation/Distributed/Sweep/SweepInBlocks.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Scattering/SweptMoments.h"

#include <memory>

namespace tyndall
{
/// One rank's block of a scene on its device: what iterations over ranks are made of, as TransportParts is of the
/// whole. Holds no state of a solve but the arrays that they work in.
class BlockOnDevice
{
public:
  /// All must stay.
  /// @throws DeviceError if the arrays do not fit
  BlockOnDevice(Device& device, Communicator& communicator, const BlockPartition& partition, const BlockScene& scene,
    const PropagationSettings& settings, const IncidentLight& incident);
  BlockOnDevice(const BlockOnDevice&) = delete;
  BlockOnDevice& operator=(const BlockOnDevice&) = delete;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const BlockScene& Scene;
  const PropagationSettings& Settings;
  const bool Has; ///< voxels
  const VolumeLayout Layout;
  const MediumOnDevice OnDevice;
  const std::unique_ptr<const ScatteringOperator> Scattering;
  std::unique_ptr<const SweptMoments> Angular; ///< null: all is isotropic, or there are no voxels
  /// Of the whole grid, by cells of its faces; where they reflect, or face power is asked for; else null.
  std::unique_ptr<FaceLight> Faces;
  AcrossFaces Across; ///< to the voxels beyond the block's faces

  /// [channel][stride]; flux [channel][x, y, z][stride], empty where net flux is not asked for. Where light has angular
  /// moments, Source and Path have them [function][channel][stride], and Source those of beams behind them.
  Buffer<float> Source, Path, Flux, Fluence;

  /// What is scattered is handed out in angular moments. The same on all ranks.
  bool StoresMoments() const { return this->Scene.Scattering().Degree() > 0 && this->Settings.storeMoments; }
  int Functions() const; ///< of angular moments
  const AngularBasis* Basis() const { return this->Angular ? &this->Angular->Basis() : nullptr; } ///< null: none
  Deposit WholeDeposit() const; ///< path, and flux and faces' cells where they are asked for
  /// All ranks make one together.
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);

private:
  BlockWorkspace Workspace;
};

/// What a solve of it begins from the last light with. Both must stay.
WarmStart::Scene SceneOf(const BlockOnDevice& block, const IncidentLight& incident);
}
