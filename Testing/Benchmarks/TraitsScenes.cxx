#include "TraitsScenes.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "Numerics/Constants.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Viewing/MediumRayCaster.h"

#include <algorithm>
#include <cmath>

namespace bench
{
namespace
{
using namespace tyndall;

constexpr double Thickness = 8.0; ///< of the cloud across the box, mean free paths

/// A few waves: lumps some voxels wide, a good third of the box between them.
double Density(double x, double y, double z)
{
  const double wave =
    std::sin(2.0 * Pi * 2.0 * x + 0.3) + std::sin(2.0 * Pi * 3.0 * y + 1.0) + std::sin(2.0 * Pi * 2.0 * z + 2.0);
  return std::max(0.0, 0.6 + 0.5 * wave);
}
}

TraitScene::TraitScene(std::array<int, 3> size)
{
  const double longest = *std::max_element(size.begin(), size.end());
  this->medium.grid.size = size;
  this->medium.grid.spacing = { 1.0 / longest, 1.0 / longest, 1.0 / longest };
  ForGridVoxels(size, [&](std::size_t, int i, int j, int k) {
    const double density = 0.05 + Density((i + 0.5) / size[0], (j + 0.5) / size[1], (k + 0.5) / size[2]);
    for (const double colour : { 0.8, 1.0, 1.25 })
    {
      this->sigma_s.push_back(static_cast<float>(Thickness * 0.9 * density * colour));
      this->sigma_a.push_back(static_cast<float>(Thickness * 0.1 * density / colour));
      this->emission.push_back(static_cast<float>(0.1 * density * colour));
    }
  });
  this->medium.sigma_a = { this->sigma_a.data(), 3 };
  this->medium.sigma_s = { this->sigma_s.data(), 3 };
  this->medium.emission = { this->emission.data(), 3 };
  this->light.sky = { 0.8, 1.0, 1.3 };
  this->settings.acceleration = PropagationAcceleration::None; // the same orders for all
}

void TraitScene::BeGrey()
{
  for (std::vector<float>* values : { &this->sigma_a, &this->sigma_s, &this->emission })
  {
    for (std::size_t i = 0; i < values->size(); i += 3)
    {
      (*values)[i] = (*values)[i + 2] = (*values)[i + 1];
    }
  }
  this->light.sky = { 1.0, 1.0, 1.0 };
}

void TraitScene::LightInOneColour()
{
  this->BeGrey();
  this->light.sky = { 0.8, 1.0, 1.3 };
  this->medium.emission = {};
}

void TraitScene::ShareExtinction()
{
  for (std::size_t i = 0; i < this->sigma_s.size(); i += 3)
  {
    const float sigma_t = this->sigma_a[i + 1] + this->sigma_s[i + 1];
    for (int c = 0; c < 3; ++c)
    {
      this->sigma_s[i + c] = sigma_t * (0.75f + 0.0625f * c);
      this->sigma_a[i + c] = sigma_t - this->sigma_s[i + c];
    }
  }
}

void TraitScene::LeaveEmpty(double filled)
{
  const std::array<int, 3>& n = this->medium.grid.size;
  const auto inside = [&](int a, int i) { return std::abs((i + 0.5) / n[a] - 0.5) < 0.5 * filled; };
  std::size_t at = 0;
  for (int k = 0; k < n[2]; ++k)
  {
    for (int j = 0; j < n[1]; ++j)
    {
      for (int i = 0; i < n[0]; ++i, at += 3)
      {
        if (!inside(0, i) || !inside(1, j) || !inside(2, k))
        {
          std::fill_n(this->sigma_a.begin() + at, 3, 0.0f);
          std::fill_n(this->sigma_s.begin() + at, 3, 0.0f);
          std::fill_n(this->emission.begin() + at, 3, 0.0f);
        }
      }
    }
  }
}

std::string TraitScene::GridName() const
{
  const std::array<int, 3>& n = this->medium.grid.size;
  return std::to_string(n[0]) + "x" + std::to_string(n[1]) + "x" + std::to_string(n[2]);
}

namespace
{
constexpr const char* Everything = "everything computed";

using Change = std::function<void(TraitScene&)>;

TraitCase Propagation(Device& device, const std::string& name, const std::array<int, 3>& size, const Change& change)
{
  const auto scene = std::make_shared<TraitScene>(size);
  change(*scene);
  return { name, "LightPropagationMaps", scene->GridName(), Everything, [&device, scene](bool leaveOut) {
            PropagationSettings settings = scene->settings;
            settings.leaveOut = leaveOut;
            return SolveConservative(device, scene->medium, scene->light, settings).fluence;
          } };
}

TraitCase AsPublished(Device& device, const std::string& name, const std::array<int, 3>& size, const Change& change)
{
  const auto scene = std::make_shared<TraitScene>(size);
  change(*scene);
  scene->settings.maximumOrders = 3;
  return { name, "LightPropagationMaps as published", scene->GridName(), Everything, [&device, scene](bool leaveOut) {
            PropagationSettings settings = scene->settings;
            settings.leaveOut = leaveOut;
            return SolveParallel(device, scene->medium, scene->light, settings).fluence;
          } };
}

/// @param accelerated  whether the cloud is ten times as dense, and its scattering orders are accelerated; false: eight
///   orders
TraitCase Ordinates(Device& device, const std::string& name, const std::array<int, 3>& size, const Change& change,
  bool accelerated = false)
{
  const auto scene = std::make_shared<TraitScene>(size);
  change(*scene);
  for (std::vector<float>* values : { &scene->sigma_a, &scene->sigma_s })
  {
    std::transform(values->begin(), values->end(), values->begin(),
      [&](float value) { return accelerated ? 10.0f * value : value; });
  }
  return { name, accelerated ? "DiscreteOrdinates, accelerated" : "DiscreteOrdinates", scene->GridName(), Everything,
    [&device, scene, accelerated](bool leaveOut) {
      OrdinatesSettings settings;
      settings.directionsPerFace = 9;
      settings.maximumOrders = accelerated ? 0 : 8;
      settings.leaveOut = leaveOut;
      return SolveDiscreteOrdinates(device, Domain(scene->medium.grid), scene->medium, scene->light, settings).fluence;
    } };
}

TraitCase Lattice(Device& device, const std::string& name, const std::array<int, 3>& size, const Change& change)
{
  const auto scene = std::make_shared<TraitScene>(size);
  change(*scene);
  return { name, "LatticeBoltzmann", scene->GridName(), Everything, [&device, scene](bool leaveOut) {
            LatticeSettings settings;
            settings.leaveOut = leaveOut;
            return SolveLatticeBoltzmann(device, Domain(scene->medium.grid), scene->medium, {}, scene->light, settings)
              .fluence;
          } };
}

/// The grey cloud in one channel beside three that share sigma_t: what colour costs where the sky has two colours.
TraitCase GreyBesideSharedExtinction(Device& device, const std::array<int, 3>& size)
{
  const auto grey = std::make_shared<TraitScene>(size);
  grey->BeGrey();
  const auto coloured = std::make_shared<TraitScene>(size);
  coloured->BeGrey();
  coloured->light.faces[0] = { 1e-6, 0.0, 0.0 };
  return { "grey", "LightPropagationMaps", grey->GridName(), "in colour, one sigma_t",
    [&device, grey, coloured](bool leaveOut) {
      const TraitScene& scene = leaveOut ? *grey : *coloured;
      return SolveConservative(device, scene.medium, scene.light, scene.settings).fluence;
    } };
}

void NoScattering(TraitScene& scene)
{
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 0.0f);
  scene.medium.emission = {};
}

std::vector<TraitCase> PropagationCases(Device& device, int edge)
{
  const std::array<int, 3> cube = { edge, edge, edge };
  const auto noEmission = [](TraitScene& scene) { scene.medium.emission = {}; };
  return {
    Propagation(device, "grey", cube, [](TraitScene& scene) { scene.BeGrey(); }),
    GreyBesideSharedExtinction(device, cube),
    Propagation(device, "one colour of light", cube, [](TraitScene& scene) { scene.LightInOneColour(); }),
    Propagation(device, "shared extinction", cube, [](TraitScene& scene) { scene.ShareExtinction(); }),
    Propagation(device, "no scattering", cube, NoScattering),
    Propagation(device, "no absorption", cube,
      [](TraitScene& scene) {
        std::fill(scene.sigma_a.begin(), scene.sigma_a.end(), 0.0f);
        scene.settings.maximumOrders = 12;
      }),
    Propagation(device, "no emission", cube, noEmission),
    Propagation(device, "empty slabs, 1/2 filled", cube, [](TraitScene& scene) { scene.LeaveEmpty(0.8); }),
    Propagation(device, "empty slabs, 1/8 filled", cube, [](TraitScene& scene) { scene.LeaveEmpty(0.5); }),
    Propagation(device, "empty slabs, 1/64 filled", cube, [](TraitScene& scene) { scene.LeaveEmpty(0.25); }),
    Propagation(device, "dark directions, one face shines", cube,
      [](TraitScene& scene) {
        NoScattering(scene);
        scene.light = {};
        scene.light.faces[4] = { 0.8, 1.0, 1.3 };
      }),
    Propagation(device, "one periodic voxel along x", { 1, edge, edge },
      [](TraitScene& scene) {
        scene.settings.periodic = { true, false, false };
      }),
    Propagation(device, "one periodic voxel along x and y", { 1, 1, edge },
      [](TraitScene& scene) {
        scene.settings.periodic = { true, true, false };
        scene.settings.maximumOrders = 8;
      }),
    AsPublished(device, "grey", cube, [](TraitScene& scene) { scene.BeGrey(); }),
    AsPublished(device, "one colour of light", cube, [](TraitScene& scene) { scene.LightInOneColour(); }),
  };
}

std::vector<TraitCase> VoxelCases(Device& device, int edge)
{
  const std::array<int, 3> cube = { edge, edge, edge };
  const auto grey = [](TraitScene& scene) { scene.BeGrey(); };
  const auto oneColour = [](TraitScene& scene) { scene.LightInOneColour(); };
  const auto empty = [](double filled) { return [filled](TraitScene& scene) { scene.LeaveEmpty(filled); }; };
  const auto oneFace = [](TraitScene& scene) {
    NoScattering(scene);
    scene.light = {};
    scene.light.faces[4] = { 0.8, 1.0, 1.3 };
  };
  const auto red = [](TraitScene& scene) {
    scene.medium.emission = {};
    scene.light.sky = { 1.0, 0.0, 0.0 };
  };
  const auto ahead = [](TraitScene& scene) {
    scene.LeaveEmpty(0.8);
    scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  };
  return {
    Ordinates(device, "grey", cube, grey),
    Ordinates(device, "one colour of light", cube, oneColour),
    Ordinates(device, "no scattering", cube, NoScattering),
    Ordinates(device, "dark directions, one face shines", cube, oneFace),
    Ordinates(device, "dark channels, red light", cube, red),
    Ordinates(device, "empty slabs, 1/2 filled", cube, empty(0.8)),
    Ordinates(device, "empty slabs, 1/2 filled, g 0.6", cube, ahead),
    Ordinates(device, "empty slabs, 1/8 filled", cube, empty(0.5)),
    Ordinates(device, "empty slabs, 1/64 filled", cube, empty(0.25)),
    Ordinates(device, "grey", cube, grey, true),
    Ordinates(device, "one colour of light", cube, oneColour, true),
    Ordinates(device, "empty slabs, 1/2 filled, g 0.6", cube, ahead, true),
    Ordinates(device, "empty slabs, 1/8 filled", cube, empty(0.5), true),
    Lattice(device, "grey", cube, grey),
    Lattice(device, "one colour of light", cube, oneColour),
    Lattice(device, "dark channels, red light", cube, red),
  };
}

/// A ball of glass in the box's middle.
std::vector<float> Ball(const Grid& grid)
{
  std::vector<float> ior;
  ForGridVoxels(grid.size, [&](std::size_t, int i, int j, int k) {
    const double r =
      std::hypot((i + 0.5) / grid.size[0] - 0.5, (j + 0.5) / grid.size[1] - 0.5, (k + 0.5) / grid.size[2] - 0.5);
    ior.push_back(static_cast<float>(1.0 + 0.3 / (1.0 + std::exp(80.0 * (r - 0.3)))));
  });
  return ior;
}

/// Parallel light from above, as many photons as lie on a square grid.
std::vector<Photon> Rain(int edge, const std::array<float, 3>& power)
{
  std::vector<Photon> photons;
  for (int j = 0; j < edge; ++j)
  {
    for (int i = 0; i < edge; ++i)
    {
      Photon photon;
      photon.position = { (i + 0.5) / edge, (j + 0.5) / edge, 1.0 };
      photon.direction = { 0.28f, 0.0f, -0.96f };
      photon.power = power;
      photons.push_back(photon);
    }
  }
  return photons;
}

/// @param glass  whether the refractive index varies
TraitCase Marching(Device& device, const std::string& name, int edge, bool glass, const std::array<float, 3>& power,
  const Change& change)
{
  const auto scene = std::make_shared<TraitScene>(std::array<int, 3>{ edge, edge, edge });
  change(*scene);
  const auto ior = std::make_shared<std::vector<float>>(glass ? Ball(scene->medium.grid) : std::vector<float>());
  const auto photons = std::make_shared<std::vector<Photon>>(Rain(6 * edge, power));
  photons->front().power = { 1.0f, 1.0f, 1.0f }; // another colour, but where power is white
  return { name, "PhotonMarcher", scene->GridName(), Everything, [&device, scene, ior, photons](bool leaveOut) {
            MarchSettings settings;
            settings.leaveOut = leaveOut;
            PhotonMarcher marcher(
              device, Domain(scene->medium.grid), scene->medium, { ior->empty() ? nullptr : ior->data(), 1 }, settings);
            return marcher.March(*photons).light.fluence;
          } };
}

TraitCase Viewing(Device& device, const std::string& name, int edge, bool glass, bool grey, const Change& change)
{
  const auto scene = std::make_shared<TraitScene>(std::array<int, 3>{ edge, edge, edge });
  change(*scene);
  const auto ior = std::make_shared<std::vector<float>>(glass ? Ball(scene->medium.grid) : std::vector<float>());
  const auto fluence = std::make_shared<std::vector<float>>(scene->sigma_s);
  if (grey)
  {
    fluence->resize(scene->medium.grid.VoxelCount());
    for (std::size_t i = 0; i < fluence->size(); ++i)
    {
      (*fluence)[i] = scene->sigma_s[3 * i];
    }
  }
  return { name, "MediumRayCaster", scene->GridName(), Everything, [&device, scene, ior, fluence, grey](bool leaveOut) {
            ViewSettings settings;
            settings.imageSize = { 8 * scene->medium.grid.size[0], 6 * scene->medium.grid.size[0] };
            settings.leaveOut = leaveOut;
            SolvedLight light;
            light.fluence = { fluence->data(), grey ? 1 : 3 };
            MediumRayCaster caster(
              device, scene->medium, light, scene->light, settings, { ior->empty() ? nullptr : ior->data(), 1 });
            return caster.Render(FrameGrid(scene->medium.grid, 4.0 / 3.0)).radiance;
          } };
}

std::vector<TraitCase> RayCases(Device& device, int edge)
{
  const auto grey = [](TraitScene& scene) { scene.BeGrey(); };
  const auto same = [](TraitScene&) {};
  const std::array<float, 3> white = { 1.0f, 1.0f, 1.0f }, bluish = { 0.8f, 1.0f, 1.3f };
  return {
    Marching(device, "grey", edge, true, white, grey),
    Marching(device, "shared extinction", edge, true, bluish, grey),
    Marching(device, "no scattering", edge, true, bluish, NoScattering),
    Marching(device, "constant index", edge, false, bluish, same),
    Viewing(device, "grey", edge, true, true, grey),
    Viewing(device, "constant index", edge, false, false, same),
    Viewing(device, "empty bricks", edge, true, false, [](TraitScene& scene) { scene.LeaveEmpty(0.5); }),
  };
}
}

std::vector<TraitCase> TraitCases(Device& device, int edge)
{
  std::vector<TraitCase> cases = PropagationCases(device, edge);
  for (const std::vector<TraitCase>& more : { VoxelCases(device, edge), RayCases(device, edge) })
  {
    cases.insert(cases.end(), more.begin(), more.end());
  }
  return cases;
}
}
