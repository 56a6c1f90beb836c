#include "LightPropagation/Emission/EmissionFans.h"

#include "Device/Device.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
/// Initial number of fans (the rays from one point of the emitting box) into each of the 24 parts of space. Half of the
/// fans are compared with the other half; each half consists of two pairs (FindPoints()).
constexpr int FewestPoints = 8;
constexpr int MostPoints = 1024; ///< maximum number of fans into each part of space
/// The number of fans n is doubled while the light of the two halves of the fans differs in more than a fraction
/// FewLeft n of all voxels. In the voxels in which it still differs at the end, rays are traced for each voxel
/// individually.
constexpr double FewLeft = 0.001;
constexpr double LinesPerVoxel = 1.02; ///< rays per voxel edge in the last layer, so that a ray crosses every voxel
/// The number of rays in a row of a fan is a multiple of this, the width of the widest SIMD packet.
constexpr int LineStep = 16;
/// Approximate number of floats for the light of the fans that are traced together: 64 MiB
constexpr std::size_t KeptFloats = 1 << 24;
constexpr int NearGap = 3; ///< voxels between the emitting box and the nearest voxel that uses fans

/// Sobol's low-discrepancy sequence in six dimensions (Joe and Kuo 2008).
class Sobol
{
public:
  static constexpr int Dimensions = 6;

  Sobol()
  {
    for (int d = 0; d < Dimensions; ++d)
    {
      const Polynomial& p = Polynomials[d];
      for (int k = 0; k < Bits; ++k)
      {
        int number = k < p.degree ? p.first[k] : p.degree == 0 ? 1 : 0;
        for (int i = 1; i <= p.degree && k >= p.degree; ++i)
        {
          const bool counts = i == p.degree || (p.inner >> (p.degree - 1 - i) & 1) != 0;
          number ^= counts ? this->Numbers[d][k - i] << i : 0;
        }
        number ^= k >= p.degree && p.degree > 0 ? this->Numbers[d][k - p.degree] : 0;
        this->Numbers[d][k] = number;
      }
    }
  }

  /// Coordinate of point n along a dimension, 0 to 1. The sequence is shifted and folded (baker's transform): the mean
  /// of the first 2^n points is 1/2 for every n, whereas that of the original sequence is lower by half the distance of
  /// neighbouring points (1/8 for four points). The shift, as a fraction of this distance, is never near 0 or 1/2,
  /// where the fold would make points coincide.
  double At(int n, int dimension) const
  {
    int place = 0;
    for (int bit = 0; bit < Bits; ++bit)
    {
      place ^= (n >> bit & 1) * (this->Numbers[dimension][bit] << (Bits - 1 - bit));
    }
    const double shifted = std::fmod(static_cast<double>(place) / (1 << Bits) + Shift, 1.0);
    return 1.0 - std::abs(2.0 * shifted - 1.0);
  }

private:
  static constexpr int Bits = 9; ///< bits of a point's index: enough for MostPoints / 2 points, each used for a pair
  static constexpr double Shift = 1.0 / 12.0;

  /// Primitive polynomial over GF(2): degree, inner coefficients, and initial direction numbers of one dimension.
  struct Polynomial
  {
    int degree, inner;
    std::array<int, 4> first;
  };
  static constexpr std::array<Polynomial, Dimensions> Polynomials = { { { 0, 0, {} }, { 1, 0, { 1 } },
    { 2, 1, { 1, 3 } }, { 3, 1, { 1, 3, 1 } }, { 3, 2, { 1, 1, 1 } }, { 4, 1, { 1, 1, 3, 3 } } } };
  std::array<std::array<int, Bits>, Dimensions> Numbers = {};
};

