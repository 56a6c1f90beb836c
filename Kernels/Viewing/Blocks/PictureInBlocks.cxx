#include "Viewing/Blocks/PictureInBlocks.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int TileEdge = 4; ///< edge, in pixels, of a square of pixels whose rays are adjacent in memory
/// Value that a rank without voxels contributes to a maximum over the ranks: smaller than that of any other rank.
constexpr double Unknown = -std::numeric_limits<double>::infinity();
/// Relative tolerance within which the lights of all ranks must agree; each rank computes them for its own block.
constexpr double MostApart = 1e-5;
constexpr std::size_t NumbersOfLight = sizeof(SmallLight) / sizeof(float);

/// Empty picture: transmittance 1, no radiance.
/// @param size  width and height, pixels
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

/// Adds the radiance of a ray that has ended to the picture.
/// @param tells  whether a primary ray also sets the picture's alpha, depth and transmittance. In a picture made of
///   angular moments only the pass for unscattered light does so
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

/// Sorts rays: first the primary ones, then those reflected by the surface, then those mirrored by the table; within
/// each group such that rays of neighbouring pixels are adjacent.
/// @param width  width of the picture, pixels
void InOrder(int width, std::vector<RayOnItsWay>& rays)
{
  const auto place = [width](const RayOnItsWay& ray) {
    const int column = ray.pixel % width, row = ray.pixel / width;
    return std::tuple(ray.kind, row / TileEdge, column / TileEdge, ray.pixel);
  };
  std::sort(rays.begin(), rays.end(), [&](const RayOnItsWay& a, const RayOnItsWay& b) { return place(a) < place(b); });
}

/// Splits a box into consecutive portions of at most `voxels` voxels. A portion is several slices, or several rows of
/// one slice, but at least one row.
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

/// Whether shadow rays from the centres of the voxels `from` to a light can cross a block. Tests whether the smallest
/// box around all these rays overlaps the block, so that the answer may be true although no ray crosses it.
/// @param grid  grid of the whole domain, to which the indices of both boxes refer
/// @param from, block  boxes of voxels; the result is false if one is empty
bool MayLeadThrough(const SmallLight& light, const Grid& grid, const VoxelBox& from, const VoxelBox& block)
{
  bool may = from.VoxelCount() > 0 && block.VoxelCount() > 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    double low = from.first[axis], high = low + from.size[axis];
    if (light.place.s[3] > 0.0f)
    {
      const double place = light.place.s[axis] / grid.spacing[axis];
      low = std::min(low, place - 1.0); // margin for rounding errors
      high = std::max(high, place + 1.0);
    }
    else
    {
      low = light.axis.s[axis] > 0.0f ? 0.0 : low;
      high = light.axis.s[axis] < 0.0f ? grid.size[axis] : high;
    }
    may = may && low < block.first[axis] + block.size[axis] && high > block.first[axis];
  }
  return may;
}

/// The lights for shadow rays, the same on all ranks: taken from the ranks that have a block. Collective.
/// @param own  lights of this rank; null: it has no block
/// @throws InvalidInput on all ranks, if the lights differ between ranks
std::vector<SmallLight> LightsOfAll(const Domain& domain, const std::vector<SmallLight>* own)
{
  const Grid& whole = domain.Whole();
  const double extent = std::max({ whole.Length(0), whole.Length(1), whole.Length(2) });
  const auto require = [](bool same) {
    Require(same, "Ranks have other lights than each other: give all of them the same.");
  };
  const double count = own ? static_cast<double>(own->size()) : Unknown;
  const std::vector<double> counts = domain.Max({ count, own ? -count : Unknown });
  require(counts[0] == Unknown || counts[0] == -counts[1]);
  std::vector<SmallLight> lights(counts[0] > Unknown ? static_cast<std::size_t>(counts[0]) : 0);
  const std::size_t numbers = NumbersOfLight * lights.size();
  // The minimum and maximum over the ranks of each number that describes the lights. Minima are computed as maxima of
  // the negated numbers.
  std::vector<double> most(2 * numbers, Unknown);
  for (std::size_t i = 0; own && i < numbers; ++i)
  {
    most[i] = reinterpret_cast<const float*>(own->data())[i];
    most[numbers + i] = -most[i];
  }
  most = domain.Max(most);
  for (std::size_t i = 0; i < numbers; ++i)
  {
    const double large = most[i], small = -most[numbers + i];
    const double scale = i % NumbersOfLight < 3 ? extent : 1.0; // the first three numbers of a light are its position
    require(large - small <= MostApart * std::max({ std::abs(large), std::abs(small), scale }));
    reinterpret_cast<float*>(lights.data())[i] = static_cast<float>(large);
  }
  return lights;
}
}

