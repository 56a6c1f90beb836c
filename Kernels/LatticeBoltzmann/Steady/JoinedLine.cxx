#include "LatticeBoltzmann/Steady/JoinedLine.h"

#include <cstddef>

namespace tyndall
{
namespace
{
/// A linear function of the light that wraps around a closed line, `round`, and of the light sent from ahead.
struct Linear
{
  double own = 0.0, ofRound = 0.0, ofAhead = 0.0;

  double At(double round, double ahead) const { return this->own + this->ofRound * round + this->ofAhead * ahead; }
};

/// a + factor b
Linear Plus(const Linear& a, double factor, const Linear& b)
{
  return { a.own + factor * b.own, a.ofRound + factor * b.ofRound, a.ofAhead + factor * b.ofAhead };
}

double Inverse(double rest)
{
  return rest > 0.0 ? 1.0 / rest : 0.0;
}

/// The pieces joined so far: light that the last one sends up and the first one sends down, as functions of the light
/// sent down to the last piece.
struct WayUp
{
  WayUp(const PieceOfLine& piece, const SentByPiece& sent, bool closed)
    : sends{ sent.up, closed ? piece.passes : 0.0, piece.returns }
    , cut{ sent.down, closed ? piece.givesBack : 0.0, piece.comesDown }
  {
  }

  /// @return light sent up into the next piece, as a function of the light sent down to that piece's last voxel
  Linear Add(const PieceOfLine& piece, const SentByPiece& sent)
  {
    // The last piece so far receives `down` times the light that the next piece sends down, plus what the link
    // reflects.
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

/// Light sent up the cut of a closed line, and down to it.
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
