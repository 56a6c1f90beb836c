#include "EmissionBeams.h"

#include "AxisSweep.h"
#include "TyndallKernelSources.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int CellsPerEdge = 20;       ///< of the direction set near the peak
constexpr int RaysPerEdge = 2;         ///< of a voxel there
constexpr double BeamWidth = 1.0;      ///< voxels, where beams leave the box
constexpr double BeamTangent = 0.0625; ///< at most
constexpr int RowSums = 11;            ///< EMISSION_SUMS of EmissionBeams.cl
constexpr int RowsPerLaunch = 256;     ///< keeps a launch well below a tenth of a second for rows of a thousand voxels
constexpr int RoundsAtMost = 64;       ///< of a beam on a periodic axis

// As lamp_info, beam_row in LampBeams.cl, the others in EmissionBeams.cl.
struct LampOnDevice
{
  cl_int size[3], periodic[3];
  cl_float spacing[3], position[3], direction[3];
  cl_float cosine, intensity, scale;
  cl_int rounds;
};
struct BeamRow
{
  cl_int axis, up;
  cl_float tangentU, tangentV, widthU, widthV;
  cl_int count;
  cl_float begin;
};
struct VoxelBox
{
  cl_int first[3], size[3];
};
struct RegionOnDevice
{
  VoxelBox source, inner, outer;
  cl_float focus;
};
struct PatchOnDevice
{
  cl_int axis, up;
  cl_float low[2], size[2];
  cl_int samples, number;
};

/// A face of the peak's box is cut in `parts` x `parts`, as Gauss's rule has them.
struct Rule
{
  int samples; ///< of a part's radiance, along each edge
  std::vector<double> parts, nodes;
};
const Rule Fine = { 2, { 0.173927423, 0.326072577, 0.326072577, 0.173927423 },
  { 0.069431844, 0.330009478, 0.669990522, 0.930568156 } };
const Rule Coarse = { 4, { 0.5, 0.5 }, { 0.211324865, 0.788675135 } };

/// How far a rule and a focus serve, in widths of the peak.
struct Reach
{
  const Rule& rule;
  double focus, until;
};
const double Everywhere = 1e9;
const std::array<Reach, 4> Reaches = { { { Fine, 1.0, 1.25 }, { Fine, 1.7, 2.5 }, { Fine, 3.6, 6.0 },
  { Coarse, 10.0, Everywhere } } };

VoxelBox Box(const std::array<int, 3>& first, const std::array<int, 3>& size)
{
  return { { first[0], first[1], first[2] }, { size[0], size[1], size[2] } };
}

std::size_t VoxelsOf(const std::array<int, 3>& size)
{
  return static_cast<std::size_t>(size[0]) * size[1] * size[2];
}

/// Whether the first is larger, nowhere smaller.
bool Contains(const VoxelBox& outer, const VoxelBox& inner)
{
  bool larger = false, smaller = false;
  for (int a = 0; a < 3; ++a)
  {
    const int below = inner.first[a] - outer.first[a];
    const int above = outer.first[a] + outer.size[a] - inner.first[a] - inner.size[a];
    larger = larger || below > 0 || above > 0;
    smaller = smaller || below < 0 || above < 0;
  }
  return larger && !smaller;
}

cl_int4 SizeOf(const Grid& grid)
{
  return { { grid.size[0], grid.size[1], grid.size[2], 1 } };
}

/// The beams from a point in a box (both in voxels), row by row; an even number, so that none is on both sides of a patch's plane.
std::vector<BeamRow> BeamsFrom(const VoxelBox& box, const std::array<double, 3>& position)
{
  std::vector<BeamRow> rows;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const bool up = face % 2 == 1;
    const double far = up ? box.first[axis] + box.size[axis] - position[axis] : position[axis] - box.first[axis];
    const int count = 2 * static_cast<int>(std::ceil(1.0 / std::min(BeamTangent, BeamWidth / std::max(far, 1.0))));
    const float width = static_cast<float>(2.0 / count);
    for (int j = 0; j < count; ++j)
    {
      rows.push_back({ axis, up, -1.0f + 0.5f * width, -1.0f + (j + 0.5f) * width, width, width, count, 0.0f });
    }
  }
  return rows;
}

