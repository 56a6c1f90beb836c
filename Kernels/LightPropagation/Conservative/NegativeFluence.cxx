#include "LightPropagation/Conservative/NegativeFluence.h"

#include "Device/HostThreads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
/// Raising negative fluence adds absorbed power, which is then subtracted from neighbouring voxels in at most this
/// number of passes (OwedPower::Collect()). If the direct neighbours of a voxel do not have enough power, each pass
/// moves the remainder to voxels one step farther away.
constexpr int MostTurns = 50;
/// A fluence that is below its uncollided part by at most this fraction of that part is raised without subtracting
/// power elsewhere.
constexpr float Rounding = 1e-6f;

/// One channel of fluence on this rank, in which negative values are raised. A raised voxel absorbs additional power;
/// it owes this power until it has been subtracted from the power that its neighbours absorb.
class OwedPower
{
public:
  /// @param instead  replacement of negative values, W / length^2, by voxel; null: 0
  OwedPower(const Halo& around, const std::function<double(std::size_t)>& sigma_a, float* fluence, const float* instead)
    : Around(around)
    , Sigma(sigma_a)
    , Fluence(fluence)
    , Known(around.KnownGrid())
    , Owed(around.Own().VoxelCount(), 0.0)
  {
    for (std::size_t i = 0; i < this->Owed.size(); ++i)
    {
      this->Borrow(i, instead ? instead[i] : 0.0f);
    }
  }

  bool Any() const
  {
    return std::any_of(this->Owed.begin(), this->Owed.end(), [](double owed) { return owed > 0.0; });
  }

  /// Subtracts the owed power, which raised voxels absorb in addition, from the power that their neighbours absorb. If
  /// the neighbours of a voxel absorb less than it owes, each of them owes an equal share of its debt in the next call.
  /// A neighbour whose fluence becomes negative is raised, and owes the difference. Collective.
  void Collect()
  {
    std::vector<float> own(this->Owed.size());
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = static_cast<float>(this->Sigma(i) * this->Fluence[i]);
    }
    const std::vector<float> absorbed = this->Around.Spread(own, 1);
    const std::vector<float> ones(absorbed.size(), 1.0f);
    std::vector<float> handed(own.size(), 0.0f);
    this->ForOwn([&](std::size_t i, std::size_t known, const std::array<int, 3>& at) {
      const double owed = std::exchange(this->Owed[i], 0.0);
      const double beside = owed > 0.0 ? this->SumBeside(absorbed, known, at) : 0.0;
      const bool suffices = beside >= owed && owed > 0.0;
      own[i] = suffices ? static_cast<float>(owed / beside) : 0.0f;
      handed[i] =
        suffices ? 0.0f : static_cast<float>(owed / std::max(this->SumBeside(ones, known, at), 1.0)); // one voxel: lost
    });
    const std::vector<float> parts = this->Around.Spread(own, 1), shares = this->Around.Spread(handed, 1);
    this->ForOwn([&](std::size_t i, std::size_t known, const std::array<int, 3>& at) {
      this->Owed[i] = this->SumBeside(shares, known, at);
      if (this->Sigma(i) > 0.0)
      {
        this->Fluence[i] = static_cast<float>(this->Fluence[i] * (1.0 - this->SumBeside(parts, known, at)));
        this->Borrow(i, 0.0f);
      }
    });
  }

