#include "LightPropagation/Conservative/UncollidedLight.h"

#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Optical thickness of the thickest voxel above which the position of first scattering within voxels is taken into
/// account.
constexpr double ThickForFirstMoments = 0.1;
/// Fraction of a voxel's first-collision source below which what does not leave the voxel at once is rounding: in a
/// voxel of 10^8 mean free paths it would have a fluence far above that of the light around.
constexpr double RoundedPart = 1e-6;
constexpr float Elsewhere = -1.0f; ///< sigma_s of ghost cells, which are excluded from sums

double Ratio(double of, double to)
{
  return to > 0.0 ? of / to : 1.0;
}
}

GhostedMedium::GhostedMedium(TransportParts& parts, const BlockWithGhosts& block)
  : hasMoments(parts.Functions() > 1)
{
  const char* what = "the diffusion system";
  Device& device = parts.TheDevice;
  const int extinctions = parts.Layout.sharedExtinction ? 1 : parts.Layout.channels;
  this->sigma_t = { device, block, parts.OnDevice.TransportSigmaT(), extinctions, what };
  this->sigma_a = { device, block, parts.OnDevice.SigmaA(), parts.Layout.channels, what };
  this->sigma_s = { device, block, parts.OnDevice.SigmaS(), parts.Layout.channels, what };
  this->sigma_t.Fill();
  this->sigma_a.Fill();
  this->sigma_s.FillOwn(Elsewhere);
  if (this->hasMoments)
  {
    this->swept = { device, block, parts.OnDevice.SigmaT(), extinctions, what };
    this->swept.Fill();
  }
}

UncollidedLight::UncollidedLight(
  TransportParts& parts, const BlockWithGhosts& block, const GhostedMedium& medium, const Monitor& monitor)
  : Parts(parts)
  , TheDomain(parts.TheDomain())
  , TheMedium(parts.Problem.TheMedium())
  , LinearSource(parts.Problem.HasLinearSource())
  , Block(block)
  , Coefficients(medium)
{
  parts.Lights.CountEmission(this->Counted);
  // Fraction of the time for uncollided light that lamps and localised emission take; boundary light takes the rest.
  const double sources = parts.Lights.FineBoundary ? 0.5 : 1.0;
  this->AddSources(OfPart(monitor, 0.0, sources));
  this->TheDomain.Collective([&] {
    if (parts.Basis && parts.Problem.Settings().netFlux)
    {
      AddFluxOfMoments(parts.TheDevice, parts.Layout, parts.Functions(), parts.Path, parts.Flux);
    }
    this->Lengths = parts.Path.Read();
  });
  this->Counted.Count(this->OfSources);
  if (parts.Lights.FineBoundary)
  {
    this->AddBoundaryDifference(OfPart(monitor, sources, 1.0));
  }
  this->CountAbsorbed();
}

/// Whether first moments are needed for the light of lamps, or for uncollided light given by another solver. They are
/// needed in optically thick voxels, where the position of first collisions matters.
bool UncollidedLight::NeedsFirstMoments() const
{
  return this->LinearSource && (!this->Parts.Lights.Lamps.empty() || this->Parts.Lights.Given) &&
    this->TheDomain.Any(AnyVoxelIsThickerThan(ThickForFirstMoments, this->TheMedium));
}

void UncollidedLight::MakePassing()
{
  TransportParts& parts = this->Parts;
  Device& device = parts.TheDevice;
  const char* what = "light of lamps";
  this->TheDomain.Collective([&] {
    this->MomentsOfLamp = Buffer<float>(device, parts.Layout.Floats(6), what);
    this->PathOfLamp = Buffer<float>(device, parts.Layout.MomentFloats(parts.Functions()), what);
    this->ThroughFaces = Buffer<float>(device, parts.Layout.Floats(6), what);
    this->ThroughFaces.Fill(0.0f);
  });
  const int channels = parts.Layout.channels;
  this->PathWithGhosts = { device, this->Block, this->PathOfLamp, channels, what };
  this->MomentsWithGhosts = { device, this->Block, this->MomentsOfLamp, 6 * channels, what };
  this->AllPathWithGhosts = { device, this->Block, parts.Path, channels, what };
  this->PassedWithGhosts = { device, this->Block, this->ThroughFaces, 6 * channels, what };
}

