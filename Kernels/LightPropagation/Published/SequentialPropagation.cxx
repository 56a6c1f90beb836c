#include "LightPropagation/Published/SequentialPropagation.h"

#include "Light/ChannelReduction.h"
#include "LightPropagation/Published/OrderLedger.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Uncollided/GivenLight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// Returns (1 - left) / sigma with left = exp(-sigma length). Uses the series for small sigma length, where 1 - left
/// would lose digits.
double Depth(double sigma, double left, double length)
{
  return sigma * length > 1e-6 ? (1.0 - left) / sigma : length * (1.0 - 0.5 * sigma * length);
}

/// Moves a position by `move` (-1, 0 or 1) voxels along an axis of `size` voxels, and wraps it around.
/// @return whether the position has wrapped around
bool Step(int& position, int move, int size)
{
  position += move;
  const bool outside = position < 0 || position == size;
  position = outside ? (position < 0 ? size - 1 : 0) : position;
  return outside;
}

class SequentialPropagation
{
public:
  SequentialPropagation(
    const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, int channels)
    : TheMedium(medium)
    , Outside(illumination)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Channels(this->Model.Channels())
    , Ledger(medium, this->Channels, settings)
    , Values(medium.grid.VoxelCount() * this->Channels)
    , Extinction(this->Values)
    , Scattering(this->Values)
    , OrderMoments(this->Model.MomentCount(), std::vector<double>(this->Values))
    , Totals(this->Model.MomentCount(), std::vector<float>(this->Values))
    , Carried(this->Model.Directions().directions.size())
    , Coefficients(this->Model.MomentCount())
  {
    std::vector<float> emission(this->Values);
    for (std::size_t i = 0; i < this->Values; ++i)
    {
      const std::size_t voxel = i / this->Channels;
      const int c = static_cast<int>(i % this->Channels);
      this->Scattering[i] = medium.sigma_s.At(voxel, c);
      this->Extinction[i] = medium.sigma_a.At(voxel, c) + this->Scattering[i];
      emission[i] = medium.emission.At(voxel, c);
    }
    this->Sources.resize(this->Model.SourceDirections().size());
    for (std::size_t i = 0; i < this->Carried.size(); ++i)
    {
      // "Initialize U with medium emitted light" (Algorithm 1)
      this->Sources[this->Model.SourceOf(static_cast<int>(i))] = emission;
    }
  }

  LightField Solve(const Monitor& monitor)
  {
    LightField field;
    do
    {
      this->Propagate(monitor);
      if (this->Ledger.Orders() == 0 && this->Outside.uncollided.IsThere())
      {
        this->AddGiven();
      }
      this->UpdateSources();
      const std::vector<float> fluence(this->OrderMoments[0].begin(), this->OrderMoments[0].end());
      this->Ledger.Count(this->Tally);
      this->Ledger.CloseOrder(fluence);
      field.fluenceDirect = this->Ledger.Orders() == 1 ? fluence : field.fluenceDirect;
    } while (!this->Ledger.Done());
    this->Ledger.WriteTo(field);
    WritePublishedLight(
      this->Model, this->TheMedium, TraitsOf(this->TheMedium), this->Outside, this->Settings,
      [this](int k) { return this->Totals[k]; }, field);
    field.device = SequentialDevice;
    return field;
  }

private:
  struct Ray
  {
    int direction;
    int u, v;
    std::array<float, 3> radiance;
  };

  /// Traces the rays of all directions through the volume once.
  void Propagate(const Monitor& monitor)
  {
    for (std::vector<double>& moment : this->OrderMoments)
    {
      std::fill(moment.begin(), moment.end(), 0.0);
    }
    this->Tally = {};
    const std::size_t directions = this->Carried.size();
    for (std::size_t i = 0; i < directions; ++i)
    {
      this->SendMap(static_cast<int>(i), OfPart(monitor, [this, i, directions](double done) {
        return this->Ledger.Progress((static_cast<double>(i) + done) / static_cast<double>(directions));
      }));
    }
  }

  /// Traces all rays of one direction's map through the volume.
  void SendMap(int direction, const Monitor& monitor)
  {
    const DirectionSet& set = this->Model.Directions();
    const MapGeometry map(this->TheMedium.grid, this->Settings, set.directions[direction], direction, set.PerFace());
    for (std::size_t k = 0; k < this->Coefficients.size(); ++k)
    {
      this->Coefficients[k] = static_cast<float>(this->Model.Coefficient(static_cast<int>(k), direction));
    }
    const bool wraps = this->Settings.periodic[map.axis];
    const int order = this->Ledger.Orders(), resolution = this->Settings.mapResolution;
    const int elementsU = map.sizeU * resolution, elementsV = map.sizeV * resolution;
    std::vector<float> behind(wraps ? static_cast<std::size_t>(elementsU) * elementsV * this->Channels : 0);
    std::vector<float>& carried = this->Carried[direction];
    for (int s = 0; s < elementsV; ++s)
    {
      const double startV = map.StartOfOrder((s % resolution + 0.5) / resolution, map.slopeV, order);
      Report(monitor, static_cast<double>(s) / elementsV);
      for (int r = 0; r < elementsU; ++r)
      {
        const double startU = map.StartOfOrder((r % resolution + 0.5) / resolution, map.slopeU, order);
        const std::size_t element = static_cast<std::size_t>(s) * elementsU + r;
        Ray ray{ direction, r / resolution, s / resolution, {} };
        if (order == 0)
        {
          this->Enter(ray, this->Model.Boundary(direction, map.axis), map);
        }
        else if (wraps)
        {
          std::copy_n(carried.begin() + static_cast<std::ptrdiff_t>(element * this->Channels), this->Channels,
            ray.radiance.begin());
        }
        this->Follow(ray, startU, startV, map);
        this->AddTo(wraps ? this->Tally.onTheWay : this->Tally.out[map.ExitFace(map.axis)], ray, map.beamPower);
        if (wraps)
        {
          const std::size_t u = ray.u * resolution + r % resolution, v = ray.v * resolution + s % resolution;
          std::copy_n(ray.radiance.begin(), this->Channels,
            behind.begin() + static_cast<std::ptrdiff_t>((v * elementsU + u) * this->Channels));
        }
      }
    }
    carried = std::move(behind);
  }

