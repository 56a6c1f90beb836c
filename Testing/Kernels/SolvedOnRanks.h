#pragma once

// Solvers on several ranks, which are threads of this process: scenes that are cut into blocks, the light that the
// ranks find together, and that it is the light of a serial solve.

#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"
#include "OnRanks.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "Light/KeptLight.h"

#include <algorithm>
#include <array>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <vector>

/// A scene with all that solvers read by voxel, of which each rank gets its block.
struct MediumToCut
{
  explicit MediumToCut(std::array<int, 3> size)
    : scene(size)
  {
  }

  tyndall::Field Index() const { return { this->ior.empty() ? nullptr : this->ior.data(), 1 }; }
  const tyndall::Grid& Grid() const { return this->scene.medium.grid; }
  void Attach()
  {
    if (this->scene.sigma_a.empty())
    {
      return; // the block of a rank without voxels
    }
    this->scene.Attach();
    if (!this->given.empty())
    {
      this->scene.light.uncollided.fluence = { this->given.data(), this->scene.ComponentsOf(this->given) };
      this->scene.light.uncollided.meanDirection = { this->ways.data(), 3 };
    }
    if (!this->g.empty())
    {
      this->scene.medium.phase = tyndall::PhaseOfMedium(
        tyndall::PhaseFunction::HenyeyGreenstein(0.1), { this->g.data(), this->scene.ComponentsOf(this->g) });
    }
  }

  MediumToCut Part(const tyndall::Domain& domain) const
  {
    MediumToCut part(domain.Own().size);
    const auto cut = [&](const std::vector<float>& values) { return BlockOf(domain, values); };
    part.scene.light = this->scene.light;
    part.scene.light.uncollided.fluence = part.scene.light.uncollided.meanDirection = {};
    part.scene.sigma_a = cut(this->scene.sigma_a);
    part.scene.sigma_s = cut(this->scene.sigma_s);
    part.scene.emission = cut(this->scene.emission);
    part.scene.medium.phase = this->scene.medium.phase;
    part.scene.medium.grid.spacing = this->scene.medium.grid.spacing;
    part.scene.medium.grid.origin = this->scene.medium.grid.origin;
    part.ior = cut(this->ior);
    part.g = cut(this->g);
    part.given = cut(this->given);
    part.ways = cut(this->ways);
    part.Attach();
    return part;
  }

  Scene scene;
  std::vector<float> ior, g;
  std::vector<float> given, ways; ///< uncollided light and its mean directions; empty: none is given
};

inline std::vector<float> RandomValues(std::size_t count, double least, double most, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(least, most);
  std::vector<float> values(count);
  std::generate(values.begin(), values.end(), [&] { return static_cast<float>(value(random)); });
  return values;
}

/// Thin and thick voxels that emit, under a sun, a sky and faces of different radiance.
inline MediumToCut Everything(std::array<int, 3> size)
{
  MediumToCut medium(size);
  Scene& scene = medium.scene;
  scene.Randomise(2.0, 2.0, 0.8, 11);
  scene.emission = RandomValues(scene.sigma_s.size(), 0.0, 0.2, 3);
  scene.ShineAlong({ 0.3, -0.5, -0.9 });
  scene.ShineFromEverywhere(0.1);
  for (std::size_t face = 0; face < 6; ++face)
  {
    scene.light.faces[face].fill(0.1 * static_cast<double>(face));
  }
  medium.ior = RandomValues(scene.sigma_s.size(), 1.0, 1.6, 5);
  return medium;
}

/// A point, a spot that shines in from beside the box, and a rectangle.
inline void AddNearLamps(Scene& scene)
{
  const auto place = [&scene](double x, double y, double z) {
    const tyndall::Grid& grid = scene.medium.grid;
    return std::array<double, 3>{ grid.origin[0] + x * grid.Length(0), grid.origin[1] + y * grid.Length(1),
      grid.origin[2] + z * grid.Length(2) };
  };
  tyndall::Light point;
  point.type = tyndall::LightType::Point;
  point.position = place(0.35, 0.6, 0.45);
  point.power = { 3.0, 3.0, 3.0 };
  tyndall::Light spot = point;
  spot.type = tyndall::LightType::Spot;
  spot.position = place(-0.5, 0.4, 1.2);
  spot.direction = { 0.9, 0.1, -0.6 };
  spot.angle = 40.0;
  tyndall::Light rectangle = point;
  rectangle.type = tyndall::LightType::Rectangle;
  rectangle.position = place(0.7, 1.1, 0.5);
  rectangle.direction = { -0.2, -0.9, 0.3 };
  rectangle.size = { 1.3, 0.7 };
  scene.light.lights.insert(scene.light.lights.end(), { point, spot, rectangle });
}

