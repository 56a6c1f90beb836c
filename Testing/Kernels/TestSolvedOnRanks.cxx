// Every solver has the light of a serial solve on any number of ranks.

#include "SolvedOnRanks.h"

#include "Device/Device.h"
#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "RanksInThreads.h"

#include <cstddef>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <type_traits>
#include <vector>

using namespace tyndall;

namespace
{
// Solves over ranks of which one has too little memory: for tests of what all then do.

/// By how many bytes more the array would have fit that words of Device say does not; 0: they say something else.
std::size_t BytesMissing(const std::string& words)
{
  std::size_t needed = 0, left = 0;
  const std::size_t numbers = words.find(": ", words.find("Not enough memory"));
  const bool found = numbers != std::string::npos &&
    std::sscanf(words.c_str() + numbers, ": %zu bytes are needed, %zu", &needed, &left) == 2;
  return found && needed > left ? needed - left : 0;
}

/// The last rank has too little memory for an array, for each array in turn that it has more in use with than ever
/// before: all ranks say so with the same words, and none waits for another.
/// @param bytes  that it has at first
/// @param solve  on the device of a rank
void ExpectToFailTogether(tyndall::Device& device, int ranks, std::size_t bytes,
  const std::function<void(tyndall::Device&, tyndall::Communicator&)>& solve)
{
  constexpr double Patience = 10.0; // seconds
  int failed = 0;
  for (std::size_t missing = 1; missing > 0; ++failed)
  {
    tyndall::MemoryBudget budget;
    budget.bytes = bytes;
    std::vector<std::string> said(static_cast<std::size_t>(ranks));
    const auto trySolve = [&](tyndall::Communicator& communicator) {
      try
      {
        tyndall::Device own(device, communicator.Rank() == ranks - 1 ? budget : tyndall::MemoryBudget());
        solve(own, communicator);
      }
      catch (const tyndall::DeviceError& error)
      {
        said[static_cast<std::size_t>(communicator.Rank())] = error.what();
      }
    };
    SCOPED_TRACE(std::to_string(bytes) + " bytes");
    ASSERT_NO_THROW(tyndall::RunInThreads(ranks, trySolve, Patience));
    EXPECT_EQ(said, std::vector<std::string>(said.size(), said[0]));
    missing = BytesMissing(said.back());
    EXPECT_EQ(said.back().empty(), missing == 0) << said.back();
    bytes += missing;
  }
  EXPECT_GT(failed, 5);
}
}

using Solvers = testing::Types<ConservativeSolver, OrdinatesSolver, LatticeSolver>;
TYPED_TEST_SUITE(SolvedOnRanks, Solvers);

namespace
{
void AddEnvironment(Scene& scene, int width, int height, std::size_t peak)
{
  Environment& environment = scene.light.environment;
  environment.width = width;
  environment.height = height;
  environment.radiance = RandomValues(3 * static_cast<std::size_t>(width * height), 0.1, 0.3, 2);
  environment.radiance[3 * peak] = 90.0f;
}
}

TYPED_TEST(SolvedOnRanks, IsTheSerialLight)
{
  MediumToCut medium = Everything({ 12, 9, 7 });
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  medium.scene.medium.grid.spacing[1] = TypeParam::SameSteps ? 0.7 : 1.0; // a lattice has cubes
  this->ExpectSerialLight(medium);
}

/// Four blocks about a fifth, which no plane separates, and blocks of one voxel.
TYPED_TEST(SolvedOnRanks, IsTheSerialLightInBlocksOfAnyShape)
{
  const BlockPartition wheel = { Grid{ { 3, 3, 2 } },
    { { { 0, 0, 0 }, { 2, 1, 2 } }, { { 2, 0, 0 }, { 1, 2, 2 } }, { { 1, 2, 0 }, { 2, 1, 2 } },
      { { 0, 1, 0 }, { 1, 2, 2 } }, { { 1, 1, 0 }, { 1, 1, 2 } } } };
  MediumToCut turning = Everything(wheel.whole.size), small = Everything({ 3, 2, 2 });
  AddNearLamps(small.scene);
  this->ExpectSerialLight(turning, TypeParam::Plain(), wheel);
  this->ExpectSerialLight(small, TypeParam::Plain(), SingleVoxels(small.Grid()));
}

