// Media that scatter forwards and backwards, solved in angular moments.

#include "DeviceTest.h"
#include "MediumScene.h"

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Scattering/BeamScattering.h"
#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"

#include <cmath>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
enum class Lit
{
  Evenly,   ///< isotropic light on one face
  Straight, ///< a beam across the slab
  Aslant    ///< one at cosine 0.5 to its normal
};

struct Slab
{
  double tau, albedo, g;
  Lit light;
};

/// Reflectance and transmittance.
struct Powers
{
  double r, t;
};

Powers SolvedSlab(Device& device, const Slab& slab, int axis, int voxels, int degree)
{
  std::array<int, 3> size = { 1, 1, 1 };
  size[axis] = voxels;
  const double sigma_t = slab.tau / voxels;
  Scene scene(size, static_cast<float>(sigma_t * (1.0 - slab.albedo)), static_cast<float>(sigma_t * slab.albedo));
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(slab.g);
  scene.settings.periodic = { axis != 0, axis != 1, axis != 2 };
  scene.settings.angularDegree = degree;
  double enters = Pi;
  if (slab.light == Lit::Evenly)
  {
    scene.light.faces[2 * axis] = { 1.0, 1.0, 1.0 };
  }
  else
  {
    enters = slab.light == Lit::Straight ? 1.0 : 0.5;
    std::array<double, 3> direction = {};
    direction[axis] = enters;
    direction[(axis + 1) % 3] = std::sqrt(1.0 - enters * enters);
    scene.ShineAlong(direction);
  }
  const LightField light = scene.Solve(device);
  EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
  return { light.facePowerOut[2 * axis][0] / enters, light.facePowerOut[2 * axis + 1][0] / enters };
}

Powers ReferenceOf(const Slab& slab)
{
  const ReferenceRow row =
    ReferenceRowWhere("slab_forward", { { "tau", slab.tau }, { "omega", slab.albedo }, { "g", slab.g } });
  const std::string light = slab.light == Lit::Evenly ? "diffuse" : slab.light == Lit::Straight ? "mu1" : "mu05";
  return { row["R_" + light], row["T_" + light] };
}
}

TEST(AngularBasis, IsOrthonormalOnEverySet)
{
  for (const int perFace : { 4, 9, 25, 144 })
  {
    const DirectionSet set = FittedDirections(perFace);
    const AngularBasis basis(set, MostDegree(set, 7));
    std::vector<double> sums(basis.Count() * basis.Count(), 0.0);
    for (const Direction& direction : set.directions)
    {
      const std::vector<double> values = basis.At(direction.omega);
      for (int i = 0; i < basis.Count(); ++i)
      {
        for (int j = 0; j < basis.Count(); ++j)
        {
          sums[i * basis.Count() + j] += direction.weight * values[i] * values[j] / (4.0 * Pi);
        }
      }
    }
    for (int i = 0; i < basis.Count(); ++i)
    {
      for (int j = 0; j < basis.Count(); ++j)
      {
        EXPECT_NEAR(sums[i * basis.Count() + j], i == j ? 1.0 : 0.0, 1e-12) << perFace << " " << i << " " << j;
      }
    }
  }
}

TEST(AngularBasis, IsToldApartByFittedDirectionsAsByThoseOfEqualAngles)
{
  for (const int perFace : { 9, 16, 25, 36, 49, 64 })
  {
    const int degree = 2 * static_cast<int>(std::lround(std::sqrt(perFace))) - 1;
    EXPECT_EQ(MostDegree(FittedDirections(perFace), degree), perFace == 16 ? degree - 1 : degree) << perFace;
    EXPECT_EQ(MostDegree(EquiangularDirections(perFace), degree), degree) << perFace;
  }
}

TEST(AngularBasis, KnowsWhichFunctionsAreOdd)
{
  const AngularBasis basis(FittedDirections(25), 7);
  const std::array<double, 3> omega = { 0.36, 0.48, 0.8 };
  const std::vector<double> values = basis.At(omega);
  for (int axis = 0; axis < 3; ++axis)
  {
    std::array<double, 3> mirrored = omega;
    mirrored[axis] = -mirrored[axis];
    const std::vector<double> there = basis.At(mirrored);
    for (int i = 0; i < basis.Count(); ++i)
    {
      EXPECT_NEAR(there[i], AngularBasis::IsOdd(i)[axis] ? -values[i] : values[i], 1e-12) << i;
    }
  }
}

