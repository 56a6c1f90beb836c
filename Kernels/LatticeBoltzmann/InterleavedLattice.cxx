#include "LatticeBoltzmann/InterleavedLattice.h"

#include "Device/Clock.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "Light/LeftOut.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Together = 0.05; ///< of the shorter part's time: with less, a device does one after the other

/// W / length^2 that are usual for light of so much power.
double UsualFluence(const Rgb& power, const Grid& grid)
{
  const double x = grid.Length(0), y = grid.Length(1), z = grid.Length(2), area = x * y + y * z + z * x;
  const double usual = Sum(power) / area;
  return usual > 1e-30 && usual < 1e30 ? usual : 1.0;
}

/// Part of a channel's light that a step's way through a voxel scatters.
std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins)
{
  std::vector<float> scatters(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < scatters.size(); ++i)
  {
    scatters[i] = static_cast<float>(begins[i] * unit * medium.grid.spacing[0] * medium.sigma_s.At(i, channel));
  }
  return scatters;
}
}

InterleavedLattice::InterleavedLattice(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
  : TheDevice(device)
  , TheMedium(medium)
  , Index(ior)
  , Shining(illumination)
  , Settings(settings)
{
}

/// Something like the photons' light, from which a problem has its units and channels, and says what they are. It
/// varies from voxel to voxel, in colour too where photons have several.
void InterleavedLattice::StandInFor(const PackedPhotons& packed, int channels)
{
  const double usual = UsualFluence(packed.entered, this->TheMedium.grid);
  const bool colours = packed.channels == 3;
  Rgb colour = colours ? Rgb{ 1.0, 0.75, 0.5 } : packed.colour;
  std::for_each(colour.begin(), colour.end(), [&](double& value) { value *= usual; });
  this->StandInEscaped.fill(colour);
  for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const std::size_t period = colours ? 5 + static_cast<std::size_t>(c) : 5;
      this->StandIn.push_back(static_cast<float>(colour[c] * (1.0 + 0.125 * static_cast<double>(i % period))));
    }
  }
}

void InterleavedLattice::Begin(const PackedPhotons& packed, int channels)
{
  this->PhotonChannels = channels;
  this->StandInFor(packed, channels);
  Illumination lit = this->Shining;
  lit.uncollided = {};
  lit.uncollided.fluence = { this->StandIn.data(), channels };
  lit.uncollided.escaped = this->StandInEscaped;
  this->Problem.emplace(this->TheMedium, lit, AsPropagation(this->Settings));
  const UncollidedImage& solved = this->Problem->Shining().uncollided;
  const int all = this->Problem->Channels();
  const auto brightest = std::max_element(this->StandInEscaped[0].begin(), this->StandInEscaped[0].end());
  this->Light.fluence.assign(this->TheMedium.grid.VoxelCount() * static_cast<std::size_t>(all), 0.0f);
  this->Light.image.fluence = { this->Light.fluence.data(), all };
  for (int c = 0; c < all; ++c)
  {
    Channel channel;
    channel.lattice = std::make_unique<LatticeChannel>(
      this->TheDevice, SceneOf(*this->Problem), this->Index, this->Settings, this->Light, c);
    const auto power = all == 1 ? brightest - this->StandInEscaped[0].begin() : c;
    channel.from = channels == 1 ? 0 : static_cast<int>(power);
    const double given = this->StandIn[channel.from], escaped = this->StandInEscaped[0][power];
    channel.fluence = given > 0.0 ? solved.fluence.At(0, c) / given : 0.0;
    channel.power = escaped > 0.0 ? solved.escaped[0][c] / escaped : 0.0;
    Lattice& lattice = channel.lattice->TheLattice();
    channel.scatters =
      lattice.Placed(ScattersOf(this->Problem->TheMedium(), c, channel.fluence, channel.lattice->TheVoxels().begins),
        "how voxels scatter photons");
    channel.glows = lattice.Placed(channel.lattice->TheVoxels().source, "what voxels emit");
    this->Channels.push_back(std::move(channel));
  }
}

/// Of a turn. The last one that is asked for is done when all photons have come to their ends.
int InterleavedLattice::StepsOfTurn() const
{
  const int most = this->Settings.stepsPerExchange, asked = this->Settings.maximumSteps;
  return asked > 0 ? std::clamp(asked - 1 - this->Steps, 0, most) : most;
}

