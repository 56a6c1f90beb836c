#include "Ranks/PieceLayout.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tyndall
{
void ValueBox::Add(const ValueBox& other)
{
  if (this->IsEmpty())
  {
    *this = other;
    return;
  }
  for (int axis = 0; axis < 3 && !other.IsEmpty(); ++axis)
  {
    this->low[axis] = std::min(this->low[axis], other.low[axis]);
    this->high[axis] = std::max(this->high[axis], other.high[axis]);
  }
}

ValueBox PointBoxOf(const std::array<int, 6>& extent)
{
  return { { extent[0], extent[2], extent[4] }, { extent[1], extent[3], extent[5] } };
}

ValueBox CellBoxOf(const std::array<int, 6>& extent)
{
  ValueBox box = PointBoxOf(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    box.high[axis] = box.high[axis] > box.low[axis] ? box.high[axis] - 1 : box.high[axis];
  }
  return box;
}

PieceLayout::PieceLayout(
  const ValueBox& whole, std::vector<Piece> pieces, unsigned char duplicate, unsigned char hidden)
  : Whole(whole)
  , AllPieces(std::move(pieces))
  , Duplicate(duplicate)
  , HiddenFlag(hidden)
  , Owners(whole.Count(), Nobody)
{
  const int count = static_cast<int>(this->AllPieces.size());
  const auto take = [&](auto may) {
    for (int piece = 0; piece < count; ++piece)
    {
      this->ForValues(piece, [&](std::size_t value, std::size_t at) {
        if (this->Owners[at] == Nobody && may(this->FlagsOf(piece, value)))
        {
          this->Owners[at] = piece;
        }
      });
    }
  };
  take([&](unsigned char flags) { return (flags & (duplicate | hidden)) == 0; });
  take([&](unsigned char flags) { return (flags & duplicate) == 0; });
  take([](unsigned char) { return true; });
}

std::size_t PieceLayout::FirstGap() const
{
  return static_cast<std::size_t>(std::find(this->Owners.begin(), this->Owners.end(), Nobody) - this->Owners.begin());
}

std::vector<unsigned char> PieceLayout::Flags() const
{
  std::vector<unsigned char> flags(this->Owners.size(), 0);
  for (int piece = 0; piece < static_cast<int>(this->AllPieces.size()); ++piece)
  {
    this->ForValues(piece, [&](std::size_t value, std::size_t at) {
      flags[at] = this->Owners[at] == piece ? this->FlagsOf(piece, value) : flags[at];
    });
  }
  return flags;
}

void PieceLayout::Paste(int piece, const char* values, std::size_t size, char* whole) const
{
  this->ForValues(piece, [&](std::size_t value, std::size_t at) {
    if (this->Owners[at] == piece)
    {
      std::memcpy(whole + at * size, values + value * size, size);
    }
  });
}
}
