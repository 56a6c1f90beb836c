#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "RandomMedium.h"

#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Numerics/Constants.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace tyndall;

namespace
{
class ParallelPropagationTest : public DeviceTest
{
protected:
  LightField Solve(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
    std::size_t temporaryBytes = 0)
  {
    return SolveParallel(this->GetDevice(), medium, illumination, settings, {}, temporaryBytes);
  }

  void ExpectAgreement(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
  {
    const LightField parallel = this->Solve(medium, illumination, settings);
    const LightField sequential = SolveSequential(medium, illumination, settings);
    ASSERT_EQ(parallel.channels, sequential.channels);
    EXPECT_EQ(parallel.convergence.size(), sequential.convergence.size());
    EXPECT_LT(RelativeRmse(parallel.fluence, sequential.fluence), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.fluenceDirect, sequential.fluenceDirect), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.scatteredRadiance, sequential.scatteredRadiance), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.netFlux, sequential.netFlux), 1e-5);
    for (int c = 0; c < parallel.channels; ++c)
    {
      const double all = sequential.balance.entered[c] + sequential.balance.emitted[c];
      EXPECT_NEAR(parallel.balance.entered[c], sequential.balance.entered[c], 1e-6 * all);
      EXPECT_NEAR(parallel.balance.absorbed[c], sequential.balance.absorbed[c], 1e-5 * all);
      EXPECT_NEAR(parallel.balance.leftOver[c], sequential.balance.leftOver[c], 1e-5 * all);
      for (int face = 0; face < 6; ++face)
      {
        EXPECT_NEAR(parallel.facePowerOut[face][c], sequential.facePowerOut[face][c], 1e-5 * all) << face;
      }
    }
  }
};

/// A different light from everywhere.
Illumination Sunset()
{
  Illumination illumination;
  illumination.sky = { 0.1, 0.2, 0.4 };
  illumination.lights.push_back({});
  illumination.lights[0].direction = { 1.0, 0.4, -0.2 };
  illumination.lights[0].power = { 3.0, 2.0, 1.0 };
  for (int face = 0; face < 6; ++face)
  {
    illumination.faces[face] = { 0.1 * face, 0.3, 0.5 - 0.1 * face };
  }
  illumination.environment.width = 8;
  illumination.environment.height = 4;
  for (int i = 0; i < 8 * 4 * 3; ++i)
  {
    illumination.environment.radiance.push_back(static_cast<float>(i * 37 % 11) / 11.0f);
  }
  return illumination;
}

Illumination GreyFaces()
{
  Illumination illumination;
  for (int face = 0; face < 6; ++face)
  {
    illumination.faces[face] = { 1.0 + face, 1.0 + face, 1.0 + face };
  }
  return illumination;
}

PropagationSettings Orders(int orders)
{
  PropagationSettings settings;
  settings.maximumOrders = orders;
  return settings;
}
}

TEST_F(ParallelPropagationTest, AgreesWithTheSequentialAlgorithm)
{
  this->ExpectAgreement(RandomMedium({ 16, 16, 16 }).medium, GreyFaces(), Orders(3));
}

TEST_F(ParallelPropagationTest, AgreesOnAnyGrid)
{
  for (const std::array<int, 3>& size :
    { std::array{ 1, 1, 1 }, { 1, 7, 3 }, { 5, 1, 1 }, { 3, 20, 1 }, { 17, 9, 33 } })
  {
    SCOPED_TRACE(testing::Message() << size[0] << " x " << size[1] << " x " << size[2]);
    this->ExpectAgreement(RandomMedium(size).medium, GreyFaces(), Orders(3));
  }
}

TEST_F(ParallelPropagationTest, AgreesWhereRaysCrossManyVoxelsOfAPlane)
{
  const Grid grid{ { 9, 6, 4 }, { 0.1, 0.37, 1.0 }, { -1e6, 3.0, 1e3 } };
  this->ExpectAgreement(RandomMedium(grid, 1, 2.0f).medium, GreyFaces(), Orders(3));
}

