#include "Photons/Scattering/PhotonScattering.h"

#include "Device/Device.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Numerics/NumberText.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Block = 16; ///< number of consecutive photons that a work-item fetches at a time
/// Number of equal intervals of cumulative probability in a table of cosines of the scattering angle.
constexpr int TableParts = 65536;

/// Methods of sampling the scattering angle; values of the macro PHASE of ScatterPhotons.cl.
enum PhaseSampling
{
  Evenly = 0,
  ByHenyeyGreenstein = 1,
  BySchlick = 2,
  ByTable = 3
};

PhaseSampling PhaseOf(const Medium& medium)
{
  const PhaseFunction& function = medium.phase.OfChannel(0);
  if (!medium.phase.Varies() && function.IsIsotropic())
  {
    return Evenly;
  }
  switch (function.TheKind())
  {
    case PhaseFunction::Kind::Isotropic: return medium.phase.Varies() ? ByHenyeyGreenstein : Evenly;
    case PhaseFunction::Kind::HenyeyGreenstein: return ByHenyeyGreenstein;
    case PhaseFunction::Kind::Schlick: return BySchlick;
    default: return ByTable;
  }
}

/// Values of SampledPhase::values. They are the parameter of the phase function, one value or one per voxel, or a table
/// of the cosine of the scattering angle at equidistant values of its cumulative probability.
std::vector<float> PhaseValues(const Medium& medium)
{
  const PhaseSampling phase = PhaseOf(medium);
  std::vector<float> values;
  for (int i = 0; i <= TableParts && phase == ByTable; ++i)
  {
    values.push_back(static_cast<float>(medium.phase.OfChannel(0).CosineAt(static_cast<double>(i) / TableParts)));
  }
  const bool given = phase == ByHenyeyGreenstein || phase == BySchlick;
  const std::size_t parameters = !given ? 0 : medium.phase.Varies() ? medium.grid.VoxelCount() : 1;
  for (std::size_t i = 0; i < parameters; ++i)
  {
    values.push_back(static_cast<float>(medium.phase.At(i, 0).Shape().first));
  }
  return values;
}

/// Values of PhotonScattering::optical: sigma_s and sigma_a times the voxel diagonal, two values per voxel of the
/// padded grid; 0 in the padding.
std::vector<float> OpticalOf(const MarchMedium& through, const Medium& medium)
{
  const std::array<int, 3>& size = medium.grid.size;
  std::vector<float> values(2 * through.PaddedCount(), 0.0f);
  const double diagonal = through.Diagonal();
  ForGridVoxels(size, [&](std::size_t voxel, int x, int y, int z) {
    const std::size_t at = (static_cast<std::size_t>(z + 1) * (size[1] + 2) + y + 1) * (size[0] + 2) + x + 1;
    values[2 * at] = static_cast<float>(std::min(diagonal * medium.sigma_s.At(voxel, 0), 1e30));
    values[2 * at + 1] = static_cast<float>(std::min(diagonal * medium.sigma_a.At(voxel, 0), 1e30));
  });
  return values;
}
}

double ScatteringStepPart(const Field& ior, const std::array<int, 3>& size)
{
  // The fraction of the step size (numerics.md, Eq. (99d)) is `Seen` divided by the largest relative jump of n^2
  // between neighbouring voxels, but at least `Least`.
  constexpr double Seen = 0.5, Least = 0.1;
  double jump = 0.0;
  const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(size[0]),
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) };
  const std::size_t voxels = ior.values ? stride[2] * static_cast<std::size_t>(size[2]) : 0;
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (i / stride[a] % static_cast<std::size_t>(size[a]) + 1 < static_cast<std::size_t>(size[a]))
      {
        const double here = std::pow(ior.At(i, 0), 2), there = std::pow(ior.At(i + stride[a], 0), 2);
        jump = std::max(jump, std::abs(here - there) / std::min(here, there));
      }
    }
  }
  return std::clamp(Seen / std::max(jump, 1e-9), Least, 1.0);
}

SampledPhase::SampledPhase(Device& device, const Medium& medium)
  : options(Define("PHASE", static_cast<int>(PhaseOf(medium))) + Define("VARIES", medium.phase.Varies()) +
      Define("COSINES", PhaseOf(medium) == ByTable ? TableParts : 0))
  , values(device, PhaseValues(medium), "how light is scattered")
{
}

