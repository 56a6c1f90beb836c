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
/// face, times the albedo of the face (Illumination::faceAlbedo), comes back through the same cell as radiance that is
/// the same in all directions. Power is conserved for every quadrature.
///
/// The rays of a sweep do not cross all cells evenly. The radiance that comes back through a cell is therefore the
/// reflected power divided by the power that radiance 1 carries into the same cell, so that uniform light stays
/// uniform. Light that leaves along other rays (lamps) does not have that uneven pattern: its reflected power is
/// divided by the mean over the face.
class FaceReflection
{
public:
  /// @param grid  voxels of the box
  /// @param channels  1 or 3
  /// @param powerIn  by cell: W that radiance 1 carries into the box along the rays of a sweep
  /// @param albedo  by face
  FaceReflection(const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  /// Replaces powerIn, for rays that cross the cells elsewhere.
  void SetPowerIn(std::vector<double> powerIn);

  const Grid& Box() const { return this->TheGrid; }
  bool Reflects() const { return this->AnyAlbedo; }
  const std::array<Rgb, 6>& Albedo() const { return this->AlbedoOfFaces; }
  std::size_t Cells() const { return this->FaceOfCell.size(); }
  int Channels() const { return this->ChannelCount; }
  int FaceOf(std::size_t cell) const { return this->FaceOfCell[cell]; }
  /// Albedo at index i of an array [channel][cell].
  double AlbedoOf(std::size_t i) const
  {
    return this->AlbedoOfFaces[this->FaceOf(i % this->Cells())][i / this->Cells()];
  }

  /// Incident radiance that carries the given powers into the box, [channel][cell].
  /// @param swept  W that left along the rays of sweeps, [channel][cell]
  /// @param uncollided  W that left along other rays, likewise
  std::vector<float> RadianceOf(const std::vector<double>& swept, const std::vector<double>& uncollided) const;

  /// Sums of an array [channel][cell] over the cells of each face.
  std::array<Rgb, 6> PowerOfFaces(const std::vector<double>& power) const;
  /// Power that radiance 1 carries through a cell along the rays of sweeps, over the mean of its face.
  double Pattern(std::size_t cell) const;
  /// `power` scaled by face and channel such that each face has the total power that it has in `sums`, [channel][cell].
  std::vector<double> ScaledTo(std::vector<double> power, const std::vector<double>& sums) const;
  std::vector<double> ScaledTo(std::vector<double> power, const std::array<Rgb, 6>& shouldBe) const; ///< W, by face
  /// Converts W, [channel][cell], to W / length^2, [cell][channel] (the layout of LightField::facePower).
  std::vector<float> PerArea(const std::vector<double>& power) const;

private:
  Grid TheGrid;
  int ChannelCount;
  std::array<Rgb, 6> AlbedoOfFaces;
  bool AnyAlbedo;
  std::vector<int> FaceOfCell;
  std::vector<double> PowerIn; ///< by cell: W that radiance 1 carries into the box
  std::vector<double> MeanIn;  ///< by cell: mean of PowerIn over the face
};

/// Outgoing power and reflected radiance by cell of the box faces, on the device.
class FaceLight : public FaceReflection
{
public:
  /// @param powerIn  by cell: W that radiance 1 carries into the box along the directions of sweeps
  FaceLight(
    Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  const Buffer<float>& Out() const { return this->Leaving; } ///< for Deposit::faceOut
  const Buffer<float>& In() const { return this->Entering; } ///< for SweepRequest::faceIn

  /// Takes the power that left since the last call as uncollided light, which did not leave along the rays of sweeps.
  void TakeUncollided() { this->Uncollided = this->TakeOut(); }
  /// Reflects the power that left since the last call, together with the uncollided light taken before: In() becomes
  /// the reflected radiance.
  /// @return reflected power by face, W
  std::array<Rgb, 6> Reflect();
  /// Sum over cells of the magnitude of the power that the last Reflect() let in, W. Power by cell may be negative
  /// after a warm start.
  const Rgb& Magnitude() const { return this->LastMagnitude; }
  /// Power that left through each cell since the last call of any method here, W, [channel][cell].
  std::vector<float> TakeOut();
  /// Sets In() such that these powers enter through each cell, W, [channel][cell].
  void LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided);

  /// Power that left through each cell, summed over all calls of Reflect, W, [channel][cell]. The uneven pattern of the
  /// rays is removed from the swept part; sums over faces are unchanged.
  std::vector<double> LeftInAll() const;

private:
  std::vector<float> Uncollided;
  std::vector<double> AllSwept, AllUncollided;
  Rgb LastMagnitude = {};
  Buffer<float> Leaving, Entering; ///< [channel][cell]
};

/// By cell: W that radiance 1 carries into the box along the rays of sweeps. The rays cross some planes of voxels more
/// often than others.
/// @param spreads  each ray spreads its power over all cells that it represents (Deposit::spreadsAside)
std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads);
}
