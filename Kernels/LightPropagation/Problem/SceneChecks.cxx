#include "LightPropagation/Problem/SceneChecks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int MomentsLookedAt = 8; ///< highest degree of phase-function moments that are compared between ranks

/// Whether a medium absorbs light, and whether light originates within it, by channel.
struct LightEnds
{
  std::array<bool, 3> absorbs = {}; ///< whether any voxel absorbs
  /// Whether any voxel emits, or scatters light of lamps with a position or uncollided light given as input; evaluated
  /// only in channels without absorption.
  std::array<bool, 3> begins = {};
};

LightEnds LightEndsIn(const Medium& medium, const Illumination& illumination)
{
  LightEnds ends;
  const auto any = [&](const Field& field, int channel) {
    bool found = false;
    for (std::size_t i = 0; i < medium.grid.VoxelCount() && field.values && !found; ++i)
    {
      found = field.At(i, channel) > 0.0f;
    }
    return found;
  };
  for (int c = 0; c < 3; ++c)
  {
    bool meets = illumination.uncollided.IsThere();
    for (const Light& light : illumination.lights)
    {
      meets = meets || (light.type != LightType::Directional && light.power[c] > 0.0);
    }
    ends.absorbs[c] = any(medium.sigma_a, c);
    ends.begins[c] = !ends.absorbs[c] && (any(medium.emission, c) || (meets && any(medium.sigma_s, c)));
  }
  return ends;
}
}

void RequireSame(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  if (domain.IsSerial())
  {
    return;
  }
  Communicator& communicator = domain.Comm();
  const bool has = !domain.IsEmpty();
  RequireSame(communicator, domain.Partition());
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a, sigma_s or emission, or one has no emission", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s), 1.0 * components(medium.emission) });
  RequireSame(communicator, "the components of UncollidedLight, or one has none", has,
    { 1.0 * components(illumination.uncollided.fluence), 1.0 * components(illumination.uncollided.meanDirection) });
  std::vector<double> escaped;
  for (const Rgb& face : illumination.uncollided.escaped)
  {
    escaped.insert(escaped.end(), face.begin(), face.end());
  }
  RequireSame(communicator, "what left of UncollidedLight", has, escaped);
  const bool varies = has && medium.phase.Varies();
  const auto cosine = [&](int c) { return has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  std::vector<double> scatters = { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) };
  for (int c = 0; c < 3; ++c)
  {
    const std::vector<double> moments = varies ? medium.phase.OfChannel(c).WithMeanCosine(0.5).Moments(MomentsLookedAt)
                                               : medium.phase.OfChannel(c).Moments(MomentsLookedAt);
    scatters.insert(scatters.end(), moments.begin(), moments.end());
  }
  RequireSame(communicator, "g, or the phase function", has, scatters);
  RequireSame(communicator, "settings", true,
    { 1.0 * settings.directionsPerFace, 1.0 * settings.mapResolution, 1.0 * settings.maximumOrders, settings.tolerance,
      1.0 * settings.netFlux, 1.0 * settings.firstMoments, 1.0 * settings.leaveOut, 1.0 * settings.staggeredRays,
      1.0 * settings.angularDegree, 1.0 * settings.storeMoments, 1.0 * settings.uncollidedDirections,
      1.0 * settings.facePower, 1.0 * settings.periodic[0], 1.0 * settings.periodic[1], 1.0 * settings.periodic[2],
      1.0 * static_cast<int>(settings.source), 1.0 * static_cast<int>(settings.acceleration), settings.emissionError });
  std::vector<double> light = { 1.0 * static_cast<double>(illumination.lights.size()), Sum(illumination.sky),
    1.0 * illumination.environment.width, 1.0 * illumination.environment.height };
  for (const Rgb& face : illumination.faces)
  {
    light.insert(light.end(), face.begin(), face.end());
  }
  for (const Rgb& albedo : illumination.faceAlbedo)
  {
    light.insert(light.end(), albedo.begin(), albedo.end());
  }
  for (const std::array<double, 3>& row : illumination.environment.toPicture)
  {
    light.insert(light.end(), row.begin(), row.end());
  }
  RequireSame(communicator, "what shines on it", true, light);
}

void RequireSink(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  const LightEnds own = domain.IsEmpty() ? LightEnds() : LightEndsIn(medium, illumination);
  std::vector<double> any(own.absorbs.begin(), own.absorbs.end());
  any.insert(any.end(), own.begins.begin(), own.begins.end());
  any = domain.Max(any);
  const std::array<bool, 3>& periodic = settings.periodic;
  const bool anyFace = !periodic[0] || !periodic[1] || !periodic[2];
  for (int c = 0; c < 3; ++c)
  {
    bool closed = true;
    for (int face = 0; face < 6; ++face)
    {
      closed = closed && (periodic[face / 2] || illumination.faceAlbedo[face][c] >= 1.0);
    }
    Require(!closed || !anyFace || any[c] != 0.0,
      "Every face gives back all light (FaceAlbedo 1) and the medium absorbs none: light would grow "
      "without end. Give a face an albedo below 1, or the medium some sigma_a.");
    Require(anyFace || any[c] != 0.0 || any[3 + c] <= 0.0 || settings.maximumOrders != 0,
      "All three axes are periodic and the medium absorbs no light: what begins in it would grow "
      "without end. Leave an axis open, give the medium some sigma_a, or set MaximumOrders.");
  }
}

void Check(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  domain.Collective([&] {
    if (!domain.IsSerial())
    {
      domain.Partition().Check();
    }
    if (!domain.IsEmpty() || domain.IsSerial()) // a serial grid without voxels is an error
    {
      Check(medium);
      Check(illumination);
      Check(illumination.uncollided, medium);
      Check(settings);
      CheckFaceAlbedo(illumination, settings.periodic);
      Require(medium.grid.size == domain.Own().size,
        "The medium of rank " + std::to_string(domain.Rank()) + " does not have the size of its block.");
    }
  });
  RequireSame(domain, medium, illumination, settings);
  RequireSink(domain, medium, illumination, settings);
}
}
