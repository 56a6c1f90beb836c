#include "DiscreteOrdinates/Published/PublishedOrders.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/ChannelArrays.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Medium/BoxFaces.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostSteps = 10000;
/// The radiance grows without bound if a step changes it by more than this factor times the change by the first step.
constexpr double WithoutEnd = 1e4;

/// One explicit step of the radiance along every direction, whose length is the shortest voxel edge (Gong et al., Eqs.
/// (7) and (9)). The paper does not specify interpolation between voxels; here it is trilinear. If sigma_t times the
/// step is above 1, radiance becomes negative; above 2 it diverges (numerics.md, Eq. (D13)).
class ExplicitStep
{
public:
  ExplicitStep(Device& device, const Grid& grid, const OrdinateGroups& groups, const IncomingRadiance& incoming,
    const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , TheGrid(grid)
    , Groups(groups)
    , Periodic(periodic)
    , Step(*std::min_element(grid.spacing.begin(), grid.spacing.end()))
  {
    std::vector<float> parts, outside;
    std::vector<cl_int> up;
    for (int g = 0; g < groups.Count(); ++g)
    {
      for (int a = 0; a < 3; ++a)
      {
        const int face = EntryFace(a, groups.All()[g].up[a]);
        up.push_back(groups.All()[g].up[a]);
        for (int lane = 0; lane < OrdinateLanes; ++lane)
        {
          const double radiance = incoming && !periodic[a] ? incoming(groups.All()[g].direction[lane], face) : 0.0;
          this->Entering[face] += this->Across(g, lane, a) * radiance * grid.VoxelCount() / grid.size[a];
          parts.push_back(static_cast<float>(std::abs(groups.Of(g, lane).omega[a]) * this->Step / grid.spacing[a]));
          outside.push_back(static_cast<float>(radiance));
        }
      }
    }
    this->Parts = Buffer<float>(device, parts, "the directions");
    this->Incoming = Buffer<float>(device, outside, "light through the faces");
    this->Up = Buffer<cl_int>(device, up, "the directions");
  }

  /// Takes the step.
  /// @param radiance  radiance before the step; overwritten with scratch values
  /// @param scattered, steady  sources, W / (length^3 sr)
  /// @param after  receives the radiance after the step
  void Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t, const Buffer<float>& after) const
  {
    const cl::NDRange all(this->TheGrid.VoxelCount(), this->Groups.Count());
    const cl_ulong stride = OrdinateStride(this->TheGrid.VoxelCount());
    cl::Kernel change = this->Kernel("change_radiance");
    With(change, radiance, scattered, steady, sigma_t, static_cast<float>(this->Step), stride);
    this->TheDevice.Queue().enqueueNDRangeKernel(change, cl::NullRange, all);
    const cl_int periodic = this->Periodic[0] + 2 * this->Periodic[1] + 4 * this->Periodic[2];
    cl::Kernel move = this->Kernel("move_on");
    With(move, radiance, after, this->Parts, this->Up, this->Incoming, Int4(this->TheGrid.size), stride, periodic);
    this->TheDevice.Queue().enqueueNDRangeKernel(move, cl::NullRange, all);
    this->TheDevice.Finish();
  }

  /// Incident and outgoing power of a step through each face, W.
  FacePowers Powers(const Buffer<float>& radiance) const
  {
    FacePowers powers;
    powers.in = this->Entering;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<float> sums = this->Periodic[axis] ? std::vector<float>() : this->SumsLeaving(radiance, axis);
      const std::size_t rows = this->TheGrid.size[AcrossAxis(axis).v];
      for (std::size_t i = 0; i < sums.size(); ++i)
      {
        const int g = static_cast<int>(i / OrdinateLanes / rows), lane = i % OrdinateLanes;
        powers.out[EntryFace(axis, !this->Groups.All()[g].up[axis])] += this->Across(g, lane, axis) * sums[i];
      }
    }
    return powers;
  }

