#pragma once

#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedSweep.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Buffer.h"
#include "Device/Monitor.h"

#include <vector>

namespace tyndall
{
/// Light propagation maps as published, Algorithm 2 of Gruson et al. 2012, on the device: rays are propagated into one
/// temporary buffer T per direction (Eq. 6), which is then collected into U and I (Eq. 4). Interpretation of these
/// equations: numerics.md, section 3.
///
/// Directions are propagated and collected in batches. The largest batch is the p directions of a cube face (one light
/// propagation map, LPM), for which T needs p n^3 floats per channel as in the paper's section 5. Batches are smaller
/// if T would not fit the device, or would exceed `temporaryBytes`. The paper instead streams slices of the volume
/// (section 4.2) in one pass per face. Batches of directions limit memory as well, with bit-identical results, because
/// both methods collect directions one by one. The medium, U, I and one map per direction stay on the device.
///
/// Per order, call Propagate() and Collect() for each batch, then FinishOrder(); RunOrder() does all of this.
class ParallelPropagation
{
public:
  /// @param medium  its arrays must outlive this object
  /// @param temporaryBytes  limit on the memory of the temporary buffers T; 0: the memory left on the device
  /// @param channels  3: solve three channels even if medium and light are grey; 1: as many as the scene needs
  /// @throws InvalidInput if medium, illumination or settings are invalid
  /// @throws DeviceError if a batch of one direction does not fit
  ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes = 0, int channels = 1);
  ParallelPropagation(const ParallelPropagation&) = delete; // members refer to each other
  ParallelPropagation& operator=(const ParallelPropagation&) = delete;

  const PublishedModel& Model() const { return this->TheModel; }
  int BatchCount() const { return static_cast<int>(this->Plan.batches.size()); }
  /// Index of a batch's first direction; for BatchCount(), the number of directions.
  int FirstDirection(int batch) const;

  /// Traces all rays of the directions of a batch through the volume once, which fills T.
  /// @param monitor  receives the progress of the solve
  void Propagate(int batch, const Monitor& monitor = {});
  /// Adds the temporary buffers T (deposits of the rays) of a batch to the moments of the current order.
  void Collect(int batch);
  /// Ends an order: computes the source U of the next order, the scattered radiance I and the fluence of all orders so
  /// far, powers and convergence.
  void FinishOrder();
  /// Runs one scattering order: Propagate() and Collect() for each batch, then FinishOrder().
  void RunOrder(const Monitor& monitor = {});
  /// Whether the maximum order or the tolerance of the settings is reached.
  bool Done() const { return this->Ledger.Done(); }

  /// Temporary buffers T (deposits of the rays) of a batch, divided by sigma_s, so that they exist in vacuum too:
  /// length W / (length^2 sr), one array per direction, x fastest, channels interleaved. T of Eq. (6) is sigma_s times
  /// the returned value.
  std::vector<std::vector<float>> Contributions(int batch) const;
  void SetContributions(int batch, const std::vector<std::vector<float>>& contributions);

  /// Source U that the next order propagates, W / (length^3 sr): channels * SourceDirections() values per voxel,
  /// channels fastest. Initially the emission of the medium.
  std::vector<float> Source() const { return this->Volumes.ReadSource(); }
  /// Sets the source U of the next order, as returned by Source(). The next order then has no boundary light, like
  /// every order after the first.
  void SetSource(const std::vector<float>& source);

  LightField Result() const; ///< light of all orders so far
  /// Computations that are omitted because the scene does not need them, as texts for LightField::leftOut.
  std::vector<std::string> LeftOut() const;

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
  SweepTally Tally; ///< power that is incident, escapes and wraps around periodic axes in the current order
  bool Emits;       ///< whether the source U is nonzero in any voxel
  bool SourceGiven = false;
  std::vector<float> FluenceDirect;
};

/// Solves all scattering orders with ParallelPropagation.
/// @param temporaryBytes  limit on the memory of the temporary buffers T; 0: the memory left on the device
LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {}, std::size_t temporaryBytes = 0);
}
