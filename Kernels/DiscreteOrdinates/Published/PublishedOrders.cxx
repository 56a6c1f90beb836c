#include "DiscreteOrdinates/Published/PublishedOrders.h"

#include "DiscreteOrdinates/ChannelArrays.h"
#include "DiscreteOrdinates/Distributed/PublishedStepInBlocks.h"
#include "DiscreteOrdinates/Published/PublishedStep.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace tyndall
{
namespace
{
constexpr int MostSteps = 10000;
constexpr double SlowestRateOfSteps = 0.99; ///< that is told the next solve: light on its way does not fall off at all
constexpr double WithoutEnd = 1e4;          ///< a step's change over the first one's

PairSums SumsOfSteps(const OrdinatesSettings& settings)
{
  return settings.scattering == OrdinatesScattering::Matrix ? PairSums::Passes : PairSums::Terms;
}

std::unique_ptr<OrdinateStep> StepOf(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const LightOfCells* reflecting)
{
  const Grid& grid = scene.medium.grid;
  if (scene.ranks)
  {
    return std::make_unique<PublishedStepInBlocks>(
      device, *scene.ranks, grid, angles.groups, settings.periodic, scene.incoming, reflecting);
  }
  return std::make_unique<PublishedStep>(
    device, grid, angles.groups, scene.incoming, SteppedFaces::Of(grid, settings.periodic, reflecting));
}

class PublishedOrders
{
public:
  PublishedOrders(
    Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, const OrdinatesSettings& settings)
    : Scene(scene)
    , Settings(settings)
    , Arrays(device, scene, angles, settings.netFlux)
    , Cells(CellsOf(this->Arrays.Faces.get()))
    , Step(StepOf(device, scene, angles, settings, this->Cells ? &*this->Cells : nullptr))
    , Scattering(
        device, angles.groups, angles.phase, SumsOfSteps(settings), false, settings.netFlux, this->Arrays.Voxels)
    , Radiance(device, AngularScattering::Floats(angles.groups, this->Arrays.Voxels), "radiance of all directions")
    , Scattered(device, this->Radiance.Size(), "scattered light of all directions")
    , Steady(device, this->Radiance.Size(), "sources of all directions")
  {
  }

  OrdinatesResult Run(const Monitor& monitor)
  {
    this->Arrays.LookAtAllRanks();
    this->Begin(OfPart(monitor, 0.0, 0.1));
    do
    {
      const double done = static_cast<double>(this->Record.All().size()) / (this->Record.All().size() + 20.0);
      const double share = 0.1 + 0.9 * done;
      this->Scene.Collective([&] { Report(monitor, share); });
      this->StepOnce(monitor ? Monitor([&](double) { return monitor(share); }) : Monitor());
    } while (!this->Done());
    this->Scene.Collective([&] { this->Finish(); });
    return std::move(this->Result);
  }

private:
  void Begin(const Monitor& monitor)
  {
    this->Scene.Collective([&] {
      for (Buffer<float>* field : { &this->Radiance, &this->Scattered, &this->Steady })
      {
        field->Fill(0.0f);
      }
    });
    if (this->Arrays.Emits())
    {
      this->Arrays.EmitEvenly(this->Steady, this->Result.ledger);
    }
    this->Arrays.AddLamps(this->Steady, this->Settings.periodic, this->Result, monitor);
    this->OfLamps = this->Result.ledger;
    this->Scene.Collective([&] {
      if (this->Arrays.Faces)
      {
        this->LampsThroughCells = this->Arrays.Faces->TakeOut();
      }
      this->LampFluence = this->Arrays.Direct.Read();
      this->LampFlux = this->Arrays.Light.flux.Read();
      this->Fluence.assign(this->Arrays.Voxels, 0.0f);
    });
    if (this->Scene.guess.values.empty())
    {
      this->MoveOn(); // from darkness: nothing is scattered yet
      return;
    }
    this->Scene.Collective([&] { this->Radiance.Write(this->Scene.guess.values.data()); });
  }

  /// What leaves the box now comes back with the next step.
  void Reflect()
  {
    if (!this->Arrays.Faces)
    {
      return;
    }
    this->Step->LeaveByCells(this->Radiance);
    this->Scene.Collective([&] { this->LetBackIn(*this->Arrays.Faces); });
  }

  void LetBackIn(FaceLight& faces)
  {
    const std::vector<float> swept = faces.TakeOut();
    this->ThroughCells.resize(swept.size());
    std::vector<double> back(swept.size());
    for (std::size_t i = 0; i < swept.size(); ++i)
    {
      this->ThroughCells[i] = static_cast<double>(swept[i]) + this->LampsThroughCells[i];
      back[i] = faces.Albedo()[faces.FaceOf(i)][0] * this->ThroughCells[i];
    }
    faces.LetIn(back, std::vector<double>(back.size(), 0.0));
    this->Returned = faces.PowerOfFaces(back);
  }

  void StepOnce(const Monitor& monitor)
  {
    std::vector<float> now;
    this->Scene.Collective([&] {
      this->Scattering.Scatter(
        this->Radiance, this->Arrays.SigmaS, this->Scattered, this->Arrays.Scale, this->Arrays.Light, monitor);
      now = this->Arrays.Light.order.Read();
    });
    const double change = this->ChangeTo(now);
    this->FirstChange = this->Record.All().empty() ? change : this->FirstChange;
    this->Result.diverged = !(change <= WithoutEnd * this->FirstChange);
    this->Fluence = now;
    this->Change = change;
    this->Result.ledger = this->OfLamps;
    this->Reflect();
    this->CountSteady();
    this->Record.Add(change, this->Result.ledger);
    if (this->Record.All().size() == 1 && !this->Scene.guess.values.empty())
    {
      this->Record.BeginWarm(this->Scene.guess.rate); // from darkness to the guess was no step
    }
    if (!this->Done())
    {
      this->MoveOn();
    }
  }

  /// Of fluence, in all voxels.
  double ChangeTo(const std::vector<float>& now) const
  {
    double change = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      change += std::abs(static_cast<double>(now[i]) - this->Fluence[i]);
    }
    const bool counts = !this->Scene.ranks || this->Scene.ranks->Has();
    return this->Scene.Sum({ counts ? change : 0.0 })[0];
  }

  void MoveOn()
  {
    this->Step->Apply(this->Radiance, this->Scattered, this->Steady, this->Arrays.SigmaT, this->Scattered);
    this->Radiance.Swap(this->Scattered);
  }

  void CountSteady()
  {
    const FacePowers powers = this->Step->Powers(this->Radiance);
    for (int face = 0; face < 6; ++face)
    {
      this->Result.ledger.Enter(0, powers.in[face]);
      this->Result.ledger.Escape(0, face, powers.out[face] - this->Returned[face][0]);
    }
    this->Result.ledger.Absorb(0,
      this->Arrays.PowersOf(this->Fluence, false).absorbed + this->Arrays.PowersOf(this->LampFluence, true).absorbed);
    this->Result.ledger.SetUnaccounted(0, this->Arrays.Stranded());
  }

  bool Done() const
  {
    const int steps = static_cast<int>(this->Record.All().size());
    if (this->Change == 0.0 || this->Result.diverged || steps >= MostSteps)
    {
      return true;
    }
    return this->Settings.maximumOrders > 0 ? steps >= this->Settings.maximumOrders
                                            : steps > 3 && this->Record.Residual() <= this->Settings.tolerance;
  }

  void Finish()
  {
    if (this->Arrays.Faces)
    {
      this->Result.facePower = this->Arrays.Faces->PerArea(this->ThroughCells);
    }
    if (this->Settings.netFlux)
    {
      this->Arrays.Light.flux.Fill(0.0f); // of all steps
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
    if (this->Scene.guess.keeps && !this->Result.diverged)
    {
      this->Result.left = this->Radiance.Read();
      this->Result.firstScattered = 1.0;
      this->Result.rate = std::max(std::min(this->Record.Rate(), SlowestRateOfSteps), this->Scene.guess.rate);
    }
    this->Result.convergence = std::move(this->Record.All());
  }

  const OrdinatesScene& Scene;
  const OrdinatesSettings& Settings;
  ChannelArrays Arrays;
  const std::optional<LightOfCells> Cells;
  std::unique_ptr<OrdinateStep> Step;
  AngularScattering Scattering;
  Buffer<float> Radiance, Scattered, Steady;
  std::vector<float> Fluence, LampFluence, LampFlux;
  std::vector<float> LampsThroughCells; ///< W
  std::vector<double> ThroughCells;     ///< W, with what leaves now
  std::array<Rgb, 6> Returned = {};     ///< W
  EnergyLedger OfLamps;                 ///< and of emission
  OrdinatesRecord Record;
  OrdinatesResult Result;
  double Change = 0.0, FirstChange = 0.0;
};
}

OrdinatesResult SolvePublishedOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor)
{
  std::unique_ptr<PublishedOrders> orders;
  scene.Collective([&] { orders = std::make_unique<PublishedOrders>(device, scene, angles, settings); });
  return orders->Run(monitor);
}

std::size_t BytesOfPublishedOrders(
  const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings, bool inBlocks)
{
  const std::size_t voxels = grid.VoxelCount();
  const std::size_t around = inBlocks ? PublishedStepInBlocks::Floats(grid, angles.groups) : 0;
  return sizeof(float) * (3 * AngularScattering::Floats(angles.groups, voxels) + around) +
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
