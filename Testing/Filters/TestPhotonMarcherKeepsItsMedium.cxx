// The medium stays prepared between updates, and is never an old one.

#include "AdaptiveScene.h"

#include "vtkRefractionOctree.h"
#include "vtkUnsignedCharArray.h"

#include <functional>
#include <string>
#include <vector>

namespace
{
/// A marcher of a medium and photons, and how to make another one like it.
struct Light
{
  vtkSmartPointer<vtkImageData> medium = test::GlassBall(16);
  vtkSmartPointer<vtkImageData> octree;
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;

  Light()
  {
    this->emitter->SetInputDataObject(test::MakeImage({ { 16, 16, 16 } })); // not the medium: photons stay the same
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetPhotonCount(500);
    this->Connect(this->marcher);
  }

  void Connect(vtkPhotonMarcher* to)
  {
    to->SetInputDataObject(this->medium);
    to->SetPhotonsConnection(this->emitter->GetOutputPort());
    this->octree ? to->SetOctreeData(this->octree) : to->RemoveOctree();
  }

  static std::vector<double> Of(vtkPhotonMarcher* marcher)
  {
    marcher->Update();
    auto* image = vtkImageData::SafeDownCast(marcher->GetOutputDataObject(0));
    std::vector<double> values;
    for (const char* name : { "fluence", "mean_direction", "photon_count", "fluence_batches" })
    {
      vtkDataArray* array = image->GetCellData()->GetArray(name);
      for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
      {
        values.push_back(array->GetVariantValue(i).ToDouble());
      }
    }
    return values;
  }
};

using Setting = std::function<void(vtkPhotonMarcher*)>;

/// After a change the light is that of a filter which has never marched.
class Follows
{
public:
  explicit Follows(test::Claims& claims)
    : TheClaims(claims)
  {
  }

