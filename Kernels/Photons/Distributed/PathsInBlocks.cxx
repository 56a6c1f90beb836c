#include "Photons/Distributed/PathsInBlocks.h"

#include "Distribution/MessageTags.h"
#include "Photons/Distributed/BlockMarch.h"
#include "Photons/Distributed/PhotonShares.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
/// Which part of a way: its photon's mark and the round in which it was gone.
using PartKey = std::pair<cl_ulong, cl_ulong>;
}

/// Those that one rank has.
struct PathsInBlocks::Parts
{
  std::vector<cl_ulong> keys; ///< photon, round and number of corners of each
  std::vector<cl_float4> corners;

  void Add(const std::vector<BlockPaths::Part>& parts, int round)
  {
    for (const BlockPaths::Part& part : parts)
    {
      this->keys.insert(
        this->keys.end(), { part.photon, static_cast<cl_ulong>(round), static_cast<cl_ulong>(part.corners.size()) });
      this->corners.insert(this->corners.end(), part.corners.begin(), part.corners.end());
    }
  }
  void PutInto(std::map<PartKey, std::vector<cl_float4>>& all) const
  {
    auto corner = this->corners.begin();
    for (std::size_t i = 0; i < this->keys.size(); i += 3)
    {
      const auto end = corner + static_cast<std::ptrdiff_t>(this->keys[i + 2]);
      all[{ this->keys[i], this->keys[i + 1] }].assign(corner, end);
      corner = end;
    }
  }
};

PathsInBlocks::PathsInBlocks(Communicator& communicator, const BlockPartition& partition, const MarchMedium* through)
  : Comm(communicator)
  , Partition(partition)
  , Through(through)
{
}

/// @param packed  all of them
PathsInBlocks::Parts PathsInBlocks::TraceParts(const PackedPhotons& packed)
{
  const VoxelBox& own = this->Partition.blocks[static_cast<std::size_t>(this->Comm.Rank())];
  Parts found;
  std::unique_ptr<BlockPaths> block;
  Rounds rounds(this->Comm, this->Partition);
  rounds.UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor&) {
      std::vector<PhotonOnItsWay> gone;
      std::vector<BlockPaths::Part> parts;
      if (this->Through && round == 0)
      {
        const PackedPhotons starting = ThoseIn(own, this->Partition.whole, packed);
        block = std::make_unique<BlockPaths>(*this->Through, packed.channels);
        gone = block->Start(starting, { starting.numbers.begin(), starting.numbers.end() }, parts);
      }
      else if (this->Through)
      {
        gone = block->Resume(arrived, parts);
      }
      found.Add(parts, round);
      return gone;
    },
    {});
  return found;
}

std::vector<PhotonPath> PathsInBlocks::Trace(
  const std::vector<Photon>& photons, const std::vector<std::size_t>& numbers, int eventLimit)
{
  PackedPhotons packed;
  this->Comm.Collective([&] { packed = Pack(photons, this->Partition.whole, true, eventLimit); });
  const Parts own = this->TraceParts(packed);
  if (this->Comm.Rank() > 0)
  {
    this->Comm.Send(0, MessageTag::CornersOfPaths, own.keys);
    this->Comm.Send(0, MessageTag::CornersOfPaths, own.corners);
    return {};
  }
  std::map<PartKey, std::vector<cl_float4>> all;
  own.PutInto(all);
  for (int rank = 1; rank < this->Comm.Ranks(); ++rank)
  {
    Parts others;
    others.keys = this->Comm.Receive<cl_ulong>(rank, MessageTag::CornersOfPaths);
    others.corners = this->Comm.Receive<cl_float4>(rank, MessageTag::CornersOfPaths);
    others.PutInto(all);
  }
  std::vector<PhotonPath> paths;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    const cl_ulong photon = packed.numbers[i];
    std::vector<cl_float4> corners;
    for (auto part = all.lower_bound({ photon, 0 }); part != all.end() && part->first.first == photon; ++part)
    {
      corners.insert(corners.end(), part->second.begin(), part->second.end());
    }
    paths.push_back(PathOf(this->Partition.whole, packed, i, corners));
    paths.back().photon = numbers[paths.back().photon];
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}
}