TEST_F(ParallelPropagationTest, AgreesInColourAndWithGreyMediaInColouredLight)
{
  this->ExpectAgreement(RandomMedium({ 9, 8, 7 }, 3).medium, Sunset(), Orders(3));
  this->ExpectAgreement(RandomMedium({ 9, 8, 7 }, 1).medium, Sunset(), Orders(3));
}

TEST_F(ParallelPropagationTest, AgreesOnFinerMaps)
{
  PropagationSettings settings = Orders(2);
  settings.mapResolution = 2;
  this->ExpectAgreement(RandomMedium({ 6, 5, 9 }).medium, GreyFaces(), settings);
  settings.mapResolution = 3;
  this->ExpectAgreement(RandomMedium({ 4, 5, 3 }).medium, GreyFaces(), settings);
}

TEST_F(ParallelPropagationTest, AgreesOnPeriodicAxes)
{
  PropagationSettings settings = Orders(4);
  for (const std::array<bool, 3>& periodic :
    { std::array{ true, false, false }, { false, true, true }, { true, true, false }, { true, true, true } })
  {
    SCOPED_TRACE(testing::Message() << periodic[0] << periodic[1] << periodic[2]);
    settings.periodic = periodic;
    settings.mapResolution = periodic[0] ? 2 : 1;
    RandomMedium random({ 5, 6, 4 });
    random.Emit(1.0f);
    this->ExpectAgreement(random.medium, GreyFaces(), settings);
  }
}

/// Which no voxel takes.
TEST_F(ParallelPropagationTest, EndsWhereLightAlongAPeriodicAxisDoesNot)
{
  RandomMedium glow(std::array{ 5, 6, 4 }, 1, 0.0f);
  glow.Emit(1.0f);
  glow.scattering[7] = 0.5f;
  PropagationSettings settings;
  settings.periodic = { false, false, true };
  const LightField light = this->Solve(glow.medium, {}, settings);
  EXPECT_LT(light.convergence.size(), 200u);
  EXPECT_GT(light.balance.leftOver[0], 0.01 * light.balance.emitted[0]);
  EXPECT_FALSE(light.doubts.empty());
}

TEST_F(ParallelPropagationTest, AgreesOnStoredDirectionsEmissionAndNetFlux)
{
  RandomMedium random({ 7, 6, 5 }, 3);
  random.Emit(0.5f);
  random.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  PropagationSettings settings = Orders(3);
  settings.netFlux = true;
  settings.directionsPerFace = 9;
  for (const int stored : { 1, 6, 10, 24 })
  {
    SCOPED_TRACE(stored);
    settings.storedDirections = stored;
    this->ExpectAgreement(random.medium, Sunset(), settings);
  }
}

TEST_F(ParallelPropagationTest, AgreesFromVacuumToOpaque)
{
  for (const float densest : { 0.0f, 1e-30f, 1e-6f, 10.0f, 1e6f, 1e30f })
  {
    SCOPED_TRACE(densest);
    this->ExpectAgreement(RandomMedium(std::array{ 6, 6, 6 }, 1, densest).medium, GreyFaces(), Orders(3));
  }
}

TEST_F(ParallelPropagationTest, VacuumLeavesRadianceUnchanged)
{
  EvenMedium vacuum({ { 5, 4, 17 }, { 1.0, 0.3, 2.0 } }, 0.0f, 0.0f);
  Illumination sky;
  sky.sky = { 1.0, 1.0, 1.0 };
  const LightField light = this->Solve(vacuum.medium, sky, {});
  for (const float fluence : light.fluence)
  {
    EXPECT_NEAR(fluence, 4.0 * Pi, 1e-4);
  }
  EXPECT_LT(light.balance.RelativeError(1), 1e-6);
}

