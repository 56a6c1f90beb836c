#pragma once

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"

#include <CL/cl.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

/// What the tests of filters share.
namespace test
{
/// Whether there is an OpenCL device. Asked of OpenCL itself: a filter's error must not pass for a missing device.
inline bool ThereIsADevice()
{
  cl_uint count = 0;
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS)
  {
    return false;
  }
  std::vector<cl_platform_id> platforms(count);
  clGetPlatformIDs(count, platforms.data(), nullptr);
  return std::any_of(platforms.begin(), platforms.end(), [](cl_platform_id platform) {
    cl_uint devices = 0;
    return clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &devices) == CL_SUCCESS && devices > 0;
  });
}

/// What a test returns whose filter did nothing: skipped where there is no OpenCL device, failed where there is one or
/// TYNDALL_REQUIRE_DEVICE is set.
/// @param why  what the filter said
inline int SkippedWithoutDevice(const std::string& why)
{
  if (ThereIsADevice() || std::getenv("TYNDALL_REQUIRE_DEVICE"))
  {
    std::cerr << "Failed: " << why << "\n";
    return EXIT_FAILURE;
  }
  std::cerr << "No OpenCL device: " << why << "\n";
  return 125;
}

/// Counts failed claims; a test ends with `return claims.Result();`.
class Claims
{
public:
  bool That(bool holds, const std::string& claim)
  {
    if (!holds)
    {
      std::cerr << "Not true: " << claim << "\n";
      ++this->Failed;
    }
    return holds;
  }

  bool Near(double value, double expected, double tolerance, const std::string& what)
  {
    const bool near = value >= expected - tolerance && value <= expected + tolerance;
    if (!near)
    {
      std::cerr.precision(12);
      std::cerr << "Not true: " << what << " is " << value << ", expected " << expected << " +- " << tolerance << "\n";
      ++this->Failed;
    }
    return near;
  }

  int Result() const { return this->Failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE; }

private:
  int Failed = 0;
};

/// Keeps the errors and warnings of an algorithm and its pipeline from the console, to look at them.
class Errors
{
public:
  explicit Errors(vtkAlgorithm* algorithm)
  {
    for (unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
    {
      algorithm->AddObserver(event, this->TheRecorder);
      algorithm->GetExecutive()->AddObserver(event, this->TheRecorder);
    }
  }

  /// Whether there was exactly one error or warning, with `part` in it; forgets what was seen.
  bool WasOneWith(const std::string& part)
  {
    const std::vector<std::string> seen = std::move(this->TheRecorder->Messages);
    this->TheRecorder->Messages.clear();
    const bool one = seen.size() == 1 && seen[0].find(part) != std::string::npos;
    if (!one)
    {
      std::cerr << "Expected one error with \"" << part << "\", got " << seen.size() << ":\n";
      for (const std::string& message : seen)
      {
        std::cerr << message << "\n";
      }
    }
    return one;
  }

  bool None() const { return this->TheRecorder->Messages.empty(); }

private:
  struct Recorder : vtkCommand
  {
    static Recorder* New() { return new Recorder; }
    void Execute(vtkObject*, unsigned long, void* message) override
    {
      this->Messages.emplace_back(static_cast<const char*>(message));
    }
    std::vector<std::string> Messages;
  };
  vtkNew<Recorder> TheRecorder;
};
}
