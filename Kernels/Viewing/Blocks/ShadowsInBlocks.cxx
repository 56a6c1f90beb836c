#include "Viewing/Blocks/ShadowsInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/Communicator.h"
#include "Viewing/Sources/SmallLights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace tyndall
{
namespace
{
/// Splits a box into consecutive portions: some of its slices each, or some rows of one slice.
std::vector<VoxelBox> PortionsOf(const VoxelBox& box, std::size_t voxels)
{
  std::vector<VoxelBox> portions;
  const auto row = static_cast<std::size_t>(box.size[0]), slice = row * static_cast<std::size_t>(box.size[1]);
  if (slice == 0)
  {
    return portions;
  }
  const int slices = static_cast<int>(std::max<std::size_t>(voxels / slice, 1));
  const int rows = slice > voxels ? static_cast<int>(std::max<std::size_t>(voxels / row, 1)) : box.size[1];
  for (int k = 0; k < box.size[2]; k += slices)
  {
    for (int j = 0; j < box.size[1]; j += rows)
    {
      portions.push_back({ { box.first[0], box.first[1] + j, box.first[2] + k },
        { box.size[0], std::min(rows, box.size[1] - j), std::min(slices, box.size[2] - k) } });
    }
  }
  return portions;
}

double LongestEdge(const Grid& grid)
{
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    longest = std::max(longest, grid.Length(axis));
  }
  return longest;
}

/// relative tolerance between the ranks' lights, which each rank computes for its own block
constexpr double MostApart = 1e-5;
constexpr const char* OtherLights = "Ranks have other lights than each other: give all of them the same.";

/// The lights, from the ranks that have a block. Throws if they differ between ranks. Collective.
/// @param extent  longest edge of the whole grid, length
std::vector<SmallLight> LightsOfAll(Communicator& communicator, const std::vector<SmallLight>* own, double extent)
{
  constexpr std::size_t numbers = 12;
  static_assert(sizeof(SmallLight) == numbers * sizeof(float));
  const double unknown = -std::numeric_limits<double>::infinity();
  const double count = own ? static_cast<double>(own->size()) : unknown;
  const std::vector<double> counts = communicator.Largest({ count, own ? -count : unknown });
  if (counts[0] > unknown && counts[0] != -counts[1])
  {
    throw InvalidInput(OtherLights);
  }
  std::vector<SmallLight> lights(counts[0] > unknown ? static_cast<std::size_t>(counts[0]) : 0);
  std::vector<double> most(numbers * lights.size(), unknown), least = most;
  if (own)
  {
    const auto* const floats = reinterpret_cast<const float*>(own->data());
    std::copy(floats, floats + most.size(), most.begin());
    std::transform(most.begin(), most.end(), least.begin(), std::negate<>());
  }
  most = communicator.Largest(most);
  least = communicator.Largest(least);
  for (std::size_t i = 0; i < most.size(); ++i)
  {
    const bool isPlace = i % numbers < 3;
    if (most[i] + least[i] > MostApart * std::max({ std::abs(most[i]), std::abs(least[i]), isPlace ? extent : 1.0 }))
    {
      throw InvalidInput(OtherLights);
    }
  }
  std::transform(most.begin(), most.end(), reinterpret_cast<float*>(lights.data()),
    [](double value) { return static_cast<float>(value); });
  return lights;
}
}

ShadowsInBlocks::ShadowsInBlocks(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& held, MediumRayCaster* own, std::size_t portion)
  : Comm(communicator)
  , Partition(partition)
  , Held(held)
  , Own(own)
  , VoxelsAtOnce(portion)
  , Lights(LightsOfAll(communicator, own ? &own->LightsOfBlock() : nullptr, LongestEdge(partition.whole)))
{
}

bool ShadowsInBlocks::LeadsThrough(const Portion& portion, int rank) const
{
  return MayLeadThrough(this->Lights[static_cast<std::size_t>(portion.light)], this->Partition.whole, portion.voxels,
    this->Partition.blocks[static_cast<std::size_t>(rank)]);
}

/// Waits until the last portion that was sent has been acknowledged.
void ShadowsInBlocks::AwaitReceipt()
{
  if (const std::optional<int> receiver = std::exchange(this->Receiver, std::nullopt))
  {
    this->Comm.Receive<char>(*receiver, MessageTag::ReceiptsOfDepths);
  }
}

/// Sends an empty message if an error has occurred.
void ShadowsInBlocks::SendDepths(const Portion& portion, const Monitor& monitor)
{
  if (!this->LeadsThrough(portion, this->Comm.Rank()))
  {
    return;
  }
  std::vector<float> depths;
  this->Failure.Attempt([&] { depths = this->Own->DepthsTowards(portion.light, portion.voxels, monitor); });
  this->AwaitReceipt();
  this->Comm.Send(portion.rank, MessageTag::DepthsOfLamps, depths);
  if (portion.rank != this->Comm.Rank())
  {
    this->Receiver = portion.rank;
  }
}

/// Computes the light of a portion of this rank's voxels, once all ranks have sent their optical lengths.
void ShadowsInBlocks::SeeLight(const Portion& portion, const Camera& camera)
{
  std::vector<float> depths(3 * portion.voxels.VoxelCount(), 0.0f);
  for (int rank = 0; rank < this->Comm.Ranks(); ++rank)
  {
    if (!this->LeadsThrough(portion, rank))
    {
      continue;
    }
    const std::vector<float> part = this->Comm.Receive<float>(rank, MessageTag::DepthsOfLamps);
    if (rank != this->Comm.Rank())
    {
      this->Comm.Send<char>(rank, MessageTag::ReceiptsOfDepths, {});
    }
    if (part.size() == depths.size())
    {
      std::transform(part.begin(), part.end(), depths.begin(), depths.begin(), std::plus<float>());
    }
    else
    {
      this->Failure.broken = true; // the sender failed
    }
  }
  this->Failure.Attempt([&] { this->Own->SeeLight(portion.light, camera, portion.voxels, depths); });
}

void ShadowsInBlocks::Follow(int light, const Camera& camera, const Monitor& monitor)
{
  this->Failure = {};
  const int ranks = this->Comm.Ranks();
  for (int rank = 0; this->Own && rank < ranks; ++rank)
  {
    const auto number = static_cast<std::size_t>(rank);
    if (this->Partition.blocks[number].VoxelCount() == 0)
    {
      continue;
    }
    const std::vector<VoxelBox> portions = PortionsOf(this->Held[number], this->VoxelsAtOnce);
    const double each = 1.0 / (1.0 * ranks * static_cast<double>(portions.size()));
    double done = 1.0 * rank / ranks;
    for (const VoxelBox& voxels : portions)
    {
      const Portion portion = { light, rank, voxels };
      this->SendDepths(portion, OfPart(monitor, done, done + each));
      done += each;
      if (rank == this->Comm.Rank())
      {
        this->SeeLight(portion, camera);
      }
    }
  }
  this->AwaitReceipt();
  this->Comm.Collective([&] { this->Failure.Throw(); });
}

void ShadowsInBlocks::Find(const Camera& camera, const Monitor& monitor)
{
  if (!this->AreThere())
  {
    return;
  }
  this->Comm.Collective([&] {
    if (this->Own)
    {
      this->Own->PackForShadowRays();
    }
  });
  const double lights = static_cast<double>(this->Lights.size());
  for (std::size_t light = 0; light < this->Lights.size(); ++light)
  {
    this->Follow(static_cast<int>(light), camera,
      OfPart(monitor, static_cast<double>(light) / lights, static_cast<double>(light + 1) / lights));
  }
}
}
