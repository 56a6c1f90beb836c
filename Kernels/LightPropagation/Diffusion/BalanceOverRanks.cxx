#include "LightPropagation/Diffusion/BalanceOverRanks.h"

#include "Medium/BoxFaces.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// The tables of the planes that a box has.
CrossingPattern PatternOf(const CrossingPattern& whole, const VoxelBox& box, const std::array<int, 3>& size)
{
  CrossingPattern pattern;
  for (int table = 0; table < 6; ++table)
  {
    const PlaneAxes axes = AcrossAxis(table / 2);
    const int along = table % 2 ? axes.v : axes.u;
    pattern.first[table] = static_cast<int>(pattern.values.size());
    for (int k = 0; k < box.size[along]; ++k)
    {
      const int plane = (box.first[along] + k + size[along]) % size[along]; // round a periodic axis
      pattern.values.push_back(whole.values[whole.first[table] + plane]);
    }
  }
  return pattern;
}

/// One of several arrays of a level, without what lies between rows.
std::vector<float> ArrayOf(const MultigridLevel& rows, const std::vector<float>& arrays, int which)
{
  const auto begin = arrays.begin() + static_cast<std::ptrdiff_t>(which) * rows.floats;
  return OfRows(rows, { begin, begin + rows.floats });
}
}

BalanceOverRanks::BalanceOverRanks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const BlockWithGhosts& block, const DirectionSet& directions, const CrossingPattern& pattern,
  const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming, const std::array<bool, 3>& periodic,
  bool linear)
  : Comm(communicator)
  , Block(block)
  , Periodic(periodic)
  , SigmaA(arrays.sigma_a)
  , First(arrays.first)
{
  std::array<std::vector<float>, 3> conductance;
  std::vector<float> loss;
  communicator.Collective([&] {
    this->Solver = std::make_unique<MultigridOverRanks>(communicator, partition, periodic);
    this->Fluence.assign(block.WithGhosts().grid.VoxelCount(), 0.0);
    if (!block.Has())
    {
      return;
    }
    this->System = std::make_unique<DiffusionSystem>(device, block.WithGhosts().grid, block.Periodic(), directions,
      PatternOf(pattern, block.Held(), partition.whole.size), arrays, incoming, linear);
    MultigridSolver& matrix = this->System->Matrix();
    const std::vector<float> all = matrix.Conductance().Read();
    for (int axis = 0; axis < 3; ++axis)
    {
      conductance[axis] = ArrayOf(matrix.Rows(), all, axis);
    }
    loss = ArrayOf(matrix.Rows(), matrix.Loss().Read(), 0);
  });
  this->Solver->SetMatrix(conductance, loss);
}

/// As DiffusionSystem::Correct.
double BalanceOverRanks::Correct(double unit)
{
  Buffer<float> none;
  this->Comm.Collective([&] {
    if (this->System)
    {
      this->System->FindModel();
    }
  });
  this->Block.FillGhosts(this->System ? this->System->TheModel() : none);
  std::vector<float> right;
  this->Comm.Collective([&] {
    if (this->System)
    {
      this->System->Balance();
      right = ArrayOf(this->System->Matrix().Rows(), this->System->Matrix().Right().Read(), 0);
    }
  });
  const double reduction = DiffusionSystem::ReductionAfter(this->Corrections++);
  this->Solver->Solve(this->Fluence, right, unit, reduction);
  AndersonMixing::Sums sums = {};
  this->Comm.Collective([&] {
    if (this->System)
    {
      this->System->SetFound(this->Fluence);
      this->System->FindFlux();
      sums = this->System->SumsOfChange();
    }
  });
  const std::vector<double> all = this->Comm.Sum({ sums.begin(), sums.end() });
  std::copy(all.begin(), all.end(), sums.begin());
  this->Comm.Collective([&] {
    if (this->System)
    {
      this->System->MixBy(sums);
    }
  });
  return AndersonMixing::ChangeBy(sums);
}

void BalanceOverRanks::Refine(double unit)
{
  this->Solver->GoOn(this->Fluence, unit, DiffusionSystem::RefinedBy, DiffusionSystem::RefinedTo);
  this->Comm.Collective([&] {
    if (this->System)
    {
      this->System->SetFound(this->Fluence);
    }
  });
}

