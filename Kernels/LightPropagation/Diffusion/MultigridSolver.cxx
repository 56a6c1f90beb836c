#include "LightPropagation/Diffusion/MultigridSolver.h"

#include "Device/Device.h"
#include "Device/Sizes.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tyndall
{
namespace
{
/// Largest number of work-groups of a kernel on a GPU, enough to occupy large GPUs. With more voxels each work-item
/// processes several, so that the number of partial sums stays small.
constexpr std::size_t GroupsAtMost = 4096;

constexpr const char* Contents = "the diffusion system";

constexpr int FinishRounds = 12; ///< number of symmetric Gauss-Seidel iterations on the coarsest level
/// Damping of Jacobi's method, near the optimum: 0.8 takes 8% more iterations, 0.95 the same number.
constexpr float Damping = 0.87f;
/// Number of coarse levels, counted from the second level, that are visited twice per cycle; more do not save
/// iterations.
constexpr std::size_t VisitedTwice = 2;
/// If a level is visited twice, each correction is multiplied by this factor. With it, the preconditioner is positive
/// definite if one visit returns less than 2.5 times the exact correction; it returns too much where voxels of unequal
/// coefficients are joined.
constexpr float PartOfVisit = 0.8f;

constexpr int MostIterations = 300;
/// Number of iterations within which the residual must halve; if it does not, the iteration stops.
constexpr int Patience = 12;
/// Bound on the reduction of the residual's root mean square, divided by the bound on its reduction in the
/// preconditioner's norm.
constexpr double Looser = 10.0;
/// The residual r counts as rounding error if its norm, sqrt(r z) with the preconditioned residual z, is below this
/// fraction of the largest norm at the start of a solve.
constexpr double Negligible = 1e-12;

/// Test whether an iteration should go on: whether the residual is above its bound and has halved recently. To be
/// called once per iteration.
class StagnationTest
{
public:
  explicit StagnationTest(double most)
    : Most(most)
  {
  }

  /// Returns whether the iteration should go on.
  /// @param square  squared norm of the residual
  bool operator()(double square)
  {
    this->SinceHalved = square < 0.25 * this->Smallest ? 0 : this->SinceHalved + 1;
    this->Smallest = this->SinceHalved == 0 ? square : this->Smallest;
    return square > this->Most && this->SinceHalved < Patience;
  }

private:
  double Most; ///< bound on the squared norm of the residual
  double Smallest = std::numeric_limits<double>::infinity();
  int SinceHalved = 0; ///< number of iterations since the norm of the residual halved
};
}

MultigridSolver::MultigridSolver(Device& device, const Domain& domain, const std::array<bool, 3>& periodic)
  : TheDevice(device)
  , TheDomain(domain)
{
  const Grid& whole = this->TheDomain.Whole();
  std::vector<MultigridLevel> layouts = MultigridLevels(whole.size, whole.spacing);
  if (!this->TheDomain.IsSerial())
  {
    if (layouts.size() == 1) // adds a second level with the same voxels, which the first rank holds
    {
      std::fill_n(layouts[0].halved, 3, 0);
      layouts.push_back(layouts[0]);
    }
    this->Exchange = std::make_unique<MultigridExchange>(device, this->TheDomain, periodic, layouts[0], layouts[1]);
    this->Touched = this->MakeLevel(this->Exchange->Touched());
    layouts[0] = this->Exchange->Finest();
    layouts.resize(this->TheDomain.Rank() == 0 ? layouts.size() : 1);
  }
  std::size_t groups = std::max<std::size_t>(1, RowGroups(device, this->Touched.layout));
  for (const MultigridLevel& layout : layouts)
  {
    this->Levels.push_back(this->MakeLevel(layout));
    groups = std::max(groups, RowGroups(device, layout));
  }
  for (std::size_t l = 1; l <= VisitedTwice && l + 1 < this->Levels.size(); ++l)
  {
    this->Levels[l].kept = Buffer<float>(device, static_cast<std::size_t>(this->Levels[l].layout.floats), Contents);
  }
  this->Direction = Buffer<float>(device, static_cast<std::size_t>(this->Rows().floats), Contents);
  this->Direction.Fill(0.0f);
  this->Sums = ExactValues(device, groups, "sums");
}

MultigridSolver::Level MultigridSolver::MakeLevel(const MultigridLevel& layout) const
{
  Level level;
  level.layout = layout;
  level.conductance = Buffer<float>(this->TheDevice, 3 * static_cast<std::size_t>(layout.floats), Contents);
  for (Buffer<float>* array : { &level.loss, &level.inverse, &level.right, &level.guess, &level.better })
  {
    *array = Buffer<float>(this->TheDevice, static_cast<std::size_t>(layout.floats), Contents);
    array->Fill(0.0f);
  }
  level.conductance.Fill(0.0f);
  return level;
}

std::string RowOptions(const Device& device)
{
  return Define("REAL_WIDTH", device.KernelWidth(4, RowVector)) + SummingOption(device);
}

std::size_t RowGroups(const Device& device, const MultigridLevel& level)
{
  const auto own = [&](int axis) { return static_cast<std::size_t>(level.end[axis] - level.first[axis]); };
  const std::size_t rows = own(1) * own(2);
  if (device.IsCpu())
  {
    return PartsOf<std::size_t>(rows, std::max(1, level.together));
  }
  return std::min<std::size_t>(PartsOf<std::size_t>(rows * own(0), SummingGroup(device)), GroupsAtMost);
}

void RunRowsOf(Device& device, cl::Kernel& kernel, const MultigridLevel& level)
{
  if (const std::size_t groups = RowGroups(device, level); groups > 0)
  {
    RunSummingGroups(device, kernel, groups);
  }
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
  if (this->Exchange)
  {
    this->TheDomain.Collective([&] { this->CoarsenTo(this->Touched, this->Levels.front()); });
    const std::vector<float> conductance = this->Exchange->Sum(this->Touched.conductance, 3);
    const std::vector<float> loss = this->Exchange->Sum(this->Touched.loss, 1);
    this->TheDomain.Collective([&] {
      if (this->HasAllLevels())
      {
        this->Levels[1].conductance.Write(conductance.data());
        this->Levels[1].loss.Write(loss.data());
      }
    });
  }
  this->TheDomain.Collective([&] {
    cl::Kernel invert = this->Kernel("level_invert");
    for (std::size_t l = 0; l < this->Levels.size(); ++l)
    {
      Level& level = this->Levels[l];
      if (l > (this->Exchange ? 1 : 0))
      {
        this->CoarsenTo(level, this->Levels[l - 1]);
      }
      With(invert, level.layout, level.conductance, level.loss, level.inverse, Damping);
      this->Run(invert, level);
    }
    if (!this->TheDevice.IsCpu() && this->HasAllLevels())
    {
      this->FindAnswers();
    }
  });
}

void MultigridSolver::CoarsenTo(Level& coarse, const Level& fine)
{
  cl::Kernel coarsen = this->Kernel("level_coarsen");
  With(coarsen, fine.layout, coarse.layout, fine.conductance, fine.loss, coarse.conductance, coarse.loss);
  this->Run(coarsen, coarse);
}

/// Computes Answers: column by column, the result of Finish() for a right-hand side of 1 in one voxel.
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
  Buffer<float> rights(this->TheDevice, floats, Contents), values(this->TheDevice, floats, Contents);
  rights.Fill(0.0f);
  this->Answers = Buffer<float>(this->TheDevice, voxels * voxels, Contents);
  cl::Kernel kernel = this->Kernel("level_answers");
  With(kernel, level.layout, level.conductance, level.loss, rights, values, this->Answers, cl_int(FinishRounds));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(voxels), cl::NullRange);
  this->TheDevice.Finish();
}

