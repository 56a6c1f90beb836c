#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Lambertian reflection by the faces of the box (numerics.md, section 7.12). The power that leaves through a cell of a
/// face, times the albedo of the face (Illumination::faceAlbedo), is incident through the same cell in the next sweep,
/// as isotropic radiance. Power is conserved for every quadrature.
///
/// The rays of a sweep do not cross all cells equally often. The reflected radiance of a cell is therefore the
/// reflected power divided by the power that radiance 1 carries into this cell along those rays, so that uniform light
/// stays uniform. Uncollided light of lamps leaves along other rays, without that pattern. Its reflected power is
/// therefore divided by the mean, over the face, of the power that radiance 1 carries into a cell.
class FaceReflection
{
public:
  /// @param grid  voxels of the box
  /// @param channels  1 or 3
  /// @param powerIn  by cell of the box faces: power, W, that radiance 1 carries into the box along the rays of a sweep
  /// @param albedo  by face (-x, +x, ... +z) and channel, 0 to 1
  FaceReflection(const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  /// Replaces the constructor's `powerIn`, for another quadrature or other starting points of rays.
  void SetPowerIn(std::vector<double> powerIn);

  const Grid& Box() const { return this->TheGrid; }
  bool Reflects() const { return this->AnyAlbedo; }
  const std::array<Rgb, 6>& Albedo() const { return this->AlbedoOfFaces; }
  std::size_t Cells() const { return this->FaceOfCell.size(); }
  int Channels() const { return this->ChannelCount; }
  int FaceOf(std::size_t cell) const { return this->FaceOfCell[cell]; }
  /// Albedo that applies to element i of an array [channel][cell].
  double AlbedoOf(std::size_t i) const
  {
    return this->AlbedoOfFaces[this->FaceOf(i % this->Cells())][i / this->Cells()];
  }

  /// Incident radiance, W / (length^2 sr), that carries the given powers into the box, [channel][cell].
  /// @param swept  reflected power of light that left along the rays of sweeps, W, [channel][cell]
  /// @param uncollided  reflected power of light that left along other rays, W, [channel][cell]
  std::vector<float> RadianceOf(const std::vector<double>& swept, const std::vector<double>& uncollided) const;

  /// Sums of an array [channel][cell] over the cells of each face.
  std::array<Rgb, 6> PowerOfFaces(const std::vector<double>& power) const;
  /// Power that radiance 1 carries through a cell along the rays of sweeps, divided by the mean of this power over the
  /// cells of the face.
  double Pattern(std::size_t cell) const;
  /// `power` scaled by one factor per face and channel, such that the total over each face equals that of `sums`. Both
  /// arrays are [channel][cell], W.
  std::vector<double> ScaledTo(std::vector<double> power, const std::vector<double>& sums) const;
  /// `power`, W, [channel][cell], scaled by one factor per face and channel, such that the total over each face is
  /// `shouldBe`, W.
  std::vector<double> ScaledTo(std::vector<double> power, const std::array<Rgb, 6>& shouldBe) const;
  /// Converts W, [channel][cell], to W / length^2, [cell][channel] (the layout of LightField::facePower).
  std::vector<float> PerArea(const std::vector<double>& power) const;

private:
  Grid TheGrid;
  int ChannelCount;
  std::array<Rgb, 6> AlbedoOfFaces;
  bool AnyAlbedo;
  std::vector<int> FaceOfCell;
  std::vector<double> PowerIn; ///< by cell: power that radiance 1 carries into the box, W
  std::vector<double> MeanIn;  ///< by cell: mean of PowerIn over the cell's face
};

/// Outgoing power and reflected radiance by cell of the box faces, in device arrays that sweeps add to and read.
class FaceLight : public FaceReflection
{
public:
  /// @param powerIn  by cell: power that radiance 1 carries into the box along the rays of sweeps, W
  FaceLight(
    Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  /// Outgoing power of sweeps, W, [channel][cell]; sweeps add to it (Deposit::faceOut).
  const Buffer<float>& Out() const { return this->Leaving; }
  /// Reflected radiance, W / (length^2 sr), [channel][cell], incident in the next sweep (SweepRequest::faceIn).
  const Buffer<float>& In() const { return this->Entering; }

  /// Counts the power in Out() as uncollided light, which did not leave along the rays of sweeps, and clears Out().
  void TakeUncollided() { this->Uncollided = this->TakeOut(); }
  /// Reflects the power in Out() and the power moved by TakeUncollided(): sets In() to the reflected radiance, and
  /// clears Out().
  /// @return reflected power by face, W
  std::array<Rgb, 6> Reflect();
  /// Sum over cells of the absolute value of the power that the last Reflect() reflected, W by channel. The power of a
  /// cell may be negative after a warm start.
  const Rgb& Magnitude() const { return this->LastMagnitude; }
  /// Returns the power in Out(), W, [channel][cell], and clears it.
  std::vector<float> TakeOut();
  /// Sets In() to the radiance that carries the given powers into the box, W, [channel][cell]
  /// (FaceReflection::RadianceOf).
  void LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided);

  /// Outgoing power by cell, summed over all calls of Reflect(), W, [channel][cell]. The uneven pattern of the rays is
  /// removed from the light of sweeps; sums over faces are unchanged.
  std::vector<double> LeftInAll() const;

private:
  std::vector<float> Uncollided;
  std::vector<double> AllSwept, AllUncollided;
  Rgb LastMagnitude = {};
  /// Outgoing power of sweeps, W, and reflected radiance, W / (length^2 sr), [channel][cell].
  Buffer<float> Leaving, Entering;
};

/// Power that radiance 1 carries into the box through each cell of its faces along the rays of sweeps, W by cell. It
/// varies between cells, because the rays leave sideways through some planes of voxels more often than through others.
/// @param spreads  whether each ray spreads its power over all cells that it represents (Deposit::spreadsAside)
std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads);
}
