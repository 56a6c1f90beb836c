#pragma once

#include "Device/Buffer.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Values in double on the device, or in float where it has no double.
class ExactValues
{
public:
  ExactValues() = default;
  ExactValues(Device& device, std::size_t count, const char* what);

  bool InDouble() const { return this->Doubles.Size() > 0; }
  const cl::Buffer& Handle() const { return this->InDouble() ? this->Doubles.Handle() : this->Floats.Handle(); }
  void Fill(double value);
  std::vector<double> Read() const;
  void Write(const std::vector<double>& values); ///< as many as there are

private:
  Buffer<double> Doubles;
  Buffer<float> Floats;
};

/// Sets an argument that a kernel declares as `exact`.
void SetExact(const Device& device, cl::Kernel& kernel, cl_uint index, double value);

/// DOUBLES, as kernels are compiled with: 1 where the device has double precision.
std::string ExactOption(const Device& device);
}