/// Solves the coarsest level approximately, for its right-hand side; the result is in `better`.
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

/// Computes right-hand side and initial guess of the coarser level from the residual of the finer one.
void MultigridSolver::Restrict(Level& fine, Level& coarse)
{
  cl::Kernel kernel = this->Kernel("level_restrict");
  With(kernel, fine.layout, coarse.layout, fine.conductance, fine.loss, fine.right, fine.guess, coarse.inverse,
    coarse.right, coarse.guess);
  this->Run(kernel, coarse);
}

/// Adds the correction of the coarser level to `guess` of the finer one.
void MultigridSolver::Prolong(const Level& coarse, Level& fine)
{
  cl::Kernel prolong = this->Kernel("level_prolong");
  With(prolong, fine.layout, coarse.layout, coarse.better, fine.guess);
  this->Run(prolong, fine);
}

void MultigridSolver::Smooth(Level& level)
{
  cl::Kernel smooth = this->Kernel("level_smooth");
  With(smooth, level.layout, level.conductance, level.loss, level.inverse, level.right, level.guess, level.better,
    this->Sums.Handle());
  this->Run(smooth, level);
}

/// Applies the preconditioner, one multigrid cycle, to the residual r; the result z is in the finest level's `better`.
/// @return r z, the square of the residual in the norm of the preconditioner; r and z are stored divided by the
///   parameter `unit` of Solve()
double MultigridSolver::Precondition()
{
  if (!this->Exchange)
  {
    return this->SumAfter([&] { this->Visit(0); });
  }
  Level& finest = this->Levels.front();
  this->Exchange->FillGhosts(finest.guess);
  this->TheDomain.Collective([&] { this->Restrict(finest, this->Touched); });
  const std::vector<float> right = this->Exchange->Sum(this->Touched.right, 1);
  this->TheDomain.Collective([&] {
    if (this->HasAllLevels())
    {
      Level& coarse = this->Levels[1];
      coarse.right.Write(right.data());
      cl::Kernel guess = this->Kernel("level_guess");
      With(guess, coarse.layout, coarse.inverse, coarse.right, coarse.guess);
      this->Run(guess, coarse);
      this->VisitCoarser(1);
    }
  });
  this->Exchange->Distribute(
    this->HasAllLevels() ? this->Levels[1].better : this->Touched.better, this->Touched.better);
  this->TheDomain.Collective([&] { this->Prolong(this->Touched, finest); });
  this->Exchange->FillGhosts(finest.guess);
  return this->SumAfter([&] { this->Smooth(finest); });
}

