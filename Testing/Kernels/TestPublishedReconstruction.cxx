#include "DeviceTest.h"
#include "Medium/Grid.h"
#include "ReconstructionScene.h"

using namespace tyndall;
using Estimator = ReconstructionSettings::Estimator;

namespace
{
/// A pyramid in doubles, cell by cell.
struct Volume
{
  std::array<int, 3> size;
  std::vector<double> values;

  double At(int x, int y, int z) const
  {
    const auto in = [&](int i, int axis) { return std::min(std::max(i, 0), this->size[axis] - 1); };
    return this->values[(static_cast<std::size_t>(in(z, 2)) * this->size[1] + in(y, 1)) * this->size[0] + in(x, 0)];
  }
  bool Has(int x, int y, int z) const { return x < this->size[0] && y < this->size[1] && z < this->size[2]; }
};

using Rule = double (*)(const Volume& fine, int x, int y, int z);

double Gauss(const Volume& fine, int x, int y, int z)
{
  double sum = 0.0, weights = 0.0;
  for (int k = -1; k <= 2; ++k)
  {
    for (int j = -1; j <= 2; ++j)
    {
      for (int i = -1; i <= 2; ++i)
      {
        const double square = (i - 0.5) * (i - 0.5) + (j - 0.5) * (j - 0.5) + (k - 0.5) * (k - 0.5);
        const double weight = std::exp(-square / 8.0);
        sum += weight * fine.At(2 * x + i, 2 * y + j, 2 * z + k);
        weights += weight;
      }
    }
  }
  return sum / weights;
}

double SumOrMean(const Volume& fine, int x, int y, int z, bool mean)
{
  double sum = 0.0, lit = 0.0;
  for (int i = 0; i < 8; ++i)
  {
    const int fx = 2 * x + i % 2, fy = 2 * y + i / 2 % 2, fz = 2 * z + i / 4;
    if (fine.Has(fx, fy, fz))
    {
      sum += fine.At(fx, fy, fz);
      lit += fine.At(fx, fy, fz) > 0.0;
    }
  }
  return !mean ? sum : lit > 0.0 ? sum / lit : 0.0;
}
double Sum(const Volume& fine, int x, int y, int z)
{
  return SumOrMean(fine, x, y, z, false);
}
double MeanOfLit(const Volume& fine, int x, int y, int z)
{
  return SumOrMean(fine, x, y, z, true);
}

std::vector<Volume> Pyramid(const ReconstructionScene& scene, const std::vector<float>& values, int levels, Rule rule)
{
  std::vector<Volume> all = { { scene.grid.size, std::vector<double>(values.begin(), values.end()) } };
  for (int l = 1; l <= levels; ++l)
  {
    const Volume fine = all.back();
    Volume coarse = { { (fine.size[0] + 1) / 2, (fine.size[1] + 1) / 2, (fine.size[2] + 1) / 2 }, {} };
    ForGridVoxels(coarse.size, [&](std::size_t, int x, int y, int z) { coarse.values.push_back(rule(fine, x, y, z)); });
    all.push_back(coarse);
  }
  return all;
}

double Interpolated(const std::vector<Volume>& pyramid, int level, const std::array<int, 3>& voxel)
{
  int i[3];
  double part[3];
  for (int a = 0; a < 3; ++a)
  {
    const double at = (voxel[a] + 0.5) / (1 << level) - 0.5;
    i[a] = static_cast<int>(std::floor(at));
    part[a] = at - i[a];
  }
  double sum = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    const int d[3] = { k % 2, k / 2 % 2, k / 4 };
    double weight = 1.0;
    for (int a = 0; a < 3; ++a)
    {
      weight *= d[a] ? part[a] : 1.0 - part[a];
    }
    sum += weight * pyramid[static_cast<std::size_t>(level)].At(i[0] + d[0], i[1] + d[1], i[2] + d[2]);
  }
  return sum;
}

