#include "MediumScene.h"

#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"

#include "vtkTable.h"

#include "Numerics/Constants.h"

#include <string>

namespace
{
using tyndall::Pi;

void FillsAFurnace(test::Claims& claims, double index)
{
  auto medium = test::MakeMedium({ { 5, 4, 6 }, { 0.5, 0.5, 0.5 }, { 0.0, 0.0, 0.0 }, { -2, 3, 9 } }, 0.0, 2.0);
  if (index != 1.0)
  {
    test::AddCells(medium, "ior", index);
    medium->GetCellData()->GetArray("ior")->SetTuple1(7, 1.0);
  }
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  test::Errors errors(lattice);
  lattice->SetInputDataObject(medium);
  lattice->SetSkyColor(0.5, 0.5, 0.5);
  lattice->SetTolerance(1e-6);
  lattice->SetNetFlux(true);
  lattice->Update();
  const std::string which = "index " + std::to_string(index);
  claims.That(errors.None(), which + ": solved without complaint");
  vtkDataArray* fluence = lattice->GetOutput()->GetCellData()->GetArray("fluence");
  const double vacuum = 4.0 * Pi * 0.5;
  claims.That(fluence && fluence->GetNumberOfTuples() == 120, which + ": a fluence a voxel");
  for (vtkIdType i = 0; fluence && i < fluence->GetNumberOfTuples(); ++i)
  {
    const double squared = i == 7 ? 1.0 : index * index;
    claims.Near(fluence->GetTuple1(i) / (vacuum * squared), 1.0, 1e-5, which + ": fluence");
  }
  claims.Near(test::Deviation(lattice->GetOutput(), "net_flux", 0.0) / vacuum, 0.0, 1e-4, which + ": what flows");
  claims.That(lattice->GetBalanceError() < 1e-5, which + ": power is conserved");
  claims.That(lattice->GetSteps() > 0 && lattice->GetResidual() <= 1e-6, which + ": says how far it came");
  vtkTable* convergence = vtkTable::SafeDownCast(lattice->GetOutputDataObject(1));
  claims.That(convergence && convergence->GetNumberOfRows() == lattice->GetSteps(), which + ": a row an iteration");
  vtkFieldData* facts = lattice->GetOutput()->GetFieldData();
  claims.That(facts->GetArray("energy_balance") && facts->GetArray("face_power_out"), which + ": where power went");
  claims.That(lattice->GetOutput()->GetExtent()[0] == -2, which + ": keeps its extent");
}

void StepsByBlocksToTheSameLight(test::Claims& claims)
{
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  lattice->SetInputDataObject(test::MakeMedium({ { 9, 6, 7 } }, 0.05, 0.5));
  lattice->SetFaceRadiance(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  lattice->SetTolerance(1e-5);
  lattice->SetLattice(6);
  lattice->SetScheme(vtkLatticeBoltzmannLighting::PUBLISHED);
  lattice->Update();
  vtkNew<vtkImageData> together;
  together->DeepCopy(lattice->GetOutput());
  lattice->SetBlockSize(4);
  lattice->Update();
  vtkDataArray* one = together->GetCellData()->GetArray("fluence");
  vtkDataArray* other = lattice->GetOutput()->GetCellData()->GetArray("fluence");
  for (vtkIdType i = 0; i < one->GetNumberOfTuples(); ++i)
  {
    claims.Near(other->GetTuple1(i) / one->GetTuple1(i), 1.0, 0.01, "blocks settle to the light of all voxels");
  }
}

void SolvesOneChannelUnlessAllIsComputed(test::Claims& claims)
{
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  lattice->SetInputDataObject(test::MakeMedium({ { 9, 6, 7 } }, 0.05, 0.5));
  lattice->SetFaceRadiance(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  const auto solvesOne = [&] {
    lattice->Update();
    return std::string(lattice->GetLeftOut()).find("one channel does") != std::string::npos;
  };
  claims.That(solvesOne() && lattice->GetSeconds() > 0.0, "one channel does");
  vtkNew<vtkImageData> one;
  one->DeepCopy(lattice->GetOutput());
  lattice->LeaveOutOff();
  claims.That(!solvesOne(), "not with LeaveOut off");
  vtkDataArray* less = one->GetCellData()->GetArray("fluence");
  vtkDataArray* all = lattice->GetOutput()->GetCellData()->GetArray("fluence");
  for (vtkIdType i = 0; i < less->GetNumberOfTuples(); ++i)
  {
    claims.Near(all->GetTuple1(i) / less->GetTuple1(i), 1.0, 1e-5, "the same light");
  }
}

/// A beam of photons through a prism of higher index, and the same light handed on by the marcher.
void DiffusesWhatPhotonsLeave(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 14, 9, 11 }, { 0.1, 0.1, 0.1 } }, 0.3, 4.0);
  test::AddCells(medium, "ior", 1.0);
  for (vtkIdType i = 500; i < 900; ++i)
  {
    medium->GetCellData()->GetArray("ior")->SetTuple1(i, 1.4);
  }
  vtkNew<vtkLightRig> lights;
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(medium);
  emitter->SetLightsConnection(lights->GetOutputPort());
  emitter->SetPhotonCount(2000);
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputDataObject(medium);
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  test::Errors errors(lattice);
  lattice->SetInputDataObject(medium);
  lattice->SetTolerance(1e-5);
  lattice->SetUncollidedLightConnection(marcher->GetOutputPort());
  lattice->Update();
  vtkNew<vtkImageData> handedOn;
  handedOn->DeepCopy(lattice->GetOutput());
  lattice->SetPhotonsConnection(emitter->GetOutputPort());
  lattice->Update();
  claims.That(errors.WasOneWith("Disconnect one of them"), "refuses the same light twice");
  lattice->RemoveUncollidedLight();
  for (const bool interleaved : { false, true })
  {
    lattice->SetInterleaved(interleaved);
    lattice->Update();
    claims.That(errors.None(), "photons are taken without complaint");
    vtkDataArray* one = handedOn->GetCellData()->GetArray("fluence");
    vtkDataArray* other = lattice->GetOutput()->GetCellData()->GetArray("fluence");
    for (vtkIdType i = 0; other && i < one->GetNumberOfTuples(); ++i)
    {
      claims.Near(other->GetTuple1(i) / one->GetTuple1(i), 1.0, interleaved ? 3e-4 : 1e-6, "the light handed on");
    }
    claims.That(lattice->GetBalanceError() < 1e-3, "power is conserved");
  }
  lattice->SetPeriodicY(true);
  lattice->Update();
  claims.That(errors.WasOneWith("periodic axes"), "refuses photons across periodic axes");
}