/// Also where the first rank has no voxels.
TYPED_TEST(SolvedOnRanks, HasColoursAndAnyMeanCosines)
{
  MediumToCut medium = Everything({ 6, 7, 5 });
  Scene& scene = medium.scene;
  scene.sigma_s = RandomValues(3 * scene.sigma_a.size(), 0.0, 1.0, 9);
  scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  medium.g = RandomValues(scene.sigma_a.size(), -0.7, 0.7, 13);
  std::fill_n(medium.g.begin(), medium.g.size() / 2, 0.6f); // the same on one rank
  EXPECT_EQ(this->ExpectSerialLight(medium, TypeParam::Plain(), Slices(medium.Grid(), { 0, 1 })).channels, 3);
}

TYPED_TEST(SolvedOnRanks, HasAnEnvironment)
{
  MediumToCut medium({ 10, 9, 8 });
  medium.scene.Randomise(0.2, 1.0, 0.95, 4);
  AddEnvironment(medium.scene, 16, 8, 37);
  this->ExpectSerialLight(medium);
}

/// Points, spots and rectangles; in units in which a float holds no area, too, and of one colour.
TYPED_TEST(SolvedOnRanks, HasNearLamps)
{
  for (const double spacing : { 1.0, 1e8 })
  {
    SCOPED_TRACE(std::to_string(spacing));
    MediumToCut medium = Everything({ 5, 9, 7 });
    Scene& scene = medium.scene;
    scene.medium.grid.spacing.fill(spacing);
    scene.medium.grid.origin = { -2.0 * spacing, 3.0 * spacing, 0.5 * spacing };
    AddNearLamps(scene);
    for (std::vector<float>* perLength : { &scene.sigma_a, &scene.sigma_s, &scene.emission })
    {
      std::for_each(
        perLength->begin(), perLength->end(), [&](float& value) { value = static_cast<float>(value / spacing); });
    }
    for (Light& lamp : scene.light.lights)
    {
      lamp.power = spacing > 1.0 ? Rgb{ 0.0, 2.0, 0.0 } : lamp.power;
    }
    this->ExpectSerialLight(medium);
  }
}

/// Rays close, or pass through blocks several times; along an axis of one or two voxels a block is its own neighbour,
/// or touches one at both faces.
TYPED_TEST(SolvedOnRanks, WrapsAroundPeriodicAxes)
{
  const std::pair<std::array<int, 3>, std::array<bool, 3>> cases[] = { { { 6, 3, 4 }, { true, false, false } },
    { { 6, 3, 4 }, { false, true, true } }, { { 3, 2, 3 }, { true, true, true } },
    { { 2, 2, 1 }, { true, true, false } }, { { 1, 3, 2 }, { true, false, false } } };
  for (const auto& [size, periodic] : cases)
  {
    SCOPED_TRACE(testing::PrintToString(size) + testing::PrintToString(periodic));
    MediumToCut medium = Everything(size);
    medium.scene.Randomise(30.0, 0.5, 0.8, 11);
    if (size != std::array<int, 3>{ 6, 3, 4 })
    {
      medium.scene.light.lights.clear(); // a beam takes many laps around few voxels
    }
    typename TypeParam::Settings settings = TypeParam::Plain(2);
    settings.periodic = periodic;
    if constexpr (TypeParam::SameSteps)
    {
      settings.directionsPerFace = 4;
    }
    this->ExpectSerialLight(medium, settings, size[2] < 3 ? SingleVoxels(medium.Grid()) : Uneven(medium.Grid()));
  }
}

