#include "Reference/PictureMonteCarlo.h"

#include "Reference/RandomWalk.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace
{
using random_walk::Random;
using random_walk::Scattered;
using Vec = std::array<double, 3>;
constexpr double Pi = 3.14159265358979323846;
constexpr int Brick = 8;           ///< voxels an edge, with one bound of sigma_t
constexpr double LeastSure = 0.02; ///< transmittance below which a ray to the sun goes on by chance

/// The volume with a border of one voxel that repeats the outermost ones, and a bound for each brick.
class Tracker
{
public:
  explicit Tracker(const LitVolume& volume)
    : Volume(volume)
  {
    const auto& n = volume.size;
    this->Row = n[0] + 2;
    this->Slice = this->Row * (n[1] + 2);
    this->Padded.resize(static_cast<std::size_t>(this->Slice) * (n[2] + 2));
    for (int k = 0; k < n[2] + 2; ++k)
    {
      for (int j = 0; j < n[1] + 2; ++j)
      {
        for (int i = 0; i < n[0] + 2; ++i)
        {
          const auto within = [](int at, int size) { return std::clamp(at - 1, 0, size - 1); };
          this->Padded[static_cast<std::size_t>(k) * this->Slice + j * this->Row + i] =
            volume
              .sigma_t[(static_cast<std::size_t>(within(k, n[2])) * n[1] + within(j, n[1])) * n[0] + within(i, n[0])];
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Bricks[axis] = (n[axis] + Brick - 1) / Brick;
    }
    this->FindBounds();
  }

  /// Goes along a ray from brick to brick and calls collide(place, sigma, bound) at every place that a constant bound
  /// would have it collide at, until that returns false. Places in voxels.
  template <class Collide>
  void Follow(const Vec& from, const Vec& along, Random& random, const Collide& collide) const
  {
    Vec at, step;
    std::array<int, 3> brick;
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] = from[axis] / this->Volume.spacing[axis];
      step[axis] = along[axis] / this->Volume.spacing[axis];
      // A place on the border of two bricks is in the one that the ray goes into.
      const double place = at[axis] / Brick;
      brick[axis] = static_cast<int>(std::floor(place));
      brick[axis] -= step[axis] < 0.0 && place == brick[axis] ? 1 : 0;
    }
    for (;;)
    {
      double length = 1e300;
      int crossing = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        if (brick[axis] < 0 || brick[axis] >= this->Bricks[axis])
        {
          return;
        }
        const double face =
          step[axis] > 0.0 ? std::min((brick[axis] + 1) * Brick, this->Volume.size[axis]) : brick[axis] * Brick;
        const double to = step[axis] != 0.0 ? std::max((face - at[axis]) / step[axis], 0.0) : 1e300;
        if (to < length)
        {
          length = to;
          crossing = axis;
        }
      }
      const double bound =
        this->Bounds[(static_cast<std::size_t>(brick[2]) * this->Bricks[1] + brick[1]) * this->Bricks[0] + brick[0]];
      double gone = 0.0;
      while (bound > 0.0)
      {
        gone -= std::log(1.0 - random()) / bound;
        if (gone >= length)
        {
          break;
        }
        const Vec place = { at[0] + gone * step[0], at[1] + gone * step[1], at[2] + gone * step[2] };
        if (!collide(place, this->SigmaAt(place), bound))
        {
          return;
        }
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        at[axis] += length * step[axis];
      }
      brick[crossing] += step[crossing] > 0.0 ? 1 : -1;
    }
  }

private:
  double SigmaAt(const Vec& place) const
  {
    std::array<int, 3> first;
    Vec part;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double p = std::clamp(place[axis], 0.0, static_cast<double>(this->Volume.size[axis])) + 0.5;
      first[axis] = std::min(static_cast<int>(p), this->Volume.size[axis]);
      part[axis] = p - first[axis];
    }
    const float* at =
      this->Padded.data() + static_cast<std::size_t>(first[2]) * this->Slice + first[1] * this->Row + first[0];
    const auto alongX = [&](const float* row) { return row[0] + part[0] * (row[1] - row[0]); };
    const auto alongY = [&](const float* slice) {
      const double low = alongX(slice);
      return low + part[1] * (alongX(slice + this->Row) - low);
    };
    const double low = alongY(at);
    return low + part[2] * (alongY(at + this->Slice) - low);
  }

  void FindBounds()
  {
    for (int k = 0; k < this->Bricks[2]; ++k)
    {
      for (int j = 0; j < this->Bricks[1]; ++j)
      {
        for (int i = 0; i < this->Bricks[0]; ++i)
        {
          float bound = 0.0f;
          const auto last = [](int b, int size) { return std::min((b + 1) * Brick, size) + 1; };
          for (int z = k * Brick; z <= last(k, this->Volume.size[2]); ++z)
          {
            for (int y = j * Brick; y <= last(j, this->Volume.size[1]); ++y)
            {
              const float* row = this->Padded.data() + static_cast<std::size_t>(z) * this->Slice + y * this->Row;
              bound = std::max(bound, *std::max_element(row + i * Brick, row + last(i, this->Volume.size[0]) + 1));
            }
          }
          this->Bounds.push_back(bound);
        }
      }
    }
  }

  const LitVolume& Volume;
  int Row, Slice;
  std::vector<float> Padded, Bounds;
  std::array<int, 3> Bricks;
};

