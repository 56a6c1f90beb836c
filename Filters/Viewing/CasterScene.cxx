#include "CasterScene.h"

#include "Distribution/SharedMedium.h"
#include "Viewing/Blocks/PictureInBlocks.h"
#include "vtkMediumRayCaster.h"

namespace tyndall
{
std::unique_ptr<CasterScene> MakeScene(const ViewedInputs& viewed, const Field& ior, const Illumination& illumination,
  const InputsKey& key, ViewSettings settings, const BlockOfScene* ofScene)
{
  auto scene = std::make_unique<CasterScene>();
  const bool sky = !illumination.environment.Empty() || illumination.sky != Rgb{};
  if (!viewed.fluence.IsThere() && illumination.lights.empty() && !viewed.medium.emission.IsThere() &&
    !(sky && viewed.ior.IsThere()))
  {
    scene->doubts.emplace_back("The medium is dark: it has no array fluence (a solver makes it, e.g. "
                               "LightPropagationMaps), there are no Lights, and it does not emit.");
  }
  scene->key = key;
  scene->grid = viewed.medium.medium.grid;
  scene->lightsAlone = !viewed.fluence.IsThere() && !illumination.lights.empty();
  settings.shadowRays |= scene->lightsAlone;
  scene->caster = std::make_unique<MediumRayCaster>(
    *key.device, viewed.medium.medium, viewed.Light(), illumination, settings, ior, ofScene);
  const std::vector<std::string>& warnings = scene->caster->Warnings();
  scene->doubts.insert(scene->doubts.end(), warnings.begin(), warnings.end());
  scene->made.Modified();
  return scene;
}

std::unique_ptr<CasterScene> MakeSceneOfBlock(
  const RankPieces& pieces, const InputsKey& key, std::vector<VoxelBox>& held)
{
  Communicator& communicator = pieces.communicator;
  const BlockPartition& partition = pieces.blocks.Partition();
  const auto rank = static_cast<std::size_t>(communicator.Rank());
  ViewedInputs viewed;
  SharedScene own;
  communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      viewed = ReadViewed(pieces.filter, pieces.image, partition.whole);
    }
  });
  AgreeOnMeanCosine(communicator, pieces.HasOwn(), viewed.medium.g, viewed.medium.medium);
  communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      own = SharedSceneOf(viewed.medium.medium, viewed.Light(), viewed.ior, pieces.settings);
    }
  });
  BlockOfScene ofScene;
  ofScene.shared = PictureInBlocks::Shared(communicator, pieces.HasOwn() ? &own : nullptr);
  const std::vector<double> shown =
    communicator.Largest({ viewed.moments.moments.IsThere() ? 1.0 : 0.0, viewed.surface.values.empty() ? 0.0 : 1.0 });
  held = pieces.blocks.HeldFor(pieces.settings, shown[0] > 0.0, shown[1] > 0.0);

  const VoxelBox& given = pieces.blocks.Given()[rank];
  std::vector<float> ior;
  if (ofScene.shared.index.Varies() || !pieces.settings.leaveOut)
  {
    std::vector<VoxelBox> known = held;
    for (std::size_t other = 0; other < known.size(); ++other)
    {
      const VoxelBox& block = partition.blocks[other];
      known[other] =
        block.VoxelCount() > 0 ? KnownBox(block, held[other], partition.whole, pieces.settings) : VoxelBox();
    }
    ior = SpreadTo(known, given, communicator, partition, viewed.ior);
    ofScene.known = known[rank];
  }
  if (!pieces.blocks.AreGiven(held))
  {
    viewed = SpreadTo(held, given, communicator, partition, pieces.image, viewed);
  }
  std::unique_ptr<CasterScene> scene;
  communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      ofScene.block = pieces.blocks.Own();
      ofScene.block.first = held[rank].first;
      KeepFacesOf(ofScene.block, held[rank].size, viewed);
      scene = MakeScene(
        viewed, { ior.empty() ? nullptr : ior.data(), 1 }, pieces.illumination, key, pieces.settings, &ofScene);
      scene->held = held;
    }
  });
  return scene;
}
}
