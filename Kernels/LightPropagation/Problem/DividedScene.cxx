#include "LightPropagation/Problem/DividedScene.h"

#include "Medium/BoxFaces.h"
#include "Medium/Coarsening.h"

namespace tyndall
{
namespace
{
std::array<int, 3> PartsOf(const Grid& whole, const std::array<bool, 3>& periodic)
{
  std::array<int, 3> parts = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    parts[axis] = whole.size[axis] == 1 && periodic[axis] ? 1 : 2;
  }
  return parts;
}

Grid Divide(Grid grid, const std::array<int, 3>& parts)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] *= parts[axis];
    grid.spacing[axis] /= parts[axis];
  }
  return grid;
}
}

DividedScene::DividedScene(const Medium& medium, const Illumination& illumination, const std::array<bool, 3>& periodic)
  : DividedScene(medium, illumination, periodic, medium.grid)
{
}

DividedScene::DividedScene(
  const Medium& part, const Illumination& illumination, const std::array<bool, 3>& periodic, const Grid& whole)
  : Whole(whole)
  , Given(part.grid)
  , Along(PartsOf(whole, periodic))
  , Divided(part)
  , Light(illumination)
{
  this->Divided.grid = Divide(part.grid, this->Along);
  for (Field* field : { &this->Divided.sigma_a, &this->Divided.sigma_s, &this->Divided.emission,
         &this->Light.uncollided.fluence, &this->Light.uncollided.meanDirection })
  {
    *field = this->Repeated(*field);
  }
  if (part.phase.Varies())
  {
    this->Divided.phase = part.phase.WithG(this->Repeated(part.phase.G()));
  }
}

BlockPartition DividedScene::BlocksOf(const BlockPartition& given) const
{
  BlockPartition divided = { Divide(given.whole, this->Along), given.blocks };
  for (VoxelBox& block : divided.blocks)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.first[axis] *= this->Along[axis];
      block.size[axis] *= this->Along[axis];
    }
  }
  return divided;
}

double DividedScene::Parts() const
{
  return this->Along[0] * this->Along[1] * this->Along[2];
}

Field DividedScene::Repeated(const Field& field)
{
  if (!field.values)
  {
    return field;
  }
  const Grid& fine = this->Divided.grid;
  const std::array<int, 3>& parts = this->Along;
  std::vector<float> values;
  values.reserve(fine.VoxelCount() * field.components);
  for (int z = 0; z < fine.size[2]; ++z)
  {
    for (int y = 0; y < fine.size[1]; ++y)
    {
      for (int x = 0; x < fine.size[0]; ++x)
      {
        const float* const from =
          field.values + this->Given.IndexOf({ x / parts[0], y / parts[1], z / parts[2] }) * field.components;
        values.insert(values.end(), from, from + field.components);
      }
    }
  }
  this->Arrays.push_back(std::move(values));
  Field repeated = field;
  repeated.values = this->Arrays.back().data();
  return repeated;
}

void DividedScene::UndoCells(std::vector<float>& values) const
{
  const Grid fine = Divide(this->Whole, this->Along);
  const std::size_t components = values.size() / BoxFaceCellCount(fine);
  if (components == 0)
  {
    return;
  }
  std::vector<float> sums(BoxFaceCellCount(this->Whole) * components, 0.0f);
  ForBoxFaceCells(fine, [&](const BoxFaceCell& cell) {
    const PlaneAxes axes = AcrossAxis(cell.face / 2);
    const BoxFaceLayout layout = LayoutOfFace(this->Whole, cell.face);
    const int partsU = this->Along[axes.u], partsV = this->Along[axes.v];
    const std::size_t parent =
      layout.first + cell.u / partsU * layout.step[axes.u] + cell.v / partsV * layout.step[axes.v];
    const float part = 1.0f / static_cast<float>(partsU * partsV);
    for (std::size_t k = 0; k < components; ++k)
    {
      sums[parent * components + k] += part * values[cell.number * components + k];
    }
  });
  values = std::move(sums);
}

void DividedScene::Undo(LightField& light) const
{
  const Coarsening back(this->Divided.grid, this->Given);
  const std::size_t voxels = this->Divided.grid.VoxelCount();
  for (std::vector<float>* values : { &light.fluence, &light.fluenceDirect, &light.netFlux, &light.scatteredRadiance,
         &light.scatteredMoments, &light.straightOn })
  {
    if (!values->empty())
    {
      *values = back.Average(values->data(), static_cast<int>(values->size() / voxels));
    }
  }
  this->UndoCells(light.surfaceRadiance);
  this->UndoCells(light.facePower);
}
}