TYPED_TEST(SolvedOnRanks, HasLampsThatShineAroundPeriodicAxes)
{
  MediumToCut medium = Everything({ 5, 3, 4 });
  medium.scene.Randomise(30.0, 0.5, 0.8, 11);
  medium.scene.light.lights.clear();
  AddNearLamps(medium.scene);
  typename TypeParam::Settings settings = TypeParam::Plain(2);
  settings.periodic = { true, false, true };
  this->ExpectSerialLight(medium, settings);
}

/// By voxel, with its mean direction. So little, too, that it is solved in another unit of power, which ranks without
/// voxels have no light to turn into.
TYPED_TEST(SolvedOnRanks, TakesUncollidedLightThatIsGiven)
{
  for (const bool colour : { false, true })
  {
    MediumToCut medium = Everything({ 7, 5, 6 });
    GiveLight(medium, colour);
    this->ExpectSerialLight(medium);
  }
  MediumToCut faint({ 4, 3, 3 });
  faint.scene.Randomise(2.0, 1.0, 0.5);
  GiveLight(faint, false);
  std::for_each(faint.given.begin(), faint.given.end(), [](float& value) { value *= 1e-25f; });
  faint.scene.light.uncollided.escaped.fill({ 1e-25, 1e-25, 1e-25 });
  this->ExpectSerialLight(faint, TypeParam::Plain(), Slices(faint.Grid(), { 0, 1 }));
}

/// Of swept light, of beams and of lamps, cell by cell.
TYPED_TEST(SolvedOnRanks, IsReflectedByFaces)
{
  MediumToCut medium = Everything({ 6, 8, 5 });
  AddNearLamps(medium.scene);
  for (std::size_t face = 0; face < 6; ++face)
  {
    const double of = 0.15 * static_cast<double>(face);
    medium.scene.light.faceAlbedo[face] = { of, TypeParam::SameSteps ? 0.5 * of : of, of };
  }
  this->ExpectSerialLight(medium, TypeParam::Plain(4));
}

/// Each kind of light alone, and beside each other kind.
TYPED_TEST(SolvedOnRanks, CountsEachLightOnce)
{
  const std::vector<std::function<void(MediumToCut&)>> kinds = {
    [](MediumToCut& medium) { medium.scene.ShineFromEverywhere(0.2); },
    [](MediumToCut& medium) { AddEnvironment(medium.scene, 8, 4, 21); },
    [](MediumToCut& medium) {
      medium.scene.light.faces[1] = { 0.7, 0.7, 0.7 };
      medium.scene.light.faces[4] = { 0.3, 0.3, 0.3 };
    },
    [](MediumToCut& medium) {
      medium.scene.ShineAlong({ 0.3, -0.5, -0.9 });
    },
    [](MediumToCut& medium) { AddNearLamps(medium.scene); },
    [](MediumToCut& medium) { medium.scene.emission = RandomValues(medium.scene.sigma_s.size(), 0.0, 0.2, 3); },
    [](MediumToCut& medium) {
      medium.given = RandomValues(medium.scene.sigma_s.size(), 0.1, 2.0, 7);
      medium.ways = RandomValues(3 * medium.scene.sigma_s.size(), -0.57, 0.57, 8);
      medium.scene.light.uncollided.escaped[3].fill(5.0);
    },
  };
  for (std::size_t first = 0; first < kinds.size(); ++first)
  {
    for (std::size_t second = first; second < kinds.size(); ++second)
    {
      SCOPED_TRACE(std::to_string(first) + " and " + std::to_string(second));
      MediumToCut medium({ 5, 4, 6 });
      medium.scene.Randomise(2.0, 2.0, 0.8, 17);
      kinds[first](medium);
      if (second != first)
      {
        kinds[second](medium);
      }
      this->ExpectSerialLight(medium, TypeParam::Plain(3));
    }
  }
}

TYPED_TEST(SolvedOnRanks, IsDarkWithoutSources)
{
  MediumToCut medium({ 4, 3, 2 });
  medium.scene.Randomise(1.0, 1.0, 0.9);
  const std::vector<float> fluence = this->ExpectSerialLight(medium).fluence;
  EXPECT_EQ(*std::max_element(fluence.begin(), fluence.end()), 0.0f);
}

