#include "LightPropagation/Conservative/ConservativePropagation.h"

#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Distribution/SharedMedium.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/Acceleration/DiffusionAcceleration.h"
#include "LightPropagation/Conservative/SolveMemory.h"
#include "LightPropagation/Conservative/SourceIteration.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"
#include "LightPropagation/Problem/GridAxes.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Entries of LightField::leftOut for work that traits of the scene make unnecessary. The entry on solving one channel
/// instead of three is not among them.
std::vector<std::string> LeftOutOf(const TransportParts& parts, const IterationResult& found)
{
  std::vector<std::string> words;
  const auto say = [&](bool condition, const std::string& text) {
    if (condition)
    {
      words.push_back(text);
    }
  };
  const MediumTraits& traits = parts.Problem.Traits();
  const int directions = static_cast<int>(parts.Usual.Set().directions.size());
  const DirectionSymmetry& symmetry = parts.Usual.Symmetry();
  say(parts.Layout.channels == 3 && parts.Layout.sharedExtinction, left_out::GreyExtinction);
  say(parts.Problem.IsIsotropic() && traits.scatters, left_out::Isotropic);
  say(!traits.scatters, left_out::NoScattering);
  say(!traits.absorbs, left_out::NoAbsorption);
  say(!traits.emits, left_out::NoEmission);
  say(!parts.Lights.SweepCarriesBoundarySource() && !parts.Lights.FineBoundary, left_out::DarkOutside);
  say(parts.Lights.Fine && parts.Lights.SweepCarriesBoundarySource() && !parts.Lights.FineBoundary,
    left_out::EvenOutside);
  say(parts.Lights.Lamps.empty(), left_out::NoLights);
  say(traits.emits && parts.Lights.Emission.peaks.empty(), left_out::NoEmissionPeaks);
  say(!parts.FacesReflect(), left_out::BlackFaces);
  say(traits.scatters && found.convergence.All().size() == 1, left_out::OneOrder);
  words.insert(words.end(), found.leftOut.begin(), found.leftOut.end());
  say(parts.Usual.MergesMirrors() && symmetry.Any(), left_out::MirrorImages(symmetry.Count(), directions));
  return words;
}

std::vector<std::string> Words(const TransportParts& parts, const IterationResult& found)
{
  std::vector<std::string> words;
  const TruncatedScattering& scattering = parts.Problem.Scattering();
  if (parts.Problem.Traits().scatters)
  {
    words = scattering.LeftOut();
  }
  if (parts.Lights.Given)
  {
    words.emplace_back(left_out::OwnUncollided);
  }
  if (parts.Problem.Settings().leaveOut)
  {
    const std::vector<std::string> ofScene = LeftOutOf(parts, found);
    words.insert(words.end(), ofScene.begin(), ofScene.end());
  }
  if (parts.FacesReflect() && parts.Lights.Fine && parts.How == IterationScheme::Dsa)
  {
    words.emplace_back("finer directions of light from outside: the box's faces reflect");
  }
  if (parts.How == IterationScheme::SourceIteration)
  {
    words.emplace_back(left_out::Acceleration);
  }
  const PropagationSettings& settings = parts.Problem.Settings();
  if (parts.Problem.Traits().emits && settings.emissionError > 0.0 && !settings.IsPeriodic() &&
    !HasExactEmission(parts.Problem))
  {
    words.emplace_back("exact rays of small bright emission: more than 2^24 voxels on several ranks");
  }
  if (!settings.netFlux)
  {
    words.emplace_back(left_out::NetFlux);
  }
  if (scattering.Degree() > 0 && !parts.StoresMoments())
  {
    words.emplace_back(left_out::MomentsForPictures);
  }
  return words;
}

constexpr double MostBytes = 1024.0 * 1024.0 * 1024.0;

/// Number of spherical harmonics stored for pictures: all up to `degree`, or up to a lower degree if they exceed
/// MostBytes.
/// @param values  number of values per harmonic
int HarmonicsKept(int degree, std::size_t values)
{
  const auto count = [](int l) { return (l + 1) * (l + 1); };
  while (degree > 1 && 4.0 * count(degree) * static_cast<double>(values) > MostBytes)
  {
    --degree;
  }
  return count(degree);
}

