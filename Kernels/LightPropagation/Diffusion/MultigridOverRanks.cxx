#include "LightPropagation/Diffusion/MultigridOverRanks.h"

#include "Device/HostThreads.h"
#include "LightPropagation/Diffusion/ConjugateGradients.h"
#include "LightPropagation/Diffusion/MultigridCycle.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// The coarse cells whose first fine cell is in the box (owned), or that contain any cell of it (touched).
VoxelBox Joined(const VoxelBox& box, const std::array<int, 3>& halved, bool owned)
{
  VoxelBox joined = box;
  for (int axis = 0; axis < 3 && box.VoxelCount() > 0; ++axis)
  {
    if (halved[axis])
    {
      const int end = (EndOf(box, axis) + 1) / 2;
      joined.first[axis] = (box.first[axis] + (owned ? 1 : 0)) / 2;
      joined.size[axis] = end - joined.first[axis];
    }
  }
  return joined;
}

/// The coarse cells that contain finer cells of this rank but belong to others: they lie below its own, if it has any.
std::vector<VoxelBox> TouchedOfOthers(const VoxelBox& own, const VoxelBox& touched)
{
  if (own.VoxelCount() == 0)
  {
    return { touched };
  }
  std::vector<VoxelBox> boxes;
  for (int below = 1; below < 8; ++below) // bit mask of the axes along which they lie below
  {
    VoxelBox box = own;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (below >> axis & 1)
      {
        box.first[axis] = touched.first[axis];
        box.size[axis] = own.first[axis] - touched.first[axis];
      }
    }
    if (box.VoxelCount() > 0)
    {
      boxes.push_back(box);
    }
  }
  return boxes;
}

std::size_t CellsOf(const std::array<int, 3>& size)
{
  return VoxelBox{ {}, size }.VoxelCount();
}
}

/// A row of a level's own cells, and the offsets of its neighbours; along x those of its first and last cell. An offset
/// is 0 at the grid's end, where the conductance is 0.
struct MultigridOverRanks::Row
{
  std::size_t first;
  int count;
  std::ptrdiff_t lowX, highX, lowY, highY, lowZ, highZ;
};

MultigridOverRanks::MultigridOverRanks(Communicator& communicator, const BlockPartition& partition,
  const std::array<bool, 3>& periodic, std::size_t gatherAtMost)
  : Comm(communicator)
  , Periodic(periodic)
{
  std::vector<MultigridLevel> layouts = MultigridLevels(partition.whole.size, partition.whole.spacing);
  if (layouts.size() == 1)
  {
    std::fill_n(layouts[0].halved, 3, 0); // adds a level of the same cells, all on one rank
    layouts.push_back(layouts[0]);
  }
  std::vector<VoxelBox> own = partition.blocks, touched = own;
  for (std::size_t l = 0; l < layouts.size(); ++l)
  {
    const MultigridLevel& layout = layouts[l];
    const std::array<int, 3> size = { layout.size[0], layout.size[1], layout.size[2] };
    const std::array<int, 3> halved = { layout.halved[0], layout.halved[1], layout.halved[2] };
    if (l > 0 && (CellsOf(size) <= gatherAtMost || l + 1 == layouts.size()))
    {
      own.assign(own.size(), VoxelBox());
      own[0] = { {}, size };
    }
    this->AddLevel(size, halved, own, touched);
    for (std::size_t rank = 0; rank < own.size(); ++rank)
    {
      touched[rank] = Joined(own[rank], halved, false);
      own[rank] = Joined(own[rank], halved, true);
    }
  }
  const std::size_t finest = this->Held().VoxelCount();
  this->Direction.assign(finest, 0.0);
  this->Applied.assign(finest, 0.0);
}

void MultigridOverRanks::AddLevel(const std::array<int, 3>& size, const std::array<int, 3>& halved,
  std::vector<VoxelBox> own, const std::vector<VoxelBox>& touched)
{
  std::vector<std::vector<VoxelBox>> beside, ofOthers;
  for (std::size_t rank = 0; rank < own.size(); ++rank)
  {
    beside.push_back(LayersBeside(own[rank], size, this->Periodic));
    ofOthers.push_back(TouchedOfOthers(own[rank], touched[rank]));
  }
  const auto self = static_cast<std::size_t>(this->Comm.Rank());
  Level level;
  level.size = size;
  level.halved = halved;
  level.own = own[self];
  level.periodic = this->Periodic;
  level.alone = GoesRoundAlone(own[self], size, this->Periodic);
  level.held = Hull(Hull(own[self], beside[self]), ofOthers[self]);
  level.beside = std::make_unique<GhostCells>(this->Comm, own, beside, level.held, size);
  level.shared = std::make_unique<GhostCells>(this->Comm, own, ofOthers, level.held);
  const std::size_t count = level.held.VoxelCount();
  for (std::vector<double>& ofAxis : level.conductance)
  {
    ofAxis.assign(count, 0.0);
  }
  for (std::vector<double>* array : { &level.loss, &level.inverse, &level.right, &level.guess, &level.better })
  {
    array->assign(count, 0.0);
  }
  this->Levels.push_back(std::move(level));
}