TEST(AngularBasis, MakesPhaseFunctionsWhoseRowsAndMeanCosineAreRight)
{
  const double g = 0.85;
  for (const int perFace : { 9, 25, 36 })
  {
    const DirectionSet set = FittedDirections(perFace);
    const AngularBasis basis(set, 5);
    const DeltaM truncated = Truncations(PhaseFunction::HenyeyGreenstein(g), 5).back();
    for (const Direction& from : { set.directions[0], set.directions[7], set.directions.back() })
    {
      const std::vector<double> there = basis.At(from.omega);
      double sum = 0.0, cosine = 0.0;
      for (const Direction& to : set.directions)
      {
        const std::vector<double> here = basis.At(to.omega);
        double p = 0.0;
        for (int i = 0; i < basis.Count(); ++i)
        {
          p += truncated.moments[AngularBasis::DegreeOf(i)] * here[i] * there[i] / (4.0 * Pi);
        }
        const double dot = from.omega[0] * to.omega[0] + from.omega[1] * to.omega[1] + from.omega[2] * to.omega[2];
        sum += to.weight * p;
        cosine += to.weight * p * dot;
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(truncated.forward + (1.0 - truncated.forward) * cosine, g, 1e-12);
    }
  }
}

TEST(TruncatedScattering, OfDegreeZeroIsTheSimilarityRelation)
{
  const DeltaM truncated = Truncations(PhaseFunction::HenyeyGreenstein(-0.6), 0).front();
  EXPECT_NEAR(truncated.forward, -0.6, 1e-15);
}

TEST(TruncatedScattering, TakesThickVoxelsAsIsotropic)
{
  Scene scene({ 3, 1, 1 });
  scene.sigma_s = { 0.5f, 3.0f, 500.0f };
  scene.Attach();
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  const TruncatedScattering scattering(scene.medium, 5, 1);
  EXPECT_EQ(scattering.DegreeOf(0, 0), 5);
  EXPECT_LT(scattering.DegreeOf(1, 0), 5);
  EXPECT_GT(scattering.DegreeOf(1, 0), 0);
  EXPECT_EQ(scattering.DegreeOf(2, 0), 0);
  EXPECT_EQ(scattering.SigmaS(2, 0), scene.medium.TransportSigmaS(2, 0));
  EXPECT_EQ(scattering.SigmaS(2, 0, 1), 0.0f);
  EXPECT_NEAR(scattering.SigmaS(0, 0), 0.5 * (1.0 - std::pow(0.85, 6)), 1e-6);
}

TEST(TruncatedScattering, OfGThatVariesIsThatOfEachVoxel)
{
  Scene scene({ 2, 1, 1 }, 0.0f, 0.5f);
  scene.Attach();
  const std::vector<float> g = { 0.3f, 0.8f };
  scene.medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0), Field{ g.data(), 1 });
  const TruncatedScattering scattering(scene.medium, 3, 1);
  for (std::size_t i = 0; i < 2; ++i)
  {
    const double f = std::pow(g[i], 4);
    EXPECT_NEAR(scattering.SigmaS(i, 0), 0.5 * (1.0 - f), 2e-6);
    EXPECT_NEAR(scattering.SigmaS(i, 0, 2), 0.5 * (g[i] * g[i] - f), 2e-6);
  }
}

namespace
{
std::vector<PhaseFunction> AllKinds()
{
  std::vector<PhaseFunction> all = { PhaseFunction(), PhaseFunction::Rayleigh(),
    PhaseFunction::DoubleHenyeyGreenstein(0.9, -0.4, 0.7),
    PhaseFunction::Tabulated({ -1.0, 0.0, 0.8, 1.0 }, { 0.2, 0.1, 1.0, 9.0 }) };
  for (const double g : { -0.99, -0.5, 0.5, 0.85, 0.99 })
  {
    all.push_back(PhaseFunction::HenyeyGreenstein(g));
    all.push_back(PhaseFunction::Schlick(g));
  }
  return all;
}

/// What a truncation scatters from one direction into another, the mean over all being 1.
double Scattered(const DeltaM& truncated, const std::vector<double>& from, const std::vector<double>& to)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    sum += truncated.moments[AngularBasis::DegreeOf(static_cast<int>(i))] * from[i] * to[i];
  }
  return sum;
}

