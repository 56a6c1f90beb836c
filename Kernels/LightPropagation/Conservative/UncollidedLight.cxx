#include "LightPropagation/Conservative/UncollidedLight.h"

#include "LightPropagation/Diffusion/LampPassing.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Scattering/MomentScattering.h"
#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>

namespace tyndall
{
namespace
{
double Ratio(double of, double to)
{
  return to > 0.0 ? of / to : 1.0;
}
}

UncollidedLight::UncollidedLight(TransportParts& parts, const Monitor& monitor)
  : Parts(parts)
  , TheMedium(parts.Problem.TheMedium())
  , LinearSource(parts.Problem.HasLinearSource())
{
  parts.CountEmission(this->Counted);
  const double sources = parts.FineBoundary ? 0.5 : 1.0; // of the time
  this->AddSources(OfPart(monitor, 0.0, sources));
  if (parts.Basis && parts.Problem.Settings().netFlux)
  {
    AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), parts.Path, parts.Flux);
  }
  this->Counted.Count(this->OfSources);
  this->Lengths = parts.Path.Read();
  if (parts.FineBoundary)
  {
    this->AddBoundaryDifference(OfPart(monitor, sources, 1.0));
  }
  this->CountAbsorbed();
}

/// In thick voxels it matters where lamps' light is first scattered.
bool UncollidedLight::NeedsFirstMoments() const
{
  return this->LinearSource && !this->Parts.Lamps.empty() &&
    AnyVoxelIsThickerThan(ThickForFirstMoments, this->TheMedium);
}

/// Lamps and bright emission, into the arrays of all sources.
void UncollidedLight::AddSources(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  Buffer<float> firstMoments, path; // of one lamp
  if (this->NeedsFirstMoments())
  {
    firstMoments = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), "light of lamps");
    path = Buffer<float>(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "light of lamps");
    this->ThroughFaces = Buffer<float>(parts.TheDevice, parts.Layout.Floats(6), "light of lamps");
    this->ThroughFaces.Fill(0.0f);
  }
  const TransportParts::Sources lamps = parts.LampSources();
  TransportParts::Sources others = parts.OtherSources();
  for (std::unique_ptr<UncollidedSource>& vacuum : parts.VacuumSources())
  {
    others.push_back(std::move(vacuum));
  }
  std::size_t done = 0;
  const auto monitorOfNext = [&] {
    const double all = static_cast<double>(lamps.size() + others.size());
    ++done;
    return OfPart(monitor, (done - 1) / all, done / all);
  };
  for (const std::unique_ptr<UncollidedSource>& lamp : lamps)
  {
    if (firstMoments.Size() == 0)
    {
      Add(this->OfSources, parts.AddUncollided(*lamp, parts.WholeDeposit(), monitorOfNext()));
      continue;
    }
    firstMoments.Fill(0.0f);
    path.Fill(0.0f);
    const Deposit whole = parts.WholeDeposit();
    const Deposit ofLamp = { &path, whole.flux, nullptr, &firstMoments, whole.faceOut, whole.spreadsAside };
    Add(this->OfSources, parts.AddUncollided(*lamp, ofLamp, monitorOfNext()));
    this->PassFaces(path, firstMoments);
    if (parts.Basis)
    {
      AddMoments(parts.TheDevice, parts.Layout, parts.Functions(), path, parts.Path);
    }
  }
  if (!lamps.empty())
  {
    this->LengthsOfLamps = parts.Path.Read();
  }
  for (const std::unique_ptr<UncollidedSource>& other : others)
  {
    Add(this->OfSources, parts.AddUncollided(*other, parts.WholeDeposit(), monitorOfNext()));
  }
}

/// Adds the part of a lamp's light that passes voxels' faces at once where it is first scattered.
void UncollidedLight::PassFaces(const Buffer<float>& path, const Buffer<float>& firstMoments)
{
  const TransportParts& parts = this->Parts;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    const std::size_t first = c * parts.Layout.Stride();
    PassLampLight(parts.TheDevice, parts.Layout.grid, parts.Problem.Settings().periodic,
      { parts.Layout.Stride(), parts.Layout.ExtinctionFirst(c), first, &parts.OnDevice.TransportSigmaT(),
        &parts.OnDevice.SigmaA(), &parts.OnDevice.SigmaS(), &parts.OnDevice.SigmaT(), &path, &firstMoments,
        &this->ThroughFaces, &parts.Path });
  }
}

Buffer<float> UncollidedLight::ScatteredInVoxels() const
{
  const VolumeLayout& layout = this->Parts.Layout;
  const std::vector<float> passed = this->ThroughFaces.Read();
  const auto scattered = [&](std::size_t i, int c) {
    double power = this->Parts.Problem.Scattering().SigmaS(i, c) * this->LengthsOfLamps[c * layout.Stride() + i];
    for (int d = 0; d < 6; ++d)
    {
      power -= passed[(6 * c + d) * layout.Stride() + i];
    }
    return static_cast<float>(power / (4.0 * Pi * layout.grid.VoxelVolume()));
  };
  return PlanarOnDevice(this->Parts.TheDevice, layout, layout.channels, scattered, "light of lamps");
}