/// Solves a level approximately, from its right-hand side and initial guess; the result is in `better`. The cycle is
/// symmetric: Jacobi's initial guess before the coarser level, a Jacobi step after it.
void MultigridSolver::Visit(std::size_t l)
{
  Level& level = this->Levels[l];
  if (l + 1 == this->Levels.size())
  {
    this->Finish(level);
    return;
  }
  this->Restrict(level, this->Levels[l + 1]);
  this->VisitCoarser(l + 1);
  this->Prolong(this->Levels[l + 1], level);
  this->Smooth(level);
}

void MultigridSolver::VisitCoarser(std::size_t l)
{
  if (this->Levels[l].kept.Size() > 0)
  {
    this->VisitTwice(l);
  }
  else
  {
    this->Visit(l);
  }
}

/// Visits a level twice, the second time for the residual of the first visit, and adds both corrections times
/// PartOfVisit. Symmetric, like one visit.
void MultigridSolver::VisitTwice(std::size_t l)
{
  Level& level = this->Levels[l];
  this->Visit(l);
  cl::Kernel revisit = this->Kernel("level_revisit");
  With(revisit, level.layout, level.conductance, level.loss, level.inverse, level.better, PartOfVisit, level.kept,
    level.right, level.guess);
  this->Run(revisit, level);
  this->Visit(l);
  this->ScaleAndAdd(level, level.kept, PartOfVisit, level.better);
}

/// Computes values = added + part * values, in rows of a level.
void MultigridSolver::ScaleAndAdd(
  const Level& level, const Buffer<float>& added, float part, const Buffer<float>& values)
{
  cl::Kernel kernel = this->Kernel("scale_and_add");
  With(kernel, level.layout, added, part, values);
  this->Run(kernel, level);
}

/// Runs kernels of the finest level that write partial sums by work-group to Sums. @return the sum over all ranks
double MultigridSolver::SumAfter(const std::function<void()>& work) const
{
  double sum = 0.0;
  this->TheDomain.Collective([&] {
    work();
    const std::vector<double> values = this->Sums.Read();
    const std::size_t groups = RowGroups(this->TheDevice, this->Rows());
    for (std::size_t i = 0; i < groups; ++i)
    {
      sum += values[i];
    }
  });
  return this->TheDomain.Sum(sum);
}

