#include "MediumScene.h"

#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace
{
vtkSmartPointer<vtkImageData> Medium(const std::array<int, 3>& cells = { 12, 10, 8 })
{
  auto image = test::MakeMedium({ cells }, 0.05, 0.2);
  test::AddValues<vtkFloatArray>(image->GetCellData(), "fluence", image->GetNumberOfCells(), 1,
    [](vtkIdType cell, int) { return 2.0 + std::sin(0.37 * cell); });
  test::AddCells(image, "fluence_direct", 0.7);
  test::AddValues<vtkFloatArray>(image->GetCellData(), "mean_direction", image->GetNumberOfCells(), 3,
    [](vtkIdType, int c) { return c == 2 ? -0.5 : 0.5; }); // downwards, onto the table
  test::AddValues<vtkFloatArray>(image->GetCellData(), "ior", image->GetNumberOfCells(), 1, [=](vtkIdType cell, int) {
    const double x = cell % cells[0] - 0.5 * cells[0];
    const double y = cell / cells[0] % cells[1] - 0.5 * cells[1];
    const double z = cell / (cells[0] * cells[1]) - 0.5 * cells[2];
    return 1.0 + 0.25 * std::erfc(std::sqrt(x * x + y * y + z * z) - 3.0);
  });
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

enum class Scene
{
  Kept,
  Replaced,
  Either
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
  void A(const std::string& what, Scene scene, const std::function<void(Pictures&)>& change, const Change& setting = {},
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
    if (scene != Scene::Either)
    {
      const bool keeps = scene == Scene::Kept;
      this->TheClaims.That(
        pictures.caster->GetSceneKept() == keeps, what + (keeps ? " keeps" : " replaces") + " the scene");
    }
    this->TheClaims.That(!fresh->GetSceneKept(), "a first picture keeps nothing");
  }

private:
  test::Claims& TheClaims;
};

const auto Nothing = [](Pictures&) {};

void WhatTheSceneDoesNotNeedKeepsIt(Follows follows)
{
  const auto move = [](vtkMediumRayCaster* caster) { caster->SetCameraPosition(40.0, 30.0, 9.0); };
  follows.A("a move of the camera", Scene::Kept, Nothing, move);
  follows.A("a move beside shadow rays", Scene::Kept, Nothing, move,
    [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); });
  follows.A(
    "the size of the picture", Scene::Kept, Nothing, [](vtkMediumRayCaster* caster) { caster->SetImageSize(30, 20); });
  follows.A("the step", Scene::Kept, Nothing, [](vtkMediumRayCaster* caster) { caster->SetStepSize(0.9); });
  follows.A("lights alone, and then a move", Scene::Kept, Nothing, move, [](vtkMediumRayCaster* caster) {
    vtkImageData::SafeDownCast(caster->GetInputDataObject(0, 0))->GetCellData()->RemoveArray("fluence");
  });
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
  follows.A("fluence changed in place", Scene::Replaced, change("fluence", true));
  follows.A("fluence changed in place, and the image told", Scene::Replaced, change("fluence", false));
  follows.A("sigma_s changed in place", Scene::Replaced, change("sigma_s", true));
  follows.A("ior changed in place", Scene::Replaced, [](Pictures& pictures) {
    vtkDataArray* ior = pictures.medium->GetCellData()->GetArray("ior");
    ior->SetComponent(12 * 10 * 4 + 12 * 5 + 6, 0, 1.3);
    ior->Modified();
  });
  follows.A("mean_direction changed in place", Scene::Replaced, [](Pictures& pictures) {
    vtkDataArray* direction = pictures.medium->GetCellData()->GetArray("mean_direction");
    direction->FillComponent(1, -0.5);
    direction->Modified();
  });
  follows.A(
    "another fluence", Scene::Replaced, [](Pictures& pictures) { test::AddCells(pictures.medium, "fluence", 3.0); });
  follows.A("another medium", Scene::Replaced, [](Pictures& pictures) {
    pictures.medium = Medium({ 6, 12, 12 });
    pictures.caster->SetInputData(pictures.medium);
  });
  follows.A("another spacing", Scene::Replaced, [](Pictures& pictures) { pictures.medium->SetSpacing(2.0, 1.0, 1.0); });
  const Change shadows = [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); };
  follows.A(
    "brighter lights", Scene::Replaced, [](Pictures& pictures) { pictures.rig->SetSunPower(9.0, 1.0, 1.0); }, {},
    shadows);
  follows.A(
    "lights taken away", Scene::Replaced, [](Pictures& pictures) { pictures.caster->RemoveLights(); },
    [](vtkMediumRayCaster* caster) { caster->RemoveLights(); }, shadows);
  follows.A("the environment's pixels", Scene::Replaced, [](Pictures& pictures) {
    pictures.environment->GetPointData()->GetArray("radiance")->Fill(0.4);
    pictures.environment->GetPointData()->GetArray("radiance")->Modified();
  });
  follows.A("the environment's turn", Scene::Replaced, Nothing,
    [](vtkMediumRayCaster* caster) { caster->SetEnvironmentAzimuth(90.0); });
}

