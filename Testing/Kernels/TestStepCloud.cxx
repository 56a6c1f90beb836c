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
    scene.settings.directionsPerFace = 36;
    scene.settings.staggeredRays = true;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
    return step_cloud::ErrorsOf(step_cloud::FoundIn(light, scene.medium.grid, experiment.sunFromZenith), experiment);
  }

  void ExpectLight(int number, double ofReflected, double ofTransmitted)
  {
    const step_cloud::Errors errors = this->ErrorsWith(5, number);
    EXPECT_LT(errors.columnReflected, ofReflected);
    EXPECT_LT(errors.columnTransmitted, ofTransmitted);
    EXPECT_NEAR(errors.meanReflected, 0.0, 4e-3);
    EXPECT_NEAR(errors.meanTransmitted, 0.0, 4e-3);
  }
};

// Of columns the worst are those beside the step: what degree 5 lets go straight on does not spread into the next one,
// and under a low sun the light of the thick half's edge is not followed between a voxel's middle and the face.
TEST_F(StepCloud, IsLitFromAboveAsTheConsensusSays)
{
  this->ExpectLight(1, 0.025, 0.05);
}

TEST_F(StepCloud, IsLitAslantAsTheConsensusSays)
{
  this->ExpectLight(2, 0.13, 0.05);
}

TEST_F(StepCloud, AbsorbsUnderASunAboveAsMonteCarloSays)
{
  this->ExpectLight(3, 0.025, 0.05);
}

TEST_F(StepCloud, AbsorbsUnderALowSunAsTheConsensusSays)
{
  this->ExpectLight(4, 0.14, 0.05);
}

TEST_F(StepCloud, IsWrongBySimilarity)
{
  const step_cloud::Errors errors = this->ErrorsWith(0, 1);
  EXPECT_GT(errors.columnTransmitted, 0.05);
  EXPECT_GT(errors.meanReflected, 4e-3);
}
