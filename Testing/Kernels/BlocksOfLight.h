#pragma once

// Solves of a medium that is spread over ranks, for tests: its parts, the light of all put together, and what it is to
// be alike in.

#include "DeviceTest.h"
#include "RandomMedium.h"

#include "Distribution/RanksInThreads.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace blocks_of_light
{
using namespace tyndall;

/// Leaves extinction as it is, but so much of it in each voxel absorbs, and so much scatters.
inline void Share(RandomMedium& whole, float absorbed, float scattered)
{
  for (std::size_t i = 0; i < whole.absorption.size(); ++i)
  {
    const float both = whole.absorption[i] + whole.scattering[i];
    whole.absorption[i] = absorbed * both;
    whole.scattering[i] = scattered * both;
  }
}

/// Such that one rank and many do the same.
inline PropagationSettings SettingsOf(int orders)
{
  PropagationSettings settings;
  settings.directionsPerFace = 9;
  settings.maximumOrders = orders;
  settings.netFlux = true;
  settings.acceleration = PropagationAcceleration::None;
  settings.source = PropagationSource::Constant;
  settings.uncollidedDirections = 0;
  settings.emissionError = 0.0;
  return settings;
}

inline Illumination LitFromOutside()
{
  Illumination shining;
  shining.faces[0] = { 1.0, 1.0, 1.0 };
  shining.sky = { 0.2, 0.2, 0.2 };
  Light sun;
  sun.direction = { 0.3, -0.5, -0.9 };
  sun.power = { 2.0, 2.0, 2.0 };
  shining.lights = { sun };
  return shining;
}

/// Lamps in the medium and beside it, each of its own kind.
inline std::vector<Light> NearLamps()
{
  std::vector<Light> lamps(4);
  const LightType types[] = { LightType::Point, LightType::Spot, LightType::Rectangle, LightType::Point };
  const std::array<double, 3> positions[] = { { 5.3, 4.1, 3.2 }, { 13.5, -2.0, 9.0 }, { 3.0, 10.5, 4.0 },
    { -1.0, 4.4, -2.5 } };
  const std::array<double, 3> directions[] = { { 0.0, 0.0, 1.0 }, { -0.7, 0.6, -0.5 }, { 0.1, -1.0, 0.2 },
    { 0.0, 0.0, 1.0 } };
  for (std::size_t i = 0; i < lamps.size(); ++i)
  {
    lamps[i].type = types[i];
    lamps[i].position = positions[i];
    lamps[i].direction = directions[i];
    lamps[i].power = { 10.0, 4.0, 1.0 };
    lamps[i].angle = 50.0;
    lamps[i].size = { 3.0, 2.0 };
  }
  return lamps;
}

/// The arrays of a box of a medium.
struct PartOf
{
  PartOf(const RandomMedium& whole, const VoxelBox& box)
    : medium(whole.medium)
    , components(static_cast<std::size_t>(whole.medium.sigma_a.components))
  {
    medium.grid.size = box.size;
    for (std::size_t i = 0; i < box.VoxelCount(); ++i)
    {
      std::array<int, 3> voxel = medium.grid.VoxelAt(i);
      for (int axis = 0; axis < 3; ++axis)
      {
        voxel[axis] += box.first[axis];
      }
      places.push_back(whole.medium.grid.IndexOf(voxel));
      const Field& ofWhole = whole.medium.phase.G();
      for (int c = 0; ofWhole.values && c < ofWhole.components; ++c)
      {
        g.push_back(ofWhole.At(places.back(), c));
      }
      for (std::size_t c = 0; c < components; ++c)
      {
        absorption.push_back(whole.absorption[places.back() * components + c]);
        scattering.push_back(whole.scattering[places.back() * components + c]);
        if (!whole.emission.empty())
        {
          emission.push_back(whole.emission[places.back() * components + c]);
        }
      }
    }
    medium.sigma_a.values = absorption.data();
    medium.sigma_s.values = scattering.data();
    medium.emission.values = emission.empty() ? nullptr : emission.data();
    if (medium.phase.Varies())
    {
      medium.phase = medium.phase.WithG({ g.data(), medium.phase.G().components });
    }
  }
  PartOf(const PartOf&) = delete;
  PartOf& operator=(const PartOf&) = delete;

  /// What shines on it: of light that is given by voxel that of its own.
  Illumination Of(const Illumination& shining)
  {
    Illumination own = shining;
    const auto take = [this](Field& field, std::vector<float>& values) {
      for (const std::size_t place : field.values ? this->places : std::vector<std::size_t>())
      {
        for (int c = 0; c < field.components; ++c)
        {
          values.push_back(field.At(place, c));
        }
      }
      field.values = field.values ? values.data() : nullptr;
    };
    take(own.uncollided.fluence, this->given);
    take(own.uncollided.meanDirection, this->directions);
    return own;
  }

  Medium medium;
  std::size_t components;
  std::vector<std::size_t> places; ///< in the whole
  std::vector<float> absorption, scattering, emission, g, given, directions;
};

/// Arrays of the blocks put together; all else of rank 0, which must be that of all.
/// @param solve  of a rank's part
inline LightField LightOfAll(const BlockPartition& partition, const RandomMedium& whole, const Illumination& shining,
  const std::function<LightField(Communicator&, const Medium&, const Illumination&)>& solve)
{
  LightField all, arrays;
  std::mutex guard;
  RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
    PartOf part(whole, partition.blocks[communicator.Rank()]);
    const LightField light = solve(communicator, part.medium, part.Of(shining));
    const std::lock_guard<std::mutex> lock(guard);
    if (all.convergence.empty())
    {
      all = light;
    }
    EXPECT_EQ(light.facePowerOut, all.facePowerOut);
    EXPECT_EQ(light.balance.absorbed, all.balance.absorbed);
    EXPECT_EQ(light.convergence.size(), all.convergence.size());
    EXPECT_EQ(light.surfaceRadiance, all.surfaceRadiance);
    EXPECT_EQ(light.relativeError, all.relativeError);
    const auto put = [&](std::vector<float> LightField::*array) {
      const std::vector<float>& from = light.*array;
      const std::size_t width = part.places.empty() ? 0 : from.size() / part.places.size();
      (arrays.*array).resize(width > 0 ? whole.medium.grid.VoxelCount() * width : (arrays.*array).size());
      for (std::size_t i = 0; i < part.places.size() * width; ++i)
      {
        (arrays.*array)[part.places[i / width] * width + i % width] = from[i];
      }
    };
    put(&LightField::fluence);
    put(&LightField::fluenceDirect);
    put(&LightField::fluenceError);
    put(&LightField::netFlux);
    put(&LightField::scatteredMoments);
    put(&LightField::straightOn);
  });
  all.fluence = arrays.fluence;
  all.fluenceDirect = arrays.fluenceDirect;
  all.fluenceError = arrays.fluenceError;
  all.netFlux = arrays.netFlux;
  all.scatteredMoments = arrays.scatteredMoments;
  all.straightOn = arrays.straightOn;
  return all;
}

