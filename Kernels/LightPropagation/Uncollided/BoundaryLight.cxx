#include "LightPropagation/Uncollided/BoundaryLight.h"

#include "Device/Errors.h"
#include "LightPropagation/Sweep/SweepShared.h"
#include "Medium/BoxFaces.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr double Rounding = 1e-6; ///< relative difference of radiances that are taken as equal
/// Rays without fractional moves, i.e. moves of only a part of a ray's power (numerics.md, Eq. (21)), do not carry
/// exactly the incident power into the box. This is the largest accepted relative difference between these powers. In a
/// box of one voxel, rays without fractional moves miss up to a fifth of the power through one face.
constexpr double MissedAtMost = 0.3;

int FaceOf(const Direction& direction, int axis)
{
  return EntryFace(axis, direction.omega[axis] > 0.0);
}

bool Enough(double exact, double whole)
{
  return std::abs(whole - exact) <= MissedAtMost * exact;
}

/// Incident power, W: its exact value, and `whole`, the power that rays carry into the box without fractional moves.
struct EnteringRays
{
  Rgb exact = {}, whole = {};

  void Add(const Rgb& radiance, double power, double exactRays, double wholeRays)
  {
    this->exact += Times(Times(radiance, exactRays), power);
    this->whole += Times(Times(radiance, wholeRays), power);
  }
};
}

BoundaryLight::BoundaryLight(const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions,
  const Illumination& illumination, const Environment& farAway)
  : TheGrid(grid)
  , Periodic(settings.periodic)
  , MapResolution(settings.mapResolution)
  , Directions(directions)
  , Faces(illumination.faces)
  , FromFarAway(directions.Set().directions.size())
{
  const std::vector<Rgb> radiance = BoundaryRadiance(directions.Set(), farAway, illumination.sky);
  for (std::size_t d = 0; d < radiance.size(); ++d)
  {
    const std::vector<int> all = directions.AllOf(static_cast<int>(d));
    for (const int one : all)
    {
      for (int c = 0; c < 3; ++c)
      {
        this->FromFarAway[d][c] += radiance[one][c] / static_cast<double>(all.size());
      }
    }
  }
  this->FindRange();
}

void BoundaryLight::FindRange()
{
  Rgb least, most = {};
  least.fill(std::numeric_limits<double>::max());
  for (std::size_t d = 0; d < this->FromFarAway.size(); ++d)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Rgb in = this->Incoming(static_cast<int>(d), FaceOf(this->Directions.Set().directions[d], axis));
      for (int c = 0; c < 3 && !this->Periodic[axis]; ++c)
      {
        least[c] = std::min(least[c], in[c]);
        most[c] = std::max(most[c], in[c]);
      }
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    this->AnyLight = this->AnyLight || most[c] > 0.0;
    this->AllAlike = this->AllAlike && (most[c] <= 0.0 || most[c] - least[c] <= Rounding * most[c]);
  }
}

bool BoundaryLight::IsLit(int direction) const
{
  bool lit = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Rgb in = this->Incoming(direction, FaceOf(this->Directions.Set().directions[direction], axis));
    lit = lit || (!this->Periodic[axis] && Sum(in) > 0.0);
  }
  return lit;
}

SweepBoundary BoundaryLight::Boundary() const
{
  return [this](int direction, int face) { return this->Incoming(direction, face); };
}

std::array<Rgb, 6> BoundaryLight::IncomingPower() const
{
  std::array<Rgb, 6> power = {};
  const std::vector<Direction>& directions = this->Directions.Set().directions;
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int face = FaceOf(directions[d], axis);
      if (!this->Periodic[axis])
      {
        power[face] +=
          Times(this->Incoming(static_cast<int>(d), face), directions[d].weight * std::abs(directions[d].omega[axis]));
      }
    }
  }
  return power;
}

/// Incident power through all faces, W: its exact value, and the power that rays carry into the box without fractional
/// moves (moves of only a part of a ray's power).
std::pair<Rgb, Rgb> BoundaryLight::EnteringPower() const
{
  EnteringRays entering;
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes axes = AcrossAxis(axis);
    const std::array<int, 3>& n = this->TheGrid.size;
    const double planes = PlanesOfPattern(n[axis], this->Periodic[axis]);
    if (planes <= 2.0)
    {
      continue; // with so few planes, fractional moves hardly change the power that enters through the lateral faces
    }
    for (const Bundle& bundle : BundlesAlong(
           axis, this->TheGrid, this->Periodic, this->Directions.Set(), this->MapResolution, this->Directions.Starts()))
    {
      const std::array<double, 2> moves = { bundle.tangentU * planes, bundle.tangentV * planes };
      const std::array<double, 2> wholeMoves = { std::floor(bundle.startU + moves[0] + 1e-9),
        std::floor(bundle.startV + moves[1] + 1e-9) };
      for (const Member& member : bundle.members)
      {
        for (const int direction : { member.direction, member.opposite })
        {
          const bool swapped = member.uFromU == 0;
          const auto add = [&](int through, double exactRays, double wholeRays) {
            const int face = FaceOf(this->Directions.Set().directions[direction], through);
            const Rgb radiance = this->Periodic[through] ? Rgb{} : this->Incoming(direction, face);
            entering.Add(radiance, bundle.power, exactRays, wholeRays);
          };
          const double across = static_cast<double>(n[axes.u]) * n[axes.v];
          add(axis, across, across);
          add(axes.u, moves[swapped] * n[axes.v], wholeMoves[swapped] * n[axes.v]);
          add(axes.v, moves[!swapped] * n[axes.u], wholeMoves[!swapped] * n[axes.u]);
        }
      }
    }
  }
  return { entering.exact, entering.whole };
}