/// Uncollided light of another solver instead of that of lamps.
inline void GiveLight(MediumToCut& medium, bool colour)
{
  const std::size_t voxels = medium.Grid().VoxelCount();
  medium.given = RandomValues((colour ? 3 : 1) * voxels, 0.1, 2.0, 7);
  medium.ways = RandomValues(3 * voxels, -0.57, 0.57, 8);
  medium.scene.light.lights.clear();
  medium.scene.light.sky = {};
  medium.scene.light.faces = {};
  for (std::size_t face = 0; face < 6; ++face)
  {
    medium.scene.light.uncollided.escaped[face].fill(0.5 * static_cast<double>(face));
  }
}

/// Blocks of different sizes, of which the third is empty and the edges of others end at the face of one.
inline tyndall::BlockPartition Uneven(const tyndall::Grid& grid)
{
  const auto [x, y, z] = grid.size;
  const int cutX = x / 3, cutY = y / 4, cutZ = 2 * z / 3;
  return { grid,
    { { { 0, 0, 0 }, { cutX, cutY, z } }, { { 0, cutY, 0 }, { cutX, y - cutY, z } }, {},
      { { cutX, 0, 0 }, { x - cutX, y, cutZ } }, { { cutX, 0, cutZ }, { x - cutX, y, z - cutZ } } } };
}

/// Cut by planes across x at these voxels.
inline tyndall::BlockPartition Slices(const tyndall::Grid& grid, std::vector<int> cuts)
{
  tyndall::BlockPartition partition = { grid, {} };
  cuts.push_back(grid.size[0]);
  int first = 0;
  for (const int cut : cuts)
  {
    partition.blocks.push_back({ { first, 0, 0 }, { cut - first, grid.size[1], grid.size[2] } });
    first = cut;
  }
  return partition;
}

/// A block for each voxel.
inline tyndall::BlockPartition SingleVoxels(const tyndall::Grid& grid)
{
  tyndall::BlockPartition partition = { grid, {} };
  for (std::size_t voxel = 0; voxel < grid.VoxelCount(); ++voxel)
  {
    partition.blocks.push_back({ grid.VoxelAt(voxel), { 1, 1, 1 } });
  }
  return partition;
}

/// Solves one rank's block.
using SolveBlock = std::function<tyndall::LightField(const tyndall::Domain&, MediumToCut& part)>;

/// The light of all blocks put together; results that are not by voxel must be the same on all ranks.
inline tyndall::LightField LightOnRanks(
  const tyndall::BlockPartition& partition, const MediumToCut& medium, const SolveBlock& solve)
{
  using tyndall::LightField;
  constexpr std::vector<float> LightField::*ByVoxel[] = { &LightField::fluence, &LightField::fluenceDirect,
    &LightField::fluenceError, &LightField::netFlux, &LightField::scatteredRadiance, &LightField::scatteredMoments,
    &LightField::straightOn };
  const std::vector<tyndall::VoxelBox>& blocks = partition.blocks;
  const auto first =
    std::find_if(blocks.begin(), blocks.end(), [](const tyndall::VoxelBox& block) { return block.VoxelCount() > 0; });
  std::vector<LightField> found(blocks.size());
  LightField all;
  std::mutex guard;
  tyndall::RunInThreads(static_cast<int>(blocks.size()), [&](tyndall::Communicator& communicator) {
    const tyndall::Domain domain(communicator, partition);
    MediumToCut part = medium.Part(domain);
    found[domain.Rank()] = solve(domain, part);
    const std::lock_guard<std::mutex> lock(guard);
    for (const auto array : ByVoxel)
    {
      std::vector<float>& own = found[domain.Rank()].*array;
      const std::size_t width = domain.IsEmpty() ? 0 : own.size() / domain.Own().VoxelCount();
      (all.*array).resize(std::max((all.*array).size(), width * partition.whole.VoxelCount()));
      PutBlock(domain, own, all.*array);
      own.clear();
    }
  });
  LightField whole = found[first - blocks.begin()];
  for (const LightField& light : found)
  {
    EXPECT_EQ(light.facePowerOut, whole.facePowerOut);
    EXPECT_EQ(light.balance.absorbed, whole.balance.absorbed);
    EXPECT_EQ(light.convergence.size(), whole.convergence.size());
    EXPECT_EQ(light.surfaceRadiance, whole.surfaceRadiance);
    EXPECT_EQ(light.relativeError, whole.relativeError);
    EXPECT_EQ(light.sweepsSaved, whole.sweepsSaved);
    EXPECT_EQ(light.leftOut, whole.leftOut);
    EXPECT_EQ(light.doubts, whole.doubts);
  }
  for (const auto array : ByVoxel)
  {
    whole.*array = all.*array;
  }
  return whole;
}

