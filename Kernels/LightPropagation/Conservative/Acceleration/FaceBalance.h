#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "Medium/Medium.h"

#include <Eigen/Dense>

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Anderson mixing (numerics.md, Eq. (71)) of short vectors in host memory, used for reflected power by cell. The next
/// iterate is the combination of the last results whose change is smallest in the least-squares sense, with negative
/// entries set to 0.
class HostMixing
{
public:
  /// Computes the next iterate.
  /// @param given  the last iterate
  /// @param found  result of one iteration from `given`
  std::vector<double> Next(const std::vector<double>& given, const std::vector<double>& found)
  {
    const auto size = static_cast<Eigen::Index>(found.size());
    const Eigen::VectorXd result = Eigen::Map<const Eigen::VectorXd>(found.data(), size);
    const Eigen::VectorXd change = result - Eigen::Map<const Eigen::VectorXd>(given.data(), size);
    Eigen::VectorXd next = result;
    const auto count = static_cast<Eigen::Index>(this->Results.size());
    if (count > 0)
    {
      Eigen::MatrixXd changes(size, count);
      for (Eigen::Index k = 0; k < count; ++k)
      {
        changes.col(k) = change - this->Changes[k];
      }
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd> squares(changes);
      squares.setThreshold(1e-6);
      const Eigen::VectorXd weights = squares.solve(change);
      for (Eigen::Index k = 0; k < count; ++k)
      {
        next -= weights[k] * (result - this->Results[k]);
      }
    }
    this->Keep(result, change);
    std::vector<double> values(next.data(), next.data() + size);
    std::for_each(values.begin(), values.end(), [](double& value) { value = std::max(value, 0.0); });
    return values;
  }

private:
  static constexpr std::size_t Depth = 3;

  void Keep(const Eigen::VectorXd& result, const Eigen::VectorXd& change)
  {
    if (this->Results.size() == Depth)
    {
      this->Results.erase(this->Results.begin());
      this->Changes.erase(this->Changes.begin());
    }
    this->Results.push_back(result);
    this->Changes.push_back(change);
  }

  std::vector<Eigen::VectorXd> Results, Changes;
};

/// Power through each cell of the box faces in a DSA solve (numerics.md, section 7.12): outgoing in the sweep, outgoing
/// in the diffusion solution, and reflected into the next sweep. Each rank holds the values of all cells of the box
/// faces in host memory, W, [channel][cell], and those of the cells at its own voxels on the device, where its
/// diffusion system reads them. Construct and call collectively.
class FaceBalance
{
public:
  /// The outgoing power in `faces` must be that of uncollided light, which is not swept. Its reflected power is
  /// incident in every sweep.
  /// @param device, faces, block  must outlive this object
  FaceBalance(Device& device, FaceLight& faces, const BlockWithGhosts& block);

  const Rgb& GivenBack() const { return this->PowerGivenBack; } ///< reflected power of uncollided light, W by channel

  /// Reads the outgoing power of the last sweep, and writes it, with the reflected powers, to Rows().
  void TakeSwept();
  /// Powers of one channel in each face cell of the block with ghost cells, W, [FaceCame ... FaceLeaves][cell]
  /// (DiffusionShared.h): power reflected into the last sweep, reflected power of uncollided light, outgoing power of
  /// the sweep, and outgoing power of the diffusion solution. 0 at ghost cells.
  const Buffer<float>& Rows(int channel) const { return this->OfBlock[channel]; }
  /// Reads the outgoing power of the diffusion solution, which the diffusion systems wrote to Rows().
  /// @param lit  by channel: whether its diffusion system was solved; equal on all ranks
  void TakeLeaving(const std::vector<bool>& lit);

  /// Sets the reflected light incident in the next sweep from the outgoing power of the diffusion solution.
  /// @param given  sum of the emitted and first-scattered power, the reflected power of uncollided light and the
  ///   incident boundary power, W by channel
  /// @return change of the reflected power since the last sweep, relative to `given` plus the reflected power; largest
  ///   over channels
  double Reflect(int iteration, const Rgb& given);

  /// Adds the escaped power, after reflection, to the ledger, which already contains the uncollided light that left.
  void Count(EnergyLedger& ledger) const;

  /// Outgoing power by cell, W, without the uneven pattern in which the rays of the last sweep cross the cells. In
  /// optically thin voxels the diffusion solution inherits this pattern from the sweep. Sums over faces are unchanged.
  /// @param incoming  irradiance of each face by the boundary source, W / length^2
  /// @param medium  medium of this rank's block
  std::vector<double> LeftWithoutPattern(const std::array<Rgb, 6>& incoming, const Medium& medium) const;

private:
  /// A cell of the box faces at a voxel of this rank. held: index of the cell among the face cells of the block with
  /// ghost cells; whole: its index among the cells of the box faces.
  struct OwnCell
  {
    std::size_t held, whole;
    std::size_t voxel; ///< index of the voxel in the block
  };
  void FindOwnCells(const BlockWithGhosts& block);
  double ReflectChannel(int iteration, std::size_t channel, double given);
  std::vector<float> RowsOf(std::size_t channel) const;
  std::vector<double> Left() const;
  std::vector<double> OpticalLengths(const Medium& medium) const;

  const Domain& TheDomain;
  FaceLight& Faces;
  const std::size_t Cells,
    HeldCells; ///< number of cells of the box faces, and of the faces of the block with ghost cells
  std::vector<OwnCell> OwnCells;
  /// For each channel, the powers that Rows() returns.
  std::vector<Buffer<float>> OfBlock;
  Rgb PowerGivenBack = {};
  std::vector<double> CameBack, GivenBackByCell, LeftUncollided;
  std::vector<float> LeftSwept;        ///< outgoing power of the last sweep, W
  std::vector<double> Leaves;          ///< outgoing power of the diffusion solution, W
  std::vector<double> CameBackInSweep; ///< reflected power incident in the last sweep, W
  std::vector<HostMixing> BackMixing;  ///< Anderson mixing of CameBack, by channel
};
}