/// The light of one peak in channels that share sigma_t.
class PeakLight
{
public:
  PeakLight(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
    const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , Volume(volume)
    , FirstChannel(firstChannel)
    , Peak(peak)
    , Periodic(periodic)
  {
  }

  SweepTally Run(const Monitor& monitor)
  {
    this->SweepNear(monitor);
    this->AddNear();
    for (const std::vector<int>& channels : this->ChannelsAlike())
    {
      this->SendBeams(channels, monitor);
    }
    return this->Tally;
  }

private:
  cl::Kernel Kernel(const char* name)
  {
    return this->TheDevice.Kernel(name,
      { kernel_source::Numerics, kernel_source::FixedPoint, kernel_source::LampBeams, kernel_source::EmissionBeams },
      "-DLAMBERT=0 -DCONE=0 -DNEARNESS=0 -DATOMICS=" + std::to_string(this->HasAtomics()) +
        " -DNET_FLUX=" + std::to_string(this->Volume.flux != nullptr));
  }

  bool HasAtomics() const { return this->TheDevice.HasExtension("cl_khr_int64_base_atomics"); }
  VoxelBox NearBox() const { return Box(this->Peak.nearFirst, this->Peak.nearSize); }

  // Near the peak.

  void LoadNear()
  {
    const std::size_t voxels = VoxelsOf(this->Peak.nearSize);
    const int channels = this->Volume.channels;
    this->NearStride = (voxels + SweepPadding - 1) / SweepPadding * SweepPadding;
    const std::size_t all = this->NearStride * channels + SweepPadding;
    Device& device = this->TheDevice;
    this->SigmaT = Buffer<float>(device, this->NearStride + SweepPadding, "sigma_t near what shines");
    this->Path = Buffer<float>(device, all, "the light near what shines");
    this->SigmaT.Fill(0.0f);
    this->Path.Fill(0.0f);
    if (this->Volume.flux)
    {
      this->Flux = Buffer<float>(device, 3 * this->NearStride * channels + SweepPadding, "net_flux near what shines");
      this->Flux.Fill(0.0f);
    }
    cl::Kernel take = this->Kernel("take_near");
    With(take, this->NearBox(), SizeOf(this->Volume.grid), *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first),
      this->SigmaT);
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
    this->Source = Buffer<float>(device, source, "what shines");
  }

