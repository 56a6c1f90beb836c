#pragma once

#include "Device/Buffer.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Array on the device, in double precision if the device has it, else in float.
class ExactValues
{
public:
  ExactValues() = default;
  ExactValues(Device& device, std::size_t count, const char* what);

  bool InDouble() const { return this->Doubles.Size() > 0; }
  const cl::Buffer& Handle() const { return this->InDouble() ? this->Doubles.Handle() : this->Floats.Handle(); }
  void Fill(double value);
  std::vector<double> Read() const;
  void Write(const std::vector<double>& values); ///< `values` must have the size of the array

private:
  Buffer<double> Doubles;
  Buffer<float> Floats;
};

/// Sets a kernel argument of type `exact`, which is double if the device has double precision, else float.
void SetExact(const Device& device, cl::Kernel& kernel, cl_uint index, double value);

/// Compiler option that defines DOUBLES: 1 if the device has double precision.
std::string ExactOption(const Device& device);
}