/// The emitting box in the permuted and reflected axes of a fan (the rays from one point of the box).
class TurnedBox
{
public:
  TurnedBox(const FanScene& scene, const FanInfo& fan)
    : Scene(scene)
    , Fan(fan)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Size[k] = scene.info.sourceSize[fan.order[k]];
      const int size = scene.info.size[fan.order[k]], first = scene.info.sourceFirst[fan.order[k]];
      this->First[k] = this->IsTurned(k) ? size - first - this->Size[k] : first;
    }
  }

  std::array<int, 3> First, Size;

  /// The point of the box, in voxels, at given quantiles of the emission. The first quantile chooses a layer across the
  /// first axis, the second one a row of that layer, the third one a point of that row.
  /// @param parts  quantiles, 0 to 1
  /// @param swapped  the third axis comes before the second
  std::array<float, 3> PointAt(const std::array<double, 3>& parts, bool swapped) const
  {
    std::array<int, 3> low = { 0, 0, 0 }, high = this->Size;
    std::array<float, 3> point;
    const std::array<int, 3> axes = { 0, swapped ? 2 : 1, swapped ? 1 : 2 };
    for (int k = 0; k < 3; ++k)
    {
      const int a = axes[k];
      double wanted = parts[k] * this->SumOf(low, high), layer = 0.0;
      const int end = high[a];
      for (int i = low[a]; i < end; ++i)
      {
        std::array<int, 3> first = low, last = high;
        first[a] = i;
        last[a] = i + 1;
        const double within = this->SumOf(first, last);
        if (within > 0.0 && (wanted <= within || layer == 0.0))
        {
          low[a] = i;
          high[a] = i + 1;
          layer = within;
          if (wanted <= within)
          {
            break;
          }
        }
        wanted -= within;
      }
      const double place = std::min(std::max(wanted / std::max(layer, 1e-300), 0.001), 0.999);
      point[a] = static_cast<float>(this->First[a] + low[a] + place);
    }
    return point;
  }

private:
  bool IsTurned(int k) const { return (this->Fan.turned >> this->Fan.order[k] & 1) != 0; }

  double SumOf(const std::array<int, 3>& low, const std::array<int, 3>& high) const
  {
    const int* size = this->Scene.info.sourceSize;
    double sum = 0.0;
    std::array<int, 3> at;
    for (at[2] = low[2]; at[2] < high[2]; ++at[2])
    {
      for (at[1] = low[1]; at[1] < high[1]; ++at[1])
      {
        for (at[0] = low[0]; at[0] < high[0]; ++at[0])
        {
          std::array<int, 3> v;
          for (int k = 0; k < 3; ++k)
          {
            v[this->Fan.order[k]] = this->IsTurned(k) ? this->Size[k] - 1 - at[k] : at[k];
          }
          sum += this->Scene.emission[(static_cast<std::size_t>(v[2]) * size[1] + v[1]) * size[0] + v[0]];
        }
      }
    }
    return sum;
  }

  const FanScene& Scene;
  const FanInfo& Fan;
};

class EmissionFans
{
public:
  EmissionFans(Device& device, const FanScene& scene)
    : TheDevice(device)
    , Scene(scene)
    , Emission(device, scene.emission, "what shines")
    , Outside(device, scene.volume.grid.VoxelCount() + 2 * FanMargin, "extinction around what shines")
    , Halves(Zeros(scene.volume.stride))
    , FaceHalves(Zeros(FanFaceFirst(scene.volume.grid, 6)))
  {
    this->Outside.Fill(0.0f);
    this->Light.path = this->Zeros(scene.volume.stride);
    this->Light.flux = this->Zeros(scene.volume.deposit.flux ? 3 * scene.volume.stride : 0);
    this->Light.found = this->Zeros(scene.volume.stride);
    this->Light.faces = this->Zeros(this->FaceHalves.Size());
    this->Light.cellsFound = this->Zeros(this->FaceHalves.Size());
    this->Emitted =
      std::accumulate(scene.emission.begin(), scene.emission.end(), 0.0) * scene.volume.grid.VoxelVolume();
  }

