// Photons know for which box they were made; in a medium of another box that is told.
#include "MediumScene.h"

#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"

int TestPhotonsOfAnotherBox(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    vtkNew<vtkLightRig> rig;
    vtkNew<vtkPhotonEmitter> emitter;
    emitter->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 2.0, 2.0, 2.0 } }, 0.1, 0.1));
    emitter->SetLightsConnection(rig->GetOutputPort());
    emitter->SetPhotonCount(1000);
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetPhotonsConnection(emitter->GetOutputPort());
    test::Errors errors(marcher);
    const auto marchIn = [&](const test::Box& box) {
      marcher->SetInputDataObject(test::MakeMedium(box, 0.1, 0.1));
      marcher->Update();
    };
    marchIn({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 2.0, 2.0, 2.0 } });
    marchIn({ { 8, 8, 8 }, { 0.5, 0.5, 0.5 }, { 2.0, 2.0, 2.0 } });
    marchIn({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 + 1e-8 }, { 2.0, 2.0, 2.0 } });
    claims.That(errors.None(), "the same box is no matter, whatever its voxels are");
    marchIn({ { 8, 8, 8 }, { 1.0, 1.0, 1.0 }, { 0.0, 0.0, 0.0 } });
    claims.That(
      errors.WasOneWith("made for the box x from 2 to 6, y from 2 to 6, z from 2 to 6, the medium fills the box x "
                        "from 0 to 8, y from 0 to 8, z from 0 to 8"),
      "a larger box");
    claims.That(marcher->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL) == 512, "a warning only");
    marchIn({ { 4, 4, 4 }, { 1.0, 1.0, 1.01 }, { 2.0, 2.0, 2.0 } });
    claims.That(errors.WasOneWith("z from 2 to 6.04"), "a box that is a little longer");
  });
}
