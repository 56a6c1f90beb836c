#include "LightPropagation/Diffusion/MultigridSolver.h"

#include "LightPropagation/Diffusion/ConjugateGradients.h"
#include "LightPropagation/Diffusion/MultigridCycle.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <stdexcept>

namespace tyndall
{
namespace
{
/// On a GPU: enough to keep the largest ones busy. With more voxels each work-item processes several, and the host need
/// not add more sums.
constexpr std::size_t GroupsAtMost = 4096;
}

MultigridSolver::MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& spacing)
  : TheDevice(device)
{
  const char* what = "the diffusion system";
  for (const MultigridLevel& layout : MultigridLevels(size, spacing))
  {
    Level level;
    level.layout = layout;
    level.conductance = Buffer<float>(device, 3 * static_cast<std::size_t>(layout.floats), what);
    for (Buffer<float>* array : { &level.loss, &level.inverse, &level.right, &level.guess, &level.better })
    {
      *array = Buffer<float>(device, static_cast<std::size_t>(layout.floats), what);
      array->Fill(0.0f);
    }
    level.conductance.Fill(0.0f);
    this->Levels.push_back(std::move(level));
  }
  for (std::size_t l = 1; l <= VisitedTwice && l + 1 < this->Levels.size(); ++l)
  {
    this->Levels[l].kept = Buffer<float>(device, static_cast<std::size_t>(this->Levels[l].layout.floats), what);
  }
  this->Direction = Buffer<float>(device, static_cast<std::size_t>(this->Rows().floats), what);
  this->Direction.Fill(0.0f);
  std::size_t groups = 1;
  for (const Level& level : this->Levels)
  {
    groups = std::max(groups, GroupsOf(device, level.layout));
  }
  this->Sums = ExactValues(device, groups, "sums");
}

std::string MultigridSolver::RowOptions(const Device& device)
{
  return Define("REAL_WIDTH", device.KernelWidth(4, RowVector)) + SummingOption(device);
}

std::size_t MultigridSolver::GroupsOf(const Device& device, const MultigridLevel& level)
{
  const std::size_t rows = static_cast<std::size_t>(level.size[1]) * level.size[2];
  if (device.IsCpu())
  {
    return PartsOf<std::size_t>(rows, level.together);
  }
  return std::min<std::size_t>(PartsOf<std::size_t>(rows * level.size[0], SummingGroup(device)), GroupsAtMost);
}

void MultigridSolver::RunRows(Device& device, cl::Kernel& kernel, const MultigridLevel& level)
{
  RunSummingGroups(device, kernel, GroupsOf(device, level));
}

std::array<const Buffer<float>*, 3> MultigridSolver::Scratch() const
{
  return { &this->Direction, &this->Levels.front().guess, &this->Levels.front().better };
}

cl::Kernel MultigridSolver::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(
    name, kernel_source::MultigridSolver, RowOptions(this->TheDevice) + ExactOption(this->TheDevice));
}

void MultigridSolver::Coarsen()
{
  cl::Kernel coarsen = this->Kernel("level_coarsen");
  cl::Kernel invert = this->Kernel("level_invert");
  for (std::size_t l = 0; l < this->Levels.size(); ++l)
  {
    Level& level = this->Levels[l];
    if (l > 0)
    {
      const Level& fine = this->Levels[l - 1];
      With(coarsen, fine.layout, level.layout, fine.conductance, fine.loss, level.conductance, level.loss);
      this->Run(coarsen, level);
    }
    With(invert, level.layout, level.conductance, level.loss, level.inverse, Damping);
    this->Run(invert, level);
  }
  if (!this->TheDevice.IsCpu())
  {
    this->FindAnswers();
  }
}

/// What the coarsest level makes of a 1 in each of its voxels.
void MultigridSolver::FindAnswers()
{
  const Level& level = this->Levels.back();
  const int* n = level.layout.size;
  const std::size_t voxels = static_cast<std::size_t>(n[0]) * n[1] * n[2];
  if (voxels > static_cast<std::size_t>(SummingGroup(this->TheDevice)))
  {
    throw std::logic_error("the coarsest level has more voxels than a group has work-items");
  }
  const std::size_t floats = voxels * level.layout.floats;
  const char* what = "the diffusion system";
  Buffer<float> rights(this->TheDevice, floats, what), values(this->TheDevice, floats, what);
  rights.Fill(0.0f);
  this->Answers = Buffer<float>(this->TheDevice, voxels * voxels, what);
  cl::Kernel kernel = this->Kernel("level_answers");
  With(kernel, level.layout, level.conductance, level.loss, rights, values, this->Answers, cl_int(FinishRounds));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(voxels), cl::NullRange);
  this->TheDevice.Finish();
}