inline LightField LightOfAll(Device& device, const BlockPartition& partition, const RandomMedium& whole,
  const Illumination& shining, const PropagationSettings& settings)
{
  return LightOfAll(
    partition, whole, shining, [&](Communicator& communicator, const Medium& medium, const Illumination& light) {
      return SolveConservative(device, Domain(communicator, partition), medium, light, settings);
    });
}

/// Cut into blocks of uneven sizes, by planes that do not meet; one has no voxels.
inline BlockPartition Uneven(const Grid& grid)
{
  const auto [x, y, z] = grid.size;
  const int cutX = x / 3, cutY = y / 4, cutZ = 2 * z / 3;
  return { grid,
    { { { 0, 0, 0 }, { cutX, cutY, z } }, { { 0, cutY, 0 }, { cutX, y - cutY, z } }, { { 0, 0, 0 }, { 0, 0, 0 } },
      { { cutX, 0, 0 }, { x - cutX, y, cutZ } }, { { cutX, 0, cutZ }, { x - cutX, y, z - cutZ } } } };
}

/// A rank for each voxel.
inline BlockPartition VoxelByVoxel(const Grid& grid)
{
  BlockPartition partition = { grid, {} };
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    partition.blocks.push_back({ grid.VoxelAt(i), { 1, 1, 1 } });
  }
  return partition;
}

inline double Rms(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float value : values)
  {
    sum += static_cast<double>(value) * value;
  }
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// @param around  light went round an axis, in laps of which each adds to all voxels: flux, most of which cancels, is
///   compared as a part of fluence
inline void ExpectSame(const LightField& found, const LightField& expected, bool around = false)
{
  const double flux = Rms(expected.netFlux), scale = around && flux > 0.0 ? Rms(expected.fluence) / flux : 1.0;
  EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 1e-6);
  EXPECT_LT(RelativeRmse(found.fluenceDirect, expected.fluenceDirect), 1e-6);
  EXPECT_LT(RelativeRmse(found.netFlux, expected.netFlux), 1e-6 * scale);
  EXPECT_LT(RelativeRmse(found.scatteredMoments, expected.scatteredMoments), 1e-6);
  EXPECT_EQ(found.straightOn, expected.straightOn);
  EXPECT_EQ(found.lampsApart.size(), expected.lampsApart.size());
  EXPECT_LT(RelativeRmse(found.facePower, expected.facePower), 1e-6);
  EXPECT_EQ(found.faceAlbedo, expected.faceAlbedo);
  EXPECT_EQ(found.convergence.size(), expected.convergence.size());
  EXPECT_LT(found.balance.RelativeError(expected.channels),
    std::max(1e-6, 1.1 * expected.balance.RelativeError(expected.channels)));
  for (int c = 0; c < expected.channels; ++c)
  {
    EXPECT_NEAR(found.balance.absorbed[c], expected.balance.absorbed[c], 1e-6 * expected.balance.absorbed[c]);
    EXPECT_NEAR(found.balance.entered[c], expected.balance.entered[c], 1e-6 * expected.balance.entered[c]);
    for (int face = 0; face < 6; ++face)
    {
      // Of a face that gives back all light nothing leaves in the end.
      const double most =
        std::max(expected.facePowerOut[face][c], expected.faceAlbedo[face][c] * expected.balance.absorbed[c]);
      EXPECT_NEAR(found.facePowerOut[face][c], expected.facePowerOut[face][c], 1e-6 * most);
    }
  }
}

/// In one block, and in uneven ones.
inline void ExpectTheLightOfTheWhole(
  Device& device, const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings)
{
  const bool around = settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
  const LightField expected = SolveConservative(device, whole.medium, shining, settings);
  const Grid& grid = whole.medium.grid;
  for (const BlockPartition& partition : { BlockPartition::Even(grid, 1), Uneven(grid) })
  {
    SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
    ExpectSame(LightOfAll(device, partition, whole, shining, settings), expected, around);
  }
}
}