/// Whatever fails on one rank is one error on each, and no rank waits for another.
TYPED_TEST(SolvedOnRanks, FailsTogether)
{
  this->ExpectErrors(
    "sigma_a", [](int rank, auto& part, auto&, auto&) { part.scene.sigma_a[0] = rank == 1 ? -1.0f : 0.1f; });
  this->ExpectErrors(
    "disagree about settings", [](int rank, auto&, auto& settings, auto&) { settings.tolerance *= 1.0 + rank; });
  this->ExpectErrors("disagree about the components", [](int rank, auto& part, auto&, auto&) {
    part.scene.medium.emission = rank == 2 ? Field() : part.scene.medium.emission;
  });
  this->ExpectErrors(
    "disagree about what shines", [](int rank, auto& part, auto&, auto&) { part.scene.light.faces[3][0] += rank; });
  this->ExpectErrors("disagree about g", [](int rank, auto& part, auto&, auto&) {
    part.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.1 + 0.1 * rank);
  });
  this->ExpectErrors("aborted", [](int rank, auto&, auto&, auto& monitor) {
    monitor = rank == 1 ? Monitor([](double done) { return done < 0.3; }) : Monitor();
  });
}

TYPED_TEST(SolvedOnRanks, FailsTogetherWhereMemoryEnds)
{
  if (!this->GetDevice().SharesHostMemory())
  {
    GTEST_SKIP() << "what does not fit lies in host memory there";
  }
  MediumToCut medium = Everything({ 4, 3, 3 });
  AddNearLamps(medium.scene);
  if (std::is_same_v<TypeParam, OrdinatesSolver>)
  {
    medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6); // else as the maps, but for a check beforehand
  }
  const BlockPartition partition = BlockPartition::Even(medium.Grid(), 2);
  typename TypeParam::Settings settings = TypeParam::Plain(2);
  ExpectToFailTogether(this->GetDevice(), 2, TypeParam::LeastMemory, [&](Device& device, Communicator& communicator) {
    const Domain domain(communicator, partition);
    const MediumToCut part = medium.Part(domain);
    TypeParam::Solve(device, domain, part, settings);
  });
}

class OrdinatesOnRanks : public SolvedOnRanks<OrdinatesSolver>
{
};

/// A slab between faces that reflect light, in more directions than asked for.
TEST_F(OrdinatesOnRanks, HasTheSlabOfASerialSolve)
{
  MediumToCut medium = Everything({ 1, 1, 9 });
  medium.scene.light.faceAlbedo[4] = { 0.3, 0.3, 0.3 };
  OrdinatesSettings settings = OrdinatesSolver::Plain();
  settings.periodic = { true, true, false };
  this->ExpectSerialLight(medium, settings, BlockPartition::Even(medium.Grid(), 3));
}

/// By every pair of directions, on a spiral, and in few orders; one colour alone shines on the last.
TEST_F(OrdinatesOnRanks, HasTheScatteringOfASerialSolve)
{
  MediumToCut medium = Everything({ 6, 7, 5 }), green({ 4, 1, 1 });
  medium.scene.sigma_s = RandomValues(3 * medium.scene.sigma_a.size(), 0.0, 1.0, 9);
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  OrdinatesSettings settings = OrdinatesSolver::Plain(3);
  settings.scattering = OrdinatesScattering::Matrix;
  settings.spiralDirections = 40;
  this->ExpectSerialLight(medium, settings);
  green.scene.Randomise(1.0, 1.0, 0.9);
  green.scene.light.lights = medium.scene.light.lights;
  green.scene.light.lights[0].power = { 0.0, 2.0, 0.0 };
  this->ExpectSerialLight(green, OrdinatesSolver::Plain(), BlockPartition::Even(green.Grid(), 6));
}