/// Adds the uncollided light of lamps, of localised emission and of the emission of empty voxels, and uncollided light
/// given by another solver.
void UncollidedLight::AddSources(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const LightSources::Sources lamps = parts.Lights.LampSources();
  const LightSources::Sources given = parts.Lights.GivenSources();
  LightSources::Sources others = parts.Lights.PeakSources();
  for (std::unique_ptr<UncollidedSource>& vacuum : parts.Lights.VacuumSources())
  {
    others.push_back(std::move(vacuum));
  }
  std::size_t done = 0;
  const auto monitorOfNext = [&] {
    const double all = static_cast<double>(lamps.size() + given.size() + others.size());
    ++done;
    return OfPart(monitor, (done - 1) / all, done / all);
  };
  const bool passes = this->NeedsFirstMoments();
  if (passes)
  {
    this->MakePassing();
  }
  const auto add = [&](const LightSources::Sources& sources) {
    for (const std::unique_ptr<UncollidedSource>& source : sources)
    {
      Add(this->OfSources,
        passes ? this->AddLampThroughFaces(*source, monitorOfNext())
               : parts.AddUncollided(*source, parts.WholeDeposit(), monitorOfNext()));
    }
  };
  add(lamps);
  this->TheDomain.Collective([&] {
    if (!lamps.empty())
    {
      this->LengthsOfLamps = parts.Path.Read();
    }
  });
  add(given);
  if (passes)
  {
    this->FindScatteredInVoxels();
  }
  for (const std::unique_ptr<UncollidedSource>& other : others)
  {
    Add(this->OfSources, parts.AddUncollided(*other, parts.WholeDeposit(), monitorOfNext()));
  }
}

SweepTally UncollidedLight::AddLampThroughFaces(const UncollidedSource& lamp, const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  this->TheDomain.Collective([&] {
    this->MomentsOfLamp.Fill(0.0f);
    this->PathOfLamp.Fill(0.0f);
  });
  const Deposit whole = parts.WholeDeposit();
  const Deposit ofLamp = { &this->PathOfLamp, whole.flux, nullptr, &this->MomentsOfLamp, whole.faceOut,
    whole.spreadsAside };
  const SweepTally tally = parts.AddUncollided(lamp, ofLamp, monitor);
  this->PathWithGhosts.FillOwn();
  this->MomentsWithGhosts.Fill();
  this->TheDomain.Collective([&] {
    if (parts.IsEmpty())
    {
      return;
    }
    this->PassFaces();
    if (parts.Basis)
    {
      AddMoments(parts.TheDevice, parts.Layout, parts.Functions(), this->PathOfLamp, parts.Path);
    }
  });
  this->AllPathWithGhosts.TakeOwn();
  return tally;
}

/// Adds the power of a lamp's first-scattered light that leaves its voxel through each face without another collision
/// (numerics.md, Eqs. (66) to (69)). Called for each lamp, since the depth of first scattering in a voxel depends on
/// the lamp.
void UncollidedLight::PassFaces()
{
  const VolumeLayout& held = this->Block.WithGhosts();
  const GhostedMedium& medium = this->Coefficients;
  Device& device = this->Parts.TheDevice;
  cl::Kernel pass = device.Kernel("pass_lamp_light", kernel_source::LampPassing, ExactOption(device));
  for (int c = 0; c < held.channels; ++c)
  {
    DiffusionLayout layout =
      LayoutOf(held.grid, this->Block.Periodic(), held.Stride(), held.ExtinctionFirst(c), c * held.Stride());
    layout.linear = true;
    With(pass, layout, medium.sigma_t.Values(), medium.sigma_a.Values(), medium.sigma_s.Values(), medium.Swept(),
      this->PathWithGhosts.Values(), this->MomentsWithGhosts.Values(), this->PassedWithGhosts.Values(),
      this->AllPathWithGhosts.Values());
    RunVoxels(device, pass, layout);
  }
}

