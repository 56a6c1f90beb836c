#include "Photons/Marching/MarchLaunch.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <string>

namespace tyndall
{
namespace
{
/// Maximum number of compute units for private sums: with more, adding up the copies costs more than atomics.
constexpr int PrivateSumsAtMost = 8;
/// Path segments in the first launch with straight rays; two cores follow them in less than SecondsPerLaunch.
constexpr double EventsPerLaunch = 4e7;
constexpr double FirstBent = 16384; ///< photons in the first launch with curved rays

bool HasAtomics(const Device& device)
{
  return device.HasExtension("cl_khr_int64_base_atomics");
}

bool NeedAtomics(const Device& device, MarchSettings::Sums sums)
{
  const bool atomics = HasAtomics(device);
  const bool few = device.IsCpu() && device.ComputeUnits() <= PrivateSumsAtMost;
  if (sums == MarchSettings::Sums::Shared && !atomics)
  {
    throw DeviceError(device.Name() +
      " has no 64-bit atomics (cl_khr_int64_base_atomics), which shared sums need. Choose private sums.");
  }
  return sums == MarchSettings::Sums::Shared || (sums == MarchSettings::Sums::Fitting && atomics && !few);
}

/// With straight rays, the cost of a launch follows from the number of voxels; with curved rays, it is measured in the
/// first launch. Few launches are best: at the end of each, work-items idle.
Batches LaunchesOf(const MarchMedium& medium, const PackedPhotons& packed, const MarchShares& shares)
{
  const double edges = (medium.grid.size[0] + medium.grid.size[1] + medium.grid.size[2]) / 3.0;
  const double straight = EventsPerLaunch / edges;
  const double first =
    medium.bends ? std::min(straight, FirstBent * std::min(medium.settings.stepSize, 1.0)) : straight;
  const int sharing = (shares.workers + shares.batches - 1) / shares.batches; // workers that share a batch
  Batches launches;
  launches.count = packed.LargestBatch();
  launches.whole = static_cast<std::size_t>(MarchBlock) * static_cast<std::size_t>(std::max(sharing, 1));
  launches.first = static_cast<std::size_t>(first / shares.batches);
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  return launches;
}
}

void Check(const MarchSettings& settings)
{
  constexpr double ShortestStep = 0.05; // voxels; for shorter steps, rounding of positions matters
  constexpr double LongestStep = 1e4;
  if (settings.order != 1 && settings.order != 2 && settings.order != 4)
  {
    throw InvalidInput("The integrator's order is " + std::to_string(settings.order) + "; there are 1, 2 and 4.");
  }
  if (!(settings.stepSize >= ShortestStep && settings.stepSize <= LongestStep))
  {
    throw InvalidInput("The step size is " + Text("%g", settings.stepSize) + " voxels; it must be " +
      Text("%g", ShortestStep) + " to " + Text("%g", LongestStep) + ".");
  }
  if (settings.maximumOrders < 0)
  {
    throw InvalidInput("MaximumOrders is " + std::to_string(settings.maximumOrders) +
      "; it must be 0 (until photons are absorbed or have left) or more.");
  }
  if (settings.errorBatches < 0 || settings.errorBatches == 1 || settings.errorBatches > MarchedBatchesAtMost)
  {
    throw InvalidInput("A standard error from " + std::to_string(settings.errorBatches) +
      " batches of photons was asked for; it takes 2 to " + std::to_string(MarchedBatchesAtMost) + ", or 0 for none.");
  }
  if (settings.errorBatches > 0 && (settings.batches || settings.counts))
  {
    throw InvalidInput(
      "The standard error is found from batches of its own. Ask for it, or for counts and for the light "
      "of each of the photons' batches, not for both.");
  }
  if (settings.maximumOrders != 1 && settings.batches)
  {
    throw InvalidInput(
      "The light of each batch is kept apart as far as photons are not scattered. Take MaximumOrders 1 "
      "with batches, or none of them.");
  }
  if (settings.batches && settings.sums == MarchSettings::Sums::Unsafe)
  {
    throw InvalidInput("Unsafe sums are of all photons together, not of each batch. Choose other sums, or no batches.");
  }
}

MarchShares ShareSums(const MarchMedium& medium, std::size_t records, int numbers, int batches, std::size_t held)
{
  const Device& device = medium.device;
  MarchShares shares;
  shares.atomics = NeedAtomics(device, medium.settings.sums);
  shares.batches = shares.copies = batches;
  if (medium.settings.sums == MarchSettings::Sums::Unsafe)
  {
    shares.workers = device.ComputeUnits();
    return shares;
  }
  const std::size_t bytes = records * static_cast<std::size_t>(numbers) * sizeof(cl_long);
  const std::size_t free = device.MemoryLimit() - std::min(device.MemoryLimit(), device.BytesInUse() - held);
  const auto fitting = [&] { return std::min(device.AllocationLimit(), free / (shares.atomics ? 1 : 2)) / bytes; };
  const bool mayShare = medium.settings.sums == MarchSettings::Sums::Fitting && HasAtomics(device);
  if (mayShare && fitting() < static_cast<std::size_t>(std::max(device.ComputeUnits(), batches)))
  {
    shares.atomics = true; // slower additions, but on all cores
  }
  const std::size_t fit = fitting();
  if (batches > 1 && fit < static_cast<std::size_t>(batches))
  {
    throw DeviceError("The sums of " + std::to_string(batches) + " batches of photons need " +
      std::to_string(bytes / (1 << 20) * static_cast<std::size_t>(batches)) + " MiB, and " + device.Name() +
      " has room for " + std::to_string(fit) + " of them. Use fewer batches, or a coarser grid.");
  }
  if (!shares.atomics)
  {
    shares.workers =
      static_cast<int>(std::min(std::max<std::size_t>(fit, 1), static_cast<std::size_t>(device.ComputeUnits())));
    shares.copies = std::max(shares.workers, batches);
  }
  return shares;
}

PhotonsOnDevice::PhotonsOnDevice(
  Device& device, const PackedPhotons& packed, const std::vector<cl_ulong>& marksOfPhotons)
  : values(device, packed.values, "photons")
  , marks(device, marksOfPhotons, "marks of photons")
  , batchBegin(device, packed.batchBegin, "batches of photons")
  , ends(device, packed.Count() * static_cast<std::size_t>(EndWords + packed.channels), "ends of photons")
{
}

cl::Kernel MarchKernelFor(
  const MarchMedium& medium, const MarchSums& target, int channels, const char* name, const std::string& options)
{
  return medium.MarchKernel(name, channels, target.directions,
    Define("REAL_WIDTH", medium.device.KernelWidth()) + Define("ATOMICS", target.shares.atomics) +
      Define("WORKERS", target.shares.workers) + Define("BLOCK", MarchBlock) + Define("PATHS", 0) +
      Define("COUNTS", target.counts) + Define("CELLS", target.cells != nullptr) + options);
}

void MarchPhotons(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, const Monitor& monitor)
{
  Device& device = medium.device;
  const MarchShares& shares = target.shares;
  const int width = device.KernelWidth();
  const std::size_t stride = shares.copies > 1 ? target.records * static_cast<std::size_t>(target.numbers) : 0;
  // With Unsafe sums, all workers use one copy, as if each had its own.
  const int copies = std::max(shares.copies, shares.workers);
  cl::Kernel march = MarchKernelFor(medium, target, packed.channels, "march_photons");
  const Buffer<cl_int> none(device, 0, "cells of the voxels");
  const Buffer<cl_int>& cells = medium.bricks.AreThere() ? medium.bricks.First() : target.cells ? *target.cells : none;
  Buffer<cl_int> next(device, static_cast<std::size_t>(shares.batches), "number of the next photon");
  InBatches(device, LaunchesOf(medium, packed, shares), monitor, [&](std::size_t first, std::size_t count) {
    next.Fill(0);
    With(march, medium.Describe(), medium.sigma, medium.coefficients, medium.nodes, photons.values, photons.marks,
      cells, photons.ends, *target.sums, cl_ulong(stride), cl_int(copies), cl_int(shares.batches), photons.batchBegin,
      next, cl_int(first), cl_int(count));
    const std::size_t packets = PartsOf(count, Count(width));
    if (shares.workers > 0)
    {
      medium.Launch(march, cl::NDRange(static_cast<std::size_t>(shares.workers)), cl::NDRange(1));
    }
    else if (device.IsCpu())
    {
      // Work-groups of one: PoCL would keep the packets of a whole work-group on one stack.
      medium.Launch(march, cl::NDRange(packets, static_cast<std::size_t>(shares.batches)), cl::NDRange(1, 1));
    }
    else
    {
      medium.Launch(march, cl::NDRange(packets, static_cast<std::size_t>(shares.batches)));
    }
  });
}
}