MultigridOverRanks::Row MultigridOverRanks::RowOf(const Level& level, int y, int z)
{
  const VoxelBox& own = level.own;
  Row row;
  row.first = (z - level.held.first[2]) * level.Stride(2) + (y - level.held.first[1]) * level.Stride(1) +
    (own.first[0] - level.held.first[0]);
  row.count = own.size[0];
  const auto step = [&](int axis, int from, int by) {
    const auto stride = static_cast<std::ptrdiff_t>(level.Stride(axis));
    const int size = level.size[axis], to = from + by;
    const bool inside = to >= 0 && to < size;
    return inside || (level.periodic[axis] && !level.alone[axis]) ? by * stride
      : level.alone[axis]                                         ? by * (1 - size) * stride
                                                                  : 0;
  };
  row.lowX = step(0, own.first[0], -1);
  row.highX = step(0, EndOf(own, 0) - 1, 1);
  row.lowY = step(1, y, -1);
  row.highY = step(1, y, 1);
  row.lowZ = step(2, z, -1);
  row.highZ = step(2, z, 1);
  return row;
}

/// Calls act(row) for the rows of own cells, on all cores.
template <class Act>
void MultigridOverRanks::ForRows(const Level& level, const Act& act)
{
  SumOverRows(level, [&](const Row& row) {
    act(row);
    return 0.0;
  });
}

template <class Term>
double MultigridOverRanks::SumOverRows(const Level& level, const Term& term)
{
  const VoxelBox& own = level.own;
  if (own.VoxelCount() == 0)
  {
    return 0.0;
  }
  const std::size_t rows = static_cast<std::size_t>(own.size[1]) * own.size[2];
  const std::size_t together = std::max<std::size_t>(1, 16384 / own.size[0]);
  return SumInThreads(rows, together, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t r = begin; r < end; ++r)
    {
      const int y = static_cast<int>(r % own.size[1]), z = static_cast<int>(r / own.size[1]);
      sum += term(RowOf(level, own.first[1] + y, own.first[2] + z));
    }
    return sum;
  });
}

/// (A x) of a cell.
double MultigridOverRanks::Apply(const Level& level, const std::vector<double>& values, const Row& row, int x)
{
  const std::size_t i = row.first + x;
  const std::ptrdiff_t lowX = x == 0 ? row.lowX : -1, highX = x + 1 == row.count ? row.highX : 1;
  const double own = values[i];
  const auto& [alongX, alongY, alongZ] = level.conductance;
  double sum = level.loss[i] * own;
  sum += alongX[i] * (own - values[i + lowX]) + alongX[i + highX] * (own - values[i + highX]);
  sum += alongY[i] * (own - values[i + row.lowY]) + alongY[i + row.highY] * (own - values[i + row.highY]);
  sum += alongZ[i] * (own - values[i + row.lowZ]) + alongZ[i + row.highZ] * (own - values[i + row.highZ]);
  return sum;
}

double MultigridOverRanks::Diagonal(const Level& level, const Row& row, int x)
{
  const std::size_t i = row.first + x;
  const auto& [alongX, alongY, alongZ] = level.conductance;
  double sum = level.loss[i] + alongX[i] + alongY[i] + alongZ[i];
  const std::ptrdiff_t highX = x + 1 == row.count ? row.highX : 1;
  sum += highX != 0 ? alongX[i + highX] : 0.0;
  sum += row.highY != 0 ? alongY[i + row.highY] : 0.0;
  sum += row.highZ != 0 ? alongZ[i + row.highZ] : 0.0;
  return sum;
}

/// Calls act(cell, its coarse cell, whether it is the first of that along each axis) for own cells, in order.
template <class Act>
void MultigridOverRanks::ForParents(const Level& fine, const Level& coarse, const Act& act)
{
  const VoxelBox& own = fine.own;
  const auto of = [&](int axis, int place) { return place >> fine.halved[axis]; };
  const auto first = [&](int axis, int place) { return !fine.halved[axis] || place % 2 == 0; };
  for (int z = own.first[2]; z < EndOf(own, 2); ++z)
  {
    for (int y = own.first[1]; y < EndOf(own, 1); ++y)
    {
      const Row row = RowOf(fine, y, z);
      const std::size_t parents =
        (of(2, z) - coarse.held.first[2]) * coarse.Stride(2) + (of(1, y) - coarse.held.first[1]) * coarse.Stride(1);
      for (int x = 0; x < row.count; ++x)
      {
        const int place = own.first[0] + x;
        act(row.first + x, parents + (of(0, place) - coarse.held.first[0]),
          std::array<bool, 3>{ first(0, place), first(1, y), first(2, z) });
      }
    }
  }
}

