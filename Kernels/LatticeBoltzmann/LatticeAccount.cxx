#include "LatticeBoltzmann/LatticeAccount.h"

#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "Numerics/Constants.h"

#include <algorithm>

namespace tyndall
{
/// Adds fluence, absorbed and emitted power. @return power of uncollided light that collides in voxels, W
double LatticeAccount::CountVoxels(LightField& light, const std::vector<float>& fluence) const
{
  const Medium& medium = this->TheMedium;
  const int channel = static_cast<int>(this->Channel);
  const double edge = this->Edge(), area = edge * edge;
  double entered = 0.0;
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double tau = edge * medium.sigma_a.At(known, channel);
    const double direct = this->Direct.image.fluence.At(known, channel), lost = this->Voxels.lost[known];
    // Part of the source that is absorbed in its first step, before it enters the lattice's fluence.
    const double own = this->Voxels.source[known] * (1.0 / this->Voxels.begins[known] - 1.0);
    const double absorbed = lost * fluence[i] + own;
    // If much is absorbed in a step, the fluence is the mean over the step.
    const double scattered = tau > 1e-6 ? absorbed / tau : fluence[i];
    light.fluence[this->Place(light, i)] = static_cast<float>(direct + scattered);
    light.fluenceDirect[this->Place(light, i)] = static_cast<float>(direct);
    light.balance.absorbed[this->Channel] += area * (absorbed + tau * direct);
    light.balance.emitted[this->Channel] += area * edge * 4.0 * Pi * medium.emission.At(known, channel);
    entered += area * direct * (tau + edge * medium.sigma_s.At(known, channel));
  }
  return entered;
}

/// Adds escaped power. @return power incident through the faces, or escaped uncollided, W
double LatticeAccount::CountFaces(LightField& light) const
{
  const std::size_t voxels = this->Box.Count();
  const double area = this->Edge() * this->Edge();
  const std::vector<float> through = this->Photons.Leaving();
  const std::vector<float> inwards =
    this->Photons.LeavingOfOne(); // by symmetry, as much enters from a fluence of 1 outside
  double entered = 0.0;
  for (std::size_t face = 0; face < 6; ++face)
  {
    double power = this->Direct.image.escaped[face][this->Channel];
    entered += power;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const std::size_t known = this->Box.Known(i);
      // Links that reflect return some incident light immediately.
      const double squared = this->Voxels.bends ? this->Voxels.squared[known] : 1.0;
      const double entering = area * this->Voxels.incoming[face] * squared * inwards[face * voxels + i];
      const double passed = 2.0 * this->Voxels.passes[known] / (this->Voxels.passes[known] + 1.0);
      power += area * through[face * voxels + i] + entering * (1.0 / passed - 1.0);
      entered += entering / passed;
      if (!this->Voxels.crossing.empty() && this->Box.Beyond(known, face) == Outside)
      {
        power += area * this->Voxels.crossing[6 * known + face];
      }
    }
    light.facePowerOut[face][this->Channel] += power;
    light.balance.escaped[this->Channel] += power;
  }
  return entered;
}

void LatticeAccount::AddFlux(LightField& light) const
{
  const std::vector<float> flux = this->Photons.NetFlux();
  const std::size_t voxels = this->Box.Count();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double tau = this->Edge() * this->TheMedium.sigma_a.At(known, static_cast<int>(this->Channel));
    const double mean = tau > 1e-6 ? this->Voxels.lost[known] / tau : 1.0; // as fluence
    for (std::size_t a = 0; a < 3; ++a)
    {
      float& sum = light.netFlux[3 * this->Place(light, i) + a];
      sum = static_cast<float>(this->Direct.netFlux[3 * this->Place(light, known) + a] + mean * flux[a * voxels + i]);
      for (std::size_t face = 2 * a; face < 2 * a + 2 && !this->Voxels.crossing.empty(); ++face)
      {
        sum += static_cast<float>(this->FluxOfCrossing(known, face));
      }
    }
  }
}

/// Flux of the crossing source (Eq. (L13)) in the voxel that sends or receives it: from the place of first scattering
/// to the face, and from there to the centre of the next voxel.
double LatticeAccount::FluxOfCrossing(std::size_t known, std::size_t face) const
{
  const std::size_t beyond = this->Box.Beyond(known, face);
  const double out = face % 2 == 0 ? -1.0 : 1.0, crosses = this->Voxels.crossing[6 * known + face];
  const double comes = beyond == Outside ? 0.0 : this->Voxels.crossing[6 * beyond + (face ^ 1)];
  const double nearer =
    crosses > 0.0 ? NearerOfNormalBeam(this->TheMedium, known, static_cast<int>(this->Channel)) : 0.0;
  return (0.5 - nearer) * out * crosses - 0.5 * out * comes;
}

void LatticeAccount::AddTo(LightField& light, const std::vector<float>& fluence) const
{
  if (this->Settings.netFlux)
  {
    this->AddFlux(light);
  }
  light.balance.entered[this->Channel] += this->CountVoxels(light, fluence) + this->CountFaces(light);
}
}
