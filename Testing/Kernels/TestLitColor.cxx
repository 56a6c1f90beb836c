#include "Viewing/LitColor.h"

#include "Distribution/BoxExchange.h"
#include "Numerics/Constants.h"
#include "RanksInThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tyndall;

namespace
{
ToneMapping Exposed(double exposure, ToneCurve curve = ToneCurve::Filmic)
{
  ToneMapping tones;
  tones.exposure = exposure;
  tones.curve = curve;
  return tones;
}

/// A medium that owns its arrays, of one kind of voxel.
struct LitBox
{
  Medium medium;
  std::vector<float> sigma_a, sigma_s, emission, fluence;

  explicit LitBox(std::array<int, 3> size, float absorption, float scattering, float light)
  {
    this->medium.grid.size = size;
    const std::size_t voxels = this->medium.grid.VoxelCount();
    this->sigma_a.assign(voxels, absorption);
    this->sigma_s.assign(voxels, scattering);
    this->fluence.assign(voxels, light);
  }

  LitColor Color(const ToneMapping& tones)
  {
    const int components = static_cast<int>(this->sigma_a.size() / this->medium.grid.VoxelCount());
    this->medium.sigma_a = { this->sigma_a.data(), components };
    this->medium.sigma_s = { this->sigma_s.data(), components };
    this->medium.emission = { this->emission.empty() ? nullptr : this->emission.data(), 1 };
    return ColorLitMedium(Domain(this->medium.grid), this->medium, { this->fluence.data(), 1 }, tones);
  }
};

/// k sigma_t of a voxel, 1/length, of its alpha.
double ShownExtinction(const LitColor& lit, std::size_t voxel)
{
  return -std::log1p(-lit.rgba[4 * voxel + 3] / 255.0) / lit.distance;
}

TEST(LitColor, IsTheScatteredAndEmittedRadianceOfEachVoxel)
{
  LitBox box({ 2, 1, 1 }, 0.5f, 1.5f, 2.0f);
  box.emission = { 0.0f, 0.3f };
  box.fluence[1] = 0.7f;
  const ToneMapping tones = Exposed(2.0);
  const LitColor lit = box.Color(tones);
  for (std::size_t voxel = 0; voxel < 2; ++voxel)
  {
    const double scattered = 1.5 * box.fluence[voxel] / (4.0 * Pi);
    const auto radiance = static_cast<float>((scattered + box.emission[voxel]) / 2.0);
    const auto expected = ToneMap({ radiance, radiance, radiance }, {}, tones);
    for (std::size_t c = 0; c < 3; ++c)
    {
      EXPECT_EQ(expected[c], lit.rgba[4 * voxel + c]) << voxel;
    }
  }
  EXPECT_EQ(2.0, lit.exposure);
}

TEST(LitColor, AVeilOverBlackLooksAsItsRadiance)
{
  for (ToneCurve curve : { ToneCurve::Linear, ToneCurve::Filmic })
  {
    for (double exposed : { 0.02, 0.2, 0.6, 0.95 })
    {
      LitBox box({ 1, 1, 20 }, 0.0f, 0.5f, static_cast<float>(4.0 * Pi));
      const ToneMapping tones = Exposed(exposed, curve);
      const LitColor lit = box.Color(tones);
      for (double part : { 0.15, 0.25, 0.4 })
      {
        const double depth = -std::log1p(-part);
        const double shown = -std::expm1(-ShownExtinction(lit, 0) / 0.5 * depth) * lit.rgba[0];
        const auto veil = static_cast<float>(part);
        const double right = ToneMap({ veil, veil, veil }, {}, tones)[0];
        const double straight = part * lit.rgba[0]; // without k
        EXPECT_NEAR(right, shown, part == 0.25 ? 3.0 : 20.0) << exposed << " " << part;
        EXPECT_LE(std::abs(right - shown), std::max(0.5 * std::abs(right - straight), 4.0)) << exposed << " " << part;
      }
    }
  }
}

TEST(LitColor, WhatIsNeverOpaqueIsOnlyAsBrightAsItBecomes)
{
  LitBox box({ 1, 1, 8 }, 0.0f, 0.01f, static_cast<float>(4.0 * Pi));
  const ToneMapping tones = Exposed(2.0);
  const LitColor lit = box.Color(tones);
  EXPECT_LT(lit.rgba[0], 190) << "not the white of radiance 2";
  const double seen = -std::expm1(-0.08); // along z
  const auto radiance = static_cast<float>(seen);
  const double right = ToneMap({ radiance, radiance, radiance }, {}, tones)[0];
  EXPECT_NEAR(right, -std::expm1(-8.0 * ShownExtinction(lit, 0)) * lit.rgba[0], 20.0);
}

TEST(LitColor, EmptyVoxelsHaveTheColourOfTheirNeighbours)
{
  LitBox box({ 5, 1, 1 }, 0.0f, 9.0f, 3.0f);
  for (std::size_t empty : { 1, 2, 3, 4 })
  {
    box.sigma_s[empty] = 0.0f;
  }
  const LitColor lit = box.Color(Exposed(1.0));
  EXPECT_GT(lit.rgba[0], 50);
  EXPECT_EQ(lit.rgba[0], lit.rgba[4]) << "beside the medium";
  EXPECT_EQ(0, lit.rgba[7]) << "but nothing is there";
  EXPECT_EQ(0, lit.rgba[8]) << "beyond";
}

TEST(LitColor, ThinMediaAreToldApartByALongerDistance)
{
  LitBox box({ 4, 4, 4 }, 0.0f, 1e-5f, 3.0f);
  box.sigma_s[7] = 5e-6f;
  const LitColor lit = box.Color(Exposed(1.0));
  EXPECT_GT(lit.distance, 1e4);
  EXPECT_NEAR(0.5, ShownExtinction(lit, 7) / ShownExtinction(lit, 0), 0.02);

  LitBox thick({ 4, 4, 4 }, 0.0f, 100.0f, 3.0f);
  thick.medium.grid.spacing = { 2.0, 0.5, 1.0 };
  EXPECT_EQ(0.5, thick.Color(Exposed(1.0)).distance) << "the shortest edge";
}

TEST(LitColor, ExposureIsThatOfViewsAlongTheAxes)
{
  LitBox box({ 3, 4, 5 }, 50.0f, 50.0f, static_cast<float>(8.0 * Pi)); // opaque, of radiance 1
  EXPECT_NEAR(0.18, box.Color({}).exposure, 1e-3);

  LitBox veil({ 1, 1, 1 }, 0.5f, 0.5f, static_cast<float>(8.0 * Pi));
  EXPECT_NEAR(0.18, veil.Color({}).exposure, 1e-3); // of what is lit, not of the dark that is seen through it
}

TEST(LitColor, OfColouredExtinctionAThinVeilHasTheRightColour)
{
  LitBox box({ 1, 1, 1 }, 0.0f, 0.0f, static_cast<float>(4.0 * Pi));
  box.sigma_a = { 0.0f, 0.0f, 0.0f };
  box.sigma_s = { 0.01f, 0.02f, 0.03f };
  const double most = (1.0 - std::exp(-0.02)) / 0.95;
  const ToneMapping tones = Exposed(0.5 / most, ToneCurve::Linear);
  const LitColor lit = box.Color(tones);
  const auto expected = ToneMap({ 0.5f, 1.0f, 1.5f }, {}, Exposed(0.5, ToneCurve::Linear));
  for (std::size_t c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(expected[c], lit.rgba[c], 1.0);
  }
}

TEST(LitColor, VacuumAndDarknessAreBlack)
{
  LitBox vacuum({ 2, 2, 2 }, 0.0f, 0.0f, 1.0f);
  const LitColor nothing = vacuum.Color({});
  EXPECT_TRUE(std::all_of(nothing.rgba.begin(), nothing.rgba.end(), [](int value) { return value == 0; }));
  EXPECT_EQ(1.0, nothing.distance);
  EXPECT_EQ(1.0, nothing.exposure);

  LitBox dark({ 1, 1, 1 }, 1.0f, 1e6f, 0.0f);
  const LitColor night = dark.Color({});
  EXPECT_EQ((std::vector<std::uint8_t>{ 0, 0, 0, 255 }), night.rgba);
}
}

