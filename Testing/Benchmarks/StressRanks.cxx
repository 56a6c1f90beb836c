#include "StressSolvers.h"

#include "../Kernels/OnRanks.h"

#include "Device/Device.h"
#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <algorithm>
#include <mutex>

using namespace tyndall;

namespace bench
{
namespace
{
constexpr int RankCount = 3;

Illumination LightsOf(const StressScene& scene)
{
  Illumination light;
  for (const Lamp& lamp : scene.lamps)
  {
    Light made;
    made.type = static_cast<LightType>(lamp.kind);
    made.position = lamp.at;
    made.direction = lamp.along;
    made.power = lamp.power;
    const double width = lamp.width > 0.0 ? lamp.width : 0.5 * scene.spacing[0];
    made.size = { width, width };
    made.angle = lamp.kind == Lamp::Spot ? 60.0 : 0.0;
    if (lamp.kind == Lamp::Point)
    {
      made.direction = { 0.0, 0.0, -1.0 };
    }
    light.lights.push_back(made);
  }
  light.sky = scene.sky;
  for (std::size_t face = 0; face < 6; ++face)
  {
    light.faces[face].fill(scene.faces[face]);
  }
  return light;
}

/// A rank's block of a scene.
struct Part
{
  std::vector<float> absorption, scattering, emission, index;
  Medium medium;

  Part(const StressScene& scene, const Domain& domain)
    : absorption(BlockOf(domain, scene.absorption))
    , scattering(BlockOf(domain, scene.scattering))
    , emission(BlockOf(domain, scene.emission))
    , index(BlockOf(domain, scene.index))
  {
    this->medium.grid = domain.OwnGrid();
    this->medium.sigma_a = { this->absorption.data(), scene.channels };
    this->medium.sigma_s = { this->scattering.data(), scene.channels };
    this->medium.emission = { scene.emission.empty() ? nullptr : this->emission.data(), scene.channels };
    this->medium.phase = PhaseFunction::HenyeyGreenstein(scene.g);
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  Field Index() const { return { this->index.empty() ? nullptr : this->index.data(), 1 }; }
};

LightField SolveGrid(const StressSolver& row, const StressScene& scene, double tolerance, Device& device,
  const Domain& domain, const Part& part)
{
  const Illumination light = LightsOf(scene);
  if (row.IsOfMaps())
  {
    PropagationSettings settings;
    settings.angularDegree = row.Is(Moments) ? -1 : 0;
    settings.tolerance = tolerance;
    settings.periodic = scene.periodic;
    settings.netFlux = true;
    return SolveConservative(device, domain, part.medium, light, settings);
  }
  if (row.family == StressFamily::Ordinates)
  {
    OrdinatesSettings settings;
    settings.maximumOrders = row.Is(ByOrders) ? StressOrdersOrdinates : 0;
    settings.tolerance = tolerance;
    settings.periodic = scene.periodic;
    settings.netFlux = true;
    return SolveDiscreteOrdinates(device, domain, part.medium, light, settings);
  }
  LatticeSettings settings;
  settings.directions = row.Is(SixLinks) ? 6 : 18;
  settings.tolerance = tolerance;
  settings.periodic = scene.periodic;
  settings.netFlux = true;
  return SolveLatticeBoltzmann(device, domain, part.medium, part.Index(), light, settings);
}

LightField March(const StressSolver& row, const StressScene& scene, Device& device, const Domain& domain,
  const Part& part, std::vector<float>& directions)
{
  EmissionSettings emission;
  emission.photonCount = PhotonsFor(row, scene);
  emission.part = domain.Rank();
  emission.parts = RankCount;
  const EmittedPhotons photons = EmitPhotons(domain.Whole(), LightsOf(scene), emission);
  MarchSettings settings;
  settings.maximumOrders = row.Is(Scattered) ? 0 : 1;
  PhotonLight found = PhotonMarcher(device, domain, part.medium, part.Index(), settings).March(photons.photons);
  directions = std::move(found.meanDirection);
  return std::move(found.light);
}

/// What all ranks have alike.
void Tell(const LightField& light, double tolerance, StressOutcome& outcome)
{
  outcome.channels = light.channels;
  outcome.warnings = light.doubts;
  outcome.halfRangeFlux.assign(light.halfRangeFlux[0] > 0.0 ? 1 : 0, light.halfRangeFlux[0]);
  outcome.residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual / tolerance;
  const EnergyBalance& balance = light.balance;
  for (const Rgb& fact : { balance.entered, balance.emitted, balance.absorbed, balance.escaped, balance.leftOver })
  {
    outcome.balance.insert(outcome.balance.end(), fact.begin(), fact.begin() + light.channels);
  }
  for (const Rgb& power : light.facePowerOut)
  {
    outcome.facePowerOut.insert(outcome.facePowerOut.end(), power.begin(), power.begin() + light.channels);
  }
}
}

void RunOnRanks(const StressSolver& row, const StressScene& scene, double tolerance, StressOutcome& outcome)
{
  Grid grid;
  grid.size = scene.cells;
  grid.spacing = scene.spacing;
  const std::shared_ptr<Device> device = Device::Find();
  std::mutex guard;
  try
  {
    OnRanks(grid, RankCount, [&](const Domain& domain) {
      const Part part(scene, domain);
      std::vector<float> directions;
      LightField light = row.IsPhotons() ? March(row, scene, *device, domain, part, directions)
                                         : SolveGrid(row, scene, tolerance, *device, domain, part);
      const std::lock_guard<std::mutex> lock(guard);
      const auto put = [&](std::vector<float>& own, std::vector<float>& all) {
        const std::size_t width = domain.IsEmpty() ? 0 : own.size() / domain.Own().VoxelCount();
        all.resize(std::max(all.size(), width * grid.VoxelCount()));
        PutBlock(domain, own, all);
      };
      put(light.fluence, outcome.fluence);
      put(light.fluenceDirect, outcome.fluenceDirect);
      put(light.netFlux, outcome.netFlux);
      put(directions, outcome.directions);
      if (domain.Rank() == 0)
      {
        Tell(light, tolerance, outcome);
      }
    });
    outcome.empty = false;
  }
  catch (const std::exception& error)
  {
    outcome = {};
    outcome.errors = { error.what() };
  }
}
}
