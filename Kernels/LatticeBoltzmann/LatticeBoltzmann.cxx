#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include "Device/Buffer.h"
#include "Device/Clock.h"
#include "Device/Defines.h"
#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr double CubesTo = 1e-3;   ///< edges of a voxel may differ by so much
constexpr int StepsPerLook = 16;   ///< after which it is looked at how much changes
constexpr int MostSteps = 200000;  ///< where the tolerance is not met
constexpr double Slowest = 0.9999; ///< of changes from look to look: beyond, their rest is not known

void CheckCubes(const Grid& grid)
{
  const auto [least, most] = std::minmax_element(grid.spacing.begin(), grid.spacing.end());
  if (*most > (1.0 + CubesTo) * *least)
  {
    throw InvalidInput("The lattice's voxels have to be cubes; their edges are " + Text("%.6g", grid.spacing[0]) +
      ", " + Text("%.6g", grid.spacing[1]) + ", " + Text("%.6g", grid.spacing[2]) + ". Resample the image.");
  }
}

PropagationSettings AsPropagation(const LatticeSettings& settings)
{
  PropagationSettings of;
  of.periodic = settings.periodic;
  of.source = PropagationSource::Constant; // voxels stay cubes in slabs, too
  return of;
}

/// Light that is not scattered, as an image and with its arrays.
struct Uncollided
{
  std::vector<float> fluence;
  UncollidedImage image;
};

/// That which is given, or else that of lamps and environment along the maps' rays. Nothing is truncated: the medium
/// counts as scattering evenly.
Uncollided FindUncollided(
  Device& device, const PropagationProblem& problem, const LatticeSettings& settings, const Monitor& monitor)
{
  Uncollided found;
  found.image = problem.Shining().uncollided;
  if (found.image.IsThere())
  {
    return found;
  }
  Medium dark = problem.TheMedium();
  dark.emission = {};
  dark.phase = PhaseFunction();
  PropagationSettings once = AsPropagation(settings);
  once.source = PropagationSource::Automatic;
  once.maximumOrders = 1;
  once.netFlux = false;
  Illumination narrow = problem.Shining(); // what is diffuse comes in on the lattice itself
  narrow.sky = {};
  narrow.faces = {};
  narrow.faceAlbedo = {};
  if (!Shines(narrow))
  {
    found.fluence.assign(problem.TheGrid().VoxelCount(), 0.0f);
    found.image.fluence = { found.fluence.data(), 1 };
    return found;
  }
  LightField light = SolveConservative(device, dark, narrow, once, monitor);
  found.fluence = std::move(light.fluenceDirect);
  found.image.fluence = { found.fluence.data(), light.channels };
  found.image.escaped = light.facePowerOut;
  return found;
}

constexpr int Ways[18][3] = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 },
  { 1, 1, 0 }, { -1, -1, 0 }, { 1, -1, 0 }, { -1, 1, 0 }, { 1, 0, 1 }, { -1, 0, -1 }, { 1, 0, -1 }, { -1, 0, 1 },
  { 0, 1, 1 }, { 0, -1, -1 }, { 0, 1, -1 }, { 0, -1, 1 } }; // as LatticeStep.cl has them
constexpr int Width = 16;                                   ///< of the kernel's vectors

float WeightOf(int directions, int i)
{
  return directions == 6 ? 1.0f / 6.0f : i < 6 ? 1.0f / 12.0f : 1.0f / 24.0f;
}

/// The lattice of one channel, and its state.
class Lattice
{
public:
  Lattice(Device& device, const PropagationProblem& problem, const Field& ior, const LatticeSettings& settings,
    const UncollidedImage& uncollided, int channel);

  void Settle(const Monitor& monitor);
  void AddTo(LightField& light);

private:
  void LayOut();
  void Load(const Field& ior);
  void FillDensities();
  void Step(bool writes);
  double Change();
  std::vector<float> Leaving(const Buffer<float>& densities, const LatticeInfo& info);
  void CountFaces(LightField& light, double& entered);

