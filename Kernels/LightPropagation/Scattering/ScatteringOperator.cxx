#include "LightPropagation/Scattering/ScatteringOperator.h"

#include "Device/Sizes.h"
#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <stdexcept>

namespace tyndall
{
namespace
{
/// Isotropic scattering: source = sigma_s fluence / 4 pi (numerics.md, Eq. (42); Gruson et al. 2012, equation 4, in
/// conservative form). sigma_s already includes the factor for a mean cosine g (TruncatedScattering.h).
class IsotropicScattering : public ScatteringOperator
{
public:
  IsotropicScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, bool scatters)
    : TheDevice(device)
    , Layout(layout)
    , TheMedium(medium)
    , Scatters(scatters)
  {
  }

  Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const override
  {
    cl::Kernel kernel = this->Kernel("scatter_order");
    const auto [begin, end] = range;
    const std::size_t chunks = PartsOf<std::size_t>(end - begin, CollectChunk);
    const int channels = this->Layout.channels;
    Buffer<cl_float2> tally(this->TheDevice, chunks * channels, "sums");
    With(kernel, *swept.path, fluence, source, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), tally,
      cl_ulong(this->Layout.Stride()), cl_ulong(begin), cl_ulong(end), cl_int(this->Layout.sharedExtinction),
      static_cast<float>(1.0 / this->Layout.grid.VoxelVolume()));
    RunSummingGroups(this->TheDevice, kernel, chunks, channels);
    Powers powers;
    const std::vector<cl_float2> sums = tally.Read();
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      powers.absorbed[i / chunks] += sums[i].s[0];
      powers.scattered[i / chunks] += sums[i].s[1];
    }
    return powers;
  }

  bool CanScatterAllOrders() const override { return true; }

  void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const override
  {
    cl::Kernel kernel = this->Kernel("scatter_all_orders");
    With(kernel, fluence, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Values());
  }

  void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const override
  {
    cl::Kernel kernel = this->Kernel("add_first_scattered");
    With(kernel, *uncollided.path, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
    SetExact(this->TheDevice, kernel, 4, 4.0 * Pi * this->Layout.grid.VoxelVolume());
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Values());
  }

  /// Nothing to add: isotropic scattering has no separate source of beams.
  void AddBeam(const Buffer<float>&, const Buffer<float>&, int) const override {}

  void ScatterFluence(int channel, const Deposit&, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const override
  {
    cl::Kernel kernel = this->Kernel("scatter_fluence");
    With(kernel, fluence.Handle(), given, source, this->TheMedium.SigmaS(), cl_ulong(channel * this->Layout.Stride()));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Layout.grid.VoxelCount()));
  }

private:
  cl::Kernel Kernel(const char* name) const
  {
    return this->TheDevice.Kernel(name, kernel_source::IsotropicScattering,
      Define("REAL_WIDTH", this->TheDevice.KernelWidth(4, 8, 4)) + Define("SCATTERS", this->Scatters) +
        SummingOption(this->TheDevice) + ExactOption(this->TheDevice));
  }

  cl::NDRange Values() const { return cl::NDRange(this->Layout.Stride(), this->Layout.channels); }

  Device& TheDevice;
  VolumeLayout Layout;
  const MediumOnDevice& TheMedium;
  bool Scatters;
};