/// Power, mean cosine and reciprocity of a truncation between directions of a set.
void ExpectConserves(const DeltaM& truncated, const DirectionSet& set, const AngularBasis& basis, double g)
{
  for (std::size_t from = 0; from < set.directions.size(); from += 1 + set.directions.size() / 12)
  {
    const std::vector<double> there = basis.At(set.directions[from].omega);
    double sum = 0.0;
    std::array<double, 3> flux = {};
    for (const Direction& to : set.directions)
    {
      const std::vector<double> here = basis.At(to.omega);
      const double p = Scattered(truncated, there, here);
      ASSERT_NEAR(p, Scattered(truncated, here, there), 1e-6);
      sum += to.weight * p / (4.0 * Pi);
      for (int axis = 0; axis < 3; ++axis)
      {
        flux[axis] += to.weight * p * to.omega[axis] / (4.0 * Pi);
      }
    }
    ASSERT_NEAR(sum, 1.0, 1e-6);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double on = set.directions[from].omega[axis];
      ASSERT_NEAR(truncated.forward * on + (1.0 - truncated.forward) * flux[axis], g * on, 1e-6);
    }
  }
}
}

TEST(TruncatedScattering, ConservesPowerAndMeanCosineOnEverySetAndIsReciprocal)
{
  for (const int perFace : { 25, 36, 64, 100 })
  {
    const DirectionSet set = FittedDirections(perFace);
    for (const int degree : { 1, 3, 5, 7, 9 })
    {
      if (MostDegree(set, degree) < degree)
      {
        continue;
      }
      const AngularBasis basis(set, degree);
      for (const PhaseFunction& function : AllKinds())
      {
        SCOPED_TRACE(std::to_string(perFace) + " directions, degree " + std::to_string(degree) + ", g " +
          std::to_string(function.MeanCosine()));
        ExpectConserves(Truncations(function, degree).back(), set, basis, function.MeanCosine());
      }
    }
  }
}

TEST(WithoutNegatives, IsNowhereNegativeAndKeepsPowerAndMeanCosine)
{
  for (const int perFace : { 25, 36 })
  {
    const DirectionSet set = FittedDirections(perFace);
    for (const int degree : { 1, 3, 5 })
    {
      const AngularBasis basis(set, degree);
      const DirectionKernel kernel(set, degree);
      for (const PhaseFunction& function : AllKinds())
      {
        SCOPED_TRACE(std::to_string(perFace) + " directions, degree " + std::to_string(degree) + ", g " +
          std::to_string(function.MeanCosine()));
        const DeltaM positive = WithoutNegatives(Truncations(function, degree).back(), kernel);
        EXPECT_GE(kernel.Least(positive.moments), 0.0);
        ExpectConserves(positive, set, basis, function.MeanCosine());
      }
    }
  }
}

TEST(WithoutNegatives, LeavesWhatIsNowhereNegativeAsItIs)
{
  const DeltaM rayleigh = Truncations(PhaseFunction::Rayleigh(), 3).back();
  const DirectionKernel kernel(FittedDirections(25), 3);
  EXPECT_EQ(WithoutNegatives(rayleigh, kernel).moments, rayleigh.moments);
  EXPECT_LT(kernel.Least(Truncations(PhaseFunction::HenyeyGreenstein(-0.9), 3).back().moments), -0.1);
}

TEST(BeyondSmoothMoments, MakeTheSourceOfABeamPositiveAndKeepItsPowerAndMeanCosine)
{
  const DirectionSet set = FittedDirections(25);
  const AngularBasis basis(set, 5);
  const DirectionKernel kernel(set, 5);
  for (const double g : { -0.5, 0.5, 0.85, 0.99 })
  {
    for (const std::array<double, 3>& beam : { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { 0.48, 0.6, 0.64 } })
    {
      const PhaseFunction function = PhaseFunction::HenyeyGreenstein(g);
      const DeltaM truncated = WithoutNegatives(Truncations(function, 5).back(), kernel);
      const std::vector<double> beyond = BeyondSmoothMoments(function, truncated, set, basis, beam);
      double sum = 0.0, cosine = 0.0;
      for (std::size_t d = 0; d < beyond.size(); ++d)
      {
        const std::array<double, 3>& omega = set.directions[d].omega;
        const double source = beyond[d] + Scattered(truncated, basis.At(beam), basis.At(omega));
        EXPECT_GE(source, -1e-12) << g;
        sum += set.directions[d].weight * source / (4.0 * Pi);
        cosine += set.directions[d].weight * source / (4.0 * Pi) *
          (omega[0] * beam[0] + omega[1] * beam[1] + omega[2] * beam[2]);
      }
      EXPECT_NEAR(sum, 1.0, 1e-9) << g;
      EXPECT_NEAR(cosine, truncated.moments[1], 1e-6) << g;
    }
  }
}

