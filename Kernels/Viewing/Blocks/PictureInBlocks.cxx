#include "Viewing/Blocks/PictureInBlocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int TileEdge = 4; ///< edge in pixels of a tile whose rays are marched together

/// Empty picture, for an invisible block.
Picture Nothing(const std::array<int, 2>& size)
{
  const std::size_t pixels = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  Picture picture;
  picture.width = size[0];
  picture.height = size[1];
  picture.radiance.assign(3 * pixels, 0.0f);
  picture.transmittance.assign(3 * pixels, 1.0f);
  picture.sceneTransmittance = picture.transmittance;
  picture.alpha.assign(pixels, 0.0f);
  picture.depth.assign(pixels, std::numeric_limits<float>::max());
  return picture;
}

/// Adds the result of a ray that has ended to the picture.
/// @param tells  whether this ray also sets transmittance and depth
void Add(const RayOnItsWay& ray, bool tells, Picture& picture)
{
  const auto pixel = static_cast<std::size_t>(ray.pixel);
  for (std::size_t c = 0; c < 3; ++c)
  {
    picture.radiance[3 * pixel + c] += ray.radiance[c] * ray.entrySquare;
  }
  if (tells && ray.kind == RayIsPrimary)
  {
    picture.alpha[pixel] = 1.0f - ray.seen;
    picture.depth[pixel] = ray.depth;
    std::fill_n(picture.sceneTransmittance.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, ray.seen);
  }
}
}

SharedScene PictureInBlocks::Shared(Communicator& communicator, const SharedScene* own)
{
  constexpr double Nowhere = -std::numeric_limits<double>::infinity();
  std::vector<double> said(6, Nowhere);
  if (own)
  {
    said = { -own->index.least, own->index.largest, own->coloured ? 1.0 : 0.0, -own->straightOn[0], -own->straightOn[1],
      -own->straightOn[2] };
  }
  const std::vector<double> largest = communicator.Largest(said);
  SharedScene all;
  if (largest[0] > Nowhere)
  {
    all.index = { static_cast<float>(-largest[0]), static_cast<float>(largest[1]) };
    all.coloured = largest[2] > 0.0;
    all.straightOn = { -largest[3], -largest[4], -largest[5] };
  }
  return all;
}

PictureInBlocks::PictureInBlocks(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& held, MediumRayCaster* own, const WorkAtOnce& atOnce)
  : Comm(communicator)
  , Partition(partition)
  , Own(own)
  , Shadows(communicator, partition, held, own, atOnce.voxels)
  , RaysAtOnce(atOnce.rays)
{
  const std::vector<double> any = this->Comm.Largest(
    { own && !own->CastsBlocks() ? 1.0 : 0.0, own && own->ShowsMoments() ? 1.0 : 0.0, own ? own->StepSize() : 0.0 });
  this->InRounds = any[0] > 0.0;
  this->ByMoments = any[1] > 0.0;
  this->Between.emplace(communicator, partition, 1 + static_cast<int>(std::ceil(any[2])));
}

void PictureInBlocks::FindSources(const Camera& camera, const Monitor& monitor)
{
  if (!OnAnyRank(this->Comm, this->Own && this->Own->NeedsSources()))
  {
    return;
  }
  this->Shadows.Find(camera, monitor);
  this->Comm.Collective([&] {
    if (this->Own)
    {
      this->Own->FinishSources(camera);
    }
  });
}

/// Sorts rays so that those of neighbouring pixels are adjacent.
std::vector<RayOnItsWay> PictureInBlocks::InOrder(std::vector<RayOnItsWay> rays, int width) const
{
  const auto place = [width](const RayOnItsWay& ray) {
    const int column = ray.pixel % width, row = ray.pixel / width;
    return std::tuple(ray.kind, row / TileEdge, column / TileEdge, ray.pixel);
  };
  std::sort(rays.begin(), rays.end(), [&](const RayOnItsWay& a, const RayOnItsWay& b) { return place(a) < place(b); });
  return rays;
}

/// Marches rays until they have ended or left this rank's block.
/// @return the rays that are now in other blocks
std::vector<RayOnItsWay> PictureInBlocks::Follow(const MediumRayCaster::Pass& pass, std::vector<RayOnItsWay> rays,
  bool sharp, Picture& picture, const Monitor& monitor)
{
  const VoxelBox& own = this->Partition.blocks[static_cast<std::size_t>(this->Comm.Rank())];
  std::vector<RayOnItsWay> gone;
  while (!rays.empty())
  {
    rays = this->InOrder(std::move(rays), picture.width);
    std::vector<RayOnItsWay> born = this->Own->MarchRays(pass, rays, monitor);
    rays.insert(rays.end(), born.begin(), born.end());
    std::vector<RayOnItsWay> here;
    for (RayOnItsWay& ray : rays)
    {
      for (int axis = 0; axis < 3; ++axis) // a ray on the upper face of the domain
      {
        ray.where[axis] = std::clamp(ray.where[axis], 0, this->Partition.whole.size[axis] - 1);
      }
      if (ray.state == RayHasEnded)
      {
        Add(ray, sharp || !this->ByMoments, picture);
      }
      else
      {
        (Holds(own, ray.where) ? here : gone).push_back(ray);
      }
    }
    rays = std::move(here);
  }
  return gone;
}

/// Renders rows of pixels in groups; only the rays of one group travel between ranks at a time.
void PictureInBlocks::CastInRounds(const Camera& camera, bool sharp, Picture& picture, const Monitor& monitor)
{
  MediumRayCaster::Pass pass = {};
  auto rays = static_cast<double>(this->RaysAtOnce);
  this->Comm.Collective([&] {
    if (this->Own)
    {
      pass = this->Own->BeginPass(camera, sharp);
      picture.farDepth = pass.view.marching.s[2];
      rays = std::min(rays, static_cast<double>(this->Own->RaysThatFit()));
    }
  });
  const double fit = -this->Comm.Largest({ -rays })[0];
  const int rows = TileEdge * std::max(static_cast<int>(fit / (1.0 * TileEdge * picture.width)), 1);
  for (int begin = 0; begin < picture.height; begin += rows)
  {
    const PixelRows some = { begin, std::min(begin + rows, picture.height) };
    this->Between->UntilAllEnd<RayOnItsWay>(
      [&](int round, std::vector<RayOnItsWay>&& arrived, const Monitor& ofRound) {
        if (!this->Own)
        {
          return std::vector<RayOnItsWay>();
        }
        return this->Follow(
          pass, round == 0 ? this->Own->StartRays(pass, some) : std::move(arrived), sharp, picture, ofRound);
      },
      OfPart(monitor, 1.0 * some.begin / picture.height, 1.0 * some.end / picture.height));
  }
}

Picture PictureInBlocks::Take(const Camera& camera, const std::array<int, 2>& size, const Monitor& monitor)
{
  const double seen = this->Shadows.AreThere() ? 0.5 : 0.0;
  this->FindSources(camera, OfPart(monitor, 0.0, seen));
  Picture picture = Nothing(size);
  if (this->InRounds)
  {
    const double scattered = this->ByMoments ? 0.8 : 1.0;
    this->CastInRounds(camera, false, picture, OfPart(monitor, seen, scattered));
    if (this->ByMoments)
    {
      this->CastInRounds(camera, true, picture, OfPart(monitor, scattered, 1.0));
    }
    return picture;
  }
  this->Comm.Collective([&] {
    if (this->Own)
    {
      picture = this->Own->CastStraight(camera, OfPart(monitor, seen, 1.0));
    }
  });
  return picture;
}
}