void WarnsBeforeItIsNotPositive(test::Claims& claims)
{
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  test::Errors errors(lattice);
  lattice->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 0.5, 1.0));
  lattice->SetSkyColor(1.0, 1.0, 1.0);
  lattice->SetScheme(vtkLatticeBoltzmannLighting::PUBLISHED);
  lattice->SetMaximumOrders(5);
  lattice->Update();
  claims.That(errors.WasOneWith("here it is up to 1.5"), "warns that explicit collisions are too strong");
}

void SaysWhatIsWrong(test::Claims& claims)
{
  vtkNew<vtkLatticeBoltzmannLighting> lattice;
  test::Errors errors(lattice);
  lattice->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 1.0, 1.0));
  lattice->DefaultSkyOff();
  lattice->Update();
  claims.That(errors.WasOneWith("Nothing shines"), "warns where it is dark");
  lattice->SetSkyColor(1.0, 1.0, 1.0);
  lattice->SetLattice(7);
  lattice->Update();
  claims.That(errors.WasOneWith("there are 6 and 18"), "refuses a lattice that there is not");
  claims.That(lattice->GetOutput()->GetNumberOfCells() == 0, "and makes nothing");
  lattice->SetLattice(18);
  lattice->SetBlockSize(1);
  lattice->Update();
  claims.That(errors.WasOneWith("BlockSize is 1"), "refuses blocks of one voxel");
  lattice->SetBlockSize(4);
  lattice->SetDecomposition(vtkLatticeBoltzmannLighting::BLOCKS);
  lattice->Update();
  claims.That(errors.WasOneWith("(Decomposition: blocks) with BlockSize"), "takes no steps by blocks of ranks");
  lattice->SetDecomposition(vtkLatticeBoltzmannLighting::AUTOMATIC_DECOMPOSITION);
  lattice->SetBlockSize(0);
  auto bent = test::MakeMedium({ { 3, 3, 3 } }, 1.0, 1.0);
  test::AddCells(bent, "ior", -1.0);
  lattice->SetInputDataObject(bent);
  lattice->Update();
  claims.That(errors.WasOneWith("ior is -1 in voxel (0, 0, 0)"), "refuses an index below 0");
  lattice->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 }, { 1.0, 1.0, 1.5 } }, 1.0, 1.0));
  lattice->Update();
  claims.That(errors.WasOneWith("have to be cubes"), "refuses voxels that are no cubes");
  lattice->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 1.0, 1.0));
  lattice->Update();
  claims.That(errors.None() && lattice->GetOutput()->GetNumberOfCells() == 27, "works again after that");
}
}

int TestLatticeBoltzmannLighting(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    FillsAFurnace(claims, 1.0);
    FillsAFurnace(claims, 1.5);
    StepsByBlocksToTheSameLight(claims);
    SolvesOneChannelUnlessAllIsComputed(claims);
    DiffusesWhatPhotonsLeave(claims);
    WarnsBeforeItIsNotPositive(claims);
    SaysWhatIsWrong(claims);
  });
}
