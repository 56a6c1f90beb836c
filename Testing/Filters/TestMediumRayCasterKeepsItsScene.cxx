#include "MediumScene.h"

#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace
{
vtkSmartPointer<vtkImageData> Medium(const std::array<int, 3>& cells = { 12, 10, 8 })
{
  auto image = test::MakeMedium({ cells }, 0.05, 0.2);
  test::AddValues<vtkFloatArray>(image->GetCellData(), "fluence", image->GetNumberOfCells(), 1,
    [](vtkIdType cell, int) { return 2.0 + std::sin(0.37 * cell); });
  test::AddCells(image, "fluence_direct", 0.7);
  test::AddCells(image, "mean_direction", 0.5, 3);
  test::AddValues<vtkDoubleArray>(image->GetFieldData(), "g", 1, 1, [](vtkIdType, int) { return 0.6; });
  return image;
}

/// Latitude-longitude image with a mark, to see which way it is turned.
vtkSmartPointer<vtkImageData> Environment()
{
  auto environment = vtkSmartPointer<vtkImageData>::New();
  environment->SetDimensions(16, 8, 1);
  test::AddValues<vtkFloatArray>(
    environment->GetPointData(), "radiance", 128, 3, [](vtkIdType pixel, int) { return 0.1 * (pixel % 16); });
  return environment;
}

/// A caster of lights and an environment, and how to make another one like it.
struct Pictures
{
  vtkSmartPointer<vtkImageData> medium = Medium();
  vtkSmartPointer<vtkImageData> environment = Environment();
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkMediumRayCaster> caster;

  Pictures() { this->Connect(this->caster); }

  void Connect(vtkMediumRayCaster* to)
  {
    to->SetInputData(this->medium);
    to->SetLightsConnection(this->rig->GetOutputPort());
    to->SetEnvironmentData(this->environment);
    to->SetImageSize(24, 18);
    to->SetExposure(1.0);
  }

  static std::vector<double> Radiance(vtkMediumRayCaster* of)
  {
    of->Update();
    vtkDataArray* pixels = of->GetOutput()->GetPointData()->GetArray("radiance");
    std::vector<double> values;
    for (vtkIdType i = 0; pixels && i < pixels->GetNumberOfTuples(); ++i)
    {
      values.insert(values.end(), pixels->GetTuple(i), pixels->GetTuple(i) + 3);
    }
    return values;
  }
};

using Change = std::function<void(vtkMediumRayCaster*)>;

/// After a change the picture is that of a filter which has never made another one.
class Follows
{
public:
  explicit Follows(test::Claims& claims)
    : TheClaims(claims)
  {
  }

  /// @param change   what happens to the inputs
  /// @param setting  what happens to the filter
  void A(const std::string& what, bool keeps, const std::function<void(Pictures&)>& change, const Change& setting = {},
    const Change& before = {})
  {
    Pictures pictures;
    if (before)
    {
      before(pictures.caster);
    }
    const std::vector<double> first = Pictures::Radiance(pictures.caster);
    change(pictures);
    if (setting)
    {
      setting(pictures.caster);
    }
    const std::vector<double> found = Pictures::Radiance(pictures.caster);
    vtkNew<vtkMediumRayCaster> fresh;
    pictures.Connect(fresh);
    for (const Change& each : { before, setting })
    {
      if (each)
      {
        each(fresh);
      }
    }
    const std::vector<double> expected = Pictures::Radiance(fresh);
    this->TheClaims.That(!found.empty() && found == expected, "the picture follows " + what);
    this->TheClaims.That(found != first, what + " is seen");
    this->TheClaims.That(
      pictures.caster->GetSceneKept() == keeps, what + (keeps ? " keeps" : " replaces") + " the scene");
    this->TheClaims.That(!fresh->GetSceneKept(), "a first picture keeps nothing");
  }

private:
  test::Claims& TheClaims;
};

const auto Nothing = [](Pictures&) {};

void WhatTheSceneDoesNotNeedKeepsIt(Follows follows)
{
  const auto move = [](vtkMediumRayCaster* caster) { caster->SetCameraPosition(40.0, 30.0, 9.0); };
  follows.A("a move of the camera", true, Nothing, move);
  follows.A(
    "a move beside shadow rays", true, Nothing, move, [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); });
  follows.A("the size of the picture", true, Nothing, [](vtkMediumRayCaster* caster) { caster->SetImageSize(30, 20); });
  follows.A("the step", true, Nothing, [](vtkMediumRayCaster* caster) { caster->SetStepSize(0.9); });
  follows.A("lights alone, and then a move", true, Nothing, move,
    [](vtkMediumRayCaster* caster) { caster->SetInputArrayToProcess(3, 0, 0, 1, "no such array"); });
}

