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

void PublishedWarmStart::AddTo(PublishedVolumes& volumes, const std::vector<float>& direct)
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
  this->Guess = this->Kept->scattered;
  for (std::size_t i = 0; i < this->Guess.size(); ++i)
  {
    const std::size_t c = i / volumes.Layouts.volume[0] % this->Channels;
    const double before = this->Kept->firstScattered[c];
    this->Guess[i] = before > 0.0 ? static_cast<float>(this->Guess[i] * this->First[c] / before) : 0.0f;
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

KeptLight PublishedWarmStart::Leave(const PublishedVolumes& volumes, const Rgb& rate) const
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
  left.fromDarkness = this->Begins() ? this->Kept->fromDarkness : std::vector<ConvergenceRow>();
  return left;
}
}
