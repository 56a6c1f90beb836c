#include "LightPropagation/Published/SequentialRays.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
void AddTo(Rgb& power, const float* radiance, double beamPower)
{
  for (int c = 0; c < 3; ++c)
  {
    power[c] += beamPower * radiance[c];
  }
}

/// (1 - exp(-sigma length)) / sigma; its series where the difference would cancel.
double Depth(double sigma, double left, double length)
{
  return sigma * length > 1e-6 ? (1.0 - left) / sigma : length * (1.0 - 0.5 * sigma * length);
}

/// @return whether the grid ends there; the position is then on its other side
bool Step(int& position, int move, int size)
{
  position += move;
  const bool outside = position < 0 || position == size;
  position = outside ? (position < 0 ? size - 1 : 0) : position;
  return outside;
}
}

SequentialRays::SequentialRays(const Grid& whole, const std::optional<PublishedSlab>& slab, const Medium& medium,
  const PublishedModel& model, const PropagationSettings& settings)
  : Whole(whole)
  , Slab(slab)
  , Size(medium.grid.size)
  , Model(model)
  , Settings(settings)
  , Channels(model.Channels())
  , Sources(model.SourceDirections().size())
  , Moments(model.MomentCount(), std::vector<double>(medium.grid.VoxelCount() * model.Channels()))
  , Coefficients(model.MomentCount())
{
  const std::size_t values = medium.grid.VoxelCount() * this->Channels;
  this->Extinction.resize(values);
  this->Scattering.resize(values);
  std::vector<float> emission(values);
  for (std::size_t i = 0; i < values; ++i)
  {
    const std::size_t voxel = i / this->Channels;
    const int c = static_cast<int>(i % this->Channels);
    this->Scattering[i] = medium.sigma_s.At(voxel, c);
    this->Extinction[i] = medium.sigma_a.At(voxel, c) + this->Scattering[i];
    emission[i] = medium.emission.At(voxel, c);
  }
  for (const int d : model.SourcesReadAlong(slab ? slab->axis : -1))
  {
    this->Sources[d] = emission; // "Initialize U with medium emitted light"
  }
}

void SequentialRays::DarkenMoments()
{
  for (std::vector<double>& moment : this->Moments)
  {
    std::fill(moment.begin(), moment.end(), 0.0);
  }
}

MapGeometry SequentialRays::MapOf(int direction) const
{
  const DirectionSet& set = this->Model.Directions();
  return { this->Whole, this->Settings, set.directions[direction], direction, set.PerFace() };
}

std::size_t SequentialRays::FloatsOfMap(int direction) const
{
  const MapGeometry map = this->MapOf(direction);
  const std::size_t resolution = static_cast<std::size_t>(this->Settings.mapResolution);
  return resolution * resolution * map.sizeU * map.sizeV * this->Channels;
}

/// Whether a plane of the whole grid is.
bool SequentialRays::IsHere(const MapGeometry& map, int plane) const
{
  return !this->Slab ||
    (this->Slab->axis == map.axis && plane >= this->Slab->first && plane < this->Slab->first + this->Slab->planes);
}

int SequentialRays::PlaneAt(const MapGeometry& map, int onTheWay)
{
  return map.forward ? onTheWay : map.planes - 1 - onTheWay;
}

std::vector<float> SequentialRays::Send(int direction, int order, const std::vector<float>& given,
  PublishedFaces& faces, SweepTally& tally, const Monitor& monitor)
{
  const MapGeometry map = this->MapOf(direction);
  for (std::size_t k = 0; k < this->Coefficients.size(); ++k)
  {
    this->Coefficients[k] = static_cast<float>(this->Model.Coefficient(static_cast<int>(k), direction));
  }
  const Sending sending = { map, order, faces, tally, this->Sources[this->Model.SourceOf(direction)].data() };
  const int resolution = this->Settings.mapResolution;
  const int elementsU = map.sizeU * resolution;
  const int elementsV = map.sizeV * resolution;
  const int last = PlaneAt(map, map.planes - 1);
  const bool ends = this->IsHere(map, last), around = this->Settings.periodic[map.axis];
  std::vector<float> behind(ends && !around ? 0 : this->FloatsOfMap(direction));
  for (int s = 0; s < elementsV; ++s)
  {
    const double startV = map.StartOfOrder((s % resolution + 0.5) / resolution, map.slopeV, order);
    Report(monitor, static_cast<double>(s) / elementsV);
    for (int r = 0; r < elementsU; ++r)
    {
      const double startU = map.StartOfOrder((r % resolution + 0.5) / resolution, map.slopeU, order);
      std::size_t element = static_cast<std::size_t>(s) * elementsU + r;
      Ray ray{ direction, r / resolution, s / resolution, {} };
      this->Start(ray, given.empty() ? nullptr : given.data() + element * this->Channels, sending);
      this->Follow(ray, startU, startV, sending);
      if (ends && !around)
      {
        this->Leave(ray, map.axis, last, map.beamPower, sending);
        continue;
      }
      if (ends)
      {
        const int u = ray.u * resolution + r % resolution;
        const int v = ray.v * resolution + s % resolution;
        element = static_cast<std::size_t>(v) * elementsU + u;
        AddTo(tally.onTheWay, ray.radiance, map.beamPower);
      }
      std::copy_n(ray.radiance, this->Channels, behind.begin() + static_cast<std::ptrdiff_t>(element * this->Channels));
    }
  }
  return behind;
}

