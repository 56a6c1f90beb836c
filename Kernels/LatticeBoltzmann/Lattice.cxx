#include "LatticeBoltzmann/Lattice.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr int Width = 16; ///< WIDTH of LatticeStep.cl: voxels per vector
/// Bytes of densities that fit into the caches; if there are more, stores bypass the caches.
constexpr std::size_t Cached = std::size_t{ 48 } << 20;

cl::NDRange WholeBlocks(const std::array<int, 3>& size, int edge)
{
  return { static_cast<std::size_t>(RoundUp(size[0], edge)), static_cast<std::size_t>(RoundUp(size[1], edge)),
    static_cast<std::size_t>(RoundUp(size[2], edge)) };
}
}

Lattice::Lattice(Device& device, const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels)
  : TheDevice(device)
  , Queue(device.Queue())
  , Box(box)
  , Size(box.own.size)
  , Settings(settings)
{
  this->LayOut(voxels);
  this->Options = Define("DIRECTIONS", settings.directions) + Define("BENDS", voxels.bends) +
    Define("PASSES_ALL", voxels.passesAll) + Define("REFLECTS", voxels.Reflects()) +
    Define("PUBLISHED", settings.scheme == LatticeScheme::Published) + Define("ENDLESS", !voxels.endless.empty());
  const std::size_t bytes = 2 * sizeof(float) * static_cast<std::size_t>(settings.directions) * this->TheInfo.stride;
  this->Options += Define("STREAMS", device.IsCpu() && bytes > Cached);
  this->Load(voxels);
  this->FillDensities();
  this->Shown = Buffer<float>(device, box.Count(), "fluence");
  this->Shown.Fill(0.0f);
}

void Lattice::LayOut(const LatticeVoxels& voxels)
{
  std::copy(this->Size.begin(), this->Size.end(), this->TheInfo.size);
  // Rows begin with LatticeFirst unused values. The ghost value after the end of a row is stored in the unused values
  // of the next row.
  this->TheInfo.row = RoundUp(this->Size[0], Width) + LatticeFirst;
  this->TheInfo.layer = this->TheInfo.row * (this->Size[1] + 2);
  for (int i = 0; i < 18; ++i)
  {
    this->TheInfo.offset[i] =
      LatticeWays[i][0] + LatticeWays[i][1] * this->TheInfo.row + LatticeWays[i][2] * this->TheInfo.layer;
  }
  const std::array<bool, 3>& periodic = this->Box.periodic;
  this->TheInfo.periodic = periodic[0] + 2 * periodic[1] + 4 * periodic[2];
  this->TheInfo.inner = this->Box.innerFaces;
  std::copy(voxels.albedo.begin(), voxels.albedo.end(), this->TheInfo.albedo);
  std::copy(voxels.incoming.begin(), voxels.incoming.end(), this->TheInfo.incoming);
  // Padding, so that vectors that begin in the last row can be read completely.
  this->TheInfo.stride = static_cast<cl_ulong>(this->TheInfo.layer) * (this->Size[2] + 2) + Width;
}

template <class Inside, class Outside>
std::vector<float> Lattice::Arrange(const Inside& inside, const Outside& outside) const
{
  std::vector<float> values(this->TheInfo.stride, 0.0f);
  std::array<int, 3> at;
  for (at[2] = -1; at[2] <= this->Size[2]; ++at[2])
  {
    for (at[1] = -1; at[1] <= this->Size[1]; ++at[1])
    {
      for (at[0] = -1; at[0] <= this->Size[0]; ++at[0])
      {
        int faces = 0;
        float beyondThem = 0.0f; // sum of outside(face) over the faces of the box beyond which the position `at` lies
        std::array<int, 3> near = at;
        for (int a = 0; a < 3; ++a)
        {
          const int face = 2 * a + (at[a] < 0 ? 0 : 1);
          const bool beyond = (at[a] < 0 || at[a] >= this->Size[a]) && !(this->Box.innerFaces >> face & 1);
          if (beyond && !this->Box.periodic[a])
          {
            beyondThem += outside(face);
            ++faces;
          }
          near[a] = beyond ? (at[a] + this->Size[a]) % this->Size[a] : at[a];
        }
        const std::size_t place = static_cast<std::size_t>(at[2] + 1) * this->TheInfo.layer +
          static_cast<std::size_t>(at[1] + 1) * this->TheInfo.row + static_cast<std::size_t>(at[0] + LatticeFirst);
        values[place] = faces == 0 ? inside(this->Box.Known(near)) : beyondThem / static_cast<float>(faces);
      }
    }
  }
  return values;
}

