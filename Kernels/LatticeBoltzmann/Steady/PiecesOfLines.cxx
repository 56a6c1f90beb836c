#include "LatticeBoltzmann/Steady/PiecesOfLines.h"

#include "LatticeBoltzmann/LatticeShared.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tyndall
{
std::array<std::size_t, 2> LinesOfPair(const std::array<int, 3>& size, int pair)
{
  std::vector<std::size_t> moving, still;
  for (int axis = 0; axis < 3; ++axis)
  {
    (LatticeWays[2 * pair][axis] != 0 ? moving : still).push_back(static_cast<std::size_t>(size[axis]));
  }
  return moving.size() == 1 ? std::array<std::size_t, 2>{ still[0], still[1] }
                            : std::array<std::size_t, 2>{ moving[0] + moving[1], still[0] };
}

PiecesOfLines::PiecesOfLines(const BlockPartition& partition, const std::array<bool, 3>& periodic, int pair)
  : Partition(partition)
  , Periodic(periodic)
  , Pair(pair)
  , Way({ LatticeWays[2 * pair][0], LatticeWays[2 * pair][1], LatticeWays[2 * pair][2] })
{
  for (int axis = 0; axis < 3; ++axis)
  {
    (this->Way[axis] != 0 ? this->Moving : this->Still).push_back(axis);
  }
}

std::array<std::size_t, 2> PiecesOfLines::Range(int rank) const
{
  return LinesOfPair(this->Partition.blocks[rank].size, this->Pair);
}

int PiecesOfLines::RankAt(const Voxel& voxel) const
{
  const std::vector<VoxelBox>& blocks = this->Partition.blocks;
  const auto holds = [&](const VoxelBox& block) { return Holds(block, voxel.data()); };
  return static_cast<int>(std::find_if(blocks.begin(), blocks.end(), holds) - blocks.begin());
}

/// The piece of a line in a rank's block that begins with the voxel `first`.
/// @param first  indices of the voxel in the whole grid
PiecesOfLines::Piece PiecesOfLines::PieceAt(int rank, const Voxel& first) const
{
  const VoxelBox& block = this->Partition.blocks[rank];
  const std::size_t range = this->Range(rank)[0];
  const auto at = [&](int axis) { return static_cast<std::size_t>(first[axis] - block.first[axis]); };
  if (this->Moving.size() == 1)
  {
    return { rank, at(this->Still[1]) * range + at(this->Still[0]) };
  }
  const int a = this->Moving[0], b = this->Moving[1];
  const std::size_t size = static_cast<std::size_t>(block.size[a]);
  return { rank, at(this->Still[0]) * range + (first[b] == this->Entry(block, b) ? at(a) : size + at(b)) };
}

/// Moves from the first voxel of a piece of a line to that of the line's next piece.
/// @return whether there is a next piece
bool PiecesOfLines::MoveOn(int rank, Voxel& voxel) const
{
  const VoxelBox& block = this->Partition.blocks[rank];
  int ways = std::numeric_limits<int>::max();
  for (const int axis : this->Moving)
  {
    ways = std::min(ways, this->Way[axis] > 0 ? EndOf(block, axis) - voxel[axis] : voxel[axis] - block.first[axis] + 1);
  }
  for (const int axis : this->Moving)
  {
    const int size = this->Partition.whole.size[axis];
    voxel[axis] += ways * this->Way[axis];
    if (voxel[axis] < 0 || voxel[axis] >= size)
    {
      if (!this->Periodic[axis])
      {
        return false;
      }
      voxel[axis] = (voxel[axis] + size) % size;
    }
  }
  return true;
}

PiecesOfLines::Line PiecesOfLines::Follow(const Voxel& first, bool closed) const
{
  Line line = { {}, closed };
  Voxel voxel = first;
  bool goesOn = true;
  for (int rank = this->RankAt(voxel); goesOn; rank = goesOn ? this->RankAt(voxel) : rank)
  {
    line.pieces.push_back(this->PieceAt(rank, voxel));
    goesOn = this->MoveOn(rank, voxel) && voxel != first;
  }
  return line;
}

bool PiecesOfLines::Closes() const
{
  return std::all_of(this->Moving.begin(), this->Moving.end(), [&](int axis) { return this->Periodic[axis]; });
}

/// First voxels of the lines through a box, in the order of begin_line() (LatticeLines.cl). Closed lines begin in a
/// plane that all of them cross.
std::vector<PiecesOfLines::Voxel> PiecesOfLines::FirstVoxels(
  const VoxelBox& box, const std::array<bool, 3>& periodic) const
{
  const int a = this->Moving.front(), b = this->Moving.back();
  std::vector<Voxel> found;
  // Adds voxels of the plane through which lines enter the box along `axis`: those for which begins(voxel) is true.
  const auto addFrom = [&](int axis, const auto& begins) {
    VoxelBox plane = box;
    plane.first[axis] = this->Entry(box, axis);
    plane.size[axis] = 1;
    Grid grid;
    grid.size = plane.size;
    for (std::size_t i = 0; i < plane.VoxelCount(); ++i)
    {
      Voxel voxel = grid.VoxelAt(i);
      std::transform(voxel.begin(), voxel.end(), plane.first.begin(), voxel.begin(), std::plus<int>());
      if (begins(voxel))
      {
        found.push_back(voxel);
      }
    }
  };
  if (a == b)
  {
    addFrom(a, [](const Voxel&) { return true; });
    return found;
  }
  const int period = periodic[a] && periodic[b] ? std::gcd(box.size[a], box.size[b]) : 0;
  addFrom(b, [&](const Voxel& voxel) { return !periodic[b] || voxel[a] - box.first[a] < period; });
  addFrom(a, [&](const Voxel& voxel) { return !periodic[a] && (periodic[b] || voxel[b] != this->Entry(box, b)); });
  return found;
}

void PiecesOfLines::ForLines(const std::function<void(int rank, const Line& line)>& visit) const
{
  const VoxelBox whole = { { 0, 0, 0 }, this->Partition.whole.size };
  for (const Voxel& first : this->FirstVoxels(whole, this->Periodic))
  {
    const Line line = this->Follow(first, this->Closes());
    if (line.closed || line.pieces.size() > 1)
    {
      visit(line.pieces.front().rank, line);
    }
  }
}

namespace
{
/// Linear function of two unknowns: the light `round` that wraps around a closed line, and the light `ahead` that is
/// sent down from the next piece.
struct Linear
{
  double own = 0.0, ofRound = 0.0, ofAhead = 0.0;

  double At(double round, double ahead) const { return this->own + this->ofRound * round + this->ofAhead * ahead; }
};

/// Returns a + factor b.
Linear Plus(const Linear& a, double factor, const Linear& b)
{
  return { a.own + factor * b.own, a.ofRound + factor * b.ofRound, a.ofAhead + factor * b.ofAhead };
}

double Inverse(double rest)
{
  return rest > 0.0 ? 1.0 / rest : 0.0;
}

/// Response of the pieces of a line that have been joined so far. sends: light that the last piece sends up; cut: light
/// that the first piece sends down. Both are linear functions of the light sent down to the last piece and, for a
/// closed line, of the light that wraps around it.
struct WayUp
{
  WayUp(const PieceOfLine& piece, const SentByPiece& sent, bool closed)
    : sends{ sent.up, closed ? piece.passes : 0.0, piece.returns }
    , cut{ sent.down, closed ? piece.givesBack : 0.0, piece.comesDown }
  {
  }

  /// Joins the next piece of the line. @return light sent up into `piece`, as a function of the light sent down to its
  /// last voxel
  Linear Add(const PieceOfLine& piece, const SentByPiece& sent)
  {
    // Fraction of the light sent up by the last joined piece that returns to it: light that the link transmits into
    // `piece` and `piece` sends back, plus light that the link reflects.
    const double again = piece.down * piece.givesBack + 1.0 - piece.up;
    const double inverse = Inverse(1.0 - this->sends.ofAhead * again);
    const Linear down = { piece.down * sent.down, 0.0, piece.down * piece.comesDown };
    const Linear goesUp =
      Plus({}, inverse, Plus({ this->sends.own, this->sends.ofRound, 0.0 }, this->sends.ofAhead, down));
    const Linear comes = Plus(down, again, goesUp);
    this->cut = Plus({ this->cut.own, this->cut.ofRound, 0.0 }, this->cut.ofAhead, comes);
    this->sends = Plus({ sent.up, 0.0, piece.returns }, piece.passes, goesUp);
    return goesUp;
  }

  Linear sends, cut;
};

/// Light of a closed line at the link between its last and its first piece.
/// @return `up`: light that the last piece sends into the link; `down`: light that arrives at the last piece from the
///   link
SentByPiece RoundOf(const WayUp& way, const PieceOfLine& first)
{
  const double inverse = Inverse(1.0 - first.down * way.cut.ofAhead);
  const double down = first.down * way.cut.own * inverse;
  const double ofRound = (first.down * way.cut.ofRound + 1.0 - first.up) * inverse;
  const double rest = 1.0 - way.sends.ofRound - way.sends.ofAhead * ofRound;
  const double round = (way.sends.own + way.sends.ofAhead * down) * Inverse(rest);
  return { round, down + ofRound * round };
}
}

std::vector<ComesToPiece> JoinLine(
  const std::vector<PieceOfLine>& pieces, const std::vector<SentByPiece>& sent, bool closed)
{
  const std::size_t count = pieces.size();
  WayUp way(pieces.front(), sent.front(), closed);
  std::vector<Linear> goesUp = { { 0.0, closed ? 1.0 : 0.0, 0.0 } };
  for (std::size_t k = 1; k < count; ++k)
  {
    goesUp.push_back(way.Add(pieces[k], sent[k]));
  }
  const SentByPiece ends = closed ? RoundOf(way, pieces.front()) : SentByPiece();
  std::vector<ComesToPiece> comes(count);
  double down = ends.down, beyond = 0.0;
  for (std::size_t k = count; k-- > 0;)
  {
    const PieceOfLine& piece = pieces[k];
    comes[k] = { goesUp[k].At(ends.up, down), down, beyond };
    beyond = sent[k].down + piece.givesBack * comes[k].up + piece.comesDown * down;
    down = piece.down * beyond + (1.0 - piece.up) * comes[k].up;
  }
  comes.back().sentBeyond = beyond; // the first piece follows the last piece of a closed line
  return comes;
}
}
