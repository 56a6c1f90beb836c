#include "LightPropagation/Emission/EmissionRays.h"

#include "LightPropagation/Emission/EmissionFans.h"
#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include "TyndallKernelSources.h"

#include "Device/Batches.h"
#include "Device/Device.h"
#include "LightPropagation/PropagationSettings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int FewestRays = 32; ///< smallest initial number of rays per voxel
constexpr int MostRays = 4096; ///< largest number of rays per voxel
/// Approximate initial number of rays in all voxels together, for the default error: about a second of work.
constexpr double AllRays = 0x1p22;
constexpr double CloseRays = 0x1p20; ///< initial number of rays in all voxels in the emitting box and next to it
const double UsualError = PropagationSettings().emissionError;

/// Generating vector of a rank-1 lattice in five dimensions, found component by component for 32 to 2048 points. For
/// each n the first 2^n points, in bit-reversed order, are a lattice, too.
constexpr std::array<std::uint32_t, 5> LatticeVector = { 1, 807, 303, 119, 445 };

/// Lattice points, [dimension][MostRays], with coordinates in [0, 1).
std::vector<float> LatticePoints()
{
  std::vector<float> points;
  for (std::uint32_t component : LatticeVector)
  {
    for (std::uint32_t i = 0; i < MostRays; ++i)
    {
      std::uint32_t reversed = 0;
      for (int bit = 0; bit < 32; ++bit)
      {
        reversed |= (i >> bit & 1u) << (31 - bit);
      }
      // Overflow drops the integer part of the coordinate. With 2^-10 added, no coordinate of the first 512 points is
      // 0.
      const std::uint32_t place = reversed * component + (1u << 22);
      points.push_back(static_cast<float>(place >> 8) * 0x1p-24f);
    }
  }
  return points;
}

/// Initial number of rays per voxel, a power of two: at most `all` over all voxels, but at least `least` per voxel.
int FewestFor(double voxels, double all, int least)
{
  int rays = MostRays;
  while (rays > least && rays * voxels > all)
  {
    rays /= 2;
  }
  return rays;
}

/// Computes the light of one peak in the channels of a volume, which share sigma_t, and adds it to the volume's
/// deposit.
class PeakLight
{
public:
  PeakLight(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak, double error)
    : TheDevice(device)
    , Volume(volume)
    , FirstChannel(firstChannel)
    , Peak(peak)
    , Error(error)
  {
  }

  SweepTally Run(const Monitor& monitor)
  {
    this->Load();
    const EmissionMirrors mirrors(this->TheDevice, this->Volume, this->Scene, this->OfChannels);
    this->Scene.mirrored = mirrors.Axes();
    this->GatherVoxels(mirrors, monitor);
    this->GatherFaces(mirrors, monitor);
    this->AddGathered();
    return this->Tally;
  }

private:
  cl::Kernel Kernel(const char* name, int width = 1)
  {
    return this->TheDevice.Kernel(name, kernel_source::EmissionRays,
      Define("REAL_WIDTH", width) + Define("CHANNELS", this->Volume.channels) +
        Define("NET_FLUX", this->Volume.deposit.flux != nullptr) + Define("MOST", MostRays));
  }

  /// Number of SIMD lanes in a packet of rays.
  int Width() const { return this->TheDevice.KernelWidth(); }

  void Load()
  {
    const Grid& grid = this->Volume.grid;
    for (int a = 0; a < 3; ++a)
    {
      this->Scene.size[a] = grid.size[a];
      this->Scene.spacing[a] = static_cast<float>(grid.spacing[a]);
      this->Scene.sourceFirst[a] = this->Peak.first[a];
      this->Scene.sourceSize[a] = this->Peak.size[a];
    }
    const double all = AllRays * (UsualError / this->Error) * (UsualError / this->Error);
    this->Scene.fewest = FewestFor(static_cast<double>(grid.VoxelCount()), all, FewestRays);
    // Voxels and face cells in the box or next to it have more rays: most of the emitted power may leave through the
    // nearest faces of the grid, and an error there would change all other light, because powers are normalised to add
    // up.
    const std::array<int, 3>& size = this->Peak.size;
    // Number of voxels in the emitting box and next to it
    const double close = (size[0] + 2.0) * (size[1] + 2.0) * (size[2] + 2.0);
    this->Scene.fewestClose = FewestFor(close, CloseRays, this->Scene.fewest);
    this->Scene.uneven = static_cast<float>(this->Error);
    this->Scene.near = FarFrom(this->Peak.size);
    const std::size_t voxels = this->Peak.emission.size() / 3;
    const auto begin = this->Peak.emission.begin() + this->FirstChannel * voxels;
    this->OfChannels.assign(begin, begin + this->Volume.channels * voxels);
    for (std::size_t i = 0; i < this->OfChannels.size(); ++i)
    {
      this->Emitted[i / voxels] += 4.0 * Pi * this->OfChannels[i] * grid.VoxelVolume();
    }
    this->Emission = Buffer<float>(this->TheDevice, this->OfChannels, "what shines");
    this->Points = Buffer<float>(this->TheDevice, LatticePoints(), "rays");
  }

