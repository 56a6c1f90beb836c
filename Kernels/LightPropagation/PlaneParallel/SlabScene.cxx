#include "LightPropagation/PlaneParallel/SlabScene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tyndall
{
SlabScene::SlabScene(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
  : TheMedium(medium)
  , Shining(illumination)
  , Axis(AxisOfLayers(settings.periodic))
  , Isotropic(medium.phase.IsIsotropic())
{
  for (std::size_t i = 0; i < illumination.lights.size(); ++i)
  {
    const std::array<double, 3> d = DirectionOf(illumination.lights[i]);
    const double along = d[this->Axis];
    if (along != 0.0)
    {
      this->Directions.push_back({ along, d[(this->Axis + 1) % 3], d[(this->Axis + 2) % 3] });
      this->Entering.push_back(i);
    }
  }
}

double SlabScene::Across() const
{
  return this->TheMedium.grid.Length((this->Axis + 1) % 3) * this->TheMedium.grid.Length((this->Axis + 2) % 3);
}

std::size_t SlabScene::VoxelOf(std::size_t layer) const
{
  return layer * this->TheMedium.grid.Strides()[this->Axis];
}

std::size_t SlabScene::LayerOf(std::size_t voxel) const
{
  return voxel / this->TheMedium.grid.Strides()[this->Axis] % this->Count();
}

bool SlabScene::HasSlantingBeams() const
{
  return std::any_of(this->Directions.begin(), this->Directions.end(),
    [](const std::array<double, 3>& d) { return d[1] != 0.0 || d[2] != 0.0; });
}

LayerStack SlabScene::StackOf(int channel, int degree) const
{
  const Medium& medium = this->TheMedium;
  LayerStack stack;
  std::map<double, DeltaM> phases;                        // by mean cosine
  std::map<std::pair<double, double>, std::size_t> kinds; // by mean cosine and absorption
  for (std::size_t i = 0; i < this->Count(); ++i)
  {
    const std::size_t voxel = this->VoxelOf(i);
    const double g = medium.phase.MeanCosine(voxel, channel), sigma_a = medium.sigma_a.At(voxel, channel);
    auto phase = phases.find(g);
    if (phase == phases.end())
    {
      phase = phases.emplace(g, this->PhaseOf(voxel, channel, degree)).first;
    }
    const double sigma_t = sigma_a + medium.sigma_s.At(voxel, channel) * (1.0 - phase->second.forward);
    const double absorbed = sigma_t > 0.0 ? sigma_a / sigma_t : 1.0;
    const auto kind = kinds.emplace(std::make_pair(absorbed, g), stack.kinds.size());
    if (kind.second)
    {
      stack.kinds.push_back({ absorbed, phase->second });
    }
    stack.layers.push_back(
      { sigma_t * this->Height(), medium.emission.At(voxel, channel) * this->Height(), kind.first->second });
  }
  return stack;
}

LayerStack SlabScene::UnscatteredStackOf(int channel) const
{
  LayerStack stack;
  for (std::size_t i = 0; i < this->Count(); ++i)
  {
    const std::size_t voxel = this->VoxelOf(i);
    const double sigma_t =
      static_cast<double>(this->TheMedium.sigma_a.At(voxel, channel)) + this->TheMedium.sigma_s.At(voxel, channel);
    stack.layers.push_back(
      { sigma_t * this->Height(), this->TheMedium.emission.At(voxel, channel) * this->Height(), 0 });
  }
  return stack;
}

DeltaM SlabScene::PhaseOf(std::size_t voxel, int channel, int degree) const
{
  const PhaseFunction phase = this->TheMedium.phase.At(voxel, channel);
  return phase.IsIsotropic() ? DeltaM(std::vector<double>{ 1.0, 0.0 }) : DeltaM(phase.Moments(degree + 1));
}

StackLight SlabScene::LightOf(int channel) const
{
  StackLight light = this->BeamsOf(channel, 0, false);
  const int top = 2 * this->Axis, bottom = top + 1;
  light.radianceAtTop = this->Shining.sky[channel] + this->Shining.faces[top][channel];
  light.radianceAtBottom = this->Shining.sky[channel] + this->Shining.faces[bottom][channel];
  light.albedoAtTop = this->Shining.faceAlbedo[top][channel];
  light.albedoAtBottom = this->Shining.faceAlbedo[bottom][channel];
  return light;
}

StackLight SlabScene::BeamsOf(int channel, int order, bool sine) const
{
  StackLight light;
  for (std::size_t b = 0; b < this->Entering.size(); ++b)
  {
    const std::array<double, 3>& d = this->Directions[b];
    const double azimuth = order * std::atan2(d[2], d[1]);
    const double power = this->Shining.lights[this->Entering[b]].power[channel];
    light.beams.push_back({ std::abs(d[0]), d[0] > 0.0,
      power *
        (sine           ? std::sin(azimuth)
            : order > 0 ? std::cos(azimuth)
                        : 1.0) });
  }
  return light;
}

double SlabScene::Absorbing(std::size_t layer, int channel) const
{
  return this->TheMedium.sigma_a.At(this->VoxelOf(layer), channel) * this->Height();
}

std::array<double, 2> SlabScene::Sideways(std::size_t beam) const
{
  return { this->Directions[beam][1], this->Directions[beam][2] };
}
}