PhotonScattering::PhotonScattering(const MarchMedium& inLayout, const Medium& medium, double part)
  : through(inLayout)
  , stepPart(part)
  , optical(through.device, OpticalOf(through, medium), "how voxels scatter")
  , phase(through.device, medium)
{
}

ScatteringRun::ScatteringRun(const PhotonScattering& in, PackedPhotons photons)
  : In(in)
  , Packed(std::move(photons))
  , Numbers(in.through.settings.meanDirection ? 4 : 1)
  , Shares(ShareSums(in.through, in.through.PaddedCount(), Numbers, 1, 0))
  , Photons(in.through.device, Packed.values, "photons")
  , Streams(in.through.device, { Packed.numbers.begin(), Packed.numbers.end() }, "numbers of photons")
  , Sums(
      in.through.device, in.through.PaddedCount() * Count(Numbers) * Count(Shares.copies), "sums of the photons' light")
  , Kernel(this->MakeKernel())
{
  this->Sums.Fill(0);
  this->Found.entered = this->Packed.entered[0];
}

cl::Kernel ScatteringRun::MakeKernel() const
{
  const MarchMedium& through = this->In.through;
  return through.device.Kernel("scatter_photons", kernel_source::ScatterPhotons,
    through.Options() + this->In.phase.options + Define("CHANNELS", 1) + Define("DIRECTIONS", 1) +
      Define("ORDER", through.settings.order) + Define("REAL_WIDTH", 1) + Define("ATOMICS", this->Shares.atomics) +
      Define("WORKERS", this->Workers()) + Define("BLOCK", Block) + Define("GATHERS", this->Numbers > 1));
}

std::vector<ScatteredOnItsWay> ScatteringRun::Start(const Monitor& monitor)
{
  return this->Launch(this->Photons.Handle(), this->Packed.Count(), false, monitor);
}

std::vector<ScatteredOnItsWay> ScatteringRun::Resume(
  const std::vector<ScatteredOnItsWay>& arrived, const Monitor& monitor)
{
  const Buffer<ScatteredOnItsWay> onDevice(this->In.through.device, arrived, "photons from other blocks");
  return this->Launch(onDevice.Handle(), arrived.size(), true, monitor);
}

std::vector<ScatteredOnItsWay> ScatteringRun::Launch(
  const cl::Buffer& photons, std::size_t all, bool resumes, const Monitor& monitor)
{
  std::vector<ScatteredOnItsWay> into;
  if (all == 0)
  {
    return into;
  }
  const MarchMedium& through = this->In.through;
  const int orders = through.settings.maximumOrders;
  MarchInfo info = through.Describe();
  info.stepSize *= static_cast<float>(this->In.stepPart);
  info.eventLimit = static_cast<int>(std::min(1e9, info.eventLimit / this->In.stepPart));
  ScatterInfo how = {};
  how.seed = through.settings.seed;
  how.mostScatterings = orders == 0 ? std::numeric_limits<int>::max() : orders - 1;
  how.copyStride = through.PaddedCount() * Count(this->Numbers);
  how.resumes = cl_int(resumes);
  const std::size_t whole = Count(Block) * Count(std::max(this->Workers(), 1));
  const Batches launches = PhotonLaunches(through, all, whole, whole, 1);
  const Buffer<ScatterEnd> ends(through.device, all, "ends of photons");
  const Buffer<ScatteredOnItsWay> gone(
    through.device, through.IsBlock() ? std::min(all, launches.most) : 0, "photons into other blocks");
  Buffer<cl_int> counters(through.device, 2, "number of the next photon");
  InBatches(through.device, launches, monitor, [&](std::size_t first, std::size_t count) {
    counters.Fill(0);
    how.first = static_cast<cl_int>(first);
    how.count = static_cast<cl_int>(count);
    With(this->Kernel, info, how, through.sigma, through.coefficients, through.nodes, this->In.optical,
      this->In.phase.values, photons, this->Streams, ends, this->Sums, counters);
    if (through.IsBlock())
    {
      SetFrom(this->Kernel, 12, gone);
    }
    const std::size_t workers = Count(this->Workers());
    through.Launch(
      this->Kernel, cl::NDRange(workers > 0 ? workers : count), workers > 0 ? cl::NDRange(1) : cl::NullRange);
    if (through.IsBlock())
    {
      AppendPhotons(gone, counters.Read().back(), into);
    }
  });
  this->TakeEnds(ends.Read());
  return into;
}

