#pragma once

#include "LightPropagation/FaceReflection.h"
#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Published/PublishedModel.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace tyndall
{
/// The cells of the box's faces as the published algorithms meet them: what leaves through them in an order, and what
/// of it comes back in the next (numerics.md, section 3, Eq. (14a)).
///
/// A ray that marches through the planes of its map and crosses a side leaves through a cell of the plane that it goes
/// on in, of the row it was in; and comes in through one of that plane, of the row it goes on in. So the mirror image
/// of a ray that leaves comes in through the same cell, also where it crosses on the border of two planes, and even
/// light stays even.
class PublishedFaces
{
public:
  /// @param model  must stay
  PublishedFaces(const Grid& grid, const PublishedModel& model, const PropagationSettings& settings);

  /// Whether cells are counted: a face gives back light, or the settings ask for the power through them.
  bool Count() const { return this->Reflection.has_value(); }
  std::size_t Cells() const { return this->Reflection->Cells(); }
  /// Of a voxel at the face.
  std::size_t Cell(int face, const std::array<int, 3>& voxel) const;

  void Leave(std::size_t cell, int channel, double power) { this->Out[channel * this->Cells() + cell] += power; }
  /// What has left in this order, [channel][cell], for sums over ranks.
  std::vector<double>& PowersLeft() { return this->Out; }
  /// What comes back in this order, [channel][cell]. W / (length^2 sr)
  const std::vector<float>& Radiance() const { return this->Back; }
  float Radiance(std::size_t cell, int channel) const { return this->Back[channel * this->Cells() + cell]; }

  /// What left in the order that ends comes back in the next, which the ledger is told.
  void CloseOrder(OrderLedger& ledger);
  /// W by cell, guessed to leave in all later orders (WarmStart): added to what leaves in the first, taken from what
  /// leaves in the second. Empty: no guess.
  void BeginWarm(std::vector<float> guess) { this->Guess = std::move(guess); }
  std::vector<float> LeftLater() const;  ///< what such a guess guesses; empty where cells are not counted
  void WriteTo(LightField& field) const; ///< facePower, faceAlbedo

private:
  std::vector<double> PowerIn(int order) const;
  double Guessed(std::size_t i, int order) const;

  Grid TheGrid;
  const PublishedModel& Model;
  PropagationSettings Settings;
  std::optional<FaceReflection> Reflection;
  std::vector<double> Out, All, Even; ///< of this order, of all, of all without the pattern of rays; [channel][cell]
  std::vector<double> First;          ///< of the first order
  std::vector<float> Back, Guess;
};
}
