#include "PictureOfBlocks.h"

#include "Ranks/Ranks.h"
#include "Viewing/ToneMapping.h"
#include "Work/GuardedWork.h"

#include "vtkCommunicator.h"
#include "vtkMultiProcessController.h"

#include <algorithm>

namespace tyndall
{
bool CanCast(vtkMultiProcessController* ranks, const BlocksOfRanks& blocks, const BlockToCast& own)
{
  constexpr std::size_t flags = 2; // able, has a block
  std::vector<double> words = { own.able ? 1.0 : 0.0, blocks.HasOwn() ? 1.0 : 0.0 };
  words.insert(words.end(), own.ofFilter.begin(), own.ofFilter.end());
  words.push_back(own.ofArrays);
  words.insert(words.end(), own.ofBlocks.begin(), own.ofBlocks.end());
  const auto count = static_cast<std::ptrdiff_t>(words.size());
  const auto ofBlock = static_cast<std::ptrdiff_t>(flags + own.ofFilter.size());
  const std::vector<double> said = SaidByAll(ranks, words);
  const double* first = nullptr; // of those that have a block
  bool can = blocks.MakeUpTheWhole() && blocks.HaveLayers();
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

PictureOfBlocks::PictureOfBlocks(vtkMultiProcessController* ranks, vtkAlgorithm* filter, const BlocksOfRanks& blocks,
  const Camera& camera, const std::array<int, 2>& size, const PixelRect& part, const PixelRect& counted)
  : Ranks(ranks)
  , Filter(filter)
  , Blocks(blocks)
  , TheCamera(camera)
  , Size(size)
  , Part(part)
  , Counted(counted)
{
}

BlockPixels PictureOfBlocks::CastOwn(MediumRayCaster* caster, double& farDepth) const
{
  BlockPixels own;
  WorkOnAllRanks(this->Ranks, this->Filter, [&] {
    if (caster)
    {
      const Picture picture = caster->Render(this->TheCamera, MonitorOf(this->Filter), {}, &this->Blocks.Own());
      farDepth = picture.farDepth;
      own = SeenPart(picture);
    }
  });
  return own;
}

/// What other blocks before this one change of it, which nobody knew when it was cast.
void PictureOfBlocks::LookAgain(MediumRayCaster* caster, BlockPixels& own) const
{
  const auto seen = this->Blocks.Exchange(own, own.rect, false, this->TheCamera);
  WorkOnAllRanks(this->Ranks, this->Filter, [&] {
    const std::vector<float> starts = caster
      ? StartsBehind(seen->frontToBack, seen->own, this->Size, caster->MinimumTransmittance())
      : std::vector<float>();
    if (!starts.empty())
    {
      TakeFrom(caster->RenderBehind(this->TheCamera, this->Blocks.Own(), starts, MonitorOf(this->Filter)), starts, own);
    }
  });
}

Picture PictureOfBlocks::Take(MediumRayCaster* caster) const
{
  double farDepth = 0.0;
  BlockPixels own = this->CastOwn(caster, farDepth);
  this->LookAgain(caster, own);
  const std::vector<double> depths = SaidByAll(this->Ranks, { farDepth });
  const auto seen = this->Blocks.Exchange(own, this->Part, false, this->TheCamera);
  return PictureOfAll(
    seen->frontToBack, this->Part, static_cast<float>(*std::max_element(depths.begin(), depths.end())));
}

double PictureOfBlocks::Exposure(const Picture& part) const
{
  std::vector<float> radiance;
  for (int row = this->Counted.begin[1]; row < this->Counted.end[1]; ++row)
  {
    const auto first = part.radiance.begin() +
      3 *
        (static_cast<std::ptrdiff_t>(row - this->Part.begin[1]) * part.width + this->Counted.begin[0] -
          this->Part.begin[0]);
    radiance.insert(radiance.end(), first, first + 3 * (this->Counted.end[0] - this->Counted.begin[0]));
  }
  const std::vector<int> own = LuminanceCounts(radiance);
  std::vector<int> all(own.size());
  this->Ranks->AllReduce(own.data(), all.data(), static_cast<vtkIdType>(own.size()), vtkCommunicator::SUM_OP);
  return ExposureOfCounts(all);
}
}
