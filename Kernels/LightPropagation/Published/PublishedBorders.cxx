#include "LightPropagation/Published/PublishedBorders.h"

namespace tyndall
{
PublishedBorders::PublishedBorders(
  const PublishedModel& model, const PropagationSettings& settings, const PublishedPlan& plan)
  : Model(model)
  , Settings(settings)
  , Plan(plan)
{
}

std::vector<float> PublishedBorders::Radiance(const PublishedPlan::Batch& batch) const
{
  std::vector<float> radiance(this->Plan.sizes.boundary, 0.0f);
  std::size_t at = 0;
  for (int i = 0; i < batch.count; ++i)
  {
    for (int axis : { batch.maps[i].axis, batch.maps[i].axisU, batch.maps[i].axisV })
    {
      for (int c = 0; c < this->Model.Channels(); ++c)
      {
        radiance[at++] = static_cast<float>(this->Model.Boundary(batch.first + i, axis)[c]);
      }
    }
  }
  return radiance;
}

void PublishedBorders::TallyEntered(const PublishedPlan::Batch& batch, SweepTally& tally) const
{
  for (int i = 0; i < batch.count; ++i)
  {
    const MapGeometry& map = batch.maps[i];
    const auto enter = [&](int axis, double rays) {
      const Rgb& boundary = this->Model.Boundary(batch.first + i, axis);
      for (int c = 0; c < this->Model.Channels(); ++c)
      {
        tally.in[map.EntryFace(axis)][c] += rays * map.beamPower * boundary[c];
      }
    };
    enter(map.axis, static_cast<double>(map.sizeU) * map.sizeV * this->Plan.SubMaps());
    for (int subMap = 0; subMap < this->Plan.SubMaps(); ++subMap)
    {
      GridWalk walk = this->Plan.Walk(map, subMap, 0);
      while (walk.Next())
      {
        const bool entersU = walk.moveU != 0 && !this->Settings.periodic[map.axisU];
        const bool entersV = walk.moveV != 0 && !this->Settings.periodic[map.axisV];
        const double edge = entersU && entersV ? 0.5 : 0.0; // one ray enters half through either side
        enter(map.axisU, entersU ? map.sizeV - edge : 0.0);
        enter(map.axisV, entersV ? map.sizeU - edge : 0.0);
      }
    }
  }
}

void PublishedBorders::TallyEscaped(
  const PublishedPlan::Batch& batch, const std::vector<float>& escaped, SweepTally& tally) const
{
  const int rows = batch.Map().sizeV;
  std::size_t at = 0;
  for (const MapGeometry& map : batch.maps)
  {
    const auto take = [&](int count) {
      double sum = 0.0;
      for (int k = 0; k < count; ++k)
      {
        sum += escaped[at++];
      }
      return map.beamPower * sum;
    };
    for (int c = 0; c < this->Model.Channels(); ++c)
    {
      tally.out[map.ExitFace(map.axisU)][c] += take(rows);
      tally.out[map.ExitFace(map.axisV)][c] += take(1);
      const double ahead = take(rows);
      if (this->Plan.Ends(batch))
      {
        (this->Settings.periodic[map.axis] ? tally.onTheWay[c] : tally.out[map.ExitFace(map.axis)][c]) += ahead;
      }
    }
  }
}

void PublishedBorders::TallyLeft(
  const PublishedPlan::Batch& batch, const std::vector<float>& left, PublishedFaces& faces) const
{
  std::size_t at = 0;
  for (const MapGeometry& map : batch.maps)
  {
    const auto take = [&](int exitAxis, int channel, int axisSlow, int slow, int axisFast, int fast) {
      const int face = map.ExitFace(exitAxis);
      const bool leaves = !this->Settings.periodic[exitAxis] && (exitAxis != map.axis || this->Plan.Ends(batch));
      std::array<int, 3> voxel = {};
      for (int j = 0; j < slow; ++j)
      {
        for (int i = 0; i < fast; ++i, ++at)
        {
          voxel[axisSlow] = j + (axisSlow == map.axis ? this->Plan.FirstPlane() : 0);
          voxel[axisFast] = i;
          if (left[at] != 0.0f && leaves)
          {
            faces.Leave(faces.Cell(face, voxel), channel, map.beamPower * left[at]);
          }
        }
      }
    };
    for (int c = 0; c < this->Model.Channels(); ++c)
    {
      take(map.axisU, c, map.axis, this->Plan.Planes(batch), map.axisV, map.sizeV);
      take(map.axisV, c, map.axis, this->Plan.Planes(batch), map.axisU, map.sizeU);
      take(map.axis, c, map.axisV, map.sizeV, map.axisU, map.sizeU);
    }
  }
}
}
