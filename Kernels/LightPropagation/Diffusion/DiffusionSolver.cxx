#include "LightPropagation/Diffusion/DiffusionSolver.h"

#include "Medium/BoxFaces.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
/// The part of the crossing pattern for the planes of a box.
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
      const int plane = (box.first[along] + k + size[along]) % size[along]; // wraps around a periodic axis
      pattern.values.push_back(whole.values[whole.first[table] + plane]);
    }
  }
  return pattern;
}

/// One of several arrays of a level, without the padding between rows.
std::vector<float> ArrayOf(const MultigridLevel& rows, const std::vector<float>& arrays, int which)
{
  const auto begin = arrays.begin() + static_cast<std::ptrdiff_t>(which) * rows.floats;
  return OfRows(rows, { begin, begin + rows.floats });
}
}

DiffusionSolver::DiffusionSolver(Device& device, const BlockWithGhosts& block, const DirectionSet& directions,
  const CrossingPattern& pattern, const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming,
  const std::array<bool, 3>& periodic, bool linear)
  : Block(block)
  , TheDomain(block.TheDomain())
  , Periodic(periodic)
  , SigmaA(arrays.sigma_a)
  , First(arrays.first)
  , ByCells(arrays.faces != nullptr)
{
  this->TheDomain.Collective([&] {
    if (block.Has())
    {
      this->System = std::make_unique<DiffusionSystem>(device, block.WithGhosts().grid, block.Periodic(), directions,
        PatternOf(pattern, block.Held(), this->TheDomain.Whole().size), arrays, incoming, linear);
    }
    if (block.HasGhosts())
    {
      this->OwnNext = ExactValues(device, block.Own().grid.VoxelCount(), "the diffusion system");
    }
  });
  if (this->TheDomain.IsSerial())
  {
    return;
  }
  std::array<std::vector<float>, 3> conductance;
  std::vector<float> loss;
  this->TheDomain.Collective([&] {
    this->OverRanks =
      std::make_unique<MultigridOverRanks>(this->TheDomain.Comm(), this->TheDomain.Partition(), periodic);
    this->Fluence.assign(block.WithGhosts().grid.VoxelCount(), 0.0);
    if (!this->System)
    {
      return;
    }
    MultigridSolver& matrix = this->System->Matrix();
    const std::vector<float> all = matrix.Conductance().Read();
    for (int axis = 0; axis < 3; ++axis)
    {
      conductance[axis] = ArrayOf(matrix.Rows(), all, axis);
    }
    loss = ArrayOf(matrix.Rows(), matrix.Loss().Read(), 0);
  });
  this->OverRanks->SetMatrix(conductance, loss);
}

double DiffusionSolver::Correct(double unit)
{
  Buffer<float> none;
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      this->System->FindModel();
    }
  });
  this->Block.FillGhosts(this->System ? this->System->TheModel() : none);
  const double reduction = DiffusionSystem::ReductionAfter(this->Corrections++);
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      this->System->Balance();
    }
    if (this->OnDevice())
    {
      this->System->Solve(unit, reduction);
    }
  });
  this->SolveOverRanks(unit, reduction);
  AndersonMixing::Sums sums = {};
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      this->System->FindFlux();
      sums = this->System->SumsOfChange();
    }
  });
  const std::vector<double> all = this->TheDomain.Sum(std::vector<double>{ sums.begin(), sums.end() });
  std::copy(all.begin(), all.end(), sums.begin());
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      this->System->MixBy(sums);
    }
  });
  return AndersonMixing::ChangeBy(sums);
}

void DiffusionSolver::SolveOverRanks(double unit, double reduction)
{
  if (!this->OverRanks)
  {
    return;
  }
  std::vector<float> right;
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      right = ArrayOf(this->System->Matrix().Rows(), this->System->Matrix().Right().Read(), 0);
    }
  });
  this->OverRanks->Solve(this->Fluence, right, unit, reduction);
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      this->System->SetFound(this->Fluence);
    }
  });
}