/// What each rank says that it cannot do; empty: nothing.
inline std::vector<std::string> ErrorsOnRanks(
  const tyndall::BlockPartition& partition, const std::function<void(const tyndall::Domain&)>& work)
{
  std::vector<std::string> errors(partition.blocks.size());
  tyndall::RunInThreads(static_cast<int>(errors.size()), [&](tyndall::Communicator& communicator) {
    try
    {
      work(tyndall::Domain(communicator, partition));
    }
    catch (const std::exception& error)
    {
      errors[communicator.Rank()] = error.what();
    }
  });
  return errors;
}

/// Absorbed power is sigma_a times fluence, and power in is power out.
inline void ExpectEnergyKept(const MediumToCut& medium, const tyndall::LightField& light)
{
  EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
  const tyndall::Field& sigma_a = medium.scene.medium.sigma_a;
  for (int c = 0; c < light.channels; ++c)
  {
    double absorbed = 0.0;
    for (std::size_t i = 0; i < medium.Grid().VoxelCount(); ++i)
    {
      EXPECT_GE(light.fluence[i * light.channels + c], 0.0f);
      absorbed += sigma_a.At(i, c) * light.fluence[i * light.channels + c];
    }
    EXPECT_NEAR(absorbed * medium.Grid().VoxelVolume(), light.balance.absorbed[c],
      1e-4 * (light.balance.entered[c] + light.balance.emitted[c]));
  }
}

/// That two solves have the same light, powers and warnings.
/// @param tolerance  of fluence and powers, relative to the largest; of uncollided light 1e-6
/// @param wraps  around a periodic axis, in laps that each light all voxels: most of the flux cancels, and is compared
///   with the fluence
inline void ExpectSameLight(
  const tyndall::LightField& found, const tyndall::LightField& expected, double tolerance, bool wraps = false)
{
  const auto largest = [](const std::vector<float>& values) {
    return values.empty() ? 0.0f : *std::max_element(values.begin(), values.end());
  };
  const double flux = largest(expected.netFlux), fluence = largest(expected.fluence);
  EXPECT_LT(RelativeDifference(found.fluence, expected.fluence), tolerance);
  EXPECT_LT(RelativeDifference(found.fluenceDirect, expected.fluenceDirect), 1e-6);
  EXPECT_LT(
    RelativeDifference(found.netFlux, expected.netFlux) * (wraps ? flux / std::max<double>(flux, fluence) : 1.0),
    2.0 * tolerance);
  EXPECT_LT(RelativeDifference(found.scatteredMoments, expected.scatteredMoments), tolerance);
  EXPECT_LT(RelativeDifference(found.facePower, expected.facePower), tolerance);
  EXPECT_LT(RelativeDifference(found.surfaceRadiance, expected.surfaceRadiance), tolerance);
  EXPECT_EQ(found.straightOn, expected.straightOn);
  EXPECT_EQ(found.lampsApart.size(), expected.lampsApart.size());
  EXPECT_EQ(found.faceAlbedo, expected.faceAlbedo);
  EXPECT_EQ(found.converged, expected.converged);
  for (std::size_t c = 0; c < static_cast<std::size_t>(expected.channels); ++c)
  {
    const double all = expected.balance.entered[c] + expected.balance.emitted[c];
    EXPECT_NEAR(found.balance.entered[c], expected.balance.entered[c], 1e-6 * all);
    EXPECT_NEAR(found.balance.emitted[c], expected.balance.emitted[c], 1e-6 * all);
    EXPECT_NEAR(found.balance.absorbed[c], expected.balance.absorbed[c], tolerance * all);
    for (std::size_t face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(found.facePowerOut[face][c], expected.facePowerOut[face][c], tolerance * all);
    }
  }
}

