#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include "LatticeBoltzmann/FindUncollided.h"
#include "LatticeBoltzmann/Interleaved/InterleavedLattice.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "Light/LeftOut.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <algorithm>

namespace tyndall
{
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor)
{
  CheckLattice(domain, medium, ior, settings);
  const LatticeProblem problem(domain, medium, ior, illumination, settings);
  const Uncollided uncollided = FindUncollided(device, problem, settings, OfPart(monitor, 0.0, 0.1));
  LightField light = BeginLight(problem, settings);
  double thickest = 0.0;
  int dark = 0;
  for (int c = 0; c < light.channels; ++c)
  {
    LatticeChannel channel(device, problem, settings, uncollided, c);
    const double all = light.channels;
    channel.Solve(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
    dark += channel.IsDark() && settings.leaveOut;
  }
  if (dark > 0)
  {
    light.leftOut.push_back(left_out::DarkChannels(dark, light.channels));
  }
  FinishLight(light, device, problem, illumination, settings, thickest, uncollided.lost);
  return light;
}

LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor)
{
  CheckLattice(domain, medium, ior, settings);
  domain.Collective([&] { RequireOpenAxes(settings); });
  MarchSettings march;
  const bool needs = !domain.IsEmpty() && NeedsFirstMoments(medium, settings);
  march.meanDirection = settings.netFlux || domain.Any(needs);
  if (settings.interleaves)
  {
    PhotonMarcher marcher(device, domain, medium, ior, march);
    return InterleavedLattice(device, domain, medium, ior, illumination, settings).Solve(marcher, photons, monitor);
  }
  const PhotonLight found = PhotonMarcher(device, domain, medium, ior, march).March(photons, OfPart(monitor, 0.0, 0.5));
  Illumination lit = illumination;
  lit.uncollided = domain.IsEmpty() ? UncollidedImage() : ImageOf(found);
  LightField light = SolveLatticeBoltzmann(device, domain, medium, ior, lit, settings, OfPart(monitor, 0.5, 1.0));
  DoubtPhotons(found, static_cast<std::size_t>(domain.Sum(static_cast<double>(photons.size()))), light);
  return light;
}
}
