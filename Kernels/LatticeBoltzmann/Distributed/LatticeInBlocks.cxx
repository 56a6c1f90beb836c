#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/Distributed/DiffusionInBlocks.h"
#include "LatticeBoltzmann/Distributed/LinesInBlocks.h"
#include "LatticeBoltzmann/Distributed/MediumAround.h"
#include "LatticeBoltzmann/Distributed/SteppedInBlocks.h"
#include "LatticeBoltzmann/Distributed/UncollidedInBlocks.h"
#include "LatticeBoltzmann/LatticeAccount.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/Steady/SteadyLattice.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Photons/Distributed/PhotonsInBlocks.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

namespace tyndall
{
namespace
{
/// That what lamps' light does in voxels depends on those next to the next ones.
constexpr int Layers = 2;

void RequireSameLattice(
  Communicator& communicator, bool has, const Field& ior, const Illumination& shining, const LatticeSettings& settings)
{
  std::vector<double> numbers = { 1.0 * settings.directions, 1.0 * static_cast<int>(settings.scheme),
    1.0 * settings.maximumSteps, 1.0 * settings.solvesSteady, 1.0 * settings.probes, settings.tolerance };
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

/// As they are for a block and the voxels around it, which go on beyond periodic ends: none is seen from there.
LatticeSettings InKnownVoxels(LatticeSettings settings)
{
  settings.periodic = {};
  return settings;
}

/// The equations of a steady lattice whose blocks lie on several ranks.
class SteadyInBlocks : public SteadySystem
{
public:
  SteadyInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeSettings& settings, const LatticeVoxels& voxels, const Lattice* lattice)
    : Others(communicator)
    , Lines(device, communicator, partition, box, settings, voxels, lattice)
    , Diffusion(device, communicator, partition, box, settings, voxels)
  {
  }

  Values Sweep(const Values& even, double shines, bool writes, const Monitor& monitor) override
  {
    return this->Lines.Sweep(even, shines, writes, monitor);
  }
  Values Diffuse(const Values& residual, double) override { return this->Diffusion.Solve(residual); }
  void Alone(const std::function<void()>& work) override { this->Others.Together(work); }
  Values Sum(const Values& ofRank) override { return this->Others.Sum(ofRank); }

private:
  Communicator& Others;
  LinesInBlocks Lines;
  DiffusionInBlocks Diffusion;
};

/// The channels of one rank's block, solved in step with the other ranks.
class ChannelsInBlocks
{
public:
  ChannelsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeScene& scene, const Field& index, const LatticeSettings& settings, const Uncollided& direct)
    : TheDevice(device)
    , Others(communicator)
    , Partition(partition)
    , Box(box)
    , Scene(scene)
    , Index(index)
    , Settings(settings)
    , OfKnown(InKnownVoxels(settings))
    , Direct(direct)
  {
  }

  /// @return sigma_t h, of all voxels
  double AddTo(LightField& light, int channel, const Monitor& monitor) const
  {
    std::optional<LatticeVoxels> made;
    this->Others.Together([&] { made.emplace(this->Scene, this->Index, this->OfKnown, this->Direct, channel); });
    LatticeVoxels& voxels = *made;
    this->TakeWhatIsOfAll(voxels, channel);
    std::optional<Lattice> lattice;
    this->Others.Together([&] {
      if (this->Box.Count() > 0)
      {
        lattice.emplace(this->TheDevice, this->Box, this->OfKnown, voxels);
      }
    });
    std::vector<float> fluence(this->Box.Count(), 0.0f);
    std::vector<ConvergenceRow> rows;
    if (this->Others.Sum({ voxels.Given() })[0] > 0.0)
    {
      fluence = this->Fluence(voxels, lattice ? &*lattice : nullptr, monitor, rows);
    }
    this->Others.Together([&] {
      if (lattice)
      {
        LatticeAccount(this->Scene, this->Box, this->OfKnown, this->Direct, voxels, *lattice, channel)
          .AddTo(light, fluence);
      }
    });
    AddRows(rows, light);
    return voxels.thickest;
  }

private:
  /// Of the steady lattice, or of one that steps.
  std::vector<float> Fluence(
    const LatticeVoxels& voxels, Lattice* lattice, const Monitor& monitor, std::vector<ConvergenceRow>& rows) const
  {
    if (this->Settings.Solves())
    {
      SteadyInBlocks system(this->TheDevice, this->Others, this->Partition, this->Box, this->Settings, voxels, lattice);
      return SteadyLattice(this->Box, this->Settings, voxels, system).Solve(monitor, rows);
    }
    SteppedInBlocks steps(this->TheDevice, this->Others, this->Partition, this->Settings, lattice);
    std::vector<float> fluence = Settling(steps, this->Settings).Run({}, monitor, rows);
    steps.FillAround(); // net flux is of what comes from there
    return fluence;
  }