void DiffusionSolver::Refine(double unit)
{
  if (this->OverRanks)
  {
    this->OverRanks->GoOn(this->Fluence, unit, DiffusionSystem::RefinedBy, DiffusionSystem::RefinedTo);
  }
  this->TheDomain.Collective([&] {
    if (this->OnDevice())
    {
      this->System->Refine(unit);
    }
    else if (this->System)
    {
      this->System->SetFound(this->Fluence);
    }
  });
}

void DiffusionSolver::BeginBeyond(const std::vector<double>& guessed)
{
  this->TheDomain.Collective([&] {
    if (!this->System)
    {
      return;
    }
    std::vector<double> state = this->System->State();
    std::copy(this->Fluence.begin(), this->Fluence.end(), state.begin()); // the host's copy is not rounded
    std::transform(state.begin(), state.end(), guessed.begin(), state.begin(), std::plus<>());
    std::copy_n(state.begin(), this->Fluence.size(), this->Fluence.begin());
    this->System->Begin(state);
  });
}

std::vector<double> DiffusionSolver::OwnOf(const std::vector<double>& held) const
{
  std::vector<double> own(this->Block.Own().grid.VoxelCount());
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    own[i] = held[this->Block.PlaceOf(i)];
  }
  return own;
}

std::vector<double> DiffusionSolver::Found() const
{
  return this->OnDevice() ? this->System->Found() : this->OwnOf(this->Fluence);
}

const ExactValues& DiffusionSolver::NextFluence()
{
  if (!this->Block.HasGhosts())
  {
    return this->System->NextFluence();
  }
  this->OwnNext.Write(this->OwnOf(this->System->NextFluence().Read()));
  return this->OwnNext;
}

double DiffusionSolver::Absorbed() const
{
  double own = 0.0;
  this->TheDomain.Collective([&] {
    if (this->OnDevice())
    {
      own = this->System->Absorbed();
    }
    else if (this->System)
    {
      const Grid& grid = this->Block.Own().grid;
      const std::vector<float> sigmaA = this->SigmaA->Read();
      own = grid.VoxelVolume() * SumOverVoxels(grid, [&](std::size_t i) {
        const std::size_t at = this->Block.PlaceOf(i);
        return sigmaA[this->First + at] * this->Fluence[at];
      });
    }
  });
  return this->TheDomain.Sum(own);
}

std::array<double, 6> DiffusionSolver::Outflow(double entered, const std::array<double, 6>& ofSweep)
{
  DiffusionSystem::BorderSums sums;
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      const std::array<int, 3>& size = this->Block.WithGhosts().grid.size;
      sums = this->System->SumBorders([&](int face, int u, int v) {
        const PlaneAxes axes = AcrossAxis(face / 2);
        std::array<int, 3> voxel = {};
        voxel[axes.axis] = face % 2 ? size[axes.axis] - 1 : 0;
        voxel[axes.u] = u;
        voxel[axes.v] = v;
        return this->Block.IsOwn(voxel); // the faces of own voxels at the end of the box are the grid's
      });
    }
  });
  std::vector<double> values = { sums.transportWeight, sums.shared };
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    values.insert(values.end(), ofFaces->begin(), ofFaces->end());
  }
  values = this->TheDomain.Sum(values);
  sums.transportWeight = values[0];
  sums.shared = this->ByCells ? 0.0 : values[1]; // otherwise the power is known by cell
  auto next = values.begin() + 2;
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    std::copy_n(next, 6, ofFaces->begin());
    next += 6;
  }
  return DiffusionSystem::OutflowBy(sums, entered, ofSweep, this->Periodic);
}

void DiffusionSolver::ShapeSource()
{
  if (this->System)
  {
    this->System->ShapeSource();
  }
}

void DiffusionSolver::PutNextFlux(const Buffer<float>& path)
{
  if (this->System)
  {
    this->System->PutNextFlux(path);
  }
}

SurfacePowers DiffusionSolver::PowersAtSurface() const
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

void DiffusionSolver::AddFlux(const Buffer<float>& flux)
{
  if (this->System)
  {
    this->System->AddFlux(flux);
  }
}
}