  void A(const std::string& what, bool keeps, const std::function<void(Light&)>& change, const Setting& setting = {},
    const std::function<void(Light&)>& before = {})
  {
    Light light;
    if (before)
    {
      before(light);
    }
    const std::vector<double> first = Light::Of(light.marcher);
    this->TheClaims.That(!light.marcher->GetMediumKept(), "a first march keeps nothing");
    change(light);
    vtkNew<vtkPhotonMarcher> fresh;
    light.Connect(fresh);
    if (setting)
    {
      setting(light.marcher);
      setting(fresh);
    }
    const std::vector<double> found = Light::Of(light.marcher);
    this->TheClaims.That(
      light.marcher->GetMediumKept() == keeps, what + (keeps ? " keeps" : " replaces") + " the medium");
    this->TheClaims.That(!found.empty() && found == Light::Of(fresh), "the light follows " + what);
    this->TheClaims.That(found != first, what + " is seen");
  }

private:
  test::Claims& TheClaims;
};

const auto Nothing = [](Light&) {};

void OtherLightKeepsTheMedium(Follows follows)
{
  follows.A("brighter light", true, [](Light& light) { light.rig->SetSunPower(3.0, 2.0, 1.0); });
  follows.A("another sun", true, [](Light& light) { light.rig->SetSunElevation(80.0); });
  follows.A("another seed", true, [](Light& light) { light.emitter->SetSeed(3); });
  follows.A("more photons", true, [](Light& light) { light.emitter->SetPhotonCount(900); });
}

void AChangedMediumIsSeen(Follows follows)
{
  const auto change = [](const char* name, bool tellArray) {
    return [=](Light& light) {
      vtkDataArray* array = light.medium->GetCellData()->GetArray(name);
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
      {
        array->SetComponent(i, 0, 1.1 * array->GetComponent(i, 0));
      }
      tellArray ? array->Modified() : light.medium->Modified();
    };
  };
  follows.A("ior changed in place", false, change("ior", true));
  follows.A("ior changed in place, and the image told", false, change("ior", false));
  follows.A("sigma_s changed in place", false, change("sigma_s", true));
  follows.A("another sigma_a", false, [](Light& light) { test::AddCells(light.medium, "sigma_a", 0.2); });
  follows.A("no index", false, [](Light& light) {
    light.medium->GetCellData()->RemoveArray("ior");
    light.medium->Modified();
  });
  follows.A("another spacing", false, [](Light& light) { light.medium->SetSpacing(1.0, 1.0, 0.9); });
  follows.A("another place", false, [](Light& light) { light.medium->SetOrigin(1.0, 0.0, 0.0); });
  follows.A("another medium", false, [](Light& light) {
    light.medium = test::GlassBall(12);
    light.marcher->SetInputDataObject(light.medium);
  });
  follows.A("another array", false, Nothing,
    [](vtkPhotonMarcher* marcher) { marcher->SetInputArrayToProcess(1, 0, 0, 1, "ior"); });
}

/// An octree of one level; steps cross its nodes as if the index was constant there.
void SetOctree(Light& light, double level)
{
  light.octree = test::MakeImage({ { 16, 16, 16 } });
  test::AddCells<vtkUnsignedCharArray>(light.octree, "octree_level", level);
  light.marcher->SetOctreeData(light.octree);
}

void AnotherOctreeIsSeen(Follows follows)
{
  follows.A("an octree", false, [](Light& light) { SetOctree(light, 2.0); });
  follows.A(
    "an octree changed in place", false,
    [](Light& light) {
      light.octree->GetCellData()->GetArray("octree_level")->Fill(3.0);
      light.octree->GetCellData()->GetArray("octree_level")->Modified();
    },
    {}, [](Light& light) { SetOctree(light, 2.0); });
  follows.A(
    "an octree taken away", false,
    [](Light& light) {
      light.octree = nullptr;
      light.marcher->RemoveOctree();
    },
    {}, [](Light& light) { SetOctree(light, 2.0); });
  follows.A("levels in the medium", false,
    [](Light& light) { test::AddCells<vtkUnsignedCharArray>(light.medium, "octree_level", 2.0); });
}

void OtherSettingsAreSeen(Follows follows)
{
  follows.A("the integrator", false, Nothing, [](vtkPhotonMarcher* marcher) { marcher->SetIntegratorOrder(4); });
  follows.A("the step", false, Nothing, [](vtkPhotonMarcher* marcher) { marcher->SetStepSize(0.5); });
  follows.A("counts", false, Nothing, [](vtkPhotonMarcher* marcher) { marcher->PhotonCountsOn(); });
  follows.A("batches", false, [](Light& light) { light.emitter->SetBatches(3); });
}

/// ParaView's filters between filters make datasets anew, with the same arrays.
void TheSameArraysInAnotherImageAreTheSame(test::Claims& claims)
{
  Light light;
  Light::Of(light.marcher);
  vtkNew<vtkRefractionOctree> before;
  before->SetInputDataObject(light.medium);
  light.marcher->SetInputConnection(before->GetOutputPort());
  Light::Of(light.marcher);
  claims.That(!light.marcher->GetMediumKept(), "another connection replaces the medium");
  light.emitter->SetSeed(8);
  Light::Of(light.marcher);
  claims.That(light.marcher->GetMediumKept(), "a filter before that does not run again keeps it");
  before->SetTolerance(0.5);
  const std::vector<double> found = Light::Of(light.marcher);
  claims.That(!light.marcher->GetMediumKept(), "one that runs again replaces it");
  vtkNew<vtkPhotonMarcher> fresh;
  light.Connect(fresh);
  fresh->SetInputConnection(before->GetOutputPort());
  claims.That(found == Light::Of(fresh), "the light is that of its new levels");
}

/// Nothing is left of a march that failed.
void AfterAnErrorItStartsAgain(test::Claims& claims)
{
  Light light;
  test::Errors errors(light.marcher);
  const std::vector<double> first = Light::Of(light.marcher);
  light.marcher->SetIntegratorOrder(3);
  Light::Of(light.marcher);
  claims.That(errors.WasOneWith("order is 3"), "an order that there is not");
  light.marcher->SetIntegratorOrder(2);
  claims.That(Light::Of(light.marcher) == first && !light.marcher->GetMediumKept(), "the next march is whole again");
  light.marcher->SetScheme(vtkPhotonMarcher::PUBLISHED);
  light.marcher->SetPathCount(3);
  light.marcher->Update();
  light.marcher->SetScheme(vtkPhotonMarcher::CONSERVATIVE);
  claims.That(Light::Of(light.marcher) == first, "and after a march of the other scheme");
}
}

int TestPhotonMarcherKeepsItsMedium(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    OtherLightKeepsTheMedium(Follows(claims));
    AChangedMediumIsSeen(Follows(claims));
    AnotherOctreeIsSeen(Follows(claims));
    OtherSettingsAreSeen(Follows(claims));
    TheSameArraysInAnotherImageAreTheSame(claims);
    AfterAnErrorItStartsAgain(claims);
  });
}
