#include "LatticeBoltzmann/Distributed/UncollidedInBlocks.h"

#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Whether light falls off alike in all channels.
bool SharesExtinction(Communicator& communicator, const LatticeScene& scene)
{
  Medium dark = scene.medium;
  dark.phase = PhaseFunction();
  const bool has = dark.grid.VoxelCount() > 0;
  return TraitsOfAll(communicator, has ? TraitsOf(dark) : MediumTraits()).greyExtinction || scene.channels == 1;
}
}

namespace
{
/// As it is found of the whole: axes along which nothing changes are wide, and directions are adapted to them.
PropagationSettings AsOfWhole(const LatticeSettings& settings)
{
  PropagationSettings of = AsPropagation(settings);
  of.source = PropagationSource::Automatic;
  return of;
}

BlockPartition Widened(BlockPartition partition, const UnvaryingAxes& unvarying)
{
  partition.whole = unvarying.Widened(partition.whole);
  return partition;
}
}

UncollidedInBlocks::UncollidedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Halo& around, const LatticeScene& scene, const LatticeSettings& settings, bool firstMoments)
  : TheDevice(device)
  , Comm(communicator)
  , Unvarying(partition.whole, scene.shining, AsOfWhole(settings))
  , Partition(Widened(partition, this->Unvarying))
  , Narrowing(partition.whole.VoxelVolume() / this->Partition.whole.VoxelVolume())
  , Around(around)
  , Scene(scene)
  , Settings(settings)
  , FirstMoments(firstMoments)
  , SharedExtinction(SharesExtinction(communicator, scene))
  , Layout(this->LayoutOn(this->Partition.OwnGrid(communicator.Rank())))
  , KnownLayout(this->LayoutOn(this->Unvarying.Widened(scene.medium.grid)))
  , Lamps(scene.shining.lights)
  , IsGiven(OnAnyRank(communicator, scene.shining.uncollided.IsThere()))
{
  if (this->IsGiven)
  {
    return;
  }
  communicator.Collective([&] {
    const LatticeBox box = BoxOf(around);
    this->SigmaT = this->SigmaTOf(this->Layout, box);
    this->Path = this->Zeros(this->Layout, 1, "the light gathered");
    if (settings.netFlux)
    {
      this->Flux = this->Zeros(this->Layout, 3, "net_flux");
    }
    if (firstMoments)
    {
      this->KnownSigmaT = this->SigmaTOf(this->KnownLayout, LatticeBox(box.known));
      this->KnownMoments = this->Zeros(this->KnownLayout, 6, "where light is lost");
      this->OwnMoments = this->Zeros(this->Layout, 6, "where light is lost");
    }
  });
}

Buffer<float> UncollidedInBlocks::SigmaTOf(const VolumeLayout& layout, const LatticeBox& box) const
{
  const Medium& medium = this->Scene.medium;
  const auto sigmaT = [&](std::size_t i, int c) {
    const std::size_t known = box.Known(i);
    return medium.sigma_a.At(known, c) + medium.sigma_s.At(known, c);
  };
  return PlanarOnDevice(this->TheDevice, layout, layout.sharedExtinction ? 1 : layout.channels, sigmaT, "extinction");
}

Buffer<float> UncollidedInBlocks::Zeros(const VolumeLayout& layout, int parts, const char* what) const
{
  Buffer<float> values(this->TheDevice, layout.Floats(parts), what);
  values.Fill(0.0f);
  return values;
}

/// Of values of the block those of the known voxels, times `scale`, side by side.
std::vector<float> UncollidedInBlocks::Known(const Buffer<float>& planar, double scale, int components) const
{
  const std::vector<float> own =
    this->Around.Own().VoxelCount() > 0 ? Interleaved(this->Layout, planar, scale) : std::vector<float>();
  return this->Around.Spread(own, components);
}

std::unique_ptr<SweepOperator> UncollidedInBlocks::MakeSweep(const SweepRequest& request)
{
  std::unique_ptr<SweepOperator> sweep;
  this->Comm.Collective([&] {
    sweep = std::make_unique<SweepInBlocks>(this->TheDevice, this->Comm, this->Partition, this->Layout, this->SigmaT,
      this->Settings.periodic, request, this->Workspace);
  });
  return sweep;
}