  /// Traces a ray through all voxels of its path.
  void Follow(Ray& ray, double startU, double startV, const MapGeometry& map)
  {
    const std::array<int, 3>& size = this->TheMedium.grid.size;
    const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * size[1] };
    const float* const source = this->Sources[this->Model.SourceOf(ray.direction)].data();
    GridWalk walk(startU, startV, map.slopeU, map.slopeV, map.planes);
    while (walk.Next())
    {
      if (walk.moveU != 0 || walk.moveV != 0)
      {
        this->Move(ray, walk.moveU, walk.moveV, map);
      }
      const std::size_t voxel =
        ray.u * stride[map.axisU] + ray.v * stride[map.axisV] + map.PlaneAt(walk.plane) * stride[map.axis];
      this->CrossVoxel(ray, source, voxel * this->Channels, walk.fraction * map.length, map.density);
    }
  }

  /// Moves a ray into the next voxel. A ray that leaves through a side of the box re-enters on the opposite side (Fig.
  /// 2 of the paper).
  void Move(Ray& ray, int moveU, int moveV, const MapGeometry& map)
  {
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
        this->AddTo(this->Tally.out[map.ExitFace(axis)], ray, share * map.beamPower);
        for (int c = 0; c < 3; ++c)
        {
          boundary[c] += share * this->Model.Boundary(ray.direction, axis)[c];
        }
      }
    }
    this->Enter(ray, this->Ledger.Orders() == 0 ? boundary : Rgb{}, map);
  }

  void Enter(Ray& ray, const Rgb& boundary, const MapGeometry& map)
  {
    std::copy(boundary.begin(), boundary.end(), ray.radiance.begin());
    this->AddTo(this->Tally.in[0], ray, map.beamPower);
  }

  void AddTo(Rgb& power, const Ray& ray, double beamPower) const
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      power[c] += beamPower * ray.radiance[c];
    }
  }

  /// Attenuates a ray in one voxel by Eq. (3) of the paper, and adds its contribution to Eq. (4) to the moments of the
  /// order.
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

  /// Adds the uncollided light of another solver to the moments of the first order.
  void AddGiven()
  {
    const UncollidedImage& image = this->Outside.uncollided;
    tyndall::AddGiven(this->Model, image, this->TheMedium.grid.VoxelCount(),
      [this](std::size_t k, std::size_t voxel, int c, double value) {
        this->OrderMoments[k][voxel * this->Channels + c] += value;
      });
    tyndall::Add(this->Tally, TallyOf(image, this->TheMedium, 0, this->Channels));
  }

  /// Completes Eq. (4): computes the source U of the next order from the moments of this order, and adds these to the
  /// totals.
  void UpdateSources()
  {
    for (std::size_t k = 0; k < this->Totals.size(); ++k)
    {
      std::transform(this->Totals[k].begin(), this->Totals[k].end(), this->OrderMoments[k].begin(),
        this->Totals[k].begin(), [](float sum, double more) { return sum + static_cast<float>(more); });
    }
    for (std::size_t d = 0; d < this->Sources.size(); ++d)
    {
      const PublishedModel::Part part = this->Model.Source(static_cast<int>(d));
      for (std::size_t i = 0; i < this->Sources[d].size(); ++i)
      {
        this->Sources[d][i] =
          static_cast<float>(part.factor * this->Scattering[i] * this->OrderMoments[part.moment][i]);
      }
    }
  }

  const Medium& TheMedium;
  const Illumination& Outside;
  PropagationSettings Settings;
  PublishedModel Model;
  int Channels;
  OrderLedger Ledger;
  SweepTally Tally;   ///< incident, escaped and wrapped power of the current order
  std::size_t Values; ///< number of voxels times number of channels
  std::vector<float> Extinction, Scattering;
  /// Source U of each source direction, channels interleaved; empty if no ray map reads it.
  std::vector<std::vector<float>> Sources;
  /// Moments of this order, in double precision: thousands of rays cross a flat voxel, and sums in float would have
  /// errors of 6e-4.
  std::vector<std::vector<double>> OrderMoments;
  std::vector<std::vector<float>> Totals; ///< moments of all orders
  /// Radiance of the rays that wrap around the marching axis into the next order, by direction
  std::vector<std::vector<float>> Carried;
  std::vector<float> Coefficients; ///< coefficients of the moments for the current direction
};
}

LightField SolveSequential(
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  Check(medium);
  Check(illumination);
  CheckPublished(medium, illumination); // checked before channels are merged
  const SceneChannels channels(medium, TraitsOf(medium), illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      return SequentialPropagation(ofChannels, light, settings, count).Solve(monitor);
    });
}
}
