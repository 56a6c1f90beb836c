#include "LightPropagation/Published/SequentialPropagation.h"

#include "Light/ChannelReduction.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedLight.h"
#include "LightPropagation/Uncollided/GivenLight.h"

#include <cmath>

namespace tyndall
{
namespace
{
class SequentialPropagation
{
public:
  SequentialPropagation(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels)
    : TheMedium(medium)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Ledger(medium, this->Model, settings)
    , Faces(medium.grid, this->Model, settings)
    , Channels(this->Model.Channels())
    , Given(illumination.uncollided)
    , Values(medium.grid.VoxelCount() * this->Channels)
    , Sources(this->Model.SourceDirections().size())
    , OrderMoments(this->Model.MomentCount(), std::vector<double>(this->Values))
    , Moments(this->OrderMoments.size(), std::vector<float>(this->Values))
    , Coefficients(this->OrderMoments.size())
  {
    this->Extinction.resize(this->Values);
    this->Scattering.resize(this->Values);
    std::vector<float> emission(this->Values);
    for (std::size_t i = 0; i < this->Values; ++i)
    {
      const std::size_t voxel = i / this->Channels;
      const int c = static_cast<int>(i % this->Channels);
      this->Scattering[i] = medium.sigma_s.At(voxel, c);
      this->Extinction[i] = medium.sigma_a.At(voxel, c) + this->Scattering[i];
      emission[i] = medium.emission.At(voxel, c);
    }
    this->Source.assign(this->Sources, emission); // "Initialize U with medium emitted light"
    this->Carried.resize(this->Model.Directions().directions.size());
  }

  LightField Solve(const Monitor& monitor)
  {
    LightField field;
    do
    {
      this->Propagate(monitor);
      if (this->Ledger.Orders() == 0 && this->Given.IsThere())
      {
        this->AddGiven();
      }
      this->Ledger.Count(this->Tally);
      const std::vector<float> fluence(this->OrderMoments[0].begin(), this->OrderMoments[0].end());
      this->Faces.CloseOrder(this->Ledger);
      this->Ledger.CloseOrder(SumsOf(this->TheMedium, this->Channels, fluence.data()));
      this->UpdateSources();
      if (this->Ledger.Orders() == 1)
      {
        field.fluenceDirect = fluence;
      }
    } while (!this->Ledger.Done());
    this->WriteTo(field);
    return field;
  }

private:
  /// All rays of all maps, once.
  void Propagate(const Monitor& monitor)
  {
    for (std::vector<double>& moment : this->OrderMoments)
    {
      std::fill(moment.begin(), moment.end(), 0.0);
    }
    this->Tally = {};
    const std::vector<Direction>& directions = this->Model.Directions().directions;
    for (std::size_t i = 0; i < directions.size(); ++i)
    {
      this->PropagateDirection(static_cast<int>(i), monitor);
    }
  }

  /// Light that another solver found, to the moments of the first order.
  void AddGiven()
  {
    tyndall::AddGiven(this->Model, this->Given, this->TheMedium.grid.VoxelCount(),
      [this](std::size_t k, std::size_t voxel, int c, double value) {
        this->OrderMoments[k][voxel * this->Channels + c] += value;
      });
    tyndall::Add(this->Tally, TallyOf(this->Given, this->TheMedium, 0, this->Channels));
  }

