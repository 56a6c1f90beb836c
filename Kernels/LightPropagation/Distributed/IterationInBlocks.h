#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/Balance/CellsOverRanks.h"
#include "LightPropagation/Distributed/Balance/OrdersOverRanks.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Distributed/LampsInBlocks.h"
#include "LightPropagation/Distributed/Sweep/SweepInBlocks.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Scattering/SweptMoments.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// How light is found, as all ranks decided.
struct WayInBlocks
{
  OrdersOverRanks orders;
  UncollidedDirections finer; ///< none where orders are added up by the balance of voxels
};

/// Source iteration on one rank's block, in step with the others.
class IterationInBlocks
{
public:
  IterationInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const BlockScene& scene, const PropagationSettings& settings, const WayInBlocks& way);
  LightField Run(const Monitor& monitor);

  bool StoresMoments() const { return this->Scene.Scattering().Degree() > 0 && this->Settings.storeMoments; }
  /// Lamps of what shines on all, and those that stand for peaks of its environment, in its own units.
  std::vector<Light> LampsOf(const Illumination& shining) const;

private:
  VolumeLayout LayoutOn(const Grid& grid) const { return { grid, this->Scene.channels, this->Scene.sharedExtinction }; }
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  int Functions() const; ///< of angular moments
  const SweptDirections& DirectionsOfBoundary() const { return this->Fine ? *this->Fine : this->Directions; }
  void MakeFineBoundary();
  void LoadEmission();
  void LoadStraightOn();
  void AddUncollided(const Monitor& monitor);
  SweepTally AddOnAllRanks(const std::function<SweepTally()>& add);
  SweepTally AddLamp(std::size_t lamp, const Monitor& monitor);
  SweepTally AddGiven(const Monitor& monitor);
  UncollidedVolume VolumeOf(const Deposit& deposit);
  void FindEscaping(const Monitor& monitor);
  void LetEscape();
  void MakeCells();
  void RunByBalance(const Monitor& monitor);
  void Reflect();
  void Scatter();
  void TakeDirect(const Buffer<float>& fluence, double scale);
  void ScatterByCells();
  EnergyLedger WithOutOfCells() const;
  void EstimateResidual();
  bool Done() const;
  Deposit WholeDeposit() const;
  void AddShown(LightField& light);
  LightField TakeLight();

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const BlockScene& Scene;
  const PropagationSettings& Settings;
  const WayInBlocks Way;
  const bool Has; ///< voxels
  const VolumeLayout Layout;
  const MediumOnDevice OnDevice;
  const std::unique_ptr<const ScatteringOperator> Scattering;
  const SweptDirections Directions;
  const std::unique_ptr<const SweptDirections> Fine; ///< of unscattered light from outside; null: the same
  const SplitEnvironment Far;
  const BoundaryLight Boundary;
  std::unique_ptr<const BoundaryLight> FineBoundary; ///< in its place; null where it is dark
  std::vector<Light> Lamps;
  std::unique_ptr<const GivenLight> Given;     ///< null: none is, or there are no voxels
  std::unique_ptr<const SweptMoments> Angular; ///< null: all is isotropic, or there are no voxels
  Buffer<float> Source, Path, Flux, Fluence;
  Buffer<float> OfLamp; ///< path integrals of one lamp's light, where it goes into angular moments
  std::optional<EscapeCorrection> Escaping;
  std::unique_ptr<FaceLight> Faces; ///< of the whole grid; where they reflect, or face power is asked for; else null
  Buffer<float> Shown;              ///< as IterationResult has it; empty: not asked for
  BlockWorkspace Workspace;
  std::unique_ptr<LampsInBlocks> NearLamps;           ///< null until there is one
  std::vector<std::unique_ptr<CellsOverRanks>> Cells; ///< by channel; empty: orders are added up as they are
  std::array<Rgb, 6> OutOfCells = {};                 ///< W, through faces, of all orders to come
  std::array<Rgb, 6> KeptByCells = {};                ///< W that the next sweep will let out, and that stay

  EnergyLedger Ledger;
  ConvergenceRecord Convergence;
  std::vector<ConvergenceRow> Rows; ///< where orders are added up by the balance of voxels
  std::vector<float> Direct, SurfaceRadiance;
  std::array<RestOfOrders, 3> Rest;
  Rgb Scattered = {}, Reflected = {}, AllScattered = {};
  Rgb Escaped = {};                 ///< W, by the correction
  Rgb OnTheWay = {}, Stranded = {}; ///< round periodic axes, as SourceIteration has them
  double Residual = 1.0;
  int Order = 0;
  bool Shining = false;
};
}