/// Blocks of any sizes, one of them empty: the colours, the exposure and the distance of the whole.
TEST(LitColor, IsTheSameInBlocks)
{
  LitBox box({ 7, 9, 8 }, 0.0f, 0.0f, 0.0f);
  const std::size_t voxels = box.medium.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const bool empty = i % 3 == 0 || i % 7 == 0; // coloured by their neighbours
    box.sigma_a[i] = empty ? 0.0f : static_cast<float>(0.1 + 0.1 * std::sin(0.1 * i));
    box.sigma_s[i] = empty ? 0.0f : static_cast<float>(0.4 + 0.3 * std::cos(0.3 * i));
    box.fluence[i] = static_cast<float>(1.0 + std::sin(0.05 * i));
  }
  const ToneMapping tones = Exposed(0.0);
  const LitColor expected = box.Color(tones);
  const Grid& grid = box.medium.grid;
  const VoxelBox all = { { 0, 0, 0 }, grid.size };
  const BlockPartition uneven = { grid,
    { { { 2, 0, 0 }, { 5, 9, 8 } }, {}, { { 0, 0, 0 }, { 2, 1, 8 } }, { { 0, 1, 0 }, { 2, 8, 8 } } } };
  for (const BlockPartition& partition : { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 8), uneven })
  {
    const int ranks = static_cast<int>(partition.blocks.size());
    RunInThreads(ranks, [&](Communicator& communicator) {
      const VoxelBox& own = partition.blocks[communicator.Rank()];
      const std::vector<float> sigma_a = PartOf(box.sigma_a, all, own, 1), sigma_s = PartOf(box.sigma_s, all, own, 1);
      const std::vector<float> fluence = PartOf(box.fluence, all, own, 1);
      Medium medium = box.medium;
      medium.grid = partition.OwnGrid(communicator.Rank());
      medium.sigma_a = { sigma_a.data(), 1 };
      medium.sigma_s = { sigma_s.data(), 1 };
      const LitColor lit = ColorLitMedium(Domain(communicator, partition), medium, { fluence.data(), 1 }, tones);
      EXPECT_NEAR(lit.exposure, expected.exposure, 1e-6 * expected.exposure);
      EXPECT_NEAR(lit.distance, expected.distance, 1e-5 * expected.distance);
      const std::vector<float> rgba(expected.rgba.begin(), expected.rgba.end());
      const std::vector<float> wanted = PartOf(rgba, all, own, 4);
      ASSERT_EQ(lit.rgba.size(), wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i)
      {
        EXPECT_NEAR(lit.rgba[i], wanted[i], 1.0); // where rounding falls
      }
    });
  }
}
