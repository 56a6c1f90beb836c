#include "MediumScene.h"

#include "vtkParticipatingMedium.h"

#include <atomic>
#include <cmath>
#include <thread>

namespace
{
constexpr int Threads = 4, Chains = 50;

/// A density of its own for each thread.
vtkSmartPointer<vtkImageData> Density(int number)
{
  auto image = test::MakeImage({ { 6, 5, 4 + number }, { 0.2, 0.2, 0.2 } });
  test::AddValues<vtkFloatArray>(image->GetCellData(), "density", image->GetNumberOfCells(), 1,
    [=](vtkIdType i, int) { return 1.0 + std::sin(0.7 * static_cast<double>(i) + number); });
  image->GetCellData()->SetActiveScalars("density");
  return image;
}

/// What a chain gives, or says.
struct Outcome
{
  std::vector<float> fluence;
  bool quiet = false; ///< neither errors nor warnings

  bool operator==(const Outcome& other) const { return this->quiet == other.quiet && this->fluence == other.fluence; }
};

/// From density to light, by filters that are made here.
/// @param stopAt  report of progress at which it is told to stop; 0: never
Outcome RunChain(int number, int stopAt = 0)
{
  struct Stopper : vtkCommand
  {
    static Stopper* New() { return new Stopper; }
    void Execute(vtkObject* caller, unsigned long, void*) override
    {
      if (++this->Reports == this->StopAt)
      {
        static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
      }
    }
    int Reports = 0, StopAt = 0;
  };
  vtkNew<vtkParticipatingMedium> medium;
  vtkNew<vtkLightPropagationMaps> maps;
  vtkNew<Stopper> stopper;
  stopper->StopAt = stopAt;
  maps->AddObserver(vtkCommand::ProgressEvent, stopper);
  test::Errors ofMedium(medium), ofMaps(maps);
  medium->SetInputDataObject(Density(number));
  medium->SetExtinctionScale(2.0);
  maps->SetInputConnection(medium->GetOutputPort());
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->SetDirectionsPerFace(4);
  maps->Update();
  Outcome outcome;
  outcome.quiet = ofMedium.None() && ofMaps.None();
  if (vtkDataArray* fluence = maps->GetOutput()->GetCellData()->GetArray("fluence"))
  {
    for (vtkIdType i = 0; i < fluence->GetNumberOfValues(); ++i)
    {
      outcome.fluence.push_back(static_cast<float>(fluence->GetVariantValue(i).ToDouble()));
    }
  }
  return outcome;
}
}

/// Threads with filters of their own get the light that one gets, each time, though some are stopped halfway.
int TestChainsInThreads(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    std::vector<Outcome> expected;
    for (int t = 0; t < Threads; ++t)
    {
      expected.push_back(RunChain(t));
      claims.That(expected[t].quiet && expected[t].fluence.size() == 30u * (4 + t), "one thread gets light");
    }
    std::atomic<int> here{ 0 }, different{ 0 }, loud{ 0 };
    std::vector<std::thread> threads;
    for (int t = 0; t < Threads; ++t)
    {
      threads.emplace_back([&, t] {
        for (++here; here < Threads;)
        {
          std::this_thread::yield(); // until all are there
        }
        for (int i = 0; i < Chains; ++i)
        {
          loud += RunChain(t, 1 + i % 7).quiet ? 0 : 1;
          different += RunChain(t) == expected[t] ? 0 : 1;
        }
      });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    claims.That(different == 0, std::to_string(different) + " of 200 chains gave other light");
    claims.That(loud == 0, std::to_string(loud) + " of 200 chains that were stopped gave an error");
    for (int t = 0; t < Threads; ++t)
    {
      claims.That(RunChain(t) == expected[t], "one thread gets the same light afterwards");
    }
  });
}
