#include "LightPropagation/Published/PublishedWarmStart.h"

#include "Distribution/KeptInBlocks.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace tyndall
{
PublishedWarmStart::PublishedWarmStart(const Scene& scene, const KeptLight* kept)
  : The(scene)
  , Kept(kept)
  , Kind{ "light propagation maps as published", scene.whole.size, scene.whole.spacing, scene.model.Channels(),
    scene.model.MomentCount(), static_cast<int>(scene.model.Directions().directions.size()), scene.settings.periodic,
    scene.block }
{
  if (kept)
  {
    this->WhyNot = WhyNotBegun(*kept, this->Kind, scene.settings.maximumOrders);
    this->WhyNot = scene.others ? WhyNotBegunOnAny(*scene.others, *kept, this->WhyNot) : this->WhyNot;
  }
}

/// What may fail on one rank (Communicator.h).
void PublishedWarmStart::Collective(const std::function<void()>& work) const
{
  this->The.others ? this->The.others->Collective(work) : work();
}

/// Some of the kept light, scaled as the first scattered light has changed.
/// @param perChannel  of how many values in turn channels are made
std::vector<float> PublishedWarmStart::GuessOf(std::size_t first, std::size_t count, std::size_t perChannel) const
{
  const auto begin = this->Kept->scattered.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<float> guess(begin, begin + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t c = i / perChannel % this->The.model.Channels();
    const double before = this->Kept->firstScattered[c];
    guess[i] = before > 0.0 ? static_cast<float>(guess[i] * this->First[c] / before) : 0.0f;
  }
  return guess;
}

void PublishedWarmStart::AddTo(std::vector<float>& moments, PublishedFaces& faces, const std::vector<float>& direct)
{
  this->Collective([&] { this->Direct = moments; });
  const std::size_t channels = static_cast<std::size_t>(this->The.model.Channels());
  for (std::size_t i = 0; i < direct.size(); ++i)
  {
    const std::size_t c = i % channels;
    this->First[c] += static_cast<double>(this->The.medium.sigma_s.At(i / channels, static_cast<int>(c))) * direct[i];
  }
  if (this->The.others)
  {
    const std::vector<double> all = this->The.others->Sum({ this->First[0], this->First[1], this->First[2] });
    std::copy(all.begin(), all.end(), this->First.begin());
  }
  if (!this->Begins())
  {
    return;
  }
  this->Collective([&] { this->AddGuessTo(moments, faces); });
}

void PublishedWarmStart::AddGuessTo(std::vector<float>& moments, PublishedFaces& faces)
{
  const std::size_t ofFaces = faces.Count() ? faces.Cells() * this->The.model.Channels() : 0;
  this->Guess = this->GuessOf(0, moments.size(), this->The.perChannel);
  if (ofFaces > 0 && this->Kept->scattered.size() >= moments.size() + ofFaces) // the last light had such faces, too
  {
    faces.BeginWarm(this->GuessOf(moments.size(), ofFaces, faces.Cells()));
  }
  std::transform(moments.begin(), moments.end(), this->Guess.begin(), moments.begin(), std::plus<>());
}

void PublishedWarmStart::TakeFrom(std::vector<float>& moments)
{
  std::transform(moments.begin(), moments.end(), this->Guess.begin(), moments.begin(), std::minus<>());
  this->Guess = {};
}

KeptLight PublishedWarmStart::Leave(std::vector<float> totals, const PublishedFaces& faces, const Rgb& rate) const
{
  KeptLight left;
  left.kind = this->Kind;
  left.rate = this->The.settings.maximumOrders > 0 ? Rgb{} : rate; // orders that are counted do not tell how they fall
  left.firstScattered = this->First;
  left.scattered = std::move(totals);
  std::transform(
    left.scattered.begin(), left.scattered.end(), this->Direct.begin(), left.scattered.begin(), std::minus<>());
  const std::vector<float> throughCells = faces.LeftLater();
  left.scattered.insert(left.scattered.end(), throughCells.begin(), throughCells.end());
  if (left.scattered.empty())
  {
    left.scattered = { 0.0f }; // of a block without voxels, which is not that there is none
  }
  left.fromDarkness = this->Begins() ? this->Kept->fromDarkness : std::vector<ConvergenceRow>();
  return left;
}
}
