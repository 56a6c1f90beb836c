#include "LatticeBoltzmann/LatticeAccount.h"

#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "Numerics/Constants.h"

#include <algorithm>

namespace tyndall
{
void AddRows(const std::vector<ConvergenceRow>& rows, LightField& light)
{
  light.convergence.resize(std::max(light.convergence.size(), rows.size()));
  for (std::size_t row = 0; row < rows.size(); ++row)
  {
    ConvergenceRow& sum = light.convergence[row];
    sum.iteration = rows[row].iteration;
    sum.seconds += rows[row].seconds;
    sum.residual = std::max(sum.residual, rows[row].residual);
    sum.change = std::max(sum.change, rows[row].change);
  }
}

/// Fluence, and what voxels absorb and emit. @return W that entered as light that collides or is absorbed
double LatticeAccount::CountVoxels(LightField& light, const std::vector<float>& fluence) const
{
  const Medium& medium = this->Scene.medium;
  const int channel = static_cast<int>(this->Channel);
  const double edge = this->Edge(), area = edge * edge;
  double entered = 0.0;
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double tau = edge * medium.sigma_a.At(known, channel);
    const double direct = this->Direct.image.fluence.At(known, channel), lost = this->Voxels.lost[known];
    // Of what begins in a voxel, what is absorbed before it is in the lattice's light.
    const double own = this->Voxels.source[known] * (1.0 / this->Voxels.begins[known] - 1.0);
    const double absorbed = lost * fluence[i] + own;
    // Where much is absorbed in a step, fluence is the mean over that.
    const double scattered = tau > 1e-6 ? absorbed / tau : fluence[i];
    light.fluence[this->Place(light, i)] = static_cast<float>(direct + scattered);
    light.fluenceDirect[this->Place(light, i)] = static_cast<float>(direct);
    light.balance.absorbed[this->Channel] += area * (absorbed + tau * direct);
    light.balance.emitted[this->Channel] += area * edge * 4.0 * Pi * medium.emission.At(known, channel);
    entered += area * direct * (tau + edge * medium.sigma_s.At(known, channel));
  }
  return entered;
}

/// What leaves through the faces. @return W that came in through them, or left without having met anything
double LatticeAccount::CountFaces(LightField& light) const
{
  const std::size_t voxels = this->Box.Count();
  const double area = this->Edge() * this->Edge();
  const std::vector<float> through = this->Photons.Leaving();
  const std::vector<float> inwards = this->Photons.LeavingOfOne(); // light of fluence 1 outside comes in the same way
  double entered = 0.0;
  for (std::size_t face = 0; face < 6; ++face)
  {
    double power = this->Direct.image.escaped[face][this->Channel];
    entered += power;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const std::size_t known = this->Box.Known(i);
      // Of what comes in through links that give back a part, that leaves at once.
      const double squared = this->Voxels.bends ? this->Voxels.squared[known] : 1.0;
      const double entering = area * this->Voxels.incoming[face] * squared * inwards[face * voxels + i];
      const double passed = 2.0 * this->Voxels.passes[known] / (this->Voxels.passes[known] + 1.0);
      power += area * through[face * voxels + i] + entering * (1.0 / passed - 1.0);
      entered += entering / passed;
      if (!this->Voxels.crossing.empty() &&
        VoxelBeyond(this->Box.known, this->Settings.periodic, known, face) == Outside)
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
    const double tau = this->Edge() * this->Scene.medium.sigma_a.At(known, static_cast<int>(this->Channel));
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

/// What crosses a face at once goes from where it is first scattered to the face, and half of the way through the voxel
/// beyond: of a voxel what it sends through one of its faces, and what comes through that from there.
double LatticeAccount::FluxOfCrossing(std::size_t known, std::size_t face) const
{
  const std::size_t beyond = VoxelBeyond(this->Box.known, this->Settings.periodic, known, face);
  const double out = face % 2 == 0 ? -1.0 : 1.0, crosses = this->Voxels.crossing[6 * known + face];
  const double comes = beyond == Outside ? 0.0 : this->Voxels.crossing[6 * beyond + (face ^ 1)];
  const double nearer =
    crosses > 0.0 ? NearerOfNormalBeam(this->Scene.medium, known, static_cast<int>(this->Channel)) : 0.0;
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
