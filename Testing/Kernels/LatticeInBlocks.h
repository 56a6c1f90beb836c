#pragma once

// Solves of a lattice in a medium that is spread over ranks, for tests.

#include "LatticeScene.h"
#include "MediumInBlocks.h"

#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace lattice_in_blocks
{
using namespace tyndall;

/// With all that shines, thick voxels beside thin ones, faces that give back light, and an index that varies.
inline MediumToCut Everything(std::array<int, 3> size)
{
  MediumToCut medium(size);
  Scene& scene = medium.scene;
  scene.Randomise(4.0, 2.0, 0.9, 11);
  scene.emission = RandomValues(scene.sigma_s.size(), 0.0, 0.2, 3);
  scene.ShineAlong({ 0.3, -0.5, -0.9 });
  scene.ShineAlong({ -0.6, 0.2, 0.1 }, 0.4);
  scene.ShineFromEverywhere(0.1);
  for (std::size_t face = 0; face < 6; ++face)
  {
    const double of = 0.1 * static_cast<double>(face);
    scene.light.faces[face] = { of, of, of };
    scene.light.faceAlbedo[face] = { of, of, of };
  }
  medium.ior = RandomValues(scene.sigma_s.size(), 1.0, 1.6, 5);
  return medium;
}

inline LatticeSettings SettingsOf(double tolerance = 1e-4)
{
  LatticeSettings settings;
  settings.tolerance = tolerance;
  settings.netFlux = true;
  return settings;
}

/// Of any place and way in some voxels, and of a colour.
inline std::vector<Photon> AnyPhotons(std::size_t count)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.5, 4.5);
  std::vector<Photon> photons(count);
  for (Photon& photon : photons)
  {
    photon.position = { place(random), place(random), place(random) };
    const glm::dvec3 along = glm::normalize(glm::dvec3(place(random) - 2.5, place(random) - 2.5, place(random) - 2.5));
    photon.direction = { static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z) };
    photon.power = { 0.01f, 0.02f, 0.03f };
  }
  return photons;
}

class LatticeBlocks : public LatticeTest
{
protected:
  LightField Whole(MediumToCut& medium, const LatticeSettings& settings)
  {
    medium.Attach();
    return this->Solve(medium.scene, settings, medium.ior);
  }

  LightField Whole(MediumToCut& medium, const std::vector<Photon>& photons, const LatticeSettings& settings)
  {
    medium.Attach();
    return SolveLatticeBoltzmann(
      this->GetDevice(), medium.scene.medium, medium.Index(), photons, medium.scene.light, settings);
  }

  LightField OfBlocks(const BlockPartition& partition, const MediumToCut& medium, const std::vector<Photon>& photons,
    const LatticeSettings& settings)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      const std::size_t rank = static_cast<std::size_t>(communicator.Rank()), ranks = partition.blocks.size();
      const std::vector<Photon> share(photons.begin() + static_cast<std::ptrdiff_t>(photons.size() * rank / ranks),
        photons.begin() + static_cast<std::ptrdiff_t>(photons.size() * (rank + 1) / ranks));
      return SolveLatticeInBlocks(
        this->GetDevice(), communicator, partition, part.scene.medium, part.Index(), share, part.scene.light, settings);
    });
  }

  LightField OfBlocks(const BlockPartition& partition, const MediumToCut& medium, const LatticeSettings& settings)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      return SolveLatticeInBlocks(
        this->GetDevice(), communicator, partition, part.scene.medium, part.Index(), part.scene.light, settings);
    });
  }

  LightField OnRanks(int ranks, const MediumToCut& medium, const LatticeSettings& settings)
  {
    return this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, settings);
  }

  static void ExpectSame(const LightField& found, const LightField& expected, double tolerance)
  {
    ExpectSameLight(found, expected, tolerance);
    EXPECT_TRUE(found.converged);
    EXPECT_LT(found.balance.RelativeError(expected.channels), 1e-5); // what uncollided light lost
    for (std::size_t c = 0; c < static_cast<std::size_t>(expected.channels); ++c)
    {
      const double all = expected.balance.entered[c] + expected.balance.emitted[c];
      EXPECT_LT(std::abs(found.balance.leftOver[c]), 1e-5 * all);
    }
  }

  /// The errors of three ranks, of which one is given something else than the others.
  std::vector<std::string> Errors(const std::function<void(int rank, MediumToCut&, LatticeSettings&, Monitor&)>& change,
    const BlockPartition* blocks = nullptr)
  {
    const MediumToCut medium = Everything({ 6, 5, 4 });
    const BlockPartition partition = blocks ? *blocks : BlockPartition::Even(medium.scene.medium.grid, 3);
    std::vector<std::string> errors(partition.blocks.size());
    RunInThreads(static_cast<int>(errors.size()), [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      MediumToCut part = medium.Part(partition.blocks[rank]);
      part.Attach();
      LatticeSettings settings = SettingsOf();
      Monitor monitor;
      change(rank, part, settings, monitor);
      try
      {
        SolveLatticeInBlocks(this->GetDevice(), communicator, partition, part.scene.medium, part.Index(),
          part.scene.light, settings, monitor);
      }
      catch (const std::exception& error)
      {
        errors[rank] = error.what();
      }
    });
    return errors;
  }

  void ExpectErrors(
    const std::string& words, const std::function<void(int rank, MediumToCut&, LatticeSettings&, Monitor&)>& change)
  {
    const std::vector<std::string> errors = this->Errors(change);
    for (const std::string& error : errors)
    {
      EXPECT_NE(error.find(words), std::string::npos) << error;
      EXPECT_EQ(error, errors.front());
    }
  }
};
}
