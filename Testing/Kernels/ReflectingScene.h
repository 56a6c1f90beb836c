#pragma once

#include "MediumScene.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

/// Boxes whose faces give back light, and what is known of them.

inline tyndall::Rgb Grey(double value)
{
  return { value, value, value };
}

/// Makes of a scene a box in which the radiance is 1 (times `colour`) everywhere and along every direction: a medium of
/// random density that emits what it absorbs, faces that give back their part and shine with the rest.
inline void MakeReflectingFurnace(Scene& scene, double thickest, double albedo, const tyndall::Rgb& colour)
{
  scene.medium.grid.spacing = { 1.0, 1.3, 0.8 };
  scene.Randomise(thickest, 2.0, albedo);
  scene.emission.resize(3 * scene.sigma_a.size());
  for (std::size_t i = 0; i < scene.emission.size(); ++i)
  {
    scene.emission[i] = static_cast<float>(scene.sigma_a[i / 3] * colour[i % 3]);
  }
  const tyndall::Rgb albedos[6] = { { 0.3, 0.5, 0.0 }, { 0.9, 0.1, 1.0 }, { 0.0, 0.2, 0.6 }, { 1.0, 1.0, 1.0 },
    { 0.8, 0.7, 0.5 }, { 0.5, 0.5, 0.5 } };
  for (int face = 0; face < 6; ++face)
  {
    scene.light.faceAlbedo[face] = albedos[face];
    for (int c = 0; c < 3; ++c)
    {
      scene.light.faces[face][c] = (1.0 - albedos[face][c]) * colour[c];
    }
  }
}

/// Largest relative deviation of fluence from that of radiance `colour`.
inline double Deviation(const tyndall::LightField& light, const tyndall::Rgb& colour)
{
  double most = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const double radiance = colour[light.channels == 3 ? i % 3 : 0];
    most = std::max(most, std::abs(light.fluence[i] / (4.0 * tyndall::Pi * radiance) - 1.0));
  }
  return most;
}

/// Lights a slab above ground, from above, by diffuse light (cosine 0) or a sun.
inline void LightOverGround(Scene& scene, double ground, double cosine)
{
  scene.light.faceAlbedo[4] = Grey(ground);
  if (cosine > 0.0)
  {
    scene.ShineAlong({ std::sqrt(1.0 - cosine * cosine), 0.0, -cosine }, 1.0 / cosine);
  }
  else
  {
    scene.light.faces[5] = Grey(1.0);
  }
}

/// W that leave through a face, before it gives back its part.
inline double Leaving(const tyndall::LightField& light, const tyndall::Grid& grid, int face, int channel)
{
  const tyndall::BoxFaceLayout layout = tyndall::LayoutOfFace(grid, face);
  const std::size_t cells = grid.VoxelCount() / grid.size[face / 2];
  double power = 0.0;
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    power += light.facePower[(layout.first + cell) * light.channels + channel];
  }
  return power * grid.VoxelVolume() / grid.spacing[face / 2];
}
