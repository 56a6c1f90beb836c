#include "LightPropagation/Conservative/SourceIteration.h"

#include "Device/Sizes.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostOrders = 100000;
constexpr int FewPlanes = 256;        ///< round a periodic axis, where there will be more orders as long as it matters
constexpr double MostlyLit = 0.75;    ///< part of the rays from which on sweeps of their own do not pay
constexpr double MostlyFilled = 0.75; ///< the same of voxels
constexpr int OrdersExpected = 6;     ///< to tell whether it pays to sweep empty slabs at the end only
}

SourceIteration::SourceIteration(TransportParts& parts)
  : Parts(parts)
  , Settings(parts.Problem.Settings())
  , Shining(parts.HasSource())
{
  this->MakeSweeps();
}

IterationResult SourceIteration::Run(const Monitor& monitor)
{
  this->Parts.CountEmission(this->Result.ledger);
  do
  {
    const Monitor ofOrder =
      OfPart(monitor, [this](double done) { return ProgressOf(this->Settings, this->Residual, this->Order + done); });
    const double uncollided = this->Order == 0 ? UncollidedPart : 0.0;
    if (this->Order == 0)
    {
      this->AddUncollided(OfPart(ofOrder, 0.0, uncollided));
    }
    const bool scatteredShines = this->Shining && this->Order > 0;
    this->SweepOrder(OfPart(ofOrder, uncollided, 1.0));
    if (this->Escaping && scatteredShines)
    {
      const Rgb escaped = this->Escaping->Apply();
      for (int c = 0; c < 3; ++c)
      {
        this->Escaped[c] += escaped[c];
        this->Result.ledger.Escape(c, escaped[c]);
      }
    }
    this->ReflectOrder();
    this->ScatterOrder();
    Report(ofOrder, 1.0);
    ++this->Order;
    this->Lit.reset();
  } while (!this->Done());
  if (this->Filled && this->Order > 1)
  {
    this->SweepEmptySlabs(monitor);
  }
  this->Result.ledger.ShareEscaped(this->Escaped);
  this->Result.leftOut = this->LeftOut();
  if (this->Parts.Faces)
  {
    this->Result.leftByCell = this->Parts.Faces->LeftInAll();
  }
  return std::move(this->Result);
}

void SourceIteration::MakeSweeps()
{
  const int mostPlanes = this->Settings.maximumOrders > 0 ? MostPlanesAround : FewPlanes;
  SweepRequest request = { this->Parts.WholeDeposit(), this->Parts.AllRays(), {}, mostPlanes };
  request.angular = this->Parts.UsualValues();
  request.faceIn = this->Parts.LightByCells();
  this->Whole = this->Parts.MakeSweep(request);
  this->MakeFilledSweep();
  if (this->Settings.leaveOut && this->Parts.SweepsAreLit() && !this->Shining)
  {
    this->MakeLitSweep();
  }
}

/// Orders after the first go through the box that the medium fills alone: what leaves it does not come back. Their
/// light in the other voxels is found at the end, for all of them in one sweep. Not with periodic axes, whose rays
/// would be on the way in both; nor where the light that leaves through the faces' cells is wanted.
void SourceIteration::MakeFilledSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  const MediumTraits& traits = this->Parts.Problem.Traits();
  if (!this->Settings.leaveOut || !traits.scatters || !this->Parts.Scattering->CanScatterAllOrders() || periodic[0] ||
    periodic[1] || periodic[2] || this->Parts.Faces)
  {
    return;
  }
  const double filled =
    static_cast<double>(traits.filled.VoxelCount()) / static_cast<double>(this->Parts.Layout.grid.VoxelCount());
  const int later = (this->Settings.maximumOrders > 0 ? this->Settings.maximumOrders : OrdersExpected) - 1;
  if (filled < MostlyFilled && later * (1.0 - filled) > 1.0)
  {
    // No flux: it comes from the sweep at the end.
    this->Filled =
      this->Parts.MakeSweep({ { &this->Parts.Path, nullptr, nullptr, nullptr }, this->Parts.AllRays(), traits.filled });
  }
}

