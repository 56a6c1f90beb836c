#include "LightPropagation/Diffusion/MultigridSolver.h"

#include "Device/Sizes.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int FewVoxels = 64;    ///< of the coarsest level
constexpr int FinishRounds = 12; ///< on it
constexpr int MostIterations = 300;
constexpr int Patience = 12;         ///< iterations in which a residual has to halve, or is left as it is
constexpr float Damping = 0.8f;      ///< of Jacobi's method, about the best for seven points
constexpr double Negligible = 1e-12; ///< residual, of the first one

/// Whether a residual is above a bound and has not stopped falling. Asked once an iteration.
class StillTooLarge
{
public:
  explicit StillTooLarge(double most)
    : Most(most)
  {
  }

  /// @param square  of the residual
  bool operator()(double square)
  {
    this->SinceHalved = square < 0.25 * this->Smallest ? 0 : this->SinceHalved + 1;
    this->Smallest = this->SinceHalved == 0 ? square : this->Smallest;
    return square > this->Most && this->SinceHalved < Patience;
  }

private:
  double Most; ///< squared
  double Smallest = std::numeric_limits<double>::infinity();
  int SinceHalved = 0; ///< iterations
};
}

MultigridSolver::MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& ofSpacing)
  : TheDevice(device)
{
  std::array<double, 3> spacing = ofSpacing;
  MultigridLevel layout = { { size[0], size[1], size[2] }, {} };
  for (;;)
  {
    const std::size_t count = static_cast<std::size_t>(layout.size[0]) * layout.size[1] * layout.size[2];
    double shortest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (layout.size[axis] > 1 && (shortest == 0.0 || spacing[axis] < shortest))
      {
        shortest = spacing[axis];
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      layout.halved[axis] = layout.size[axis] > 1 && spacing[axis] < 1.9 * shortest ? 1 : 0;
    }
    Level level;
    level.layout = layout;
    const char* what = "the diffusion system";
    level.conductance = Buffer<float>(device, 3 * count, what);
    level.loss = Buffer<float>(device, count, what);
    level.right = Buffer<float>(device, count, what);
    level.values = Buffer<float>(device, count, what);
    level.other = Buffer<float>(device, count, what);
    this->Levels.push_back(std::move(level));
    if (count <= FewVoxels)
    {
      break;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      spacing[axis] *= 1 + layout.halved[axis];
      layout.size[axis] = (layout.size[axis] + layout.halved[axis]) >> layout.halved[axis];
    }
  }
  this->Count = static_cast<std::size_t>(size[0]) * size[1] * size[2];
  this->Residual = ExactValues(device, this->Count, "the diffusion system");
  this->Direction = ExactValues(device, this->Count, "the diffusion system");
  this->Applied = ExactValues(device, this->Count, "the diffusion system");
  this->Sums = ExactValues(device, PartsOf<std::size_t>(this->Count, DiffusionChunk), "sums");
}

cl::NDRange MultigridSolver::Range(const int* size)
{
  return { static_cast<std::size_t>(RoundUp(size[0], 32)), static_cast<std::size_t>(RoundUp(size[1], 8)),
    static_cast<std::size_t>(size[2]) };
}

cl::Kernel MultigridSolver::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::MultigridSolver, ExactOption(this->TheDevice));
}

void MultigridSolver::Run(cl::Kernel& kernel, const int* size)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Range(size), Group());
}

void MultigridSolver::Coarsen()
{
  cl::Kernel kernel = this->Kernel("level_coarsen");
  for (std::size_t l = 0; l + 1 < this->Levels.size(); ++l)
  {
    Level& fine = this->Levels[l];
    Level& coarse = this->Levels[l + 1];
    With(kernel, fine.layout, coarse.layout, fine.conductance, fine.loss, coarse.conductance, coarse.loss);
    this->Run(kernel, coarse.layout.size);
  }
}

/// One step of Jacobi's method.
void MultigridSolver::Smooth(Level& level)
{
  cl::Kernel kernel = this->Kernel("level_smooth");
  With(kernel, level.layout, level.conductance, level.loss, level.right, level.values, level.other, Damping);
  this->Run(kernel, level.layout.size);
  level.values.Swap(level.other);
}

