#include "LightPropagation/Uncollided/Lamps/LampSums.h"

#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tyndall
{
namespace
{
/// Number of voxels per launch; with more, a launch might take longer than a tenth of a second
constexpr std::size_t GainsPerLaunch = 1 << 16;

/// Power, as a fraction of the traced power, that the medium removes in the voxels.
/// @param sums  path integrals of the voxels, in fixed point
/// @param gains  factors by which the path integrals are multiplied (FitToVacuum)
double Taken(
  const SweepVolume& volume, const LampOnGrid& lamp, const std::vector<cl_long>& sums, const std::vector<float>& gains)
{
  const std::vector<float> sigma = volume.sigma_t->Read();
  double taken = 0.0;
  for (std::size_t i = 0; i < volume.grid.VoxelCount(); ++i)
  {
    const double extinction = sigma[volume.sigma_t_first + i];
    // Path integral from its fixed-point sum (numerics.md, Eq. (35))
    const double path = static_cast<double>(sums[i]) / std::max(extinction * lamp.Diagonal(), 1.0);
    taken += extinction * path * gains[i];
  }
  return taken / lamp.UnitsPerLength();
}
}

LampSums::LampSums(Device& device, const LampOnGrid& lamp, const Deposit& deposit, std::size_t stride, const Grid& grid)
  : TheDevice(device)
  , Fixed(device, Parts(lamp, deposit) * stride, "the light of a lamp")
  , OfCells(device, deposit.faceOut ? BoxFaceCellCount(grid) : 1, "the light of a lamp")
  , Gains(device, lamp.SumsOfVacuum() > 0 ? stride : 1, "the light of a lamp")
  , TheStride(stride)
{
  this->Gains.Fill(1.0f);
  this->Fixed.Fill(0);
  this->OfCells.Fill(0);
}

double LampSums::FitToVacuum(const SweepVolume& volume, const LampOnGrid& lamp, const VoxelBox& own)
{
  const std::size_t all = own.VoxelCount();
  if (lamp.SumsOfVacuum() == 0 || all == 0)
  {
    return 0.0;
  }
  cl::Kernel kernel = lamp.Kernel(this->TheDevice, "find_gains", kernel_source::LampSums, volume.deposit);
  const RectangleInfo rectangle = lamp.DescribeRectangle(own);
  for (std::size_t first = 0; first < all; first += GainsPerLaunch)
  {
    With(kernel, rectangle, this->Fixed, cl_ulong(this->TheStride), this->Gains, cl_ulong(first), *volume.sigma_t,
      cl_ulong(volume.sigma_t_first), static_cast<float>(lamp.Diagonal()));
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(std::min(GainsPerLaunch, all - first)), cl::NullRange);
    this->TheDevice.Finish();
  }
  return Taken(volume, lamp, this->Fixed.Read(), this->Gains.Read());
}

void LampSums::AddTo(const SweepVolume& volume, const LampOnGrid& lamp, double factor) const
{
  cl_float4 units = {};
  for (int c = 0; c < 3; ++c)
  {
    units.s[c] = static_cast<float>(lamp.TheLight().power[c] * factor / lamp.UnitsPerLength());
  }
  const auto add = [&](const char* name, const Buffer<float>* sum) {
    if (!sum || volume.grid.VoxelCount() == 0)
    {
      return;
    }
    cl::Kernel kernel = lamp.Kernel(this->TheDevice, name, kernel_source::LampSums, volume.deposit);
    With(kernel, this->Fixed, *sum, cl_ulong(volume.first), cl_ulong(this->TheStride), units, *volume.sigma_t,
      cl_ulong(volume.sigma_t_first), static_cast<float>(lamp.Diagonal()), this->Gains);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(this->TheStride, volume.channels), cl::NullRange);
  };
  add("add_fixed", volume.deposit.path);
  add("add_fixed_moments", volume.deposit.firstMoments);
  add("add_fixed_flux", volume.deposit.flux);
}

void LampSums::AddCellsTo(const SweepVolume& volume, std::size_t faceFirst, const LampOnGrid& lamp, double factor) const
{
  cl_float4 watts = {};
  for (int c = 0; c < 3; ++c)
  {
    watts.s[c] = static_cast<float>(lamp.TheLight().power[c] * factor);
  }
  const std::size_t cells = this->OfCells.Size();
  cl::Kernel add = lamp.Kernel(this->TheDevice, "add_fixed_cells", kernel_source::LampSums, volume.deposit);
  With(add, this->OfCells, *volume.deposit.faceOut, cl_ulong(faceFirst), cl_ulong(cells), watts);
  this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(cells, volume.channels), cl::NullRange);
  this->TheDevice.Finish(); // the kernel must end before the caller releases the cells
}

void LampSums::SpreadEvenly(const SweepVolume& volume, const LampOnGrid& lamp, double share, double extinction) const
{
  const bool adds = share > 0.0 && extinction > 0.0 && volume.grid.VoxelCount() > 0;
  for (int c = 0; c < volume.channels && adds; ++c)
  {
    cl::Kernel add = lamp.Kernel(this->TheDevice, "add_evenly", kernel_source::LampSums, volume.deposit);
    With(add, *volume.deposit.path, cl_ulong(volume.first + c * volume.stride),
      static_cast<float>(lamp.TheLight().power[c] * share / extinction));
    this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(volume.grid.VoxelCount()));
  }
}

double Extinction(const SweepVolume& volume)
{
  if (volume.grid.VoxelCount() == 0)
  {
    return 0.0;
  }
  const std::vector<float> sigma = volume.sigma_t->Read();
  const auto first = sigma.begin() + static_cast<std::ptrdiff_t>(volume.sigma_t_first);
  return std::accumulate(first, first + static_cast<std::ptrdiff_t>(volume.grid.VoxelCount()), 0.0);
}
}