/// Of the directions alone from which light comes. Those of a periodic axis stay as they are: rays wait in them for the
/// next order.
void SourceIteration::MakeLitSweep()
{
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  if (periodic[0] || periodic[1] || periodic[2])
  {
    return;
  }
  const auto isLit = [this](int direction) { return this->Parts.UsualBoundary->IsLit(direction); };
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
    SweepRequest request = { this->Parts.WholeDeposit(), ways };
    request.angular = this->Parts.UsualValues();
    this->Lit = this->Parts.MakeSweep(request);
  }
}

void SourceIteration::AddUncollided(const Monitor& monitor)
{
  TransportParts::Sources sources = this->Parts.LampSources();
  if (this->Parts.FineBoundary)
  {
    sources.push_back(std::make_unique<UncollidedBoundary>(this->Settings, *this->Parts.FineBoundary));
  }
  for (std::unique_ptr<UncollidedSource>& peak : this->Parts.BrightEmissionSources())
  {
    sources.push_back(std::move(peak));
  }
  const bool escapes = this->Parts.Fine && this->Parts.Problem.Traits().scatters && !this->Parts.FacesReflect();
  const double all = static_cast<double>(sources.size() + (escapes ? 1 : 0));
  SweepTally tally;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const Monitor ofSource = OfPart(monitor, i / all, (i + 1) / all);
    Add(tally, this->Parts.AddUncollided(*sources[i], this->Parts.WholeDeposit(), ofSource));
  }
  this->Result.ledger.Count(tally);
  this->Stranded = tally.onTheWay;
  if (this->Parts.Faces)
  {
    this->Parts.Faces->TakeUncollided();
  }
  if (escapes)
  {
    this->Escaping.emplace(this->Parts, OfPart(monitor, sources.size() / all, 1.0)); // whatever shines: lights add up
  }
}

void SourceIteration::SweepOrder(const Monitor& monitor)
{
  const SweepBoundary boundary = this->Order == 0 ? this->Parts.BoundaryOfSweeps() : SweepBoundary();
  const bool nothing = !boundary && !this->Shining && Sum(this->OnTheWay) == 0.0 && Sum(this->Reflected) == 0.0;
  this->OnTheWay = {};
  if (nothing)
  {
    return;
  }
  const Buffer<float>* const source = this->Shining ? &this->Parts.Source : nullptr;
  SweepOperator& sweep = this->InFilledPart() ? *this->Filled : this->Lit ? *this->Lit : *this->Whole;
  const SweepTally tally = sweep.Apply(source, boundary, monitor);
  this->OnTheWay = tally.onTheWay;
  if (this->Order > 0)
  {
    this->Parts.DarkenBeams(); // they are first scattered once
  }
  if (!this->InFilledPart())
  {
    this->Result.ledger.Count(tally);
    return;
  }
  for (int c = 0; c < 3; ++c) // through which of the box's faces is not known yet
  {
    for (const Rgb& face : tally.out)
    {
      this->Result.ledger.Escape(c, face[c]);
    }
  }
}

/// What faces give back of the light that left in this order has not left.
void SourceIteration::ReflectOrder()
{
  this->Reflected = {};
  if (!this->Parts.Faces)
  {
    return;
  }
  const std::array<Rgb, 6> back = this->Parts.Faces->Reflect();
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Reflected[c] += back[face][c];
      this->Result.ledger.Escape(c, face, -back[face][c]);
    }
  }
}

/// The values of a channel that a sweep may have changed: whole vectors.
std::array<std::size_t, 2> SourceIteration::SweptValues() const
{
  if (!this->InFilledPart())
  {
    return { 0, this->Parts.Layout.Stride() };
  }
  const std::array<int, 3>& n = this->Parts.Layout.grid.size;
  const std::size_t layer = static_cast<std::size_t>(n[0]) * n[1];
  const VoxelBox& filled = this->Parts.Problem.Traits().filled;
  return { layer * filled.first[2] / SweepPadding * SweepPadding,
    RoundUp(layer * (filled.first[2] + filled.size[2]), SweepPadding) };
}

