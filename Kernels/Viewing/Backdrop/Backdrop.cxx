#include "Viewing/Backdrop/Backdrop.h"

#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
std::array<int, 2> FaceSize(const Grid& grid, int face)
{
  const PlaneAxes axes = AcrossAxis(face / 2);
  return { grid.size[axes.u], grid.size[axes.v] };
}

namespace
{
/// Copies values given per cell of the box's faces (BoxFaces.h) and adds to each face a border of one cell, which
/// repeats the face's outermost cells.
std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells)
{
  std::vector<cl_float4> padded;
  std::size_t first = 0;
  for (int face = 0; face < 6; ++face)
  {
    const std::array<int, 2> size = FaceSize(grid, face);
    for (int j = -1; j <= size[1]; ++j)
    {
      for (int i = -1; i <= size[0]; ++i)
      {
        const std::size_t row = std::clamp(j, 0, size[1] - 1);
        padded.push_back(cells[first + row * size[0] + std::clamp(i, 0, size[0] - 1)]);
      }
    }
    first += static_cast<std::size_t>(size[0]) * size[1];
  }
  return padded;
}

/// Bit mask of the reflecting faces, bit 0 for -x to bit 5 for +z.
int GroundFaces(const SolvedLight& light)
{
  int faces = 0;
  for (int face = 0; face < 6 && light.facePower.values; ++face)
  {
    faces |= IsBlack(light.faceAlbedo[face]) ? 0 : 1 << face;
  }
  return faces;
}

constexpr int Emits = 6; ///< bit of face -x among the bits of the faces through which light enters

/// Bit mask of the faces that pictures show. Bits 0 to 5: reflecting faces. Bits 6 to 11: other faces through which
/// light enters, set only in pictures made of angular moments.
int ShownFaces(const SolvedLight& light, bool byMoments)
{
  int faces = GroundFaces(light);
  for (int face = 0; face < 6 && byMoments; ++face)
  {
    const bool emits = !IsBlack(light.faceRadiance[face]) && (faces >> face & 1) == 0;
    faces |= emits ? 1 << (Emits + face) : 0;
  }
  return faces;
}

/// Radiance of faces seen from inside, W / (length^2 sr), as [face][row][cell of the row] with a border of one cell
/// around each face that repeats the outermost cells. A reflecting face (ground) has albedo / pi times the outgoing
/// partial current of the cell (numerics.md, Eq. (111a)). Any other face has the radiance that enters through it.
std::vector<cl_float4> FaceLight(const Grid& grid, const SolvedLight& light, int bits)
{
  std::vector<cl_float4> cells(BoxFaceCellCount(grid));
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    for (int c = 0; c < 3; ++c)
    {
      const bool reflects = (bits >> cell.face & 1) != 0;
      const double leaves =
        reflects ? light.facePower.At(cell.number, light.facePower.components == 3 ? c : 0) / Pi : 1.0;
      const Rgb& part = reflects ? light.faceAlbedo[cell.face] : light.faceRadiance[cell.face];
      cells[cell.number].s[c] = static_cast<float>(part[c] * leaves);
    }
  });
  return WithBorders(grid, cells);
}

/// Radiance, divided by n^2, that a white table would reflect, W / (length^2 sr). A table is a plane at one face of the
/// box that reflects light; a white one has diffuse reflectance 1. The radiance is the irradiance by the light in the
/// adjacent voxels, divided by pi (numerics.md, Eq. (111)). One value per cell of the face, with a border of one cell
/// that repeats the outermost cells.
/// @param ior        refractive index; null: 1
/// @param fromBelow  whether light may enter through the table's face, because there is an environment
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow)
{
  const int axis = face / 2;
  const double outwards = face % 2 ? 1.0 : -1.0;
  const std::array<int, 2> size = FaceSize(grid, face);
  const std::array<std::size_t, 3> strides = grid.Strides();
  std::vector<cl_float4> lit;
  lit.reserve(static_cast<std::size_t>(size[0] + 2) * (size[1] + 2));
  for (int j = -1; j <= size[1]; ++j)
  {
    for (int i = -1; i <= size[0]; ++i)
    {
      const std::size_t voxel = std::clamp(i, 0, size[0] - 1) * strides[AcrossAxis(axis).u] +
        std::clamp(j, 0, size[1] - 1) * strides[AcrossAxis(axis).v] +
        (face % 2 ? grid.size[axis] - 1 : 0) * strides[axis];
      const double n = ior.values ? ior.values[voxel] : 1.0;
      glm::dvec3 mean(0.0);
      if (meanDirection.values)
      {
        const float* m = meanDirection.values + 3 * voxel;
        mean = glm::dvec3(m[0], m[1], m[2]) / std::max(1.0, glm::length(glm::dvec3(m[0], m[1], m[2])));
      }
      const double even = fromBelow || !meanDirection.values ? 0.25 * (1.0 - glm::length(mean)) : 0.0;
      const double part = even + std::max(outwards * mean[axis], 0.0);
      const glm::dvec3 all(fluence.At(voxel, 0), fluence.At(voxel, 1), fluence.At(voxel, 2));
      lit.push_back(Float4(all * (part / (Pi * n * n)), 0.0));
    }
  }
  return lit;
}

