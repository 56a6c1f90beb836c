#include "LightPropagation/Uncollided/EmissionFans.h"

#include "Device/Defines.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr int FewestPoints = 8;   ///< fans into each part of space; two halves, each of four mirror images
constexpr int MostPoints = 256;   ///< the same
constexpr double FewLeft = 0.012; ///< of all voxels, may be left to 32 rays of their own rather than to one more fan
constexpr double LinesPerVoxel = 1.02;      ///< along an edge in the last layer: none is without a line
constexpr int LineStep = 16;                ///< lines are a multiple of that: the widest packet
constexpr std::size_t KeptFloats = 1 << 24; ///< of the fans that are kept at a time, about: 64 MiB
constexpr int NearGap = 3; ///< voxels between what shines and the nearest voxel that a fan is asked for

/// Of Sobol's sequence in four dimensions (Joe and Kuo 2008), the first numbers of each, over 2, 4, 8, ...
constexpr int SobolBits = 6;
constexpr std::array<std::array<int, SobolBits>, 4> SobolNumbers = { { { 1, 1, 1, 1, 1, 1 }, { 1, 3, 5, 15, 17, 51 },
  { 1, 3, 3, 9, 29, 23 }, { 1, 3, 1, 5, 31, 29 } } };

/// 0 to 1, in the middle of a cell of all the points.
double InSequence(int n, int dimension)
{
  int place = 0;
  for (int bit = 0; bit < SobolBits; ++bit)
  {
    place ^= (n >> bit & 1) * (SobolNumbers[dimension][bit] << (SobolBits - 1 - bit));
  }
  return (place + 0.5) / (1 << SobolBits);
}

/// The box of what shines, its axes in another order and some of them turned round.
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

  /// The point at parts of what shines: of all along the first axis, and of what is left along the two others in turn.
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
    const std::size_t voxels = this->Scene.emission.size() / this->Scene.volume.channels;
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
          const std::size_t place = (static_cast<std::size_t>(v[2]) * size[1] + v[1]) * size[0] + v[0];
          for (std::size_t i = place; i < this->Scene.emission.size(); i += voxels)
          {
            sum += this->Scene.emission[i];
          }
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
  EmissionFans(Device& device, const FanScene& scene, const Buffer<float>& path, const Buffer<float>& flux)
    : TheDevice(device)
    , Scene(scene)
    , Path(path)
    , Flux(flux)
    , Outside(device, scene.volume.stride, "extinction around what shines")
    , Halves(device, scene.volume.stride, "half the light of what shines")
  {
    const SweepVolume& volume = scene.volume;
    this->Halves.Fill(0.0f);
    cl::Kernel clear = this->Kernel("clear_box");
    With(clear, scene.info, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Outside);
    device.Queue().enqueueNDRangeKernel(clear, cl::NullRange, cl::NDRange(volume.grid.VoxelCount()));
    this->Emitted = std::accumulate(scene.emission.begin(), scene.emission.end(), 0.0) * volume.grid.VoxelVolume();
  }

  Buffer<float> Run(const Monitor& monitor)
  {
    Buffer<float> found(this->TheDevice, this->Scene.volume.stride, "voxels that fans light");
    found.Fill(-1.0f);
    this->FollowAll(0, this->Points, OfPart(monitor, 0.0, 0.5));
    while (this->ArePartsLeft(found) && this->Points < MostPoints)
    {
      cl::Kernel keep = this->Kernel("keep_half");
      With(keep, this->Path, cl_ulong(this->Scene.volume.stride), this->Halves);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        keep, cl::NullRange, cl::NDRange(this->Scene.volume.grid.VoxelCount()));
      this->FollowAll(this->Points, 2 * this->Points, OfPart(monitor, 0.5, 1.0));
      this->Points *= 2;
    }
    for (const Buffer<float>* values : { &this->Path, &this->Flux })
    {
      if (values->Size() > 0)
      {
        cl::Kernel scale = this->Kernel("scale_fans");
        With(scale, *values, static_cast<float>(1.0 / this->Points));
        this->TheDevice.Queue().enqueueNDRangeKernel(scale, cl::NullRange, cl::NDRange(values->Size()));
      }
    }
    this->TheDevice.Finish();
    return found;
  }