TEST_F(ParallelPropagationTest, AbsorberFollowsTheExponentialAlongEachAxis)
{
  EvenMedium absorber({ { 6, 6, 6 } }, 0.4f, 0.0f);
  const double weight = 4.0 * Pi / 6.0;
  for (int face = 0; face < 6; ++face)
  {
    Illumination one;
    one.faces[face] = { 2.0, 2.0, 2.0 };
    PropagationSettings settings;
    settings.directionsPerFace = 1; // along the axes alone
    const LightField light = this->Solve(absorber.medium, one, settings);
    EXPECT_NEAR(light.facePowerOut[face ^ 1][0], weight * 2.0 * 36.0 * std::exp(-0.4 * 6), 1e-4);
    EXPECT_NEAR(light.facePowerOut[face][0], 0.0, 1e-12);
    const int stride = face / 2 == 0 ? 1 : face / 2 == 1 ? 6 : 36;
    for (int k = 0; k < 6; ++k)
    {
      const int depth = face % 2 == 0 ? k : 5 - k;
      EXPECT_NEAR(light.fluence[k * stride], weight * 2.0 * std::exp(-0.4 * (depth + 1)), 1e-6);
    }
  }
}

TEST_F(ParallelPropagationTest, GivesTheSameBitsInBatchesAndAgain)
{
  RandomMedium random({ 9, 12, 10 }, 3);
  PropagationSettings settings = Orders(3);
  settings.storedDirections = 24;
  random.medium.phase = PhaseFunction::HenyeyGreenstein(0.5);
  const LightField atOnce = this->Solve(random.medium, Sunset(), settings);
  const LightField again = this->Solve(random.medium, Sunset(), settings);
  const LightField streamed = this->Solve(random.medium, Sunset(), settings, 200000);
  const LightField single = this->Solve(random.medium, Sunset(), settings, 1);
  for (const LightField* other : { &again, &streamed, &single })
  {
    EXPECT_EQ(other->fluence, atOnce.fluence);
    EXPECT_EQ(other->scatteredRadiance, atOnce.scatteredRadiance);
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(other->facePowerOut[face][0], atOnce.facePowerOut[face][0], 1e-12 * atOnce.balance.entered[0]);
    }
  }
  ParallelPropagation few(this->GetDevice(), random.medium, Sunset(), settings, 1);
  EXPECT_EQ(few.BatchCount(), 150);
}

/// As the filters LPMPropagate and LPMCollect do it: nothing but U and T goes from one step to the next.
TEST_F(ParallelPropagationTest, OrdersChainedByHandEqualTheSolver)
{
  RandomMedium random({ 8, 5, 11 }, 3);
  random.Emit(0.2f);
  const LightField whole = this->Solve(random.medium, Sunset(), Orders(3));
  std::vector<float> unscattered;
  std::vector<float> fluence(whole.fluence.size(), 0.0f);
  for (int order = 0; order < 3; ++order)
  {
    ParallelPropagation propagate(this->GetDevice(), random.medium, Sunset(), Orders(1));
    if (order > 0)
    {
      propagate.SetSource(unscattered);
    }
    ParallelPropagation collect(this->GetDevice(), random.medium, {}, Orders(1));
    ASSERT_EQ(propagate.BatchCount(), 6);
    for (int batch = 0; batch < 6; ++batch)
    {
      propagate.Propagate(batch);
      collect.SetContributions(batch, propagate.Contributions(batch));
      collect.Collect(batch);
    }
    collect.FinishOrder();
    unscattered = collect.Source();
    const LightField light = collect.Result();
    for (std::size_t i = 0; i < fluence.size(); ++i)
    {
      fluence[i] += light.fluence[i];
    }
  }
  EXPECT_LT(RelativeRmse(fluence, whole.fluence), 1e-7);
}

TEST_F(ParallelPropagationTest, SaysHowMuchMemoryIsMissing)
{
  RandomMedium random({ 64, 64, 64 });
  const std::vector<Buffer<char>> hoard = AllMemoryBut(this->GetDevice(), 1000000);
  const std::string words =
    ErrorWords<DeviceError>([&] { ParallelPropagation(this->GetDevice(), random.medium, GreyFaces(), {}); });
  EXPECT_THAT(words, testing::HasSubstr("bytes"));
}

TEST_F(ParallelPropagationTest, StopsWhenToldTo)
{
  RandomMedium random({ 16, 16, 16 });
  int calls = 0;
  EXPECT_THROW(SolveParallel(this->GetDevice(), random.medium, GreyFaces(), {},
                 [&](double done) {
                   EXPECT_GE(done, 0.0);
                   EXPECT_LE(done, 1.0);
                   return ++calls < 3;
                 }),
    Aborted);
  EXPECT_EQ(calls, 3);
}