  /// A value of each place of the lattice: inside(voxel), or outside(face, nearest voxel).
  template <class Inside, class Outside>
  std::vector<float> Arrange(const Inside& inside, const Outside& outside) const;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const LatticeSettings& Settings;
  const UncollidedImage& Direct;
  int Channel;
  double Edge;
  bool Bends = false, PassesAll = true, Reflects = false;
  LatticeInfo Info = {};
  std::array<float, 6> Incoming = {}; ///< W / length^2: fluence of the diffuse light outside -x, +x, ... +z
  std::vector<float> Lost;            ///< part that is absorbed in a step
  std::vector<float> Passes;          ///< part that links let through
  double Given = 0.0;                 ///< above 0: something shines
  cl::Kernel StepKernel, Wrap;
  Buffer<float> Resistance, Turning, Kept, Squared, Albedo, Source, Fluence;
  Buffer<float> Densities[2];
  std::vector<float> Last; ///< fluence when it was looked at last
  double LastChange = 0.0;
  std::vector<ConvergenceRow> Rows;
  double Start = ClockSeconds();
};

Lattice::Lattice(Device& device, const PropagationProblem& problem, const Field& ior, const LatticeSettings& settings,
  const UncollidedImage& uncollided, int channel)
  : TheDevice(device)
  , Problem(problem)
  , Settings(settings)
  , Direct(uncollided)
  , Channel(channel)
  , Edge(problem.TheGrid().spacing[0])
{
  const std::size_t voxels = problem.TheGrid().VoxelCount();
  for (std::size_t face = 0; face < 6; ++face)
  {
    const Illumination& shining = problem.Shining();
    const auto c = static_cast<std::size_t>(channel);
    const double radiance = shining.sky[c] + shining.faces[face][c];
    this->Incoming[face] = static_cast<float>(4.0 * Pi * radiance);
    this->Info.albedo[face] = static_cast<float>(shining.faceAlbedo[face][c]);
    this->Reflects = this->Reflects || this->Info.albedo[face] > 0.0f;
    this->Given += radiance;
  }
  this->LayOut();
  this->Load(ior);
  this->FillDensities();
  this->Fluence = Buffer<float>(device, voxels, "fluence");
  this->Fluence.Fill(0.0f);
  this->Last.assign(voxels, 0.0f);
  const std::string options = Define("DIRECTIONS", settings.directions) + Define("BENDS", this->Bends) +
    Define("PASSES_ALL", this->PassesAll) + Define("REFLECTS", this->Reflects);
  this->StepKernel = device.Kernel("step_lattice", kernel_source::LatticeStep, options);
  this->Wrap = device.Kernel("wrap_lattice", kernel_source::LatticeStep, options);
}

void Lattice::LayOut()
{
  const std::array<int, 3>& size = this->Problem.TheGrid().size;
  std::copy(size.begin(), size.end(), this->Info.size);
  this->Info.row = size[0] + 2;
  this->Info.layer = this->Info.row * (size[1] + 2);
  for (int i = 0; i < 18; ++i)
  {
    this->Info.offset[i] = Ways[i][0] + Ways[i][1] * this->Info.row + Ways[i][2] * this->Info.layer;
  }
  // Vectors that begin in the last row may be read whole.
  this->Info.stride = static_cast<cl_ulong>(this->Info.layer) * (size[2] + 2) + Width;
}

template <class Inside, class Outside>
std::vector<float> Lattice::Arrange(const Inside& inside, const Outside& outside) const
{
  const std::array<int, 3>& size = this->Problem.TheGrid().size;
  std::vector<float> values(this->Info.stride, 0.0f);
  std::array<int, 3> at;
  for (at[2] = -1; at[2] <= size[2]; ++at[2])
  {
    for (at[1] = -1; at[1] <= size[1]; ++at[1])
    {
      for (at[0] = -1; at[0] <= size[0]; ++at[0])
      {
        int face = -1;
        std::array<int, 3> near = at;
        for (int a = 0; a < 3; ++a)
        {
          const bool beyond = at[a] < 0 || at[a] >= size[a];
          face = face < 0 && beyond && !this->Settings.periodic[a] ? 2 * a + (at[a] < 0 ? 0 : 1) : face;
          near[a] = !beyond              ? at[a]
            : this->Settings.periodic[a] ? (at[a] + size[a]) % size[a]
                                         : std::clamp(at[a], 0, size[a] - 1);
        }
        const std::size_t voxel = (static_cast<std::size_t>(near[2]) * size[1] + near[1]) * size[0] + near[0];
        const std::size_t place = static_cast<std::size_t>(at[2] + 1) * this->Info.layer +
          static_cast<std::size_t>(at[1] + 1) * this->Info.row + static_cast<std::size_t>(at[0] + 1);
        values[place] = face < 0 ? inside(voxel) : outside(face, voxel);
      }
    }
  }
  return values;
}