/// Weight of the difference of finer and usual directions (numerics.md, Eqs. (55), (76)): little in thick voxels, where
/// it matters at which depth light is scattered, which the diffusion system has for the light in sweeps alone.
double UncollidedLight::PartOfDifference(std::size_t voxel, int channel) const
{
  const std::array<double, 3>& h = this->TheMedium.grid.spacing;
  const double longest = *std::max_element(h.begin(), h.end());
  const double tau = longest * this->TheMedium.TransportSigmaT(voxel, channel);
  const double absorbing = longest * this->TheMedium.sigma_a.At(voxel, channel);
  // As the system weighs what sweeps find.
  return this->LinearSource ? 1.0 / (1.0 + tau * (0.25 * tau + 3.0 * absorbing)) : 1.0;
}

/// Sweeps carry all light from outside along the usual directions, as the diffusion system needs it. The difference
/// that finer ones make to it before it is scattered is added like the light of lamps (numerics.md, Eq. (76)): where
/// light is scattered many times, and along directions that nobody asked for, scaled in each voxel so that power is
/// as in the sweeps and an even sky stays even, else scaled by the power that enters. Power that this adds to voxels
/// or takes from them is made up for by what leaves the box.
void UncollidedLight::AddBoundaryDifference(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const PropagationSettings& settings = parts.Problem.Settings();
  const auto fine = parts.FindUncollided(UncollidedBoundary(settings, *parts.FineBoundary), OfPart(monitor, 0.0, 0.4));
  const BoundaryLight alongUsual = parts.FinePartAlongUsual();
  const auto usual = parts.FindUncollided(UncollidedBoundary(settings, alongUsual), OfPart(monitor, 0.4, 0.5));
  const bool staysEven = settings.uncollidedDirections < 0 || ScatteredManyTimes(parts.Problem);
  const TransportParts::EvenSky even =
    staysEven ? parts.FindEvenSky(OfPart(monitor, 0.5, 1.0)) : TransportParts::EvenSky();
  std::vector<float> flux = parts.Problem.Settings().netFlux ? parts.Flux.Read() : std::vector<float>();
  const std::size_t stride = parts.Layout.Stride();
  const MomentPlaces places = parts.Layout.Places(parts.Functions());
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    double more = 0.0, out = 0.0, in = 0.0, usualIn = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      in += fine.tally.in[face][c];
      usualIn += usual.tally.in[face][c];
    }
    const double whole = Ratio(usualIn, in);
    const auto addToVoxel = [&](std::size_t i) {
      const std::size_t at = c * stride + i;
      const double part = this->PartOfDifference(i, c);
      const double scale = staysEven ? Ratio(even.usual.path[at], even.fine.path[at]) : whole;
      const double difference = part * (scale * fine.path[at] - usual.path[at]);
      this->Lengths[at] += static_cast<float>(difference);
      for (int q = 1; q < parts.Functions(); ++q)
      {
        const std::size_t moment = parts.Layout.MomentPlace(places, q, c, i);
        this->Lengths[moment] += static_cast<float>(part * (scale * fine.path[moment] - usual.path[moment]));
      }
      for (int a = 0; a < 3 && !flux.empty(); ++a)
      {
        const std::size_t along = (3 * c + a) * stride + i;
        flux[along] += static_cast<float>(part * (scale * fine.flux[along] - usual.flux[along]));
      }
      return parts.Problem.Scattering().SigmaT(i, c) * difference;
    };
    more += SumOverVoxels(parts.Layout.grid, addToVoxel);
    std::array<double, 6> leaves;
    for (int face = 0; face < 6; ++face)
    {
      const double scale = staysEven ? Ratio(even.usual.tally.out[face][c], even.fine.tally.out[face][c]) : whole;
      leaves[face] = scale * fine.tally.out[face][c] - usual.tally.out[face][c];
      more += leaves[face];
      out += fine.tally.out[face][c];
    }
    for (int face = 0; face < 6 && out > 0.0; ++face)
    {
      this->Counted.Escape(c, face, leaves[face] - more * fine.tally.out[face][c] / out);
    }
  }
  if (!flux.empty())
  {
    parts.Flux.Write(flux.data());
  }
}

void UncollidedLight::CountAbsorbed()
{
  const VolumeLayout& layout = this->Parts.Layout;
  for (int c = 0; c < layout.channels; ++c)
  {
    this->Counted.Absorb(c, SumOverVoxels(layout.grid, [&](std::size_t i) {
      return static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Lengths[c * layout.Stride() + i];
    }));
    this->Counted.SetUnaccounted(c, this->OfSources.onTheWay[c]);
  }
}
}