/// Anisotropic scattering in angular moments (AngularBasis.h): each moment of degree l is multiplied by the scattering
/// coefficient of that degree (numerics.md, Eq. (42a)). Array layout: MomentPlacesShared.h. The first moment is the
/// fluence and is scattered by IsotropicScattering.
class MomentScattering : public ScatteringOperator
{
public:
  MomentScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree)
    : TheDevice(device)
    , Layout(layout)
    , TheMedium(medium)
    , OfFluence(device, layout, medium, true)
    , Degree(degree)
    , Functions((degree + 1) * (degree + 1))
  {
  }

  Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const override
  {
    const Powers powers = this->OfFluence.ScatterOrder(swept, fluence, source, range);
    if (swept.flux)
    {
      AddFluxOfMoments(this->TheDevice, this->Layout, this->Functions, *swept.path, *swept.flux);
    }
    for (int c = 0; c < this->Layout.channels; ++c)
    {
      this->Scatter("scatter_moments", c, *swept.path, source);
    }
    return powers;
  }

  bool CanScatterAllOrders() const override { return false; } ///< no: moments of all orders are not stored

  void ScatterAllOrders(const Buffer<float>&, const Buffer<float>&) const override
  {
    throw std::logic_error("the moments of all orders are not kept");
  }

  void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const override
  {
    this->OfFluence.AddFirstScattered(uncollided, source);
    for (int c = 0; c < this->Layout.channels; ++c)
    {
      this->Scatter("add_scattered_moments", c, *uncollided.path, source);
    }
  }

  void AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const override
  {
    const std::size_t values = this->Layout.channels * this->Layout.Stride();
    cl::Kernel kernel = this->TheDevice.Kernel("scatter_beam", kernel_source::MomentScattering);
    With(kernel, this->Layout.Places(this->Functions), path, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(values),
      cl_int(beam), cl_int(this->Degree), this->PerPath());
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
    this->TheDevice.Finish(); // the caller releases `path`
  }

  void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const override
  {
    this->OfFluence.ScatterFluence(channel, swept, fluence, given, source);
    this->Scatter("scatter_given_moments", channel, *swept.path, given, source);
  }

private:
  /// Runs a kernel of MomentScattering.cl on a channel's moments except the first, one work-item per row of voxels.
  /// @param arrays  kernel arguments between the channel and the coefficients
  template <class... Arrays>
  void Scatter(const char* name, int channel, const Arrays&... arrays) const
  {
    cl::Kernel kernel = this->TheDevice.Kernel(name, kernel_source::MomentScattering);
    With(kernel, this->Layout.Places(this->Functions), cl_int(channel), arrays..., this->TheMedium.SigmaOfDegrees(),
      cl_ulong(this->Layout.Stride()), this->PerPath());
    const std::array<int, 3>& size = this->Layout.grid.size;
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
      cl::NDRange(static_cast<std::size_t>(size[1]) * size[2]), GroupOfLargeItems(this->TheDevice));
  }

  /// Factor from path integral, W length, to source, W / (length^3 sr), for a scattering coefficient of 1.
  float PerPath() const { return static_cast<float>(1.0 / (4.0 * Pi * this->Layout.grid.VoxelVolume())); }

  Device& TheDevice;
  VolumeLayout Layout;
  const MediumOnDevice& TheMedium;
  IsotropicScattering OfFluence;
  int Degree;
  int Functions;
};
}

std::unique_ptr<const ScatteringOperator> MakeScattering(
  Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree, bool scatters)
{
  if (degree > 0)
  {
    return std::make_unique<MomentScattering>(device, layout, medium, degree);
  }
  return std::make_unique<IsotropicScattering>(device, layout, medium, scatters);
}

void AddMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& to)
{
  const MomentPlaces places = layout.Places(functions);
  cl::Kernel kernel = device.Kernel("add_moments", kernel_source::MomentScattering);
  With(kernel, places, path, to);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(places.beams - places.second));
}

void AddToShown(Device& device, std::size_t values, const Buffer<float>& source, const Buffer<float>& shown, float part)
{
  cl::Kernel kernel = device.Kernel("add_to_shown", kernel_source::MomentScattering);
  With(kernel, source, shown, part);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
}

void AddFluxOfMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& flux)
{
  const std::array<int, 3>& size = layout.grid.size;
  for (int c = 0; c < layout.channels; ++c)
  {
    cl::Kernel kernel = device.Kernel("add_flux_of_moments", kernel_source::MomentScattering);
    With(kernel, layout.Places(functions), cl_int(c), path, flux, cl_ulong(layout.Stride()));
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2]));
  }
}
}
