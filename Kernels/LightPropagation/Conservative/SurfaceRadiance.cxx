#include "LightPropagation/Conservative/SurfaceRadiance.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Error of the power that diffusion predicts through a cell, relative to sqrt(1 - albedo) times the incident light
/// (Eq. (79)).
constexpr double Uncertainty = 0.1;
/// Error of the power that diffusion predicts through a cell that lamps light unevenly, relative to |1 - b| times the
/// lamp light that the cell reflects (Eq. (79)). b is the lamp light deposited in the cell's voxel, divided by the
/// deposit expected from the irradiance.
constexpr double UncertainPart = 0.5;
/// Largest ratio of lamp light deposited in a voxel to that expected from the irradiance.
constexpr double MostUneven = 4.0;
/// Largest decay rate, per mean free path, assumed for light from deep inside; at a rate of 1 its radiance along the
/// normal diverges.
constexpr double LargestExponent = 0.9;

/// Gauss-Legendre nodes and weights on [0, 1].
constexpr std::array<double, 4> Nodes = { 0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
  0.9305681557970263 };
constexpr std::array<double, 4> Weights = { 0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
  0.1739274225687269 };

/// Light of one lamp incident on a cell.
struct Beam
{
  double irradiance; ///< power per area of the face, W / length^2
  double cosine;     ///< cosine of the angle between the light's direction and the inward normal
};

/// Properties of a cell's voxel and light through the cell, in one channel.
struct Surface
{
  double albedo, emitted; ///< `emitted`: emission / sigma_a, W / (length^2 sr); 0 without absorption
  /// outgoing and incident power, each given as the isotropic radiance that carries it, W / (length^2 sr)
  double out, in;
  std::vector<Beam> beams;
  double brought = 1.0; ///< lamp light deposited in the voxel, relative to that expected from `beams`
};

/// Irradiance of a lamp at the centre of a cell, through vacuum; 0 if the light arrives from inside the box.
Beam BeamOf(const Light& lamp, const Grid& grid, const BoxFaceCell& cell, int channel)
{
  const int axis = cell.face / 2;
  const int u = AcrossAxis(axis).u;
  const int v = AcrossAxis(axis).v;
  const double inwards = cell.face % 2 ? -1.0 : 1.0;
  const std::array<double, 3> d = DirectionOf(lamp);
  if (lamp.type == LightType::Directional)
  {
    const double cosine = inwards * d[axis];
    return { cosine > 0.0 ? lamp.power[channel] * cosine : 0.0, cosine };
  }
  std::array<double, 3> way = {};
  way[axis] = (cell.face % 2 ? grid.Length(axis) : 0.0);
  way[u] = (cell.u + 0.5) * grid.spacing[u];
  way[v] = (cell.v + 0.5) * grid.spacing[v];
  for (int i = 0; i < 3; ++i)
  {
    way[i] += grid.origin[i] - lamp.position[i];
  }
  const double distance = std::hypot(way[0], way[1], way[2]);
  const double cosine = inwards * way[axis] / distance;
  if (!(cosine > 0.0))
  {
    return { 0.0, 0.0 };
  }
  const double part = lamp.type == LightType::Point ? 1.0
    : lamp.type == LightType::Spot                  ? (AngleFromAxis(lamp, way) <= HalfAngle(lamp) ? 1.0 : 0.0)
                                                    : std::max(std::cos(AngleFromAxis(lamp, way)), 0.0);
  const double ofAll = AxialIntensity(lamp) * part * cosine / (distance * distance);
  // A cone narrower than the cell lights a part of it: the irradiance is limited to the lamp's power over the cell's
  // area.
  return { lamp.power[channel] * std::min(ofAll, 1.0 / (grid.spacing[u] * grid.spacing[v])), cosine };
}

/// Outgoing radiance of a half-space at cosine mu: reflected light and emission, the first three terms of Eq. (77).
/// @param ofBeams  factor of the reflected light of lamps
double OfHalfSpace(const Surface& s, double mu, double ofBeams = 1.0)
{
  const double h = HalfSpaceH(s.albedo, mu);
  const double c = std::sqrt(1.0 - s.albedo);
  double radiance = s.in * (1.0 - c * h) + s.emitted * c * h;
  for (const Beam& beam : s.beams)
  {
    radiance +=
      ofBeams * s.albedo * beam.irradiance * HalfSpaceH(s.albedo, beam.cosine) * h / (4.0 * Pi * (mu + beam.cosine));
  }
  return radiance;
}