ScatteredPhotons ScatteringRun::Finish()
{
  this->TakeLight();
  return std::move(this->Found);
}

/// Converts the sums of deposits to the fluence and the net flux of the result, `Found`.
void ScatteringRun::TakeLight()
{
  const MarchMedium& through = this->In.through;
  Device& device = through.device;
  const Grid& grid = through.grid;
  const std::size_t voxels = grid.VoxelCount(), rows = voxels / static_cast<std::size_t>(grid.size[0]);
  const bool directions = this->Numbers > 1;
  std::vector<float>& fluence = this->Found.fluence = Zeros(voxels);
  std::vector<float>& flow = this->Found.flow = Zeros(directions ? 3 * voxels : 0);
  const HostMappedBuffer<float> toFluence(device, fluence.data(), fluence.size(), "fluence");
  const HostMappedBuffer<float> toDirection(device, flow.data(), flow.size(), "mean direction");
  const Buffer<float> none(device, 0, "what is not asked for");
  const Buffer<cl_long> taken(device, 2 * rows, "tallies");
  cl::Kernel finish = through.SumsKernel("finish_light", 1,
    Define("DIRECTIONS", directions) + Define("COUNTS", 0) + Define("COLOURS", 1) + Define("CARRIES", 1));
  With(finish, through.DescribeSums(this->Packed, this->Shares), through.sigmaA, through.sigmaS, this->Sums,
    cl_ulong(through.PaddedCount() * static_cast<std::size_t>(this->Numbers)), toFluence.Handle(), toDirection.Handle(),
    none, none, none, taken);
  through.Launch(finish, cl::NDRange(rows));
  toFluence.Fetch();
  toDirection.Fetch();
  const std::vector<cl_long> units = taken.Read();
  for (std::size_t row = 0; row < rows; ++row)
  {
    this->Found.absorbed += units[2 * row] * this->Packed.unit;
  }
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    flow[i] *= fluence[i / 3];
  }
}

/// Adds the final states of photons to the powers and counts of the result, `Found`. Photons that continue in another
/// block are counted there.
void ScatteringRun::TakeEnds(const std::vector<ScatterEnd>& ends)
{
  const double unit = this->Packed.unit;
  for (const ScatterEnd& end : ends)
  {
    if (end.face == Elsewhere)
    {
      continue;
    }
    this->Found.absorbed += unit * end.absorbedAtFirst;
    this->Found.exchanged += unit * end.exchanged;
    this->Found.scatterings += static_cast<std::uint64_t>(end.scatterings);
    if (end.face < StillGoing)
    {
      this->Found.escaped[end.face] += unit * end.power;
    }
    else
    {
      this->Found.leftOver += unit * end.power;
    }
  }
}

namespace
{
/// One channel of a medium, with arrays of one component.
struct OneChannelMedium
{
  OneChannelMedium(const Medium& medium, int channel)
    : seen(medium)
  {
    const auto take = [&](Field& field, std::vector<float>& values) {
      for (std::size_t i = 0; i < medium.grid.VoxelCount() && field.values; ++i)
      {
        values.push_back(field.At(i, channel));
      }
      field = { values.empty() ? nullptr : values.data(), 1 };
    };
    take(this->seen.sigma_a, this->sigma_a);
    take(this->seen.sigma_s, this->sigma_s);
    this->seen.emission = {};
    this->seen.phase = medium.phase.Seen(channel);
  }
  OneChannelMedium(const OneChannelMedium&) = delete;
  OneChannelMedium& operator=(const OneChannelMedium&) = delete;

  std::vector<float> sigma_a, sigma_s;
  Medium seen;
};

/// Adds the light, powers and counts of photons that were followed in one channel to every channel of `light`,
/// multiplied by that channel's factor in `colour`.
void AddRun(const ScatteredPhotons& found, const Rgb& colour, PhotonLight& light)
{
  const auto channels = static_cast<std::size_t>(light.light.channels);
  EnergyBalance& balance = light.light.balance;
  for (std::size_t c = 0; c < channels; ++c)
  {
    balance.entered[c] += colour[c] * found.entered;
    balance.absorbed[c] += colour[c] * found.absorbed;
    balance.leftOver[c] += colour[c] * (found.leftOver - found.exchanged);
    light.exchanged[c] += colour[c] * found.exchanged;
    for (std::size_t face = 0; face < 6; ++face)
    {
      light.light.facePowerOut[face][c] += colour[c] * found.escaped[face];
      balance.escaped[c] += colour[c] * found.escaped[face];
    }
    for (std::size_t i = 0; i < found.fluence.size(); ++i)
    {
      light.light.fluence[i * channels + c] += static_cast<float>(colour[c] * found.fluence[i]);
    }
  }
  light.scatterings += found.scatterings;
}
}