TEST_F(OrdinatesOnRanks, AreNotSolvedAsPublished)
{
  this->ExpectErrors("cannot be solved as published", [](int rank, auto&, OrdinatesSettings& settings, auto&) {
    settings.scheme = rank == 1 ? OrdinatesScheme::Published : OrdinatesScheme::Conservative;
  });
}

/// As many directions as a serial solve has on the smallest device, and terms as far as any rank scatters unevenly.
TEST(QualityOfOrdinates, IsThatOfASerialSolveOnAnyNumberOfRanks)
{
  MediumToCut medium = Everything({ 7, 4, 6 });
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  medium.Attach();
  const std::size_t bytes = 6 * 49 * 4 * medium.Grid().VoxelCount(); // of 49 directions a face
  const DeviceMemory large, small = { 2 * bytes + 1, large.one };
  for (const Quality quality : { Quality::Draft, Quality::Default, Quality::Fine })
  {
    const OrdinatesSettings expected = AtQuality(Domain(medium.Grid()), quality, {}, medium.scene.medium, small);
    EXPECT_EQ(expected.directionsPerFace, quality == Quality::Draft ? 9 : quality == Quality::Fine ? 49 : 25);
    ErrorsOnRanks(Slices(medium.Grid(), { 0, 5 }), [&](const Domain& domain) {
      MediumToCut part = medium.Part(domain);
      part.scene.medium.phase = domain.Rank() > 0 ? part.scene.medium.phase : PhaseFunction();
      EXPECT_EQ(
        Words(AtQuality(domain, quality, {}, part.scene.medium, domain.Rank() == 1 ? small : large)), Words(expected));
    });
  }
}

TEST(BalanceOfOrdinates, IsJudgedOnAnyNumberOfRanks)
{
  MediumToCut medium = Everything({ 3, 1, 1 });
  medium.Attach();
  LightField given;
  given.convergence = { ConvergenceRow() };
  given.balance.entered[0] = 4.0;
  given.balance.absorbed[0] = 3.0; // a quarter is lost
  OrdinatesSettings settings;
  for (const int ranks : { 1, 3 })
  {
    const auto errors = ErrorsOnRanks(BlockPartition::Even(medium.Grid(), ranks), [&](const Domain& domain) {
      LightField light = given;
      Judge(settings, domain, medium.scene.medium, light);
    });
    EXPECT_THAT(
      errors, testing::Each(testing::HasSubstr("The light does not balance: 0.25 of the power is lost or made")));
  }
  settings.scheme = OrdinatesScheme::Published; // loses power, as its paper has it
  Judge(settings, Domain(medium.Grid()), medium.scene.medium, given);
}

class LatticeOnRanks : public SolvedOnRanks<LatticeSolver>
{
protected:
  /// Any places and directions, of one colour.
  static std::vector<Photon> AnyPhotons(std::size_t count)
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0.5, 4.5);
    std::vector<Photon> photons(count);
    for (Photon& photon : photons)
    {
      photon.position = { place(random), place(random), place(random) };
      const glm::dvec3 along = glm::normalize(glm::dvec3(place(random), place(random), place(random)) - 2.5);
      photon.direction = { static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z) };
      photon.power = { 0.01f, 0.02f, 0.03f };
    }
    return photons;
  }

  LightField OfPhotons(const BlockPartition& partition, const MediumToCut& medium, const std::vector<Photon>& photons)
  {
    return LightOnRanks(partition, medium, [&](const Domain& domain, MediumToCut& part) {
      const auto from = [&](int rank) {
        return photons.begin() + static_cast<std::ptrdiff_t>(photons.size() * rank / partition.blocks.size());
      };
      return SolveLatticeBoltzmann(this->GetDevice(), domain, part.scene.medium, part.Index(),
        { from(domain.Rank()), from(domain.Rank() + 1) }, part.scene.light, LatticeSolver::Plain());
    });
  }
};