private:
  cl::Kernel Kernel(const char* name) const { return this->TheDevice.Kernel(name, kernel_source::PublishedOrders, ""); }

  /// Power that a radiance of 1 W / (length^2 sr) along a direction (at place `lane`, 0 to 7, of its group) carries
  /// through a voxel face perpendicular to `axis`, W.
  double Across(int group, int lane, int axis) const
  {
    return this->Groups.Weight(group, lane) * std::abs(this->Groups.Of(group, lane).omega[axis]) *
      this->TheGrid.VoxelVolume() / this->TheGrid.spacing[axis];
  }

  /// For each group of directions: radiance in the voxels at the face through which these directions leave the box (the
  /// face perpendicular to `axis`), summed along each row of the face.
  std::vector<float> SumsLeaving(const Buffer<float>& radiance, int axis) const
  {
    const std::array<std::size_t, 3> strides = this->TheGrid.Strides();
    const PlaneAxes across = AcrossAxis(axis);
    const std::size_t rows = this->TheGrid.size[across.v];
    Buffer<float> sums(this->TheDevice, this->Groups.Lanes() * rows, "sums");
    cl::Kernel sum = this->Kernel("sum_leaving");
    With(sum, radiance, sums, this->Up, cl_ulong(OrdinateStride(this->TheGrid.VoxelCount())), axis,
      cl_ulong(strides[axis] * (this->TheGrid.size[axis] - 1)), cl_ulong(strides[across.v]),
      cl_ulong(strides[across.u]), this->TheGrid.size[across.u]);
    this->TheDevice.Queue().enqueueNDRangeKernel(sum, cl::NullRange, cl::NDRange(rows, this->Groups.Count()));
    return sums.Read();
  }

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  const std::array<bool, 3> Periodic;
  double Step;
  std::array<double, 6> Entering = {};
  Buffer<float> Parts, Incoming;
  Buffer<cl_int> Up;
};

PairSums SumsOfSteps(const OrdinatesSettings& settings)
{
  return settings.scattering == OrdinatesScattering::Matrix ? PairSums::Passes : PairSums::Terms;
}

class PublishedOrders
{
public:
  PublishedOrders(
    Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
    : Scene(scene)
    , Angles(angles)
    , Settings(settings)
    , Arrays(device, scene, angles, settings.netFlux)
    , Step(device, scene.medium.grid, angles.groups, scene.incoming, settings.periodic)
    , Scattering(
        device, angles.groups, angles.phase, SumsOfSteps(settings), false, settings.netFlux, this->Arrays.Voxels)
    , Radiance(device, AngularScattering::Floats(angles.groups, this->Arrays.Voxels), "radiance of all directions")
    , Scattered(device, this->Radiance.Size(), "scattered light of all directions")
    , Steady(device, this->Radiance.Size(), "sources of all directions")
    , Fluence(this->Arrays.Voxels)
  {
    for (Buffer<float>* field : { &this->Radiance, &this->Scattered, &this->Steady })
    {
      field->Fill(0.0f);
    }
  }

  OrdinatesResult Run(const Monitor& monitor)
  {
    this->AddSteadySources(OfPart(monitor, 0.0, 0.1));
    do
    {
      this->Step.Apply(this->Radiance, this->Scattered, this->Steady, this->Arrays.SigmaT, this->Scattered);
      this->Radiance.Swap(this->Scattered);
      const double done = static_cast<double>(this->Record.All().size()) / (this->Record.All().size() + 20.0);
      const double share = 0.1 + 0.9 * done;
      Report(monitor, share);
      this->Scatter(monitor ? Monitor([&](double) { return monitor(share); }) : Monitor());
    } while (!this->Done());
    this->Finish();
    return std::move(this->Result);
  }

private:
  void AddSteadySources(const Monitor& monitor)
  {
    if (this->Arrays.Emits())
    {
      this->Arrays.EmitEvenly(this->Steady, this->Result.ledger);
    }
    this->Arrays.AddLamps(this->Steady, this->Settings.periodic, this->Result, monitor);
    this->OfSources = this->Result.ledger;
    this->LampFluence = this->Arrays.Direct.Read();
    this->LampFlux = this->Arrays.Light.flux.Read();
  }

  /// Computes the scattering source of the next step, and the powers after this step.
  void Scatter(const Monitor& monitor)
  {
    this->Scattering.Scatter(
      this->Radiance, this->Arrays.SigmaS, this->Scattered, this->Arrays.Scale, this->Arrays.Light, monitor);
    const std::vector<float> now = this->Arrays.Light.order.Read();
    this->Change = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      this->Change += std::abs(static_cast<double>(now[i]) - this->Fluence[i]);
    }
    this->FirstChange = this->Record.All().empty() ? this->Change : this->FirstChange;
    if (!(this->Change <= WithoutEnd * this->FirstChange))
    {
      this->RefuseGrowth();
    }
    this->Fluence = now;
    this->CountSteady();
    this->Record.Add(this->Change, this->Result.ledger);
  }

