#include "MediumScene.h"
#include "MeshData.h"

#include "vtkCallbackCommand.h"
#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkMeshVoxelizer.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"

#include <memory>
#include <vector>

namespace
{
vtkSmartPointer<vtkPolyData> Ball(bool open)
{
  tyndall::TriangleMesh mesh = shapes::Sphere({ 0.0, 0.0, 0.0 }, 1.0, 3);
  mesh.triangles.resize(mesh.triangles.size() - open);
  return test::ToPolyData(mesh);
}

/// From a mesh to a picture, with an ear on each filter.
struct Chain
{
  vtkNew<vtkMeshVoxelizer> voxelizer;
  vtkNew<vtkRefractionOctree> octree;
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkPhotonReconstruction> reconstruction;
  vtkNew<vtkMediumRayCaster> caster;
  std::vector<vtkAlgorithm*> filters = { voxelizer, octree, rig, importance, emitter, marcher, reconstruction, caster };
  std::vector<std::unique_ptr<test::Errors>> errors;

  Chain()
  {
    this->voxelizer->SetInputDataObject(Ball(false));
    this->voxelizer->SetSampleDimensions(12, 12, 12);
    this->octree->SetInputConnection(this->voxelizer->GetOutputPort());
    this->importance->SetInputConnection(this->voxelizer->GetOutputPort());
    this->importance->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetImportanceMapConnection(this->importance->GetOutputPort());
    this->emitter->SetInputConnection(this->voxelizer->GetOutputPort());
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetPhotonCount(500);
    this->marcher->SetInputConnection(this->voxelizer->GetOutputPort());
    this->marcher->SetOctreeConnection(this->octree->GetOutputPort());
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
    this->reconstruction->SetInputConnection(this->marcher->GetOutputPort());
    this->caster->SetInputConnection(this->reconstruction->GetOutputPort());
    this->caster->SetImageSize(9, 9);
    for (vtkAlgorithm* filter : this->filters)
    {
      this->errors.push_back(std::make_unique<test::Errors>(filter));
    }
  }

  test::Errors& ErrorsOf(vtkAlgorithm* filter)
  {
    return *this->errors[std::find(this->filters.begin(), this->filters.end(), filter) - this->filters.begin()];
  }

  bool NoErrors()
  {
    return std::all_of(this->errors.begin(), this->errors.end(), [](const auto& each) { return each->None(); });
  }

  /// Whether all outputs of a filter are empty, and say why.
  static bool IsEmpty(vtkAlgorithm* filter, const char* why)
  {
    bool empty = true;
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject* output = filter->GetOutputDataObject(port);
      empty = empty && output->GetNumberOfElements(vtkDataObject::CELL) == 0 && output->GetFieldData()->GetArray(why);
    }
    return empty;
  }

  bool AreEmpty(std::initializer_list<vtkAlgorithm*> some, const char* why)
  {
    return std::all_of(some.begin(), some.end(), [&](vtkAlgorithm* filter) { return IsEmpty(filter, why); });
  }
};

void AnOpenMeshIsOneErrorInAll(test::Claims& claims)
{
  Chain chain;
  chain.voxelizer->SetInputDataObject(Ball(true));
  chain.caster->Update();
  claims.That(chain.ErrorsOf(chain.voxelizer).WasOneWith("boundary edges"), "the mesh is refused once");
  claims.That(chain.NoErrors(), "later filters say nothing of an open mesh");
  claims.That(chain.AreEmpty({ chain.voxelizer, chain.octree, chain.importance, chain.emitter, chain.marcher,
                               chain.reconstruction, chain.caster },
                "failed"),
    "everything after an open mesh is empty");
  chain.caster->Update();
  claims.That(chain.NoErrors(), "nothing is said a second time");

  chain.voxelizer->SetInputDataObject(Ball(false));
  chain.caster->Update();
  claims.That(
    chain.NoErrors() && chain.caster->GetOutput()->GetNumberOfPoints() == 81, "a closed mesh makes a picture");
}

void BadBoundsAreOneErrorInAll(test::Claims& claims)
{
  Chain chain;
  chain.voxelizer->SetModelBounds(0.0, 1.0, 2.0, 2.0, 0.0, 1.0);
  chain.caster->Update();
  chain.caster->Update();
  claims.That(chain.ErrorsOf(chain.voxelizer).WasOneWith("ModelBounds"), "a flat box is refused once");
  claims.That(chain.NoErrors(), "later filters say nothing of a flat box");
  claims.That(chain.AreEmpty({ chain.voxelizer, chain.marcher, chain.caster }, "failed"), "and are empty");
}

