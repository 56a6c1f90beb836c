#include "LightPropagation/Conservative/OrderSweeps.h"

#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Light/LeftOut.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
/// Largest number of planes of voxels that a ray crosses in one sweep while it wraps around a periodic axis, if another
/// scattering order will continue it.
constexpr int FewPlanes = 256;
constexpr double MostlyLit = 0.75; ///< fraction of rays with incident light above which the first order sweeps all rays
/// Fraction of voxels in the medium's bounding box above which all orders sweep the whole grid.
constexpr double MostlyFilled = 0.75;
/// Number of scattering orders assumed in the decision whether later sweeps omit the empty voxels around the medium, if
/// the settings set no limit.
constexpr int OrdersExpected = 6;

/// Fraction of the domain's voxels without medium. Collective.
double PartWithoutMedium(const PropagationProblem& problem)
{
  const Domain& domain = problem.TheDomain();
  const Medium& medium = problem.TheMedium();
  const double filled = SumInThreads(domain.Own().VoxelCount(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
    {
      float sigma_t = 0.0f;
      for (int c = 0; c < 3; ++c)
      {
        sigma_t += medium.sigma_a.At(i, c) + medium.sigma_s.At(i, c);
      }
      sum += sigma_t > 0.0f ? 1.0 : 0.0;
    }
    return sum;
  });
  return 1.0 - domain.Sum(filled) / static_cast<double>(domain.Whole().VoxelCount());
}
}

bool PaysToOmitEmptySlabs(const VoxelBox& filled, const Grid& grid, const PropagationSettings& settings)
{
  const double part = static_cast<double>(filled.VoxelCount()) / static_cast<double>(grid.VoxelCount());
  const int later = (settings.maximumOrders > 0 ? settings.maximumOrders : OrdersExpected) - 1;
  return settings.leaveOut && !settings.IsPeriodic() && part < MostlyFilled && later * (1.0 - part) > 1.0;
}

OrderSweeps::OrderSweeps(
  TransportParts& parts, const Deposit& deposit, const Buffer<float>* octantSource, bool byCells, bool shines)
  : Parts(parts)
{
  const PropagationSettings& settings = parts.Problem.Settings();
  // With coarse-mesh DSA a ray is followed around periodic axes to its end in one sweep: the coarse solution does not
  // include the light of rays that wait for the next sweep.
  const bool wholeWay = settings.maximumOrders > 0 || byCells;
  SweepRequest request = { deposit, parts.AllRays(), {}, wholeWay ? MostPlanesAround : FewPlanes };
  request.octantSource = octantSource;
  request.angular = parts.UsualValues();
  request.faceIn = parts.LightByCells();
  request.skipsEmpty = settings.leaveOut && settings.alongRays && !deposit.flux && !deposit.partialCurrents;
  // a rank without voxels has no values of angular functions
  if (parts.TheDomain().Any(request.skipsEmpty && request.angular && parts.TheDevice.IsCpu()))
  {
    this->EmptyPart = PartWithoutMedium(parts.Problem);
  }
  this->Whole = parts.Scattered.make(request);
  if (!octantSource && !byCells && this->MayOmitEmptySlabs())
  {
    // This sweep does not sum the net flux. The final sweep, through the whole grid (SweepEmptySlabs), sums that of all
    // orders after the first.
    this->Filled = parts.Scattered.make(
      { { &parts.Path, nullptr, nullptr, nullptr }, parts.AllRays(), parts.Problem.Traits().filled });
  }
  const bool reflects = !settings.alongRays && parts.FacesReflect();
  if (settings.leaveOut && parts.Lights.SweepCarriesBoundarySource() && !shines && !settings.IsPeriodic() && !reflects)
  {
    this->MakeLitSweep(deposit);
  }
}

/// Whether later orders sweep only the bounding box of the medium, since light that leaves it does not return. False if
/// light by cell of the box faces is needed, which the final sweep does not compute.
bool OrderSweeps::MayOmitEmptySlabs() const
{
  const PropagationSettings& settings = this->Parts.Problem.Settings();
  const MediumTraits& traits = this->Parts.Problem.Traits();
  return this->Parts.Transport.SweepsParts() && traits.scatters && this->Parts.Scattering->CanScatterAllOrders() &&
    !this->Parts.Faces && PaysToOmitEmptySlabs(traits.filled, this->Parts.Layout.grid, settings);
}