ScatteredChannels::ScatteredChannels(Device& device, const Block& block)
{
  for (int c = 0; c < (block.coloured ? 3 : 1); ++c)
  {
    Channel channel;
    if (const MarchMedium* const through = block.through)
    {
      const OneChannelMedium one(block.medium, c);
      if (block.coloured)
      {
        MarchTraits traits = through->traits;
        traits.coloured = false;
        traits.grey = traits.greyExtinction = true;
        auto own = std::make_unique<MarchMedium>(
          device, one.seen, block.ior, block.settings, traits, through->block, nullptr, block.levels);
        if (block.nodes)
        {
          own->SetNodes(*block.nodes);
        }
        channel.own = std::move(own);
      }
      channel.photons =
        std::make_unique<PhotonScattering>(block.coloured ? *channel.own : *through, one.seen, block.stepPart);
    }
    this->Channels.push_back(std::move(channel));
  }
}

/// Photons are followed in one channel per run. Returns the factors by which the light of a run is multiplied to give
/// red, green and blue.
/// @param oneRun  whether the same run serves all channels
Rgb ScatteredChannels::ColourOfRun(const PackedPhotons& packed, bool oneRun, int run)
{
  Rgb colour = {};
  colour[static_cast<std::size_t>(run)] = 1.0;
  return oneRun ? packed.colour : colour;
}

void ScatteredChannels::AddTo(
  PhotonLight& light, const PackedPhotons& packed, const Monitor& monitor, const Follower& follow) const
{
  light.light.fluenceDirect = light.light.fluence;
  light.light.balance = {};
  light.light.facePowerOut = {};
  const bool oneRun = this->Channels.size() == 1 && packed.channels == 1;
  const int runs = oneRun ? 1 : 3;
  std::vector<float> flow(light.meanDirection.size(), 0.0f);
  for (int run = 0; run < runs; ++run)
  {
    const double all = runs;
    const std::size_t of = this->Channels.size() == 1 ? 0 : static_cast<std::size_t>(run);
    const double power = oneRun || packed.channels == 3 ? 1.0 : packed.colour[static_cast<std::size_t>(run)];
    const ScatteredPhotons found = follow(this->Channels[of].photons.get(),
      OneChannel(packed, packed.channels == 3 ? run : 0, power, PhotonScattering::DepositsPerEvent),
      OfPart(monitor, run / all, (run + 1) / all));
    const Rgb colour = ColourOfRun(packed, oneRun, run);
    AddRun(found, colour, light);
    for (std::size_t i = 0; i < flow.size(); ++i)
    {
      flow[i] += static_cast<float>(Sum(colour) * found.flow[i]);
    }
  }
  const auto channels = static_cast<std::size_t>(light.light.channels);
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    double all = 0.0, direct = 0.0;
    for (std::size_t c = 0; c < channels; ++c)
    {
      // A single channel stands for three equal ones: the power summed over red, green and blue is three times its own.
      const double counts = channels == 1 ? 3.0 : 1.0;
      all += counts * light.light.fluence[i / 3 * channels + c];
      direct += counts * light.light.fluenceDirect[i / 3 * channels + c];
    }
    light.meanDirection[i] = all > 0.0 ? static_cast<float>((direct * light.meanDirection[i] + flow[i]) / all) : 0.0f;
  }
}