/// @param given  radiance; null: none
void SequentialRays::Start(Ray& ray, const float* given, const Sending& sending) const
{
  const MapGeometry& map = sending.map;
  const bool begins = this->IsHere(map, PlaneAt(map, 0));
  if (begins && sending.order == 0)
  {
    this->Enter(ray, this->Model.Boundary(ray.direction, map.axis), sending);
  }
  else if (given)
  {
    std::copy_n(given, this->Channels, ray.radiance);
  }
  if (begins && !this->Settings.periodic[map.axis])
  {
    this->ComeBack(ray, map.axis, PlaneAt(map, 0), 1.0, sending);
  }
}

/// Eq. (3), then the ray's part of Eq. (4).
// Inline, as this is done for each voxel that a ray crosses.
inline void SequentialRays::CrossVoxel(Ray& ray, const float* source, std::size_t first, double length, double density)
{
  for (int c = 0; c < this->Channels; ++c)
  {
    const double sigma_t = this->Extinction[first + c];
    const double left = std::exp(-length * sigma_t);
    const float radiance =
      static_cast<float>(ray.radiance[c] * left + source[first + c] * Depth(sigma_t, left, length));
    ray.radiance[c] = radiance;
    const double sigma_s = this->Scattering[first + c];
    const double deposit = density * radiance * Depth(sigma_s, std::exp(-length * sigma_s), length);
    for (std::size_t k = 0; k < this->Moments.size(); ++k)
    {
      this->Moments[k][first + c] += this->Coefficients[k] * deposit;
    }
  }
}

/// Into the next voxel, in plane w; a ray that leaves through a side enters anew on the other (Fig. 2).
inline void SequentialRays::Move(Ray& ray, int w, int moveU, int moveV, const Sending& sending) const
{
  const MapGeometry& map = sending.map;
  const Ray before = ray;
  const bool leavesU = Step(ray.u, moveU, map.sizeU) && !this->Settings.periodic[map.axisU];
  const bool leavesV = Step(ray.v, moveV, map.sizeV) && !this->Settings.periodic[map.axisV];
  if (!leavesU && !leavesV)
  {
    return;
  }
  const double share = leavesU && leavesV ? 0.5 : 1.0;
  Rgb boundary = {};
  for (const int axis : { leavesU ? map.axisU : -1, leavesV ? map.axisV : -1 })
  {
    if (axis >= 0)
    {
      this->Leave(before, axis, w, share * map.beamPower, sending);
      for (int c = 0; c < 3; ++c)
      {
        boundary[c] += share * this->Model.Boundary(ray.direction, axis)[c];
      }
    }
  }
  this->Enter(ray, sending.order == 0 ? boundary : Rgb{}, sending);
  for (const int axis : { leavesU ? map.axisU : -1, leavesV ? map.axisV : -1 })
  {
    if (axis >= 0)
    {
      this->ComeBack(ray, axis, w, share, sending);
    }
  }
}

/// To the planes that are here, and through all voxels of these.
void SequentialRays::Follow(Ray& ray, double startU, double startV, const Sending& sending)
{
  const MapGeometry& map = sending.map;
  const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(this->Size[0]),
    static_cast<std::size_t>(this->Size[0]) * this->Size[1] };
  const int firstPlane = this->Slab ? this->Slab->first : 0, endPlane = firstPlane + this->Size[map.axis];
  GridWalk walk(startU, startV, map.slopeU, map.slopeV, map.planes);
  bool more = walk.Next();
  const auto isHere = [&](int w) { return w >= firstPlane && w < endPlane; };
  for (; more && !isHere(PlaneAt(map, walk.plane)); more = walk.Next())
  {
    Step(ray.u, walk.moveU, map.sizeU);
    Step(ray.v, walk.moveV, map.sizeV);
  }
  for (; more && isHere(PlaneAt(map, walk.plane)); more = walk.Next())
  {
    const int w = PlaneAt(map, walk.plane);
    if (walk.moveU != 0 || walk.moveV != 0)
    {
      this->Move(ray, w, walk.moveU, walk.moveV, sending);
    }
    const std::size_t voxel =
      ray.u * stride[map.axisU] + ray.v * stride[map.axisV] + (w - firstPlane) * stride[map.axis];
    this->CrossVoxel(ray, sending.source, voxel * this->Channels, walk.fraction * map.length, map.density);
  }
}

void SequentialRays::Enter(Ray& ray, const Rgb& boundary, const Sending& sending) const
{
  for (int c = 0; c < this->Channels; ++c)
  {
    ray.radiance[c] = static_cast<float>(boundary[c]);
  }
  AddTo(sending.tally.in[0], ray.radiance, sending.map.beamPower);
}

std::size_t SequentialRays::CellOf(int face, const Ray& ray, int w, const Sending& sending) const
{
  std::array<int, 3> voxel = {};
  voxel[sending.map.axis] = w;
  voxel[sending.map.axisU] = ray.u;
  voxel[sending.map.axisV] = ray.v;
  return sending.faces.Cell(face, voxel);
}

/// Out of the box across an axis, in plane w.
void SequentialRays::Leave(const Ray& ray, int axis, int w, double power, const Sending& sending) const
{
  const int face = sending.map.ExitFace(axis);
  AddTo(sending.tally.out[face], ray.radiance, power);
  if (sending.faces.Count())
  {
    const std::size_t cell = this->CellOf(face, ray, w, sending);
    for (int c = 0; c < this->Channels; ++c)
    {
      sending.faces.Leave(cell, c, power * ray.radiance[c]);
    }
  }
}

/// With what the face gives back, across an axis, in plane w.
void SequentialRays::ComeBack(Ray& ray, int axis, int w, double share, const Sending& sending) const
{
  if (sending.faces.Count())
  {
    const std::size_t cell = this->CellOf(sending.map.EntryFace(axis), ray, w, sending);
    for (int c = 0; c < this->Channels; ++c)
    {
      ray.radiance[c] += static_cast<float>(share * sending.faces.Radiance(cell, c));
    }
  }
}
}
