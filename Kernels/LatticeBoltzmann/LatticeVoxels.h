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

/// Second moment of the lattice directions along an axis: the sum over directions of weight times squared component of
/// the link vector.
double LatticeSquares(int directions);

/// Coefficients of the lattice step for one channel, by own and ghost voxel (numerics.md, Eqs. (L2) to (L6)).
struct LatticeVoxels
{
  /// Fraction of the density that a step's collision makes isotropic; published scheme: fraction that is scattered.
  std::vector<float> turning;
  std::vector<float> lost; ///< fraction of the density that is absorbed in a step
  /// Fraction of the density that is not absorbed in a step; published scheme: neither absorbed nor scattered.
  std::vector<float> kept;
  std::vector<float> passes;  ///< fraction of light that a link between two voxels like this one transmits
  std::vector<float> squared; ///< n^2
  std::vector<float> source;  ///< isotropic source, W / length^2 per step
  /// First-collision source that is moved across a face, to the next voxel or out of the box, because light is first
  /// scattered near the face (Eq. (L13)), W / length^2, [voxel][face]. Empty: none is moved.
  std::vector<float> crossing;
  /// Endless lines, by voxel: bit k of the (integer) value is set if the line of links along directions 2 k and 2 k + 1
  /// through the voxel closes around periodic axes and has almost no extinction, so that light on it would never end.
  /// No light is sent along an endless line; sources in its voxels emit along the other lines. Empty: no line is
  /// endless.
  std::vector<float> endless;
  std::vector<double> begins;       ///< fraction of the source that is not absorbed in its first step, Eq. (L4a)
  bool bends = false;               ///< whether n^2 varies between voxels
  bool passesAll = true;            ///< whether no link reflects light
  double thickest = 0.0;            ///< largest optical thickness of a voxel, sigma_t h with the transport extinction
  std::array<double, 6> incoming{}; ///< fluence / n^2 of the diffuse light outside -x, +x, ... +z, W / length^2
  std::array<double, 6> albedo{};   ///< albedo of the faces -x, +x, ... +z

  /// Collective. @param problem must outlive this object
  /// @throws InvalidInput if all lines through a voxel with a source are endless (names the first such known voxel)
  LatticeVoxels(const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct, int channel);

  /// Sets `source` and `crossing` from the first-collision source of uncollided light and from emission.
  void LoadSources(const Uncollided& direct);
  /// Total weight of the directions along which a voxel sends light; 1 unless some of its lines are endless.
  double OpenWeight(std::size_t voxel) const;

  bool Reflects() const; ///< whether a face has an albedo above 0
  /// sum of the isotropic sources of all own and ghost voxels and of the incident light at the faces; 0 if there is no
  /// light
  double Given() const;

  /// Diffusive resistances (Eq. (L12)): difference of fluence / n^2 that drives a flux of 1 W / length^2 from a voxel's
  /// centre to its faces (Within), between the centres of neighbours (Between), and from a centre out of the box
  /// (OfFace; infinite at a face of albedo 1).
  /// @param least  lower bound for the fraction of light that is absorbed or scattered isotropically in a step
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