/// Computes OfLamps(): the first-collision source of lamps and of light given by another solver, minus the power that
/// leaves its voxel without another collision.
void UncollidedLight::FindScatteredInVoxels()
{
  const VolumeLayout& layout = this->Parts.Layout;
  this->PassedWithGhosts.TakeOwn();
  this->PassedWithGhosts.Fill();
  this->TheDomain.Collective([&] {
    const std::vector<float> passed = this->ThroughFaces.Read(), lengths = this->Parts.Path.Read();
    const auto scattered = [&](std::size_t i, int c) {
      const double all = this->Parts.Problem.Scattering().SigmaS(i, c) * lengths[c * layout.Stride() + i];
      double power = all;
      for (int d = 0; d < 6; ++d)
      {
        power -= passed[(6 * c + d) * layout.Stride() + i];
      }
      power = std::abs(power) < RoundedPart * all ? 0.0 : power;
      return static_cast<float>(power / (4.0 * Pi * layout.grid.VoxelVolume()));
    };
    this->ScatteredInVoxels =
      PlanarOnDevice(this->Parts.TheDevice, layout, layout.channels, scattered, "light of lamps");
  });
  this->OfLampsWithGhosts = { this->Parts.TheDevice, this->Block, this->ScatteredInVoxels, layout.channels,
    "light of lamps" };
  this->OfLampsWithGhosts.FillOwn();
  for (GhostedBuffer* ofOneLamp : { &this->PathWithGhosts, &this->MomentsWithGhosts, &this->AllPathWithGhosts })
  {
    *ofOneLamp = {};
  }
  this->PathOfLamp = {};
  this->MomentsOfLamp = {};
}

/// Weight, in a voxel, of the difference between boundary light along the finer quadrature and along the quadrature of
/// scattered light (numerics.md, Eqs. (55), (76)). It is small in optically thick voxels: the depth of first collisions
/// matters there, and the diffusion system takes it into account only for light in sweeps.
double UncollidedLight::PartOfDifference(std::size_t voxel, int channel) const
{
  const std::array<double, 3>& h = this->TheMedium.grid.spacing;
  const double longest = *std::max_element(h.begin(), h.end());
  const double tau = longest * this->TheMedium.TransportSigmaT(voxel, channel);
  const double absorbing = longest * this->TheMedium.sigma_a.At(voxel, channel);
  // The weight by which the diffusion system multiplies the transport correction, Eq. (55).
  return this->LinearSource ? 1.0 / (1.0 + tau * (TRANSPORT_FALL(tau) + 3.0 * absorbing)) : 1.0;
}

/// Adds the uncollided boundary light along the finer quadrature minus that along the quadrature of scattered light
/// (numerics.md, Eq. (76)). The sweeps of DSA carry all boundary light along the latter, because the diffusion system
/// needs it. In media with many scatterings, and for automatically chosen directions, the light along the finer
/// quadrature is scaled by voxel, so that the light of a uniform sky stays uniform; otherwise it is scaled by the
/// incident power. The power that the difference adds to voxels is subtracted from the escaped power.
void UncollidedLight::AddBoundaryDifference(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const PropagationSettings& settings = parts.Problem.Settings();
  const auto fine =
    parts.FindUncollided(UncollidedBoundary(settings, *parts.Lights.FineBoundary), OfPart(monitor, 0.0, 0.4));
  const BoundaryLight alongUsual = parts.Lights.FinePartAlongUsual();
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
    more += this->TheDomain.Sum(SumOverVoxels(parts.Layout.grid, addToVoxel));
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
  Rgb absorbed = {};
  for (int c = 0; c < layout.channels; ++c)
  {
    absorbed[c] = SumOverVoxels(layout.grid, [&](std::size_t i) {
      return static_cast<double>(this->TheMedium.sigma_a.At(i, c)) * this->Lengths[c * layout.Stride() + i];
    });
  }
  absorbed = this->TheDomain.Sum(absorbed);
  for (int c = 0; c < layout.channels; ++c)
  {
    this->Counted.Absorb(c, absorbed[c]);
    this->Counted.SetUnaccounted(c, this->OfSources.onTheWay[c]);
  }
}
}
