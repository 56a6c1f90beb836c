#pragma once

#include "Distribution/Domain.h"
#include "LatticeBoltzmann/FindUncollided.h"
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
/// Weight of a lattice direction in isotropic light; the weights add up to 1.
double LatticeWeight(int directions, int i);

/// Second moment of the lattice directions along an axis: the sum of w c c.
double LatticeSquares(int directions);

/// Coefficients of the lattice step for one channel, by known voxel (numerics.md, Eqs. (L2) to (L6)).
struct LatticeVoxels
{
  std::vector<float>
    turning; ///< fraction of the density that collisions make isotropic; published scheme: that is scattered
  std::vector<float> lost;    ///< fraction that is absorbed
  std::vector<float> kept;    ///< fraction that is not absorbed; published scheme: neither absorbed nor scattered
  std::vector<float> passes;  ///< fraction that links transmit
  std::vector<float> squared; ///< n^2
  std::vector<float> source;  ///< isotropic source, W / length^2 per step
  /// First-collision source of uncollided light that is scattered so near to a face that the source lies on the other
  /// side (Eq. (L13)), W / length^2, by voxel and face. Empty: none.
  std::vector<float> crossing;
  /// By voxel, an integer whose bit k is set if the line of links along directions 2 k and 2 k + 1 wraps around
  /// periodic axes and has almost no extinction, so that light on it would never end. No light is sent along such a
  /// line; sources in its voxels emit along the other lines. Empty: there is none.
  std::vector<float> endless;
  std::vector<double> begins;       ///< fraction of the source that is not absorbed in its first step, Eq. (L4a)
  bool bends = false;               ///< n^2 varies
  bool passesAll = true;            ///< no link reflects light
  double thickest = 0.0;            ///< largest sigma_t h, with the transport extinction
  std::array<double, 6> incoming{}; ///< fluence / n^2 of the diffuse light outside -x, +x, ... +z, W / length^2
  std::array<double, 6> albedo{};   ///< albedo of the faces -x, +x, ... +z

  /// Collective. @param problem  must outlive it
  /// @throws InvalidInput if a voxel with a source has endless lines only (names the first such known voxel)
  LatticeVoxels(const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct, int channel);

  /// Sets the sources: first-collision source and emission.
  void LoadSources(const Uncollided& direct);
  /// Total weight of the directions along which a voxel sends light; 1 unless some of its lines are endless.
  double OpenWeight(std::size_t voxel) const;

  bool Reflects() const; ///< whether a face has an albedo above 0
  double Given() const;  ///< above 0 if there is a source, in a voxel or outside a face

  /// Diffusive resistances: the difference of fluence / n^2 that drives a flux of 1 W / length^2 from a voxel's centre
  /// to its faces, to the centre of the next voxel, and out of the box through a face (Eq. (L12)). Infinite at a face
  /// of albedo 1.
  /// @param least  lower bound for the fraction of light that a step turns or absorbs
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