  /// Whether the peak's emission has the same distribution in all channels, up to a factor. All channels can then share
  /// one set of fans of rays, whose origins are distributed in proportion to emission.
  bool ShineAlike() const
  {
    const std::size_t voxels = this->OfChannels.size() / this->Volume.channels;
    for (std::size_t i = voxels; i < this->OfChannels.size(); ++i)
    {
      const double here = this->OfChannels[i] * this->Emitted[0];
      const double first = this->OfChannels[i % voxels] * this->Emitted[i / voxels];
      if (std::abs(here - first) > 1e-4 * std::max(here, first))
      {
        return false;
      }
    }
    return true;
  }

  void GatherVoxels(const EmissionMirrors& mirrors, const Monitor& monitor)
  {
    const SweepVolume& volume = this->Volume;
    Device& device = this->TheDevice;
    this->Path = Buffer<float>(device, volume.stride * volume.channels, "the light of what shines");
    this->Path.Fill(0.0f);
    this->Flux = Buffer<float>(device, volume.deposit.flux ? 3 * volume.stride * volume.channels : 0, "its net flux");
    this->Flux.Fill(0.0f);
    this->Found = Buffer<float>(device, volume.stride, "voxels that fans light");
    this->FaceLight = Buffer<float>(device, FanFaceFirst(volume.grid, 6) * volume.channels, "light that leaves");
    this->CellsFound = Buffer<float>(device, FanFaceFirst(volume.grid, 6), "cells that fans light");
    // Fans are used if the grid is so large that each voxel would start with the fewest rays: the same number of rays
    // costs less if voxels share them.
    const bool fans = this->Scene.fewest == FewestRays;
    this->Found.Fill(fans ? 1.0f : 0.0f);
    this->CellsFound.Fill(fans ? 1.0f : 0.0f);
    if (fans)
    {
      this->GatherByFansFor(OfPart(monitor, 0.0, 0.5));
    }
    mirrors.MarkImages(this->Found, this->CellsFound);
    cl::Kernel gather = this->Kernel("gather_voxels", this->Width());
    this->InParts(volume.grid.VoxelCount(), 0.5, 0.9, monitor, [&](std::size_t first, std::size_t size) {
      With(gather, this->Scene, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Points, this->Emission,
        this->Path, this->Flux, cl_ulong(volume.stride), this->Found, cl_ulong(first), cl_ulong(first + size));
      device.Queue().enqueueNDRangeKernel(gather, cl::NullRange, cl::NDRange(size));
    });
    mirrors.CopyVoxels(this->Path, this->Flux);
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

  /// Gathers light by fans of rays (EmissionFans.h) in all channels. Channels with the same distribution of emission
  /// share one set of fans; otherwise each channel has a separate one.
  void GatherByFansFor(const Monitor& monitor)
  {
    const SweepVolume& volume = this->Volume;
    const std::size_t voxels = this->OfChannels.size() / volume.channels;
    const int sets = this->ShineAlike() ? 1 : volume.channels;
    for (int set = 0; set < sets; ++set)
    {
      const auto begin = this->OfChannels.begin() + set * voxels;
      const FanScene scene = { volume, this->Scene, std::vector<float>(begin, begin + voxels) };
      if (this->Emitted[set] == 0.0)
      {
        continue;
      }
      const FanLight light = GatherByFans(this->TheDevice, scene,
        OfPart(monitor, set / static_cast<double>(sets), (set + 1) / static_cast<double>(sets)));
      const auto keep = [&](const char* kernel, const Buffer<float>& from, const Buffer<float>& to, std::size_t first,
                          std::size_t stride, float factor) {
        cl::Kernel take = this->Kernel(kernel);
        With(take, from, to, cl_ulong(first), cl_ulong(stride), factor);
        this->TheDevice.Queue().enqueueNDRangeKernel(take, cl::NullRange, cl::NDRange(from.Size()));
      };
      for (int c = set; c < (sets == 1 ? volume.channels : set + 1); ++c)
      {
        const double part = this->Emitted[c] / this->Emitted[set];
        const float ofVoxel = static_cast<float>(part * volume.grid.VoxelVolume());
        keep("take_fans", light.path, this->Path, c * volume.stride, 1, ofVoxel);
        keep("take_fans", light.faces, this->FaceLight, c, volume.channels, static_cast<float>(part));
        if (light.flux.Size() > 0)
        {
          keep("take_fans", light.flux, this->Flux, 3 * c * volume.stride, 1, ofVoxel);
        }
      }
      keep("take_least", light.found, this->Found, 0, 1, 1.0f);
      keep("take_least", light.cellsFound, this->CellsFound, 0, 1, 1.0f);
      this->TheDevice.Finish(); // the kernels must end before `light` is released
    }
  }

  void GatherFaces(const EmissionMirrors& mirrors, const Monitor& monitor)
  {
    const SweepVolume& volume = this->Volume;
    cl::Kernel gather = this->Kernel("gather_face", this->Width());
    for (int face = 0; face < 6; ++face)
    {
      const std::size_t first = FanFaceFirst(volume.grid, face);
      const std::size_t cells = FanFaceFirst(volume.grid, face + 1) - first;
      this->InParts(
        cells, 0.9 + face / 60.0, 0.9 + (face + 1) / 60.0, monitor, [&](std::size_t begin, std::size_t size) {
          With(gather, this->Scene, cl_int(face / 2), cl_int(face % 2), *volume.sigma_t, cl_ulong(volume.sigma_t_first),
            this->Points, this->Emission, this->FaceLight, this->CellsFound, cl_ulong(first), cl_ulong(begin),
            cl_ulong(begin + size));
          this->TheDevice.Queue().enqueueNDRangeKernel(gather, cl::NullRange, cl::NDRange(size));
        });
    }
    mirrors.CopyCells(this->FaceLight);
    const std::vector<float> all = this->FaceLight.Read();
    for (int face = 0; face < 6; ++face)
    {
      const auto ofCell = [&](int of) { return all.begin() + FanFaceFirst(volume.grid, of) * volume.channels; };
      std::vector<float> power(ofCell(face), ofCell(face + 1));
      const double area = volume.grid.VoxelVolume() / volume.grid.spacing[face / 2];
      for (float& watts : power)
      {
        watts *= static_cast<float>(area);
      }
      this->KeepCells(face, power);
      for (std::size_t i = 0; i < power.size(); ++i)
      {
        this->Escaped[face][i % volume.channels] += power[i];
      }
    }
  }

  /// Stores the escaped power of a face's cells in EscapedByCell, in the order of BoxFaces.h; in `power` the cells
  /// along the axis after the face's normal are contiguous.
  void KeepCells(int face, const std::vector<float>& power)
  {
    const Grid& grid = this->Volume.grid;
    const BoxFaceLayout layout = LayoutOfFace(grid, face);
    const int u = (face / 2 + 1) % 3, v = (face / 2 + 2) % 3;
    const std::size_t all = BoxFaceCellCount(grid), channels = this->Volume.channels;
    this->EscapedByCell.resize(this->Volume.deposit.faceOut ? all * channels : 0);
    for (std::size_t i = 0; i < power.size() && this->Volume.deposit.faceOut; ++i)
    {
      const std::size_t cell = i / channels, row = cell / grid.size[u];
      const std::size_t to = layout.first + cell % grid.size[u] * layout.step[u] + row * layout.step[v];
      this->EscapedByCell[i % channels * all + to] = power[i];
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

  void AddCells(int channel, double factor)
  {
    if (this->Volume.deposit.faceOut)
    {
      const std::size_t cells = BoxFaceCellCount(this->Volume.grid);
      const Buffer<float> escaped(this->TheDevice, this->EscapedByCell, "the light that leaves through the faces");
      cl::Kernel add = this->Kernel("add_gathered");
      With(add, escaped, cl_ulong(channel * cells), *this->Volume.deposit.faceOut,
        cl_ulong(this->Volume.faceFirst + channel * cells), static_cast<float>(factor));
      this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(cells));
      this->TheDevice.Finish(); // the kernel must end before `escaped` is released
    }
  }

  /// Adds the gathered light to the deposit, normalised to the emitted power.
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
      const double factor = all > 1e-30 ? this->Emitted[c] / all : 0.0;
      this->Tally.onTheWay[c] += factor > 0.0 ? 0.0 : this->Emitted[c];
      for (int face = 0; face < 6; ++face)
      {
        this->Tally.out[face][c] += factor * this->Escaped[face][c];
      }
      this->AddCells(c, factor);
      addTo(this->Path, c, *volume.deposit.path, volume.first, factor);
      for (int a = 0; a < 3 && volume.deposit.flux; ++a)
      {
        addTo(this->Flux, 3 * c + a, *volume.deposit.flux, 3 * volume.first, factor);
      }
    }
    this->TheDevice.Finish();
  }