bool BoundaryLight::HasEnoughRays(
  const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions)
{
  bool enough = true;
  for (int face = 0; face < 6; ++face)
  {
    Illumination shining;
    shining.faces[face][0] = settings.periodic[face / 2] ? 0.0 : 1.0;
    const auto [exact, whole] = BoundaryLight(grid, settings, directions, shining, {}).EnteringPower();
    enough = enough && Enough(exact[0], whole[0]);
  }
  return enough;
}

void BoundaryLight::CheckRays(int channels) const
{
  const auto [exact, whole] = this->EnteringPower();
  for (int c = 0; c < channels; ++c)
  {
    if (!Enough(exact[c], whole[c]))
    {
      const std::array<double, 3>& h = this->TheGrid.spacing;
      throw InvalidInput("Whole rays bring " + Text("%.3g", 100.0 * whole[c] / exact[c]) +
        "% of the light that shines through the box's faces: too few of them meet the faces that shine, for voxels "
        "of " +
        Text("%g", h[0]) + " x " + Text("%g", h[1]) + " x " + Text("%g", h[2]) +
        " are too unequal, or directions too few. Resample to voxels of more equal edges, or raise MapResolution, "
        "DirectionsPerFace or UncollidedDirections.");
    }
  }
}

namespace
{
/// Maximum number of rays whose powers are stored during a sweep, for one sense of marching: 128 MiB of floats.
constexpr std::size_t MostRays = std::size_t(1) << 25;

/// Removes fractional moves (moves of only a part of a ray's power), so that all power of a ray follows a straight
/// line. Fractional moves make the incident power of boundary sources exact, but in an emitting medium they would
/// change path lengths in the outermost emitting voxels.
void MoveAsLines(std::vector<Bundle>& bundles)
{
  for (Bundle& bundle : bundles)
  {
    bundle.movesU.clear();
    bundle.movesV.clear();
  }
}
}

SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor)
{
  // Boundary source of radiance 0. Without a boundary source, the sweep would not clear the maps (ray powers) of the
  // opposite sense of marching.
  const SweepBoundary dark = [](int, int) { return Rgb{}; };
  const Grid& grid = volume.domain.Whole();
  const int channels = volume.layout.Groups().front().count; // number of channels that are swept together
  AngularValues values;
  volume.domain.Collective([&] { values = volume.basis ? along.Values(*volume.basis) : AngularValues(); });
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    std::vector<Bundle> bundles;
    volume.domain.Collective([&] { bundles = along.LitAlong(part / 2, part % 2, isLit); });
    if (!incoming)
    {
      MoveAsLines(bundles);
    }
    const PlaneAxes axes = AcrossAxis(part / 2);
    const std::size_t plane = static_cast<std::size_t>(grid.size[axes.u]) * grid.size[axes.v];
    const std::size_t most = std::max<std::size_t>(MostRays / (MaxMembers * plane * channels), 8);
    for (std::size_t first = 0; first < bundles.size(); first += most)
    {
      const std::vector<Bundle> some(bundles.begin() + first, bundles.begin() + std::min(first + most, bundles.size()));
      const double all = 6.0 * static_cast<double>(bundles.size());
      const double before = part / 6.0 + static_cast<double>(first) / all;
      const Monitor ofSome = OfPart(monitor, before, before + static_cast<double>(some.size()) / all);
      SweepRequest request = { volume.deposit, { { part / 2, some } } };
      request.angular = volume.basis ? &values : nullptr;
      Add(tally, volume.makeSweep(request)->Apply(source, incoming ? incoming : dark, ofSome));
    }
  }
  return tally;
}

UncollidedBoundary::UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light)
  : Settings(settings)
  , Light(light)
{
}

SweepTally UncollidedBoundary::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto isLit = [this](int direction) { return !this->Settings.leaveOut || this->Light.IsLit(direction); };
  return SweepAlong(volume, this->Light.Along(), isLit, nullptr, this->Light.Boundary(), monitor);
}
}
