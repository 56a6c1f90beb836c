#include "LightPropagation/Distributed/Published/SlabRaysInTurn.h"

namespace tyndall
{
SlabRaysInTurn::SlabRaysInTurn(const Grid& whole, const PublishedModel& model, const PropagationSettings& settings)
  : Whole(whole)
  , Model(model)
  , Settings(settings)
{
}

void SlabRaysInTurn::TakePlanes(const PublishedSlab& slab, const Medium& medium)
{
  this->Across[slab.axis].emplace(this->Whole, slab, medium, this->Model, this->Settings);
}

int SlabRaysInTurn::DirectionOf(int axis, std::size_t batch) const
{
  return 2 * axis * this->Model.Directions().PerFace() + static_cast<int>(batch);
}

std::size_t SlabRaysInTurn::Batches(int axis) const
{
  return this->Across[axis] ? 2 * static_cast<std::size_t>(this->Model.Directions().PerFace()) : 0;
}

bool SlabRaysInTurn::IsForward(int axis, std::size_t batch) const
{
  return this->Across[axis]->MapOf(this->DirectionOf(axis, batch)).forward;
}

std::size_t SlabRaysInTurn::FloatsOfMap(int axis, std::size_t batch) const
{
  return this->Across[axis]->FloatsOfMap(this->DirectionOf(axis, batch));
}

void SlabRaysInTurn::BeginOrder()
{
  for (std::optional<SequentialRays>& rays : this->Across)
  {
    if (rays)
    {
      rays->DarkenMoments();
    }
  }
}

std::vector<float> SlabRaysInTurn::Send(const Way& way, std::size_t, const std::vector<float>& given,
  PublishedFaces& faces, SweepTally& tally, const Monitor& monitor)
{
  return this->Across[way.axis]->Send(this->DirectionOf(way.axis, way.batch), way.order, given, faces, tally, monitor);
}

std::vector<float> SlabRaysInTurn::Moment(int axis, int moment) const
{
  const std::vector<double>& values = this->Across[axis]->Moment(moment);
  return { values.begin(), values.end() };
}

void SlabRaysInTurn::WriteSource(int axis, int sourceDirection, const std::vector<float>& source)
{
  this->Across[axis]->Source(sourceDirection) = source;
}
}