void UncollidedInBlocks::AddEnvironment(const Monitor& monitor)
{
  const Environment& environment = this->Scene.shining.environment;
  if (environment.Empty())
  {
    return;
  }
  PropagationSettings settings = AsOfWhole(this->Settings);
  settings.directionsPerFace = DirectionsPerFaceFor(settings, this->Unvarying);
  const Grid& whole = this->Partition.whole;
  const SweptDirections directions(
    whole, settings, DirectionsForVoxels(settings.directionsPerFace, whole.spacing), RayStarts::Middle);
  const SplitEnvironment far = Split(environment, directions.Set());
  this->Lamps.insert(this->Lamps.end(), far.peaks.begin(), far.peaks.end());
  const Illumination noOther; // sky and faces are incident on the lattice itself
  const BoundaryLight boundary(whole, settings, directions, noOther, far.smooth);
  if (!boundary.Shines())
  {
    return;
  }
  boundary.CheckRays(this->Scene.channels);
  const SweepRequest request = { this->ToOwn(),
    { { 0, directions.Along(0) }, { 1, directions.Along(1) }, { 2, directions.Along(2) } } };
  Add(this->Tally, this->MakeSweep(request)->Apply(nullptr, boundary.Boundary(), monitor));
}

/// Of the block; rays are those through the whole grid.
UncollidedVolume UncollidedInBlocks::Volume()
{
  const SweepMaker sweeps = [this](const SweepRequest& request) { return this->MakeSweep(request); };
  UncollidedVolume volume = { this->TheDevice, this->Layout, this->SigmaT, this->Settings.periodic, sweeps,
    this->ToOwn() };
  volume.whole = &this->Partition.whole;
  volume.together = [this](const std::function<void()>& work) { this->Comm.Collective(work); };
  volume.followLamp = [this](const SweepVolume& ofChannels, const Light& lamp, const Monitor& monitor) {
    if (!this->NearLamps)
    {
      this->NearLamps = std::make_unique<LampsInBlocks>(
        this->TheDevice, this->Comm, this->Partition, this->Settings.periodic, this->Layout, this->SigmaT);
    }
    return this->NearLamps->Deposit(ofChannels, lamp, monitor);
  };
  return volume;
}

void UncollidedInBlocks::AddLamp(const Light& lamp, const Monitor& monitor)
{
  if (Sum(lamp.power) == 0.0)
  {
    return;
  }
  UncollidedVolume volume = this->Volume();
  if (!this->FirstMoments || lamp.type != LightType::Directional)
  {
    volume.deposit.firstMoments = this->FirstMoments ? &this->OwnMoments : nullptr;
    Add(this->Tally, UncollidedLamp(lamp).AddTo(volume, monitor));
    return;
  }
  Buffer<float> path, currents;
  this->Comm.Collective([&] {
    path = this->Zeros(this->Layout, 1, "the light of a beam");
    currents = this->Zeros(this->Layout, 6, "the light of a beam");
  });
  Deposit ofBeam = this->ToOwn();
  ofBeam.path = &path;
  ofBeam.partialCurrents = &currents;
  Add(this->Tally, SweepBeam(volume, lamp, true, ofBeam, monitor));
  this->AddMoments(lamp, path, currents);
}

/// What goes from a voxel into the next is known where that is: also of the next blocks' voxels.
void UncollidedInBlocks::AddMoments(const Light& lamp, const Buffer<float>& path, const Buffer<float>& currents)
{
  const int channels = this->Scene.channels;
  const std::vector<float> knownPath = this->Known(path, 1.0, channels);
  const std::vector<float> knownCurrents = this->Known(currents, 1.0, 6 * channels);
  this->Comm.Collective([&] {
    if (this->Around.Own().VoxelCount() == 0)
    {
      return;
    }
    const auto onDevice = [&](const std::vector<float>& values, int components) {
      const auto at = [&](std::size_t i, int c) { return values[i * components + c]; };
      return PlanarOnDevice(this->TheDevice, this->KnownLayout, components, at, "the light of a beam");
    };
    const Buffer<float> alone = onDevice(knownPath, channels), through = onDevice(knownCurrents, 6 * channels);
    const Buffer<float> ignored = this->Zeros(this->KnownLayout, 1, "the light of a beam");
    Deposit to, ofBeam;
    to.path = &ignored;
    to.firstMoments = &this->KnownMoments;
    ofBeam.path = &alone;
    ofBeam.partialCurrents = &through;
    const std::array<bool, 3> open = {}; // the known voxels go on beyond periodic ends
    AddWithFirstMoments({ this->TheDevice, this->KnownLayout, this->KnownSigmaT, open, {}, to }, lamp, ofBeam);
    std::vector<float> sum = this->Path.Read(), added = path.Read();
    std::transform(sum.begin(), sum.end(), added.begin(), sum.begin(), std::plus<float>());
    this->Path.Write(sum.data());
  });
}

