#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// What faces of the box give back of the light that leaves through their cells: the reflectance of a face
/// (Illumination::faceAlbedo) times the power that left through a cell comes in through the same cell, the same
/// radiance along all directions (Lambert; numerics.md, section 7.12). Of power nothing is lost or made, whatever the
/// directions.
///
/// Rays bring and take light through cells in a pattern of their own: what they took is given back over what radiance 1
/// brings through the same cell, so that even light stays even. What comes along other rays (lamps) does not have that
/// pattern: it is given back over the mean of the face.
class FaceReflection
{
public:
  /// @param powerIn  W that radiance 1 brings through each cell along the rays
  FaceReflection(const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  /// From now on rays come in through other parts of the cells.
  void SetPowerIn(std::vector<double> powerIn);

  const Grid& Box() const { return this->TheGrid; }
  bool Reflects() const { return this->AnyAlbedo; }
  const std::array<Rgb, 6>& Albedo() const { return this->AlbedoOfFaces; }
  std::size_t Cells() const { return this->FaceOfCell.size(); }
  int Channels() const { return this->ChannelCount; }
  int FaceOf(std::size_t cell) const { return this->FaceOfCell[cell]; }
  /// Of [channel][cell] what comes back.
  double AlbedoOf(std::size_t i) const
  {
    return this->AlbedoOfFaces[this->FaceOf(i % this->Cells())][i / this->Cells()];
  }

  /// Radiance that brings W in through each cell, [channel][cell] of all.
  std::vector<float> RadianceOf(const std::vector<double>& swept, const std::vector<double>& uncollided) const;

  /// The sums over the cells of each face, of [channel][cell].
  std::array<Rgb, 6> PowerOfFaces(const std::vector<double>& power) const;
  /// What radiance 1 brings through a cell along the rays, over the mean of its face.
  double Pattern(std::size_t cell) const;
  /// Scaled such that the sums over faces are those of `sums`.
  std::vector<double> ScaledTo(std::vector<double> power, const std::vector<double>& sums) const;
  std::vector<double> ScaledTo(std::vector<double> power, const std::array<Rgb, 6>& shouldBe) const; ///< W of faces
  /// W / length^2 of W, [channel][cell]; [cell][channel] as LightField::facePower has it.
  std::vector<float> PerArea(const std::vector<double>& power) const;

private:
  Grid TheGrid;
  int ChannelCount;
  std::array<Rgb, 6> AlbedoOfFaces;
  bool AnyAlbedo;
  std::vector<int> FaceOfCell;
  std::vector<double> PowerIn; ///< W that radiance 1 brings through each cell
  std::vector<double> MeanIn;  ///< the same in the mean over its face
};
}