double HenyeyGreenstein(double g, double cosine)
{
  const double base = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * Pi * base * std::sqrt(base));
}

/// What comes through from the sun to a place, as a random number of that mean.
double SunThrough(const Tracker& tracker, const LitVolume& volume, const Vec& place, Random& random)
{
  const Vec towards = { -volume.sunTravels[0], -volume.sunTravels[1], -volume.sunTravels[2] };
  double left = 1.0;
  tracker.Follow(place, towards, random, [&](const Vec&, double sigma, double bound) {
    left *= 1.0 - sigma / bound;
    if (left < LeastSure)
    {
      left = random() < 0.5 ? 2.0 * left : 0.0;
    }
    return left > 0.0;
  });
  return left;
}

/// Where a ray enters the box; false: it misses.
bool EnterBox(const LitVolume& volume, const ViewRay& ray, Vec& place)
{
  double in = 0.0, out = 1e300;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = volume.size[axis] * volume.spacing[axis];
    const double a = -ray.from[axis] / ray.along[axis], b = (length - ray.from[axis]) / ray.along[axis];
    if (ray.along[axis] == 0.0)
    {
      out = ray.from[axis] < 0.0 || ray.from[axis] > length ? -1.0 : out;
      continue;
    }
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = volume.size[axis] * volume.spacing[axis];
    place[axis] = std::clamp(ray.from[axis] + in * ray.along[axis], 0.0, length);
  }
  return out > in;
}

double RadianceOfPath(const Tracker& tracker, const LitVolume& volume, const ViewRay& ray, Random& random)
{
  Vec place, along = ray.along;
  if (!EnterBox(volume, ray, place))
  {
    return volume.skyRadiance;
  }
  double weight = 1.0, radiance = 0.0;
  for (int n = 0; n < volume.mostScatterings; ++n)
  {
    bool collides = false;
    Vec where;
    tracker.Follow(place, along, random, [&](const Vec& at, double sigma, double bound) {
      where = at;
      collides = random() * bound < sigma;
      return !collides;
    });
    if (!collides)
    {
      return radiance + weight * volume.skyRadiance;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = where[axis] * volume.spacing[axis];
    }
    weight *= volume.albedo;
    const double cosine =
      -(along[0] * volume.sunTravels[0] + along[1] * volume.sunTravels[1] + along[2] * volume.sunTravels[2]);
    if (volume.sunIrradiance > 0.0)
    {
      radiance +=
        weight * volume.sunIrradiance * HenyeyGreenstein(volume.g, cosine) * SunThrough(tracker, volume, place, random);
    }
    along = Scattered(along, volume.g, random);
    if (weight < 0.05)
    {
      if (random() < 0.5)
      {
        return radiance;
      }
      weight *= 2.0;
    }
  }
  return radiance;
}
}

std::vector<double> PictureByMonteCarlo(
  const LitVolume& volume, const std::vector<ViewRay>& rays, int paths, std::uint64_t seed, int threads)
{
  const Tracker tracker(volume);
  std::vector<double> radiance(rays.size(), 0.0);
  std::atomic<std::size_t> next{ 0 };
  const auto work = [&] {
    for (std::size_t i = next++; i < rays.size(); i = next++)
    {
      Random random(seed * 0x9e3779b97f4a7c15u + i);
      double sum = 0.0;
      for (int n = 0; n < paths; ++n)
      {
        sum += RadianceOfPath(tracker, volume, rays[i], random);
      }
      radiance[i] = sum / paths;
    }
  };
  std::vector<std::thread> crew;
  for (int t = 1; t < threads; ++t)
  {
    crew.emplace_back(work);
  }
  work();
  for (std::thread& one : crew)
  {
    one.join();
  }
  return radiance;
}
