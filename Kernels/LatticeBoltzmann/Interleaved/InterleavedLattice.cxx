#include "LatticeBoltzmann/Interleaved/InterleavedLattice.h"

#include "Device/Clock.h"
#include "LatticeBoltzmann/FindUncollided.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "Light/LeftOut.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Order of magnitude of the fluence of light that enters a grid with the given power, W / length^2.
double UsualFluence(const Rgb& power, const Grid& grid)
{
  const double x = grid.Length(0), y = grid.Length(1), z = grid.Length(2), area = x * y + y * z + z * x;
  const double usual = Sum(power) / area;
  return usual > 1e-30 && usual < 1e30 ? usual : 1.0;
}
}

PhotonsToCome::PhotonsToCome(const PackedPhotons& packed, int given, const Grid& grid)
  : channels(given)
{
  const double usual = UsualFluence(packed.entered, grid);
  const bool colours = packed.channels == 3;
  Rgb colour = colours ? Rgb{ 1.0, 0.75, 0.5 } : packed.colour;
  std::for_each(colour.begin(), colour.end(), [&](double& value) { value *= usual; });
  this->escaped.fill(colour);
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < this->channels; ++c)
    {
      const std::size_t period = colours ? 5 + static_cast<std::size_t>(c) : 5;
      const auto place = static_cast<double>(i % period);
      this->fluence.push_back(static_cast<float>(colour[c] * (1.0 + 0.125 * place)));
    }
  }
}

UncollidedImage PhotonsToCome::Image() const
{
  UncollidedImage image;
  image.fluence = { this->fluence.data(), this->channels };
  image.escaped = this->escaped;
  return image;
}

PhotonChannelMap::PhotonChannelMap(
  const PhotonsToCome& photons, const UncollidedImage& solved, int channels, int channel)
{
  const Rgb& escaped = photons.escaped[0];
  const auto brightest = std::max_element(escaped.begin(), escaped.end()) - escaped.begin();
  const auto colour = static_cast<std::size_t>(channels == 1 ? brightest : channel);
  this->from = photons.channels == 1 ? 0 : static_cast<int>(colour);
  const double given = photons.fluence[static_cast<std::size_t>(this->from)];
  this->fluence = given > 0.0 ? solved.fluence.At(0, channel) / given : 0.0;
  this->power = escaped[colour] > 0.0 ? solved.escaped[0][static_cast<std::size_t>(channel)] / escaped[colour] : 0.0;
}

std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins)
{
  std::vector<float> scatters(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < scatters.size(); ++i)
  {
    scatters[i] = static_cast<float>(begins[i] * unit * medium.grid.spacing[0] * medium.sigma_s.At(i, channel));
  }
  return scatters;
}

namespace
{
/// Photons and lattice steps count as concurrent if they overlap by more than this fraction of the shorter of their run
/// times.
constexpr double Overlap = 0.05;

/// Number of lattice steps to queue while the photons march the next segments of their paths. If the settings limit the
/// number of steps, one is left for the time when all photons have ended.
/// @param done  steps taken so far
int StepsOfTurn(const LatticeSettings& settings, int done)
{
  const int most = settings.stepsPerExchange, asked = settings.maximumSteps;
  return asked > 0 ? std::clamp(asked - 1 - done, 0, most) : most;
}
}