/// Lines of voxels, flat grids, whose cells are long, and six directions.
TEST_F(LatticeOnRanks, SolvesPlanesAndRowsInSixDirections)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 12, 9, 1 }, { 1, 17, 1 }, { 1, 1, 1 }, { 7, 6, 5 } })
  {
    SCOPED_TRACE(testing::PrintToString(size));
    MediumToCut medium = Everything(size);
    LatticeSettings settings = LatticeSolver::Plain();
    settings.directions = size[0] == 7 ? 6 : 18;
    this->ExpectSerialLight(medium, settings);
  }
}

/// Photons on bent paths, a share of them on each rank, beside emission.
TEST_F(LatticeOnRanks, TakesPhotons)
{
  MediumToCut medium = Everything({ 8, 7, 5 });
  medium.scene.light.lights.clear();
  medium.Attach();
  std::vector<Photon> photons = AnyPhotons(300);
  const LightField expected = this->OfPhotons(BlockPartition::Even(medium.Grid(), 1), medium, photons);
  for (const BlockPartition& partition : { Uneven(medium.Grid()), Slices(medium.Grid(), { 0, 1 }) })
  {
    ExpectSameLight(this->OfPhotons(partition, medium, photons), expected, 2e-6);
  }
  photons[1].position = photons[4].position = { -9.0, 0.0, 0.0 };
  photons[1].direction = photons[4].direction = { -1.0f, 0.0f, 0.0f };
  EXPECT_THAT(this->OfPhotons(Uneven(medium.Grid()), medium, photons).doubts,
    testing::Contains(testing::HasSubstr("2 of 300 photons do not meet the medium")));
}

/// Between perfect mirrors the medium absorbs all light in the end; if it absorbs none, that is an error.
TEST_F(LatticeOnRanks, MayBeBetweenPerfectMirrors)
{
  MediumToCut medium = Everything({ 5, 6, 4 });
  medium.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  this->ExpectSerialLight(medium);
  for (const bool around : { false, true })
  {
    this->ExpectErrors("without end", [&](int, MediumToCut& part, LatticeSettings& settings, auto&) {
      settings.periodic.fill(around);
      part.scene.light.faceAlbedo.fill(around ? Rgb{} : Rgb{ 1.0, 1.0, 1.0 });
      std::fill(part.scene.sigma_a.begin(), part.scene.sigma_a.end(), 0.0f);
    });
  }
}

/// Rows of voxels along periodic axes are empty, as clear air above a cloud is, or a hole through it. Of what is first
/// scattered near a thick voxel's face a part begins in such a row, and some rows emit.
TEST_F(LatticeOnRanks, LightsRowsThatAreEmptyAlongPeriodicAxes)
{
  const auto clearAir = [](const std::array<int, 3>& at) { return at[2] >= 5; };
  const auto hole = [](const std::array<int, 3>& at) { return at[0] == 1 && at[1] == 2; };
  const auto diagonal = [](const std::array<int, 3>& at) { return (at[0] + at[2]) % 2 == 0; };
  const std::vector<std::pair<std::array<bool, 3>, std::function<bool(const std::array<int, 3>&)>>> cases = {
    { { true, true, false }, clearAir }, { { false, true, true }, hole }, { { true, false, true }, diagonal }
  };
  for (const auto& [periodic, isEmpty] : cases)
  {
    SCOPED_TRACE(testing::PrintToString(periodic));
    MediumToCut medium = Everything({ 4, 5, 6 });
    Scene& scene = medium.scene;
    scene.Randomise(4.0, 1.0, 0.9, 23);
    AddNearLamps(scene);
    medium.ior.clear();
    for (std::size_t voxel = 0; voxel < scene.sigma_a.size(); ++voxel)
    {
      if (isEmpty(scene.medium.grid.VoxelAt(voxel)))
      {
        scene.sigma_a[voxel] = scene.sigma_s[voxel] = 0.0f;
      }
    }
    LatticeSettings settings = LatticeSolver::Plain();
    settings.periodic = periodic;
    const LightField steady = this->ExpectSerialLight(medium, settings);
    settings.tolerance = 1e-5;
    settings.solvesSteady = false;
    for (const int block : { 0, 3 })
    {
      settings.blockSize = block;
      ExpectSameLight(this->Serial(medium, settings), steady, 3e-4);
    }
  }
}

