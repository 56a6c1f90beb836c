#include "LightPropagation/Published/PublishedLight.h"

namespace tyndall
{
namespace
{
using Moment = std::function<std::vector<float>(int)>;

std::vector<float> ScatteredRadiance(const PublishedModel& model, const Moment& moment)
{
  const std::size_t stored = model.StoredDirections().size();
  const std::size_t channels = static_cast<std::size_t>(model.Channels());
  std::vector<float> radiance;
  for (std::size_t d = 0; d < stored; ++d)
  {
    const PublishedModel::Part part = model.ScatteredRadiance(static_cast<int>(d));
    const std::vector<float> values = moment(part.moment);
    radiance.resize(values.size() * stored);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      radiance[(i / channels * stored + d) * channels + i % channels] = static_cast<float>(part.factor) * values[i];
    }
  }
  return radiance;
}

std::vector<float> NetFlux(const PublishedModel& model, const Moment& moment)
{
  std::vector<float> netFlux;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<float> flux = moment(model.NetFlux(axis));
    netFlux.resize(3 * flux.size());
    for (std::size_t i = 0; i < flux.size(); ++i)
    {
      netFlux[3 * i + axis] = flux[i];
    }
  }
  return netFlux;
}
}

void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t, std::size_t, int, double)>& add)
{
  const Field& mean = image.meanDirection;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
  {
    const std::vector<double> moments = model.MomentsAlong({ mean.At(voxel, 0), mean.At(voxel, 1), mean.At(voxel, 2) });
    for (std::size_t k = 0; k < moments.size(); ++k)
    {
      for (int c = 0; c < model.Channels(); ++c)
      {
        add(k, voxel, c, moments[k] * image.fluence.At(voxel, c));
      }
    }
  }
}

void TakeMoments(const PublishedModel& model, bool netFlux, const Moment& moment, LightField& field)
{
  field.channels = model.Channels();
  field.fluence = moment(0);
  field.storedDirections = model.StoredDirections();
  field.scatteredRadiance = ScatteredRadiance(model, moment);
  if (netFlux)
  {
    field.netFlux = NetFlux(model, moment);
  }
}
}
