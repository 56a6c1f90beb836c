#pragma once

#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeScene.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Field.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Light that is not scattered, as an image and with its arrays.
struct Uncollided
{
  std::vector<float> fluence, netFlux;
  std::vector<float> firstMoments; ///< as LightField has them, of the image's channels; empty: not known
  UncollidedImage image;
  Rgb lost = {}; ///< W that entered and went nowhere, which the energy balance is to show

  /// Distance in voxels, 0 to 1/2, from a voxel's middle towards a face of the mean place where its light is lost.
  double Nearer(std::size_t voxel, int channel, std::size_t face) const;
};

constexpr auto Outside = static_cast<std::size_t>(-1); ///< of the box

/// The voxel past a face -x, +x, ... +z of another one, or Outside.
std::size_t VoxelBeyond(const Grid& grid, const std::array<bool, 3>& periodic, std::size_t voxel, std::size_t face);

/// Weight of a direction in even light; those of all directions add up to 1.
double LatticeWeight(int directions, int i);

/// Part of the density of even light that the links' ways carry along an axis, squared: sum of w c c.
double LatticeSquares(int directions);

/// What each voxel of one channel does to the light of a step (numerics.md, Eqs. (L2) to (L6)), by voxel.
struct LatticeVoxels
{
  std::vector<float> turning; ///< part of the density that collisions make even; published: that is scattered
  std::vector<float> lost;    ///< part that is absorbed
  std::vector<float> kept;    ///< part that is not, or as published neither absorbed nor scattered
  std::vector<float> passes;  ///< part that links let through
  std::vector<float> squared; ///< n^2
  std::vector<float> source;  ///< W / length^2, that begins evenly in all directions
  /// W / length^2 of uncollided light, by voxel and face, that is scattered first so near to the face that it begins on
  /// its other side (Eq. (L13)): no part of `source` there. Empty: none.
  std::vector<float> crossing;
  /// By voxel, a whole number whose bit k stands for directions 2 k and 2 k + 1: along these its line of links closes
  /// round periodic axes and meets next to nothing, so that light on it would never end. No light is sent along such a
  /// line; what begins in its voxels goes along the others. Empty: there is none.
  std::vector<float> endless;
  std::vector<double> begins;       ///< part of what begins in a voxel that is not absorbed in the same step, Eq. (L4a)
  bool bends = false;               ///< n^2 varies
  bool passesAll = true;            ///< no link gives back light
  double thickest = 0.0;            ///< sigma_t h, by the transport extinction
  std::array<double, 6> incoming{}; ///< W / length^2: fluence of the diffuse light outside -x, +x, ... +z, over n^2
  std::array<double, 6> albedo{};   ///< of the faces

  /// @param ior  null: 1
  LatticeVoxels(const LatticeScene& scene, const Field& ior, const LatticeSettings& settings, const Uncollided& direct,
    int channel);

  /// Source of uncollided light, and of what the medium emits.
  void Shine(const LatticeScene& scene, const Uncollided& direct, int channel);
  /// Where the lines are that light would go round without end. Collective.
  /// @param whole, periodic  the grid of all ranks
  /// @param box    of this rank, whose first own voxel is at `first` in the whole grid
  /// @param sum    over all ranks
  void FindEndless(const Grid& whole, const std::array<bool, 3>& periodic, const LatticeBox& box,
    const std::array<int, 3>& first, const std::function<std::vector<double>(const std::vector<double>&)>& sum);
  /// @throws InvalidInput where light begins in a voxel all of whose lines are endless (names the first known one)
  void CheckLightEnds(const Grid& known) const;
  /// Weight of the directions along which light is sent; 1 but on endless lines.
  double OpenWeight(std::size_t voxel) const;
  /// What comes in from outside and what faces give back. To be called again where `bends` was changed.
  void TakeOutside(const Illumination& shining, int channel);

  bool Reflects() const; ///< some face gives back light
  double Given() const;  ///< above 0: something shines

  /// Fluence over n^2 that drives 1 W / length^2: from a voxel's centre to its faces, to the centre of the next voxel,
  /// and out of the box through a face (Eq. (L12)). Infinite where a face gives back all.
  /// @param least  part of the light that a step turns or absorbs, as which less counts
  double ResistanceWithin(std::size_t voxel, double least = 0.0) const;
  double ResistanceBetween(std::size_t a, std::size_t b, double least = 0.0) const;
  double ResistanceOfFace(std::size_t voxel, std::size_t face, double least = 0.0) const;

private:
  void CrossFaces(const Medium& medium, const Uncollided& direct, int channel, std::vector<double>& begin);
  double PartWithin(const Grid& grid, std::size_t voxel, std::size_t face) const;

  int Directions;
  std::array<bool, 3> Periodic;
};
}
