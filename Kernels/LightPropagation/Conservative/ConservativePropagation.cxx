#include "LightPropagation/Conservative/ConservativePropagation.h"

#include "Device/DeviceWords.h"
#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/Acceleration/DiffusionAcceleration.h"
#include "LightPropagation/Conservative/ShownLight.h"
#include "LightPropagation/Conservative/SolveMemory.h"
#include "LightPropagation/Conservative/SourceIteration.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Emission/GlobalStatistics.h"
#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"
#include "LightPropagation/Problem/GridAxes.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <memory>
#include <string>

namespace tyndall
{
namespace
{
/// Entries of leftOut that follow from the traits of the scene, except the use of one channel for three.
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
  say(parts.Problem.TheMedium().phase.IsIsotropic() && traits.scatters, left_out::Isotropic);
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
    words.emplace_back("acceleration: few scattering orders do");
  }
  if (parts.Problem.Traits().emits && parts.Problem.Settings().emissionError > 0.0 && !parts.TheDomain().IsSerial())
  {
    words.emplace_back("exact rays of small bright emission: the medium is spread over ranks");
  }
  if (!parts.Problem.Settings().netFlux)
  {
    words.emplace_back(left_out::NetFlux);
  }
  if (scattering.Degree() > 0 && !parts.StoresMoments())
  {
    words.emplace_back(left_out::MomentsForPictures);
  }
  return words;
}

/// Adds the data for rendering scattered light, in the same form on all ranks.
void AddShown(const TransportParts& parts, const Buffer<float>& ofOrders, LightField& light)
{
  const Domain& domain = parts.TheDomain();
  std::unique_ptr<ShownLight> shown;
  if (parts.Basis)
  {
    std::size_t most = 0; // values of one function in the largest block
    for (const VoxelBox& block : domain.Partition().blocks)
    {
      most = std::max(most, parts.Layout.channels * block.VoxelCount());
    }
    shown = std::make_unique<ShownLight>(
      parts.Problem.TheMedium(), parts.Problem.Scattering(), *parts.Basis, parts.Layout, most);
  }
  const bool coloured = domain.Any(shown && shown->HasColour());
  domain.Collective([&] {
    if (shown)
    {
      shown->TakeColour(coloured);
      shown->AddTo(light, parts.TheDevice, ofOrders, parts.Path);
    }
  });
}

/// Copies the arrays over voxels.
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
  light.halfRangeFlux = HalfRangeFlux(
    (parts.Lights.FineBoundary && parts.How != IterationScheme::Dsa ? *parts.Lights.Fine : parts.Usual).Set());
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

/// Solves a scene whose axes are already permuted for fast sweeps.
LightField Solve(Device& device, const Domain& domain, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  const PropagationProblem problem(domain, medium, illumination, settings, MemoryOf(device));
  const IterationScheme how = ChooseIterationScheme(problem);
  Device ofSolve(device, BudgetOfSolve(device, ExtentOf(problem, how)));
  const std::unique_ptr<TransportParts> parts = MakeParts(ofSolve, problem, how);
  IterationResult found = MakeIteration(*parts, kept)->Run(monitor);
  const bool warm = found.warm;
  KeptLight left = std::move(found.kept);
  LightField light = LightOf(*parts, std::move(found));
  JudgeBalance(light, problem.TheDomain(), problem.TheMedium());
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
  JudgeConvergence(settings, light);
  WarnAboutInputLight(illumination, light);
  return light;
}
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
  Check(medium, illumination, settings); // before axes are permuted, so that messages name the user's axes
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
  const IterationScheme how = ChooseIterationScheme(problem);
  // Plane-parallel blocks may still differ from each other; then the voxel solver is used.
  const bool varies = !domain.IsEmpty() && !IsPlaneParallel(medium, illumination, settings);
  if (problem.IsSlab() || !domain.Any(varies))
  {
    return "layers, which it solves in the cosine alone";
  }
  if (how == IterationScheme::SourceIteration && FastestScheme(problem) != how)
  {
    return "many scattering orders in thin voxels round a periodic axis, which it accelerates";
  }
  if (MayHaveEmissionPeaks(problem))
  {
    return "small bright emission, whose light it has along exact rays";
  }
  return {};
}
}
