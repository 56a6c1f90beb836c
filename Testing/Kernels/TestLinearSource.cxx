#include "DeviceTest.h"
#include "MediumScene.h"
#include <cstdio>
using namespace tyndall;
class LinearSource : public DeviceTest {};
TEST_F(LinearSource, Try)
{
  for (double tau : { 0.01, 1.0, 10.0, 30.0, 100.0, 1e3, 1e6 })
  {
    Scene scene({ 1, 1, 32 }, 0.0f, static_cast<float>(tau / 32));
    scene.settings.periodic = { true, true, false };
    scene.settings.directionsPerFace = 100;
    scene.settings.source = PropagationSource::Linear;
    scene.light.faces[4] = { 1, 1, 1 };
    const LightField light = scene.Solve(this->GetDevice());
    const double in = light.balance.entered[0];
    std::printf("tau %g T %.6e R %.6e R+T-1 %.1e exact %.6e rows %zu residual %.1e balance %.1e\n", tau, light.facePowerOut[5][0] / in,
      light.facePowerOut[4][0] / in, (light.facePowerOut[5][0] + light.facePowerOut[4][0]) / in - 1, 4 / (3 * (tau + 1.4208922)),
      light.convergence.size(), light.convergence.back().residual, light.balance.RelativeError(1));
    for (auto& r : light.convergence) std::printf("   %d %.2e %.2e\n", r.iteration, r.change, r.residual);
  }
}