  void PropagateDirection(int i, const Monitor& monitor)
  {
    const DirectionSet& set = this->Model.Directions();
    const MapGeometry map(this->TheMedium.grid, this->Settings, set.directions[i], i, set.PerFace());
    for (std::size_t k = 0; k < this->Coefficients.size(); ++k)
    {
      this->Coefficients[k] = static_cast<float>(this->Model.Coefficient(static_cast<int>(k), i));
    }
    const int resolution = this->Settings.mapResolution;
    const int elementsU = map.sizeU * resolution;
    const int elementsV = map.sizeV * resolution;
    const bool carries = this->Settings.periodic[map.axis];
    std::vector<float> carriedOn(carries ? static_cast<std::size_t>(elementsU) * elementsV * this->Channels : 0);
    const int order = this->Ledger.Orders();
    for (int s = 0; s < elementsV; ++s)
    {
      const double startV = map.StartOfOrder((s % resolution + 0.5) / resolution, map.slopeV, order);
      Report(monitor, this->Ledger.Progress((i + static_cast<double>(s) / elementsV) / set.directions.size()));
      for (int r = 0; r < elementsU; ++r)
      {
        const double startU = map.StartOfOrder((r % resolution + 0.5) / resolution, map.slopeU, order);
        Ray ray{ i, r / resolution, s / resolution, {} };
        if (order == 0)
        {
          this->Enter(ray, map, this->Model.Boundary(i, map.axis));
        }
        else if (carries)
        {
          const std::size_t first = (static_cast<std::size_t>(s) * elementsU + r) * this->Channels;
          std::copy_n(this->Carried[i].begin() + first, this->Channels, ray.radiance);
        }
        if (!carries)
        {
          this->ComeBack(ray, map, map.axis, this->FirstPlane(map), 1.0);
        }
        this->Follow(ray, map, startU, startV);
        if (carries)
        {
          const int u = ray.u * resolution + r % resolution;
          const int v = ray.v * resolution + s % resolution;
          const std::size_t first = (static_cast<std::size_t>(v) * elementsU + u) * this->Channels;
          std::copy_n(ray.radiance, this->Channels, carriedOn.begin() + first);
          Add(this->Tally.onTheWay, ray, map.beamPower);
        }
        else
        {
          this->Leave(ray, map, map.axis, map.planes - 1 - this->FirstPlane(map), map.beamPower);
        }
      }
    }
    this->Carried[i].swap(carriedOn);
  }

  struct Ray
  {
    int direction;
    int u, v;
    float radiance[3];
  };

  /// Through all voxels to the last plane.
  void Follow(Ray& ray, const MapGeometry& map, double startU, double startV)
  {
    const std::array<int, 3>& size = this->TheMedium.grid.size;
    const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * size[1] };
    const float* source = this->Source[this->Model.SourceOf(ray.direction)].data();
    GridWalk walk(startU, startV, map.slopeU, map.slopeV, map.planes);
    while (walk.Next())
    {
      const int w = map.forward ? walk.plane : map.planes - 1 - walk.plane;
      this->Move(ray, map, w, walk.moveU, walk.moveV);
      const std::size_t voxel = ray.u * stride[map.axisU] + ray.v * stride[map.axisV] + w * stride[map.axis];
      this->CrossVoxel(ray, source, voxel * this->Channels, walk.fraction * map.length, map.density);
    }
  }

  static int FirstPlane(const MapGeometry& map) { return map.forward ? 0 : map.planes - 1; }

  /// Into the next voxel, in plane w; a ray that leaves through a side enters anew on the other (Fig. 2).
  void Move(Ray& ray, const MapGeometry& map, int w, int moveU, int moveV)
  {
    const Ray before = ray;
    const bool leavesU = Step(ray.u, moveU, map.sizeU) && !this->Settings.periodic[map.axisU];
    const bool leavesV = Step(ray.v, moveV, map.sizeV) && !this->Settings.periodic[map.axisV];
    if (leavesU || leavesV)
    {
      const double share = leavesU && leavesV ? 0.5 : 1.0;
      Rgb boundary = {};
      for (int axis : { leavesU ? map.axisU : -1, leavesV ? map.axisV : -1 })
      {
        if (axis >= 0)
        {
          this->Leave(before, map, axis, w, share * map.beamPower);
          for (int c = 0; c < 3; ++c)
          {
            boundary[c] += share * this->Model.Boundary(ray.direction, axis)[c];
          }
        }
      }
      this->Enter(ray, map, this->Ledger.Orders() == 0 ? boundary : Rgb{});
      for (int axis : { leavesU ? map.axisU : -1, leavesV ? map.axisV : -1 })
      {
        if (axis >= 0)
        {
          this->ComeBack(ray, map, axis, w, share);
        }
      }
    }
  }

  /// @return whether the grid ends there; the position is then on its other side
  static bool Step(int& position, int move, int size)
  {
    position += move;
    const bool outside = position < 0 || position == size;
    position = outside ? (position < 0 ? size - 1 : 0) : position;
    return outside;
  }

