#include "Photons/Marching/PhotonMarcher.h"

#include "Device/Clock.h"
#include "LightPropagation/Convergence.h"
#include "Photons/Importance/PilotGathering.h"
#include "Photons/Marching/MarchedBatches.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/PhotonPaths.h"
#include "Photons/Scattering/ScatteredChannels.h"

#include <algorithm>
#include <string>

namespace tyndall
{
class PhotonMarcher::Implementation
{
public:
  Implementation(Device& device, const Medium& medium, const FilledBricks& filled, const Field& ior,
    const MarchSettings& settings, const std::uint8_t* levels)
    : medium(device, medium, ior, settings, filled, levels)
    , pilots(this->medium)
    , Sums(this->medium)
  {
    this->Sums.Share(1, 1); // says what the device lacks
    if (settings.maximumOrders != 1 && this->medium.traits.scatters)
    {
      this->Scattering = std::make_unique<ScatteredChannels>(device, this->medium, medium, ior, levels);
    }
  }

  /// What a march in turns is given, and gives.
  struct Turns
  {
    const MarchTurns& how;
    TurnTimes& times;
  };
  PhotonLight March(const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor,
    const Turns* turns = nullptr);
  /// @throws InvalidInput where light is kept by bricks
  void RequireVoxels(const char* what) const
  {
    if (this->medium.bricks.AreThere())
    {
      throw InvalidInput(std::string(what) + " voxel by voxel. Do not ask for light by bricks.");
    }
  }
  PhotonLight MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor);

  MarchMedium medium;
  PilotGathering pilots;

private:
  void MarchTo(const MarchSums& target, const PackedPhotons& packed, const PhotonsOnDevice& photons,
    const LightField& light, const Turns* turns, const Monitor& monitor);

  MarchedLight Sums;
  std::unique_ptr<ScatteredChannels> Scattering; ///< null: photons are followed to where they are first scattered
};

/// All at once, or in turns between which the light so far is shown.
void PhotonMarcher::Implementation::MarchTo(const MarchSums& target, const PackedPhotons& packed,
  const PhotonsOnDevice& photons, const LightField& light, const Turns* turns, const Monitor& monitor)
{
  if (!turns)
  {
    MarchPhotons(this->medium, packed, photons, target, monitor);
    return;
  }
  const std::size_t voxels = this->medium.grid.VoxelCount();
  const Buffer<float> fluence(
    this->medium.device, voxels * static_cast<std::size_t>(light.channels), "fluence of photons on their way");
  const cl::Kernel show = this->Sums.Show(packed, target, light, fluence);
  turns->how.begin(packed, light.channels);
  turns->times = MarchInTurns(
    this->medium, packed, photons, target, turns->how,
    [&](const cl::CommandQueue& queue) -> const Buffer<float>& {
      queue.enqueueNDRangeKernel(
        show, cl::NullRange, cl::NDRange(voxels / static_cast<std::size_t>(this->medium.grid.size[0])));
      return fluence;
    },
    monitor);
}

PhotonLight PhotonMarcher::Implementation::MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor)
{
  const auto batches = static_cast<std::size_t>(this->medium.settings.errorBatches);
  MarchedBatches all;
  for (std::size_t b = 0; b < batches; ++b)
  {
    const PhotonNumbers numbers = NumbersOfBatch(photons.size(), b, batches);
    std::vector<Photon> some;
    for (const std::size_t number : numbers)
    {
      some.push_back(photons[number]);
    }
    const double parts = static_cast<double>(batches);
    all.Add(this->March(some, numbers, OfPart(monitor, b / parts, (b + 1) / parts)));
  }
  return std::move(all).Sum();
}

PhotonLight PhotonMarcher::Implementation::March(
  const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor, const Turns* turns)
{
  const double start = ClockSeconds();
  const MarchSettings& settings = this->medium.settings;
  const PackedPhotons packed =
    Pack(photons, this->medium.grid, this->medium.channels == 3, this->medium.EventLimit(), settings.batches);
  const CountedPhotons counted(photons, packed, settings.counts);
  PhotonLight result;
  result.missed = packed.missed;
  result.batches = BatchesOf(photons);
  const int colours = this->Scattering && this->Scattering->HasColour() ? 3 : this->medium.traits.ColoursOf(packed);
  result.light.channels = std::max(packed.channels, colours);
  result.light.device = this->medium.device.Name();
  result.light.balance.entered = packed.entered;

  const MarchSums target = this->Sums.Prepare(packed);
  const PhotonsOnDevice onDevice(this->medium.device, packed, counted.marks);
  result.secondsMarching = -ClockSeconds();
  try
  {
    this->MarchTo(
      target, packed, onDevice, result.light, turns, this->Scattering ? OfPart(monitor, 0.0, 0.05) : monitor);
  }
  catch (...)
  {
    this->Sums.Forget();
    throw;
  }
  this->Sums.Finish(packed, target, counted.weightUnit, result);
  Tally(packed, onDevice.ends.Read(), result);
  PutIntoColours(packed, colours, result);
  if (this->Scattering)
  {
    this->Scattering->AddTo(result, packed, numbers, OfPart(monitor, 0.05, 1.0));
  }
  else if (settings.maximumOrders != 1)
  {
    result.light.fluenceDirect = result.light.fluence; // nothing scatters
  }
  SayWhatIsLeftOut(this->medium, packed, result.light);
  if (settings.batches && packed.Batches() == 1)
  {
    result.batchFluence = result.light.fluence;
  }
  result.seconds = ClockSeconds() - start;
  return result;
}

PhotonMarcher::PhotonMarcher(
  Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels)
{
  const FilledBricks filled = CheckedBricks(medium);
  tyndall::Check(settings);
  CheckIndex(ior, medium.grid);
  CheckLevels(levels, medium.grid);
  this->Inside = std::make_unique<Implementation>(device, medium, filled, ior, settings, levels);
}

PhotonMarcher::~PhotonMarcher() = default;
PhotonMarcher::PhotonMarcher(PhotonMarcher&&) noexcept = default;

PhotonLight PhotonMarcher::March(const std::vector<Photon>& photons, const Monitor& monitor)
{
  const bool batches = this->Inside->medium.settings.errorBatches > 0;
  PhotonLight found =
    batches ? this->Inside->MarchInBatches(photons, monitor) : this->Inside->March(photons, {}, monitor);
  JudgeBalance(found.light, Medium());
  return found;
}

PhotonLight PhotonMarcher::MarchByTurns(
  const std::vector<Photon>& photons, const MarchTurns& turns, TurnTimes& times, const Monitor& monitor)
{
  const MarchSettings& settings = this->Inside->medium.settings;
  if (settings.maximumOrders != 1 || settings.batches)
  {
    throw InvalidInput("Photons march in turns up to where they are first scattered, and without batches.");
  }
  this->Inside->RequireVoxels("Photons march in turns");
  const Implementation::Turns inTurns = { turns, times };
  PhotonLight found = this->Inside->March(photons, {}, monitor, &inTurns);
  JudgeBalance(found.light, Medium());
  return found;
}

std::vector<PhotonPath> PhotonMarcher::Paths(const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen)
{
  return TracePaths(this->Inside->medium, photons, chosen);
}

PilotLight PhotonMarcher::Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
  const std::array<int, 3>& cells, const Monitor& monitor)
{
  this->Inside->RequireVoxels("Pilot photons are gathered");
  return this->Inside->pilots.Gather(photons, origins, cells, monitor);
}
}