/// Smallest sigma_s, in the solver's units (1/length), whose scattered light is stored for pictures.
constexpr float LeastScattering = 1e-30f;

/// Factor that converts a scattering source, per length, to one per scattering mean free path: 1 / sigma_s, or 0 where
/// sigma_s is negligible.
Buffer<float> PerScattering(Device& device, const VolumeLayout& layout, const Field& sigma_s)
{
  const auto inverse = [&](std::size_t i, int c) {
    return sigma_s.At(i, c) > LeastScattering ? 1.0f / sigma_s.At(i, c) : 0.0f;
  };
  return PlanarOnDevice(device, layout, layout.channels, inverse, "the inverse of sigma_s");
}

/// Whether the fraction of scattered light that delta-M treats as unscattered differs between channels in any voxel.
bool HasColouredStraightOn(const TransportParts& parts)
{
  const TruncatedScattering& scattering = parts.Problem.Scattering();
  for (std::size_t i = 0; i < parts.Layout.grid.VoxelCount(); ++i)
  {
    for (int c = 1; c < parts.Layout.channels; ++c)
    {
      if (scattering.StraightOn(i, c) != scattering.StraightOn(i, 0))
      {
        return true;
      }
    }
  }
  return false;
}

/// Computes LightField::scatteredMoments, in the solver's units. Overwrites parts.Path.
/// @param shown  angular moments of the scattered radiance (IterationResult::shown)
std::vector<float> MomentsForPictures(const TransportParts& parts, const Buffer<float>& shown, int harmonics)
{
  const VolumeLayout& layout = parts.Layout;
  Device& device = parts.TheDevice;
  const std::vector<double> matrix = parts.Basis->Matrix();
  const Buffer<float> basis(device, std::vector<float>(matrix.begin(), matrix.end()), "the angular functions");
  const Buffer<float> scale = PerScattering(device, layout, parts.Problem.TheMedium().sigma_s);
  const std::array<int, 3>& size = layout.grid.size;
  for (int c = 0; c < layout.channels; ++c)
  {
    cl::Kernel kernel = device.Kernel("to_harmonics", kernel_source::MomentScattering);
    With(
      kernel, layout.Places(parts.Functions()), cl_int(c), basis, shown, scale, cl_ulong(layout.Stride()), parts.Path);
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2], harmonics));
  }
  std::vector<float> moments(layout.grid.VoxelCount() * layout.channels * harmonics);
  parts.Path.Read(moments.data(), moments.size());
  return moments;
}

/// Sets LightField::scatteredMoments and straightOn, from which a camera renders scattered light in any direction
/// (numerics.md, section 14.7). Number of harmonics and channels are equal on all ranks. Collective.
/// @param shown  angular moments of the scattered radiance (IterationResult::shown)
void AddShown(const TransportParts& parts, const Buffer<float>& shown, LightField& light)
{
  const Domain& domain = parts.TheDomain();
  const bool coloured = domain.Any(parts.Basis && HasColouredStraightOn(parts));
  domain.Collective([&] {
    if (!parts.Basis)
    {
      return;
    }
    std::size_t most = 0; // number of values of one angular function in the largest block
    for (const VoxelBox& block : domain.Partition().blocks)
    {
      most = std::max(most, parts.Layout.channels * block.VoxelCount());
    }
    const int harmonics = HarmonicsKept(parts.Basis->Degree(), most), channels = coloured ? parts.Layout.channels : 1;
    light.scatteredMoments = MomentsForPictures(parts, shown, harmonics);
    light.straightOn.resize(parts.Layout.grid.VoxelCount() * channels);
    for (std::size_t i = 0; i < light.straightOn.size(); ++i)
    {
      light.straightOn[i] = parts.Problem.Scattering().StraightOn(i / channels, static_cast<int>(i % channels));
    }
    if (harmonics < parts.Functions())
    {
      light.leftOut.push_back("angular moments for pictures: " + std::to_string(harmonics) + " of " +
        std::to_string(parts.Functions()) + ", more take above 1 GiB");
    }
  });
}

