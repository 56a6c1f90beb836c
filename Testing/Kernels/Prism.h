#pragma once

#include "MeshShapes.h"
#include "PhotonScene.h"
#include "RefractionOptics.h"

/// A prism of glass in air, equilateral, voxelised from a mesh, and how far it turns rays.
namespace prism
{
constexpr double Index = 1.5;
constexpr double Apex = optics::Pi / 3.0;
constexpr double Side = 1.2; ///< in a cube from -1 to 1

inline PhotonScene Scene(tyndall::Device& device, int edge, int samples = 4)
{
  PhotonScene scene(edge);
  scene.Voxelize(device, shapes::Prism(Side, 1.5), Index, 9, samples);
  return scene;
}

/// Incidences, from the normal, of which the ray leaves through the middle of the next face or near it: before, of and
/// beyond least deviation.
inline std::vector<double> Incidences()
{
  return { 0.7, optics::IncidenceOfLeastTurn(Index, Apex), 1.0 };
}

/// Angles by which rays are turned that meet the face on the left at several places about its middle.
inline std::vector<double> Turns(tyndall::PhotonMarcher& marcher, double incidence)
{
  const double up = incidence - 0.5 * Apex; // the face's normal points to the left and up by half of the angle
  const std::array<double, 3> d = { std::cos(up), std::sin(up), 0.0 };
  const double radius = Side / std::sqrt(3.0);
  std::vector<tyndall::Photon> photons;
  std::vector<std::size_t> all;
  for (int i = 0; i < 32; ++i)
  {
    const double along = (i - 15.5) * 0.005, deep = (i * 13 % 32 - 15.5) * 0.013;
    tyndall::Photon photon;
    photon.position = { -0.5 * radius * std::cos(0.5 * Apex) + along * std::sin(0.5 * Apex) - 3.0 * d[0],
      0.5 * radius * std::sin(0.5 * Apex) + along * std::cos(0.5 * Apex) - 3.0 * d[1], deep };
    for (int a = 0; a < 3; ++a)
    {
      photon.direction[a] = static_cast<float>(d[a]);
    }
    photon.power = { 1.0f, 1.0f, 1.0f };
    all.push_back(photons.size());
    photons.push_back(photon);
  }
  std::vector<double> turns;
  for (const tyndall::PhotonPath& path : marcher.Paths(photons, all))
  {
    const std::array<double, 3> out = LastDirection(path);
    turns.push_back(up - std::atan2(out[1], out[0]));
  }
  return turns;
}

/// Largest difference from Snell's law at both faces, and that of the mean.
struct Error
{
  double largest = 0.0, ofMean = 0.0;
};

inline Error ErrorOf(const std::vector<double>& turns, double incidence)
{
  Error error;
  for (const double turn : turns)
  {
    const double difference = turn - optics::PrismTurn(Index, Apex, incidence);
    error.largest = std::max(error.largest, std::abs(difference));
    error.ofMean += difference / static_cast<double>(turns.size());
  }
  return error;
}
}