/// What voxels do to light, by their transport extinction over an edge, s (numerics.md, Eqs. (L2) to (L5)).
void Lattice::Load(const Field& ior)
{
  const Medium& medium = this->Problem.TheMedium();
  std::vector<float> turning, squared, source;
  const double squares = this->Settings.directions == 6 ? 1.0 / 3.0 : 0.5; // of the links' ways, along an axis
  const double most = 2.0 / (3.0 * squares); // thickness of which every collision is even, and links pass all
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double s = this->Edge * medium.TransportSigmaT(i, this->Channel);
    turning.push_back(static_cast<float>(s > 0.0 ? std::min(1.0, 1.0 / (0.5 + 0.5 * most / s)) : 0.0));
    this->Passes.push_back(static_cast<float>(s > most ? most / s : 1.0));
    this->PassesAll = this->PassesAll && this->Passes.back() == 1.0f;
    this->Lost.push_back(static_cast<float>(-std::expm1(-this->Edge * medium.sigma_a.At(i, this->Channel))));
    source.push_back(static_cast<float>(this->Edge *
      (medium.sigma_s.At(i, this->Channel) * this->Direct.fluence.At(i, this->Channel) +
        4.0 * Pi * medium.emission.At(i, this->Channel))));
    this->Given += source.back();
    squared.push_back(ior.values ? ior.At(i, 0) * ior.At(i, 0) : 1.0f);
    this->Bends = this->Bends || squared.back() != squared.front();
  }
  const auto arranged = [&](const std::vector<float>& values, float beyond, const char* what) {
    return Buffer<float>(this->TheDevice,
      this->Arrange([&](std::size_t voxel) { return values[voxel]; }, [&](int, std::size_t) { return beyond; }), what);
  };
  this->Turning = arranged(turning, 0.0f, "how voxels scatter");
  this->Source = arranged(source, 0.0f, "sources");
  this->Kept = Buffer<float>(this->TheDevice,
    this->Arrange([&](std::size_t voxel) { return 1.0f - this->Lost[voxel]; }, [](int, std::size_t) { return 1.0f; }),
    "how voxels absorb");
  this->Resistance = Buffer<float>(this->TheDevice,
    this->Arrange([&](std::size_t voxel) { return 1.0f / this->Passes[voxel]; }, [](int, std::size_t) { return 1.0f; }),
    "how links pass light");
  if (this->Bends) // outside, the index is that of the voxels there
  {
    const auto at = [&](std::size_t voxel) { return squared[voxel]; };
    this->Squared =
      Buffer<float>(this->TheDevice, this->Arrange(at, [&](int, std::size_t voxel) { return squared[voxel]; }), "n^2");
  }
  if (this->Reflects)
  {
    this->Albedo = Buffer<float>(this->TheDevice,
      this->Arrange([](std::size_t) { return 0.0f; }, [&](int face, std::size_t) { return this->Info.albedo[face]; }),
      "the faces' albedo");
  }
}

/// Dark, but for what comes in from outside.
void Lattice::FillDensities()
{
  const std::vector<float> incoming = this->Arrange([](std::size_t) { return 0.0f; },
    [&](int face, std::size_t) { return this->Incoming[static_cast<std::size_t>(face)]; });
  std::vector<float> densities;
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    for (float fluence : incoming)
    {
      densities.push_back(WeightOf(this->Settings.directions, i) * fluence);
    }
  }
  this->Densities[0] = Buffer<float>(this->TheDevice, densities, "photon density");
  this->Densities[1] = Buffer<float>(this->TheDevice, densities, "photon density");
}