/// The correction SurfaceLight begins where a voxel at the face has the optical thickness ThickAtSurface. It is fully
/// applied at AllOfIt times this thickness.
constexpr double AllOfIt = 2.0;
/// The correction SurfaceLight also depends on the optical thickness of the medium behind a cell of a face, in mean
/// free paths: it begins at Translucent and is fully applied from Opaque on.
constexpr double Translucent = 1.5, Opaque = 3.0;
constexpr double EnoughLeft = 1e-5; ///< transmittance at which the march for the correction ends
constexpr int MostSteps = 200;
/// Smallest step of the march for the correction, voxels; smaller steps give equal results.
constexpr double FinestStep = 0.1;

/// Extinction and source (emitted and scattered radiance per unit length) of one channel, as the march of rays uses
/// them.
struct Coefficients
{
  double sigma, source;
};

Coefficients CoefficientsOf(const Medium& medium, const SolvedLight& light, std::size_t voxel, int channel)
{
  const double scatters = medium.sigma_s.At(voxel, channel);
  const double sigma = scatters + medium.sigma_a.At(voxel, channel);
  return { sigma, scatters * light.fluence.At(voxel, channel) / (4.0 * Pi) + medium.emission.At(voxel, channel) };
}

/// Smooth step: 0 for x below `low`, 1 above `high`, 3 t^2 - 2 t^3 in between.
double Between(double low, double high, double x)
{
  const double part = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return part * part * (3.0 - 2.0 * part);
}

/// Optical thickness, in mean free paths, of a path of `length` in a voxel, with the solver's transport coefficient.
double Thickness(const Medium& medium, std::size_t voxel, int channel, double length)
{
  return length * medium.TransportSigmaT(voxel, channel);
}

/// Fraction, in [0, 1], of the correction SurfaceLight that is applied in a cell of a face.
double PartAt(const Medium& medium, const BoxFaceCell& cell, int channel)
{
  const int axis = cell.face / 2;
  const double edge = medium.grid.spacing[axis];
  const double first = Thickness(medium, cell.voxel, channel, edge);
  const double thick = Between(ThickAtSurface, AllOfIt * ThickAtSurface, first);
  double all = 0.0;
  const auto step = static_cast<std::ptrdiff_t>(cell.inward) - static_cast<std::ptrdiff_t>(cell.voxel);
  for (int n = 0; thick > 0.0 && n < std::min(VoxelsBehindSurface, medium.grid.size[axis]); ++n)
  {
    all += Thickness(medium, cell.voxel + n * step, channel, edge);
  }
  return thick * Between(Translucent, Opaque, all);
}

/// Coefficients of the first three voxels behind a cell of a face, for one channel. Deeper inside, the medium is taken
/// to have the coefficients of the third voxel.
struct Column
{
  std::array<Coefficients, 3> voxels;
  double edge;   ///< edge of a voxel along the face's normal, in units of length
  double across; ///< mean edge of a voxel along the face, in units of length

  /// Coefficients at a depth, in voxels from the face: interpolated between voxel centres, constant between the face
  /// and the first centre.
  Coefficients At(double depth) const
  {
    const double place = std::clamp(depth - 0.5, 0.0, 2.0);
    const std::size_t first = place < 1.0 ? 0 : 1;
    const double part = place - static_cast<double>(first);
    const Coefficients& a = this->voxels[first];
    const Coefficients& b = this->voxels[first + 1];
    return { a.sigma + part * (b.sigma - a.sigma), a.source + part * (b.source - a.source) };
  }
};

