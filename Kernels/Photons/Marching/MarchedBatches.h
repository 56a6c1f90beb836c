#pragma once

#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Photons.h"

#include <vector>

namespace tyndall
{
/// Indices of the photons in one of the batches from which the standard error is estimated: one random photon out of
/// each group of `batches`, the same on every machine.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches);

/// Sums the light of several independent batches of photons, each a part of all the power, and estimates the standard
/// error of the sum (numerics.md, Eq. (99e)).
class MarchedBatches
{
public:
  void Add(PhotonLight&& part);
  /// The light of all batches, with fluenceError. With one batch or none, the light as it is, without an error.
  PhotonLight Sum() &&;

private:
  void AddArrays(const PhotonLight& part);

  PhotonLight All;
  int Count = 0;
  std::vector<double> Fluence, Squares, Direct, Flow, Weights;
};
}
