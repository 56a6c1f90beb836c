#include "BlocksOfRanks.h"

#include "CasterProperties.h"
#include "Common/LightTransportData.h"
#include "Pieces/UpdateExtent.h"
#include "Viewing/ToneMapping.h"

#include "vtkImageData.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Axes of the image of the first rank that has voxels. Collective.
OwnAxes AxesOfFirst(Communicator& communicator, vtkImageData* image)
{
  std::vector<double> words = OwnAxesOf(image).Words();
  words.push_back(image && image->GetNumberOfPoints() > 0 ? 1.0 : 0.0);
  const std::vector<double> said = SaidByAll(communicator, words);
  for (auto rank = said.begin(); rank != said.end(); rank += static_cast<std::ptrdiff_t>(words.size()))
  {
    const auto last = rank + static_cast<std::ptrdiff_t>(words.size() - 1);
    if (*last > 0.0)
    {
      return OwnAxes::From({ rank, last + 1 });
    }
  }
  return {};
}
}

BlocksOfRanks::BlocksOfRanks(vtkImageData* whole)
  : Pieces(whole)
  , AxesOfAll(OwnAxesOf(whole))
{
  GridOf(whole); // throws InvalidInput if the image has no valid grid
}

BlocksOfRanks::BlocksOfRanks(Communicator& communicator, vtkImageData* image)
  : Pieces(communicator, nullptr, image)
  , AxesOfAll(AxesOfFirst(communicator, image))
{
  if (!this->Over().Partition().blocks.empty()) // the list of blocks is empty if no rank has cells
  {
    const auto rank = static_cast<std::size_t>(communicator.Rank());
    this->OwnBlock = BlockOfRank(this->Over().Partition(), communicator.Rank(), this->Given()[rank]);
  }
}

bool BlocksOfRanks::AreGiven(const std::vector<VoxelBox>& held) const
{
  return std::equal(held.begin(), held.end(), this->Given().begin(), [](const VoxelBox& a, const VoxelBox& b) {
    return (a.VoxelCount() == 0 && b.VoxelCount() == 0) || (a.first == b.first && a.size == b.size);
  });
}

std::vector<VoxelBox> BlocksOfRanks::HeldFor(const ViewSettings& settings, bool moments, bool surface) const
{
  std::vector<VoxelBox> needed;
  bool enough = true;
  for (std::size_t rank = 0; rank < this->Given().size(); ++rank)
  {
    const VoxelBox& own = this->Over().Partition().blocks[rank];
    needed.push_back(
      own.VoxelCount() > 0 ? HeldBox(own, this->Over().Whole(), settings, moments, surface) : VoxelBox());
    enough = enough && Common(needed[rank], this->Given()[rank]).VoxelCount() == needed[rank].VoxelCount();
  }
  return enough ? this->Given() : needed;
}

std::optional<SeenBlocks> BlocksOfRanks::Exchange(
  const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera) const
{
  return ExchangePixels(this->Over(), own, wanted, failed, InOwnAxes(camera, this->AxesOfAll));
}

bool FitTogether(const BlocksOfRanks& blocks, bool able, std::vector<double> properties, double arrays)
{
  properties.insert(properties.end(), { able ? 1.0 : 0.0, blocks.HasOwn() ? 1.0 : 0.0, arrays });
  const std::vector<double> said = SaidByAll(blocks.Over().Comm(), properties);
  const auto count = static_cast<std::ptrdiff_t>(properties.size());
  std::optional<double> first; // hash of the arrays of the first rank with a block
  bool fit = blocks.MakeUpTheWhole();
  for (auto rank = said.begin(); rank != said.end(); rank += count)
  {
    const double* const state = &*rank + count - 3;
    fit = fit && state[0] > 0.0 && std::equal(rank, rank + count - 3, said.begin());
    if (state[1] > 0.0)
    {
      first = first.value_or(state[2]);
      fit = fit && state[2] == *first;
    }
  }
  return fit;
}

double ExposureOfParts(const Domain& domain, const Picture& part, const PixelRect& counted, bool background)
{
  Picture own = part; // copy, cropped below to the pixels that this rank counts
  own = PartOf(std::move(own), counted);
  const std::vector<int> here = LuminanceCounts(own.radiance, background ? std::vector<float>() : own.alpha);
  const std::vector<double> all = domain.Sum(std::vector<double>(here.begin(), here.end()));
  return ExposureOfCounts({ all.begin(), all.end() });
}

PixelRect RectOf(const std::array<int, 6>& extent)
{
  return { { extent[0], extent[2] }, { extent[1] + 1, extent[3] + 1 } };
}

PixelRect OwnPixels(const Communicator& communicator, const std::array<int, 6>& all)
{
  std::array<int, 6> own = PartOfExtent(all, communicator.Rank(), communicator.Ranks());
  for (int last : { 1, 3 }) // extents of neighbouring ranks share border pixels, so the last column or row is dropped
  {
    own[last] -= own[last] < all[last] ? 1 : 0;
  }
  return RectOf(own);
}

PixelRect Around(const PixelRect& a, const PixelRect& b)
{
  if (a.IsEmpty() || b.IsEmpty())
  {
    return a.IsEmpty() ? b : a;
  }
  PixelRect around;
  for (int axis = 0; axis < 2; ++axis)
  {
    around.begin[axis] = std::min(a.begin[axis], b.begin[axis]);
    around.end[axis] = std::max(a.end[axis], b.end[axis]);
  }
  return around;
}

std::vector<std::string> OnAllLists(Communicator& communicator, const std::vector<std::string>& own, bool says)
{
  std::vector<int> ranks(static_cast<std::size_t>(communicator.Ranks()));
  std::iota(ranks.begin(), ranks.end(), 0);
  std::vector<char> said; // message of this rank: "+" if it has a list, then the lines, each ended by a line feed
  for (const std::string& line : own)
  {
    said.insert(said.end(), line.begin(), line.end());
    said.push_back('\n');
  }
  said.insert(said.begin(), says ? 1 : 0, '+');
  const auto arrived =
    communicator.Exchange<char>(ranks, [&] { return std::vector<std::vector<char>>(ranks.size(), said); });
  std::vector<std::string> common;
  bool any = false;
  for (const std::vector<char>& list : arrived)
  {
    std::vector<std::string> lines;
    for (auto from = list.begin() + (list.empty() ? 0 : 1); from != list.end();)
    {
      const auto end = std::find(from, list.end(), '\n');
      lines.emplace_back(from, end);
      from = std::next(end);
    }
    const auto isMissing = [&](const std::string& line) {
      return std::find(lines.begin(), lines.end(), line) == lines.end();
    };
    if (any && !list.empty())
    {
      common.erase(std::remove_if(common.begin(), common.end(), isMissing), common.end());
    }
    common = any ? common : lines;
    any = any || !list.empty();
  }
  return common;
}
}
