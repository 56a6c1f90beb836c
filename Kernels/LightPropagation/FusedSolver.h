#pragma once

#include "AxisSweep.h"
#include "EmissionPeaks.h"
#include "FirstFlight.h"
#include "FusedPropagation.h"
#include "LowOrder.h"
#include "NeededRays.h"
#include "OneChannel.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
inline double Total(const Rgb& values)
{
  return values[0] + values[1] + values[2];
}

constexpr std::size_t CollectChunk = 4096; ///< CHUNK of Collect.cl

/// One solve, from the arrays of the medium to those of the light.
class FusedSolver
{
public:
  /// @param traits  of the medium; all must stay
  /// @param channels  to solve for
  FusedSolver(Device& device, const Medium& medium, const MediumTraits& traits, const Illumination& illumination,
    const PropagationSettings& settings, int channels)
    : TheDevice(device)
    , TheMedium(medium)
    , Traits(traits)
    , Outside(illumination)
    , Settings(settings)
    , Directions(SoundDirections(settings.directionsPerFace))
    , Mirrors(medium.grid, settings.periodic, this->Directions)
    , Channels(channels)
    , SharedExtinction(channels == 1 || (settings.leaveOut && traits.greyExtinction))
    , Stride((medium.grid.VoxelCount() + SweepPadding - 1) / SweepPadding * SweepPadding)
  {
  }

  LightField Run(const Monitor& monitor);

private:
  float SigmaS(std::size_t voxel, int channel) const
  {
    return static_cast<float>(this->TheMedium.sigma_s.At(voxel, channel) * (1.0 - this->TheMedium.g));
  }
  float SigmaT(std::size_t voxel, int channel) const
  {
    return this->TheMedium.sigma_a.At(voxel, channel) + this->SigmaS(voxel, channel);
  }

  void RunOrders(const Monitor& monitor);
  /// @throws InvalidInput where rays along a set of directions are too few to tell where light comes in through the box's faces
  void CheckRays(const DirectionSet& set, RayStarts starts, const SweepBoundary& boundary) const;
  /// @throws InvalidInput where the energy balance is off by a hundredth
  void CheckBalance() const;
  void Load();
  template <class Loader>
  void LoadEmission(const Loader& load);
  using AxisSweeps = std::vector<std::unique_ptr<AxisSweep>>;
  /// A part of the volume, and which of the tallies count what leaves it.
  enum class Part
  {
    All,
    Filled, ///< the box that the medium fills; what leaves it has escaped, through which face is not known
    Empty   ///< all, to know what is outside that box, and through which faces what has escaped leaves
  };
  bool ScattersAtAll() const { return !this->Settings.leaveOut || this->Traits.scatters; }
  const Buffer<float>& SigmaSOnDevice() const;
  void FindOutsideLight();
  void MakeSweeps();
  void MakeLitSweeps();
  AxisSweeps SweepsThrough(Part part);
  std::vector<Bundle> BundlesOf(int axis) const;
  RayStarts Starts() const { return this->Settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle; }
  bool LeavesSlabsOut() const;
  bool MergesMirrors() const { return this->Settings.leaveOut && !this->Settings.netFlux; }
  std::array<std::size_t, 2> SweptValues() const;
  void SweepEmptySlabs(const Monitor& monitor);
  void PropagateOrder(int order, const Monitor& monitor);
  void PropagateSweeps(const AxisSweeps& sweeps, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor);
  void PropagateLights(const Monitor& monitor);
  void FindFlight(const Environment& farAway);
  void PropagateFlight(const Monitor& monitor);
  struct FlightLight
  {
    std::vector<float> path, flux; ///< as in SweepVolume
    SweepTally tally;
  };
  FlightLight LightOf(const FirstFlight& flight, const Monitor& monitor);
  std::array<FlightLight, 2> LightOfEvenSky(const Monitor& monitor);
  RayStarts FineStarts() const { return this->Accelerated ? this->Starts() : RayStarts::Staggered; }
  void FindExtraEscape(const Monitor& monitor);
  void LetEscape();
  void ShareEscape();
  void AddFlightDifference(const Monitor& monitor);
  double PartOfDifference(std::size_t voxel, int channel) const;
  void PropagatePeaks(const Monitor& monitor);
  SweepVolume VolumeOf(int firstChannel, Part part) const;
  void ForChannels(const std::function<void(const SweepVolume&, int)>& act);
  void Count(const SweepTally& tally, int firstChannel, int channels);
  SweepBoundary BoundaryOfOrder(int order) const;
  Rgb Incoming(int direction, int face) const;
  void CollectOrder(int order);
  void EstimateResidual(int order);
  bool Done(int orders) const;
  void AddRow(int iteration, double change);