InterleavedLattice::InterleavedLattice(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
  : TheDevice(device)
  , TheDomain(domain)
  , TheMedium(medium)
  , Index(ior)
  , Shining(illumination)
  , Settings(settings)
{
}

void InterleavedLattice::Begin(const PackedPhotons& packed, int channels)
{
  const Grid& grid = this->TheMedium.grid;
  this->ToCome.emplace(packed, channels, grid);
  Illumination lit = this->Shining;
  lit.uncollided = this->ToCome->Image();
  this->Problem.emplace(this->TheDomain, this->TheMedium, this->Index, lit, this->Settings);
  const UncollidedImage& solved = this->Problem->TheIllumination().uncollided;
  const int all = this->Problem->Channels();
  this->Light.fluence.assign(grid.VoxelCount() * static_cast<std::size_t>(all), 0.0f);
  this->Light.image.fluence = { this->Light.fluence.data(), all };
  for (int c = 0; c < all; ++c)
  {
    Channel channel;
    channel.lattice = std::make_unique<LatticeChannel>(this->TheDevice, *this->Problem, this->Settings, this->Light, c);
    channel.takes = PhotonChannelMap(*this->ToCome, solved, all, c);
    Lattice& lattice = channel.lattice->TheLattice();
    channel.scatters = lattice.Placed(
      ScattersOf(this->Problem->TheMedium(), c, channel.takes.fluence, channel.lattice->TheVoxels().begins),
      "how voxels scatter photons");
    channel.emits = lattice.Placed(channel.lattice->TheVoxels().source, "what voxels emit");
    this->Channels.push_back(std::move(channel));
  }
}

std::array<cl::Event, 2> InterleavedLattice::Step(const cl::CommandQueue& queue)
{
  std::array<cl::Event, 2> events;
  queue.enqueueMarkerWithWaitList(nullptr, &events[0]);
  const int steps = StepsOfTurn(this->Settings, this->Steps);
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
    lattice.SetSourceOf(channel.scatters, channel.emits, fluence, this->ToCome->channels, channel.takes.from);
  }
}

/// Copies the light of all photons to Light, in the problem's units and channels.
/// @return whether any of it is so faint beside the emission that floats do not hold it
bool InterleavedLattice::TakeAll(const PhotonLight& photons)
{
  bool faint = false;
  const auto all = static_cast<std::size_t>(this->Problem->Channels());
  const auto given = static_cast<std::size_t>(photons.light.channels);
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  for (std::size_t c = 0; c < all; ++c)
  {
    const Channel& channel = this->Channels[c];
    const std::size_t from = std::min(static_cast<std::size_t>(channel.takes.from), given - 1);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const float fluence = photons.light.fluence[i * given + from];
      this->Light.fluence[i * all + c] = static_cast<float>(channel.takes.fluence * fluence);
      faint = faint || (fluence > 0.0f && this->Light.fluence[i * all + c] == 0.0f);
    }
    for (std::size_t face = 0; face < 6; ++face)
    {
      this->Light.image.escaped[face][c] = channel.takes.power * photons.light.facePowerOut[face][from];
    }
  }
  if (!photons.meanDirection.empty())
  {
    this->Light.image.meanDirection = { photons.meanDirection.data(), 3 };
  }
  AddMomentsOfImage(
    this->Light, *this->Problem, this->Settings, NeedsFirstMoments(this->Problem->TheMedium(), this->Settings));
  for (Channel& channel : this->Channels)
  {
    channel.lattice->TheLattice().StepOn(this->TheDevice.Queue());
    channel.scatters = Buffer<float>();
    channel.emits = Buffer<float>();
    channel.lattice->UpdateSources();
  }
  return faint;
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
  const PhotonLight found = marcher.MarchByTurns(photons, turns, OfPart(monitor, 0.0, 0.3));
  const TurnTimes& times = turns.times;
  const bool faint = this->TakeAll(found);
  const double marched =
    // the time is divided among the channels, since the rows of the convergence table are summed over them
    (ClockSeconds() - start) / static_cast<double>(this->Channels.size());
  LightField light = BeginLight(*this->Problem, this->Settings);
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
  DoubtPhotons(found, photons.size(), light);
  if (faint)
  {
    light.doubts.emplace_back(
      "Beside the emission, the photons' light is fainter than floats hold, and left out: solve "
      "it alone if it matters.");
  }
  if (this->Settings.sideBySide && times.together < Overlap * std::min(times.marching, times.meanwhile))
  {
    light.leftOut.emplace_back(left_out::NotSideBySide);
  }
  return light;
}
}
