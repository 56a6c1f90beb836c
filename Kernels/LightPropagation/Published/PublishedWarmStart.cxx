#include "LightPropagation/Published/PublishedWarmStart.h"

namespace tyndall
{
PublishedWarmStart::PublishedWarmStart(
  const Medium& medium, const PublishedModel& model, const PropagationSettings& settings, const KeptLight* kept)
  : TheMedium(medium)
  , Channels(model.Channels())
  , Counted(settings.maximumOrders > 0)
  , Kept(kept)
  , Kind{ "light propagation maps as published", medium.grid.size, medium.grid.spacing, model.Channels(),
    model.MomentCount(), static_cast<int>(model.Directions().directions.size()), settings.periodic }
{
  if (kept)
  {
    this->WhyNot = WhyNotBegun(*kept, this->Kind, settings.maximumOrders);
  }
}

/// Some of the kept light, scaled as the first scattered light has changed.
/// @param perChannel  of how many values in turn channels are made
std::vector<float> PublishedWarmStart::GuessOf(std::size_t first, std::size_t count, std::size_t perChannel) const
{
  const auto begin = this->Kept->scattered.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<float> guess(begin, begin + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t c = i / perChannel % this->Channels;
    const double before = this->Kept->firstScattered[c];
    guess[i] = before > 0.0 ? static_cast<float>(guess[i] * this->First[c] / before) : 0.0f;
  }
  return guess;
}

void PublishedWarmStart::AddTo(PublishedVolumes& volumes, PublishedFaces& faces, const std::vector<float>& direct)
{
  this->Direct = volumes.OrderMoments[0].Read();
  for (std::size_t i = 0; i < direct.size(); ++i)
  {
    const int c = static_cast<int>(i % this->Channels);
    this->First[c] += static_cast<double>(this->TheMedium.sigma_s.At(i / this->Channels, c)) * direct[i];
  }
  if (!this->Begins())
  {
    return;
  }
  const std::size_t moments = volumes.Totals.Size();
  this->Guess = this->GuessOf(0, moments, volumes.Layouts.volume[0]);
  if (faces.Count() && this->Kept->scattered.size() > moments) // the last light had such faces, too
  {
    faces.BeginWarm(this->GuessOf(moments, faces.Cells() * this->Channels, faces.Cells()));
  }
  this->Add(volumes.OrderMoments[0], 1.0f);
  volumes.OrderMoments[1].Fill(0.0f); // it is in the other already
  volumes.Totals.Fill(0.0f);
}

void PublishedWarmStart::TakeFrom(PublishedVolumes& volumes)
{
  this->Add(volumes.OrderMoments[0], -1.0f);
  this->Guess = {};
}

void PublishedWarmStart::Add(Buffer<float>& moments, float sign) const
{
  std::vector<float> values = moments.Read();
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] += sign * this->Guess[i];
  }
  moments.Write(values.data());
}

KeptLight PublishedWarmStart::Leave(const PublishedVolumes& volumes, const PublishedFaces& faces, const Rgb& rate) const
{
  KeptLight left;
  left.kind = this->Kind;
  left.rate = this->Counted ? Rgb{} : rate;
  left.firstScattered = this->First;
  left.scattered = volumes.Totals.Read();
  for (std::size_t i = 0; i < left.scattered.size(); ++i)
  {
    left.scattered[i] -= this->Direct[i];
  }
  const std::vector<float> throughCells = faces.LeftLater();
  left.scattered.insert(left.scattered.end(), throughCells.begin(), throughCells.end());
  left.fromDarkness = this->Begins() ? this->Kept->fromDarkness : std::vector<ConvergenceRow>();
  return left;
}
}
