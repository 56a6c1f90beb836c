#include "LightPropagation/Uncollided/LampSums.h"

#include "TyndallKernelSources.h"

namespace tyndall
{
LampSums::LampSums(Device& device, const Deposit& deposit, std::size_t stride)
  : TheDevice(device)
  , Fixed(device, Parts(deposit) * stride, "the light of a lamp")
  , TheStride(stride)
{
  this->Fixed.Fill(0);
}

void LampSums::AddTo(const SweepVolume& volume, const LampOnGrid& lamp, double factor) const
{
  cl_float4 units = {};
  for (int c = 0; c < 3; ++c)
  {
    units.s[c] = static_cast<float>(lamp.TheLight().power[c] * factor / lamp.UnitsPerLength());
  }
  const auto add = [&](const char* name, const Buffer<float>* sum) {
    if (!sum)
    {
      return;
    }
    cl::Kernel kernel = lamp.Kernel(this->TheDevice, name, kernel_source::LampSums, volume.deposit);
    With(kernel, this->Fixed, *sum, cl_ulong(volume.first), cl_ulong(this->TheStride), units, *volume.sigma_t,
      cl_ulong(volume.sigma_t_first), static_cast<float>(lamp.Diagonal()));
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(this->TheStride, volume.channels), cl::NullRange);
  };
  add("add_fixed", volume.deposit.path);
  add("add_fixed_moments", volume.deposit.firstMoments);
  add("add_fixed_flux", volume.deposit.flux);
}
}