  // Accelerated, see AcceleratedPropagation.cxx.
  void ChooseAcceleration();
  double OrdersNeeded() const;
  bool ScatteredManyTimes() const;
  void LoadAbsorption();
  void ChooseNearness();
  void PassLight(int firstChannel, int channels);
  void RunAccelerated(const Monitor& monitor);
  void LoadAccelerated(const Monitor& monitor);
  std::vector<float> WithLamps(const Buffer<float>& planar, double scale) const;
  void SweepAll(int sweepNumber, const Monitor& monitor);
  void MakeSystems();
  void Correct(int sweep);
  void CountLight();
  double UnitPower(int channel) const;
  bool DoneAccelerated(int sweeps) const;
  void UnloadAccelerated();
  void LimitFlux(const std::vector<float>& fluence);
  void FindSurfaceRadiance();

  double Progress(int order, double done) const;
  std::vector<std::string> LeftOut() const;
  void SayWhatIsLeftOut(std::vector<std::string>& words) const;
  void Unload();

  std::vector<float> Interleaved(const Buffer<float>& planar, double scale) const;

  Device& TheDevice;
  const Medium& TheMedium;
  const MediumTraits& Traits;
  const Illumination& Outside;
  std::vector<Light> Lights; ///< those of the scene and the peaks of the environment
  SplitEmission Emission;    ///< of the medium
  const PropagationSettings& Settings;
  DirectionSet Directions;
  MirrorClasses Mirrors;
  int Channels;
  bool SharedExtinction;
  std::size_t Stride;

  Buffer<float> Extinction, Scattering, Source, Path, Flux, Fluence;
  SweepWorkspace Workspace;
  AxisSweeps Sweeps;
  AxisSweeps LitSweeps;    ///< of the first order, where much of the outside is dark and the medium too; else empty
  AxisSweeps FilledSweeps; ///< of the orders after it, where the medium leaves much of the volume empty; else empty
  Part Swept = Part::All;
  double LitPart = 1.0; ///< of all rays, in the first order
  std::vector<Rgb> FromFarAway;
  bool Shining = false;        ///< the source is not zero
  bool LitFromOutside = false; ///< in sweeps

  // Accelerated: what the low-order systems have, by channel
  bool Accelerated = false;
  bool LinearSource = false;
  bool Iterating = false;                    ///< sweeps tell what enters voxels, and no net flux
  Buffer<float> Absorption, Given, Entering; ///< as LowOrder::Arrays has them
  Buffer<float> Nearness, LampPath; ///< of a lamp, as SweepVolume has them; empty where voxels are thin
  Buffer<float> Passed;             ///< of all lamps, as LowOrder::Arrays has it
  std::vector<std::unique_ptr<LowOrder>> Systems;
  std::vector<std::vector<double>> Found; ///< W / length^2, without lights' own
  std::vector<float> Lamps;               ///< W / length^2, lights' own, [channel][stride]
  EnergyBalance LampBalance;              ///< of lights' own light
  std::array<Rgb, 6> LampFaces = {};
  Rgb GivenPower = {}, PowerIn = {};    ///< W, emitted or first scattered; through faces
  std::array<Rgb, 6> FacePowerOut = {}; ///< W, in a sweep
  double Change = 1.0, LastRatio = 1.0;

  // Where unscattered light from outside has directions of its own, see FlightOfSolver.cxx.
  DirectionSet FineDirections;
  std::optional<FirstFlight> Flight;
  std::optional<FirstFlight>
    UsualFlight; ///< accelerated: the same light along the usual directions, as the sweeps carry it
  Buffer<float> ExtraEscape; ///< not accelerated: what escapes of a source, more than sweeps say, W length
  Rgb Escaped = {};          ///< W, that way

  LightField Result;
  std::chrono::steady_clock::time_point Start;
  Rgb Scattered = {};     ///< W, by the order just done
  Rgb OnTheWay = {};      ///< W, rays that still go round a periodic axis
  Rgb Stranded = {};      ///< W, of lights whose rays go round a periodic axis without end
  Rgb LastScattered = {}; ///< W, by the order before
  Rgb AllScattered = {};  ///< W, by all orders so far
  Rgb Ratio = {};         ///< of this order's scattered power to that of the one before
  double Residual = 1.0;
};
}
