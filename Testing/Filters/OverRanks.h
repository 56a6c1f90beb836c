#pragma once

#include "Device/Errors.h"

#include "vtkCommand.h"
#include "vtkMPIController.h"
#include "vtkNew.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

/// What the programs share that mpiexec runs as tests.
namespace test
{
/// Runs `test`(controller), which returns whether all is right, on the ranks of MPI.
/// @return what the program returns: 125, skipped, without an OpenCL device unless TYNDALL_REQUIRE_DEVICE is set
template <class Test>
int RunOverRanks(int argc, char* argv[], const Test& test)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  int end = EXIT_FAILURE;
  try
  {
    end = test(controller.Get()) ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const tyndall::DeviceError& error)
  {
    std::cerr << error.what() << "\n";
    end = std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return end;
}

/// Says on which rank a claim does not hold.
inline bool Expect(bool holds, const std::string& what, int rank)
{
  if (!holds)
  {
    std::cerr << "rank " << rank << ": " << what << "\n";
  }
  return holds;
}

/// Keeps the words of errors that it observes.
struct Note : vtkCommand
{
  static Note* New() { return new Note; }
  void Execute(vtkObject*, unsigned long, void* data) override { this->said += static_cast<const char*>(data); }
  std::string said;
};
}