/// Replaces the right-hand side by the residual r = b - A x of x = `values`, divided by `unit`. @return r r of the
/// divided residual
double MultigridSolver::Begin(const ExactValues& values, double unit)
{
  return this->SumAfter([&] {
    const Level& finest = this->Levels.front();
    cl::Kernel kernel = this->Kernel("begin_residual");
    With(kernel, finest.layout, finest.conductance, finest.loss, finest.inverse, values.Handle(),
      static_cast<float>(1.0 / unit), finest.right, finest.guess, this->Sums.Handle());
    this->Run(kernel, finest);
    this->Direction.Fill(0.0f);
  });
}

/// New search direction: p = z + part * p, with the preconditioned residual z.
void MultigridSolver::Turn(double part)
{
  this->TheDomain.Collective([&] {
    const Level& finest = this->Levels.front();
    this->ScaleAndAdd(finest, finest.better, static_cast<float>(part), this->Direction);
  });
  if (this->Exchange)
  {
    this->Exchange->FillGhosts(this->Direction);
  }
}

/// Computes A p of the search direction p, in the finest level's `better`. @return p A p
double MultigridSolver::Curvature()
{
  return this->SumAfter([&] {
    const Level& finest = this->Levels.front();
    cl::Kernel kernel = this->Kernel("apply_matrix");
    With(kernel, finest.layout, finest.conductance, finest.loss, this->Direction, finest.better, this->Sums.Handle());
    this->Run(kernel, finest);
  });
}

/// Step along the search direction: x += length * p, r -= length * A p. @return r r; r and p are stored divided by
/// `unit`
double MultigridSolver::Step(const ExactValues& values, double length, double unit)
{
  return this->SumAfter([&] {
    const Level& finest = this->Levels.front();
    cl::Kernel kernel = this->Kernel("go_along");
    With(kernel, finest.layout, this->Direction, finest.better, finest.inverse, static_cast<float>(length));
    SetExact(this->TheDevice, kernel, 5, length * unit);
    SetFrom(kernel, 6, finest.right, finest.guess, values.Handle(), this->Sums.Handle());
    this->Run(kernel, finest);
  });
}

int MultigridSolver::Solve(ExactValues& values, double unit, double reduction, double leftAtMost)
{
  if (this->Exchange)
  {
    this->Exchange->FillGhosts(values);
  }
  return this->Iterate(values, this->Begin(values, unit), unit, reduction, leftAtMost);
}

int MultigridSolver::GoOn(ExactValues& values, double unit, double reduction, double leftAtMost)
{
  return this->Iterate(values, this->Step(values, 0.0, unit), unit, reduction, leftAtMost);
}

/// Conjugate gradients (Hestenes and Stiefel 1952) until the bounds are met or the residual stagnates.
/// @param left  r r of the initial residual r, which is stored divided by `unit`
/// @return number of iterations
int MultigridSolver::Iterate(ExactValues& values, double left, double unit, double reduction, double leftAtMost)
{
  double rz = this->Precondition();
  this->FirstResidual = std::max(this->FirstResidual, rz);
  const double enough = std::max(rz * reduction * reduction, this->FirstResidual * Negligible * Negligible);
  const double least = Looser * reduction;
  const auto voxels = static_cast<double>(this->TheDomain.Whole().VoxelCount());
  StagnationTest tooLarge(std::min(leftAtMost * leftAtMost * voxels, least * least * left));
  bool tooMuchLeft = tooLarge(left);
  double part = 0.0;
  int iteration = 0;
  while (iteration < MostIterations && rz > 0.0 && std::isfinite(rz) && (rz > enough || tooMuchLeft))
  {
    this->Turn(part);
    const double curvature = this->Curvature();
    if (!(curvature > 0.0))
    {
      break;
    }
    left = this->Step(values, rz / curvature, unit);
    tooMuchLeft = tooLarge(left);
    const double next = this->Precondition();
    part = next / rz;
    rz = next;
    ++iteration;
  }
  if (this->Exchange)
  {
    this->Exchange->FillGhosts(values);
  }
  return iteration;
}
}
