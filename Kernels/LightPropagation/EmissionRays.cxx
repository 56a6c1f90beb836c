#include "EmissionRays.h"

#include "AxisSweep.h"
#include "TyndallKernelSources.h"

#include "../Device/Batches.h"
#include "../Device/Defines.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int CellsPerEdge = 20; ///< of the direction set near the peak
constexpr int RaysPerEdge = 2;   ///< of a voxel there
constexpr int TableCells = 8;    ///< of the table of escaping light, along an edge of each of six sides

// As in EmissionRays.cl.
struct SceneOnDevice
{
  cl_int size[3];
  cl_float spacing[3];
  cl_int sourceFirst[3], sourceSize[3];
  cl_int nearFirst[3], nearSize[3];
  cl_int firstNode[2], nodes[2];
};

/// Along one edge of the peak's box, which is 1 long: parts and a point in each.
struct EdgeRule
{
  std::vector<double> begins, nodes; ///< one more begin than nodes
};

/// Gauss's rule of four points.
const EdgeRule Few = { { 0.0, 0.173927423, 0.5, 0.826072577, 1.0 },
  { 0.069431844, 0.330009478, 0.669990522, 0.930568156 } };

/// Every part of the other in two, by Gauss's rule of two points.
EdgeRule Halved(const EdgeRule& rule)
{
  EdgeRule halved = { { 0.0 }, {} };
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
  {
    const double begin = rule.begins[i], length = rule.begins[i + 1] - begin;
    halved.begins.insert(halved.begins.end(), { begin + 0.5 * length, begin + length });
    halved.nodes.insert(halved.nodes.end(), { begin + 0.211324865 * length, begin + 0.788675135 * length });
  }
  return halved;
}

std::size_t VoxelsOf(const std::array<int, 3>& size)
{
  return static_cast<std::size_t>(size[0]) * size[1] * size[2];
}

/// The light of one peak in channels that share sigma_t.
class PeakLight
{
public:
  PeakLight(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak)
    : TheDevice(device)
    , Volume(volume)
    , FirstChannel(firstChannel)
    , Peak(peak)
  {
  }

  SweepTally Run(const Monitor& monitor)
  {
    this->Describe();
    this->SweepNear(monitor);
    this->AddNear();
    this->LoadNodes(monitor);
    this->GatherVoxels(monitor);
    this->GatherFaces(monitor);
    this->AddGathered();
    return this->Tally;
  }

private:
  cl::Kernel Kernel(const char* name, int width = 1)
  {
    return this->TheDevice.Kernel(name, { kernel_source::Numerics, kernel_source::EmissionRays },
      Define("REAL_WIDTH", width) + Define("CHANNELS", this->Volume.channels) +
        Define("NET_FLUX", this->Volume.flux != nullptr) + Define("CELLS", TableCells));
  }

  /// Lanes of a packet of rays.
  int Width() const
  {
    const int width = this->TheDevice.FloatVectorWidth();
    return width >= 16 ? 16 : width >= 8 ? 8 : width >= 4 ? 4 : 1;
  }

  void Describe()
  {
    const Grid& grid = this->Volume.grid;
    for (int a = 0; a < 3; ++a)
    {
      this->Scene.size[a] = grid.size[a];
      this->Scene.spacing[a] = static_cast<float>(grid.spacing[a]);
      this->Scene.sourceFirst[a] = this->Peak.first[a];
      this->Scene.sourceSize[a] = this->Peak.size[a];
      this->Scene.nearFirst[a] = this->Peak.nearFirst[a];
      this->Scene.nearSize[a] = this->Peak.nearSize[a];
    }
  }

  // Near the peak.