  /// What kernels leave out they do for all voxels of the grid, and what comes in depends on it.
  void TakeWhatIsOfAll(LatticeVoxels& voxels, int channel) const
  {
    const bool has = this->Box.Count() > 0;
    const auto ends = std::minmax_element(voxels.squared.begin(), voxels.squared.end());
    const std::vector<double> all =
      this->Others.Largest({ voxels.passesAll ? 0.0 : 1.0, has ? static_cast<double>(*ends.second) : 0.0,
        has ? 1.0 / static_cast<double>(*ends.first) : 0.0, voxels.thickest });
    voxels.passesAll = all[0] == 0.0;
    voxels.bends = static_cast<float>(all[1]) != static_cast<float>(1.0 / all[2]);
    voxels.thickest = all[3];
    voxels.TakeOutside(this->Scene.shining, channel);
  }

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const LatticeBox& Box;
  const LatticeScene Scene;
  const Field Index;
  const LatticeSettings& Settings;
  const LatticeSettings OfKnown;
  const Uncollided& Direct;
};
}

std::string NotInBlocks(const LatticeSettings& settings)
{
  if (settings.blockSize > 0)
  {
    return "blocks of voxels that step by themselves (BlockSize)";
  }
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
  PropagationSettings asPropagation = AsPropagation(settings);
  asPropagation.angularDegree = 0; // light diffuses
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, asPropagation);
  RequireSameLattice(communicator, has, ior, illumination, settings);
  CheckLightHasAnEnd(AbsorbsOnAny(communicator, has, medium), illumination, settings.periodic);

  Medium own = has ? medium : Medium();
  own.grid = partition.OwnGrid(communicator.Rank());
  const VoxelsAround around(communicator, partition, settings.periodic, Layers);
  const MediumAround known(around, own, has ? ior : Field(), has ? illumination.uncollided : UncollidedImage());
  Illumination shining = illumination;
  shining.uncollided = known.uncollided;
  const BlockScene scene(communicator, has, partition, known.medium, shining, asPropagation, MemoryOf(device));
  BlockPartition inUnits = partition;
  inUnits.whole = scene.WholeOf(partition.whole);
  const LatticeScene solved = { scene.medium, scene.illumination, scene.channels };
  const LatticeBox box(scene.medium.grid, BoxOf(around).own, BoxOf(around).innerFaces);

  const bool moments = OnAnyRank(communicator, has && NeedsFirstMoments(scene.medium, settings));
  const Uncollided direct = UncollidedInBlocks(device, communicator, inUnits, around, solved, settings, moments)
                              .Find(OfPart(monitor, 0.0, 0.1));
  LightField light = BeginLight(box.Count(), scene.channels, settings);
  const ChannelsInBlocks channels(device, communicator, inUnits, box, solved, known.index, settings, direct);
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    const double all = light.channels;
    const Monitor ofChannel = OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all);
    thickest = std::max(thickest, channels.AddTo(light, c, ofChannel));
  }
  AddUp(communicator, light);
  const bool anisotropic = OnAnyRank(communicator, has && !scene.medium.phase.IsIsotropic()) && scene.traits.scatters;
  communicator.Together([&] {
    DescribeLight(light, device, anisotropic, settings, thickest);
    scene.Undo(light);
    JudgeLight(light, illumination, settings);
  });
  return light;
}
}