void WhatIsChangedIsSeen(Follows follows)
{
  const auto change = [](const char* name, bool tellArray) {
    return [=](Pictures& pictures) {
      auto* array = vtkArrayDownCast<vtkFloatArray>(pictures.medium->GetCellData()->GetArray(name));
      std::transform(array->GetPointer(0), array->GetPointer(array->GetNumberOfValues()), array->GetPointer(0),
        [](float value) { return -0.5f * value + 1.5f; });
      tellArray ? array->Modified() : pictures.medium->Modified();
    };
  };
  follows.A("fluence changed in place", false, change("fluence", true));
  follows.A("fluence changed in place, and the image told", false, change("fluence", false));
  follows.A("sigma_s changed in place", false, change("sigma_s", true));
  follows.A("another fluence", false, [](Pictures& pictures) { test::AddCells(pictures.medium, "fluence", 3.0); });
  follows.A("another medium", false, [](Pictures& pictures) {
    pictures.medium = Medium({ 6, 12, 12 });
    pictures.caster->SetInputData(pictures.medium);
  });
  follows.A("another spacing", false, [](Pictures& pictures) { pictures.medium->SetSpacing(2.0, 1.0, 1.0); });
  const Change shadows = [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); };
  follows.A(
    "brighter lights", false, [](Pictures& pictures) { pictures.rig->SetSunPower(9.0, 1.0, 1.0); }, {}, shadows);
  follows.A(
    "lights taken away", false, [](Pictures& pictures) { pictures.caster->RemoveLights(); },
    [](vtkMediumRayCaster* caster) { caster->RemoveLights(); }, shadows);
  follows.A(
    "g", false,
    [](Pictures& pictures) {
      pictures.medium->GetFieldData()->GetArray("g")->SetComponent(0, 0, -0.5);
      pictures.medium->GetFieldData()->GetArray("g")->Modified();
    },
    {}, shadows);
  follows.A("the environment's pixels", false, [](Pictures& pictures) {
    pictures.environment->GetPointData()->GetArray("radiance")->Fill(0.4);
    pictures.environment->GetPointData()->GetArray("radiance")->Modified();
  });
  follows.A(
    "the environment's turn", false, Nothing, [](vtkMediumRayCaster* caster) { caster->SetEnvironmentAzimuth(90.0); });
}

void SettingsThatNeedAnotherSceneGetOne(Follows follows)
{
  follows.A(
    "SingleScatteringOnly", false, Nothing, [](vtkMediumRayCaster* caster) { caster->SingleScatteringOnlyOn(); });
  follows.A("ShadowRays", false, Nothing, [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); });
  follows.A("ShowBackground", false, Nothing, [](vtkMediumRayCaster* caster) { caster->ShowBackgroundOff(); });
  follows.A("another array", false, Nothing,
    [](vtkMediumRayCaster* caster) { caster->SetInputArrayToProcess(3, 0, 0, 1, "fluence_direct"); });
}

/// Memory of this process, bytes; 0 where the system does not tell.
double ResidentBytes()
{
  std::ifstream status("/proc/self/statm");
  double pages = 0.0;
  status >> pages >> pages;
  return 4096.0 * pages;
}

void MemoryIsGivenBack(test::Claims& claims)
{
  const auto given = [&](const char* when, const std::function<void(vtkSmartPointer<vtkMediumRayCaster>&)>& end) {
    const auto image = Medium({ 160, 160, 160 }); // 16 bytes a voxel on the device: 65 MB
    auto caster = vtkSmartPointer<vtkMediumRayCaster>::New();
    caster->SetDevice("pthread"); // PoCL's, whose memory is that of the process
    caster->SetImageSize(8, 8);
    caster->SetInputData(image);
    test::Errors errors(caster);
    caster->Update();
    if (!errors.None() || ResidentBytes() == 0.0)
    {
      return; // there is no PoCL here
    }
    const double kept = ResidentBytes();
    end(caster);
    claims.That(kept - ResidentBytes() > 60e6, std::string("memory of the device is given back when ") + when);
  };
  given("the filter goes", [](auto& caster) { caster = nullptr; });
  given("the input goes", [](auto& caster) { caster->SetInputConnection(0, nullptr); });
  given("the input changes, before the filters before run", [](auto& caster) {
    caster->GetInput()->Modified();
    caster->PropagateUpdateExtent();
  });
}
}

int TestMediumRayCasterKeepsItsScene(int, char*[])
{
  if (!test::HasDevice())
  {
    return test::SkippedWithoutDevice("nothing was solved");
  }
  test::Claims claims;
  WhatTheSceneDoesNotNeedKeepsIt(Follows(claims));
  WhatIsChangedIsSeen(Follows(claims));
  SettingsThatNeedAnotherSceneGetOne(Follows(claims));
  MemoryIsGivenBack(claims);
  return claims.Result();
}