void BalanceOverRanks::BeginBeyond(const std::vector<double>& guessed)
{
  this->Comm.Collective([&] {
    for (std::size_t i = 0; i < this->Fluence.size(); ++i)
    {
      this->Fluence[i] += guessed[i];
    }
    if (this->System)
    {
      std::vector<double> state = this->System->State();
      std::copy(this->Fluence.begin(), this->Fluence.end(), state.begin());
      for (std::size_t i = this->Fluence.size(); i < state.size(); ++i)
      {
        state[i] += guessed[i];
      }
      this->System->Begin(state);
    }
  });
}

std::vector<double> BalanceOverRanks::OwnOf(const std::vector<double>& held) const
{
  std::vector<double> own(this->Block.Own().grid.VoxelCount());
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    own[i] = held[this->Block.PlaceOf(i)];
  }
  return own;
}

std::vector<double> BalanceOverRanks::Found() const
{
  return this->OwnOf(this->Fluence);
}

std::vector<double> BalanceOverRanks::NextFluence() const
{
  return this->System ? this->OwnOf(this->System->NextFluence().Read()) : std::vector<double>();
}

double BalanceOverRanks::Absorbed() const
{
  double own = 0.0;
  this->Comm.Collective([&] {
    if (this->System)
    {
      const Grid& grid = this->Block.Own().grid;
      const std::vector<float> sigmaA = this->SigmaA->Read();
      own = grid.VoxelVolume() * SumOverVoxels(grid, [&](std::size_t i) {
        const std::size_t at = this->Block.PlaceOf(i);
        return sigmaA[this->First + at] * this->Fluence[at];
      });
    }
  });
  return this->Comm.Sum({ own })[0];
}

std::array<double, 6> BalanceOverRanks::Outflow(double entered, const std::array<double, 6>& ofSweep)
{
  DiffusionSystem::BorderSums sums;
  this->Comm.Collective([&] {
    if (this->System)
    {
      const std::array<int, 3>& size = this->Block.WithGhosts().grid.size;
      sums = this->System->SumBorders([&](int face, int u, int v) {
        const PlaneAxes axes = AcrossAxis(face / 2);
        std::array<int, 3> voxel = {};
        voxel[axes.axis] = face % 2 ? size[axes.axis] - 1 : 0;
        voxel[axes.u] = u;
        voxel[axes.v] = v;
        return this->Block.IsOwn(voxel); // whose faces at the end of the box are the grid's
      });
    }
  });
  std::vector<double> values = { sums.transportWeight, sums.shared };
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    values.insert(values.end(), ofFaces->begin(), ofFaces->end());
  }
  values = this->Comm.Sum(values);
  sums.transportWeight = values[0];
  sums.shared = values[1];
  auto next = values.begin() + 2;
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    std::copy_n(next, 6, ofFaces->begin());
    next += 6;
  }
  return DiffusionSystem::OutflowBy(sums, entered, ofSweep, this->Periodic);
}

void BalanceOverRanks::ShapeSource()
{
  if (this->System)
  {
    this->System->ShapeSource();
  }
}

void BalanceOverRanks::PutNextFlux(const Buffer<float>& path)
{
  if (this->System)
  {
    this->System->PutNextFlux(path);
  }
}

SurfacePowers BalanceOverRanks::PowersAtSurface() const
{
  SurfacePowers powers = this->System->PowersAtSurface();
  const std::vector<double> held = std::exchange(powers.net, {}), back = std::exchange(powers.back, {});
  const Grid& grid = this->Block.WithGhosts().grid;
  ForBoxFaceCells(this->Block.Own().grid, [&](const BoxFaceCell& cell) {
    const std::array<int, 3> voxel = grid.VoxelAt(this->Block.PlaceOf(cell.voxel));
    const BoxFaceLayout layout = LayoutOfFace(grid, cell.face);
    const std::size_t at =
      layout.first + voxel[0] * layout.step[0] + voxel[1] * layout.step[1] + voxel[2] * layout.step[2];
    powers.net.push_back(held[at]);
    if (!back.empty())
    {
      powers.back.push_back(back[at]);
    }
  });
  return powers;
}

void BalanceOverRanks::AddFlux(const Buffer<float>& flux)
{
  if (this->System)
  {
    this->System->AddFlux(flux);
  }
}
}
