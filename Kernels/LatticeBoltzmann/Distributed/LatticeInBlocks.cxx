#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/Distributed/ChannelInBlocks.h"
#include "LatticeBoltzmann/Distributed/SceneInBlocks.h"
#include "LatticeBoltzmann/Distributed/UncollidedInBlocks.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Photons/Distributed/PhotonsInBlocks.h"

#include <algorithm>

namespace tyndall
{
namespace
{
void RequireSameLattice(
  Communicator& communicator, bool has, const Field& ior, const Illumination& shining, const LatticeSettings& settings)
{
  std::vector<double> numbers = { 1.0 * settings.directions, 1.0 * static_cast<int>(settings.scheme),
    1.0 * settings.maximumSteps, 1.0 * settings.solvesSteady, 1.0 * settings.probes, settings.tolerance,
    1.0 * settings.blockSize, 1.0 * settings.stepsPerExchange };
  for (const Rgb& face : shining.faceAlbedo)
  {
    numbers.insert(numbers.end(), face.begin(), face.end());
  }
  RequireSame(communicator, "settings of the lattice", true, numbers);
  RequireSame(communicator, "whether there is a refractive index", has, { ior.values ? 1.0 : 0.0 });
}

/// Sums over ranks of what each counted.
void AddUp(Communicator& communicator, LightField& light)
{
  EnergyBalance& balance = light.balance;
  std::vector<Rgb*> counted = { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped };
  for (Rgb& face : light.facePowerOut)
  {
    counted.push_back(&face);
  }
  std::vector<double> values;
  for (const Rgb* rgb : counted)
  {
    values.insert(values.end(), rgb->begin(), rgb->end());
  }
  values = communicator.Sum(values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    (*counted[i / 3])[i % 3] = values[i];
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    balance.leftOver[c] = balance.entered[c] + balance.emitted[c] - balance.absorbed[c] - balance.escaped[c];
  }
}
}

std::string NotInBlocks(const LatticeSettings& settings)
{
  return settings.interleaves ? "photons that march while light diffuses (Interleaved)" : std::string();
}

namespace
{
/// What a rank can tell of its own input. All ranks call it.
void CheckInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
{
  communicator.Together([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    Check(settings);
    Check(illumination);
    CheckFaceAlbedo(illumination, settings.periodic);
    const std::string refused = NotInBlocks(settings);
    Require(refused.empty(), "A medium that is spread over ranks is not solved on a lattice with " + refused + ".");
    if (partition.blocks[communicator.Rank()].VoxelCount() > 0)
    {
      CheckLattice(medium, ior, settings);
      Check(illumination.uncollided, medium);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
  });
}
}

LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const std::vector<Photon>& share, const Illumination& illumination,
  const LatticeSettings& settings, const Monitor& monitor)
{
  CheckInBlocks(communicator, partition, medium, ior, illumination, settings);
  communicator.Together([&] { CheckPhotonsGoNotRound(settings); });
  const bool has = partition.blocks[communicator.Rank()].VoxelCount() > 0;
  MarchSettings march;
  const bool needs = settings.netFlux || (has && NeedsFirstMoments(medium, settings));
  march.meanDirection = OnAnyRank(communicator, needs);
  const PhotonLight found =
    PhotonMarcherInBlocks(device, communicator, partition, medium, ior, march).March(share, OfPart(monitor, 0.0, 0.5));
  Illumination lit = illumination;
  lit.uncollided = has ? ImageOf(found) : UncollidedImage();
  return SolveLatticeInBlocks(device, communicator, partition, medium, ior, lit, settings, OfPart(monitor, 0.5, 1.0));
}

LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  CheckInBlocks(communicator, partition, medium, ior, illumination, settings);
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, AsPropagationInBlocks(settings));
  RequireSameLattice(communicator, has, ior, illumination, settings);
  CheckLightHasAnEnd(AbsorbsOnAny(communicator, has, medium), illumination, settings.periodic);

  const SceneInBlocks scene(device, communicator, partition, medium, ior, illumination, settings);
  const BlockScene& solved = scene.scene;
  const bool moments = OnAnyRank(communicator, has && NeedsFirstMoments(solved.medium, settings));
  const Uncollided direct =
    UncollidedInBlocks(device, communicator, scene.partition, scene.around, scene.OfKnown(), settings, moments)
      .Find(OfPart(monitor, 0.0, 0.1));
  LightField light = BeginLight(scene.Box().Count(), solved.channels, settings);
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    ChannelInBlocks channel(device, communicator, scene, settings, direct, c);
    const double all = light.channels;
    channel.Solve(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  AddUp(communicator, light);
  const bool anisotropic = OnAnyRank(communicator, has && !solved.medium.phase.IsIsotropic()) && solved.traits.scatters;
  communicator.Together([&] {
    DescribeLight(light, device, anisotropic, settings, thickest);
    solved.Undo(light);
    JudgeLight(light, illumination, settings);
  });
  return light;
}
}
