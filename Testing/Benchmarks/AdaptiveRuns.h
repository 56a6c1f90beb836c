#pragma once

#include "PhotonRuns.h"

#include "Photons/Importance/PhotonImportance.h"
#include "Reconstruction/PhotonReconstruction.h"

#include <memory>
#include <vector>

/// Ways from a lamp to light, pass by pass, that the adaptive benchmark compares.
namespace bench
{
enum class Way
{
  Published, ///< the reference pipeline: its marching and its 3x3x3 Gauss filter
  Uniform,   ///< photons spread evenly, conservative marching, no filter
  Smoothed,  ///< the same, and a 3x3x3 Gauss filter (that of the reference pipeline; on the host, its time not counted)
  Reconstructed,     ///< photons spread evenly, conservative reconstruction
  AdaptivePublished, ///< importance map, counts, and level by centre-surround and weight
  Adaptive,          ///< importance map, two batches, conservative reconstruction: the default
};
const char* NameOf(Way way);

/// Seconds of each pass.
struct Passes
{
  double pilot = 0.0; ///< pilot photons, their marching, and the map
  double generation = 0.0, marching = 0.0, reconstruction = 0.0;

  double Whole() const { return this->pilot + this->generation + this->marching + this->reconstruction; }
};

struct WayLight
{
  std::vector<float> fluence, meanDirection, fluenceError, mipLevel;
  std::size_t photons = 0; ///< all that were marched, pilot ones too
  Passes passes;
  tyndall::Importance importance; ///< of the adaptive ways
};

/// A scene, prepared for all ways. The medium is on the device before any of them begins: that costs the same for all.
class WayRunner
{
public:
  WayRunner(tyndall::Device& device, PaperScene& scene);

  /// @param photons  those of the pilot included
  WayLight Run(Way way, std::size_t photons, std::uint64_t seed = 1);

  /// As Run, times the medians of several; the light is the first run's.
  WayLight Time(Way way, std::size_t photons, int runs);

private:
  tyndall::PhotonMarcher& MarcherFor(Way way);
  tyndall::PhotonLight March(Way way);
  void Find(std::size_t photons, std::uint64_t seed, WayLight& light);

  tyndall::Device& Device;
  PaperScene& Scene;
  std::unique_ptr<tyndall::PhotonMarcher> Plain, Counting, Batching;
};

/// The perturbed cube of Pfeuti's Figure 4.9.
PaperScene CubeInFog(int edge);
/// Fog alone under a sun that fills it: nothing to be gained by sending photons here or there.
PaperScene EvenFog(int edge);
}