void Lattice::Step(bool writes)
{
  const std::array<int, 3>& size = this->Problem.TheGrid().size;
  const int steps[3] = { 1, this->Info.row, this->Info.layer };
  cl::CommandQueue& queue = this->TheDevice.Queue();
  for (int a = 0; a < 3; ++a)
  {
    if (this->Settings.periodic[a])
    {
      const int u = (a + 1) % 3, v = (a + 2) % 3;
      With(this->Wrap, this->Densities[0], this->Info.stride, cl_int(steps[u]), cl_int(steps[v]), cl_int(steps[a]),
        cl_int(size[a]));
      queue.enqueueNDRangeKernel(
        this->Wrap, cl::NullRange, cl::NDRange(size[u] + 2, size[v] + 2, this->Settings.directions));
    }
  }
  With(this->StepKernel, this->Info, this->Resistance, this->Turning, this->Kept, this->Squared, this->Albedo,
    this->Source, this->Densities[0], this->Densities[1], this->Fluence, cl_int(writes));
  queue.enqueueNDRangeKernel(this->StepKernel, cl::NullRange, cl::NDRange(size[1], size[2]));
  std::swap(this->Densities[0], this->Densities[1]);
}

/// Of fluence since it was looked at last, relative.
double Lattice::Change()
{
  const std::vector<float> now = this->Fluence.Read();
  double change = 0.0, all = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    change += std::abs(static_cast<double>(now[i]) - this->Last[i]);
    all += now[i];
  }
  this->Last = now;
  return all > 0.0 ? change / all : 0.0;
}

void Lattice::Settle(const Monitor& monitor)
{
  const int most = this->Settings.maximumSteps > 0 ? this->Settings.maximumSteps : MostSteps;
  double residual = this->Given > 0.0 ? 1.0 : 0.0;
  for (int step = 0; step < most && residual > (this->Settings.maximumSteps > 0 ? -1.0 : this->Settings.tolerance);)
  {
    const int steps = std::min(StepsPerLook, most - step);
    for (int i = 0; i < steps; ++i)
    {
      this->Step(i + 1 == steps);
    }
    step += steps;
    const double change = this->Change();
    const double ratio = this->LastChange > 0.0 ? std::min(change / this->LastChange, Slowest) : 1.0;
    residual = change == 0.0 ? 0.0 : this->LastChange > 0.0 ? std::min(change * ratio / (1.0 - ratio), 1.0) : 1.0;
    this->LastChange = change;
    ConvergenceRow row;
    row.iteration = step;
    row.seconds = ClockSeconds() - this->Start;
    row.residual = residual;
    row.change = change;
    this->Rows.push_back(row);
    const double done = this->Settings.maximumSteps > 0
      ? static_cast<double>(step) / most
      : std::clamp(std::log(std::max(residual, 1e-30)) / std::log(this->Settings.tolerance), 0.0, 1.0);
    Report(monitor, done);
  }
}

/// W / length^2, [face][voxel].
std::vector<float> Lattice::Leaving(const Buffer<float>& densities, const LatticeInfo& info)
{
  const Grid& grid = this->Problem.TheGrid();
  cl::Kernel leave = this->TheDevice.Kernel("leave_lattice", kernel_source::LatticeStep,
    Define("DIRECTIONS", this->Settings.directions) + Define("BENDS", this->Bends) +
      Define("PASSES_ALL", this->PassesAll) + Define("REFLECTS", this->Reflects));
  const Buffer<float> leaving(this->TheDevice, 6 * grid.VoxelCount(), "light that leaves");
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  With(leave, info, this->Resistance, densities, cl_int(periodic[0] + 2 * periodic[1] + 4 * periodic[2]), leaving);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    leave, cl::NullRange, cl::NDRange(grid.size[0], grid.size[1], grid.size[2]));
  return leaving.Read();
}

/// W that leaves and comes in through the faces.
void Lattice::CountFaces(LightField& light, double& entered)
{
  const std::size_t voxels = this->Problem.TheGrid().VoxelCount();
  const std::size_t c = static_cast<std::size_t>(this->Channel);
  const double area = this->Edge * this->Edge;
  const std::vector<float> through = this->Leaving(this->Densities[0], this->Info);
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    this->Densities[1].Fill(
      WeightOf(this->Settings.directions, i), static_cast<std::size_t>(i) * this->Info.stride, this->Info.stride);
  }
  LatticeInfo black = this->Info;
  std::fill_n(black.albedo, 6, 0.0f);
  const std::vector<float> inwards = this->Leaving(this->Densities[1], black); // of fluence 1 outside, the same way
  for (std::size_t face = 0; face < 6; ++face)
  {
    double power = this->Direct.escaped[face][c];
    entered += this->Direct.escaped[face][c];
    for (std::size_t i = 0; i < voxels; ++i)
    {
      // Of what comes in through links that give back a part, that leaves at once.
      const double entering = area * this->Incoming[face] * inwards[face * voxels + i];
      const double passed = 2.0 * this->Passes[i] / (this->Passes[i] + 1.0);
      power += area * through[face * voxels + i] + entering * (1.0 / passed - 1.0);
      entered += entering / passed;
    }
    light.facePowerOut[face][c] = power;
    light.balance.escaped[c] += power;
  }
}

