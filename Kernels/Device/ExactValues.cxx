#include "Device/ExactValues.h"

#include "Device/Device.h"

namespace tyndall
{
namespace
{
bool HasDoubles(const Device& device)
{
  return device.HasExtension("cl_khr_fp64");
}
}

ExactValues::ExactValues(Device& device, std::size_t count, const char* what)
{
  if (HasDoubles(device))
  {
    this->Doubles = Buffer<double>(device, count, what);
  }
  else
  {
    this->Floats = Buffer<float>(device, count, what);
  }
  this->Fill(0.0);
}

void ExactValues::Fill(double value)
{
  this->Doubles.Fill(value);
  this->Floats.Fill(static_cast<float>(value));
}

std::vector<double> ExactValues::Read() const
{
  if (this->InDouble())
  {
    return this->Doubles.Read();
  }
  const std::vector<float> values = this->Floats.Read();
  return { values.begin(), values.end() };
}

void ExactValues::Write(const std::vector<double>& values)
{
  if (this->InDouble())
  {
    this->Doubles.Write(values.data());
    return;
  }
  const std::vector<float> rounded(values.begin(), values.end());
  this->Floats.Write(rounded.data());
}

void SetExact(const Device& device, cl::Kernel& kernel, cl_uint index, double value)
{
  if (HasDoubles(device))
  {
    kernel.setArg(index, value);
  }
  else
  {
    kernel.setArg(index, static_cast<float>(value));
  }
}

std::string ExactOption(const Device& device)
{
  return Define("DOUBLES", HasDoubles(device));
}
}