void SourceIteration::ScatterOrder()
{
  const TransportParts& parts = this->Parts;
  const ScatteringOperator::Powers powers =
    parts.Scattering->ScatterOrder(parts.WholeDeposit(), parts.Fluence, parts.Source, this->SweptValues());
  this->Scattered = powers.scattered;
  for (int c = 0; c < 3; ++c)
  {
    this->Result.ledger.Absorb(c, powers.absorbed[c]);
    this->Result.ledger.LeaveOver(c, this->Scattered[c] + this->OnTheWay[c] + this->Reflected[c] + this->Stranded[c]);
  }
  this->Shining = Sum(this->Scattered) > 0.0;
  this->EstimateResidual();
  if (this->Order == 0)
  {
    this->Result.fluenceDirect = Interleaved(this->Parts.Layout, this->Parts.Fluence, 1.0);
  }
  const double all = Sum(this->AllScattered);
  this->Result.convergence.Add(this->Residual, all > 0.0 ? Sum(this->Scattered) / all : 0.0, this->Result.ledger);
}

/// What the orders to come will add to the light that is scattered, over what there is: the rest of a geometric series
/// (numerics.md, Eq. (43)). The worst channel counts.
void SourceIteration::EstimateResidual()
{
  this->Residual = 0.0;
  for (int c = 0; c < this->Parts.Layout.channels; ++c)
  {
    const double now = this->Scattered[c] + this->OnTheWay[c] + this->Reflected[c];
    this->AllScattered[c] += now;
    if (now == 0.0)
    {
      continue;
    }
    const double ratio = this->Order > 0 ? now / this->LastScattered[c] : 1.0;
    const double growth = this->Order > 1 ? std::max(0.0, ratio - this->Ratio[c]) : 0.0;
    const double limit = std::min(ratio + growth, 1.0 - 1e-9);
    this->Residual = std::max(this->Residual, now / this->AllScattered[c] * limit / (1.0 - limit));
    this->Ratio[c] = ratio;
    this->LastScattered[c] = now;
  }
  // One order does not show how fast they fall.
  this->Residual = this->Order == 0 ? std::min(this->Residual, 1.0) : this->Residual;
}

bool SourceIteration::Done() const
{
  if (this->Residual == 0.0 || this->Order >= MostOrders)
  {
    return true;
  }
  return this->Settings.maximumOrders > 0 ? this->Order >= this->Settings.maximumOrders
                                          : this->Order > 2 && MeetsTolerance(this->Settings, this->Residual);
}

/// Light of the orders after the first in the voxels around the medium, and the faces that it leaves through: one sweep
/// of all that was scattered but what the last order left over (numerics.md, Eq. (44)).
void SourceIteration::SweepEmptySlabs(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  parts.Scattering->ScatterAllOrders(parts.Fluence, parts.Source);
  const SweepTally tally = this->Whole->Apply(&parts.Source, {}, monitor);
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->Result.ledger.AssignFace(c, face, tally.out[face][c]);
    }
  }
  this->AddOutside(parts.Problem.Traits().filled);
}

/// To fluence what a sweep left in the voxels outside a box.
void SourceIteration::AddOutside(const VoxelBox& box)
{
  const TransportParts& parts = this->Parts;
  const VolumeLayout& layout = parts.Layout;
  cl::Kernel add = parts.TheDevice.Kernel("add_outside", kernel_source::SourceIteration);
  const std::array<int, 3>& n = layout.grid.size;
  With(add, parts.Path, parts.Fluence, cl_ulong(layout.Stride()), static_cast<float>(1.0 / layout.grid.VoxelVolume()),
    cl_int3{ { n[0], n[1], n[2] } }, cl_int3{ { box.first[0], box.first[1], box.first[2] } },
    cl_int3{ { box.size[0], box.size[1], box.size[2] } });
  parts.TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
}

std::vector<std::string> SourceIteration::LeftOut() const
{
  std::vector<std::string> words;
  if (this->Filled)
  {
    words.push_back(left_out::EmptySlabs(this->Parts.Problem.Traits().filled, this->Parts.Layout.grid));
  }
  if (this->LitPart < 1.0)
  {
    words.push_back(left_out::DarkDirections(this->LitPart));
  }
  return words;
}
}