/// Photons in some voxels, of varied weight, and light that goes with them.
ReconstructionScene Sparse(std::array<int, 3> size)
{
  ReconstructionScene scene(size);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> part;
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    scene.count[i] = part(random) < 0.4f ? 0.0f : std::floor(4.0f * part(random)) + 1.0f;
    scene.weight[i] = scene.count[i] > 0.0f ? 0.2f + 5.0f * part(random) * part(random) : 0.0f;
    scene.batchFluence[2 * i] = scene.batchFluence[2 * i + 1] = scene.count[i] * scene.weight[i];
  }
  return scene.Average();
}

ReconstructionSettings Raw(Estimator estimator)
{
  ReconstructionSettings settings = By(estimator);
  settings.conserve = false;
  settings.levels = 4;
  return settings;
}

/// Listing B.3.
int PublishedLevel(const std::vector<Volume>& light, const std::vector<Volume>& counts,
  const std::vector<Volume>& weights, double weightStep, int top, const std::array<int, 3>& voxel)
{
  int found = 0;
  while (found < top && Interpolated(counts, found, voxel) < 1.0)
  {
    ++found;
  }
  const int byWeight = std::min(top, static_cast<int>(Interpolated(weights, found, voxel) / weightStep));
  int level = 0;
  double center = Interpolated(light, 0, voxel), surround = Interpolated(light, 1, voxel);
  double difference = std::abs(center - surround);
  center = surround;
  surround = Interpolated(light, 2, voxel);
  double next = std::abs(center - surround);
  while (next <= difference && level + 2 < top)
  {
    ++level;
    center = surround;
    surround = Interpolated(light, level + 2, voxel);
    difference = next;
    next = std::abs(center - surround);
  }
  return std::min(level, byWeight);
}

class PublishedReconstruction : public DeviceTest
{
};
}

TEST_F(PublishedReconstruction, TheGaussPyramidIsThatOfDoubles)
{
  for (std::array<int, 3> size : { std::array<int, 3>{ 33, 18, 9 }, { 7, 5, 12 }, { 32, 32, 16 } })
  {
    const ReconstructionScene scene = Sparse(size);
    const std::vector<Volume> pyramid = Pyramid(scene, scene.fluence, 4, Gauss);
    for (int level = 0; level <= 3; ++level)
    {
      ReconstructionSettings settings = Raw(Estimator::ConstantRadius);
      settings.level = level;
      const ReconstructedLight light = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
      for (std::size_t i = 0; i < light.fluence.size(); ++i)
      {
        ASSERT_NEAR(light.fluence[i], Interpolated(pyramid, level, scene.Place(i)), 1e-5) << level << ' ' << i;
        ASSERT_EQ(light.mipLevel[i], static_cast<float>(level));
      }
    }
  }
}

TEST_F(PublishedReconstruction, NearestPhotonsTakesTheFirstLevelWithEnough)
{
  for (std::array<int, 3> size : { std::array<int, 3>{ 33, 18, 9 }, { 7, 5, 12 }, { 32, 32, 16 } })
  {
    const ReconstructionScene scene = Sparse(size);
    const std::vector<Volume> counts = Pyramid(scene, scene.count, 4, Sum);
    const ReconstructedLight light =
      Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), Raw(Estimator::NearestPhotons));
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      int level = 0;
      bool sure = true;
      for (; level < 4 && Interpolated(counts, level, scene.Place(i)) < 20.0; ++level)
      {
        sure = sure && Interpolated(counts, level, scene.Place(i)) < 19.999;
      }
      if (sure && (level == 4 || Interpolated(counts, level, scene.Place(i)) > 20.001))
      {
        ASSERT_EQ(light.mipLevel[i], static_cast<float>(level)) << i;
      }
    }
  }
}