double DiffuseExitance(double albedo, double mu)
{
  const double k = std::min(std::sqrt(3.0 * (1.0 - albedo)), LargestExponent);
  return HalfSpaceH(albedo, mu) / (1.0 - k * mu);
}

/// Outgoing radiance of a cell at the cosines SurfaceCosines, W / (length^2 sr).
std::array<double, 4> Leaving(const Surface& s)
{
  // Isotropic radiances that carry the same outgoing power as OfHalfSpace() and as DiffuseExitance().
  double halfSpace = 0.0, deep = 0.0;
  for (std::size_t n = 0; n < Nodes.size(); ++n)
  {
    halfSpace += 2.0 * Nodes[n] * Weights[n] * OfHalfSpace(s, Nodes[n], s.brought);
    deep += 2.0 * Nodes[n] * Weights[n] * DiffuseExitance(s.albedo, Nodes[n]);
  }
  // Reflected fraction of isotropic light: its exact value, and that of diffusion with Marshak's boundary condition
  // (numerics.md, Eq. (79)).
  double exact = 0.0;
  for (std::size_t n = 0; n < Nodes.size(); ++n)
  {
    exact += 2.0 * Nodes[n] * Weights[n] * (1.0 - std::sqrt(1.0 - s.albedo) * HalfSpaceH(s.albedo, Nodes[n]));
  }
  const double k = std::sqrt(3.0 * (1.0 - s.albedo));
  const double diffused = (1.0 - 2.0 / 3.0 * k) / (1.0 + 2.0 / 3.0 * k);
  const double expected = halfSpace + (s.in - s.emitted) * (diffused - exact);
  double incoming = s.in;
  double uneven = 0.0;
  for (const Beam& beam : s.beams)
  {
    incoming += beam.irradiance / Pi;
    uneven += beam.irradiance / Pi * s.albedo * std::abs(s.brought - 1.0);
  }
  const double difference = s.out - expected;
  const double unknown = Uncertainty * std::sqrt(1.0 - s.albedo) * incoming + UncertainPart * uneven;
  const double known = std::max(std::abs(difference) - unknown, 0.0);
  const double amplitude = std::copysign(known, difference) / deep;
  std::array<double, 4> radiance;
  for (std::size_t n = 0; n < radiance.size(); ++n)
  {
    const double mu = SurfaceCosines[n];
    radiance[n] = std::max(OfHalfSpace(s, mu) + amplitude * DiffuseExitance(s.albedo, mu), 0.0);
  }
  return radiance;
}

/// Lamp light that collides in a cell's voxel, divided by the amount expected from the lamps' irradiance of those faces
/// of the voxel that lie on the box.
/// @param fluence  uncollided fluence of lamps in the voxel, W / length^2
double Brought(const Medium& medium, const std::array<bool, 6>& faces, const std::vector<Light>& lamps,
  const BoxFaceCell& cell, int channel, double fluence)
{
  const Grid& grid = medium.grid;
  const double sigma = medium.TransportSigmaT(cell.voxel, channel);
  const std::array<int, 3> at = grid.VoxelAt(cell.voxel);
  double expected = 0.0; // expected deposit of lamp light per volume, W / length^3
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    if (!faces[face] || at[axis] != (face % 2 ? grid.size[axis] - 1 : 0))
    {
      continue;
    }
    const BoxFaceCell there = { 0, face, at[AcrossAxis(axis).u], at[AcrossAxis(axis).v], cell.voxel, cell.voxel };
    for (const Light& lamp : lamps)
    {
      const Beam beam = BeamOf(lamp, grid, there, channel);
      expected += beam.irradiance > 0.0
        ? beam.irradiance * -std::expm1(-sigma * grid.spacing[axis] / beam.cosine) / grid.spacing[axis]
        : 0.0;
    }
  }
  return expected > 0.0 ? std::clamp(sigma * fluence / expected, 1.0 / MostUneven, MostUneven) : 1.0;
}

/// Whether any voxel at the given faces has an optical thickness above ThickAtSurface perpendicular to the face, in any
/// channel. Only then is SurfaceRadiance() more accurate than radiance computed from the fluence of the voxels.
bool IsThickAtFaces(const Medium& medium, const std::array<bool, 6>& faces, int channels)
{
  bool thick = false;
  ForBoxFaceCells(medium.grid, [&](const BoxFaceCell& cell) {
    for (int c = 0; c < channels && faces[cell.face]; ++c)
    {
      const double sigma = medium.TransportSigmaT(cell.voxel, c);
      thick |= sigma * medium.grid.spacing[cell.face / 2] > ThickAtSurface;
    }
  });
  return thick;
}
}