class AngularScattering : public DeviceTest
{
protected:
  void ExpectSlab(const Slab& slab, int voxels, int degree, double tolerance)
  {
    const Powers expected = ReferenceOf(slab);
    const Powers found = SolvedSlab(this->GetDevice(), slab, 2, voxels, degree);
    EXPECT_NEAR(found.r, expected.r, tolerance) << "tau " << slab.tau << " g " << slab.g;
    EXPECT_NEAR(found.t, expected.t, tolerance) << "tau " << slab.tau << " g " << slab.g;
  }
};

TEST_F(AngularScattering, LeavesLightThatIsTheSameEverywhereAsItIs)
{
  for (const double g : { -0.5, 0.5, 0.9 })
  {
    for (const float scattering : { 0.05f, 3.0f }) // order by order, and accelerated
    {
      Scene scene({ 9, 8, 7 }, 0.0f, scattering);
      scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
      scene.settings.angularDegree = 3;
      scene.settings.tolerance = 1e-6;
      scene.ShineFromEverywhere(1.0);
      const LightField light = scene.Solve(this->GetDevice());
      for (const float fluence : light.fluence)
      {
        ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5) << "g " << g << " sigma_s " << scattering;
      }
    }
  }
}

TEST_F(AngularScattering, ReflectsAndTransmitsASkyAsASlabDoes)
{
  this->ExpectSlab({ 1.0, 1.0, 0.5, Lit::Evenly }, 32, 3, 3e-3);
  this->ExpectSlab({ 1.0, 0.9, 0.85, Lit::Evenly }, 32, 5, 3e-3);
  this->ExpectSlab({ 10.0, 1.0, 0.9, Lit::Evenly }, 128, 5, 2e-3);
  this->ExpectSlab({ 10.0, 0.9, 0.85, Lit::Evenly }, 128, 5, 3e-3);
}

TEST_F(AngularScattering, ReflectsAndTransmitsBeamsAsASlabDoes)
{
  this->ExpectSlab({ 1.0, 1.0, 0.85, Lit::Straight }, 32, 5, 3e-3);
  this->ExpectSlab({ 1.0, 0.9, 0.85, Lit::Aslant }, 32, 5, 3e-3);
  this->ExpectSlab({ 10.0, 1.0, 0.9, Lit::Straight }, 128, 5, 3e-3);
  this->ExpectSlab({ 10.0, 0.99, 0.85, Lit::Aslant }, 128, 5, 3e-3);
  this->ExpectSlab({ 1.0, 0.9, -0.5, Lit::Straight }, 32, 5, 3e-3);
}

TEST_F(AngularScattering, IsTheSameAlongEveryAxis)
{
  const Slab slab = { 5.0, 0.99, 0.85, Lit::Aslant };
  const Powers z = SolvedSlab(this->GetDevice(), slab, 2, 24, 3);
  for (const int axis : { 0, 1 })
  {
    const Powers found = SolvedSlab(this->GetDevice(), slab, axis, 24, 3);
    EXPECT_NEAR(found.r, z.r, 2e-5);
    EXPECT_NEAR(found.t, z.t, 2e-5);
  }
}

TEST_F(AngularScattering, HasNoNegativeLightInFlatVoxels)
{
  for (const double g : { -0.9, 0.99 })
  {
    for (const int axis : { 0, 2 })
    {
      Scene scene({ 9, 9, 9 }, 0.0f, 1.0f);
      scene.medium.grid.spacing[axis] = 1e-3;
      scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
      scene.settings.angularDegree = -1;
      std::array<double, 3> down = {};
      down[axis] = -1.0;
      scene.ShineAlong(down);
      const LightField light = scene.Solve(this->GetDevice());
      for (int face = 0; face < 6; ++face)
      {
        EXPECT_GT(light.facePowerOut[face][0], 0.0) << "g " << g << " face " << face;
      }
      for (std::size_t i = 0; i < light.fluence.size(); ++i)
      {
        ASSERT_GE(light.fluence[i], light.fluenceDirect[i] * (1.0f - 1e-5f)) << "g " << g << " voxel " << i;
      }
    }
  }
}

