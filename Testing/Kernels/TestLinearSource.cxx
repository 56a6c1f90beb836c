#include "DeviceTest.h"
#include "MediumScene.h"
#include <cstdio>
using namespace tyndall;
class LinearSource : public DeviceTest {};
namespace
{
void Print(const char* name, const Scene& scene, const LightField& light)
{
  float least = 1e30f, most = -1e30f;
  for (float f : light.fluence) { least = std::min(least, f); most = std::max(most, f); }
  const auto n = scene.medium.grid.size;
  double mid = 0;
  for (int z : { n[2] / 2 - 1, n[2] / 2 }) for (int y : { n[1] / 2 - 1, n[1] / 2 }) for (int x : { n[0] / 2 - 1, n[0] / 2 })
    mid += light.fluence[(static_cast<size_t>(z) * n[1] + y) * n[0] + x] / 8;
  const double in = light.balance.entered[0];
  std::printf("%s centre/4pi %.7f (6x-1 %.2e) min %.3e max %.6e R %.5f T %.6f sweeps %zu residual %.1e balance %.1e seconds %.2f\n", name, mid / 12.566370614,
    6 * mid / 12.566370614 - 1, least, most, light.facePowerOut[4][0] / in, light.facePowerOut[5][0] / in, light.convergence.size(),
    light.convergence.back().residual, light.balance.RelativeError(1), light.convergence.back().seconds);
  for (auto& r : light.convergence) std::printf("   %d %.2e %.2e %.2f s\n", r.iteration, r.change, r.residual, r.seconds);
  std::fflush(stdout);
}
}
TEST_F(LinearSource, Cube)
{
  for (double tau : { 1e-6, 1.0, 10.0, 100.0, 1e4 })
  {
    Scene scene({ 32, 32, 32 }, 0.0f, static_cast<float>(tau / 32));
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    Print(("cube " + std::to_string(tau)).c_str(), scene, scene.Solve(this->GetDevice()));
  }
}
TEST_F(LinearSource, All)
{
    Scene scene({ 24, 24, 24 });
    scene.Randomise(1e4, 8, 1.0);
    for (size_t i = 0; i < scene.sigma_s.size(); i += 5) scene.sigma_s[i] = 0;
    scene.settings.tolerance = 1e-6;
    scene.settings.source = PropagationSource::Linear;
    scene.ShineFromEverywhere(1.0);
    const auto l = scene.Solve(this->GetDevice());
    Print("all", scene, l);
    double worst = 0; for (float f : l.fluence) worst = std::max(worst, std::abs(f / 12.566370614359 - 1)); std::printf("worst %.2e\n", worst);
}
TEST_F(LinearSource, Duct)
{
    Scene scene({ 32, 32, 32 }, 0.0f, 100.0f / 32);
    for (size_t i = 0; i < scene.sigma_s.size(); ++i) { int x = i % 32, y = i / 32 % 32; if (x >= 12 && x < 20 && y >= 12 && y < 20) scene.sigma_s[i] = 0; }
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    Print("duct", scene, scene.Solve(this->GetDevice()));
}
TEST_F(LinearSource, Checker)
{
  for (double w : {1.0, 0.99}) {
    Scene scene({ 32, 32, 32 });
    for (size_t i = 0; i < scene.sigma_s.size(); ++i) { int x = i % 32, y = i / 32 % 32, z = i / 1024; float s = (x + y + z) & 1 ? 1e4 : 1e-4; scene.sigma_s[i] = s * w; scene.sigma_a[i] = s * (1 - w);}
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    Print("checker", scene, scene.Solve(this->GetDevice()));
  }
}
TEST_F(LinearSource, Slab)
{
  for (double tau : { 0.01, 1.0, 10.0, 1e6 })
  {
    Scene scene({ 1, 1, 32 }, 0.0f, static_cast<float>(tau / 32));
    scene.settings.periodic = { true, true, false };
    scene.settings.directionsPerFace = 100;
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    const LightField light = scene.Solve(this->GetDevice());
    std::printf("tau %g exact %.6e\n", tau, 4 / (3 * (tau + 1.4208922)));
    Print("slab", scene, light);
  }
}
TEST_F(LinearSource, Cloud)
{
  for (double w : {1.0, 0.999}) {
    Scene scene({ 32, 32, 32 });
    std::mt19937 random(1); std::normal_distribution<double> nd; std::vector<double> f(scene.sigma_s.size()); for (auto& x : f) x = nd(random);
    const int n = 32; for (int it = 0; it < 3; ++it) { auto o = f; for (size_t i = 0; i < f.size(); ++i) { int x = i % n, y = i / n % n, z = i / n / n; double s = 0; for (int d = -1; d <= 1; ++d) s += o[(z * n + y) * n + (x + d + n) % n] + o[(z * n + (y + d + n) % n) * n + x] + o[(((z + d + n) % n) * n + y) * n + x]; f[i] = s / 9; } }
    const auto [lo, hi] = std::minmax_element(f.begin(), f.end());
    for (size_t i = 0; i < f.size(); ++i) { double s = std::pow(10., -4 + 8 * (f[i] - *lo) / (*hi - *lo)); scene.sigma_s[i] = s * w; scene.sigma_a[i] = s * (1 - w); }
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    Print("cloud", scene, scene.Solve(this->GetDevice()));
  }
}
TEST_F(LinearSource, Monte)
{
  for (double tau : { 1.0, 5.0, 10.0, 50.0 }) for (double w : { 0.9, 1.0 })
  {
    Scene scene({ 32, 32, 32 }, static_cast<float>(tau / 32 * (1 - w)), static_cast<float>(tau / 32 * w));
    scene.settings.source = PropagationSource::Linear;
    scene.settings.directionsPerFace = 100;
    scene.light.faces[4] = { 1, 1, 1 };
    const auto l = scene.Solve(this->GetDevice()); const double in = l.balance.entered[0]; const auto& o = l.facePowerOut;
    std::printf("%g,%g R %.6f T %.6f S %.6f A %.6f sweeps %zu\n", tau, w, o[4][0]/in, o[5][0]/in, (o[0][0]+o[1][0]+o[2][0]+o[3][0])/in, l.balance.absorbed[0]/in, l.convergence.size());
  }
}
