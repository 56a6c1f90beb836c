#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Numbers of cells or of points along the axes, from the lowest to the highest of each, x fastest.
struct ValueBox
{
  std::array<int, 3> low = { 0, 0, 0 };
  std::array<int, 3> high = { -1, -1, -1 };

  bool IsEmpty() const
  {
    return this->low[0] > this->high[0] || this->low[1] > this->high[1] || this->low[2] > this->high[2];
  }
  std::size_t Along(int axis) const { return static_cast<std::size_t>(this->high[axis] - this->low[axis] + 1); }
  std::size_t Count() const { return this->IsEmpty() ? 0 : this->Along(0) * this->Along(1) * this->Along(2); }
  void Add(const ValueBox& other); ///< so that the other is in it, too
};

/// The points of an extent.
ValueBox PointBoxOf(const std::array<int, 6>& extent);
/// Its cells; a flat one has one layer of them.
ValueBox CellBoxOf(const std::array<int, 6>& extent);

/// Which of an image's values come from which of its pieces, where those may overlap. A value is taken from the first
/// piece that flags it (vtkGhostType) neither as a duplicate nor as hidden, else from the first that has it hidden,
/// else from one that has a copy.
class PieceLayout
{
public:
  struct Piece
  {
    ValueBox values;
    std::vector<unsigned char> flags; ///< of each value; empty: there is none
  };

  static constexpr int Nobody = -1;

  /// @param duplicate, hidden  what flags say so
  PieceLayout(const ValueBox& whole, std::vector<Piece> pieces, unsigned char duplicate, unsigned char hidden);

  /// The first value, in the order of the whole, that no piece has; as many as values: there is none.
  std::size_t FirstGap() const;

  /// The piece that a value comes from.
  int OwnerOf(std::size_t value) const { return this->Owners[value]; }

  /// Of each value, where it comes from.
  std::vector<unsigned char> Flags() const;

  /// Copies what comes from a piece into the whole.
  /// @param size  bytes of a value
  void Paste(int piece, const char* values, std::size_t size, char* whole) const;

  /// Calls act with the number in the piece and in the whole of each value that a piece has as its own, neither
  /// duplicate nor hidden, and that comes from another.
  template <typename Do>
  void ForOverlap(int piece, const Do& act) const
  {
    this->ForValues(piece, [&](std::size_t value, std::size_t at) {
      if (this->Owners[at] != piece && !(this->FlagsOf(piece, value) & (this->Duplicate | this->HiddenFlag)))
      {
        act(value, at);
      }
    });
  }

private:
  unsigned char FlagsOf(int piece, std::size_t value) const
  {
    const std::vector<unsigned char>& flags = this->AllPieces[static_cast<std::size_t>(piece)].flags;
    return flags.empty() ? 0 : flags[value];
  }

  template <typename Do>
  void ForValues(int piece, const Do& act) const
  {
    const ValueBox& box = this->AllPieces[static_cast<std::size_t>(piece)].values;
    std::size_t value = 0;
    for (int k = box.low[2]; !box.IsEmpty() && k <= box.high[2]; ++k)
    {
      for (int j = box.low[1]; j <= box.high[1]; ++j)
      {
        std::size_t at = (static_cast<std::size_t>(k - this->Whole.low[2]) * this->Whole.Along(1) +
                           static_cast<std::size_t>(j - this->Whole.low[1])) *
            this->Whole.Along(0) +
          static_cast<std::size_t>(box.low[0] - this->Whole.low[0]);
        for (int i = box.low[0]; i <= box.high[0]; ++i)
        {
          act(value++, at++);
        }
      }
    }
  }

  ValueBox Whole;
  std::vector<Piece> AllPieces;
  unsigned char Duplicate, HiddenFlag;
  std::vector<int> Owners;
};
}
