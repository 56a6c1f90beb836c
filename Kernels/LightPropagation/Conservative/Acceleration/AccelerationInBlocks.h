#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "LightPropagation/Conservative/Acceleration/BeamsInThickBlocks.h"
#include "LightPropagation/Conservative/Acceleration/FaceBalanceInBlocks.h"
#include "LightPropagation/Conservative/Acceleration/MomentsWithGhosts.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Conservative/WarmStart.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Diffusion/BalanceOverRanks.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Iteration with diffusion acceleration (numerics.md, section 7) on one rank's block, in step with the others: as
/// DiffusionAcceleration.h.
class AccelerationInBlocks
{
public:
  /// Collective.
  /// @param parts  must stay, as all that follows. Source has emission and lamps' first scattered beams, Path
  /// uncollided
  ///   light of lamps, Flux theirs, Faces what of it left: used up
  /// @param ledger  of emission and of what lamps let in and out, is added to
  AccelerationInBlocks(TransportParts& parts, LampAdder addLamp, EnergyLedger& ledger, WarmStart& warm);

  /// In thick voxels it matters where lamps' light is first scattered. The same on all ranks, which ask together.
  bool NeedsFirstMoments() const;
  /// If it does: adds the uncollided light of lamps to path, flux and faces. All ranks call it before Run.
  SweepTally AddBeams(const Monitor& monitor);

  /// All ranks call it.
  ConvergenceRecord Run(const Monitor& monitor);
  const std::vector<float>& Direct() const { return this->FluenceDirect; } ///< unscattered, channels interleaved
  /// Writes what is given and what is scattered of the light that was found to the parts' Source. All ranks call it.
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

  TransportParts& Parts;
  const Domain& TheDomain;
  const PropagationSettings& Settings;
  const VolumeLayout& Layout;
  const Medium& TheMedium;
  const LampAdder AddLamp;
  EnergyLedger& Ledger;
  WarmStart& Warm;
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