Buffer<float> Lattice::Placed(const std::vector<float>& values, const char* what) const
{
  return Buffer<float>(
    this->TheDevice, this->Arrange([&](std::size_t voxel) { return values[voxel]; }, [](int) { return 0.0f; }), what);
}

void Lattice::Load(const LatticeVoxels& voxels)
{
  const auto arranged = [&](const std::vector<float>& values, float beyond, const char* what) {
    return Buffer<float>(this->TheDevice,
      this->Arrange([&](std::size_t voxel) { return values[voxel]; }, [&](int) { return beyond; }), what);
  };
  this->Turning = arranged(voxels.turning, 0.0f, "how voxels scatter");
  this->SetSource(voxels.source);
  this->Kept = arranged(voxels.kept, 1.0f, "how voxels absorb");
  this->Resistance = Buffer<float>(this->TheDevice,
    this->Arrange([&](std::size_t voxel) { return 1.0f / voxels.passes[voxel]; }, [](int) { return 1.0f; }),
    "how links pass light");
  if (voxels.bends)
  {
    this->Squared = arranged(voxels.squared, 0.0f, "n^2");
  }
  if (!voxels.endless.empty())
  {
    this->Endless = arranged(voxels.endless, 0.0f, "lines without an end");
  }
  if (voxels.Reflects())
  {
    this->Albedo = Buffer<float>(this->TheDevice,
      this->Arrange([](std::size_t) { return 0.0f; }, [&](int face) { return this->TheInfo.albedo[face]; }),
      "the faces' albedo");
  }
}

/// Sets densities to zero, except for incident light.
void Lattice::FillDensities()
{
  const std::vector<float> incoming =
    this->Arrange([](std::size_t) { return 0.0f; }, [&](int face) { return this->TheInfo.incoming[face]; });
  std::vector<float> densities;
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    const float weight = static_cast<float>(LatticeWeight(this->Settings.directions, i));
    std::transform(
      incoming.begin(), incoming.end(), std::back_inserter(densities), [&](float fluence) { return weight * fluence; });
  }
  this->Now = Buffer<float>(this->TheDevice, densities, "photon density");
  this->Next = Buffer<float>(this->TheDevice, densities, "photon density");
  if (this->Settings.blockSize > 0)
  {
    this->Sends = Buffer<float>(this->TheDevice, densities, "light between blocks");
  }
}

cl::Kernel Lattice::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::LatticeStep, this->Options);
}

/// Copies densities to the halo across periodic axes.
void Lattice::Wrap(const Buffer<float>& densities)
{
  const int steps[3] = { 1, this->TheInfo.row, this->TheInfo.layer };
  cl::Kernel wrap = this->Kernel("wrap_lattice");
  for (int a = 0; a < 3; ++a)
  {
    if (this->Box.periodic[a])
    {
      const int u = (a + 1) % 3, v = (a + 2) % 3;
      With(wrap, densities, this->TheInfo.stride, cl_int(steps[u]), cl_int(steps[v]), cl_int(steps[a]),
        cl_int(this->Size[a]));
      this->Queue.enqueueNDRangeKernel(
        wrap, cl::NullRange, cl::NDRange(this->Size[u] + 2, this->Size[v] + 2, this->Settings.directions));
    }
  }
}

void Lattice::Step(int steps, bool writes)
{
  if (this->Settings.blockSize > 0)
  {
    for (int done = 0; done < steps; done += this->Settings.stepsPerExchange)
    {
      this->StepBlocks(std::min(this->Settings.stepsPerExchange, steps - done));
    }
    return;
  }
  for (int step = 1; step <= steps; ++step)
  {
    this->StepTogether(writes && step == steps);
  }
}

