#pragma once

#include "PhotonScene.h"

#include "Numerics/Constants.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

/// A cube of side 1 from the origin on, of `edge` voxels along each axis.
inline PhotonScene UnitCube(int edge, double tau, double albedo, double g = 0.0)
{
  PhotonScene scene(
    { edge, edge, edge }, 1.0 / edge, 0.0, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  scene.medium.phase = tyndall::PhaseFunction::HenyeyGreenstein(g);
  scene.settings.maximumOrders = 0;
  return scene;
}

/// Photons at random, of 1 W in all, so that those of two batches have nothing in common.
class RandomPhotons
{
public:
  explicit RandomPhotons(const tyndall::Grid& grid, unsigned seed = 1)
    : Box(grid)
    , Random(seed)
  {
  }

  /// Diffuse light through a face: -x, +x, ... +z.
  std::vector<tyndall::Photon> ThroughFace(int face, std::size_t count)
  {
    return this->Make(count, [&](tyndall::Photon& photon) {
      const int axis = face / 2;
      photon.position[axis] = this->Box.origin[axis] + (face % 2 == 0 ? 0.0 : this->Box.Length(axis));
      const double cosine = std::sqrt(this->Uniform()), turn = 2.0 * tyndall::Pi * this->Uniform();
      const double sine = std::sqrt(1.0 - cosine * cosine);
      photon.direction[axis] = static_cast<float>(face % 2 == 0 ? cosine : -cosine);
      photon.direction[(axis + 1) % 3] = static_cast<float>(sine * std::cos(turn));
      photon.direction[(axis + 2) % 3] = static_cast<float>(sine * std::sin(turn));
    });
  }

  /// The same through all faces, by their areas.
  std::vector<tyndall::Photon> ThroughAllFaces(std::size_t count)
  {
    std::array<double, 3> area;
    double all = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      area[a] = this->Box.Length((a + 1) % 3) * this->Box.Length((a + 2) % 3);
      all += 2.0 * area[a];
    }
    std::vector<tyndall::Photon> photons;
    for (int face = 0; face < 6; ++face)
    {
      const double part = area[face / 2] / all;
      std::vector<tyndall::Photon> own =
        this->ThroughFace(face, static_cast<std::size_t>(part * static_cast<double>(count)));
      for (tyndall::Photon& photon : own)
      {
        for (float& power : photon.power)
        {
          power *= static_cast<float>(part);
        }
      }
      photons.insert(photons.end(), own.begin(), own.end());
    }
    return photons;
  }

  /// Along one direction through face -z.
  std::vector<tyndall::Photon> Beam(double mu, std::size_t count)
  {
    return this->Make(count, [&](tyndall::Photon& photon) {
      photon.position[2] = this->Box.origin[2];
      photon.direction = { static_cast<float>(std::sqrt(1.0 - mu * mu)), 0.0f, static_cast<float>(mu) };
    });
  }

  /// From everywhere in the box, in all directions.
  std::vector<tyndall::Photon> Within(std::size_t count)
  {
    return this->Make(count, [&](tyndall::Photon& photon) {
      const double z = 2.0 * this->Uniform() - 1.0, turn = 2.0 * tyndall::Pi * this->Uniform();
      const double sine = std::sqrt(1.0 - z * z);
      photon.direction = { static_cast<float>(sine * std::cos(turn)), static_cast<float>(sine * std::sin(turn)),
        static_cast<float>(z) };
    });
  }

private:
  double Uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }

  template <class Place>
  std::vector<tyndall::Photon> Make(std::size_t count, const Place& place)
  {
    std::vector<tyndall::Photon> photons(count);
    const float power = 1.0f / static_cast<float>(count);
    for (tyndall::Photon& photon : photons)
    {
      photon.power = { power, power, power };
      for (int a = 0; a < 3; ++a)
      {
        photon.position[a] = this->Box.origin[a] + this->Uniform() * this->Box.Length(a);
      }
      place(photon);
    }
    return photons;
  }

  tyndall::Grid Box;
  std::mt19937_64 Random;
};
