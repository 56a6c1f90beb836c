#include "LightPropagation/Accuracy/SceneOnFirst.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/SharedFigures.h"
#include "Distribution/SharedMedium.h"

#include <algorithm>

namespace tyndall
{
SceneOnFirst::SceneOnFirst(const CoarseBlocks& blocks, const PreviewScene& own, const Medium& fine)
  : Blocks(blocks)
  , Here(IsFirstThatHas(blocks.Comm(), blocks.Fine()))
  , TheMedium(fine)
  , Light(own.illumination)
  , Index(own.index)
{
  const std::vector<VoxelBox>& owned = blocks.Fine().blocks;
  const auto first = std::find_if(owned.begin(), owned.end(), [](const VoxelBox& box) { return box.VoxelCount() > 0; });
  this->Boxes.resize(owned.size());
  this->Boxes[first - owned.begin()] = { {}, blocks.Coarse().whole.size };

  this->TheMedium.grid = blocks.Coarse().whole;
  Field g = own.medium.phase.Varies() ? own.medium.phase.G() : Field();
  const std::array<std::pair<Field, Field*>, 7> fields = { { { own.medium.sigma_a, &this->TheMedium.sigma_a },
    { own.medium.sigma_s, &this->TheMedium.sigma_s }, { own.medium.emission, &this->TheMedium.emission }, { g, &g },
    { own.illumination.uncollided.fluence, &this->Light.uncollided.fluence },
    { own.illumination.uncollided.meanDirection, &this->Light.uncollided.meanDirection },
    { own.index, &this->Index } } };
  std::vector<double> components;
  for (const auto& [from, to] : fields)
  {
    components.push_back(blocks.HasOwn() && from.values ? from.components : 0.0);
  }
  components = blocks.Comm().Largest(components);
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    *fields[i].second = this->Gathered(fields[i].first, static_cast<int>(components[i]), this->Arrays[i]);
  }
  if (this->Here && g.values)
  {
    this->TheMedium.phase = fine.phase.WithG(g);
  }
}

/// Gathers a field of coarse voxels from all ranks on the first rank.
Field SceneOnFirst::Gathered(const Field& own, int components, std::vector<float>& values) const
{
  if (components == 0)
  {
    return {};
  }
  std::vector<float> ofBlock;
  if (this->Blocks.HasOwn())
  {
    const std::size_t voxels = this->Blocks.Own().Coarse().VoxelCount();
    ofBlock.assign(own.values, own.values + voxels * static_cast<std::size_t>(components));
  }
  values = ValuesInBox(this->Blocks.Comm(), this->Blocks.Coarse(), this->Boxes, ofBlock, components);
  return { this->Here ? values.data() : nullptr, components };
}

void SceneOnFirst::Spread(LightField& light) const
{
  Communicator& others = this->Blocks.Comm();
  ShareFigures(others, this->Here, light);
  const BlockPartition onFirst = { this->Blocks.Coarse().whole, this->Boxes };
  for (std::vector<float>* const values : { &light.fluence, &light.fluenceDirect })
  {
    if (OnAnyRank(others, !values->empty()))
    {
      *values = ValuesInBox(others, onFirst, this->Blocks.Coarse().blocks, *values, light.channels);
    }
  }
}
}