/// A V cycle on the residual; the finest level's values are what comes of it. The same steps up and down keep it
/// symmetric.
void MultigridSolver::Precondition(double perUnit)
{
  cl::Kernel first = this->Kernel("finest_begin");
  cl::Kernel begin = this->Kernel("level_begin");
  cl::Kernel residual = this->Kernel("level_residual");
  cl::Kernel restricts = this->Kernel("level_restrict");
  cl::Kernel prolong = this->Kernel("level_prolong");
  cl::Kernel finish = this->Kernel("level_finish");
  const std::size_t last = this->Levels.size() - 1;
  for (std::size_t l = 0; l < last || l == 0; ++l)
  {
    Level& level = this->Levels[l];
    if (l == 0)
    {
      With(first, level.layout, level.conductance, level.loss, this->Residual.Handle(), static_cast<float>(perUnit),
        level.right, level.values, Damping);
      this->Run(first, level.layout.size);
    }
    else
    {
      With(begin, level.layout, level.conductance, level.loss, level.right, level.values, Damping);
      this->Run(begin, level.layout.size);
    }
    if (last == 0)
    {
      break;
    }
    this->Smooth(level);
    With(residual, level.layout, level.conductance, level.loss, level.right, level.values, level.other);
    this->Run(residual, level.layout.size);
    Level& coarse = this->Levels[l + 1];
    With(restricts, level.layout, coarse.layout, level.other, coarse.right);
    this->Run(restricts, coarse.layout.size);
  }
  Level& coarsest = this->Levels[last];
  With(finish, coarsest.layout, coarsest.conductance, coarsest.loss, coarsest.right, coarsest.values,
    cl_int(FinishRounds));
  this->TheDevice.Queue().enqueueNDRangeKernel(finish, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
  for (std::size_t l = last; l-- > 0;)
  {
    Level& level = this->Levels[l];
    With(prolong, level.layout, this->Levels[l + 1].layout, this->Levels[l + 1].values, level.values);
    this->Run(prolong, level.layout.size);
    this->Smooth(level);
    this->Smooth(level);
  }
}

double MultigridSolver::Dot(const ExactValues& a, const cl::Buffer& b, bool ofFloats)
{
  cl::Kernel kernel = this->Kernel(ofFloats ? "diffusion_dot_float" : "diffusion_dot");
  With(kernel, a.Handle(), b, cl_int(this->Count), this->Sums.Handle());
  const std::size_t chunks = PartsOf<std::size_t>(this->Count, DiffusionChunk);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(chunks), cl::NDRange(1));
  double sum = 0.0;
  for (double part : this->Sums.Read())
  {
    sum += part;
  }
  return sum;
}

/// A x, or b - A x where `from` is given, into `into`.
void MultigridSolver::Multiply(const ExactValues& x, const ExactValues* from, const ExactValues& into)
{
  const Level& finest = this->Levels.front();
  cl::Kernel apply = this->Kernel("diffusion_apply");
  With(apply, finest.layout, finest.conductance, finest.loss, x.Handle(), (from ? *from : x).Handle(),
    cl_int(from != nullptr), into.Handle());
  this->Run(apply, finest.layout.size);
}

/// Preconditions the residual. @return its norm in that of the preconditioner, squared, in units
double MultigridSolver::PreconditionedNorm(double unit)
{
  this->Precondition(1.0 / unit);
  return this->Dot(this->Residual, this->Levels.front().values.Handle(), true) / unit;
}

/// The next direction: the preconditioned residual and `part` of the last direction.
void MultigridSolver::Turn(double part)
{
  cl::Kernel turn = this->Kernel("diffusion_turn");
  With(turn, this->Direction.Handle(), this->Levels.front().values);
  SetExact(this->TheDevice, turn, 2, part);
  this->TheDevice.Queue().enqueueNDRangeKernel(turn, cl::NullRange, cl::NDRange(this->Count), cl::NullRange);
}

/// Goes so far along the direction.
void MultigridSolver::Step(const ExactValues& values, double length)
{
  cl::Kernel step = this->Kernel("diffusion_step");
  With(step, values.Handle(), this->Residual.Handle(), this->Direction.Handle(), this->Applied.Handle());
  SetExact(this->TheDevice, step, 4, length);
  this->TheDevice.Queue().enqueueNDRangeKernel(step, cl::NullRange, cl::NDRange(this->Count), cl::NullRange);
}

int MultigridSolver::Solve(
  const ExactValues& right, ExactValues& values, double unit, double reduction, double leftAtMost)
{
  this->Multiply(values, &right, this->Residual);
  double rz = this->PreconditionedNorm(unit);
  this->FirstResidual = std::max(this->FirstResidual, rz);
  const double enough = std::max(rz * reduction * reduction, this->FirstResidual * Negligible * Negligible);
  StillTooLarge tooLarge(leftAtMost * leftAtMost * unit * unit * static_cast<double>(this->Count));
  const auto isLeft = [&] {
    return std::isfinite(leftAtMost) && tooLarge(this->Dot(this->Residual, this->Residual.Handle(), false));
  };
  this->Direction.Fill(0.0);
  double part = 0.0;
  int iteration = 0;
  while (iteration < MostIterations && rz > 0.0 && std::isfinite(rz) && (rz > enough || isLeft()))
  {
    this->Turn(part);
    this->Multiply(this->Direction, nullptr, this->Applied);
    const double curvature = this->Dot(this->Direction, this->Applied.Handle(), false);
    if (!(curvature > 0.0))
    {
      break;
    }
    this->Step(values, rz * unit / curvature); // the direction is in units: so is the step
    const double next = this->PreconditionedNorm(unit);
    part = next / rz;
    rz = next;
    ++iteration;
  }
  return iteration;
}
}