void MultigridOverRanks::SetMatrix(const std::array<std::vector<float>, 3>& conductance, const std::vector<float>& loss)
{
  Level& finest = this->Levels.front();
  for (int axis = 0; axis < 3; ++axis)
  {
    finest.conductance[axis].assign(conductance[axis].begin(), conductance[axis].end());
  }
  finest.loss.assign(loss.begin(), loss.end());
  for (std::size_t l = 0; l < this->Levels.size(); ++l)
  {
    if (l > 0)
    {
      this->CoarsenMatrix(this->Levels[l - 1], this->Levels[l]);
    }
    this->InvertDiagonal(this->Levels[l]);
  }
}

/// As level_coarsen in MultigridSolver.cl.
void MultigridOverRanks::CoarsenMatrix(const Level& fine, Level& coarse) const
{
  ForParents(fine, coarse, [&](std::size_t i, std::size_t parent, const std::array<bool, 3>& first) {
    coarse.loss[parent] += fine.loss[i];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double part = coarse.size[axis] == 1 || !first[axis] ? 0.0 : fine.halved[axis] ? 0.5 : 1.0;
      coarse.conductance[axis][parent] += part * fine.conductance[axis][i];
    }
  });
  coarse.shared->AddToOwners(coarse.loss);
  for (std::vector<double>& ofAxis : coarse.conductance)
  {
    coarse.shared->AddToOwners(ofAxis);
    coarse.beside->Fill(ofAxis);
  }
}

void MultigridOverRanks::InvertDiagonal(Level& level) const
{
  ForRows(level, [&](const Row& row) {
    for (int x = 0; x < row.count; ++x)
    {
      const double diagonal = Diagonal(level, row, x);
      level.inverse[row.first + x] = diagonal > 0.0 ? Damping / diagonal : 0.0;
    }
  });
}

void MultigridOverRanks::Restrict(Level& fine, Level& coarse) const
{
  fine.beside->Fill(fine.guess);
  ForRows(fine, [&](const Row& row) {
    for (int x = 0; x < row.count; ++x)
    {
      fine.better[row.first + x] = fine.right[row.first + x] - Apply(fine, fine.guess, row, x);
    }
  });
  std::fill(coarse.right.begin(), coarse.right.end(), 0.0);
  ForParents(fine, coarse,
    [&](std::size_t i, std::size_t parent, const std::array<bool, 3>&) { coarse.right[parent] += fine.better[i]; });
  coarse.shared->AddToOwners(coarse.right);
  ForRows(coarse, [&](const Row& row) {
    for (std::size_t i = row.first; i < row.first + row.count; ++i)
    {
      coarse.guess[i] = coarse.inverse[i] * coarse.right[i];
    }
  });
}

void MultigridOverRanks::Correct(Level& fine, Level& coarse) const
{
  coarse.shared->Fill(coarse.better);
  ForParents(fine, coarse,
    [&](std::size_t i, std::size_t parent, const std::array<bool, 3>&) { fine.guess[i] += coarse.better[parent]; });
  fine.beside->Fill(fine.guess);
  ForRows(fine, [&](const Row& row) {
    for (int x = 0; x < row.count; ++x)
    {
      const std::size_t i = row.first + x;
      fine.better[i] = fine.guess[i] + fine.inverse[i] * (fine.right[i] - Apply(fine, fine.guess, row, x));
    }
  });
}

/// As MultigridSolver::Visit.
void MultigridOverRanks::Visit(std::size_t l)
{
  if (l + 1 == this->Levels.size())
  {
    Finish(this->Levels[l]);
    return;
  }
  this->Restrict(this->Levels[l], this->Levels[l + 1]);
  if (l + 1 <= VisitedTwice && l + 2 < this->Levels.size())
  {
    this->VisitTwice(l + 1);
  }
  else
  {
    this->Visit(l + 1);
  }
  this->Correct(this->Levels[l], this->Levels[l + 1]);
}

/// As MultigridSolver::VisitTwice.
void MultigridOverRanks::VisitTwice(std::size_t l)
{
  Level& level = this->Levels[l];
  this->Visit(l);
  level.beside->Fill(level.better);
  level.kept = level.better;
  ForRows(level, [&](const Row& row) {
    for (int x = 0; x < row.count; ++x)
    {
      const std::size_t i = row.first + x;
      level.right[i] -= PartOfVisit * Apply(level, level.kept, row, x);
      level.guess[i] = level.inverse[i] * level.right[i];
    }
  });
  this->Visit(l);
  ForRows(level, [&](const Row& row) {
    for (std::size_t i = row.first; i < row.first + row.count; ++i)
    {
      level.better[i] = PartOfVisit * (level.kept[i] + level.better[i]);
    }
  });
}