private:
  /// Judges all voxels. @return whether more than a few of the far ones need more fans
  bool ArePartsLeft(Buffer<float>& found)
  {
    const SweepVolume& volume = this->Scene.volume;
    cl::Kernel judge = this->Kernel("judge_fans");
    With(judge, this->Scene.info, this->Path, cl_ulong(volume.stride),
      static_cast<float>(this->Emitted * volume.grid.VoxelVolume() * this->Points), this->Halves, found);
    this->TheDevice.Queue().enqueueNDRangeKernel(judge, cl::NullRange, cl::NDRange(volume.grid.VoxelCount()));
    const std::vector<float> values = found.Read();
    const std::ptrdiff_t left = std::count(values.begin(), values.begin() + volume.grid.VoxelCount(), 0.0f);
    return left > FewLeft * this->Points * volume.grid.VoxelCount();
  }

  /// @param from, end  points of each part of space
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
      Define("REAL_WIDTH", width) + Define("CHANNELS", this->Scene.volume.channels) +
        Define("NET_FLUX", this->Scene.volume.deposit.flux != nullptr));
  }

  /// The fans into one part of space. @return no layers: it has no far voxels
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
    const double away = fan.first[0] + 1.0 - box.First[0] - 0.5 * box.Size[0]; // how far aside voxels are, at most
    fan.spacing = static_cast<float>(1.0 / (LinesPerVoxel * farthest));
    const auto cover = [&](int k, float& first, int& count) {
      const double low = std::min(0.0, (fan.first[k] - box.First[k] - box.Size[k]) / nearest);
      const double high = std::min(away + 0.5 * box.Size[k] + 0.5, ends[k] - box.First[k] + 0.0) / nearest;
      first = static_cast<float>(low) - 0.5f * fan.spacing;
      count = static_cast<int>(std::ceil((high - low) / fan.spacing)) + 2;
    };
    cover(1, fan.firstLine, fan.lines);
    cover(2, fan.firstRow, fan.rows);
    fan.lines = (fan.lines + LineStep - 1) / LineStep * LineStep;
    fan.emitted = static_cast<float>(this->Emitted);
    fan.share = static_cast<float>(this->Scene.volume.grid.VoxelVolume());
    return fan;
  }

  /// [point][place along the turned axes, depth in a layer]; any four are mirror images of each other.
  std::vector<float> FindPoints(const FanInfo& fan, int from, int end) const
  {
    const TurnedBox box(this->Scene, fan);
    std::vector<float> points;
    for (int p = from; p < end; ++p)
    {
      std::array<double, 4> parts;
      for (int d = 0; d < 4; ++d)
      {
        const double part = InSequence(p / 4, d);
        parts[d] = p & 2 ? 1.0 - part : part;
      }
      for (float place : box.PointAt({ parts[0], parts[1], parts[2] }, (p & 1) != 0))
      {
        points.push_back(place);
      }
      points.push_back(static_cast<float>(parts[3]));
    }
    return points;
  }

  void Follow(int part, int from, int end, const Monitor& monitor)
  {
    FanInfo fan = this->Describe(part);
    if (fan.layers == 0)
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
    const std::size_t ofRow = static_cast<std::size_t>(fan.layers) * fan.lines;
    const int mostRows = static_cast<int>(std::max<std::size_t>(1, KeptFloats / ofRow));
    fan.bandRows = std::min(fan.rows, mostRows);
    const int together = std::max(1, std::min(all, mostRows / fan.rows));
    const std::size_t lines = static_cast<std::size_t>(fan.bandRows) * fan.lines * together;
    const KeptFans kept = { { this->TheDevice, this->FindPoints(fan, from, end), "fans of rays" },
      { this->TheDevice, tangents, "fans of rays" }, { this->TheDevice, lines * fan.layers, "fans of rays" },
      { this->TheDevice, lines * this->Scene.volume.channels, "fans of rays" } };
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

  /// As in EmissionFans.cl.
  struct KeptFans
  {
    Buffer<float> points, tangents, left, weights;
  };

  void FollowBand(const FanInfo& fan, const KeptFans& kept)
  {
    const SweepVolume& volume = this->Scene.volume;
    const std::size_t width = this->TheDevice.KernelWidth();
    cl::Kernel follow = this->Kernel("follow_fan", this->TheDevice.KernelWidth());
    With(follow, this->Scene.info, fan, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Outside, kept.points,
      kept.tangents, this->Scene.emissionOnDevice, kept.left, kept.weights);
    const int rows = std::min(fan.bandRows, fan.rows - fan.bandFirst);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      follow, cl::NullRange, cl::NDRange(fan.lines / width, rows, fan.points), cl::NDRange(1, 1, 1));
    cl::Kernel collect = this->Kernel("collect_fans");
    With(collect, this->Scene.info, fan, kept.points, kept.left, kept.weights, this->Path, this->Flux,
      cl_ulong(volume.stride), this->Halves);
    const cl::NDRange voxels(
      volume.grid.size[fan.order[1]] - fan.first[1], volume.grid.size[fan.order[2]] - fan.first[2], fan.layers);
    this->TheDevice.Queue().enqueueNDRangeKernel(collect, cl::NullRange, voxels, cl::NDRange(1, 1, 1));
    this->TheDevice.Finish();
  }

  Device& TheDevice;
  const FanScene& Scene;
  const Buffer<float>&Path, &Flux;
  Buffer<float> Outside, Halves; ///< as in EmissionFans.cl
  double Emitted = 0.0;          ///< as FanInfo has it
  int Points = FewestPoints;     ///< fans into each part of space
};
}

int FarFrom(const std::array<int, 3>& sourceSize)
{
  return 2 * (*std::max_element(sourceSize.begin(), sourceSize.end()) + NearGap);
}

Buffer<float> GatherByFans(
  Device& device, const FanScene& scene, const Buffer<float>& path, const Buffer<float>& flux, const Monitor& monitor)
{
  return EmissionFans(device, scene, path, flux).Run(monitor);
}
}