  void CountSteady()
  {
    this->Result.ledger = this->OfSources;
    const FacePowers powers = this->Step.Powers(this->Radiance);
    for (int face = 0; face < 6; ++face)
    {
      this->Result.ledger.Enter(0, powers.in[face]);
      this->Result.ledger.Escape(0, face, powers.out[face]);
    }
    this->Result.ledger.Absorb(0,
      this->Arrays.PowersOf(this->Fluence, false).absorbed + this->Arrays.PowersOf(this->LampFluence, true).absorbed);
    this->Result.ledger.SetUnaccounted(0, this->Arrays.Stranded());
  }

  /// Throws the error of a radiance that grows without bound.
  [[noreturn]] void RefuseGrowth() const
  {
    throw InvalidInput("The light grows without end, and was stopped after " +
      std::to_string(this->Record.All().size() + 1) +
      " steps. Explicit steps as published are stable where sigma_t times the step, the shortest edge of a voxel, is "
      "at most 1 (here up to " +
      Text("%.3g", ThickestStep(this->Scene.medium, this->Scene.channel)) +
      "), and where the phase function scatters no more than comes (along these directions up to " +
      Text("%.3g", this->Angles.phase.LargestPower()) +
      " times of it). Choose the conservative scheme, more directions or smaller voxels.");
  }

  bool Done() const
  {
    const int steps = static_cast<int>(this->Record.All().size());
    if (this->Change == 0.0 || steps >= MostSteps)
    {
      return true;
    }
    return this->Settings.maximumOrders > 0 ? steps >= this->Settings.maximumOrders
                                            : steps > 3 && this->Record.Residual() <= this->Settings.tolerance;
  }

  void Finish()
  {
    if (this->Settings.netFlux)
    {
      // discards the net flux summed over all steps; only that of the last step is wanted
      this->Arrays.Light.flux.Fill(0.0f);
      this->Scattering.Gather(this->Radiance, this->Arrays.Light, {});
    }
    this->Arrays.Read(this->Result);
    this->Result.fluence = this->Fluence;
    this->Result.direct = this->LampFluence;
    for (std::size_t i = 0; i < this->LampFluence.size(); ++i)
    {
      this->Result.fluence[i] += this->LampFluence[i];
    }
    for (std::size_t i = 0; i < this->LampFlux.size(); ++i)
    {
      this->Result.flux[i] += this->LampFlux[i];
    }
    this->Result.convergence = std::move(this->Record.All());
  }

  const OrdinatesScene& Scene;
  const OrdinatesAngles& Angles;
  const OrdinatesSettings& Settings;
  ChannelArrays Arrays;
  ExplicitStep Step;
  AngularScattering Scattering;
  Buffer<float> Radiance, Scattered, Steady;
  std::vector<float> Fluence, LampFluence, LampFlux;
  EnergyLedger OfSources; ///< power of lamps and emission
  OrdinatesRecord Record;
  OrdinatesResult Result;
  double Change = 0.0, FirstChange = 0.0;
};
}

OrdinatesResult SolvePublishedOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor)
{
  return PublishedOrders(device, scene, angles, settings).Run(monitor);
}

std::size_t BytesOfPublishedOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
{
  const std::size_t voxels = grid.VoxelCount();
  return sizeof(float) * 3 * AngularScattering::Floats(angles.groups, voxels) +
    ChannelArrays::Bytes(grid, settings.netFlux) +
    AngularScattering::Bytes(angles.groups, angles.phase.Terms(), SumsOfSteps(settings), voxels);
}

double ThickestStep(const Medium& medium, int channel)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    largest = std::max(largest, static_cast<double>(medium.sigma_a.At(i, channel)) + medium.sigma_s.At(i, channel));
  }
  return largest * *std::min_element(medium.grid.spacing.begin(), medium.grid.spacing.end());
}
}
