#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"

#include "LightPropagation/Diffusion/MultigridLayout.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Floor = 0.05; ///< minimum optical length between cell centres in conductances
/// Term by which Marshak's boundary condition enters the resistance of a face of the box, Eq. (76d).
constexpr double Marshak = 2.0;

/// One grid of a hierarchy: edges and mean extinction of its cells. Each coarser grid joins two cells along each axis.
struct Level
{
  std::array<int, 3> size;
  std::array<std::vector<double>, 3> widths; ///< edges of cells along each axis, in units of length
  std::vector<double> sigmaT;                ///< mean extinction of each cell, 1/length

  std::size_t At(int x, int y, int z) const { return (std::size_t(z) * size[1] + y) * size[0] + x; }
  double Volume(int x, int y, int z) const { return this->widths[0][x] * this->widths[1][y] * this->widths[2][z]; }
  double Longest(int x, int y, int z) const
  {
    return std::max({ this->widths[0][x], this->widths[1][y], this->widths[2][z] });
  }
};

Level Finest(const Grid& grid, const CoarseCells& box, const std::vector<float>& sigmaT)
{
  Level level;
  for (int axis = 0; axis < 3; ++axis)
  {
    level.size[axis] = box.cells.size[axis];
    const int edge = 1 << box.halvings[axis];
    for (int cell = 0; cell < level.size[axis]; ++cell)
    {
      level.widths[axis].push_back(grid.spacing[axis] * std::min(edge, grid.size[axis] - cell * edge));
    }
  }
  level.sigmaT.assign(sigmaT.begin(), sigmaT.end());
  const double voxel = grid.VoxelVolume();
  ForGridVoxels(level.size,
    [&](std::size_t, int x, int y, int z) { level.sigmaT[level.At(x, y, z)] *= voxel / level.Volume(x, y, z); });
  return level;
}

Level Coarser(const Level& fine)
{
  Level level;
  for (int axis = 0; axis < 3; ++axis)
  {
    level.size[axis] = (fine.size[axis] + 1) / 2;
    level.widths[axis].assign(level.size[axis], 0.0);
    for (int cell = 0; cell < fine.size[axis]; ++cell)
    {
      level.widths[axis][cell / 2] += fine.widths[axis][cell];
    }
  }
  level.sigmaT.assign(std::size_t(level.size[0]) * level.size[1] * level.size[2], 0.0);
  ForGridVoxels(fine.size, [&](std::size_t, int x, int y, int z) {
    level.sigmaT[level.At(x / 2, y / 2, z / 2)] += fine.sigmaT[fine.At(x, y, z)] * fine.Volume(x, y, z);
  });
  ForGridVoxels(
    level.size, [&](std::size_t, int x, int y, int z) { level.sigmaT[level.At(x, y, z)] /= level.Volume(x, y, z); });
  return level;
}

/// Edge of the box around a cell that is one mean free path thick (W of numerics.md, Eq. (76h)), interpolated between a
/// thinner and a thicker box.
/// @param edge, wide  edges of the thinner and the thicker box, in units of length
/// @param thin, thick  optical width of the thinner and of the thicker box, divided by its edge, 1/length
double EdgeOfMeanFreePath(double edge, double thin, double wide, double thick)
{
  constexpr double Vacuum = 1e-9;
  const double tau = std::max(edge * thin, Vacuum);
  return edge * std::pow(wide / edge, -std::log(tau) / std::log(wide * thick / tau));
}

/// Extinction of each cell in the diffusion coefficient, 1/length: max(sigma_t, 1 / W), with W the edge of the box
/// around the cell that is one mean free path thick (numerics.md, Eq. (76h)). With a diffusion coefficient of 1 / (3
/// sigma_t), light would diffuse too fast in thin cells over distances below a mean free path.
std::vector<double> Diffusing(const Level& level)
{
  std::vector<double> sigma = level.sigmaT;
  if (sigma.size() == 1)
  {
    return sigma;
  }
  std::vector<double> around; // result of this function for the next coarser grid; computed when first needed
  Level coarser;
  ForGridVoxels(level.size, [&](std::size_t, int x, int y, int z) {
    double& here = sigma[level.At(x, y, z)];
    const double edge = level.Longest(x, y, z);
    if (here * edge >= 1.0)
    {
      return;
    }
    if (around.empty())
    {
      coarser = Coarser(level);
      around = Diffusing(coarser);
    }
    const std::size_t outer = coarser.At(x / 2, y / 2, z / 2);
    const double wide = coarser.Longest(x / 2, y / 2, z / 2);
    const bool isThick = coarser.sigmaT[outer] * wide >= 1.0;
    here = std::max(here, isThick ? 1.0 / EdgeOfMeanFreePath(edge, here, wide, coarser.sigmaT[outer]) : around[outer]);
  });
  return sigma;
}
}

CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS)
{
  const Level level = Finest(grid, box, sigmaT);
  const std::vector<double> sigma = Diffusing(level);
  const std::size_t count = sigma.size();
  std::vector<double> conductance(3 * count, 0.0), loss(count, 0.0);
  ForGridVoxels(level.size, [&](std::size_t, int x, int y, int z) {
    const std::array<int, 3> at = { x, y, z };
    const std::size_t here = level.At(x, y, z);
    loss[here] = std::max(0.0, double(sigmaT[here]) - sigmaS[here]) * grid.VoxelVolume();
    for (int axis = 0; axis < 3; ++axis)
    {
      if (at[axis] == 0 && !box.periodic[axis])
      {
        continue;
      }
      std::array<int, 3> low = at;
      low[axis] = at[axis] == 0 ? level.size[axis] - 1 : at[axis] - 1;
      const double width = level.widths[axis][at[axis]], area = level.Volume(x, y, z) / width;
      const double between =
        sigma[here] * width + sigma[level.At(low[0], low[1], low[2])] * level.widths[axis][low[axis]];
      conductance[axis * count + here] = area / (1.5 * std::max(between, 2.0 * Floor));
    }
  });
  CoarseMatrix matrix;
  ForBoxFaceCells(cells, [&](const BoxFaceCell& cell) {
    const int axis = cell.face / 2;
    const std::array<int, 3> at = cells.VoxelAt(cell.voxel);
    const double width = level.widths[axis][at[axis]], area = level.Volume(at[0], at[1], at[2]) / width;
    const double passes = box.periodic[axis] ? 0.0 : area / (1.5 * sigma[cell.voxel] * width + Marshak);
    loss[cell.voxel] += passes;
    matrix.borders.push_back(passes);
  });
  matrix.conductance = InRows(box.cells, conductance, 3);
  matrix.loss = InRows(box.cells, loss);
  return matrix;
}
}