/// Solves the coarsest level approximately: from its right-hand side to `better`.
void MultigridSolver::Finish(Level& level)
{
  if (this->Answers.Size() == 0)
  {
    cl::Kernel finish = this->Kernel("level_finish");
    With(finish, level.layout, level.conductance, level.loss, level.right, level.better, this->Sums.Handle(),
      cl_int(FinishRounds));
    this->TheDevice.Queue().enqueueNDRangeKernel(finish, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
    return;
  }
  cl::Kernel answer = this->Kernel("level_answer");
  With(answer, level.layout, this->Answers, level.right, level.better, this->Sums.Handle());
  RunSummingGroups(this->TheDevice, answer, 1);
}

/// Computes the next level's right-hand side and initial guess from a level's residual.
void MultigridSolver::Restrict(Level& fine, Level& coarse)
{
  cl::Kernel kernel = this->Kernel("level_restrict");
  With(kernel, fine.layout, coarse.layout, fine.conductance, fine.loss, fine.right, fine.guess, coarse.inverse,
    coarse.right, coarse.guess);
  this->Run(kernel, coarse);
}

/// Adds the coarser level's correction, and smoothes.
void MultigridSolver::Correct(Level& fine, const Level& coarse)
{
  cl::Kernel prolong = this->Kernel("level_prolong");
  With(prolong, fine.layout, coarse.layout, coarse.better, fine.guess);
  this->Run(prolong, fine);
  cl::Kernel smooth = this->Kernel("level_smooth");
  With(smooth, fine.layout, fine.conductance, fine.loss, fine.inverse, fine.right, fine.guess, fine.better,
    this->Sums.Handle());
  this->Run(smooth, fine);
}

/// Applies a multigrid cycle to the residual; the result is in the finest level's `better`.
/// @return the residual's squared norm in that of the preconditioner, in units
double MultigridSolver::Precondition()
{
  this->Visit(0);
  return this->SumOfGroups();
}

/// Solves a level approximately: from its right-hand side and initial guess to `better`. The cycle is symmetric:
/// Jacobi's initial guess on the way down, a Jacobi step on the way up.
void MultigridSolver::Visit(std::size_t l)
{
  Level& level = this->Levels[l];
  if (l + 1 == this->Levels.size())
  {
    this->Finish(level);
    return;
  }
  this->Restrict(level, this->Levels[l + 1]);
  if (this->Levels[l + 1].kept.Size() > 0)
  {
    this->VisitTwice(l + 1);
  }
  else
  {
    this->Visit(l + 1);
  }
  this->Correct(level, this->Levels[l + 1]);
}

/// Applies a fraction of each of two visits' corrections, the second for the residual of the first: symmetric, as one
/// visit is.
void MultigridSolver::VisitTwice(std::size_t l)
{
  Level& level = this->Levels[l];
  this->Visit(l);
  cl::Kernel revisit = this->Kernel("level_revisit");
  With(revisit, level.layout, level.conductance, level.loss, level.inverse, level.better, PartOfVisit, level.kept,
    level.right, level.guess);
  this->Run(revisit, level);
  this->Visit(l);
  cl::Kernel join = this->Kernel("level_join");
  With(join, level.layout, level.kept, PartOfVisit, level.better);
  this->Run(join, level);
}

/// Sum of the partial sums of the finest level's work-groups.
double MultigridSolver::SumOfGroups() const
{
  const std::vector<double> values = this->Sums.Read();
  const std::size_t groups = GroupsOf(this->TheDevice, this->Rows());
  double sum = 0.0;
  for (std::size_t i = 0; i < groups; ++i)
  {
    sum += values[i];
  }
  return sum;
}

/// Replaces the right-hand side by the residual. @return r r, in units
double MultigridSolver::Begin(const ExactValues& values, double unit)
{
  const Level& finest = this->Levels.front();
  cl::Kernel kernel = this->Kernel("begin_residual");
  With(kernel, finest.layout, finest.conductance, finest.loss, finest.inverse, values.Handle(),
    static_cast<float>(1.0 / unit), finest.right, finest.guess, this->Sums.Handle());
  this->Run(kernel, finest);
  this->Direction.Fill(0.0f);
  return this->SumOfGroups();
}

/// p = z + part p
void MultigridSolver::Turn(double part)
{
  const Level& finest = this->Levels.front();
  cl::Kernel kernel = this->Kernel("turn_direction");
  With(kernel, finest.layout, finest.better, this->Direction, static_cast<float>(part));
  this->Run(kernel, finest);
}

/// @return p A p. Leaves A p in the finest level's `better`.
double MultigridSolver::Curvature()
{
  const Level& finest = this->Levels.front();
  cl::Kernel kernel = this->Kernel("apply_matrix");
  With(kernel, finest.layout, finest.conductance, finest.loss, this->Direction, finest.better, this->Sums.Handle());
  this->Run(kernel, finest);
  return this->SumOfGroups();
}

/// x += length p, r -= length A p. @return r r, in units
double MultigridSolver::Step(const ExactValues& values, double length, double unit)
{
  const Level& finest = this->Levels.front();
  cl::Kernel kernel = this->Kernel("go_along");
  With(kernel, finest.layout, this->Direction, finest.better, finest.inverse, static_cast<float>(length));
  SetExact(this->TheDevice, kernel, 5, length * unit);
  SetFrom(kernel, 6, finest.right, finest.guess, values.Handle(), this->Sums.Handle());
  this->Run(kernel, finest);
  return this->SumOfGroups();
}

int MultigridSolver::Solve(const ExactValues& values, double unit, double reduction, double leftAtMost)
{
  return this->Iterate(values, this->Begin(values, unit), unit, reduction, leftAtMost);
}

int MultigridSolver::GoOn(const ExactValues& values, double unit, double reduction, double leftAtMost)
{
  return this->Iterate(values, this->Step(values, 0.0, unit), unit, reduction, leftAtMost);
}

/// @param left  r r of the initial residual, in units
int MultigridSolver::Iterate(const ExactValues& values, double left, double unit, double reduction, double leftAtMost)
{
  const GradientSteps steps = { [&] { return this->Precondition(); }, [&](double part) { this->Turn(part); },
    [&] { return this->Curvature(); }, [&](double length) { return this->Step(values, length, unit); } };
  const auto voxels = static_cast<double>(this->Rows().size[0]) * this->Rows().size[1] * this->Rows().size[2];
  return SolveCg(steps, left, { reduction, leftAtMost, voxels }, this->FirstResidual);
}
}