  FanLight Run(const Monitor& monitor)
  {
    this->FollowAll(0, this->Points, OfPart(monitor, 0.0, 0.5));
    while (this->AreManyLeft() && this->Points < MostPoints)
    {
      // the fans traced so far become the first half of the doubled number of fans
      this->Halves.CopyFrom(this->Light.path, 0, this->Halves.Size());
      this->FaceHalves.CopyFrom(this->Light.faces, 0, this->FaceHalves.Size());
      this->FollowAll(this->Points, 2 * this->Points, OfPart(monitor, 0.5, 1.0));
      this->Points *= 2;
    }
    this->JudgeCells();
    for (const Buffer<float>* values : { &this->Light.path, &this->Light.flux, &this->Light.faces })
    {
      if (values->Size() > 0)
      {
        cl::Kernel scale = this->Kernel("scale_fans");
        With(scale, *values, static_cast<float>(1.0 / this->Points));
        this->TheDevice.Queue().enqueueNDRangeKernel(scale, cl::NullRange, cl::NDRange(values->Size()));
      }
    }
    this->TheDevice.Finish();
    return std::move(this->Light);
  }

private:
  Buffer<float> Zeros(std::size_t size)
  {
    Buffer<float> values(this->TheDevice, size, "the light of fans");
    values.Fill(0.0f);
    return values;
  }

  /// Compares the light of the two halves of the fans in all voxels. @return whether the halves still differ in too
  /// many voxels, so that more fans are needed
  bool AreManyLeft()
  {
    const std::size_t voxels = this->Scene.volume.grid.VoxelCount();
    cl::Kernel judge = this->Kernel("judge_voxels");
    With(judge, this->Scene.info, static_cast<float>(this->Emitted * this->Points), this->Light.path, this->Halves,
      this->Light.found);
    this->TheDevice.Queue().enqueueNDRangeKernel(judge, cl::NullRange, cl::NDRange(voxels));
    const std::vector<float> values = this->Light.found.Read();
    const std::ptrdiff_t left = std::count(values.begin(), values.begin() + voxels, 0.0f);
    return left > FewLeft * this->Points * voxels;
  }

  void JudgeCells()
  {
    const Grid& grid = this->Scene.volume.grid;
    for (int face = 0; face < 6; ++face)
    {
      cl::Kernel judge = this->Kernel("judge_cells");
      With(judge, this->Scene.info, cl_int(face / 2), cl_int(face % 2), cl_ulong(FanFaceFirst(grid, face)),
        static_cast<float>(this->Emitted * this->Points), this->Light.faces, this->FaceHalves, this->Light.cellsFound);
      const std::size_t cells = grid.VoxelCount() / grid.size[face / 2];
      this->TheDevice.Queue().enqueueNDRangeKernel(judge, cl::NullRange, cl::NDRange(cells));
    }
  }

  /// Traces the fans into all 24 parts of space. @param from, end  range of the fans in each part
  void FollowAll(int from, int end, const Monitor& monitor)
  {
    for (int part = 0; part < 24; ++part)
    {
      this->Follow(part, from, end, OfPart(monitor, part / 24.0, (part + 1) / 24.0));
    }
  }

  cl::Kernel Kernel(const char* name, int width = 1)
  {
    return this->TheDevice.Kernel(name, kernel_source::EmissionFans,
      Define("REAL_WIDTH", width) + Define("CHANNELS", 1) +
        Define("NET_FLUX", this->Scene.volume.deposit.flux != nullptr));
  }

  /// Fills Outside with a copy of sigma_t whose axes are permuted for `fan` and all other fans with the same first
  /// axis.
  void LayOut(const FanInfo& fan)
  {
    const SweepVolume& volume = this->Scene.volume;
    cl::Kernel layOut = this->Kernel("lay_out");
    With(layOut, this->Scene.info, fan, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Outside);
    const std::array<int, 3>& size = volume.grid.size;
    this->TheDevice.Queue().enqueueNDRangeKernel(
      layOut, cl::NullRange, cl::NDRange(size[fan.order[1]], size[fan.order[2]], size[fan.order[0]]));
  }

