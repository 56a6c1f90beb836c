// Cosines that photons draw have the moments of the phase function.

#include "DeviceTest.h"
#include "MediumScene.h"

#include "Device/Device.h"
#include "Numerics/Legendre.h"
#include "Photons/Scattering/PhotonScattering.h"
#include "TyndallKernelSources.h"

#include <cmath>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Draws = 1 << 20;

PhaseFunction Glory()
{
  return PhaseFunction::Tabulated(
    { -1.0, -0.98, -0.6, 0.0, 0.5, 0.9, 0.99, 1.0 }, { 0.4, 0.1, 0.02, 0.05, 0.2, 1.0, 20.0, 90.0 });
}
}

class SampledPhaseTest : public DeviceTest
{
protected:
  std::vector<float> Draw(const Medium& medium, cl_ulong voxel = 0)
  {
    Device& device = this->GetDevice();
    const SampledPhase phase(device, medium);
    const std::string source = std::string(kernel_source::ScatterPhotons.data()) +
      "__kernel void cosines(const __global float* phase, ulong voxel, __global float* out)"
      "{ random_numbers random = random_of(11, get_global_id(0)); const scattering medium = { 0, phase };"
      "  out[get_global_id(0)] = cosine_of(&medium, voxel, draw(&random)); }";
    cl::Kernel kernel = device.Kernel("cosines", source,
      phase.options + Define("CHANNELS", 1) + Define("MEDIUM_CHANNELS", 1) + Define("DIRECTIONS", 1) +
        Define("GATHERS", 0) + Define("ORDER", 2) + Define("BENDS", 0) + Define("LEVELS", 0) + Define("ATOMICS", 0) +
        Define("WORKERS", 1) + Define("BLOCK", 1) + Define("REAL_WIDTH", 1));
    Buffer<float> out(device, Draws, "cosines");
    With(kernel, phase.values, voxel, out);
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(Draws));
    return out.Read();
  }

  void HasMoments(const std::vector<float>& cosines, const PhaseFunction& function, const std::string& name)
  {
    const std::vector<double> exact = function.Moments(8);
    std::vector<double> sums(9, 0.0), squares(9, 0.0);
    for (float cosine : cosines)
    {
      ASSERT_LE(std::abs(cosine), 1.0f + 1e-5f) << name;
      const std::vector<double> p = LegendrePolynomials(8, cosine);
      for (std::size_t l = 0; l < p.size(); ++l)
      {
        sums[l] += p[l] / Draws;
        squares[l] += p[l] * p[l] / Draws;
      }
    }
    for (std::size_t l = 1; l < exact.size(); ++l)
    {
      const double error = std::sqrt((squares[l] - sums[l] * sums[l]) / Draws);
      EXPECT_NEAR(sums[l], exact[l], 4.0 * error + 1e-6) << name << " degree " << l;
    }
  }
};

TEST_F(SampledPhaseTest, HasTheMomentsOfItsFunction)
{
  Scene scene({ 2, 1, 1 }, 0.0f, 1.0f);
  scene.Attach();
  const std::vector<std::pair<std::string, PhaseFunction>> functions = { { "isotropic", PhaseFunction() },
    { "g 0.85", PhaseFunction::HenyeyGreenstein(0.85) }, { "g -0.5", PhaseFunction::HenyeyGreenstein(-0.5) },
    { "g 1e-4", PhaseFunction::HenyeyGreenstein(1e-4) }, { "g 0.99", PhaseFunction::HenyeyGreenstein(0.99) },
    { "Schlick", PhaseFunction::Schlick(0.6) }, { "Rayleigh", PhaseFunction::Rayleigh() },
    { "double", PhaseFunction::DoubleHenyeyGreenstein(0.9, -0.4, 0.7) }, { "table", Glory() } };
  for (const auto& [name, function] : functions)
  {
    scene.medium.phase = function;
    this->HasMoments(this->Draw(scene.medium), function, name);
  }
}

TEST_F(SampledPhaseTest, VariesByVoxel)
{
  Scene scene({ 2, 1, 1 }, 0.0f, 1.0f);
  scene.Attach();
  const std::vector<float> g = { 0.2f, -0.7f };
  for (const PhaseFunction& kind : { PhaseFunction::HenyeyGreenstein(0.1), PhaseFunction::Schlick(0.1) })
  {
    scene.medium.phase = PhaseOfMedium(kind, { g.data(), 1 });
    for (cl_ulong voxel = 0; voxel < 2; ++voxel)
    {
      this->HasMoments(this->Draw(scene.medium, voxel), kind.WithMeanCosine(g[voxel]), "voxel");
    }
  }
}
