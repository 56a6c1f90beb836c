#include "FusedSolver.h"
#include "UnvaryingAxes.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int MostSweeps = 200;
constexpr int ManyPlanes = 8192;          ///< that a ray goes round a periodic axis before it is given up
constexpr double UsualTolerance = 1e-4;   ///< the method must not depend on the tolerance
constexpr double ThickForNearness = 0.1;  ///< mean free paths a voxel
constexpr double Margin = 1.5;            ///< of the estimated error: changes do not fall off evenly
constexpr double ManyOrders = 40.0;       ///< plain iteration that is dearer than an acceleration
constexpr double ManyOrdersInSlab = 12.0; ///< the same in a slab, whose low-order system is small
}

/// As many as plain iteration would need. In a slab of optical thickness tau orders fall off like
/// albedo (1 - pi^2 / (3 (tau + 1.42)^2)) (diffusion, extrapolated); the longest lines of voxels stand for the slab.
double FusedSolver::OrdersNeeded() const
{
  const Grid& grid = this->TheMedium.grid;
  const std::array<std::size_t, 3> step = { 1, static_cast<std::size_t>(grid.size[0]),
    static_cast<std::size_t>(grid.size[0]) * grid.size[1] };
  double slowest = 0.0;
  for (int c = 0; c < this->Channels; ++c)
  {
    double scattering = 0.0, albedo = 0.0;
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      const double s = this->SigmaS(i, c);
      scattering += s;
      albedo += s > 0.0 ? s * s / (s + this->TheMedium.sigma_a.At(i, c)) : 0.0;
    }
    double leak = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = AcrossAxis(axis).u;
      const int v = AcrossAxis(axis).v;
      double longest = 0.0;
      for (int j = 0; j < grid.size[v]; ++j)
      {
        for (int i = 0; i < grid.size[u]; ++i)
        {
          double tau = 0.0;
          for (int k = 0; k < grid.size[axis]; ++k)
          {
            tau += this->SigmaT(i * step[u] + j * step[v] + k * step[axis], c);
          }
          longest = std::max(longest, tau * grid.spacing[axis]);
        }
      }
      leak += this->Settings.periodic[axis] ? 0.0 : Pi * Pi / 3.0 / ((longest + 1.42) * (longest + 1.42));
    }
    const double ratio = scattering > 0.0 ? albedo / scattering / (1.0 + leak) : 0.0;
    slowest = std::max(slowest, ratio);
  }
  return slowest <= 0.0 ? 0.0 : slowest >= 1.0 ? 1e30 : std::log(UsualTolerance) / std::log(slowest);
}

/// So that plain iteration is dearer than an acceleration.
bool FusedSolver::ScatteredManyTimes() const
{
  const bool slab = UnvaryingAxes(this->TheMedium.grid, this->Outside, this->Settings).IsSlab();
  return this->OrdersNeeded() > (slab ? ManyOrdersInSlab : ManyOrders);
}

void FusedSolver::ChooseAcceleration()
{
  const bool linear = this->Settings.source == PropagationSource::Linear;
  this->LinearSource = this->Settings.source != PropagationSource::Constant;
  if (linear)
  {
    this->Accelerated = true;
    return;
  }
  this->Accelerated = this->Settings.acceleration == PropagationAcceleration::Automatic &&
    this->Settings.maximumOrders == 0 && this->Traits.scatters && this->ScatteredManyTimes();
}

void FusedSolver::RunAccelerated(const Monitor& monitor)
{
  this->Iterating = false;
  this->LoadAbsorption();
  this->ChooseNearness();
  this->PropagateLights(monitor);
  this->Iterating = true;
  this->Stranded = this->OnTheWay;
  this->LoadAccelerated(monitor);
  int sweep = 0;
  do
  {
    const Monitor ofSweep =
      monitor ? Monitor([&](double done) { return monitor(this->Progress(sweep, done)); }) : Monitor();
    this->SweepAll(sweep, ofSweep);
    if (sweep == 0)
    {
      this->Fluence.Write(this->WithLamps(this->Path, 1.0 / this->TheMedium.grid.VoxelVolume()).data());
      this->Result.fluenceDirect = this->Interleaved(this->Fluence, 1.0);
      this->MakeSystems();
    }
    this->Correct(sweep);
    Report(ofSweep, 1.0);
    ++sweep;
  } while (!this->DoneAccelerated(sweep));
  this->UnloadAccelerated();
}