/// Outgoing radiance, divided by 1 - transmittance of the path, that the march of rays computes at the face along a ray
/// at cosine mu to the normal.
/// @param step  step of the march, voxels
double Marched(const Column& column, double mu, double step)
{
  const double voxelsPerLength = std::hypot(mu / column.edge, std::sqrt(1.0 - mu * mu) / column.across);
  const double length = step / voxelsPerLength;
  double left = 1.0, radiance = 0.0;
  for (int n = 0; left > EnoughLeft && n < MostSteps; ++n)
  {
    const Coefficients there = column.At((n + 0.5) * length * mu / column.edge);
    const double tau = there.sigma * length;
    radiance += left * there.source * (tau > 1e-9 ? -std::expm1(-tau) / there.sigma : length);
    left *= std::exp(-tau);
  }
  return radiance / std::max(1.0 - left, 1e-6);
}

Column ColumnBehind(const Medium& medium, const SolvedLight& light, const BoxFaceCell& cell, int channel)
{
  const std::array<double, 3>& h = medium.grid.spacing;
  const int axis = cell.face / 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Column column;
  column.edge = h[axis];
  column.across = std::sqrt(2.0 / (1.0 / (h[u] * h[u]) + 1.0 / (h[v] * h[v])));
  const auto step = static_cast<std::ptrdiff_t>(cell.inward) - static_cast<std::ptrdiff_t>(cell.voxel);
  for (int n = 0; n < 3; ++n)
  {
    const std::size_t voxel = cell.voxel + std::min(n, medium.grid.size[axis] - 1) * step;
    column.voxels[n] = CoefficientsOf(medium, light, voxel, channel);
  }
  return column;
}

/// Correction SurfaceLight of one cell and channel, for each of the cosines SurfaceCosines to the normal, W / (length^2
/// sr).
/// @param step  step of the march, voxels
std::array<double, 4> Missing(
  const Medium& medium, const SolvedLight& light, const BoxFaceCell& cell, int channel, double step)
{
  std::array<double, 4> missing = {};
  const double part = PartAt(medium, cell, channel);
  if (part <= 0.0)
  {
    return missing;
  }
  const Column column = ColumnBehind(medium, light, cell, channel);
  const int components = light.surface.components;
  const int channels = components / static_cast<int>(SurfaceCosines.size());
  for (std::size_t n = 0; n < missing.size(); ++n)
  {
    const double leaves = light.surface.values[cell.number * components + n * channels + (channels == 3 ? channel : 0)];
    missing[n] =
      std::isnan(leaves) ? 0.0 : part * (leaves - Marched(column, SurfaceCosines[n], std::max(step, FinestStep)));
  }
  return missing;
}

/// Correction for rays that enter the box through optically thick voxels (numerics.md, Eq. (112)). It is the outgoing
/// radiance that the solver computed at the surface (`surface`), minus the radiance that the march of rays obtains by
/// interpolating the light between the centres of thick voxels. The correction sets in at an optical thickness
/// ThickAtSurface of the voxel and is complete at twice this thickness. It applies only where the medium behind is some
/// mean free paths thick, since it assumes the light of a half-space.
///
/// @param step   step of the march, voxels
/// @param block  position of the medium in a larger grid: only those of its faces that lie on the domain's boundary are
///   corrected. Its arrays must cover VoxelsBehindSurface voxels behind these faces, or the whole domain. Null: the
///   medium is the whole domain
/// @return W / (length^2 sr), [cosine][face][row][cell of the row], each face with a border of one cell that repeats
///   the outermost cells. Empty if no correction is needed
std::vector<cl_float4> SurfaceLight(const Medium& medium, const SolvedLight& light, double step, const GridBlock* block)
{
  const Grid& grid = medium.grid;
  std::array<std::vector<cl_float4>, SurfaceCosines.size()> cells;
  cells.fill(std::vector<cl_float4>(BoxFaceCellCount(grid)));
  bool any = false;
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    if (block && !IsOnFace(*block, grid.size, cell.face))
    {
      return;
    }
    for (int c = 0; c < 3; ++c)
    {
      const std::array<double, 4> missing = Missing(medium, light, cell, c, step);
      for (std::size_t n = 0; n < missing.size(); ++n)
      {
        cells[n][cell.number].s[c] = static_cast<float>(missing[n]);
        any |= missing[n] != 0.0;
      }
    }
  });
  std::vector<cl_float4> table;
  for (std::size_t n = 0; any && n < SurfaceCosines.size(); ++n)
  {
    const std::vector<cl_float4> padded = WithBorders(grid, cells[n]);
    table.insert(table.end(), padded.begin(), padded.end());
  }
  return table;
}

/// Split separates bright peaks of the environment from its smooth part with a quadrature of this many directions per
/// face of a cube.
constexpr int DirectionsOfPeaks = 25;

