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
TEST_F(LinearSource, Plain)
{
  for (int per : {25, 100}) for (bool a : { false, true }) for (double tau : { 1e-6, 1.0, 5.0 }) for (double w : { 0.9 })
  {
    Scene scene({ 32, 32, 32 }, static_cast<float>(tau / 32 * (1 - w)), static_cast<float>(tau / 32 * w));
    scene.settings.source = a ? PropagationSource::Linear : PropagationSource::Constant;
    scene.settings.acceleration = a ? PropagationAcceleration::Automatic : PropagationAcceleration::None;
    scene.settings.directionsPerFace = per;
    scene.light.faces[4] = { 1, 1, 1 };
    const auto l = scene.Solve(this->GetDevice()); const double in = l.balance.entered[0]; const auto& o = l.facePowerOut;
    std::printf("%d %d %g,%g R %.6f T %.6f S %.6f A %.6f sweeps %zu bal %.1e seconds %.3f\n", per, a, tau, w, o[4][0]/in, o[5][0]/in, (o[0][0]+o[1][0]+o[2][0]+o[3][0])/in, l.balance.absorbed[0]/in, l.convergence.size(), l.balance.RelativeError(1), l.convergence.back().seconds);
  }
}
TEST_F(LinearSource, Absorbing)
{
  struct Row { double tau, w, R, T; };
  for (Row row : { Row{1,0.9,3.52712040e-01,4.74745855e-01}, Row{5,.9,4.76338493e-01,5.34214494e-02}, Row{10,.99,7.85324130e-01,6.64331966e-02}, Row{100,.99,7.94563653e-01,1.17773514e-08}, Row{100,.999,9.29711087e-01,5.66953603e-04}, Row{1000,.9999,0.977156,0} , Row{100,.9,4.78024489e-01,0}, Row{100,.5,1.46544381e-01,0}})
  {
    Scene scene({ 1, 1, 32 }, static_cast<float>(row.tau / 32 * (1 - row.w)), static_cast<float>(row.tau / 32 * row.w));
    scene.settings.periodic = { true, true, false };
    scene.settings.directionsPerFace = 100;
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    const LightField light = scene.Solve(this->GetDevice());
    const double in = light.balance.entered[0];
    std::printf("tau %g w %g R %.6e (%.6e) T %.6e (%.6e) sweeps %zu\n", row.tau, row.w, light.facePowerOut[4][0] / in, row.R, light.facePowerOut[5][0] / in, row.T, light.convergence.size());
  }
  for (Row row : { Row{1,1,3.41328760e-01,6.58671240e-01}, Row{10,1,8.53004619e-01,1.46995381e-01}, Row{100,1,9.83446949e-01,1.65530509e-02}, Row{1000,1,9.98323557e-01,1.67644300e-03}})
  {
    Scene scene({ 1, 1, 32 }, static_cast<float>(row.tau / 32 * (1 - row.w)), static_cast<float>(row.tau / 32 * row.w));
    scene.settings.periodic = { true, true, false };
    scene.settings.directionsPerFace = 100;
    scene.settings.source = PropagationSource::Linear;
    scene.ShineAlong({ 0, 0, 1 }, 1);
    const LightField light = scene.Solve(this->GetDevice());
    const double in = light.balance.entered[0];
    std::printf("beam tau %g w %g R %.6e (%.6e) T %.6e (%.6e) sweeps %zu bal %.1e\n", row.tau, row.w, light.facePowerOut[4][0] / in, row.R, light.facePowerOut[5][0] / in, row.T, light.convergence.size(), light.balance.RelativeError(1));
  }
}
TEST_F(LinearSource, ConstantIsTheSweeps)
{
  for (double tau : { 3.0, 20.0 , 60.0})
  {
    Scene scene({ 12, 11, 10 });
    scene.Randomise(tau, 2, 0.99);
    scene.ShineFromEverywhere(1);
    scene.settings.tolerance = 1e-6;
    scene.ShineAlong({ 0.3, -0.5, -0.8 }, 2.0);
    scene.settings.source = PropagationSource::Constant;
    scene.settings.acceleration = PropagationAcceleration::None;
    const auto a = scene.Solve(this->GetDevice());
    scene.settings.acceleration = PropagationAcceleration::Automatic;
    const auto b = scene.Solve(this->GetDevice());
    double worst = 0; for (size_t i = 0; i < a.fluence.size(); ++i) worst = std::max(worst, std::abs(a.fluence[i] / b.fluence[i] - 1.));
    double worstd = 0; for (size_t i = 0; i < a.fluence.size(); ++i) worstd = std::max(worstd, std::abs(a.fluenceDirect[i] / b.fluenceDirect[i] - 1.));
    std::printf("tau %g worst %.2e direct %.2e orders %zu sweeps %zu  absorbed %.6f %.6f escaped %.6f %.6f balance %.1e %.1e\n", tau, worst, worstd, a.convergence.size(), b.convergence.size(), a.balance.absorbed[0], b.balance.absorbed[0], a.balance.escaped[0], b.balance.escaped[0], a.balance.RelativeError(1), b.balance.RelativeError(1));
    for (int f = 0; f < 6; ++f) std::printf("  %.5f %.5f", a.facePowerOut[f][0], b.facePowerOut[f][0]);
    std::printf("\n");
  for (auto& r : b.convergence) std::printf("   %d %.2e %.2e %.2f s\n", r.iteration, r.change, r.residual, r.seconds);
  }
}