  /// Describes the fans into one of the 24 parts of space. @return FanInfo with layers 0 if that part has no voxels far
  /// enough from the emission
  FanInfo Describe(int part) const
  {
    const EmissionInfo& info = this->Scene.info;
    FanInfo fan = {};
    const int axis = part / 8;
    for (int k = 0; k < 3; ++k)
    {
      fan.order[k] = (axis + k) % 3;
      fan.turned |= (part >> k & 1) << fan.order[k];
    }
    const std::array<int, 3> strides = { info.size[fan.order[1]] * info.size[fan.order[2]], 1,
      info.size[fan.order[1]] };
    for (int k = 0; k < 3; ++k)
    {
      const bool round = (part >> k & 1) != 0;
      fan.strides[k] = round ? -strides[k] : strides[k];
      fan.base += round ? (info.size[fan.order[k]] - 1) * strides[k] : 0;
    }
    fan.faceFirst = static_cast<int>(FanFaceFirst(this->Scene.volume.grid, 2 * axis + (part & 1 ? 0 : 1)));
    const TurnedBox box(this->Scene, fan);
    std::array<int, 3> ends;
    for (int k = 0; k < 3; ++k)
    {
      ends[k] = info.size[fan.order[k]];
      fan.first[k] = box.First[k] + (k == 0 ? (info.near + box.Size[0]) / 2 : box.Size[k] / 2);
    }
    fan.layers = std::max(0, ends[0] - fan.first[0]);
    if (fan.layers == 0 || fan.first[1] >= ends[1] || fan.first[2] >= ends[2])
    {
      fan.layers = 0;
      return fan;
    }
    const double nearest = fan.first[0] - box.First[0] - box.Size[0];
    const double farthest = ends[0] - box.First[0];
    // Largest distance along the second and third axis, from the emitting box's centre, of voxels of the first layer
    // that belong to this part of space.
    const double away = fan.first[0] + 1.0 - box.First[0] - 0.5 * box.Size[0];
    fan.spacing = static_cast<float>(1.0 / (LinesPerVoxel * farthest));
    const auto cover = [&](int k, float& first, int& count) {
      const double low = std::min(0.0, (fan.first[k] - box.First[k] - box.Size[k]) / nearest);
      const double high = std::min(away + 0.5 * box.Size[k] + 0.5, ends[k] - box.First[k] + 0.0) / nearest;
      // The lowest tangent is reduced by `spacing`, since each fan adds an offset of at most `spacing` to its tangents.
      first = static_cast<float>(low) - fan.spacing;
      count = static_cast<int>(std::ceil((high - low) / fan.spacing)) + 3;
    };
    cover(1, fan.firstLine, fan.lines);
    cover(2, fan.firstRow, fan.rows);
    fan.lines = (fan.lines + LineStep - 1) / LineStep * LineStep;
    fan.emitted = static_cast<float>(this->Emitted);
    return fan;
  }

  /// Whether all voxels of a fan's part of space are mirror images of others, so that the fan is not traced. False if
  /// the grid has an odd number of voxels along the mirrored axis, because the fan then also lights the voxels in the
  /// middle.
  bool IsImage(const FanInfo& fan) const
  {
    int even = 0;
    for (int a = 0; a < 3; ++a)
    {
      even |= this->Scene.info.size[a] % 2 == 0 ? 1 << a : 0;
    }
    // the fan propagates towards the high side of a plane of symmetry
    return (~fan.turned & this->Scene.info.mirrored & even) != 0;
  }

  /// Origins and offsets of the fans [from, end), [fan][FanPointFloats]. Each two consecutive fans are a pair that uses
  /// the same quantiles of the emission and the same offsets, but with the second and third axis exchanged.
  std::vector<float> FindPoints(const FanInfo& fan, int from, int end) const
  {
    const TurnedBox box(this->Scene, fan);
    const Sobol sobol;
    std::vector<float> points;
    for (int p = from; p < end; ++p)
    {
      const bool swapped = (p & 1) != 0;
      std::array<double, Sobol::Dimensions> parts;
      for (int d = 0; d < Sobol::Dimensions; ++d)
      {
        parts[d] = sobol.At(p / 2, d);
      }
      for (float place : box.PointAt({ parts[0], parts[1], parts[2] }, swapped))
      {
        points.push_back(place);
      }
      points.push_back(static_cast<float>(parts[3]));
      points.push_back(static_cast<float>(parts[swapped ? 5 : 4]));
      points.push_back(static_cast<float>(parts[swapped ? 4 : 5]));
    }
    return points;
  }