void PhotonsThatFailedAreNoErrorOfTheMarcher(test::Claims& claims)
{
  Chain chain;
  chain.emitter->SetSkyColor(-1.0, 0.0, 0.0);
  chain.caster->Update();
  claims.That(chain.ErrorsOf(chain.emitter).WasOneWith("SkyColor is (-1, 0, 0)"), "a negative sky is refused once");
  claims.That(chain.NoErrors(), "the marcher says nothing of photons that failed");
  claims.That(chain.AreEmpty({ chain.emitter, chain.marcher, chain.caster }, "failed"), "and is empty");
}

void LightsThatFailedAreNoErrorOfTheEmitter(test::Claims& claims)
{
  Chain chain;
  chain.rig->SetSunPower(-1.0, 1.0, 1.0);
  chain.caster->Update();
  claims.That(!chain.ErrorsOf(chain.rig).None(), "a negative sun is refused");
  claims.That(
    chain.ErrorsOf(chain.emitter).None() && chain.ErrorsOf(chain.marcher).None(), "photons of it are no error");
  claims.That(chain.AreEmpty({ chain.emitter, chain.marcher, chain.caster }, "failed"), "there is no light");
}

void AMapThatFailedIsNoErrorOfTheEmitter(test::Claims& claims)
{
  Chain chain;
  chain.importance->SetBackground(-1.0);
  chain.caster->Update();
  claims.That(chain.ErrorsOf(chain.importance).WasOneWith("Background is -1"), "a negative background is refused once");
  claims.That(chain.NoErrors(), "later filters say nothing of a map that failed");
  claims.That(
    chain.AreEmpty({ chain.importance, chain.emitter, chain.marcher, chain.reconstruction, chain.caster }, "failed"),
    "and are empty");
}

void AMeshThatFailedIsNoErrorOfTheVoxelizer(test::Claims& claims)
{
  Chain chain;
  chain.emitter->SetSkyColor(-1.0, 0.0, 0.0);
  vtkNew<vtkMeshVoxelizer> next;
  next->SetInputConnection(chain.marcher->GetOutputPort(1));
  test::Errors errors(next);
  next->Update();
  claims.That(errors.None() && Chain::IsEmpty(next, "failed"), "a mesh that its filter could not make is no error");
}

void AnAbortEmptiesWhatFollows(test::Claims& claims)
{
  const auto stop = [](vtkObject* filter, unsigned long, void*, void*) {
    static_cast<vtkAlgorithm*>(filter)->SetAbortExecute(1);
  };
  Chain chain;
  chain.emitter->SetPhotonCount(150000); // it looks up every 100000
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(stop);
  for (vtkAlgorithm* aborted :
    { static_cast<vtkAlgorithm*>(chain.voxelizer), static_cast<vtkAlgorithm*>(chain.emitter) })
  {
    const unsigned long tag = aborted->AddObserver(vtkCommand::ProgressEvent, command);
    aborted->Modified();
    chain.caster->Update();
    claims.That(chain.NoErrors(), "an abort is no error");
    claims.That(chain.AreEmpty({ aborted, chain.marcher, chain.caster }, "aborted"),
      std::string("what follows an abort is empty: ") + aborted->GetClassName());
    aborted->RemoveObserver(tag);
    aborted->SetAbortExecute(0);
    aborted->Modified();
    chain.caster->Update();
    claims.That(chain.caster->GetOutput()->GetNumberOfPoints() == 81, "the next update makes the picture");
  }
}
}

int TestPhotonFiltersAfterAFailure(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    AnOpenMeshIsOneErrorInAll(claims);
    BadBoundsAreOneErrorInAll(claims);
    PhotonsThatFailedAreNoErrorOfTheMarcher(claims);
    LightsThatFailedAreNoErrorOfTheEmitter(claims);
    AMapThatFailedIsNoErrorOfTheEmitter(claims);
    AMeshThatFailedIsNoErrorOfTheVoxelizer(claims);
    AnAbortEmptiesWhatFollows(claims);
  });
}