private:
  void Borrow(std::size_t i, float instead)
  {
    if (this->Fluence[i] < 0.0f)
    {
      this->Owed[i] += this->Sigma(i) * (static_cast<double>(instead) - this->Fluence[i]);
      this->Fluence[i] = instead;
    }
  }

  /// Calls act(index in the block, index in the box with halo, indices along the axes of the box with halo) for each
  /// voxel of the block.
  template <class Act>
  void ForOwn(const Act& act) const
  {
    const VoxelBox &own = this->Around.Own(), &known = this->Around.Known();
    for (std::size_t i = 0; i < this->Owed.size(); ++i)
    {
      const std::array<int, 3> at = known.Within(own.VoxelAt(i));
      act(i, this->Known.IndexOf(at), at);
    }
  }

  /// Sum of `values`, an array over the block with its halo, over the (at most six) neighbours of a voxel.
  /// @param known  index of the voxel in that array
  /// @param at  indices of the voxel along the axes of the block with its halo
  double SumBeside(const std::vector<float>& values, std::size_t known, const std::array<int, 3>& at) const
  {
    const std::array<std::size_t, 3> step = this->Known.Strides();
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      sum += at[axis] > 0 ? values[known - step[axis]] : 0.0;
      sum += at[axis] + 1 < this->Known.size[axis] ? values[known + step[axis]] : 0.0;
    }
    return sum;
  }

  const Halo& Around;
  const std::function<double(std::size_t)> Sigma;
  float* Fluence;
  const Grid Known; ///< the block with its halo
  /// Power per volume that voxels absorb in addition since their fluence was raised, W / length^3, by voxel of the
  /// block.
  std::vector<double> Owed;
};
}

void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& fluence, const std::vector<float>& instead)
{
  const bool any = std::any_of(fluence.begin(), fluence.end(), [](float value) { return value < 0.0f; });
  if (communicator.Sum({ any ? 1.0 : 0.0 })[0] == 0.0)
  {
    return;
  }
  for (int c = 0; c < layout.channels; ++c)
  {
    const std::size_t first = c * layout.Stride();
    OwedPower owed(
      around, [&sigma_a, c](std::size_t i) { return sigma_a.At(i, c); }, fluence.data() + first,
      instead.empty() ? nullptr : instead.data() + first);
    for (int turn = 0; turn < MostTurns && communicator.Sum({ owed.Any() ? 1.0 : 0.0 })[0] > 0.0; ++turn)
    {
      owed.Collect();
    }
  }
}

void MakeFluence(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& solved, std::vector<float> path, const std::vector<float>& uncollided)
{
  const double perVolume = 1.0 / layout.grid.VoxelVolume();
  path.resize(solved.size());
  std::transform(path.begin(), path.end(), path.begin(),
    [perVolume](float value) { return std::max(static_cast<float>(value * perVolume), 0.0f); });
  CutOffNegative(communicator, around, layout, sigma_a, solved, path);
  std::transform(solved.begin(), solved.end(), uncollided.begin(), solved.begin(), std::plus<float>());
}

void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  const std::vector<float>& uncollided, Buffer<float>& fluence)
{
  std::vector<float> direct, values;
  communicator.Collective([&] {
    direct = Planar(layout, layout.channels, [&](std::size_t i, int c) { return uncollided[i * layout.channels + c]; });
    values = fluence.Read();
    std::transform(values.begin(), values.end(), direct.begin(), values.begin(), [](float all, float direct) {
      const float scattered = all - direct;
      return scattered < 0.0f && scattered >= -Rounding * direct ? 0.0f : scattered;
    });
  });
  CutOffNegative(communicator, around, layout, sigma_a, values);
  communicator.Collective([&] {
    std::transform(values.begin(), values.end(), direct.begin(), values.begin(), std::plus<float>());
    fluence.Write(values.data());
  });
}

void LimitFlux(const VolumeLayout& layout, const std::vector<float>& fluence, Buffer<float>& ofLight)
{
  const std::size_t stride = layout.Stride();
  std::vector<float> flux = ofLight.Read();
  const double volume = layout.grid.VoxelVolume();
  for (int c = 0; c < layout.channels; ++c)
  {
    InThreads(layout.grid.VoxelCount(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
      {
        float* const x = flux.data() + 3 * c * stride + i;
        float* const y = x + stride;
        float* const z = y + stride;
        const double most = fluence[c * stride + i] * volume;
        const double flows = std::hypot(*x, *y, *z);
        const auto part = static_cast<float>(flows > most ? most / flows : 1.0);
        *x *= part;
        *y *= part;
        *z *= part;
      }
    });
  }
  ofLight.Write(flux.data());
}
}