/// Where lamps' light is scattered first within a voxel matters where one is thick.
void FusedSolver::ChooseNearness()
{
  const Grid& grid = this->TheMedium.grid;
  bool thick = false;
  for (std::size_t i = 0; i < grid.VoxelCount() && !thick; ++i)
  {
    for (int c = 0; c < this->Channels && !thick; ++c)
    {
      thick = this->SigmaT(i, c) * *std::max_element(grid.spacing.begin(), grid.spacing.end()) > ThickForNearness;
    }
  }
  if (this->LinearSource && thick && !this->Lights.empty())
  {
    this->Nearness = Buffer<float>(this->TheDevice, 6 * this->Stride * this->Channels + SweepPadding, "light of lamps");
    this->Passed = Buffer<float>(this->TheDevice, 6 * this->Stride * this->Channels, "light of lamps");
    this->Passed.Fill(0.0f);
    this->LampPath = Buffer<float>(this->TheDevice, this->Stride * this->Channels + SweepPadding, "light of lamps");
  }
}

void FusedSolver::LoadAbsorption()
{
  std::vector<float> absorption(this->Stride * this->Channels + SweepPadding, 0.0f);
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      absorption[c * this->Stride + i] = this->TheMedium.sigma_a.At(i, c);
    }
  }
  this->Absorption = Buffer<float>(this->TheDevice, absorption, "sigma_a");
}

/// A lamp's light in voxels where it matters how deep in them it is scattered: what passes their faces at once.
void FusedSolver::PassLight(int firstChannel, int channels)
{
  for (int c = firstChannel; c < firstChannel + channels; ++c)
  {
    const std::size_t first = c * this->Stride;
    PassLampLight(this->TheDevice, this->TheMedium.grid, this->Settings.periodic,
      { this->Stride, this->SharedExtinction ? 0 : first, first, &this->Extinction, &this->Absorption,
        &this->SigmaSOnDevice(), &this->LampPath, &this->Nearness, &this->Passed, &this->Path });
  }
}

/// The lights' unscattered light is known: what of it is scattered is given to the medium, like what it shines itself.
void FusedSolver::LoadAccelerated(const Monitor& monitor)
{
  const std::size_t voxels = this->TheMedium.grid.VoxelCount();
  const double volume = this->TheMedium.grid.VoxelVolume();
  Device& device = this->TheDevice;
  this->Lamps = this->Path.Read();
  this->LampBalance = this->Result.balance;
  this->LampFaces = this->Result.facePowerOut;
  this->Nearness = {};
  this->LampPath = {};
  if (this->Flight)
  {
    this->AddFlightDifference(monitor);
  }
  std::vector<float> given = this->Source.Read();
  this->GivenPower = this->Result.balance.emitted;
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const std::size_t at = c * this->Stride + i;
      const double scattered = static_cast<double>(this->SigmaS(i, c)) * this->Lamps[at];
      given[at] += static_cast<float>(scattered / (4.0 * Pi * volume));
      this->LampBalance.absorbed[c] += static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Lamps[at];
      this->GivenPower[c] += scattered;
      this->Lamps[at] = static_cast<float>(this->Lamps[at] / volume);
    }
  }
  this->Given = Buffer<float>(device, given, "the light given");
  this->Entering =
    Buffer<float>(device, 6 * this->Stride * this->Channels + SweepPadding, "the power from voxel to voxel");
}

/// A quantity of the sweep and what lights add to it, planar.
std::vector<float> FusedSolver::WithLamps(const Buffer<float>& planar, double scale) const
{
  std::vector<float> values = planar.Read();
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = std::max(static_cast<float>(values[i] * scale + this->Lamps[i]), 0.0f);
  }
  return values;
}