void HowTheMediumScattersIsSeen(Follows follows)
{
  const Change shadows = [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); };
  follows.A(
    "g", Scene::Replaced,
    [](Pictures& pictures) {
      pictures.medium->GetFieldData()->GetArray("g")->SetComponent(0, 0, -0.5);
      pictures.medium->GetFieldData()->GetArray("g")->Modified();
    },
    {}, shadows);
  const auto say = [](Pictures& pictures, const char* function) {
    vtkNew<vtkStringArray> name;
    name->SetName("phase_function");
    name->InsertNextValue(function);
    pictures.medium->GetFieldData()->AddArray(name);
  };
  follows.A(
    "another phase function", Scene::Replaced, [=](Pictures& pictures) { say(pictures, "schlick"); }, {}, shadows);
  const auto two = [=](Pictures& pictures) {
    say(pictures, "double_henyey_greenstein");
    for (const char* number : { "phase_second_g", "phase_first_part" })
    {
      test::AddValues<vtkDoubleArray>(
        pictures.medium->GetFieldData(), number, 1, 1, [](vtkIdType, int) { return 0.25; });
    }
  };
  follows.A("two lobes", Scene::Replaced, two, {}, shadows);
  follows.A(
    "cells g", Scene::Replaced,
    [](Pictures& pictures) {
      test::AddValues<vtkFloatArray>(pictures.medium->GetCellData(), "g", pictures.medium->GetNumberOfCells(), 1,
        [](vtkIdType cell, int) { return cell % 7 * 0.1; });
    },
    {}, shadows);
  follows.A(
    "a table", Scene::Replaced,
    [=](Pictures& pictures) {
      say(pictures, "tabulated");
      pictures.medium->GetFieldData()->RemoveArray("g");
      for (const char* column : { "phase_cosine", "phase_value" })
      {
        test::AddValues<vtkDoubleArray>(
          pictures.medium->GetFieldData(), column, 2, 1, [](vtkIdType row, int) { return row == 0 ? 1.0 : -1.0; });
      }
      pictures.medium->GetFieldData()->GetArray("phase_value")->SetComponent(1, 0, 0.2);
    },
    {}, shadows);
}

void SettingsThatNeedAnotherSceneGetOne(Follows follows)
{
  follows.A("SingleScatteringOnly", Scene::Replaced, Nothing,
    [](vtkMediumRayCaster* caster) { caster->SingleScatteringOnlyOn(); });
  follows.A("ShadowRays", Scene::Replaced, Nothing, [](vtkMediumRayCaster* caster) { caster->ShadowRaysOn(); });
  follows.A(
    "ShowBackground", Scene::Replaced, Nothing, [](vtkMediumRayCaster* caster) { caster->ShowBackgroundOff(); });
  follows.A("another array", Scene::Replaced, Nothing,
    [](vtkMediumRayCaster* caster) { caster->SetInputArrayToProcess(3, 0, 0, 1, "fluence_direct"); });
}

void SettingsOfRefractionAreFollowed(Follows follows)
{
  const Change mirror = [](vtkMediumRayCaster* caster) { caster->SetSurfaceReflection(vtkMediumRayCaster::FIXED); };
  const Change table = [](vtkMediumRayCaster* caster) { caster->SetTableFace(4); };
  const auto set = [&](const char* what, const Change& setting, const Change& before = {}) {
    follows.A(what, Scene::Either, Nothing, setting, before);
  };
  set("SurfaceReflection", mirror);
  set(
    "SurfaceReflection of another kind",
    [](vtkMediumRayCaster* caster) { caster->SetSurfaceReflection(vtkMediumRayCaster::FRESNEL); }, mirror);
  set(
    "SurfaceIndex", [](vtkMediumRayCaster* caster) { caster->SetSurfaceIndex(1.1); }, mirror);
  set(
    "SurfaceReflectance", [](vtkMediumRayCaster* caster) { caster->SetSurfaceReflectance(0.9); }, mirror);
  set("TableFace", table);
  set(
    "another TableFace", [](vtkMediumRayCaster* caster) { caster->SetTableFace(0); }, table);
  set(
    "TableColor", [](vtkMediumRayCaster* caster) { caster->SetTableColor(0.2, 0.4, 0.5); }, table);
  set(
    "TableReflectance", [](vtkMediumRayCaster* caster) { caster->SetTableReflectance(0.3); }, table);
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
    const auto image = test::MakeMedium({ { 160, 160, 160 } }, 0.1, 0.1); // 16 bytes a voxel on the device: 68 MB
    auto caster = vtkSmartPointer<vtkMediumRayCaster>::New();
    caster->SetDevice("pthread"); // PoCL's, whose memory is that of the process
    caster->SetImageSize(8, 8);
    test::AddCells(image, "fluence", 1.0);
    caster->SetInputData(image);
    test::Errors errors(caster);
    caster->Update();
    if (!errors.None() || ResidentBytes() == 0.0)
    {
      return; // there is no PoCL here
    }
    const double kept = ResidentBytes();
    end(caster);
    // PoCL lets go in a thread of its own, of uploads as well, whenever that gets its turn.
    for (int n = 0; n < 30000 && kept - ResidentBytes() < 60e6; ++n)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    claims.That(kept - ResidentBytes() > 60e6, std::string("memory of the device is given back when ") + when);
  };
  given("the filter goes", [](auto& caster) { caster = nullptr; });
  given("the input goes", [](auto& caster) { caster->SetInputConnection(0, nullptr); });
  given("the input changes, before the filters before run", [](auto& caster) {
    caster->GetInput()->Modified();
    caster->UpdateInformation();
    caster->PropagateUpdateExtent();
  });
}
}

int TestMediumRayCasterKeepsItsScene(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    WhatTheSceneDoesNotNeedKeepsIt(Follows(claims));
    WhatIsChangedIsSeen(Follows(claims));
    HowTheMediumScattersIsSeen(Follows(claims));
    SettingsThatNeedAnotherSceneGetOne(Follows(claims));
    SettingsOfRefractionAreFollowed(Follows(claims));
    MemoryIsGivenBack(claims);
  });
}
