#include "LatticeBoltzmann/FindUncollided.h"

#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/GridAxes.h"
#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/Lamps/LampsInBlocks.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/Traits.h"
#include "Medium/VoxelSums.h"

#include <memory>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Settings for a single sweep: voxels are made wide along axes on which nothing varies, and the quadrature is adapted
/// to them.
PropagationSettings AsSweep(const LatticeSettings& settings)
{
  PropagationSettings of = AsPropagation(settings);
  of.source = PropagationSource::Automatic;
  return of;
}

/// Clears moments towards faces across a periodic axis of one voxel: the voxel is its own neighbour there.
void ClearAcrossSingleVoxels(const Grid& whole, const LatticeSettings& settings, std::vector<float>& moments)
{
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    const std::size_t axis = i % 6 / 2;
    const bool isSingle = settings.periodic[axis] && whole.size[axis] == 1;
    moments[i] = isSingle ? 0.0f : moments[i];
  }
}

/// Serial: the first sweep of light propagation maps.
Uncollided BySweepOfGrid(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
  bool firstMoments, const Monitor& monitor)
{
  const std::size_t voxels = problem.Box().Count();
  const int channels = problem.Channels();
  Medium dark = problem.TheMedium(); // isotropic scattering: no delta-M truncation
  dark.emission = {};
  dark.phase = PhaseFunction();
  PropagationSettings once = AsSweep(settings);
  once.maximumOrders = 1;
  once.firstMoments = firstMoments;
  Illumination narrow = problem.TheIllumination();
  narrow.sky = {};
  narrow.faces = {};
  narrow.faceAlbedo = {};
  Uncollided found;
  if (!Shines(narrow))
  {
    found.fluence.assign(voxels, 0.0f);
    found.image.fluence = { found.fluence.data(), 1 };
    found.netFlux.assign(settings.netFlux ? 3 * voxels * static_cast<std::size_t>(channels) : 0, 0.0f);
    return found;
  }
  LightField light = SolveConservative(device, dark, narrow, once, monitor);
  found.fluence = std::move(light.fluenceDirect);
  found.firstMoments = std::move(light.firstMoments);
  found.image.fluence = { found.fluence.data(), light.channels };
  found.image.escaped = EscapedByChannel(light);
  for (int c = 0; c < channels; ++c)
  {
    const EnergyBalance& sums = light.balance;
    const int of = light.channels > 1 ? c : 0;
    found.lost[c] = sums.entered[of] - sums.absorbed[of] - sums.escaped[of] - sums.leftOver[of];
  }
  for (std::size_t i = 0; settings.netFlux && i < voxels; ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const float* flux = light.netFlux.data() + 3 * (i * light.channels + (light.channels > 1 ? c : 0));
      found.netFlux.insert(found.netFlux.end(), flux, flux + 3);
    }
  }
  return found;
}

/// Distributed: the same rays through the whole grid; each rank deposits their light in its block.
class SweepOfBlocks
{
public:
  /// Collective; all arguments must outlive this.
  SweepOfBlocks(Device& device, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments);

  Uncollided Find(const Monitor& monitor); ///< collective

private:
  UnvaryingAxes Unvarying() const;
  BlockPartition Widened() const;
  bool SharesExtinction() const;
  Buffer<float> Zeros(int parts, const char* what) const;
  std::vector<float> Known(const Buffer<float>& planar, double scale, int components) const;
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  void AddEnvironment(const Monitor& monitor);
  void AddLamp(const Light& lamp, const Monitor& monitor);
  Rgb Lost() const;

  Device& TheDevice;
  const LatticeProblem& Problem;
  const LatticeSettings& Settings;
  Communicator& Comm;
  const BlockPartition Partition; ///< blocks of voxels that are wide along axes on which nothing varies
  const double Narrowing;         ///< volume of a voxel of the scene over that of a wide voxel
  const VolumeLayout Layout;
  AcrossFaces Across;
  Buffer<float> SigmaT, Path, Flux, FirstMoments; ///< Flux and FirstMoments are empty unless asked for
  std::unique_ptr<LampsInBlocks> NearLamps;       ///< null until a lamp needs it
  BlockWorkspace Workspace;
  std::vector<Light> Lamps;
  Deposit To;
  SweepTally Tally;
};