  void Enter(Ray& ray, const MapGeometry& map, const Rgb& boundary)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      ray.radiance[c] = static_cast<float>(boundary[c]);
    }
    Add(this->Tally.in[0], ray, map.beamPower);
  }

  std::size_t CellOf(int face, const Ray& ray, const MapGeometry& map, int w) const
  {
    std::array<int, 3> voxel = {};
    voxel[map.axis] = w;
    voxel[map.axisU] = ray.u;
    voxel[map.axisV] = ray.v;
    return this->Faces.Cell(face, voxel);
  }

  /// Out of the box across an axis, in plane w.
  void Leave(const Ray& ray, const MapGeometry& map, int axis, int w, double power)
  {
    const int face = map.ExitFace(axis);
    Add(this->Tally.out[face], ray, power);
    if (this->Faces.Count())
    {
      const std::size_t cell = this->CellOf(face, ray, map, w);
      for (int c = 0; c < this->Channels; ++c)
      {
        this->Faces.Leave(cell, c, power * ray.radiance[c]);
      }
    }
  }

  /// With what the face gives back, across an axis, in plane w.
  void ComeBack(Ray& ray, const MapGeometry& map, int axis, int w, double share)
  {
    if (this->Faces.Count())
    {
      const std::size_t cell = this->CellOf(map.EntryFace(axis), ray, map, w);
      for (int c = 0; c < this->Channels; ++c)
      {
        ray.radiance[c] += static_cast<float>(share * this->Faces.Radiance(cell, c));
      }
    }
  }

  /// Eq. (3), then the ray's part of Eq. (4).
  void CrossVoxel(Ray& ray, const float* source, std::size_t first, double length, double density)
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
      for (std::size_t k = 0; k < this->OrderMoments.size(); ++k)
      {
        this->OrderMoments[k][first + c] += this->Coefficients[k] * deposit;
      }
    }
  }

  /// (1 - exp(-sigma length)) / sigma; its series where the difference would cancel.
  static double Depth(double sigma, double left, double length)
  {
    return sigma * length > 1e-6 ? (1.0 - left) / sigma : length * (1.0 - 0.5 * sigma * length);
  }

  static void Add(Rgb& power, const Ray& ray, double beamPower)
  {
    for (int c = 0; c < 3; ++c)
    {
      power[c] += beamPower * ray.radiance[c];
    }
  }

  /// The rest of Eq. (4): U of the next order from what this one left in the voxels.
  void UpdateSources()
  {
    for (std::size_t k = 0; k < this->Moments.size(); ++k)
    {
      for (std::size_t i = 0; i < this->Values; ++i)
      {
        this->Moments[k][i] += static_cast<float>(this->OrderMoments[k][i]);
      }
    }
    for (std::size_t d = 0; d < this->Sources; ++d)
    {
      const PublishedModel::Part part = this->Model.Source(static_cast<int>(d));
      const std::vector<double>& moment = this->OrderMoments[part.moment];
      for (std::size_t i = 0; i < this->Values; ++i)
      {
        this->Source[d][i] = static_cast<float>(part.factor * this->Scattering[i] * moment[i]);
      }
    }
  }

  void WriteTo(LightField& field) const
  {
    TakeMoments(
      this->Model, this->Settings.netFlux, [this](int k) { return this->Moments[k]; }, field);
    this->Ledger.WriteTo(field);
    this->Faces.WriteTo(field);
    field.halfRangeFlux = HalfRangeFlux(this->Model.Directions());
    field.device = "host, one core";
  }

  const Medium& TheMedium;
  PropagationSettings Settings;
  PublishedModel Model;
  OrderLedger Ledger;
  SweepTally Tally; ///< of the order that runs
  PublishedFaces Faces;
  int Channels;
  UncollidedImage Given;
  std::size_t Values;  ///< voxels times channels
  std::size_t Sources; ///< directions of U
  std::vector<float> Extinction, Scattering;
  std::vector<std::vector<float>> Source; ///< U of the order before, by direction
  /// Of this order. Where voxels are flat a ray comes by thousands of times: as floats their sums were off by 6e-4.
  std::vector<std::vector<double>> OrderMoments;
  std::vector<std::vector<float>> Moments; ///< of all orders
  std::vector<float> Coefficients;         ///< of the moments, for the direction that is under way
  std::vector<std::vector<float>> Carried; ///< by direction: radiance on its way through a periodic axis
};
}

LightField SolveSequential(
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  Check(medium);
  CheckPublishedPhase(medium); // before channels become one
  Check(illumination);
  const MediumTraits traits = TraitsOf(medium);
  const SceneChannels channels(medium, traits, illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      LightField field = SequentialPropagation(ofChannels, light, settings, count).Solve(monitor);
      field.leftOut = LeftOutAsPublished(medium.phase.IsIsotropic(), traits, illumination.uncollided.IsThere(),
        illumination, settings, static_cast<int>(field.convergence.size()));
      JudgeConvergence(settings, field);
      DoubtGivenLight(illumination, field);
      return field;
    });
}
}