/// White, up to a hundred mean free paths a voxel: diffusion on the first rank's cells preconditions it.
TEST_F(LatticeOnRanks, NeedsFewIterationsWhateverTheThickness)
{
  for (const double thickest : { 1e-2, 1.0, 1e2 })
  {
    SCOPED_TRACE(std::to_string(thickest));
    MediumToCut medium({ 24, 22, 20 });
    medium.scene.Randomise(thickest, 1.0, 1.0, 5);
    medium.scene.ShineFromEverywhere(0.3);
    medium.scene.ShineAlong({ 0.3, -0.2, -0.9 });
    LatticeSettings settings;
    settings.netFlux = true;
    const LightField expected = this->Serial(medium, settings);
    const LightField light = this->OnRanks(BlockPartition::Even(medium.Grid(), 2), medium, settings);
    EXPECT_LE(light.convergence.size(), expected.convergence.size() + 4);
    ExpectSameLight(light, expected, 5e-4);
  }
}

/// The error names the setting, or what one rank has and another has not.
TEST_F(LatticeOnRanks, SaysWhatItDoesNotTake)
{
  const auto expect = [this](const std::string& words, const std::function<void(LatticeSettings&)>& change) {
    this->ExpectErrors(
      "not solved with " + words, [&](int, auto&, LatticeSettings& settings, auto&) { change(settings); });
  };
  expect("the scheme as published", [](LatticeSettings& settings) { settings.scheme = LatticeScheme::Published; });
  expect("BlockSize", [](LatticeSettings& settings) { settings.blockSize = 4; });
  expect("Interleaved", [](LatticeSettings& settings) { settings.interleaves = true; });
  expect("MaximumOrders", [](LatticeSettings& settings) { settings.maximumSteps = 20; });
  this->ExpectErrors("disagree about whether there is a refractive index",
    [](int rank, MediumToCut& part, auto&, auto&) { part.ior.resize(rank == 1 ? 0 : part.ior.size()); });
  static const std::vector<float> given(6 * 5 * 4, 1.0f);
  this->ExpectErrors("UncollidedLight", [](int rank, MediumToCut& part, auto&, auto&) {
    part.scene.light.uncollided.fluence = { rank == 1 ? given.data() : nullptr, 1 };
  });
}

/// Power that was deposited nowhere is in the balance, whichever rank lost it.
TEST_F(LatticeOnRanks, RefusesLightThatDoesNotBalance)
{
  MediumToCut medium = Everything({ 6, 5, 4 });
  const auto expect = [&](double lost, const std::string& expected) {
    for (const int ranks : { 1, 3 })
    {
      const auto errors = ErrorsOnRanks(BlockPartition::Even(medium.Grid(), ranks), [&](const Domain& domain) {
        MediumToCut part = medium.Part(domain);
        const LatticeSettings settings = LatticeSolver::Plain();
        const LatticeProblem problem(domain, part.scene.medium, part.Index(), part.scene.light, settings);
        LightField light = BeginLight(problem, settings);
        light.balance.entered[0] = light.balance.escaped[0] = 2.0;
        const Rgb lostHere = { domain.Rank() == ranks - 1 ? lost * ranks : 0.0, 0.0, 0.0 };
        FinishLight(light, this->GetDevice(), problem, part.scene.light, settings, 1.0, lostHere);
        throw InvalidInput(light.doubts.at(0));
      });
      EXPECT_THAT(errors, testing::Each(testing::HasSubstr(expected)));
    }
  };
  expect(0.5, "The light does not balance: 0.2 of the power is lost or made");
  expect(0.002, "The energy balance is off: 0.001 of the power is lost or made");
}
