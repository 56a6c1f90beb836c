// I3RC's step cloud: light that goes from one column into the next, scattered forwards.

#include "DeviceTest.h"
#include "StepCloud.h"

using namespace tyndall;

class StepCloud : public DeviceTest
{
protected:
  /// @param degree  of angular moments
  step_cloud::Errors ErrorsWith(int degree, int number)
  {
    const step_cloud::Experiment experiment = step_cloud::ExperimentOf(number);
    Scene scene = step_cloud::SceneOf(experiment, { 2, 32 });
    scene.settings.angularDegree = degree;
    scene.settings.directionsPerFace = 64;
    scene.settings.staggeredRays = true;
    scene.settings.mapResolution = 2; // a column's power is that of few rays
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
    return step_cloud::ErrorsOf(step_cloud::FoundIn(light, scene.medium.grid, experiment.sunFromZenith), experiment);
  }

  void ExpectLight(int number, double ofReflected, double ofTransmitted)
  {
    const step_cloud::Errors errors = this->ErrorsWith(7, number);
    EXPECT_LT(errors.columnReflected, ofReflected);
    EXPECT_LT(errors.columnTransmitted, ofTransmitted);
    EXPECT_NEAR(errors.meanReflected, 0.0, 3e-3);
    EXPECT_NEAR(errors.meanTransmitted, 0.0, 3e-3);
  }
};

// Of columns the worst are those beside the step: what degree 7 lets go straight on does not spread into the next one.
TEST_F(StepCloud, IsLitFromAboveAsTheConsensusSays)
{
  this->ExpectLight(1, 0.015, 0.025);
}

TEST_F(StepCloud, IsLitAslantAsTheConsensusSays)
{
  this->ExpectLight(2, 0.022, 0.01);
}

TEST_F(StepCloud, AbsorbsUnderASunAboveAsMonteCarloSays)
{
  this->ExpectLight(3, 0.01, 0.025);
}

TEST_F(StepCloud, AbsorbsUnderALowSunAsTheConsensusSays)
{
  this->ExpectLight(4, 0.025, 0.022);
}

TEST_F(StepCloud, IsWrongBySimilarity)
{
  const step_cloud::Errors errors = this->ErrorsWith(0, 1);
  EXPECT_GT(errors.columnTransmitted, 0.05);
  EXPECT_GT(errors.meanReflected, 4e-3);
}
