#pragma once

#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Photons.h"

#include <vector>

namespace tyndall
{
/// Numbers of the photons of one of the batches by which a standard error is found: of each row of so many photons one,
/// by chance, and the same on every machine.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches);

/// Light of several independent batches of photons, each a part of all the power, added up as they come, with the
/// standard error of their sum (numerics.md, Eq. (99e)).
class MarchedBatches
{
public:
  void Add(PhotonLight&& part);
  /// All light, and fluenceError. Of one batch or none as it is, without an error.
  PhotonLight Sum() &&;

private:
  void AddArrays(const PhotonLight& part);

  PhotonLight All;
  int Count = 0;
  std::vector<double> Fluence, Squares, Direct, Flow, Weights;
};
}