  void SweepNear(const Monitor& monitor)
  {
    this->LoadNear();
    SweepVolume near;
    near.grid.size = this->Peak.nearSize;
    near.grid.spacing = this->Volume.grid.spacing;
    near.channels = this->Volume.channels;
    near.stride = this->NearStride;
    near.sigma_t = &this->SigmaT;
    near.source = &this->Source;
    near.path = &this->Path;
    near.flux = this->Volume.flux ? &this->Flux : nullptr;
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
        (this->IsBorder(this->NearBox(), face) ? this->Tally.out[face][c] : this->OutOfNear[c]) += tally.out[face][c];
      }
    }
  }

  /// Whether a face of a box is the grid's.
  bool IsBorder(const VoxelBox& box, int face) const
  {
    const int axis = face / 2;
    return !this->Periodic[axis] &&
      (face % 2 == 1 ? box.first[axis] + box.size[axis] == this->Volume.grid.size[axis] : box.first[axis] == 0);
  }

  void AddNear()
  {
    cl::Kernel add = this->Kernel("add_near");
    const auto addTo = [&](const Buffer<float>& near, const Buffer<float>& values, int parts) {
      With(add, this->NearBox(), SizeOf(this->Volume.grid), near, cl_ulong(this->NearStride), values,
        cl_ulong(parts * this->Volume.first), cl_ulong(this->Volume.stride));
      this->TheDevice.Queue().enqueueNDRangeKernel(
        add, cl::NullRange, cl::NDRange(VoxelsOf(this->Peak.nearSize), parts * this->Volume.channels));
    };
    addTo(this->Path, *this->Volume.path, 1);
    if (this->Volume.flux)
    {
      addTo(this->Flux, *this->Volume.flux, 3);
    }
    this->TheDevice.Finish();
  }

  // Beyond.

  /// Light of the peak that comes from `inner` and is followed to the border of `outer`, with one rule.
  struct Stage
  {
    const Rule& rule;
    double focus;
    VoxelBox inner, outer;
  };

  /// The box around the peak with a margin of so many of its widths, within the grid but for periodic axes.
  VoxelBox WithMargin(double widths) const
  {
    const Grid& grid = this->Volume.grid;
    VoxelBox box;
    for (int a = 0; a < 3; ++a)
    {
      const double margin = widths * this->Peak.Width(grid) / grid.spacing[a];
      const int reach = static_cast<int>(std::min(std::ceil(margin), RoundsAtMost * 1.0 * grid.size[a]));
      const int from = this->Peak.first[a] - reach;
      const int to = this->Peak.first[a] + this->Peak.size[a] + reach;
      box.first[a] = this->Periodic[a] ? from : std::max(from, 0);
      box.size[a] = (this->Periodic[a] ? to : std::min(to, grid.size[a])) - box.first[a];
    }
    return box;
  }

  /// From the near box on, until all of the grid is within.
  std::vector<Stage> Stages() const
  {
    std::vector<Stage> stages;
    VoxelBox inner = this->NearBox();
    for (const Reach& reach : Reaches)
    {
      const VoxelBox outer = this->WithMargin(reach.until);
      if (Contains(outer, inner))
      {
        stages.push_back({ reach.rule, reach.focus * this->Peak.Width(this->Volume.grid), inner, outer });
        inner = outer;
      }
    }
    return stages;
  }

  /// What became of the light of all patches: parts of the power.
  struct BeamTally
  {
    double lostInner = 0.0, escapedInner = 0.0, handedOn = 0.0, stranded = 0.0, shone = 0.0;
    std::array<double, 6> escaped = {};
    double OutOfInner() const { return this->shone - this->lostInner - this->escapedInner; }
  };

  /// Follow the light of channels in which it is spread alike over the peak.
  void SendBeams(const std::vector<int>& channels, const Monitor& monitor)
  {
    const std::size_t voxels = VoxelsOf(this->Peak.size);
    std::vector<float> parts(voxels);
    const double power = this->Power(channels[0]);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      parts[i] = static_cast<float>(this->Emission(channels[0], i) / power);
    }
    const Buffer<float> emission(this->TheDevice, parts, "what shines");
    Rgb out = this->OutOfNear;
    for (const Stage& stage : this->Stages())
    {
      Buffer<cl_long> deposit(
        this->TheDevice, (this->Volume.flux ? 4 : 1) * this->Volume.stride, "the light of what shines");
      deposit.Fill(0);
      BeamTally tally;
      for (int face = 0; face < 6; ++face)
      {
        this->FollowFace(stage, face, emission, deposit, tally);
        Report(monitor, 0.5 + 0.5 * (face + 1.0) / 6.0);
      }
      for (int c : channels)
      {
        out[c] = this->AddBeams(c, out[c], tally, deposit);
      }
    }
  }

  void FollowFace(
    const Stage& stage, int face, const Buffer<float>& emission, const Buffer<cl_long>& deposit, BeamTally& tally)
  {
    const VoxelBox source = Box(this->Peak.first, this->Peak.size);
    if (this->IsBorder(source, face))
    {
      return; // its light leaves the grid: counted where it is near
    }
    const int axis = face / 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    PatchOnDevice patch = {};
    patch.number = 37 * face;
    patch.axis = axis;
    patch.up = face % 2;
    patch.samples = stage.rule.samples;
    std::array<double, 3> position;
    position[axis] = source.first[axis] + patch.up * source.size[axis];
    double lowV = 0.0;
    for (std::size_t j = 0; j < stage.rule.parts.size(); ++j)
    {
      double lowU = 0.0;
      for (std::size_t i = 0; i < stage.rule.parts.size(); ++i)
      {
        patch.low[0] = static_cast<float>(source.first[u] + lowU * source.size[u]);
        patch.low[1] = static_cast<float>(source.first[v] + lowV * source.size[v]);
        patch.size[0] = static_cast<float>(stage.rule.parts[i] * source.size[u]);
        patch.size[1] = static_cast<float>(stage.rule.parts[j] * source.size[v]);
        position[u] = source.first[u] + stage.rule.nodes[i] * source.size[u];
        position[v] = source.first[v] + stage.rule.nodes[j] * source.size[v];
        this->FollowPatch({ source, stage.inner, stage.outer, static_cast<float>(stage.focus) }, patch, position,
          emission, deposit, tally);
        ++patch.number;
        lowU += stage.rule.parts[i];
      }
      lowV += stage.rule.parts[j];
    }
  }

  void FollowPatch(const RegionOnDevice& region, const PatchOnDevice& patch, const std::array<double, 3>& position,
    const Buffer<float>& emission, const Buffer<cl_long>& deposit, BeamTally& tally)
  {
    const std::vector<BeamRow> rows = BeamsFrom(region.outer, position);
    const Buffer<BeamRow> rowBuffer(this->TheDevice, rows, "the beams of what shines");
    Buffer<float> sums(this->TheDevice, rows.size() * RowSums, "sums");
    cl::Kernel kernel = this->Kernel("follow_emission");
    const LampOnDevice info = this->Describe(patch, position);
    for (std::size_t first = 0; first < rows.size(); first += RowsPerLaunch)
    {
      const std::size_t count = std::min<std::size_t>(RowsPerLaunch, rows.size() - first);
      With(kernel, info, region, patch, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), emission, deposit,
        cl_ulong(this->Volume.stride), rowBuffer, cl_int(count), cl_int(first), sums);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        kernel, cl::NullRange, cl::NDRange(this->HasAtomics() ? count : 1), cl::NDRange(1));
      this->TheDevice.Finish();
    }
    const std::vector<float> values = sums.Read();
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      const float* row = values.data() + r * RowSums;
      tally.lostInner += row[0];
      tally.escapedInner += row[1];
      tally.handedOn += row[2];
      for (int face = 0; face < 6; ++face)
      {
        tally.escaped[face] += row[3 + face];
      }
      tally.stranded += row[9];
      tally.shone += row[10];
    }
  }

  LampOnDevice Describe(const PatchOnDevice& patch, const std::array<double, 3>& position) const
  {
    const Grid& grid = this->Volume.grid;
    LampOnDevice info = {};
    for (int a = 0; a < 3; ++a)
    {
      info.size[a] = grid.size[a];
      info.periodic[a] = this->Periodic[a];
      info.spacing[a] = static_cast<float>(grid.spacing[a]);
      info.position[a] = static_cast<float>(position[a]);
    }
    info.intensity = static_cast<float>(patch.size[0] * grid.spacing[(patch.axis + 1) % 3] * patch.size[1] *
      grid.spacing[(patch.axis + 2) % 3]); // the patch's area
    info.scale = static_cast<float>(this->Scale());
    info.rounds = RoundsAtMost;
    return info;
  }

  /// Fixed point units per length: no voxel can gather more than all power along its diagonal.
  double Scale() const
  {
    const std::array<double, 3>& h = this->Volume.grid.spacing;
    return std::exp2(std::floor(std::log2(0x1p60 / (std::hypot(h[0], h[1], h[2]) * RoundsAtMost))));
  }

  /// @param out  W that come out of the inner box: the beams bring as much
  /// @return W that go on beyond the outer box
  double AddBeams(int c, double out, const BeamTally& tally, const Buffer<cl_long>& deposit)
  {
    if (!(tally.OutOfInner() > 1e-30))
    {
      this->Tally.onTheWay[c] += out; // next to nothing, that no beam has
      return 0.0;
    }
    const double factor = out / tally.OutOfInner();
    cl::Kernel add = this->Kernel("add_emission");
    const auto addTo = [&](const Buffer<float>& values, std::size_t first, int part) {
      With(add, deposit, cl_ulong(part * this->Volume.stride), values, cl_ulong(first),
        static_cast<float>(factor / this->Scale()));
      this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(this->Volume.stride));
    };
    addTo(*this->Volume.path, this->Volume.first + c * this->Volume.stride, 0);
    for (int a = 0; a < 3 && this->Volume.flux; ++a)
    {
      addTo(*this->Volume.flux, 3 * this->Volume.first + (3 * c + a) * this->Volume.stride, 1 + a);
    }
    this->TheDevice.Finish();
    for (int face = 0; face < 6; ++face)
    {
      this->Tally.out[face][c] += tally.escaped[face] * factor;
    }
    this->Tally.onTheWay[c] += tally.stranded * factor;
    return tally.handedOn * factor;
  }

  /// Channels that shine, those together whose light is spread alike.
  std::vector<std::vector<int>> ChannelsAlike() const
  {
    std::vector<std::vector<int>> groups;
    for (int c = 0; c < this->Volume.channels; ++c)
    {
      if (this->Power(c) <= 0.0)
      {
        continue;
      }
      bool found = false;
      for (std::vector<int>& group : groups)
      {
        if (!found && this->Alike(group[0], c))
        {
          group.push_back(c);
          found = true;
        }
      }
      if (!found)
      {
        groups.push_back({ c });
      }
    }
    return groups;
  }

  bool Alike(int a, int b) const
  {
    const double powerA = this->Power(a), powerB = this->Power(b);
    bool alike = true;
    for (std::size_t i = 0; i < VoxelsOf(this->Peak.size); ++i)
    {
      const double ofA = this->Emission(a, i) / powerA;
      alike = alike && std::abs(ofA - this->Emission(b, i) / powerB) <= 1e-6 * ofA;
    }
    return alike;
  }

  float Emission(int channel, std::size_t place) const
  {
    return this->Peak.emission[(this->FirstChannel + channel) * VoxelsOf(this->Peak.size) + place];
  }

  /// W
  double Power(int channel) const
  {
    double sum = 0.0;
    this->ForVoxels([&](const std::array<int, 3>&, std::size_t place) { sum += this->Emission(channel, place); });
    return 4.0 * glm::pi<double>() * sum * this->Volume.grid.VoxelVolume();
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
  std::array<bool, 3> Periodic;

  std::size_t NearStride = 0;
  Buffer<float> SigmaT, Source, Path, Flux; ///< of the near box
  Rgb OutOfNear = {};                       ///< W, but through the grid's faces
  SweepTally Tally;
};
}

SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  const std::array<bool, 3>& periodic, const Monitor& monitor)
{
  return PeakLight(device, volume, firstChannel, peak, periodic).Run(monitor);
}
}
