// I3RC's step cloud: light that goes from one column into the next, scattered forwards.

#include "DeviceTest.h"
#include "StepCloud.h"

using namespace tyndall;

class StepCloud : public DeviceTest
{
protected:
  void ExpectColumns(int number, double ofColumns, double ofMean)
  {
    const step_cloud::Experiment experiment = step_cloud::ExperimentOf(number);
    Scene scene = step_cloud::SceneOf(experiment, { 4, 32 });
    scene.settings.angularDegree = 5;
    scene.settings.directionsPerFace = 36;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
    const step_cloud::Found found = step_cloud::FoundIn(light, scene.medium.grid, experiment.sunFromZenith);
    EXPECT_LT(found.leastSure, 2e-3) << "net flux of voxels, continued to the faces, is not the power through them";
    const step_cloud::Errors errors = step_cloud::ErrorsOf(found, experiment);
    EXPECT_LT(errors.columnReflected, ofColumns);
    EXPECT_LT(errors.columnTransmitted, ofColumns);
    EXPECT_NEAR(errors.meanReflected, 0.0, ofMean);
    EXPECT_NEAR(errors.meanTransmitted, 0.0, ofMean);
  }
};

TEST_F(StepCloud, IsLitFromAboveAsTheConsensusSays)
{
  this->ExpectColumns(1, 0.01, 0.003);
}

TEST_F(StepCloud, IsLitAslantAsTheConsensusSays)
{
  this->ExpectColumns(2, 0.01, 0.003);
}

TEST_F(StepCloud, AbsorbsUnderASunAboveAsMonteCarloSays)
{
  this->ExpectColumns(3, 0.01, 0.003);
}

TEST_F(StepCloud, AbsorbsUnderALowSunAsTheConsensusSays)
{
  this->ExpectColumns(4, 0.01, 0.003);
}
