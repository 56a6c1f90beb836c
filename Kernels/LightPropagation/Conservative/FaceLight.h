#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Light that leaves through the cells of the box's faces, and what comes back of it through those that reflect: the
/// reflectance of a face (Illumination::faceAlbedo) times the power that left through a cell comes in through the same
/// cell, the same radiance along all directions (Lambert; numerics.md, section 7.12). Of power nothing is lost or made,
/// whatever the directions.
///
/// Sweeps bring and take light through cells in the pattern of their rays: what they took is given back over what
/// radiance 1 brings through the same cell, so that even light stays even. What comes along other rays (lamps) does not
/// have that pattern: it is given back over the mean of the face.
class FaceLight
{
public:
  /// @param powerIn  W that radiance 1 brings through each cell along the directions of sweeps
  FaceLight(
    Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  bool Reflects() const { return this->AnyAlbedo; }
  const Buffer<float>& Out() const { return this->Leaving; } ///< for Deposit::faceOut
  const Buffer<float>& In() const { return this->Entering; } ///< for SweepRequest::faceIn
  const std::array<Rgb, 6>& Albedo() const { return this->AlbedoOfFaces; }

  /// What left since the last call came along rays that are not those of sweeps.
  void TakeUncollided() { this->Uncollided = this->TakeOut(); }
  /// What left since the last call, and the uncollided light before it: lets the part come in that is reflected.
  /// @return W that come back through each face
  std::array<Rgb, 6> Reflect();
  /// Of what the last call of Reflect let in, which may be negative (WarmStart), the magnitudes by cell added up; W.
  const Rgb& Magnitude() const { return this->LastMagnitude; }
  /// W that left through each cell since the last call of anything here, [channel][cell].
  std::vector<float> TakeOut();
  /// Lets W come in through each cell, [channel][cell].
  void LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided);

  /// The sums over the cells of each face, of [channel][cell].
  std::array<Rgb, 6> PowerOfFaces(const std::vector<double>& power) const;

  /// W that left through each cell in all calls of Reflect, [channel][cell]. Of what sweeps took out the pattern of
  /// their rays is taken away; the sums over faces are as they were.
  std::vector<double> LeftInAll() const;
  /// What radiance 1 brings through a cell along the rays of sweeps, over the mean of its face.
  double Pattern(std::size_t cell) const;
  /// Scaled such that the sums over faces are those of `sums`.
  std::vector<double> ScaledTo(std::vector<double> power, const std::vector<double>& sums) const;
  /// W / length^2 of W, [channel][cell]; [cell][channel] as LightField::facePower has it.
  std::vector<float> PerArea(const std::vector<double>& power) const;
  std::size_t Cells() const { return this->FaceOfCell.size(); }
  int FaceOf(std::size_t cell) const { return this->FaceOfCell[cell]; }

private:
  Grid TheGrid;
  int Channels;
  std::array<Rgb, 6> AlbedoOfFaces;
  bool AnyAlbedo;
  std::vector<int> FaceOfCell;
  std::vector<double> PowerIn; ///< W that radiance 1 brings through each cell
  std::vector<double> MeanIn;  ///< the same in the mean over its face
  std::vector<float> Uncollided;
  std::vector<double> AllSwept, AllUncollided;
  Rgb LastMagnitude = {};
  Buffer<float> Leaving, Entering; ///< [channel][cell]
};

/// W that radiance 1 brings through each cell of the box's faces along the rays of sweeps, which come in through some
/// planes of voxels more than through others.
/// @param spreads  each through all cells that it stands for (Deposit::spreadsAside)
std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads);
}
