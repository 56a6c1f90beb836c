#include "LatticeBoltzmann/LatticeLight.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Refraction/Index/IndexField.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tyndall
{
namespace
{
void CheckCubes(const Grid& grid)
{
  if (!HasCubicVoxels(grid))
  {
    throw InvalidInput("The lattice's voxels have to be cubes; their edges are " + Text("%.6g", grid.spacing[0]) +
      ", " + Text("%.6g", grid.spacing[1]) + ", " + Text("%.6g", grid.spacing[2]) + ". Resample the image.");
  }
}

/// Checks that no voxel is too thick for its absorption: double precision limits the number of collisions in a voxel
/// that can be resolved.
void CheckThickness(const Medium& medium)
{
  // A voxel of an optical thickness (transport extinction times edge) above `thickest` is refused if its absorption
  // thickness (sigma_a times edge) is below `absorbsAtLeast`. At these two limits a collision absorbs the fraction
  // 1e-3 / 1e10 = 1e-13 of the light, well above the relative rounding error of a double, 1e-16.
  constexpr double thickest = 1e10, absorbsAtLeast = 1e-3;
  const double edge = medium.grid.spacing[0];
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < medium.Channels(); ++c)
    {
      const double thickness = edge * medium.TransportSigmaT(i, c);
      if (thickness > thickest && edge * medium.sigma_a.At(i, c) < absorbsAtLeast)
      {
        throw InvalidInput("Voxel " + VoxelName(medium.grid, i) + " has optical thickness " + Text("%.6g", thickness) +
          " and absorbs next to nothing of it; the lattice's numbers hold up to 1e10. Make "
          "sigma_s or voxels smaller.");
      }
    }
  }
}

void CheckOwnBlock(const Domain& domain, const Medium& medium, const Field& ior, const LatticeSettings& settings)
{
  Check(settings);
  const std::string refused = domain.IsSerial() ? "" : NotInBlocks(settings);
  Require(refused.empty(), "A lattice that is spread over ranks is not solved with " + refused + ".");
  if (domain.IsEmpty())
  {
    return;
  }
  CheckCubes(medium.grid);
  CheckThickness(medium);
  CheckIndex(ior, Domain(medium.grid));
}
}

void CheckLattice(const Domain& domain, const Medium& medium, const Field& ior, const LatticeSettings& settings)
{
  domain.Collective([&] {
    Require(static_cast<int>(domain.Partition().blocks.size()) == domain.Comm().Ranks(),
      "There is not a block for each rank.");
    CheckOwnBlock(domain, medium, ior, settings);
  });
  RequireSame(domain.Comm(), "settings of the lattice", true,
    { 1.0 * settings.directions, settings.tolerance, 1.0 * settings.interleaves });
  RequireSame(domain.Comm(), "whether there is a refractive index", !domain.IsEmpty(), { ior.values ? 1.0 : 0.0 });
}

bool NeedsFirstMoments(const Medium& medium, const LatticeSettings& settings)
{
  constexpr double thick = 0.1; // mean free paths across a voxel above which the position of first scattering matters
  return settings.scheme == LatticeScheme::Conservative && AnyVoxelIsThickerThan(thick, medium);
}

void RequireOpenAxes(const LatticeSettings& settings)
{
  Require(!settings.periodic[0] && !settings.periodic[1] && !settings.periodic[2],
    "Photons do not come back across periodic axes. Switch PeriodicX, PeriodicY and PeriodicZ off, "
    "or light the lattice by lights.");
}

std::array<Rgb, 6> EscapedByChannel(const LightField& light)
{
  std::array<Rgb, 6> escaped = light.facePowerOut;
  for (Rgb& face : escaped)
  {
    face = light.channels == 1 ? Rgb{ face[0], face[0], face[0] } : face;
  }
  return escaped;
}

UncollidedImage ImageOf(const PhotonLight& photons)
{
  UncollidedImage image;
  image.fluence = { photons.light.fluence.data(), photons.light.channels };
  image.meanDirection = { photons.meanDirection.empty() ? nullptr : photons.meanDirection.data(), 3 };
  image.escaped = EscapedByChannel(photons.light);
  return image;
}

void DoubtPhotons(const PhotonLight& photons, std::size_t all, LightField& light)
{
  light.doubts.insert(light.doubts.end(), photons.light.doubts.begin(), photons.light.doubts.end());
  if (photons.missed > 0)
  {
    light.doubts.push_back(std::to_string(photons.missed) + " of " + std::to_string(all) +
      " photons do not meet the medium, so their power is not in it. Give PhotonEmitter the same medium.");
  }
}

LightField BeginLight(const LatticeProblem& problem, const LatticeSettings& settings)
{
  LightField light;
  light.channels = problem.Channels();
  light.fluence.resize(problem.Box().Count() * static_cast<std::size_t>(light.channels));
  light.fluenceDirect = light.fluence;
  light.netFlux.resize(settings.netFlux ? 3 * light.fluence.size() : 0);
  return light;
}

namespace
{
/// Sets leftOut, and the quantities of `light` that are derived from its fluence; `light` is in the units of the
/// solver.
void DescribeLight(
  LightField& light, const Device& device, bool anisotropic, const LatticeSettings& settings, double thickest)
{
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.device = NameWithStreaming(device);
  if (anisotropic)
  {
    light.leftOut.emplace_back(
      "anisotropy: diffuses as isotropic scattering with sigma_s (1 - g) (similarity relation)");
  }
  if (!settings.netFlux)
  {
    light.leftOut.emplace_back(left_out::NetFlux);
  }
  if (settings.scheme == LatticeScheme::Published && thickest > 1.0)
  {
    light.doubts.push_back(
      "As published, collisions are positive only where sigma_t times a voxel's edge is at most 1; "
      "here it is up to " +
      Text("%.3g", thickest) + ", and light may swing and grow. Choose the conservative scheme, or smaller voxels.");
  }
}

/// Sums powers over ranks, and sets leftOver to the power that densities still gain per step.
void SumPowers(const Domain& domain, LightField& light)
{
  EnergyBalance& balance = light.balance;
  std::vector<Rgb*> powers = { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped };
  for (Rgb& face : light.facePowerOut)
  {
    powers.push_back(&face);
  }
  SumOverRanks(domain, powers);
  balance.leftOver = balance.entered + balance.emitted - balance.absorbed - balance.escaped;
}

/// Sets `converged` and adds warnings to `light`, which is in the user's units.
void JudgeLight(LightField& light, const Illumination& illumination, const LatticeSettings& settings)
{
  PropagationSettings judged = AsPropagation(settings);
  judged.tolerance = settings.tolerance;
  JudgeConvergence(judged, light, false);
  if (Reflects(illumination))
  {
    light.doubts.emplace_back(
      "FaceAlbedo gives back diffuse light only, not what leaves without having been scattered.");
  }
  light.faceAlbedo = illumination.faceAlbedo;
}
}

void FinishLight(LightField& light, const Device& device, const LatticeProblem& problem,
  const Illumination& illumination, const LatticeSettings& settings, double thickest, const Rgb& lost)
{
  const Domain& domain = problem.TheDomain();
  SumPowers(domain, light);
  light.balance.entered += domain.Sum(lost);
  const bool anisotropic = problem.IsAnisotropic();
  domain.Collective([&] { DescribeLight(light, device, anisotropic, settings, thickest); });
  if (settings.scheme == LatticeScheme::Conservative)
  {
    JudgeBalance(light, domain, problem.OwnMedium());
  }
  problem.Undo(light);
  domain.Collective([&] { JudgeLight(light, illumination, settings); });
}
}
