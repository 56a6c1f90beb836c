#include "Photons/Marching/MarchedBatches.h"

#include "Light/ChannelReduction.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace tyndall
{
namespace
{
constexpr Rgb White = { 1.0, 1.0, 1.0 };

void Add(Rgb& sum, const Rgb& more)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    sum[c] += more[c];
  }
}

void AddBalance(PhotonLight& sum, const PhotonLight& part)
{
  EnergyBalance& all = sum.light.balance;
  const EnergyBalance& more = part.light.balance;
  Add(all.entered, more.entered);
  Add(all.emitted, more.emitted);
  Add(all.absorbed, more.absorbed);
  Add(all.escaped, more.escaped);
  Add(all.leftOver, more.leftOver);
  Add(sum.scattered, part.scattered);
  Add(sum.exchanged, part.exchanged);
  for (std::size_t face = 0; face < 6; ++face)
  {
    Add(sum.light.facePowerOut[face], part.light.facePowerOut[face]);
  }
  sum.scatterings += part.scatterings;
  sum.missed += part.missed;
  sum.deposits += part.deposits;
  sum.steps += part.steps;
  sum.secondsMarching += part.secondsMarching;
  sum.seconds += part.seconds;
}

void AddTo(std::vector<double>& sum, const std::vector<float>& part)
{
  sum.resize(part.size(), 0.0);
  std::transform(sum.begin(), sum.end(), part.begin(), sum.begin(), [](double a, float b) { return a + b; });
}

std::vector<float> Floats(const std::vector<double>& values)
{
  return { values.begin(), values.end() };
}

/// Repeats each value three times.
void Widen(std::vector<double>& values)
{
  std::vector<double> three;
  for (double value : values)
  {
    three.insert(three.end(), 3, value);
  }
  values.swap(three);
}
}

// Random choice rather than a fixed stride: low-discrepancy samples depend on the digits of their indices (every
// sixteenth index has the same last four binary digits, which are Hammersley's leading ones), and all photons of a
// batch would come from one part of the light.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches)
{
  std::mt19937 random; // the same sequence for every batch
  PhotonNumbers numbers;
  for (std::size_t row = 0; row < photons; row += batches)
  {
    const std::size_t number = row + (batch + random()) % batches;
    if (number < photons)
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}

void MarchedBatches::Add(PhotonLight&& part)
{
  ++this->Count;
  // By chance all photons of this batch have one colour.
  if (this->Count > 1 && part.light.channels < this->All.light.channels)
  {
    Spread(part.light, White);
    part.scattered = part.exchanged = {};
  }
  if (this->Count > 1 && part.light.channels > this->All.light.channels)
  {
    Spread(this->All.light, White);
    for (std::vector<double>* values : { &this->Fluence, &this->Squares, &this->Direct })
    {
      Widen(*values);
    }
  }
  this->AddArrays(part);
  if (this->Count == 1)
  {
    this->All = std::move(part);
    return;
  }
  AddBalance(this->All, part);
}

void MarchedBatches::AddArrays(const PhotonLight& part)
{
  const auto channels = static_cast<std::size_t>(part.light.channels);
  AddTo(this->Fluence, part.light.fluence);
  AddTo(this->Direct, part.light.fluenceDirect);
  this->Squares.resize(part.light.fluence.size(), 0.0);
  for (std::size_t i = 0; i < part.light.fluence.size(); ++i)
  {
    this->Squares[i] += static_cast<double>(part.light.fluence[i]) * part.light.fluence[i];
  }
  this->Flow.resize(part.meanDirection.size(), 0.0);
  this->Weights.resize(part.meanDirection.size() / 3, 0.0);
  for (std::size_t i = 0; i < this->Weights.size(); ++i)
  {
    double weight = 0.0;
    for (std::size_t c = 0; c < channels; ++c)
    {
      weight += part.light.fluence[i * channels + c] / static_cast<double>(channels);
    }
    this->Weights[i] += weight;
    for (std::size_t a = 0; a < 3; ++a)
    {
      this->Flow[3 * i + a] += weight * part.meanDirection[3 * i + a];
    }
  }
}

PhotonLight MarchedBatches::Sum() &&
{
  if (this->Count < 2)
  {
    return std::move(this->All);
  }
  LightField& light = this->All.light;
  light.fluence = Floats(this->Fluence);
  light.fluenceDirect = Floats(this->Direct);
  light.fluenceError.clear();
  const double count = this->Count;
  for (std::size_t i = 0; i < this->Fluence.size(); ++i)
  {
    // Each batch is a part of the light: the variance of the sum is that of `count` such parts.
    const double scatter = this->Squares[i] - this->Fluence[i] * this->Fluence[i] / count;
    light.fluenceError.push_back(static_cast<float>(std::sqrt(std::max(scatter, 0.0) * count / (count - 1.0))));
  }
  for (std::size_t i = 0; i < this->Flow.size(); ++i)
  {
    const double weight = this->Weights[i / 3];
    this->All.meanDirection[i] = weight > 0.0 ? static_cast<float>(this->Flow[i] / weight) : 0.0f;
  }
  return std::move(this->All);
}
}
