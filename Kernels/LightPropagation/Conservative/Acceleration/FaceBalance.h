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
/// Anderson mixing (numerics.md, Eq. (71)) of short vectors on the host; used for reflected light. The next iterate is
/// the combination of the last results whose change is smallest in the least-squares sense, with negative entries set
/// to 0.
class HostMixing
{
public:
  /// @param given  the iterate
  /// @param found  result of one iteration from `given`
  /// @return the next iterate
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

/// Light by cell of the box faces in a DSA solve (numerics.md, section 7.12): the power that left in the sweep, the
/// power that leaves in the diffusion solution, and the reflected power that therefore enters the next sweep. Each rank
/// holds the light of all cells of the box faces on the host, W, [channel][cell], and the light of the cells at its own
/// voxels on the device, where its diffusion system reads it. Construct and call collectively.
class FaceBalance
{
public:
  /// Takes the power that has left so far as uncollided. It is not swept again; its reflected part enters every sweep.
  /// @param device, faces, block  must outlive this
  FaceBalance(Device& device, FaceLight& faces, const BlockWithGhosts& block);

  const Rgb& GivenBack() const { return this->PowerGivenBack; } ///< W of uncollided light reflected, by channel

  /// Takes the power that left in the last sweep, and writes Rows.
  void TakeSwept();
  /// Rows in the layout of DiffusionSystem::Arrays, by cell of the faces of the block with ghost cells; 0 at ghost
  /// cells.
  const Buffer<float>& Rows(int channel) const { return this->OfBlock[channel]; }
  /// Reads the leaving power from the rows that the diffusion systems wrote.
  /// @param lit  channels that were solved, the same on all ranks
  void TakeLeaving(const std::vector<bool>& lit);

  /// Sets the incident light of the next sweep to the reflected power of the diffusion solution.
  /// @param given  by channel, W: emitted, first scattered, reflected uncollided and incident boundary power
  /// @return difference between this reflected power and that incident in the last sweep, relative to `given` plus the
  ///   reflected power; largest over channels
  double Reflect(int iteration, const Rgb& given);

  /// Adds the escaped power after reflection to the ledger, which already contains uncollided light that left.
  void Count(EnergyLedger& ledger) const;

  /// Power that leaves through each cell, W, without the uneven pattern in which the rays of the last sweep cross the
  /// cells. In optically thin voxels the diffusion systems inherit this pattern from the sweep. Sums over faces are
  /// unchanged.
  /// @param incoming  boundary irradiance of each face, W / length^2
  /// @param medium  of this rank's block
  std::vector<double> LeftWithoutPattern(const std::array<Rgb, 6>& incoming, const Medium& medium) const;

private:
  /// A cell of the box faces at a voxel of this rank: its index among the face cells of the block with ghost cells
  /// (held) and of the whole box (whole).
  struct OwnCell
  {
    std::size_t held, whole;
    std::size_t voxel; ///< index in the block
  };
  void FindOwnCells(const BlockWithGhosts& block);
  double ReflectChannel(int iteration, std::size_t channel, double given);
  std::vector<float> RowsOf(std::size_t channel) const;
  std::vector<double> Left() const;
  std::vector<double> OpticalLengths(const Medium& medium) const;

  const Domain& TheDomain;
  FaceLight& Faces;
  const std::size_t Cells, HeldCells; ///< number of cells of the box faces, and of those of the block with ghost cells
  std::vector<OwnCell> OwnCells;
  std::vector<Buffer<float>> OfBlock; ///< by channel
  Rgb PowerGivenBack = {};
  std::vector<double> CameBack, GivenBackByCell, LeftUncollided;
  std::vector<float> LeftSwept;        ///< W that left in the last sweep
  std::vector<double> Leaves;          ///< W that leaves in the diffusion solution
  std::vector<double> CameBackInSweep; ///< W reflected into the last sweep
  std::vector<HostMixing> BackMixing;  ///< mixes CameBack, by channel
};
}