SharedScene PictureInBlocks::Shared(const Domain& domain, const SharedScene* own)
{
  std::vector<double> largest(7, Unknown);
  if (own)
  {
    largest = { -own->index.least, own->index.largest, own->coloured ? 1.0 : 0.0, -own->straightOn[0],
      -own->straightOn[1], -own->straightOn[2], own->largestError };
  }
  largest = domain.Max(largest);
  SharedScene all;
  if (largest[0] > Unknown)
  {
    all.index = { static_cast<float>(-largest[0]), static_cast<float>(largest[1]) };
    all.coloured = largest[2] > 0.0;
    all.straightOn = { -largest[3], -largest[4], -largest[5] };
    all.largestError = largest[6];
  }
  return all;
}

PictureInBlocks::PictureInBlocks(
  const Domain& domain, const std::vector<VoxelBox>& held, MediumRayCaster* own, const WorkAtOnce& atOnce)
  : Over(domain)
  , Held(held)
  , Own(own)
  , AtOnce(atOnce)
  , Lights(LightsOfAll(domain, own ? &own->Sources.LightsOfBlock() : nullptr))
{
  const std::vector<double> any = domain.Max({ own && !own->CastsBlocks() ? 1.0 : 0.0,
    own && own->Traits.ShowsMoments() ? 1.0 : 0.0, own ? own->Settings.stepSize : 0.0 });
  this->InRounds = any[0] > 0.0;
  this->ByMoments = any[1] > 0.0;
  this->Between.emplace(domain.Comm(), domain.Partition(), 1 + static_cast<int>(std::ceil(any[2])));
}

/// Computes the light of one lamp in a portion of each rank's voxels. Every rank computes the optical length within its
/// block of the shadow rays from all these voxels. The rank that owns a voxel sums these lengths in rank order.
/// Collective.
/// @param light     index of the lamp
/// @param portions  by rank, the portion of its voxels; empty: all voxels of the rank are done
void PictureInBlocks::Follow(
  int light, const std::vector<VoxelBox>& portions, const Camera& camera, const Monitor& monitor)
{
  const auto rank = static_cast<std::size_t>(this->Over.Rank());
  const auto crosses = [&](std::size_t block, std::size_t owner) {
    return MayLeadThrough(this->Lights[static_cast<std::size_t>(light)], this->Over.Whole(), portions[owner],
      this->Over.Partition().blocks[block]);
  };
  std::vector<int> partners;
  for (std::size_t other = 0; other < portions.size(); ++other)
  {
    if (crosses(rank, other) || crosses(other, rank))
    {
      partners.push_back(static_cast<int>(other));
    }
  }
  const std::vector<std::vector<float>> sections = this->Over.Comm().Exchange<float>(partners, [&] {
    std::vector<std::vector<float>> own(partners.size());
    for (std::size_t i = 0; i < partners.size(); ++i)
    {
      const auto owner = static_cast<std::size_t>(partners[i]);
      const double done = static_cast<double>(i), count = static_cast<double>(partners.size());
      if (crosses(rank, owner))
      {
        own[i] =
          this->Own->Sources.DepthsTowards(light, portions[owner], OfPart(monitor, done / count, (done + 1.0) / count));
      }
    }
    return own;
  });
  this->Over.Collective([&] {
    if (portions[rank].VoxelCount() > 0)
    {
      std::vector<float> depths(3 * portions[rank].VoxelCount(), 0.0f);
      for (const std::vector<float>& section : sections)
      {
        std::transform(section.begin(), section.end(), depths.begin(), depths.begin(), std::plus<float>());
      }
      this->Own->Sources.SeeLight(light, camera, portions[rank], depths);
    }
  });
}

/// Computes the lamps' light in the voxels of all blocks. Shadow rays cross the blocks of all ranks. Collective.
void PictureInBlocks::FindShadows(const Camera& camera, const Monitor& monitor)
{
  this->Over.Collective([&] {
    if (this->Own)
    {
      this->Own->PackForShadowRays();
    }
  });
  const std::size_t ranks = this->Held.size();
  std::vector<std::vector<VoxelBox>> portions;
  std::size_t steps = 0;
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    const bool empty = this->Over.Partition().blocks[rank].VoxelCount() == 0;
    portions.push_back(PortionsOf(empty ? VoxelBox() : this->Held[rank], this->AtOnce.voxels / ranks));
    steps = std::max(steps, portions.back().size());
  }
  // The number of portions is found from all ranks' boxes, which a rank without voxels may not know.
  steps = static_cast<std::size_t>(this->Over.Max(static_cast<double>(steps)));
  const auto all = static_cast<double>(this->Lights.size() * steps);
  double done = 0.0;
  for (std::size_t light = 0; light < this->Lights.size(); ++light)
  {
    for (std::size_t step = 0; step < steps; ++step, done += 1.0)
    {
      std::vector<VoxelBox> now;
      for (const std::vector<VoxelBox>& ofRank : portions)
      {
        now.push_back(step < ofRank.size() ? ofRank[step] : VoxelBox());
      }
      this->Follow(static_cast<int>(light), now, camera, OfPart(monitor, done / all, (done + 1.0) / all));
    }
  }
}

