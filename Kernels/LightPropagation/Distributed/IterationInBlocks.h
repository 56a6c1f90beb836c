#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Distributed/CellsOverRanks.h"
#include "LightPropagation/Distributed/LampsInBlocks.h"
#include "LightPropagation/Distributed/OrdersOverRanks.h"
#include "LightPropagation/Distributed/SweepInBlocks.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Scattering/IsotropicScattering.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Source iteration on one rank's block, in step with the others.
class IterationInBlocks
{
public:
  IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const BlockScene& scene, const PropagationSettings& settings);
  LightField Run(const Monitor& monitor);

private:
  VolumeLayout LayoutOn(const Grid& grid) const { return { grid, this->Scene.channels, this->Scene.sharedExtinction }; }
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  void LoadEmission();
  std::vector<Light> Lamps() const;
  SweepTally AddNearLamp(const Light& lamp, const Deposit& to, const Monitor& monitor);
  void AddLamps(const Monitor& monitor);
  void MakeCells();
  void RunByBalance(const Monitor& monitor);
  void Scatter();
  void ScatterByCells();
  EnergyLedger WithOutOfCells() const;
  void EstimateResidual();
  bool Done() const;
  Deposit WholeDeposit() const
  {
    return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr, nullptr, nullptr };
  }
  LightField TakeLight();

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const BlockScene& Scene;
  const PropagationSettings& Settings;
  const bool Has; ///< voxels
  const VolumeLayout Layout, WholeLayout;
  const TruncatedScattering Truncated;
  const MediumOnDevice OnDevice;
  const IsotropicScattering Scattering;
  const SweptDirections Directions;
  const SplitEnvironment Far;
  const BoundaryLight Boundary;
  Buffer<float> Source, Path, Flux, Fluence;
  BlockWorkspace Workspace;
  std::unique_ptr<LampsInBlocks> NearLamps;           ///< null until there is one
  std::vector<std::unique_ptr<CellsOverRanks>> Cells; ///< by channel; empty: orders are added up as they are
  std::array<Rgb, 6> OutOfCells = {};                 ///< W, through faces, of all orders to come

  OrdersOverRanks Orders;
  EnergyLedger Ledger;
  ConvergenceRecord Convergence;
  std::vector<ConvergenceRow> Rows; ///< where orders are added up by the balance of voxels
  std::vector<float> Direct;
  std::array<RestOfOrders, 3> Rest;
  Rgb Scattered = {}, AllScattered = {};
  double Residual = 1.0;
  int Order = 0;
  bool Shining = false;
};
}
