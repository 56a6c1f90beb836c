#pragma once

#include "Distribution/Domain.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Lights/Rgb.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Uncollided light by known voxel, as an image and with its arrays.
struct Uncollided
{
  std::vector<float> fluence, netFlux;
  std::vector<float> firstMoments; ///< as LightField has them, of the image's channels; empty: not known
  UncollidedImage image;           ///< `escaped` on the first rank that has voxels, 0 on the others
  Rgb lost = {};                   ///< W that entered and was deposited nowhere, likewise

  /// Distance in voxels, 0 to 1/2, of the mean place where a voxel's light collides from its middle towards a face.
  double Nearer(std::size_t voxel, int channel, std::size_t face) const;
};

/// Weight of a direction in even light; those of all directions add up to 1.
double LatticeWeight(int directions, int i);

/// Second moment of the links' directions along an axis: sum of w c c.
double LatticeSquares(int directions);

/// What each voxel of one channel does to the light of a step (numerics.md, Eqs. (L2) to (L6)), by known voxel.
struct LatticeVoxels
{
  std::vector<float> turning; ///< part of the density that collisions make even; published: that is scattered
  std::vector<float> lost;    ///< part that is absorbed
  std::vector<float> kept;    ///< part that is not, or as published neither absorbed nor scattered
  std::vector<float> passes;  ///< part that links let through
  std::vector<float> squared; ///< n^2
  std::vector<float> source;  ///< W / length^2 a step, even in all directions
  /// W / length^2 of uncollided light, by voxel and face, that is first scattered so near to the face that its source
  /// lies on the other side (Eq. (L13)). Empty: none.
  std::vector<float> crossing;
  /// By voxel, a whole number whose bit k stands for directions 2 k and 2 k + 1: along these its line of links wraps
  /// around periodic axes and meets next to nothing, so that light on it would never end. No light is sent along such a
  /// line; what begins in its voxels is sent along the others. Empty: there is none.
  std::vector<float> endless;
  std::vector<double> begins;       ///< part of the source that is not absorbed in its first step, Eq. (L4a)
  bool bends = false;               ///< n^2 varies
  bool passesAll = true;            ///< no link gives back light
  double thickest = 0.0;            ///< sigma_t h, by the transport extinction
  std::array<double, 6> incoming{}; ///< W / length^2: fluence of the diffuse light outside -x, +x, ... +z, over n^2
  std::array<double, 6> albedo{};   ///< of the faces

  /// Collective. @param problem  must outlive it
  /// @throws InvalidInput where light begins in a voxel all of whose lines are endless (names the first known one)
  LatticeVoxels(const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct, int channel);

  /// Sets the sources, of uncollided light and of emission.
  void LoadSources(const Uncollided& direct);
  /// Weight of the directions along which light is sent; 1 but on endless lines.
  double OpenWeight(std::size_t voxel) const;

  bool Reflects() const; ///< a face has an albedo above 0
  double Given() const;  ///< above 0: there is a source, in a voxel or outside a face

  /// Fluence over n^2 that drives 1 W / length^2: from a voxel's centre to its faces, to the centre of the next voxel,
  /// and out of the box through a face (Eq. (L12)). Infinite at a face of albedo 1.
  /// @param least  part of the light that a step turns or absorbs, as which less counts
  double ResistanceWithin(std::size_t voxel, double least = 0.0) const;
  double ResistanceBetween(std::size_t a, std::size_t b, double least = 0.0) const;
  double ResistanceOfFace(std::size_t voxel, std::size_t face, double least = 0.0) const;

private:
  void Load(const LatticeSettings& settings);
  void ReduceGlobals();
  void LoadBoundary();
  void FindEndless(const std::array<bool, 3>& periodic);
  void CheckLightEnds() const;
  void CrossFaces(const Uncollided& direct, std::vector<double>& begin);
  double PartWithin(std::size_t voxel, std::size_t face) const;

  const LatticeProblem& Problem;
  const int Channel, Directions;
};
}