void PictureInBlocks::FindSources(const Camera& camera, const Monitor& monitor)
{
  if (!this->Over.Any(this->Own && this->Own->NeedsSources()))
  {
    return;
  }
  if (!this->Lights.empty())
  {
    this->FindShadows(camera, monitor);
  }
  this->Over.Collective([&] {
    if (this->Own)
    {
      this->Own->FinishSources(camera);
    }
  });
}

/// Marches rays until they end or leave this rank's block.
/// @param sharp  whether this is the pass for unscattered light of a picture made of angular moments
/// @param picture  receives the radiance of rays that have ended
/// @return the rays that continue in other blocks
std::vector<RayOnItsWay> PictureInBlocks::Follow(
  const RayPass& pass, std::vector<RayOnItsWay> rays, bool sharp, Picture& picture, const Monitor& monitor)
{
  const VoxelBox& own = this->Over.Own();
  std::vector<RayOnItsWay> gone;
  while (!rays.empty())
  {
    InOrder(picture.width, rays);
    std::vector<RayOnItsWay> born = this->Own->Rays.March(pass, rays, monitor);
    rays.insert(rays.end(), born.begin(), born.end());
    std::vector<RayOnItsWay> here;
    for (RayOnItsWay& ray : rays)
    {
      // A ray on the upper face of the domain has an index beyond the last voxel: it is assigned to the last voxel.
      for (int axis = 0; axis < 3; ++axis)
      {
        ray.where[axis] = std::clamp(ray.where[axis], 0, this->Over.Whole().size[axis] - 1);
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

/// Renders the picture in groups of pixel rows, so that only the rays of one group travel between ranks at a time.
/// Collective.
/// @param sharp  whether this is the pass for unscattered light of a picture made of angular moments
void PictureInBlocks::CastInRounds(const Camera& camera, bool sharp, Picture& picture, const Monitor& monitor)
{
  RayPass pass = {};
  auto rays = static_cast<double>(this->AtOnce.rays);
  this->Over.Collective([&] {
    if (this->Own)
    {
      this->Own->Pack(sharp ? Packing::Unscattered : Packing::Scattered);
      pass = this->Own->Rays.PassOf(camera, &this->Own->Part->block, sharp);
      picture.farDepth = pass.view.marching.s[2];
      rays = std::min(rays, static_cast<double>(this->Own->Rays.CountThatFits()));
    }
  });
  const double fit = -this->Over.Max(-rays);
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
          pass, round == 0 ? this->Own->Rays.Start(pass, some) : std::move(arrived), sharp, picture, ofRound);
      },
      OfPart(monitor, 1.0 * some.begin / picture.height, 1.0 * some.end / picture.height));
  }
}

/// Renders this rank's contribution to the picture. For straight rays the contribution consists of the pixels that show
/// the rank's block of voxels, otherwise of the pixels of rays that end on this rank. Collective.
/// @param size  width and height of the picture, pixels
Picture PictureInBlocks::CastOwn(const Camera& camera, const std::array<int, 2>& size, const Monitor& monitor)
{
  const double seen = this->Lights.empty() ? 0.0 : 0.5;
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
  this->Over.Collective([&] {
    if (this->Own)
    {
      picture = this->Own->RenderBehind(camera, this->Own->Part->block, {}, OfPart(monitor, seen, 1.0));
    }
  });
  return picture;
}

/// Renders those pixels of this rank's block again that depend on the transmittance of the blocks in front
/// (StartsBehind), which was unknown in the first pass. Collective.
/// @param own  pixels of the block from the first pass; corrected
void PictureInBlocks::LookAgain(
  const Camera& camera, const std::array<int, 2>& size, BlockPixels& own, const Monitor& monitor)
{
  const auto seen = ExchangePixels(this->Over, own, own.rect, false, camera);
  this->Over.Collective([&] {
    const Starts starts =
      this->Own ? StartsBehind(seen->frontToBack, seen->own, size, this->Own->Settings.minimumTransmittance) : Starts();
    if (!starts.IsEmpty())
    {
      TakeFrom(this->Own->RenderBehind(camera, this->Own->Part->block, starts, monitor), starts, own);
    }
  });
}

Picture PictureInBlocks::Take(
  const Camera& camera, const std::array<int, 2>& size, const PixelRect& part, const Monitor& monitor)
{
  if (this->Over.IsSerial())
  {
    return PartOf(this->Own->Render(camera, monitor), part);
  }
  const Picture picture = this->CastOwn(camera, size, monitor);
  BlockPixels own;
  this->Over.Collective([&] { own = SeenPart(picture); });
  if (!this->InRounds)
  {
    this->LookAgain(camera, size, own, monitor);
  }
  const auto farDepth = static_cast<float>(this->Over.Max(picture.farDepth));
  return PictureOfAll(ExchangePixels(this->Over, own, part, false, camera)->frontToBack, part, farDepth);
}
}
