#include "LightPropagation/Uncollided/Lamps/LampPasses.h"

#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int PassesAtMost = 9; ///< number of passes
/// Number of passes after which the remaining light of a box without faces is spread uniformly.
constexpr int EvenFrom = 3;
constexpr double LeftAtMost = 5e-5; ///< no further pass once this fraction of the power, or less, is still in flight
}

double FollowInPasses(const Grid& grid, const std::array<bool, 3>& periodic, LampShares& shares,
  const FollowPass& follow, const Monitor& monitor)
{
  Pass pass = FirstPass(grid);
  follow(pass, 1.0, OfPart(monitor, 0.0, 0.5));
  const bool endless = periodic[0] && periodic[1] && periodic[2];
  const int most = endless ? EvenFrom : PassesAtMost;
  for (int done = 1; done < most && shares.onTheWay > LeftAtMost * shares.shone; ++done)
  {
    const Monitor ofPass = OfPart(monitor, 1.0 - std::exp2(-done), 1.0 - std::exp2(-done - 1));
    const double wanted = std::exchange(shares.onTheWay, 0.0);
    pass = pass.Next();
    follow({ pass.begin, pass.end, true }, 1.0, {}); // power that the new beams have left where the pass begins
    const double found = std::exchange(shares.onTheWay, 0.0);
    if (!(found > 0.0))
    {
      shares.onTheWay = wanted;
      break;
    }
    follow(pass, wanted / found, ofPass);
  }
  return endless ? std::exchange(shares.onTheWay, 0.0) : 0.0;
}
}
