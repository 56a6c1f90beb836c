#pragma once

#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedSweep.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Buffer.h"
#include "Device/Monitor.h"

#include <vector>

namespace tyndall
{
/// Light propagation maps as published, Algorithm 2 of Gruson et al. 2012: propagation into one temporary buffer T a
/// direction (Eq. 6), then collection into U and I (Eq. 4); numerics.md, section 3, says how they are read.
///
/// The buffers are filled and collected in batches of directions. The largest batch is one LPM, the p directions of a
/// face, so that T takes p n^3 floats a channel as in the paper's section 5. Where that does not fit the device, or the
/// caller allows less, batches are smaller. The paper streams slices of the volume instead (section 4.2), which needs a
/// pass over all slices a face; batches of directions bound the same memory, and give the same bits, because collection
/// adds directions one by one in either case. The medium, U, I and one map a direction stay on the device.
///
/// Per order: for each batch Propagate() and Collect(), then FinishOrder(). RunOrder() does just that.
class ParallelPropagation
{
public:
  /// @param medium  its arrays must stay
  /// @param temporaryBytes  most that T may take; 0: what is left on the device
  /// @param channels  3: as if something had colour; 1: as the scene needs
  /// @throws InvalidInput for a medium, illumination or settings without meaning; DeviceError if it does not fit even
  ///   with one direction a batch
  ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes = 0, int channels = 1);
  ParallelPropagation(const ParallelPropagation&) = delete; // its parts refer to each other
  ParallelPropagation& operator=(const ParallelPropagation&) = delete;

  const PublishedModel& Model() const { return this->TheModel; }
  int BatchCount() const { return static_cast<int>(this->Plan.batches.size()); }
  int FirstDirection(int batch) const; ///< BatchCount() gives the number of directions

  /// All rays of the batch's directions once through the volume, T filled.
  /// @param monitor  given fractions of the order
  void Propagate(int batch, const Monitor& monitor = {});
  void Collect(int batch);
  /// U of the next order, I and fluence of all orders so far, powers and convergence.
  void FinishOrder();
  void RunOrder(const Monitor& monitor = {});
  /// The orders or the tolerance of the settings are reached.
  bool Done() const { return this->Ledger.Done(); }

  /// T of a batch, each direction x fastest with channels interleaved: a deposit divided by sigma_s (so that vacuum has
  /// one too), length W / (length^2 sr). T of Eq. (6) is sigma_s times that.
  std::vector<std::vector<float>> Contributions(int batch) const;
  void SetContributions(int batch, const std::vector<std::vector<float>>& contributions);

  /// U that the next order propagates, W / (length^3 sr): channels * SourceDirections() a voxel, channels fastest. At
  /// first the medium's emission. Setting it makes the next order one without light from outside, as all but the first
  /// are.
  std::vector<float> Source() const { return this->Volumes.ReadSource(); }
  void SetSource(const std::vector<float>& source);

  LightField Result() const; ///< of all orders so far

private:
  using Batch = PublishedPlan::Batch;
  void UpdateSourcesOfOrder();

  Device& TheDevice;
  const Medium& TheMedium;
  Illumination Outside;
  PropagationSettings Settings;
  PublishedModel TheModel;
  MediumTraits Traits;
  OrderLedger Ledger;
  PublishedVolumes Volumes;
  PublishedPlan Plan;
  PublishedSweep Sweep;
  cl::Kernel UpdateSources;
  SweepTally Tally; ///< of the current order
  bool Emits;       ///< U is not zero
  bool SourceGiven = false;
  std::vector<float> FluenceDirect;
};

/// All orders on the device.
/// @param temporaryBytes  as above
LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {}, std::size_t temporaryBytes = 0);
}
