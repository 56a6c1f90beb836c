#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/Balance/BalanceOverRanks.h"
#include "LightPropagation/Distributed/Balance/BeamsInThickBlocks.h"
#include "LightPropagation/Distributed/Balance/BlockWithGhosts.h"
#include "LightPropagation/Distributed/Balance/FaceBalanceInBlocks.h"
#include "LightPropagation/Distributed/Balance/MomentsWithGhosts.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/PropagationSettings.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Scattering/SweptMoments.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Iteration with diffusion acceleration (numerics.md, section 7) on one rank's block, in step with the others: as
/// DiffusionAcceleration.h.
class AccelerationInBlocks
{
public:
  /// What it works on, of the rank's block; must stay.
  struct Parts
  {
    Device& device;
    Communicator& others;
    const BlockPartition& partition;
    const BlockScene& scene;
    const PropagationSettings& settings;
    const VolumeLayout& layout;
    const MediumOnDevice& medium;
    const SweptDirections& directions;
    const BoundaryLight& boundary; ///< of the whole grid
    const std::vector<Light>& lamps;
    const ScatteringOperator& scattering;
    const SweptMoments* angular; ///< null: all is isotropic, or there are no voxels
    int functions;               ///< of angular moments, the same on all ranks
    SweepMaker makeSweep;
    LampAdder addLamp;

    Buffer<float>& source;  ///< W / (length^3 sr), emission, and lamps' first scattered beams; used up
    Buffer<float>& path;    ///< W length, of lamps' uncollided light; used up
    Buffer<float>& fluence; ///< W / length^2, becomes the light
    Buffer<float>& flux;    ///< of lamps, is added to; empty: not wanted
    FaceLight* faces;     ///< of the whole box, with what of lamps left; null: no face gives back light or is asked for
    EnergyLedger& ledger; ///< of emission and of what lamps let in and out, is added to
    WarmStart& warm;      ///< of the block
    bool shines;          ///< the source, on any rank
  };
  /// All ranks make one together.
  explicit AccelerationInBlocks(const Parts& parts);

  /// In thick voxels it matters where lamps' light is first scattered. The same on all ranks, which ask together.
  bool NeedsFirstMoments() const;
  /// If it does: adds the uncollided light of lamps to path, flux and faces. All ranks call it before Run.
  SweepTally AddBeams(const Monitor& monitor);

  /// All ranks call it.
  ConvergenceRecord Run(const Monitor& monitor);
  const std::vector<float>& Direct() const { return this->FluenceDirect; } ///< unscattered, channels interleaved
  /// Writes what is given and what is scattered of the light that was found to Parts::source. All ranks call it.
  void ScatterFound();
  /// As LightField has it, after Run: of the faces of the whole box. All ranks call it.
  std::vector<float> FindSurfaceRadiance() const;
  /// W that left through each cell of the whole box's faces, after Run, with faces. All ranks call it.
  std::vector<double> LeftByCell() const;
  /// For the next solve, after Run, where light is kept. All ranks call it.
  KeptLight Leave() const;

private:
  void SpreadMedium();
  void GiveFirstScattered();
  void FindGiven();
  std::size_t BeamValues() const;
  std::vector<float> FluxOf(const Buffer<float>& moments) const;
  void MakeSystems();
  void SpreadSource();
  void ShapeSource();
  void Sweep(int iteration, const Monitor& monitor);
  void PutNextFlux();
  void TakeDirect();
  void BeginWarm();
  void Correct(int iteration);
  void CountLight();
  void ReflectUncollided();
  Deposit DepositOfSweep() const;
  double VoxelPower(int channel) const;
  bool Done(int iterations) const;
  void WriteFluence();
  std::vector<float> FluenceOfSystems();
  std::vector<float> FluxOfSystems() const;

  Parts The;
  const bool LinearSource;
  const BlockWithGhosts Block;
  const MomentsWithGhosts Moments;
  // With ghosts, as DiffusionSystem::Arrays has them; of sigma_s, source, path and given those of the block alone.
  Buffer<float> SigmaT, SweptSigmaT, SigmaA, CountedSigmaS, Given, GivenFlux, Source, Path, PartialCurrents;
  Buffer<float> OwnGiven, OwnCurrents;             ///< of the block; what is given as Parts::source has it
  ExactValues OwnNext;                             ///< of a channel, of the block
  std::vector<float> OwnSigmaS, UncollidedFluence; ///< of the block, [channel][stride]
  std::unique_ptr<BeamsInThickBlocks> Beams;       ///< null: not added
  std::unique_ptr<FaceBalanceInBlocks> Faces;      ///< null: as in Parts
  std::unique_ptr<SweepOperator> Swept;
  std::vector<std::unique_ptr<BalanceOverRanks>> Systems; ///< by channel
  std::vector<float> FluenceDirect;

  EnergyLedger OfUncollided;
  SweepTally Tally; ///< of the last sweep
  Rgb GivenPower = {}, PowerIn = {};
  std::vector<float> First, FirstMoments; ///< as DiffusionAcceleration has them
  RestOfChanges Rest;
  double Residual = 1.0;
  ConvergenceRecord Convergence;
};
}