double HalfSpaceH(double albedo, double mu)
{
  if (mu <= 0.0)
  {
    return 1.0;
  }
  const double c = std::sqrt(1.0 - albedo);
  const double r = (1.0 - c) / (1.0 + c);
  return 1.0 / (1.0 - albedo * mu * (r + 0.5 * (1.0 - 2.0 * r * mu) * std::log1p(1.0 / mu)));
}

std::vector<float> SurfaceRadiance(const Medium& medium, const std::array<bool, 6>& faces,
  const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers)
{
  const Grid& grid = medium.grid;
  const int channels = static_cast<int>(powers.size());
  std::vector<float> radiance(BoxFaceCellCount(grid) * SurfaceCosines.size() * channels, 0.0f);
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    for (int c = 0; c < channels; ++c)
    {
      if (!faces[cell.face] || powers[c].net.empty())
      {
        continue;
      }
      const double absorbs = medium.sigma_a.At(cell.voxel, c);
      const double scatters = medium.TransportSigmaS(cell.voxel, c);
      const double sigma = absorbs + scatters;
      Surface s;
      s.albedo = sigma > 0.0 ? scatters / sigma : 0.0;
      s.emitted = absorbs > 0.0 ? medium.emission.At(cell.voxel, c) / absorbs : 0.0;
      const double back = powers[c].back.empty() ? 0.0 : powers[c].back[cell.number];
      s.in = (powers[c].in[cell.face] + back) / (4.0 * Pi * powers[c].halfRange);
      s.out = s.in + powers[c].net[cell.number] / Pi;
      for (const Light& lamp : lamps)
      {
        const Beam beam = BeamOf(lamp, grid, cell, c);
        if (beam.irradiance > 0.0)
        {
          s.beams.push_back(beam);
        }
      }
      if (!s.beams.empty() && powers[c].lamps)
      {
        s.brought = Brought(medium, faces, lamps, cell, c, powers[c].lamps[cell.voxel]);
      }
      const std::array<double, 4> leaves = Leaving(s);
      for (std::size_t n = 0; n < leaves.size(); ++n)
      {
        radiance[(cell.number * leaves.size() + n) * channels + c] = static_cast<float>(leaves[n]);
      }
    }
  });
  return radiance;
}

namespace
{
/// For each face -x, +x, ... +z of a block, whether it lies on a face of the box.
std::array<bool, 6> FacesAtBox(const VoxelBox& block, const Grid& whole, const std::array<bool, 3>& periodic)
{
  std::array<bool, 6> faces;
  for (int axis = 0; axis < 3; ++axis)
  {
    faces[2 * axis] = !periodic[axis] && block.first[axis] == 0;
    faces[2 * axis + 1] = !periodic[axis] && EndOf(block, axis) == whole.size[axis];
  }
  return faces;
}

/// Copies an array over the cells of a block's faces, with a fixed number of values per cell, to an array over the
/// cells of the box faces.
void PutCells(const std::vector<float>& ofBlock, const VoxelBox& block, const std::array<bool, 6>& faces,
  const Grid& grid, const Grid& whole, std::vector<double>& all)
{
  const std::size_t width = ofBlock.size() / BoxFaceCellCount(grid);
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    if (!faces[cell.face])
    {
      return;
    }
    const std::size_t place = LayoutOfFace(whole, cell.face).CellAt(block.VoxelAt(cell.voxel));
    std::copy_n(ofBlock.begin() + static_cast<std::ptrdiff_t>(cell.number * width), width,
      all.begin() + static_cast<std::ptrdiff_t>(place * width));
  });
}
}

std::vector<float> SurfaceRadiance(const Domain& domain, const std::array<bool, 3>& periodic, const Medium& medium,
  int channels, const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers)
{
  const std::array<bool, 6> faces = FacesAtBox(domain.Own(), domain.Whole(), periodic);
  const bool has = !domain.IsEmpty();
  if (!domain.Any(has && IsThickAtFaces(medium, faces, channels)))
  {
    return {};
  }
  std::vector<double> all;
  domain.Collective([&] {
    all.assign(BoxFaceCellCount(domain.Whole()) * SurfaceCosines.size() * channels, 0.0);
    if (has)
    {
      PutCells(SurfaceRadiance(medium, faces, lamps, powers), domain.Own(), faces, medium.grid, domain.Whole(), all);
    }
  });
  all = domain.Sum(all);
  return { all.begin(), all.end() };
}
}