/// Sets the arrays over voxels of `light`: fluence, net flux and scattered radiance.
void TakeVoxels(const TransportParts& parts, LightField& light)
{
  light.fluence = Interleaved(parts.Layout, parts.Fluence, 1.0);
  if (parts.Problem.Settings().netFlux)
  {
    light.netFlux = Interleaved(parts.Layout, parts.Flux, 1.0 / parts.Layout.grid.VoxelVolume());
  }
  light.scatteredRadiance = Zeros(light.fluence.size());
  InThreads(light.fluence.size(), 65536, [&](std::size_t begin, std::size_t end) {
    const auto from = light.fluence.begin();
    std::transform(from + static_cast<std::ptrdiff_t>(begin), from + static_cast<std::ptrdiff_t>(end),
      light.scatteredRadiance.begin() + static_cast<std::ptrdiff_t>(begin),
      [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  });
}

LightField LightOf(const TransportParts& parts, IterationResult&& found)
{
  LightField light;
  light.channels = parts.Layout.channels;
  parts.TheDomain().Collective([&] { TakeVoxels(parts, light); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.leftOut = Words(parts, found);
  if (parts.StoresMoments())
  {
    AddShown(parts, found.shown, light);
  }
  light.halfRangeFlux.fill(HalfRangeFlux(
    (parts.Lights.FineBoundary && parts.How != IterationScheme::Dsa ? *parts.Lights.Fine : parts.Usual).Set()));
  light.uncollidedDirections = parts.Lights.FineBoundary ? parts.Lights.Fine->Set().PerFace() : 0;
  light.balance = found.ledger.Balance();
  light.facePowerOut = found.ledger.FacePowerOut();
  if (parts.Faces)
  {
    light.facePower = parts.Faces->PerArea(found.leftByCell);
  }
  light.convergence = found.convergence.All();
  light.fluenceDirect = std::move(found.fluenceDirect);
  light.firstMoments = std::move(found.firstMoments);
  light.surfaceRadiance = std::move(found.surfaceRadiance);
  light.device = NameWithStreaming(parts.TheDevice);
  return light;
}

std::unique_ptr<Iteration> MakeIteration(TransportParts& parts, const KeptLight* kept)
{
  if (parts.How != IterationScheme::Dsa)
  {
    return std::make_unique<SourceIteration>(parts, kept);
  }
  return std::make_unique<DiffusionAcceleration>(parts, kept);
}

/// A channel of a scene, to be solved alone. Construct collectively.
struct ChannelProblem
{
  ChannelProblem(Device& device, const Domain& domain, const Medium& medium, const Illumination& illumination,
    int channel, const PropagationSettings& settings)
    : scene(medium, illumination, channel)
    , problem(domain, this->scene.medium, this->scene.light, settings, MemoryOf(device))
    , how(ChooseIterationScheme(this->problem))
  {
  }

  const OneChannelScene scene;
  const PropagationProblem problem;
  const IterationScheme how;
};

/// The channels of a scene, to be solved one by one, if the iteration scheme or the degree of angular moments chosen
/// for a single channel differs from that chosen for all together. Both change the light of optically thick voxels, and
/// the light of a channel must not depend on the other channels. If the phase function is isotropic, the difference is
/// small (numerics.md, "Channels"), and channels are solved together. Empty: all channels are solved together.
/// Collective.
std::vector<std::unique_ptr<ChannelProblem>> UnlikeChannels(Device& device, const PropagationProblem& all,
  IterationScheme how, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Domain& domain)
{
  std::vector<std::unique_ptr<ChannelProblem>> channels;
  bool differ = false;
  const bool may = all.Channels() > 1 && domain.Any(!domain.IsEmpty() && !medium.phase.IsIsotropic());
  for (int c = 0; c < all.Channels() && may; ++c)
  {
    channels.push_back(std::make_unique<ChannelProblem>(device, domain, medium, illumination, c, settings));
    const ChannelProblem& one = *channels.back();
    differ = differ || one.how != how || one.problem.Scattering().Degree() != all.Scattering().Degree();
  }
  if (!differ)
  {
    channels.clear();
  }
  return channels;
}

/// Solves a scene by sweeps; its axes are already permuted for fast sweeps.
LightField Solve(Device& device, const Domain& domain, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  std::optional<PropagationProblem> problem(std::in_place, domain, medium, illumination, settings, MemoryOf(device));
  const IterationScheme how = ChooseIterationScheme(*problem);
  auto channels = UnlikeChannels(device, *problem, how, medium, illumination, settings, domain);
  if (channels.empty())
  {
    return SolveBySweeps(device, *problem, illumination, how, monitor, kept);
  }
  problem.reset();
  return SolveOneByOne(monitor, kept, [&](int c, const Monitor& part, KeptLight* ofChannel) {
    const std::unique_ptr<ChannelProblem> channel = std::move(channels[c]); // released after its solve
    return SolveBySweeps(device, channel->problem, channel->scene.light, channel->how, part, ofChannel);
  });
}
}

LightField SolveBySweeps(Device& device, const PropagationProblem& problem, const Illumination& illumination,
  IterationScheme how, const Monitor& monitor, KeptLight* kept,
  const std::function<void(TransportParts& parts)>& replace)
{
  const Domain& domain = problem.TheDomain();
  Device ofSolve(device, BudgetOfSolve(device, problem, how));
  const std::unique_ptr<TransportParts> parts = MakeParts(ofSolve, problem, how);
  if (replace)
  {
    domain.Collective([&] { replace(*parts); });
  }
  IterationResult found = MakeIteration(*parts, kept)->Run(monitor);
  const bool warm = found.warm;
  KeptLight left = std::move(found.kept);
  LightField light = LightOf(*parts, std::move(found));
  JudgeBalance(light, domain, problem.TheMedium());
  if (kept)
  {
    Keep(std::move(left), warm, light, *kept);
  }
  light.faceAlbedo = illumination.faceAlbedo;
  domain.Collective([&] { problem.Undo(light); });
  if (parts->StoresMoments())
  {
    light.lampsApart = parts->Lights.LampsOf(illumination);
  }
  JudgeConvergence(problem.Settings(), light);
  WarnAboutInputLight(domain, illumination, light);
  ShareLeftOut(domain, light);
  return light;
}

LightField SolveConservative(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  if (!domain.IsSerial())
  {
    RequireSame(domain.Comm(), "WarmStart", true, { kept ? 1.0 : 0.0 });
    return Solve(device, domain, medium, illumination, settings, monitor, kept);
  }
  if (IsPlaneParallel(medium, illumination, settings))
  {
    LightField light = SolvePlaneParallel(medium, illumination, settings, monitor);
    JudgeBalance(light, domain, medium);
    return light;
  }
  const AxisPermutation turn(medium.grid, illumination, settings);
  if (!turn)
  {
    return Solve(device, domain, medium, illumination, settings, monitor, kept);
  }
  // Checks before axes are permuted, so that messages name the user's axes.
  Check(domain, medium, illumination, settings);
  const Medium turned = turn.Of(medium);
  LightField light =
    Solve(device, Domain(turned.grid), turned, turn.Of(illumination), turn.Of(settings), monitor, kept);
  turn.Undo(light, medium.grid);
  return light;
}

std::string ReasonNotToDecompose(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings)
{
  const PropagationProblem problem(domain, medium, illumination, settings, MemoryOf(device));
  // Each block may consist of plane-parallel layers although the domain does not, if the layers differ between blocks.
  // The domain is then solved in voxels, as in a serial solve.
  const bool varies = !domain.IsEmpty() && !IsPlaneParallel(medium, illumination, settings);
  if (problem.IsSlab() || !domain.Any(varies))
  {
    return "layers, which it solves in the cosine alone";
  }
  if (MayHaveEmissionPeaks(problem) && !HasExactEmission(problem))
  {
    return "small bright emission, whose light it has along exact rays";
  }
  return {};
}
}