/// From the source that is there to path and entering power. The light that comes in from outside comes in every time.
void FusedSolver::SweepAll(int sweepNumber, const Monitor& monitor)
{
  for (std::size_t c = 0; c < this->Systems.size(); ++c)
  {
    if (this->UnitPower(static_cast<int>(c)) > 0.0)
    {
      this->Systems[c]->WriteSource();
    }
  }
  this->Path.Fill(0.0f);
  this->Entering.Fill(0.0f);
  for (const std::unique_ptr<AxisSweep>& sweep : this->Sweeps)
  {
    sweep->Forget();
  }
  this->Result.balance = this->LampBalance;
  this->Result.facePowerOut = this->LampFaces;
  this->Shining = sweepNumber > 0 || this->Shining;
  this->PropagateSweeps(this->Sweeps, this->BoundaryOfOrder(0), ManyPlanes, monitor);
  this->OnTheWay = {};
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->FacePowerOut[face][c] = this->Result.facePowerOut[face][c] - this->LampFaces[face][c];
    }
  }
  // What went out is for the low-order system to say.
  for (int c = 0; c < this->Channels; ++c)
  {
    this->Result.balance.escaped[c] = this->LampBalance.escaped[c];
  }
  this->Result.facePowerOut = this->LampFaces;
}

void FusedSolver::MakeSystems()
{
  const Grid& grid = this->TheMedium.grid;
  const CrossingPattern pattern =
    FindCrossingPattern(grid, this->Directions, this->Settings.mapResolution, this->Starts(), this->Settings.periodic);
  const SweepBoundary boundary = this->BoundaryOfOrder(0);
  for (int c = 0; c < this->Channels; ++c)
  {
    std::array<double, 6> incoming = {};
    for (std::size_t d = 0; boundary && d < this->Directions.directions.size(); ++d)
    {
      const Direction& direction = this->Directions.directions[d];
      for (int axis = 0; axis < 3; ++axis)
      {
        const int face = 2 * axis + (direction.omega[axis] > 0.0 ? 0 : 1);
        if (!this->Settings.periodic[axis])
        {
          incoming[face] += direction.weight * std::abs(direction.omega[axis]) * boundary(static_cast<int>(d), face)[c];
        }
      }
    }
    this->PowerIn[c] = this->Result.balance.entered[c] - this->LampBalance.entered[c];
    const std::size_t first = c * this->Stride;
    const LowOrder::Arrays arrays = { this->Stride, this->SharedExtinction ? 0 : first, first, &this->Extinction,
      &this->Absorption, &this->SigmaSOnDevice(), &this->Given, &this->Source, &this->Path, &this->Entering,
      this->Passed.Size() > 0 ? &this->Passed : nullptr };
    this->Systems.push_back(std::make_unique<LowOrder>(
      this->TheDevice, grid, this->Settings.periodic, this->Directions, pattern, arrays, incoming, this->LinearSource));
  }
}

/// W of a voxel, about.
double FusedSolver::UnitPower(int c) const
{
  return (this->GivenPower[c] + this->PowerIn[c]) / static_cast<double>(this->TheMedium.grid.VoxelCount());
}

/// Solve for the light of each channel and estimate how far it is from the truth of an endless iteration: changes fall
/// off like a geometric series, so the rest of it is the change times q / (1 - q). The worst channel counts.
void FusedSolver::Correct(int sweep)
{
  double change = 0.0;
  for (int c = 0; c < this->Channels; ++c)
  {
    const double unit = this->UnitPower(c);
    if (unit > 0.0)
    {
      change = std::max(change, this->Systems[c]->Correct(unit));
    }
  }
  const double ratio = sweep > 0 && this->Change > 0.0 ? change / this->Change : 1.0;
  const double fall = std::clamp(sweep > 1 ? std::max(ratio, this->LastRatio) : ratio, 0.5, 0.95);
  this->Residual = sweep > 0 || change == 0.0 ? Margin * change * fall / (1.0 - fall) : 1.0;
  this->LastRatio = ratio;
  this->Change = change;
  this->CountLight();
  this->AddRow(sweep, change);
}