SweepOfBlocks::SweepOfBlocks(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments)
  : TheDevice(device)
  , Problem(problem)
  , Settings(settings)
  , Comm(problem.TheDomain().Comm())
  , Partition(this->Widened())
  , Narrowing(problem.TheDomain().Whole().VoxelVolume() / this->Partition.whole.VoxelVolume())
  , Layout({ this->Partition.OwnGrid(this->Comm.Rank()), problem.Channels(), this->SharesExtinction() })
  , Across(device, this->Comm, this->Partition, this->Layout, settings.periodic)
  , Lamps(problem.TheIllumination().lights)
{
  const Medium& medium = problem.TheMedium();
  const auto sigmaT = [&](std::size_t i, int c) {
    const std::size_t known = problem.Box().Known(i);
    return medium.sigma_a.At(known, c) + medium.sigma_s.At(known, c);
  };
  this->Comm.Collective([&] {
    const int extinctions = this->Layout.sharedExtinction ? 1 : this->Layout.channels;
    this->SigmaT = PlanarOnDevice(device, this->Layout, extinctions, sigmaT, "extinction");
    this->Path = this->Zeros(1, "the light gathered");
    this->To.path = &this->Path;
    if (settings.netFlux)
    {
      this->Flux = this->Zeros(3, "net_flux");
      this->To.flux = &this->Flux;
    }
    if (firstMoments)
    {
      this->FirstMoments = this->Zeros(6, "where light is lost");
    }
  });
}

UnvaryingAxes SweepOfBlocks::Unvarying() const
{
  return { this->Problem.TheDomain().Whole(), this->Problem.TheIllumination(), AsSweep(this->Settings) };
}

BlockPartition SweepOfBlocks::Widened() const
{
  BlockPartition partition = this->Problem.TheDomain().Partition();
  partition.whole = this->Unvarying().Widened(partition.whole);
  return partition;
}

/// Whether extinction is the same in all channels.
bool SweepOfBlocks::SharesExtinction() const
{
  Medium dark = this->Problem.TheMedium();
  dark.phase = PhaseFunction();
  const bool has = dark.grid.VoxelCount() > 0;
  return TraitsOfAll(this->Comm, has ? TraitsOf(dark) : MediumTraits()).greyExtinction || this->Problem.Channels() == 1;
}

Buffer<float> SweepOfBlocks::Zeros(int parts, const char* what) const
{
  Buffer<float> values(this->TheDevice, this->Layout.Floats(parts), what);
  values.Fill(0.0f);
  return values;
}

/// Converts planar device values to values by known voxel, interleaved and multiplied by `scale`.
std::vector<float> SweepOfBlocks::Known(const Buffer<float>& planar, double scale, int components) const
{
  const bool has = this->Problem.Box().Count() > 0;
  return this->Problem.WithGhosts(
    has ? Interleaved(this->Layout, planar, scale) : std::vector<float>(), components * this->Layout.channels);
}

std::unique_ptr<SweepOperator> SweepOfBlocks::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->Comm.Collective([&] {
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, this->Comm, this->Partition, this->Layout, this->SigmaT,
      this->Settings.periodic, request, this->Workspace);
  });
  return sweep;
}

/// Adds the environment; its bright peaks become lamps.
void SweepOfBlocks::AddEnvironment(const Monitor& monitor)
{
  const Environment& environment = this->Problem.TheIllumination().environment;
  if (environment.Empty())
  {
    return;
  }
  PropagationSettings settings = AsSweep(this->Settings);
  settings.directionsPerFace = DirectionsPerFaceFor(settings, this->Unvarying());
  const Grid& whole = this->Partition.whole;
  const SweptDirections directions(
    whole, settings, DirectionsForVoxels(settings.directionsPerFace, whole.spacing), RayStarts::Middle);
  const SplitEnvironment far = Split(environment, directions.Set());
  this->Lamps.insert(this->Lamps.end(), far.peaks.begin(), far.peaks.end());
  const BoundaryLight boundary(whole, settings, directions, Illumination(), far.smooth);
  if (!boundary.Shines())
  {
    return;
  }
  boundary.CheckRays(this->Layout.channels);
  const SweepRequest request = { this->To,
    { { 0, directions.Along(0) }, { 1, directions.Along(1) }, { 2, directions.Along(2) } } };
  Add(this->Tally, this->MakeSweep(request)->Apply(nullptr, boundary.Boundary(), monitor));
}

