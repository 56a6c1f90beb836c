#include "LatticeBoltzmann/Steady/LatticeDiffusion.h"

#include "LightPropagation/Diffusion/MultigridLayout.h"

namespace tyndall
{
namespace
{
/// Factor by which a solve reduces the residual, in the norm of the multigrid preconditioner.
constexpr double Reduction = 0.1;
constexpr double Thinnest = 0.05; ///< smallest optical thickness of a voxel, sigma_t h, in the matrix
}

LatticeDiffusion::LatticeDiffusion(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels)
  : TheDomain(problem.TheDomain())
  , Block(this->TheDomain, settings.periodic, 1, true)
{
  this->TheDomain.Collective([&] {
    const Matrix matrix = this->MatrixOf(problem.Box(), settings, voxels);
    this->Multigrid = std::make_unique<MultigridSolver>(device, this->TheDomain, settings.periodic);
    std::vector<float> conductance;
    for (const std::vector<float>& ofAxis : matrix.conductance)
    {
      conductance.insert(conductance.end(), ofAxis.begin(), ofAxis.end());
    }
    this->Multigrid->Conductance().Write(InRows(this->Multigrid->Rows(), conductance, 3).data());
    this->Multigrid->Loss().Write(InRows(this->Multigrid->Rows(), matrix.loss).data());
    this->Found = ExactValues(device, matrix.loss.size(), "diffusion of the lattice");
  });
  this->Multigrid->Coarsen();
}

LatticeDiffusion::Matrix LatticeDiffusion::MatrixOf(
  const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels) const
{
  const Grid& held = this->Block.WithGhosts().grid;
  const std::array<std::size_t, 3> strides = held.Strides();
  const double thin = 1.0 / (0.5 + 1.0 / (3.0 * LatticeSquares(settings.directions) * Thinnest));
  Matrix matrix;
  matrix.conductance.fill(std::vector<float>(held.VoxelCount(), 0.0f));
  matrix.loss.assign(held.VoxelCount(), 0.0f);
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t known = box.Known(i), place = this->Block.PlaceOf(i);
    const std::array<int, 3> at = box.known.VoxelAt(known), atHeld = held.VoxelAt(place);
    double loss = voxels.lost[known] * voxels.squared[known];
    for (std::size_t face = 0; face < 6; ++face)
    {
      const std::size_t axis = face / 2;
      if (settings.periodic[axis] && this->TheDomain.Whole().size[axis] == 1)
      {
        continue; // on a periodic axis of one voxel, the voxel is its own neighbour, and no light is exchanged
      }
      const std::size_t beyond = box.Beyond(at, face);
      std::array<int, 3> above = atHeld;
      ++above[axis];
      const bool isHigh = face % 2 == 1, hasGhostAbove = above[axis] < held.size[axis] && !this->Block.IsOwn(above);
      if (beyond == Outside)
      {
        loss += 1.0 / voxels.ResistanceOfFace(known, face, thin);
      }
      else if (!isHigh || hasGhostAbove) // high faces between own voxels are handled as low faces of the next voxel
      {
        matrix.conductance[axis][isHigh ? place + strides[axis] : place] =
          static_cast<float>(1.0 / voxels.ResistanceBetween(known, beyond, thin));
      }
    }
    matrix.loss[place] = static_cast<float>(loss);
  }
  return matrix;
}

LatticeDiffusion::Values LatticeDiffusion::Solve(const Values& residual, double unit)
{
  std::vector<float> right;
  this->TheDomain.Collective([&] {
    right.assign(this->Block.WithGhosts().grid.VoxelCount(), 0.0f);
    for (std::size_t i = 0; i < residual.size(); ++i)
    {
      right[this->Block.PlaceOf(i)] = static_cast<float>(residual[i]);
    }
    this->Multigrid->Right().Write(InRows(this->Multigrid->Rows(), right).data());
    this->Found.Fill(0.0);
  });
  this->Multigrid->Solve(this->Found, unit, Reduction);
  const Values values = this->Found.Read();
  Values found(residual.size());
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    found[i] = values[this->Block.PlaceOf(i)];
  }
  return found;
}
}