/// Solves a level of few cells, all on one rank, approximately by symmetric Gauss-Seidel iterations.
void MultigridOverRanks::Finish(Level& level)
{
  std::fill(level.better.begin(), level.better.end(), 0.0);
  const VoxelBox& own = level.own;
  const int rows = own.size[1] * own.size[2], count = own.size[0] * rows;
  for (int round = 0; round < 2 * FinishRounds; ++round)
  {
    for (int k = 0; k < count; ++k)
    {
      const int i = round % 2 ? count - 1 - k : k, x = i % own.size[0], r = i / own.size[0];
      const Row row = RowOf(level, r % own.size[1], r / own.size[1]);
      const double diagonal = Diagonal(level, row, x);
      double& value = level.better[row.first + x];
      const double change = level.right[row.first + x] - Apply(level, level.better, row, x);
      value = diagonal > 0.0 ? value + change / diagonal : 0.0;
    }
  }
}

/// Applies a multigrid cycle to the residual, which is the finest level's right-hand side.
double MultigridOverRanks::Precondition()
{
  Level& finest = this->Levels.front();
  ForRows(finest, [&](const Row& row) {
    for (std::size_t i = row.first; i < row.first + row.count; ++i)
    {
      finest.guess[i] = finest.inverse[i] * finest.right[i];
    }
  });
  this->Visit(0);
  return this->SumOfAll(SumOverRows(finest, [&](const Row& row) {
    double sum = 0.0;
    for (std::size_t i = row.first; i < row.first + row.count; ++i)
    {
      sum += finest.right[i] * finest.better[i];
    }
    return sum;
  }));
}

/// Computes the residual. @return r r, in units
double MultigridOverRanks::Begin(std::vector<double>& values, const std::vector<float>& right, double unit)
{
  Level& finest = this->Levels.front();
  finest.beside->Fill(values);
  std::fill(this->Direction.begin(), this->Direction.end(), 0.0);
  return this->SumOfAll(SumOverRows(finest, [&](const Row& row) {
    double sum = 0.0;
    for (int x = 0; x < row.count; ++x)
    {
      const std::size_t i = row.first + x;
      finest.right[i] = (right[i] - Apply(finest, values, row, x)) / unit;
      sum += finest.right[i] * finest.right[i];
    }
    return sum;
  }));
}

double MultigridOverRanks::GoAlong(std::vector<double>& values, double length, double unit)
{
  Level& finest = this->Levels.front();
  return this->SumOfAll(SumOverRows(finest, [&](const Row& row) {
    double sum = 0.0;
    for (std::size_t i = row.first; i < row.first + row.count; ++i)
    {
      finest.right[i] -= length * this->Applied[i];
      values[i] += length * unit * this->Direction[i];
      sum += finest.right[i] * finest.right[i];
    }
    return sum;
  }));
}

int MultigridOverRanks::Solve(
  std::vector<double>& values, const std::vector<float>& right, double unit, double reduction, double leftAtMost)
{
  return this->Iterate(values, this->Begin(values, right, unit), unit, reduction, leftAtMost);
}

int MultigridOverRanks::GoOn(std::vector<double>& values, double unit, double reduction, double leftAtMost)
{
  return this->Iterate(values, this->GoAlong(values, 0.0, unit), unit, reduction, leftAtMost);
}

int MultigridOverRanks::Iterate(
  std::vector<double>& values, double left, double unit, double reduction, double leftAtMost)
{
  Level& finest = this->Levels.front();
  const auto turn = [&](double part) {
    ForRows(finest, [&](const Row& row) {
      for (std::size_t i = row.first; i < row.first + row.count; ++i)
      {
        this->Direction[i] = finest.better[i] + part * this->Direction[i];
      }
    });
    finest.beside->Fill(this->Direction);
  };
  const auto curvature = [&] {
    return this->SumOfAll(SumOverRows(finest, [&](const Row& row) {
      double sum = 0.0;
      for (int x = 0; x < row.count; ++x)
      {
        const std::size_t i = row.first + x;
        this->Applied[i] = Apply(finest, this->Direction, row, x);
        sum += this->Applied[i] * this->Direction[i];
      }
      return sum;
    }));
  };
  const GradientSteps steps = { [&] { return this->Precondition(); }, turn, curvature,
    [&](double length) { return this->GoAlong(values, length, unit); } };
  const auto count = static_cast<double>(CellsOf(finest.size));
  const int iterations = SolveCg(steps, left, { reduction, leftAtMost, count }, this->FirstResidual);
  finest.beside->Fill(values);
  return iterations;
}
}