/// Makes the sweep of the first order along directions with incident light only, if these directions are few. Not used
/// with periodic axes, where rays of all directions carry light on to the next order.
void OrderSweeps::MakeLitSweep(const Deposit& deposit)
{
  const auto isLit = [this](int direction) { return this->Parts.Lights.UsualBoundary->IsLit(direction); };
  double all = 0.0, lit = 0.0;
  std::vector<AxisBundles> ways;
  for (int axis = 0; axis < 3; ++axis)
  {
    all += CountRays(this->Parts.Usual.Along(axis));
    for (int way = 0; way < 2; ++way)
    {
      ways.push_back({ axis, this->Parts.Usual.LitAlong(axis, way, isLit) });
      lit += CountRays(ways.back().bundles);
    }
  }
  if (lit <= MostlyLit * all)
  {
    this->LitPart = lit / all;
    SweepRequest request = { deposit, ways };
    request.angular = this->Parts.UsualValues();
    request.skipsEmpty = !deposit.flux && !deposit.partialCurrents;
    if (this->Parts.Problem.Settings().alongRays) // discrete ordinates: the operator Whole omits dark directions
    {
      this->Lit = this->Parts.Transport.MakeSweep(request);
    }
  }
}

SweepOperator& OrderSweeps::Of(int order)
{
  return this->OmitsEmptySlabs(order) ? *this->Filled : this->Lit ? *this->Lit : *this->Whole;
}

std::array<std::size_t, 2> OrderSweeps::Values(int order) const
{
  if (!this->OmitsEmptySlabs(order))
  {
    return { 0, this->Parts.Layout.Stride() };
  }
  const std::array<int, 3>& n = this->Parts.Layout.grid.size;
  const std::size_t layer = static_cast<std::size_t>(n[0]) * n[1];
  const VoxelBox& filled = this->Parts.Problem.Traits().filled;
  return { layer * filled.first[2] / SweepPadding * SweepPadding,
    RoundUp(layer * (filled.first[2] + filled.size[2]), SweepPadding) };
}

/// The source of the final sweep is the sum of the sources of all orders that were swept (numerics.md, Eq. (44)).
void OrderSweeps::SweepEmptySlabs(EnergyLedger& ledger, const Monitor& monitor)
{
  if (!this->Filled)
  {
    return;
  }
  TransportParts& parts = this->Parts;
  parts.Scattering->ScatterAllOrders(parts.Fluence, parts.Source);
  const SweepTally tally = this->Whole->Apply(&parts.Source, {}, monitor);
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      ledger.AssignFace(c, face, tally.out[face][c]);
    }
  }
  this->AddOutside(parts.Problem.Traits().filled);
}

/// Adds the path integrals of the final sweep, which computes the light of later orders around the medium, to the
/// fluence of the voxels outside `box`.
void OrderSweeps::AddOutside(const VoxelBox& box)
{
  const TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  cl::Kernel add =
    parts.TheDevice.Kernel("add_outside", kernel_source::SourceIteration, SummingOption(parts.TheDevice));
  const std::array<int, 3>& n = layout.grid.size;
  With(add, parts.Path, parts.Fluence, cl_ulong(layout.Stride()), static_cast<float>(1.0 / layout.grid.VoxelVolume()),
    cl_int3{ { n[0], n[1], n[2] } }, cl_int3{ { box.first[0], box.first[1], box.first[2] } },
    cl_int3{ { box.size[0], box.size[1], box.size[2] } });
  parts.TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
}

std::vector<std::string> OrderSweeps::LeftOut() const
{
  std::vector<std::string> words;
  if (this->Filled)
  {
    words.push_back(left_out::EmptySlabs(this->Parts.Problem.Traits().filled, this->Parts.Layout.grid));
  }
  if (this->EmptyPart > 0.0)
  {
    words.push_back(left_out::EmptyMoments(this->EmptyPart));
  }
  if (this->LitPart < 1.0)
  {
    words.push_back(left_out::DarkDirections(this->LitPart));
  }
  return words;
}
}