TEST_F(PublishedReconstruction, LevelsAreThoseOfTheListing)
{
  for (std::array<int, 3> size : { std::array<int, 3>{ 33, 18, 9 }, { 11, 5, 12 }, { 32, 32, 16 } })
  {
    const ReconstructionScene scene = Sparse(size);
    const std::vector<Volume> light = Pyramid(scene, scene.fluence, 4, Gauss);
    const std::vector<Volume> counts = Pyramid(scene, scene.count, 4, Sum);
    const std::vector<Volume> weights = Pyramid(scene, scene.weight, 4, MeanOfLit);
    ReconstructionSettings settings = Raw(Estimator::Published);
    settings.weightStep = 0.7;
    const ReconstructedLight filtered = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
    std::size_t others = 0;
    std::array<int, 5> taken = {};
    for (std::size_t i = 0; i < filtered.fluence.size(); ++i)
    {
      const int level = PublishedLevel(light, counts, weights, 0.7, 4, scene.Place(i));
      others += filtered.mipLevel[i] != static_cast<float>(level); // where floats round a comparison to the other side
      ++taken[static_cast<std::size_t>(level)];
      ASSERT_NEAR(
        filtered.fluence[i], Interpolated(light, static_cast<int>(filtered.mipLevel[i]), scene.Place(i)), 1e-5);
    }
    EXPECT_LE(others, filtered.fluence.size() / 10000);
    EXPECT_GT(taken[0], 0);
    EXPECT_GT(taken[1], 0);
    EXPECT_GT(taken[2], 0);
  }
}

TEST_F(PublishedReconstruction, AHoleIsFilled)
{
  ReconstructionScene scene({ 32, 32, 32 });
  scene.Light([](std::size_t) { return 1.0; }, 0.0);
  const std::size_t hole = (16 * 32 + 15) * 32 + 17;
  scene.fluence[hole] = scene.count[hole] = scene.weight[hole] = 0.0f;
  const ReconstructedLight light =
    Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), Raw(Estimator::Published));
  EXPECT_GE(light.mipLevel[hole], 1.0f);
  EXPECT_NEAR(light.fluence[hole], 1.0, 0.05);
}

TEST_F(PublishedReconstruction, StaysLowAtAnEdgeAndClimbsInEvenNoise)
{
  ReconstructionScene scene({ 64, 32, 32 });
  scene.Light([&](std::size_t i) { return scene.Place(i)[0] < 32 ? 10.0 : 1.0; }, 0.0);
  scene.weight.assign(scene.weight.size(), 100.0f); // the surround alone chooses
  ReconstructionSettings settings = Raw(Estimator::Published);
  settings.weightStep = 1.0;
  settings.levels = 5;
  const auto level = [&](const ReconstructedLight& light, int x) { return light.mipLevel[(16 * 32 + 16) * 64 + x]; };
  const ReconstructedLight edge = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  EXPECT_EQ(level(edge, 29), 0.0f); // two levels of it differ more than none
  EXPECT_GE(level(edge, 4), 1.0f);

  scene.Light([](std::size_t) { return 1.0; }, 0.5);
  const ReconstructedLight noise = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  double mean = 0.0;
  for (float l : noise.mipLevel)
  {
    mean += l / static_cast<double>(noise.mipLevel.size());
  }
  EXPECT_GT(mean, 1.0);
}

TEST_F(PublishedReconstruction, WithoutAStepTheMeanWeightIsOne)
{
  ReconstructionScene scene = Sparse({ 24, 20, 16 });
  double sum = 0.0, lit = 0.0;
  for (float weight : scene.weight)
  {
    sum += weight;
    lit += weight > 0.0f;
  }
  ReconstructionSettings settings = Raw(Estimator::Published);
  const ReconstructedLight byItself = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  settings.weightStep = 0.999 * sum / lit;
  EXPECT_EQ(byItself.mipLevel, Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings).mipLevel);
}

TEST_F(PublishedReconstruction, ScalesToTheTotalWhereAsked)
{
  const ReconstructionScene scene = Sparse({ 33, 18, 9 });
  ReconstructionSettings settings = Raw(Estimator::Published);
  const ReconstructedLight raw = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  settings.conserve = true;
  const ReconstructedLight scaled = Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  const double before = Total(scene.fluence, 1, 0);
  EXPECT_NEAR(raw.bias, Total(raw.fluence, 1, 0) / before - 1.0, 1e-6);
  EXPECT_GT(std::abs(raw.bias), 1e-4);
  EXPECT_NEAR(Total(scaled.fluence, 1, 0), before, 1e-6 * before);
  EXPECT_EQ(raw.mipLevel, scaled.mipLevel);
}