void SweepOfBlocks::AddLamp(const Light& lamp, const Monitor& monitor)
{
  if (Sum(lamp.power) == 0.0)
  {
    return;
  }
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  UncollidedVolume volume = { this->TheDevice, this->Layout, this->SigmaT, this->Settings.periodic, sweeps, this->To };
  volume.deposit.firstMoments = this->FirstMoments.Size() > 0 ? &this->FirstMoments : nullptr;
  volume.whole = &this->Partition.whole;
  volume.fetchBeyond = [this](const Buffer<float>& byFaces) { return this->Across.Fetch(byFaces); };
  volume.together = [this](const std::function<void()>& work) { this->Comm.Collective(work); };
  volume.followLamp = [this](const SweepVolume& ofChannels, const Light& near, const Monitor& ofLamp) {
    if (!this->NearLamps)
    {
      this->NearLamps = std::make_unique<LampsInBlocks>(
        this->TheDevice, this->Comm, this->Partition, this->Settings.periodic, this->Layout, this->SigmaT);
    }
    return this->NearLamps->Deposit(ofChannels, near, ofLamp);
  };
  Add(this->Tally, UncollidedLamp(lamp).AddTo(volume, monitor));
}

/// Power, over all ranks, that entered and neither escaped, nor collided, nor still wraps around a periodic axis, W.
/// Collective.
Rgb SweepOfBlocks::Lost() const
{
  const std::vector<float> path = this->Path.Read(), sigma_t = this->SigmaT.Read();
  Rgb collides = {};
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    collides[c] = SumOverVoxels(this->Layout.grid, [&](std::size_t i) {
      return static_cast<double>(path[c * this->Layout.Stride() + i]) * sigma_t[this->Layout.ExtinctionFirst(c) + i];
    });
  }
  collides = this->Problem.TheDomain().Sum(collides);
  Rgb lost = {};
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    lost[c] = -collides[c] - this->Tally.onTheWay[c];
    for (int face = 0; face < 6; ++face)
    {
      lost[c] += this->Tally.in[face][c] - this->Tally.out[face][c];
    }
  }
  return lost;
}

Uncollided SweepOfBlocks::Find(const Monitor& monitor)
{
  this->AddEnvironment(OfPart(monitor, 0.0, 0.5));
  for (std::size_t i = 0; i < this->Lamps.size(); ++i)
  {
    const double all = static_cast<double>(this->Lamps.size());
    this->AddLamp(this->Lamps[i], OfPart(monitor, 0.5 + 0.5 * i / all, 0.5 + 0.5 * (i + 1) / all));
  }
  const double inverse = 1.0 / this->Partition.whole.VoxelVolume();
  Uncollided found;
  found.fluence = this->Known(this->Path, inverse, 1);
  found.image.fluence = { found.fluence.data(), this->Layout.channels };
  if (this->Settings.netFlux)
  {
    found.netFlux = this->Known(this->Flux, inverse, 3);
  }
  if (this->FirstMoments.Size() > 0)
  {
    found.firstMoments = this->Known(this->FirstMoments, inverse, 6);
    ClearAcrossSingleVoxels(this->Partition.whole, this->Settings, found.firstMoments);
  }
  const Rgb lost = this->Lost();
  if (IsFirstThatHas(this->Comm, this->Partition))
  {
    found.lost = Times(lost, this->Narrowing);
    found.image.escaped = this->Tally.out;
    for (Rgb& face : found.image.escaped)
    {
      face = Times(face, this->Narrowing);
    }
  }
  return found;
}

/// Net flux in the layout of LightField::netFlux: mean directions times fluence.
std::vector<float> NetFluxOf(const UncollidedImage& image, std::size_t voxels, int channels)
{
  std::vector<float> flux;
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      for (int a = 0; a < 3; ++a)
      {
        const float along = image.meanDirection.values ? image.meanDirection.values[3 * i + a] : 0.0f;
        flux.push_back(along * image.fluence.At(i, c));
      }
    }
  }
  return flux;
}
}

void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments)
{
  const Medium& medium = problem.TheMedium();
  if (settings.netFlux)
  {
    found.netFlux = NetFluxOf(found.image, medium.grid.VoxelCount(), problem.Channels());
  }
  if (firstMoments)
  {
    found.firstMoments = EstimatedFirstMoments(found.image, medium, problem.Box());
    ClearAcrossSingleVoxels(problem.TheDomain().Whole(), settings, found.firstMoments);
  }
}

Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor)
{
  const Domain& domain = problem.TheDomain();
  const bool moments = domain.Any(!domain.IsEmpty() && NeedsFirstMoments(problem.TheMedium(), settings));
  const UncollidedImage& given = problem.TheIllumination().uncollided;
  if (domain.Any(given.IsThere()))
  {
    Uncollided found;
    found.image = given;
    if (!IsFirstThatHas(domain.Comm(), domain.Partition()))
    {
      found.image.escaped = {}; // every rank has the powers of the whole grid
    }
    AddMomentsOfImage(found, problem, settings, moments);
    return found;
  }
  return domain.IsSerial() ? BySweepOfGrid(device, problem, settings, moments, monitor)
                           : SweepOfBlocks(device, problem, settings, moments).Find(monitor);
}
}
