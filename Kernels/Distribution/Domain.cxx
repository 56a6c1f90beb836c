#include "Distribution/Domain.h"

#include <utility>

namespace tyndall
{
Domain::Domain(const Grid& grid)
  : Ranks(std::make_shared<SingleRank>())
  , Blocks(BlockPartition::Even(grid, 1))
{
}

Domain::Domain(Communicator& communicator, BlockPartition partition)
  : Ranks(&communicator, [](Communicator*) {})
  , Blocks(std::move(partition))
{
}

Domain Domain::WithGrid(const Grid& whole) const
{
  Domain other = *this;
  other.Blocks.whole.origin = whole.origin;
  other.Blocks.whole.spacing = whole.spacing;
  return other;
}

Domain Domain::WithBlocks(BlockPartition partition) const
{
  Domain other = *this;
  other.Blocks = std::move(partition);
  return other;
}

double Domain::Sum(double own) const
{
  return this->Ranks->Sum({ own })[0];
}

Rgb Domain::Sum(const Rgb& own) const
{
  const std::vector<double> sums = this->Ranks->Sum({ own[0], own[1], own[2] });
  return { sums[0], sums[1], sums[2] };
}

double Domain::Max(double own) const
{
  return this->Ranks->Largest({ own })[0];
}

bool Domain::Any(bool own) const
{
  return OnAnyRank(*this->Ranks, own);
}

}