  void Follow(int part, int from, int end, const Monitor& monitor)
  {
    FanInfo fan = this->Describe(part);
    if (fan.layers == 0 || this->IsImage(fan))
    {
      return;
    }
    const int all = end - from;
    fan.halfOfPoints = from == 0 ? all / 2 : 0;
    std::vector<float> tangents(fan.lines);
    for (int i = 0; i < fan.lines; ++i)
    {
      tangents[i] = fan.firstLine + i * fan.spacing;
    }
    if (this->LaidOut != fan.order[0])
    {
      this->LayOut(fan);
      this->LaidOut = fan.order[0];
    }
    const std::size_t ofRow = static_cast<std::size_t>(fan.layers + 1) * fan.lines;
    const int mostRows = static_cast<int>(std::max<std::size_t>(1, KeptFloats / ofRow));
    fan.bandRows = std::min(fan.rows, mostRows);
    const int together = std::max(1, std::min(all, mostRows / fan.rows));
    const std::size_t lines = static_cast<std::size_t>(fan.bandRows) * fan.lines * together;
    const KeptFans kept = { { this->TheDevice, this->FindPoints(fan, from, end), "fans of rays" },
      { this->TheDevice, tangents, "fans of rays" },
      { this->TheDevice, lines * (fan.layers + 1) + FanMargin, "fans of rays" } };
    for (fan.pointFirst = 0; fan.pointFirst < all; fan.pointFirst += together)
    {
      fan.points = std::min(together, all - fan.pointFirst);
      for (fan.bandFirst = 0; fan.bandFirst < fan.rows; fan.bandFirst += fan.bandRows)
      {
        this->FollowBand(fan, kept);
      }
      Report(monitor, static_cast<double>(fan.pointFirst + fan.points) / all);
    }
  }

  /// Arguments of follow_fan() and collect_fans(): origins of all fans of a part of space, tangents of a row's rays,
  /// and the light of the fans that are traced together.
  struct KeptFans
  {
    Buffer<float> points, tangents, light;
  };

  void FollowBand(const FanInfo& fan, const KeptFans& kept)
  {
    const SweepVolume& volume = this->Scene.volume;
    const std::size_t width = this->TheDevice.KernelWidth();
    cl::Kernel follow = this->Kernel("follow_fan", this->TheDevice.KernelWidth());
    With(follow, this->Scene.info, fan, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Outside, kept.points,
      kept.tangents, this->Emission, kept.light);
    const int rows = std::min(fan.bandRows, fan.rows - fan.bandFirst);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      follow, cl::NullRange, cl::NDRange(fan.lines / width, rows, fan.points), GroupOfLargeItems(this->TheDevice, 3));
    cl::Kernel collect = this->Kernel("collect_fans", this->TheDevice.KernelWidth());
    With(collect, this->Scene.info, fan, kept.points, kept.light, this->Light.path, this->Light.flux,
      cl_ulong(volume.stride), this->Halves, this->Light.faces, this->FaceHalves);
    const std::size_t across = volume.grid.size[fan.order[1]] - fan.first[1];
    const cl::NDRange voxels(
      (across + width - 1) / width, volume.grid.size[fan.order[2]] - fan.first[2], fan.layers + 1);
    this->TheDevice.Queue().enqueueNDRangeKernel(collect, cl::NullRange, voxels, GroupOfLargeItems(this->TheDevice, 3));
    this->TheDevice.Finish();
  }

  Device& TheDevice;
  const FanScene& Scene;
  const Buffer<float> Emission;
  /// Extinction outside the emitting box (lay_out()), and light of the first half of the fans in voxels and in cells of
  /// the grid's faces.
  Buffer<float> Outside, Halves, FaceHalves;
  /// Marching axis of the fans for which the extinction in `Outside` is laid out, 0 to 2; -1: not laid out yet
  int LaidOut = -1;
  FanLight Light;
  double Emitted = 0.0;      ///< integral of emission over the emitting box, W / sr
  int Points = FewestPoints; ///< number of fans into each part of space that have been traced, or are about to be
};
}

int FarFrom(const std::array<int, 3>& sourceSize)
{
  return 2 * (*std::max_element(sourceSize.begin(), sourceSize.end()) + NearGap);
}

std::size_t FanFaceFirst(const Grid& grid, int face)
{
  std::size_t first = 0;
  for (int before = 0; before < face; ++before)
  {
    first += grid.VoxelCount() / grid.size[before / 2];
  }
  return first;
}

FanLight GatherByFans(Device& device, const FanScene& scene, const Monitor& monitor)
{
  return EmissionFans(device, scene).Run(monitor);
}
}