  Device& TheDevice;
  const SweepVolume& Volume;
  int FirstChannel;
  const EmissionPeak& Peak;
  double Error;
  EmissionInfo Scene = {};

  std::vector<float> OfChannels;  ///< emission of the bounding box, W / (length^3 sr), [channel][voxel]
  Buffer<float> Points, Emission; ///< arguments of gather_voxels(): lattice, and emission
  Rgb Emitted = {};               ///< emitted power of the peak, W, by channel
  Buffer<float> Path, Flux;
  /// By voxel, 1: its light is known from fans of rays; below 1: rays are traced for this voxel alone
  Buffer<float> Found;
  /// By face cell, 1: its light is known from fans of rays; below 1: rays are traced for this cell alone
  Buffer<float> CellsFound;
  Buffer<float> FaceLight; ///< outgoing flux density through the box's faces, W / length^2, [cell][channel]
  Rgb Taken = {};          ///< power that the medium removes from the gathered light, W, by channel
  std::array<Rgb, 6> Escaped = {};
  std::vector<float> EscapedByCell; ///< escaped power, W, [channel][cell]; empty if not requested
  SweepTally Tally;
};
}

SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  double error, const Monitor& monitor)
{
  return PeakLight(device, volume, firstChannel, peak, error).Run(monitor);
}
}