/// Where the power went, by the low-order system: it conserves energy.
void FusedSolver::CountLight()
{
  const Grid& grid = this->TheMedium.grid;
  this->Result.balance.absorbed = this->LampBalance.absorbed;
  this->Result.balance.escaped = this->LampBalance.escaped;
  this->Result.facePowerOut = this->LampFaces;
  this->Found.clear();
  for (int c = 0; c < this->Channels; ++c)
  {
    this->Result.balance.leftOver[c] = this->Stranded[c];
    if (!(this->UnitPower(c) > 0.0))
    {
      this->Found.emplace_back(grid.VoxelCount(), 0.0); // dark: never solved for
      continue;
    }
    this->Found.push_back(this->Systems[c]->Found());
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      this->Result.balance.absorbed[c] +=
        static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Found[c][i] * grid.VoxelVolume();
    }
    std::array<double, 6> ofSweep;
    for (int face = 0; face < 6; ++face)
    {
      ofSweep[face] = this->FacePowerOut[face][c];
    }
    const std::array<double, 6> outflow = this->Systems[c]->Outflow(ofSweep);
    for (int face = 0; face < 6; ++face)
    {
      this->Result.facePowerOut[face][c] += outflow[face];
      this->Result.balance.escaped[c] += outflow[face];
    }
  }
}

bool FusedSolver::DoneAccelerated(int sweeps) const
{
  const int most = this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : MostSweeps;
  return sweeps >= most || this->Residual == 0.0 ||
    (this->Settings.maximumOrders == 0 && sweeps > 2 && this->Residual <= this->Settings.tolerance);
}

/// Where the system found less than nothing, what the last sweep found stands.
void FusedSolver::UnloadAccelerated()
{
  for (int c = 0; c < this->Channels; ++c)
  {
    if (this->UnitPower(c) > 0.0)
    {
      this->Systems[c]->Refine(this->UnitPower(c));
    }
  }
  this->CountLight();
  const double perVolume = 1.0 / this->TheMedium.grid.VoxelVolume();
  const std::vector<float> path = this->Path.Read();
  std::vector<float> fluence(path.size(), 0.0f);
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      const std::size_t at = c * this->Stride + i;
      const double found = this->Found[c][i];
      const double swept = found >= 0.0 ? found : path[at] * perVolume;
      fluence[at] = std::max(static_cast<float>(swept + this->Lamps[at]), 0.0f);
    }
    if (this->Settings.netFlux && this->UnitPower(c) > 0.0)
    {
      this->Systems[c]->AddFlux(this->Flux);
    }
  }
  this->Fluence.Write(fluence.data());
  if (this->Settings.netFlux)
  {
    this->LimitFlux(fluence);
  }
  this->FindSurfaceRadiance();
}

/// Of thick voxels: there the system knows what a sweep does not.
void FusedSolver::FindSurfaceRadiance()
{
  std::vector<SurfacePowers> powers(this->LinearSource ? this->Channels : 0);
  for (std::size_t c = 0; c < powers.size(); ++c)
  {
    powers[c] = this->UnitPower(static_cast<int>(c)) > 0.0 ? this->Systems[c]->PowersAtSurface() : SurfacePowers();
    powers[c].lamps = this->Lamps.data() + c * this->Stride;
  }
  this->Result.surfaceRadiance = SurfaceRadiance(this->TheMedium, this->Settings.periodic, this->Lights, powers);
}

/// The mean of what goes through a voxel's faces is more than what flows in it where light dies away within it. No light flows
/// more than there is.
void FusedSolver::LimitFlux(const std::vector<float>& fluence)
{
  std::vector<float> flux = this->Flux.Read();
  const double volume = this->TheMedium.grid.VoxelVolume();
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t i = 0; i < this->TheMedium.grid.VoxelCount(); ++i)
    {
      float* const x = flux.data() + 3 * c * this->Stride + i;
      float* const y = x + this->Stride;
      float* const z = y + this->Stride;
      const double most = fluence[c * this->Stride + i] * volume;
      const double flows = std::hypot(*x, *y, *z);
      const auto part = static_cast<float>(flows > most ? most / flows : 1.0);
      *x *= part;
      *y *= part;
      *z *= part;
    }
  }
  this->Flux.Write(flux.data());
}
}