/// Scattered light beside the uncollided one, and where all power went.
void Lattice::AddTo(LightField& light)
{
  const Medium& medium = this->Problem.TheMedium();
  const std::size_t c = static_cast<std::size_t>(this->Channel);
  const double area = this->Edge * this->Edge;
  double entered = 0.0;
  EnergyBalance& balance = light.balance;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double tau = this->Edge * medium.sigma_a.At(i, this->Channel);
    const double direct = this->Direct.fluence.At(i, this->Channel);
    // Where much is absorbed in a step, fluence is the mean over that.
    const double mean = tau > 1e-6 ? this->Lost[i] / tau : 1.0;
    light.fluence[i * light.channels + c] = static_cast<float>(direct + mean * this->Last[i]);
    light.fluenceDirect[i * light.channels + c] = static_cast<float>(direct);
    balance.absorbed[c] += area * (this->Lost[i] * static_cast<double>(this->Last[i]) + tau * direct);
    balance.emitted[c] += area * this->Edge * 4.0 * Pi * medium.emission.At(i, this->Channel);
    entered += area * direct * (tau + this->Edge * medium.sigma_s.At(i, this->Channel));
  }
  this->CountFaces(light, entered);
  balance.entered[c] = entered;
  // What densities still gain in a step.
  balance.leftOver[c] = entered + balance.emitted[c] - balance.absorbed[c] - balance.escaped[c];
  light.convergence.resize(std::max(light.convergence.size(), this->Rows.size()));
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    ConvergenceRow& sum = light.convergence[row];
    sum.iteration = this->Rows[row].iteration;
    sum.seconds += this->Rows[row].seconds;
    sum.residual = std::max(sum.residual, this->Rows[row].residual);
    sum.change = std::max(sum.change, this->Rows[row].change);
  }
}
}

void Check(const LatticeSettings& settings)
{
  if (settings.directions != 6 && settings.directions != 18)
  {
    throw InvalidInput(
      "A lattice of " + std::to_string(settings.directions) + " directions was asked for; there are 6 and 18.");
  }
  if (settings.maximumSteps < 0)
  {
    throw InvalidInput("MaximumSteps is " + std::to_string(settings.maximumSteps) +
      "; give a number of steps, or 0 for as many as the tolerance needs.");
  }
  if (!(settings.tolerance > 0.0))
  {
    throw InvalidInput("Tolerance is " + std::to_string(settings.tolerance) + "; it must be positive.");
  }
}

LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor)
{
  Check(settings);
  CheckCubes(medium.grid);
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  const Uncollided uncollided = FindUncollided(device, problem, settings, OfPart(monitor, 0.0, 0.1));
  LightField light;
  light.channels = problem.Channels();
  light.fluence.resize(medium.grid.VoxelCount() * static_cast<std::size_t>(light.channels));
  light.fluenceDirect = light.fluence;
  for (int c = 0; c < light.channels; ++c)
  {
    Lattice lattice(device, problem, ior, settings, uncollided.image, c);
    const double all = light.channels;
    lattice.Settle(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    lattice.AddTo(light);
  }
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.device = device.Name();
  if (!medium.phase.IsIsotropic() && problem.Traits().scatters)
  {
    light.leftOut.emplace_back(
      "anisotropy: diffuses as isotropic scattering with sigma_s (1 - g) (similarity relation)");
  }
  light.leftOut.emplace_back(left_out::NetFlux);
  problem.Undo(light);
  PropagationSettings judged = AsPropagation(settings);
  judged.maximumOrders = settings.maximumSteps;
  judged.tolerance = settings.tolerance;
  JudgeConvergence(judged, light);
  if (Reflects(illumination))
  {
    light.doubts.emplace_back(
      "FaceAlbedo gives back diffuse light only, not what leaves without having been scattered.");
  }
  light.faceAlbedo = illumination.faceAlbedo;
  return light;
}
}
