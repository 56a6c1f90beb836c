// What users do in a program under a locale with a decimal comma: light, messages and files are as without it.
#include "MediumScene.h"

#include "Reference/CommaLocale.h"

#include "vtkEnvironmentReader.h"
#include "vtkLightRig.h"
#include "vtkParticipatingMedium.h"
#include "vtkStringArray.h"
#include "vtkTestUtilities.h"

#include <fstream>

int TestVDBWriter(int argc, char* argv[]);

namespace
{
std::string SettingsUsed(vtkDataObject* light)
{
  auto* const lines = vtkStringArray::SafeDownCast(light->GetFieldData()->GetAbstractArray("settings_used"));
  std::string all;
  for (vtkIdType i = 0; lines && i < lines->GetNumberOfValues(); ++i)
  {
    all += lines->GetValue(i) + "\n";
  }
  return all;
}

void LampsShine(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->SetSun(false);
  rig->AddPointLight(1.9, 2.1, 2.2, 5.0, 5.0, 5.0);
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 1.5, 4.5));
  maps->SetLightsConnection(rig->GetOutputPort());
  maps->Update();
  claims.That(errors.None() && maps->GetOutput()->GetCellData()->HasArray("fluence"), "a lamp shines");
  const std::string settings = SettingsUsed(maps->GetOutput());
  claims.That(settings.find("Tolerance = 0.0001") != std::string::npos, "settings have a point: " + settings);
}

void MessagesHavePoints(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> medium;
  test::Errors errors(medium);
  const auto image = test::MakeImage({ { 4, 4, 4 }, { 375.0, 375.0, 375.0 } });
  test::AddCells(image, "density", 1.0);
  medium->SetInputDataObject(image);
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");
  medium->SetLengthUnit(vtkParticipatingMedium::METRES);
  medium->Update();
  claims.That(medium->GetPhysicalExtent() == std::string("1.5 x 1.5 x 1.5 km"),
    std::string("the extent: ") + medium->GetPhysicalExtent());
  claims.That(errors.None(), "a medium of that size is fine");
  medium->SetAlbedo(1.5, 0.5, 0.5);
  medium->Update();
  claims.That(errors.WasOneWith("1.5"), "what is refused is told with a point");
}

void ExposuresAreRead(test::Claims& claims, const std::string& folder)
{
  const std::string path = folder + "/comma.hdr";
  std::ofstream(path, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0.25\n\n-Y 1 +X 2\n"
                                        << std::string(8, char(128));
  vtkNew<vtkEnvironmentReader> reader;
  test::Errors errors(reader);
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkDataArray* const radiance = reader->GetOutput()->GetPointData()->GetArray("radiance");
  claims.That(errors.None() && radiance, "a picture with an exposure is read");
  claims.Near(radiance ? radiance->GetComponent(0, 0) : -1.0, 128.5 / 256.0 / 0.25, 1e-6, "its radiance");
}
}

int TestDecimalComma(int argc, char* argv[])
{
  char* output = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "TYNDALL_TEST_OUTPUT", ".");
  const std::string folder = output;
  delete[] output;
  return test::WithDevice([&](test::Claims& claims) {
    const reference::CommaLocale locale;
    claims.That(locale.Works, "there is a locale with a decimal comma");
    LampsShine(claims);
    MessagesHavePoints(claims);
    ExposuresAreRead(claims, folder);
    claims.That(TestVDBWriter(argc, argv) == EXIT_SUCCESS, "VDBWriter and VDBReader pass their test");
  });
}
