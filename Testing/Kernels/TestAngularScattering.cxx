// Media that scatter forwards and backwards, solved in angular moments.

#include "DeviceTest.h"
#include "MediumScene.h"

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
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
    const DirectionSet set = EquiangularDirections(perFace);
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

TEST(AngularBasis, KnowsWhichFunctionsAreOdd)
{
  const AngularBasis basis(EquiangularDirections(25), 7);
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
    const DirectionSet set = EquiangularDirections(perFace);
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
