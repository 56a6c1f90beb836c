#include "PictureOfBlocks.h"

#include "Distribution/Communicator.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Viewing/ToneMapping.h"

#include <algorithm>
#include <iterator>

namespace tyndall
{
namespace
{
std::string JoinedLines(const std::vector<std::string>& lines)
{
  std::string joined;
  for (const std::string& line : lines)
  {
    joined += line + '\n';
  }
  return joined;
}

/// Splits a text into its lines.
template <class Text>
std::vector<std::string> LinesOf(const Text& text)
{
  std::vector<std::string> lines;
  for (auto from = text.begin(); from != text.end();)
  {
    const auto end = std::find(from, text.end(), '\n');
    lines.emplace_back(from, end);
    from = std::next(end);
  }
  return lines;
}
}

bool CanCast(Communicator& communicator, const BlocksOfRanks& blocks, const BlockToCast& own)
{
  constexpr std::size_t flags = 2; // whether it is able, whether it has a block
  std::vector<double> words = { own.able ? 1.0 : 0.0, blocks.HasOwn() ? 1.0 : 0.0 };
  words.insert(words.end(), own.ofFilter.begin(), own.ofFilter.end());
  words.push_back(own.ofArrays);
  words.insert(words.end(), own.ofBlocks.begin(), own.ofBlocks.end());
  const auto count = static_cast<std::ptrdiff_t>(words.size());
  const auto ofBlock = static_cast<std::ptrdiff_t>(flags + own.ofFilter.size());
  const std::vector<double> said = SaidByAll(communicator, words);
  const double* first = nullptr; // first rank with a block
  bool can = blocks.MakeUpTheWhole();
  for (const double* rank = said.data(); rank < said.data() + said.size(); rank += count)
  {
    can = can && rank[0] > 0.0 && std::equal(rank + flags, rank + ofBlock, said.data() + flags);
    if (rank[1] > 0.0)
    {
      first = first ? first : rank;
      can = can && std::equal(rank + ofBlock, rank + count, first + ofBlock);
    }
  }
  return can;
}

PictureOfBlocks::PictureOfBlocks(const SeeingRanks& seen, const Camera& camera, const std::array<int, 2>& size,
  const PixelRect& part, const PixelRect& counted)
  : Seen(seen)
  , TheCamera(camera)
  , Size(size)
  , Part(part)
  , Counted(counted)
{
}

BlockPixels PictureOfBlocks::CastOwn(double& farDepth) const
{
  const Picture picture = this->Seen.ofBlock.Take(this->TheCamera, this->Size, MonitorOf(this->Seen.filter));
  farDepth = picture.farDepth;
  BlockPixels own;
  this->Seen.communicator.Collective([&] { own = SeenPart(picture); });
  return own;
}

/// Casts again those rays whose start depends on the blocks in front of this one, which was not known in the first
/// pass.
void PictureOfBlocks::LookAgain(BlockPixels& own) const
{
  MediumRayCaster* const caster = this->Seen.caster;
  const auto seen = this->Seen.blocks.Exchange(own, own.rect, false, this->TheCamera);
  this->Seen.communicator.Collective([&] {
    const Starts starts =
      caster ? StartsBehind(seen->frontToBack, seen->own, this->Size, caster->MinimumTransmittance()) : Starts();
    if (!starts.IsEmpty())
    {
      const GridBlock& block = caster->Block().block;
      TakeFrom(caster->RenderBehind(this->TheCamera, block, starts, MonitorOf(this->Seen.filter)), starts, own);
    }
  });
}

Picture PictureOfBlocks::Take() const
{
  double farDepth = 0.0;
  BlockPixels own = this->CastOwn(farDepth);
  if (!this->Seen.ofBlock.GoesInRounds())
  {
    this->LookAgain(own);
  }
  farDepth = this->Seen.communicator.Largest({ farDepth })[0];
  const auto seen = this->Seen.blocks.Exchange(own, this->Part, false, this->TheCamera);
  return PictureOfAll(seen->frontToBack, this->Part, static_cast<float>(farDepth));
}

double PictureOfBlocks::Exposure(const Picture& part, bool background) const
{
  std::vector<float> radiance, alpha;
  const int columns = this->Counted.end[0] - this->Counted.begin[0];
  for (int row = this->Counted.begin[1]; row < this->Counted.end[1]; ++row)
  {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row - this->Part.begin[1]) * part.width +
      this->Counted.begin[0] - this->Part.begin[0];
    const auto lit = part.radiance.begin() + 3 * first;
    radiance.insert(radiance.end(), lit, lit + 3 * columns);
    if (!background)
    {
      alpha.insert(alpha.end(), part.alpha.begin() + first, part.alpha.begin() + first + columns);
    }
  }
  const std::vector<int> own = LuminanceCounts(radiance, alpha);
  const std::vector<double> all = this->Seen.communicator.Sum({ own.begin(), own.end() });
  return ExposureOfCounts({ all.begin(), all.end() });
}

PixelRect RectOf(const std::array<int, 6>& extent)
{
  return { { extent[0], extent[2] }, { extent[1] + 1, extent[3] + 1 } };
}

PixelRect OwnPixels(const Communicator& communicator, const std::array<int, 6>& all)
{
  std::array<int, 6> own = PartOfExtent(all, communicator.Rank(), communicator.Ranks());
  for (int last : { 1, 3 }) // pieces share their border pixels
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
  const std::string said = JoinedLines(own);
  communicator.Send<char>(0, MessageTag::ListsOfWords, { said.begin(), said.end() });
  communicator.Send<char>(0, MessageTag::ListsOfWords, { says ? '1' : '0' });
  std::vector<std::string> common;
  bool any = false;
  for (int rank = 0; communicator.Rank() == 0 && rank < communicator.Ranks(); ++rank)
  {
    const std::vector<std::string> list = LinesOf(communicator.Receive<char>(rank, MessageTag::ListsOfWords));
    if (communicator.Receive<char>(rank, MessageTag::ListsOfWords)[0] == '0')
    {
      continue;
    }
    common.erase(std::remove_if(common.begin(), common.end(),
                   [&](const std::string& line) { return std::find(list.begin(), list.end(), line) == list.end(); }),
      common.end());
    common = any ? common : list;
    any = true;
  }
  return LinesOf(WordsOfAny(communicator, JoinedLines(common)));
}
}
