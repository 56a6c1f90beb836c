#include "LightPropagation/Diffusion/DiffusionSolver.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Crossing pattern (power of the rays that cross voxel faces, relative to the mean) for a box of voxels: the entries
/// of its planes, copied from the tables for the whole grid.
/// @param size  size of the whole grid, voxels
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
      // Index of the plane in the whole grid, wrapped around a periodic axis.
      const int plane = (box.first[along] + k + size[along]) % size[along];
      pattern.values.push_back(whole.values[whole.first[table] + plane]);
    }
  }
  return pattern;
}

/// Factor by which the diffusion solve after each sweep reduces the residual of the diffusion system; a stronger
/// reduction would hardly save sweeps.
constexpr double Reduction = 3e-3;
/// Factor by which the diffusion solve reduces the residual if opaque voxels lie next to thin ones. Errors of the thin
/// voxels have little weight in the norm of the residual.
constexpr double ReductionBesideThin = 3e-4;
/// Factor by which the diffusion solves from the 13th sweep on reduce the residual: if the iteration converges slowly,
/// the residuals of successive solves add up.
constexpr double SlowReduction = 1e-4;
constexpr int Several = 12;
/// Targets of Refine(): factor by which it reduces the residual of the diffusion system, and upper bound on the
/// residual's root mean square, relative to the typical power of a voxel.
constexpr double RefinedBy = 0.1, RefinedTo = 1e-6;
/// Relative change of the fluence, as a root mean square, at which Refine() ends, and largest number of its rounds. The
/// residual alone does not bound the error: between opaque voxels, whose conductances are small, little power makes a
/// large difference of fluence.
constexpr double RefinedChange = 1e-5;
constexpr int MostRounds = 8;

/// Escaped power through each of the box's faces in the last solution, W; 0 on periodic axes. Rounding may make it
/// negative at faces through which no light leaves.
/// @param sums  over all ranks
/// @param entered  incident power of the sweep, W
/// @param ofSweep  escaped power of the sweep through each face, W; determines how the power of voxels with several
///   faces on the box is divided among faces
std::array<double, 6> OutflowBy(const DiffusionSystem::BorderSums& sums, double entered,
  const std::array<double, 6>& ofSweep, const std::array<bool, 3>& periodic)
{
  std::array<double, 6> outflow = sums.out;
  std::array<double, 6> missing = ofSweep; // outgoing power of the sweep minus its estimate, by face
  // The incident power by face is scaled to the total `entered`: sums over thousands of rays through a cell in floats
  // have errors of 1e-5.
  const double allCame = std::accumulate(sums.came.begin(), sums.came.end(), 0.0);
  for (int face = 0; face < 6; ++face)
  {
    missing[face] -= sums.seeming[face];
    outflow[face] += allCame > 0.0 ? sums.came[face] * (entered / allCame) : 0.0;
  }
  const double all = std::accumulate(missing.begin(), missing.end(), 0.0);
  const double left = std::accumulate(ofSweep.begin(), ofSweep.end(), 0.0);
  for (int face = 0; face < 6 && sums.shared > 0.0 && left > 0.0; ++face)
  {
    outflow[face] +=
      periodic[face / 2] ? 0.0 : sums.transportWeight / sums.shared * (missing[face] - all * ofSweep[face] / left);
  }
  return outflow;
}
}

DiffusionSolver::DiffusionSolver(Device& device, const BlockWithGhosts& block, const SweepModel& model,
  const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming, const std::array<bool, 3>& periodic,
  bool linear)
  : Block(block)
  , TheDomain(block.TheDomain())
  , Periodic(periodic)
  , ByCells(arrays.faces != nullptr)
{
  this->TheDomain.Collective([&] {
    this->Solver = std::make_unique<MultigridSolver>(device, this->TheDomain, periodic);
    if (block.Has())
    {
      this->System = std::make_unique<DiffusionSystem>(device, *this->Solver, block.WithGhosts().grid, block.Periodic(),
        SweepModel{
          model.halfRange, PatternOf(model.pattern, block.Held(), this->TheDomain.Whole().size), model.flatSource },
        arrays, incoming, linear);
    }
    else
    {
      this->NoVoxels = ExactValues(device, 0, "the diffusion system");
    }
    if (block.HasGhosts())
    {
      this->OwnNext = ExactValues(device, block.Own().grid.VoxelCount(), "the diffusion system");
    }
  });
  this->Solver->Coarsen();
  const int skin = this->System ? this->System->MostOpaqueSkin() : static_cast<int>(NoSkin);
  this->OpaqueBesideThin = this->TheDomain.Max(1.0 * skin) == OpaqueSkin;
  this->TheDomain.Collective([&] {
    const std::size_t floats = this->OpaqueBesideThin ? this->Solver->Right().Size() : 0;
    this->Balance = Buffer<float>(device, floats, "the diffusion system");
    this->Balance.Fill(0.0f);
  });
}

/// Runs `step` on this rank's system, if the rank has voxels. Collective.
void DiffusionSolver::OnSystem(const std::function<void(DiffusionSystem&)>& step) const
{
  this->TheDomain.Collective([&] {
    if (this->System)
    {
      step(*this->System);
    }
  });
}

