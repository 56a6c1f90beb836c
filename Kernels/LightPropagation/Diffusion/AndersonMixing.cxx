#include "LightPropagation/Diffusion/AndersonMixing.h"

#include "Device/Device.h"
#include "Device/Sizes.h"

#include "TyndallKernelSources.h"

#include <cmath>
#include <utility>

namespace tyndall
{
AndersonMixing::AndersonMixing(Device& device, std::size_t voxels, std::size_t count, const char* what)
  : TheDevice(device)
  , Voxels(voxels)
  , Count(count)
  , OfChunks(device, AndersonSums * PartsOf<std::size_t>(count, DiffusionChunk), "sums")
{
  for (int i = 0; i < 2; ++i)
  {
    this->FoundBefore[i] = Buffer<float>(device, count, what);
    this->ChangeBefore[i] = Buffer<float>(device, count, what);
    this->FoundBefore[i].Fill(0.0f);
    this->ChangeBefore[i].Fill(0.0f);
  }
}

cl::Kernel AndersonMixing::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(
    name, kernel_source::AndersonMixing, SummingOption(this->TheDevice) + ExactOption(this->TheDevice));
}

void AndersonMixing::Mix(const ExactValues& given, const ExactValues& found, const Sums& sums)
{
  const std::array<double, 2> weights = this->WeightsBy(sums);
  cl::Kernel step = this->Kernel("anderson_step");
  std::swap(this->FoundBefore[0], this->FoundBefore[1]);
  std::swap(this->ChangeBefore[0], this->ChangeBefore[1]);
  // After the swap, index 0 is the older of the two stored results, which the kernel reads and then overwrites with the
  // new one.
  With(step, given.Handle(), found.Handle(), this->FoundBefore[1], this->FoundBefore[0], this->ChangeBefore[0],
    static_cast<float>(weights[0]), static_cast<float>(weights[1]));
  this->TheDevice.Queue().enqueueNDRangeKernel(step, cl::NullRange, cl::NDRange(this->Count), cl::NullRange);
  ++this->Mixes;
}

double AndersonMixing::ChangeBy(const Sums& sums)
{
  return sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}

AndersonMixing::Sums AndersonMixing::SumsOf(
  const ExactValues& given, const ExactValues& found, const Weighting& weighting) const
{
  cl::Kernel kernel = this->Kernel("anderson_sums");
  With(kernel, given.Handle(), found.Handle(), this->ChangeBefore[0], this->ChangeBefore[1], *weighting.sigma_s,
    cl_int(weighting.first), weighting.length, cl_int(this->Voxels), cl_int(this->Count), this->OfChunks.Handle());
  RunSummingGroups(this->TheDevice, kernel, PartsOf<std::size_t>(this->Count, DiffusionChunk));
  Sums sums = {};
  const std::vector<double> parts = this->OfChunks.Read();
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    sums[i % AndersonSums] += parts[i];
  }
  return sums;
}

/// Weights w1, w2 of the two previous iterations, which minimise the change in the least-squares sense (numerics.md,
/// Eq. (71)).
std::array<double, 2> AndersonMixing::WeightsBy(const Sums& sums) const
{
  const auto& [ff, all, aa, ab, bb, af, bf, unused] = sums;
  const double determinant = aa * bb - ab * ab;
  if (this->Mixes >= 2 && determinant > 1e-8 * aa * bb)
  {
    return { (af * bb - bf * ab) / determinant, (bf * aa - af * ab) / determinant };
  }
  return { this->Mixes >= 1 && aa > 0.0 ? af / aa : 0.0, 0.0 };
}
}