/// Beams' are found for each known voxel, those of near lamps with the light of the block.
std::vector<float> UncollidedInBlocks::FoundMoments(double scale) const
{
  std::vector<float> moments = this->Known(this->OwnMoments, scale, 6 * this->Scene.channels);
  if (!moments.empty())
  {
    const std::vector<float> ofBeams = Interleaved(this->KnownLayout, this->KnownMoments, scale);
    std::transform(moments.begin(), moments.end(), ofBeams.begin(), moments.begin(), std::plus<float>());
  }
  this->LeaveAlone(moments);
  return moments;
}

/// That which is given, by known voxel.
Uncollided UncollidedInBlocks::Given() const
{
  Uncollided found;
  found.image = this->Scene.shining.uncollided;
  if (!IsFirstThatHas(this->Comm, this->Partition))
  {
    found.image.escaped = {}; // all ranks have that of the whole
  }
  const Medium& medium = this->Scene.medium;
  if (this->Settings.netFlux)
  {
    found.netFlux = NetFluxOf(found.image, medium.grid, this->Scene.channels);
  }
  if (this->FirstMoments)
  {
    found.firstMoments = EstimatedFirstMoments(found.image, medium, {});
    this->LeaveAlone(found.firstMoments);
  }
  return found;
}

/// Beyond the face of a single voxel of a periodic axis lies that itself: nothing crosses it.
void UncollidedInBlocks::LeaveAlone(std::vector<float>& moments) const
{
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    const std::size_t axis = i % 6 / 2;
    const bool isAlone = this->Settings.periodic[axis] && this->Partition.whole.size[axis] == 1;
    moments[i] = isAlone ? 0.0f : moments[i];
  }
}

/// W that entered and went nowhere: it neither left, nor collides in a voxel of any rank, nor is still on the way round
/// a periodic axis. Collective.
Rgb UncollidedInBlocks::Lost() const
{
  const std::vector<float> path = this->Path.Read(), sigma_t = this->SigmaT.Read();
  std::vector<double> collides(3, 0.0);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    collides[c] = SumOverVoxels(this->Layout.grid, [&](std::size_t i) {
      return static_cast<double>(path[c * this->Layout.Stride() + i]) * sigma_t[this->Layout.ExtinctionFirst(c) + i];
    });
  }
  collides = this->Comm.Sum(collides);
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

Uncollided UncollidedInBlocks::Find(const Monitor& monitor)
{
  if (this->IsGiven)
  {
    return this->Given();
  }
  this->AddEnvironment(OfPart(monitor, 0.0, 0.5));
  for (std::size_t i = 0; i < this->Lamps.size(); ++i)
  {
    const double all = static_cast<double>(this->Lamps.size());
    this->AddLamp(this->Lamps[i], OfPart(monitor, 0.5 + 0.5 * i / all, 0.5 + 0.5 * (i + 1) / all));
  }
  const int channels = this->Scene.channels;
  const double inverse = 1.0 / this->Partition.whole.VoxelVolume();
  Uncollided found;
  found.fluence = this->Known(this->Path, inverse, channels);
  found.image.fluence = { found.fluence.data(), channels };
  if (this->Settings.netFlux)
  {
    found.netFlux = this->Known(this->Flux, inverse, 3 * channels);
  }
  if (this->FirstMoments)
  {
    found.firstMoments = this->FoundMoments(inverse);
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
}