  void LoadNear()
  {
    const std::size_t voxels = VoxelsOf(this->Peak.nearSize);
    const int channels = this->Volume.channels;
    this->NearStride = (voxels + SweepPadding - 1) / SweepPadding * SweepPadding;
    const std::size_t all = this->NearStride * channels + SweepPadding;
    Device& device = this->TheDevice;
    this->NearSigmaT = Buffer<float>(device, this->NearStride + SweepPadding, "sigma_t near what shines");
    this->NearPath = Buffer<float>(device, all, "the light near what shines");
    this->NearSigmaT.Fill(0.0f);
    this->NearPath.Fill(0.0f);
    if (this->Volume.flux)
    {
      this->NearFlux =
        Buffer<float>(device, 3 * this->NearStride * channels + SweepPadding, "net_flux near what shines");
      this->NearFlux.Fill(0.0f);
    }
    cl::Kernel take = this->Kernel("take_near");
    With(take, this->Scene, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), this->NearSigmaT);
    device.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(voxels));

    std::vector<float> source(all, 0.0f);
    this->ForVoxels([&](const std::array<int, 3>& at, std::size_t place) {
      std::array<int, 3> in;
      for (int a = 0; a < 3; ++a)
      {
        in[a] = this->Peak.first[a] + at[a] - this->Peak.nearFirst[a];
      }
      const std::array<int, 3>& n = this->Peak.nearSize;
      for (int c = 0; c < channels; ++c)
      {
        source[c * this->NearStride + (static_cast<std::size_t>(in[2]) * n[1] + in[1]) * n[0] + in[0]] =
          this->Emission(c, place);
      }
    });
    this->NearSource = Buffer<float>(device, source, "what shines");
  }

  void SweepNear(const Monitor& monitor)
  {
    this->LoadNear();
    SweepVolume near;
    near.grid.size = this->Peak.nearSize;
    near.grid.spacing = this->Volume.grid.spacing;
    near.channels = this->Volume.channels;
    near.stride = this->NearStride;
    near.sigma_t = &this->NearSigmaT;
    near.source = &this->NearSource;
    near.path = &this->NearPath;
    near.flux = this->Volume.flux ? &this->NearFlux : nullptr;
    const DirectionSet directions = SoundDirections(CellsPerEdge * CellsPerEdge);
    SweepWorkspace workspace;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<Bundle> bundles = BundlesAlong(axis, near.grid, directions, RaysPerEdge);
      if (bundles.empty())
      {
        continue;
      }
      AxisSweep sweep(this->TheDevice, near, axis, bundles, {}, workspace);
      const Monitor ofSweep = monitor ? Monitor([&](double done) { return monitor((axis + done) / 6.0); }) : Monitor();
      sweep.Start(near, {}, true, 0, ofSweep);
      this->CountNear(sweep.Finish());
    }
  }

  /// What leaves the near box leaves the grid, or goes on.
  void CountNear(const SweepTally& tally)
  {
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < this->Volume.channels; ++c)
      {
        (this->IsBorder(face) ? this->Tally.out[face][c] : this->OutOfNear[c]) += tally.out[face][c];
      }
    }
  }

  /// Whether a face of the near box is the grid's.
  bool IsBorder(int face) const
  {
    const int axis = face / 2;
    const int first = this->Peak.nearFirst[axis];
    return face % 2 == 1 ? first + this->Peak.nearSize[axis] == this->Volume.grid.size[axis] : first == 0;
  }

  void AddNear()
  {
    cl::Kernel add = this->Kernel("add_near");
    const auto addTo = [&](const Buffer<float>& near, const Buffer<float>& values, int parts) {
      With(add, this->Scene, near, cl_ulong(this->NearStride), values, cl_ulong(parts * this->Volume.first),
        cl_ulong(this->Volume.stride));
      this->TheDevice.Queue().enqueueNDRangeKernel(
        add, cl::NullRange, cl::NDRange(VoxelsOf(this->Peak.nearSize), parts * this->Volume.channels));
    };
    addTo(this->NearPath, *this->Volume.path, 1);
    if (this->Volume.flux)
    {
      addTo(this->NearFlux, *this->Volume.flux, 3);
    }
    this->TheDevice.Finish();
  }

  // Beyond.

  struct Nodes
  {
    std::vector<cl_float4> places, corners;
    std::vector<float> powers;
  };

  /// The box around the peak in parts, with a node in each: the rule's where it shines evenly, else moved with what shines.
  void AddNodes(int number, const EdgeRule& rule, Nodes& nodes)
  {
    const int perEdge = static_cast<int>(rule.nodes.size());
    this->Scene.firstNode[number] = static_cast<int>(nodes.places.size());
    for (int part = 0; part < perEdge * perEdge * perEdge; ++part)
    {
      const std::array<int, 3> of = { part % perEdge, part / perEdge % perEdge, part / (perEdge * perEdge) };
      std::array<double, 3> low, high, moment = {};
      int bits = (of[0] + of[1] + of[2]) % 2 * 8;
      for (int a = 2; a >= 0; --a)
      {
        low[a] = rule.begins[of[a]] * this->Peak.size[a];
        high[a] = rule.begins[of[a] + 1] * this->Peak.size[a];
        bits += (of[(a + 1) % 3] + of[(a + 2) % 3]) % 2 << a;
      }
      const Rgb power = this->PowerIn(low, high, moment);
      const double all = power[0] + power[1] + power[2];
      cl_float4 place = {};
      for (int a = 0; a < 3; ++a)
      {
        const double middle = 0.5 * (low[a] + high[a]), mean = all > 0.0 ? moment[a] / all : middle;
        const double even = std::max(1.0 - std::abs(mean - middle) / (0.5 * (high[a] - low[a])), 0.0);
        place.s[a] =
          static_cast<float>(this->Peak.first[a] + mean + even * (rule.nodes[of[a]] * this->Peak.size[a] - middle));
      }
      place.s[3] = static_cast<float>(bits);
      if (all > 0.0)
      {
        nodes.places.push_back(place);
        for (const std::array<double, 3>& corner : { low, high })
        {
          nodes.corners.push_back(
            { { static_cast<float>(corner[0]), static_cast<float>(corner[1]), static_cast<float>(corner[2]), 0.0f } });
        }
        for (int c = 0; c < this->Volume.channels; ++c)
        {
          nodes.powers.push_back(static_cast<float>(power[c]));
        }
      }
    }
    this->Scene.nodes[number] = static_cast<int>(nodes.places.size()) - this->Scene.firstNode[number];
  }

  /// Of a part of the peak's box, W / (4 pi).
  /// @param moment  of it, along each edge, voxels of the box
  Rgb PowerIn(const std::array<double, 3>& low, const std::array<double, 3>& high, std::array<double, 3>& moment) const
  {
    Rgb power = {};
    this->ForVoxels([&](const std::array<int, 3>& at, std::size_t place) {
      double shared = this->Volume.grid.VoxelVolume();
      std::array<double, 3> middle;
      for (int a = 0; a < 3; ++a)
      {
        const double from = std::max(low[a], 1.0 * at[a]), to = std::min(high[a], at[a] + 1.0);
        shared *= std::max(to - from, 0.0);
        middle[a] = 0.5 * (from + to);
      }
      for (int c = 0; c < this->Volume.channels && shared > 0.0; ++c)
      {
        const double shines = this->Emission(c, place) * shared;
        power[c] += shines;
        for (int a = 0; a < 3; ++a)
        {
          moment[a] += shines * middle[a];
        }
      }
    });
    return power;
  }

  void LoadNodes(const Monitor& monitor)
  {
    Nodes nodes;
    this->AddNodes(0, Few, nodes);
    this->AddNodes(1, Halved(Few), nodes);
    std::vector<float> grey(VoxelsOf(this->Peak.size), 0.0f);
    for (std::size_t i = 0; i < grey.size(); ++i)
    {
      for (int c = 0; c < this->Volume.channels; ++c)
      {
        grey[i] += this->Emission(c, i);
      }
    }
    Device& device = this->TheDevice;
    this->Places = Buffer<cl_float4>(device, nodes.places, "what shines");
    this->Powers = Buffer<float>(device, nodes.powers, "what shines");
    const Buffer<float> shining(device, grey, "what shines");
    const Buffer<cl_float4> corners(device, nodes.corners, "its parts");
    const std::size_t count = nodes.places.size() * 6 * (TableCells + 1) * (TableCells + 1);
    this->Escapes = Buffer<cl_float2>(device, count, "the light that gets out of what shines");
    cl::Kernel find = this->Kernel("find_escapes");
    this->InParts(count, 0.1, 0.2, monitor, [&](std::size_t first, std::size_t size) {
      With(find, this->Scene, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), shining, corners,
        this->Escapes, cl_ulong(first), cl_ulong(first + size));
      device.Queue().enqueueNDRangeKernel(find, cl::NullRange, cl::NDRange(size));
    });
  }

  void GatherVoxels(const Monitor& monitor)
  {
    const SweepVolume& volume = this->Volume;
    Device& device = this->TheDevice;
    this->Path = Buffer<float>(device, volume.stride * volume.channels, "the light of what shines");
    this->Path.Fill(0.0f);
    this->Flux = Buffer<float>(device, volume.flux ? 3 * volume.stride * volume.channels : 0, "its net flux");
    this->Flux.Fill(0.0f);
    cl::Kernel gather = this->Kernel("gather_voxels", this->Width());
    this->InParts(volume.grid.VoxelCount(), 0.2, 0.9, monitor, [&](std::size_t first, std::size_t size) {
      With(gather, this->Scene, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Escapes, this->Places,
        this->Powers, this->Path, this->Flux, cl_ulong(volume.stride), cl_ulong(first), cl_ulong(first + size));
      device.Queue().enqueueNDRangeKernel(gather, cl::NullRange, cl::NDRange(size));
    });
    cl::Kernel take = this->Kernel("take_rows");
    const std::size_t rows = volume.grid.VoxelCount() / volume.grid.size[0];
    Buffer<float> taken(device, rows, "sums");
    for (int c = 0; c < volume.channels; ++c)
    {
      With(take, cl_int(volume.grid.size[0]), *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Path,
        cl_ulong(c * volume.stride), taken);
      device.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(rows));
      for (float sum : taken.Read())
      {
        this->Taken[c] += sum;
      }
    }
  }

  void GatherFaces(const Monitor& monitor)
  {
    const SweepVolume& volume = this->Volume;
    cl::Kernel gather = this->Kernel("gather_face", this->Width());
    for (int face = 0; face < 6; ++face)
    {
      const std::size_t cells = volume.grid.VoxelCount() / volume.grid.size[face / 2];
      Buffer<float> out(this->TheDevice, cells * volume.channels, "the light that leaves through a face");
      this->InParts(
        cells, 0.9 + face / 60.0, 0.9 + (face + 1) / 60.0, monitor, [&](std::size_t first, std::size_t size) {
          With(gather, this->Scene, cl_int(face / 2), cl_int(face % 2), *volume.sigma_t, cl_ulong(volume.sigma_t_first),
            this->Escapes, this->Places, this->Powers, out, cl_ulong(first), cl_ulong(first + size));
          this->TheDevice.Queue().enqueueNDRangeKernel(gather, cl::NullRange, cl::NDRange(size));
        });
      const std::vector<float> power = out.Read();
      for (std::size_t i = 0; i < power.size(); ++i)
      {
        this->Escaped[face][i % volume.channels] += power[i];
      }
    }
  }

  template <class Queue>
  void InParts(std::size_t count, double from, double to, const Monitor& monitor, const Queue& queue)
  {
    Batches batches;
    batches.count = count;
    batches.first = batches.whole = 256;
    batches.from = from;
    batches.to = to;
    InBatches(this->TheDevice, batches, monitor, queue);
  }

  /// With the power that leaves the near box.
  void AddGathered()
  {
    const SweepVolume& volume = this->Volume;
    cl::Kernel add = this->Kernel("add_gathered");
    const auto addTo = [&](const Buffer<float>& from, int array, const Buffer<float>& to, std::size_t first,
                         double factor) {
      With(add, from, cl_ulong(array * volume.stride), to, cl_ulong(first + array * volume.stride),
        static_cast<float>(factor));
      this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(volume.stride));
    };
    for (int c = 0; c < volume.channels; ++c)
    {
      double all = this->Taken[c];
      for (const Rgb& escaped : this->Escaped)
      {
        all += escaped[c];
      }
      const double factor = all > 1e-30 ? this->OutOfNear[c] / all : 0.0;
      this->Tally.onTheWay[c] += this->OutOfNear[c] - factor * all;
      for (int face = 0; face < 6; ++face)
      {
        this->Tally.out[face][c] += factor * this->Escaped[face][c];
      }
      addTo(this->Path, c, *volume.path, volume.first, factor);
      for (int a = 0; a < 3 && volume.flux; ++a)
      {
        addTo(this->Flux, 3 * c + a, *volume.flux, 3 * volume.first, factor);
      }
    }
    this->TheDevice.Finish();
  }

  float Emission(int channel, std::size_t place) const
  {
    return this->Peak.emission[(this->FirstChannel + channel) * VoxelsOf(this->Peak.size) + place];
  }

  template <class Act>
  void ForVoxels(const Act& act) const
  {
    const std::array<int, 3>& n = this->Peak.size;
    std::size_t place = 0;
    for (int z = 0; z < n[2]; ++z)
    {
      for (int y = 0; y < n[1]; ++y)
      {
        for (int x = 0; x < n[0]; ++x)
        {
          act({ x, y, z }, place++);
        }
      }
    }
  }

  Device& TheDevice;
  const SweepVolume& Volume;
  int FirstChannel;
  const EmissionPeak& Peak;
  SceneOnDevice Scene = {};

  std::size_t NearStride = 0;
  Buffer<float> NearSigmaT, NearSource, NearPath, NearFlux;
  Rgb OutOfNear = {}; ///< W, but through the grid's faces

  Buffer<cl_float4> Places;
  Buffer<float> Powers;
  Buffer<cl_float2> Escapes;
  Buffer<float> Path, Flux; ///< beyond
  Rgb Taken = {};           ///< W, beyond
  std::array<Rgb, 6> Escaped = {};
  SweepTally Tally;
};
}

SweepTally DepositEmission(
  Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak, const Monitor& monitor)
{
  return PeakLight(device, volume, firstChannel, peak).Run(monitor);
}
}