std::array<cl::Event, 2> InterleavedLattice::Step(const cl::CommandQueue& queue)
{
  std::array<cl::Event, 2> events;
  queue.enqueueMarkerWithWaitList(nullptr, &events[0]);
  const int steps = this->StepsOfTurn();
  for (Channel& channel : this->Channels)
  {
    Lattice& lattice = channel.lattice->TheLattice();
    lattice.StepOn(queue);
    lattice.Step(steps, true);
  }
  this->Steps += steps;
  queue.enqueueMarkerWithWaitList(nullptr, &events[1]);
  queue.flush();
  return events;
}

void InterleavedLattice::Take(const cl::CommandQueue& queue, const Buffer<float>& fluence)
{
  for (Channel& channel : this->Channels)
  {
    Lattice& lattice = channel.lattice->TheLattice();
    lattice.StepOn(queue);
    lattice.ShineBy(channel.scatters, channel.glows, fluence, this->PhotonChannels, channel.from);
  }
}

/// The light of photons that have all come to their ends, as the problem has it.
void InterleavedLattice::TakeAll(const PhotonLight& photons)
{
  const auto all = static_cast<std::size_t>(this->Problem->Channels());
  const auto given = static_cast<std::size_t>(photons.light.channels);
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  for (std::size_t c = 0; c < all; ++c)
  {
    const Channel& channel = this->Channels[c];
    const std::size_t from = std::min(static_cast<std::size_t>(channel.from), given - 1);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      this->Light.fluence[i * all + c] = static_cast<float>(channel.fluence * photons.light.fluence[i * given + from]);
    }
    for (std::size_t face = 0; face < 6; ++face)
    {
      this->Light.image.escaped[face][c] = channel.power * photons.light.facePowerOut[face][from];
    }
  }
  if (!photons.meanDirection.empty())
  {
    this->Light.image.meanDirection = { photons.meanDirection.data(), 3 };
  }
  if (NeedsFirstMoments(this->Problem->TheMedium(), this->Settings))
  {
    this->Light.firstMoments =
      EstimatedFirstMoments(this->Light.image, this->Problem->TheMedium(), this->Settings.periodic);
  }
  if (this->Settings.netFlux)
  {
    this->Light.netFlux = NetFluxOf(this->Light.image, this->TheMedium.grid, static_cast<int>(all));
  }
  for (Channel& channel : this->Channels)
  {
    channel.lattice->TheLattice().StepOn(this->TheDevice.Queue());
    channel.scatters = Buffer<float>();
    channel.glows = Buffer<float>();
    channel.lattice->Shine();
  }
}

LightField InterleavedLattice::Solve(PhotonMarcher& marcher, const std::vector<Photon>& photons, const Monitor& monitor)
{
  MarchTurns turns;
  turns.stretches = this->Settings.stretches;
  turns.sideBySide = this->Settings.sideBySide;
  turns.begin = [this](const PackedPhotons& packed, int channels) { this->Begin(packed, channels); };
  turns.meanwhile = [this](const cl::CommandQueue& queue) { return this->Step(queue); };
  turns.take = [this](const cl::CommandQueue& queue, const Buffer<float>& fluence) { this->Take(queue, fluence); };
  const double start = ClockSeconds();
  TurnTimes times;
  const PhotonLight found = marcher.MarchByTurns(photons, turns, times, OfPart(monitor, 0.0, 0.3));
  this->TakeAll(found);
  const double marched = (ClockSeconds() - start) / static_cast<double>(this->Channels.size()); // rows add them up
  LightField light = BeginLight(this->TheMedium.grid.VoxelCount(), this->Problem->Channels(), this->Settings);
  double thickest = 0.0;
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    LatticeChannel& channel = *this->Channels[c].lattice;
    const double all = static_cast<double>(this->Channels.size());
    channel.Settle({ this->Steps, marched }, OfPart(monitor, 0.3 + 0.7 * c / all, 0.3 + 0.7 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  FinishLight(light, this->TheDevice, *this->Problem, this->Shining, this->Settings, thickest);
  if (this->Settings.sideBySide && times.together < Together * std::min(times.marching, times.meanwhile))
  {
    light.leftOut.emplace_back(left_out::NotSideBySide);
  }
  return light;
}
}