TEST_F(AngularScattering, HasNoNegativeLightInThinRods)
{
  Scene scene({ 1, 1, 1000 }, 0.0f, 0.1f);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(-0.9);
  scene.settings.angularDegree = -1;
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  const LightField light = scene.Solve(this->GetDevice());
  for (const float fluence : light.fluence)
  {
    ASSERT_GE(fluence, 0.0f);
  }
  for (int face = 0; face < 6; ++face)
  {
    EXPECT_GE(light.facePowerOut[face][0], 0.0) << face;
  }
}

TEST_F(AngularScattering, StoresFiniteMomentsOfAMediumThatHardlyScatters)
{
  Scene scene({ 5, 4, 3 }, 1e-40f, 1e-40f);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.5);
  scene.settings.angularDegree = 3;
  scene.settings.storeMoments = true;
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  ASSERT_FALSE(light.scatteredMoments.empty());
  for (const float moment : light.scatteredMoments)
  {
    ASSERT_TRUE(std::isfinite(moment));
  }
}

TEST_F(AngularScattering, FurnaceIsOneWithEveryPhaseFunctionAndBalances)
{
  for (const PhaseFunction& function : AllKinds())
  {
    for (const float absorption : { 0.0f, 0.1f })
    {
      Scene scene({ 5, 6, 7 }, absorption, 0.4f);
      scene.emission.assign(scene.sigma_a.begin(), scene.sigma_a.end());
      scene.medium.phase = function;
      scene.settings.angularDegree = 3;
      scene.settings.tolerance = 1e-6;
      scene.ShineFromEverywhere(1.0);
      const LightField light = scene.Solve(this->GetDevice());
      EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
      for (const float fluence : light.fluence)
      {
        ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5) << "g " << function.MeanCosine() << " sigma_a " << absorption;
      }
    }
  }
}

TEST_F(AngularScattering, FurnaceOfThreeMeanCosinesInThreeChannelsIsOne)
{
  Scene scene({ 5, 6, 7 }, 0.0f, 0.4f);
  scene.medium.phase = PhaseOfMedium(std::array<PhaseFunction, 3>{ PhaseFunction::HenyeyGreenstein(-0.5),
    PhaseFunction::HenyeyGreenstein(0.5), PhaseFunction::HenyeyGreenstein(0.9) });
  scene.settings.angularDegree = 3;
  scene.settings.tolerance = 1e-6;
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_EQ(light.channels, 3);
  EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
  for (const float fluence : light.fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5);
  }
}

TEST_F(AngularScattering, TakesFewSweepsInVeryThickWhiteMedia)
{
  Scene cube({ 32, 32, 32 }, 0.0f, static_cast<float>(1e4 / 32));
  Scene slab({ 1, 1, 64 }, 0.0f, static_cast<float>(1e4 / 64));
  slab.settings.periodic = { true, true, false };
  for (Scene* scene : { &cube, &slab })
  {
    scene->medium.phase = PhaseFunction::HenyeyGreenstein(0.99);
    scene->settings.angularDegree = -1;
    scene->ShineAlong({ 0.0, 0.0, -1.0 });
    const LightField light = scene->Solve(this->GetDevice());
    EXPECT_LE(light.convergence.size(), 20u);
    EXPECT_LT(light.convergence.back().residual, scene->settings.tolerance);
  }
}

TEST_F(AngularScattering, LeavesAFurnaceOfLongVoxelsAsItIs)
{
  Scene scene({ 9, 9, 9 }, 0.0f, 1.0f);
  scene.medium.grid.spacing = { 1000.0, 1.0, 1.0 };
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.9);
  scene.ShineFromEverywhere(1.0);
  scene.settings.angularDegree = -1;
  const LightField light = scene.Solve(this->GetDevice());
  for (const float fluence : light.fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 5e-4);
  }
}