double DiffusionSolver::Correct(double unit)
{
  Buffer<float> none;
  this->OnSystem([](DiffusionSystem& system) { system.FindModel(); });
  this->Block.FillGhosts(this->System ? this->System->TheModel() : none);
  this->OnSystem([&](DiffusionSystem& system) {
    system.Balance();
    if (this->OpaqueBesideThin)
    {
      this->Balance.CopyFrom(this->Solver->Right(), 0, this->Balance.Size());
    }
  });
  const double usual = this->OpaqueBesideThin ? ReductionBesideThin : Reduction;
  const double reduction = this->Corrections++ < Several ? usual : SlowReduction;
  this->Solver->Solve(this->System ? this->System->Solved() : this->NoVoxels, unit, reduction);
  AndersonMixing::Sums sums = {};
  this->OnSystem([&](DiffusionSystem& system) {
    system.FindFlux();
    sums = system.SumsOfChange(this->OpaqueBesideThin);
  });
  const std::vector<double> all = this->TheDomain.Sum(std::vector<double>{ sums.begin(), sums.end() });
  std::copy(all.begin(), all.end(), sums.begin());
  this->OnSystem([&](DiffusionSystem& system) { system.MixBy(sums); });
  return AndersonMixing::ChangeBy(sums);
}

void DiffusionSolver::Refine(double unit)
{
  ExactValues& values = this->System ? this->System->Solved() : this->NoVoxels;
  double change = 1.0;
  std::vector<double> before;
  this->TheDomain.Collective([&] { before = this->Found(); });
  for (int round = 0; round < MostRounds && change > RefinedChange; ++round)
  {
    std::vector<double> sums(2, 0.0);
    this->TheDomain.Collective([&] {
      if (this->OpaqueBesideThin)
      {
        this->Solver->Right().CopyFrom(this->Balance, 0, this->Balance.Size());
      }
    });
    // With opaque voxels next to thin ones, each round computes the residual anew. Otherwise rounding errors of the
    // large powers between thin voxels would hide the small powers between opaque voxels.
    this->OpaqueBesideThin ? this->Solver->Solve(values, unit, RefinedBy, RefinedTo)
                           : this->Solver->GoOn(values, unit, RefinedBy, RefinedTo);
    this->TheDomain.Collective([&] {
      std::vector<double> now = this->Found();
      for (std::size_t i = 0; i < now.size(); ++i)
      {
        sums[0] += (now[i] - before[i]) * (now[i] - before[i]);
        sums[1] += now[i] * now[i];
      }
      before = std::move(now);
    });
    sums = this->TheDomain.Sum(sums);
    change = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
  }
}

void DiffusionSolver::BeginBeyond(const std::vector<double>& guessed)
{
  this->OnSystem([&](DiffusionSystem& system) {
    std::vector<double> state = system.State();
    std::transform(state.begin(), state.end(), guessed.begin(), state.begin(), std::plus<>());
    system.Begin(state);
  });
}

/// Extracts the fluence of the block's voxels from a state with ghost voxels (DiffusionSystem::State).
std::vector<double> DiffusionSolver::OwnOf(std::vector<double> held) const
{
  const std::size_t count = this->Block.Own().grid.VoxelCount();
  if (!this->Block.HasGhosts())
  {
    held.resize(count);
    return held;
  }
  std::vector<double> own(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    own[i] = held[this->Block.PlaceOf(i)];
  }
  return own;
}

std::vector<double> DiffusionSolver::Found() const
{
  return this->System ? this->OwnOf(this->System->State()) : std::vector<double>();
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
  this->OnSystem([&](DiffusionSystem& system) { own = system.Absorbed(); });
  return this->TheDomain.Sum(own);
}

std::array<double, 6> DiffusionSolver::Outflow(double entered, const std::array<double, 6>& ofSweep)
{
  DiffusionSystem::BorderSums sums;
  this->OnSystem([&](DiffusionSystem& system) {
    const std::array<int, 3>& size = this->Block.WithGhosts().grid.size;
    sums = system.SumBorders([&](int face, int u, int v) {
      const PlaneAxes axes = AcrossAxis(face / 2);
      std::array<int, 3> voxel = {};
      voxel[axes.axis] = face % 2 ? size[axes.axis] - 1 : 0;
      voxel[axes.u] = u;
      voxel[axes.v] = v;
      // A voxel at an end of the box with ghosts that is not a ghost itself also lies at an end of the whole grid.
      return this->Block.IsOwn(voxel);
    });
  });
  std::vector<double> values = { sums.transportWeight, sums.shared };
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    values.insert(values.end(), ofFaces->begin(), ofFaces->end());
  }
  values = this->TheDomain.Sum(values);
  sums.transportWeight = values[0];
  // If sweeps tally power by cell, the power of voxels with several faces on the box need not be divided among faces.
  sums.shared = this->ByCells ? 0.0 : values[1];
  auto next = values.begin() + 2;
  for (std::array<double, 6>* ofFaces : { &sums.out, &sums.seeming, &sums.came })
  {
    std::copy_n(next, 6, ofFaces->begin());
    next += 6;
  }
  return OutflowBy(sums, entered, ofSweep, this->Periodic);
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