void Lattice::StepTogether(bool writes)
{
  this->Wrap(this->Now);
  cl::Kernel step = this->Kernel("step_lattice");
  With(step, this->TheInfo, this->Resistance, this->Squared, this->Albedo, this->Turning, this->Kept, this->Source,
    this->Endless, this->Now, this->Next, this->Shown, cl_int(writes));
  this->Queue.enqueueNDRangeKernel(step, cl::NullRange, cl::NDRange(this->Size[1], this->Size[2]));
  this->Now.Swap(this->Next);
}

void Lattice::StepBlocks(int steps)
{
  const int edge = this->Settings.blockSize;
  const auto group = static_cast<std::size_t>(edge);
  this->Wrap(this->Next);
  cl::Kernel step =
    this->TheDevice.Kernel("step_blocks", kernel_source::LatticeBlocks, this->Options + Define("BLOCK", edge));
  this->TheInfo.steps = steps;
  With(step, this->TheInfo, this->Resistance, this->Squared, this->Albedo, this->Turning, this->Kept, this->Source,
    this->Endless, this->Next, this->Sends, this->Now, this->Shown);
  this->Queue.enqueueNDRangeKernel(
    step, cl::NullRange, WholeBlocks(this->Size, edge), cl::NDRange(group, group, group));
  this->Next.Swap(this->Sends);
}

std::vector<float> Lattice::FluenceAt(const Buffer<cl_int>& voxels) const
{
  cl::Kernel look = this->Kernel("look_at_lattice");
  const Buffer<float> seen(this->TheDevice, voxels.Size(), "fluence at probes");
  With(look, this->Shown, voxels, seen);
  this->TheDevice.Queue().enqueueNDRangeKernel(look, cl::NullRange, cl::NDRange(voxels.Size()));
  return seen.Read();
}

void Lattice::SetSource(const std::vector<float>& source)
{
  this->Source = this->Placed(source, "sources");
}

void Lattice::SetSourceOf(
  const Buffer<float>& scatters, const Buffer<float>& emits, const Buffer<float>& fluence, int channels, int channel)
{
  cl::Kernel kernel = this->Kernel("source_of_fluence");
  With(kernel, this->TheInfo, scatters, emits, fluence, cl_int(channels), cl_int(channel), this->Source);
  this->Queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Size[1], this->Size[2]));
}

std::vector<float> Lattice::Leaving(const Buffer<float>& densities, const LatticeInfo& info)
{
  cl::Kernel leave = this->Kernel("leave_lattice");
  const std::size_t voxels = static_cast<std::size_t>(this->Size[0]) * this->Size[1] * this->Size[2];
  const Buffer<float> leaving(this->TheDevice, 6 * voxels, "light that leaves");
  With(leave, info, this->Resistance, densities, leaving);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    leave, cl::NullRange, cl::NDRange(this->Size[0], this->Size[1], this->Size[2]));
  return leaving.Read();
}

std::vector<float> Lattice::Leaving()
{
  return this->Leaving(this->Now, this->TheInfo);
}

std::vector<float> Lattice::LeavingOfOne()
{
  for (int i = 0; i < this->Settings.directions; ++i)
  {
    this->Next.Fill(static_cast<float>(LatticeWeight(this->Settings.directions, i)),
      static_cast<std::size_t>(i) * this->TheInfo.stride, this->TheInfo.stride);
  }
  LatticeInfo black = this->TheInfo;
  std::fill_n(black.albedo, 6, 0.0f);
  return this->Leaving(this->Next, black);
}

std::vector<float> Lattice::NetFlux()
{
  this->Wrap(this->Now);
  cl::Kernel kernel = this->Kernel("flux_lattice");
  const std::size_t voxels = static_cast<std::size_t>(this->Size[0]) * this->Size[1] * this->Size[2];
  const Buffer<float> flux(this->TheDevice, 3 * voxels, "net flux");
  With(kernel, this->TheInfo, this->Resistance, this->Squared, this->Albedo, this->Now, flux);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Size[1], this->Size[2]));
  return flux.Read();
}
}