/// Pixels of the environment with an additional column on either side, for periodic interpolation.
std::vector<cl_float4> ClosedEnvironment(const Environment& environment)
{
  const int width = environment.width;
  std::vector<cl_float4> pixels(static_cast<std::size_t>(width + 2) * environment.height);
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < width + 2; ++i)
    {
      const std::size_t from = 3 * (static_cast<std::size_t>(j) * width + (i + width - 1) % width);
      pixels[static_cast<std::size_t>(j) * (width + 2) + i] = { { environment.radiance[from],
        environment.radiance[from + 1], environment.radiance[from + 2], 0.0f } };
    }
  }
  return pixels;
}

std::vector<cl_float4> LightOnTable(
  const SolvedLight& light, const Field& ior, const ViewSettings& settings, const ViewTraits& traits, bool fromBelow)
{
  const bool single = settings.singleScatteringOnly && light.fluenceDirect.values;
  return TableLight(traits.grid, single ? light.fluenceDirect : light.fluence, light.meanDirection,
    traits.bends ? ior : Field{}, settings.tableFace, fromBelow);
}

/// Whether the correction SurfaceLight is possible and valid. The solver's outgoing radiance at the faces (`surface`)
/// must be known, and the picture must show all light, without shadow rays, mean directions or a table.
bool ShowsSurface(const SolvedLight& light, const ViewTraits& traits)
{
  const bool plain = !traits.singleScatteringOnly && !traits.shadowRays && !traits.knowsFlow &&
    !traits.ShowsMoments() && traits.OnlyStraight();
  return plain && light.surface.values && light.fluence.values;
}
}

Backdrop::Backdrop(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
  const Field& ior, const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* block)
  : UnderSky(!illumination.environment.Empty() || !IsBlack(illumination.sky))
  , Sky(illumination.sky)
  , FaceBits(settings.showBackground ? ShownFaces(light, traits.ShowsMoments()) : 0)
{
  std::vector<cl_float4> all;
  const auto add = [&](const std::vector<cl_float4>& table) {
    const auto first = static_cast<int>(all.size());
    all.insert(all.end(), table.begin(), table.end());
    return first;
  };
  const tyndall::Environment& environment = illumination.environment;
  if (!environment.Empty() && settings.showBackground)
  {
    this->Size = { environment.width, environment.height };
    this->Turn = environment.toPicture;
    std::vector<cl_float4> shown = ClosedEnvironment(environment);
    if (traits.ShowsMoments())
    {
      // A picture made of angular moments has two passes, for scattered and for unscattered light. Peaks of the
      // environment are treated as lamps: the pass for unscattered light shows them (numerics.md, section 14.7).
      std::vector<cl_float4> sharp = std::move(shown);
      shown = ClosedEnvironment(Split(environment, EquiangularDirections(DirectionsOfPeaks)).smooth);
      for (std::size_t i = 0; i < sharp.size(); ++i)
      {
        for (int c = 0; c < 3; ++c)
        {
          sharp[i].s[c] -= shown[i].s[c];
        }
      }
      this->FirstSharp = add(sharp);
    }
    this->First.s[0] = add(shown);
  }
  if (this->FaceBits != 0)
  {
    this->First.s[1] = add(FaceLight(traits.grid, light, this->FaceBits));
  }
  if (ShowsSurface(light, traits))
  {
    this->First.s[2] = add(SurfaceLight(medium, light, settings.stepSize, block ? &block->block : nullptr));
    this->HasSurface = all.size() > static_cast<std::size_t>(this->First.s[2]);
  }
  if (traits.hasTable)
  {
    const std::vector<float> held = block ? HeldIndex(ior, *block, medium.grid.size) : std::vector<float>();
    const Field index = block ? Field{ held.empty() ? nullptr : held.data(), 1 } : ior;
    this->First.s[3] = add(LightOnTable(light, index, settings, traits, this->UnderSky));
  }
  this->Cells = Buffer<cl_float4>(device, all, "what is behind the medium");
}

void Backdrop::Describe(const ViewSettings& settings, bool sharp, ViewInfo& view) const
{
  const Rgb& colour = this->UnderSky ? this->Sky : settings.backgroundColor;
  view.background = Float4(Vector(colour), settings.showBackground ? 1.0 : 0.0);
  view.environment = Int4({ this->Size[0], this->Size[1], this->FaceBits });
  view.backdrop = this->First;
  view.backdrop.s[0] = sharp ? this->FirstSharp : this->First.s[0];
  for (int row = 0; row < 3; ++row)
  {
    view.toPicture[row] = Float4(Vector(this->Turn[row]));
  }
}
}