/// A solver for tests of all: its settings, here such that one rank and several take the same steps, and how well their
/// light agrees then.
struct ConservativeSolver
{
  using Settings = tyndall::PropagationSettings;
  static constexpr double Tolerance = 2e-6;
  static constexpr bool SameSteps = true;
  static constexpr std::size_t LeastMemory = 1000; ///< bytes of which no check says beforehand that they do not suffice
  static Settings Plain(int orders = 0)
  {
    Settings settings;
    settings.directionsPerFace = 9;
    settings.maximumOrders = orders;
    settings.netFlux = true;
    settings.acceleration = tyndall::PropagationAcceleration::None;
    settings.source = tyndall::PropagationSource::Constant;
    settings.uncollidedDirections = 0;
    settings.emissionError = 0.0;
    return settings;
  }
  static tyndall::LightField Solve(tyndall::Device& device, const tyndall::Domain& domain, const MediumToCut& part,
    const Settings& settings, const tyndall::Monitor& monitor = {}, tyndall::KeptLight* kept = nullptr)
  {
    return tyndall::SolveConservative(device, domain, part.scene.medium, part.scene.light, settings, monitor, kept);
  }
};
struct OrdinatesSolver
{
  using Settings = tyndall::OrdinatesSettings;
  static constexpr double Tolerance = 1e-6;
  static constexpr bool SameSteps = true;
  static constexpr std::size_t LeastMemory = 150000;
  static Settings Plain(int orders = 0)
  {
    Settings settings;
    settings.directionsPerFace = 9;
    settings.terms = 16;
    settings.netFlux = true;
    settings.maximumOrders = orders;
    settings.acceleration = tyndall::PropagationAcceleration::None;
    return settings;
  }
  static tyndall::LightField Solve(tyndall::Device& device, const tyndall::Domain& domain, const MediumToCut& part,
    const Settings& settings, const tyndall::Monitor& monitor = {}, tyndall::KeptLight* kept = nullptr)
  {
    return tyndall::SolveDiscreteOrdinates(
      device, domain, part.scene.medium, part.scene.light, settings, monitor, kept);
  }
};
struct LatticeSolver
{
  using Settings = tyndall::LatticeSettings;
  static constexpr double Tolerance = 2e-6; ///< of light that is solved to 1e-7, in other steps
  static constexpr bool SameSteps = false;
  static constexpr std::size_t LeastMemory = 1000;
  static Settings Plain(int = 0)
  {
    Settings settings;
    settings.tolerance = 1e-7;
    settings.netFlux = true;
    return settings;
  }
  static tyndall::LightField Solve(tyndall::Device& device, const tyndall::Domain& domain, const MediumToCut& part,
    const Settings& settings, const tyndall::Monitor& monitor = {})
  {
    return tyndall::SolveLatticeBoltzmann(
      device, domain, part.scene.medium, part.Index(), part.scene.light, settings, monitor);
  }
};

/// A solver on one rank and on several: the light is the same, keeps its energy, and fails with the same words.
template <class Solver>
class SolvedOnRanks : public DeviceTest
{
protected:
  using Settings = typename Solver::Settings;

  tyndall::LightField Serial(MediumToCut& medium, const Settings& settings)
  {
    medium.Attach();
    return Solver::Solve(this->GetDevice(), tyndall::Domain(medium.Grid()), medium, settings);
  }
  tyndall::LightField OnRanks(
    const tyndall::BlockPartition& partition, const MediumToCut& medium, const Settings& settings)
  {
    return LightOnRanks(partition, medium, [&](const tyndall::Domain& domain, MediumToCut& part) {
      return Solver::Solve(this->GetDevice(), domain, part, settings);
    });
  }

  /// @return the serial light
  tyndall::LightField ExpectSerialLight(MediumToCut& medium, const Settings& settings,
    const tyndall::BlockPartition& partition, double tolerance = Solver::Tolerance)
  {
    const tyndall::LightField serial = this->Serial(medium, settings);
    const tyndall::LightField found = this->OnRanks(partition, medium, settings);
    const std::array<bool, 3>& wraps = settings.periodic;
    ExpectSameLight(found, serial, tolerance, wraps[0] || wraps[1] || wraps[2]);
    EXPECT_EQ(found.doubts, serial.doubts);
    if (Solver::SameSteps)
    {
      EXPECT_EQ(found.convergence.size(), serial.convergence.size());
      EXPECT_EQ(found.directionsPerFace, serial.directionsPerFace);
      EXPECT_EQ(found.uncollidedDirections, serial.uncollidedDirections);
    }
    ExpectEnergyKept(medium, serial);
    ExpectEnergyKept(medium, found);
    return serial;
  }
  tyndall::LightField ExpectSerialLight(MediumToCut& medium, const Settings& settings = Solver::Plain())
  {
    return this->ExpectSerialLight(medium, settings, Uneven(medium.Grid()));
  }

  using Change = std::function<void(int rank, MediumToCut& part, Settings& settings, tyndall::Monitor& monitor)>;

  /// Three ranks, of which some are given other things, report one error.
  void ExpectErrors(const std::string& words, const Change& change)
  {
    MediumToCut medium = Everything({ 6, 5, 4 });
    const std::vector<std::string> errors =
      ErrorsOnRanks(tyndall::BlockPartition::Even(medium.Grid(), 3), [&](const tyndall::Domain& domain) {
        MediumToCut part = medium.Part(domain);
        Settings settings = Solver::Plain();
        tyndall::Monitor monitor;
        change(domain.Rank(), part, settings, monitor);
        Solver::Solve(this->GetDevice(), domain, part, settings, monitor);
      });
    EXPECT_NE(errors[0].find(words), std::string::npos) << errors[0];
    EXPECT_EQ(errors, std::vector<std::string>(errors.size(), errors[0]));
  }
};