namespace
{
constexpr double ManyScatterings = 1e5;     ///< scatterings of a photon from which on a march is warned of
constexpr std::size_t MostExamined = 10000; ///< number of photons of a rank that are examined
/// Extrapolation length of Milne's problem, transport mean free paths: the distance from a box at which the diffuse
/// light inside, extrapolated, vanishes.
constexpr double Extrapolation = 0.7104;
/// Absorption optical depth at which a photon's power is so small that it ends by Russian roulette (ScatterPhotons.cl).
constexpr double DepthToEnd = 3.0;

/// Mean length of the path of a photon that diffuses in a slab, until it leaves or ends.
/// @param transport  transport coefficient, 1 / length
/// @param ends  probability per length that it ends by absorption
/// @param depth, thickness  of the photon and of the slab, length
double PathInSlab(double transport, double ends, double depth, double thickness)
{
  const double beyond = Extrapolation / transport, left = depth + beyond, right = thickness - depth + beyond;
  const double k = std::sqrt(3.0 * transport * ends);
  return k * (left + right) < 1e-4
    ? 1.5 * transport * left * right
    : std::expm1(-k * left) * std::expm1(-k * right) / (ends * (1.0 + std::exp(-k * (left + right))));
}

/// Four times the volume of a box, divided by its surface: the mean length of paths from face to face, whatever
/// scatters in it.
double MeanPath(const Grid& grid)
{
  const double x = grid.Length(0), y = grid.Length(1), z = grid.Length(2);
  return 2.0 * x * y * z / (x * y + y * z + z * x);
}
}

ScatteringForecast::ScatteringForecast(const Domain& domain, const Medium& medium)
{
  std::vector<double> sums(9, 0.0);
  const std::size_t voxels = domain.IsEmpty() ? 0 : medium.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      sums[c] += medium.sigma_s.At(i, c);
      sums[3 + c] += medium.TransportSigmaS(i, c);
      sums[6 + c] += medium.sigma_a.At(i, c);
    }
  }
  sums = domain.Sum(sums);
  for (double& sum : sums)
  {
    sum /= static_cast<double>(domain.Whole().VoxelCount());
  }
  std::copy_n(sums.begin(), 3, this->Scattering.begin());
  std::copy_n(sums.begin() + 3, 3, this->Transport.begin());
  std::copy_n(sums.begin() + 6, 3, this->Absorption.begin());
}

double ScatteringForecast::Scatterings(const Grid& whole, const Photon& photon, int channel) const
{
  const double scatters = this->Scattering[channel], transport = this->Transport[channel];
  if (scatters <= 0.0 || transport <= 0.0)
  {
    return 0.0;
  }
  const double ends = this->Absorption[channel] / DepthToEnd;
  double perLength = -2.0 * ends; // reciprocal of the path's length; each axis counts absorption
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = whole.Length(axis), start = photon.position[axis] - whole.origin[axis];
    const double depth = std::clamp(start + photon.direction[axis] / transport, 0.0, length);
    const double path = PathInSlab(transport, ends, depth, length);
    if (start <= 0.0 || start >= length)
    {
      // Light that enters through a face leaves by the sides, too, unless it is absorbed before.
      const double part = path / PathInSlab(transport, 0.0, depth, length);
      return scatters * path * std::pow(MeanPath(whole) / (2.0 * length), part);
    }
    perLength += 1.0 / path;
  }
  return scatters / perLength;
}

double ScatteringForecast::Scatterings(const Domain& domain, const std::vector<Photon>& share) const
{
  std::vector<double> sums(6, 0.0); // scatterings by channel, and number of photons with power in it
  const std::size_t stride = share.size() / MostExamined + 1;
  for (std::size_t i = 0; i < share.size(); i += stride)
  {
    for (int c = 0; c < 3; ++c)
    {
      const bool shines = share[i].power[c] > 0.0f;
      sums[c] += shines ? this->Scatterings(domain.Whole(), share[i], c) : 0.0;
      sums[3 + c] += shines ? 1.0 : 0.0;
    }
  }
  sums = domain.Sum(sums);
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    most = std::max(most, sums[c] / std::max(sums[3 + c], 1.0));
  }
  return most;
}

std::string ScatteringForecast::Warning(const Domain& domain, const std::vector<Photon>& share, int maximumOrders) const
{
  const double each = this->Scatterings(domain, share);
  const double followed = maximumOrders > 0 ? std::min(each, maximumOrders - 1.0) : each;
  const double all = followed * domain.Sum(static_cast<double>(share.size()));
  return followed > ManyScatterings ? "Each photon is scattered some " + Text("%.0e", followed) +
      " times before it leaves the medium or is absorbed, " + Text("%.0e", all) +
      " times in all, at some 1e7 a second and core. Take fewer photons, set MaximumOrders to 1 and "
      "compute scattered light by Light Propagation Maps (Uncollided Light), or use those alone."
                                    : "";
}
}
