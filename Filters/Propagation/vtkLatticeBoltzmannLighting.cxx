#include "vtkLatticeBoltzmannLighting.h"

#include "Common/LightTransportData.h"
#include "Device/Device.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{
tyndall::LatticeSettings SettingsOf(vtkLatticeBoltzmannLighting* filter)
{
  tyndall::LatticeSettings settings;
  settings.directions = filter->GetLattice();
  settings.scheme = static_cast<tyndall::LatticeScheme>(filter->GetScheme());
  settings.blockSize = filter->GetBlockSize();
  settings.stepsPerExchange = filter->GetStepsPerExchange();
  settings.maximumSteps = filter->GetMaximumOrders();
  settings.tolerance = filter->GetTolerance();
  settings.periodic = { filter->GetPeriodicX(), filter->GetPeriodicY(), filter->GetPeriodicZ() };
  settings.netFlux = filter->GetNetFlux();
  return settings;
}

/// Of all power, what is in none of the balance's accounts but the last, the worst channel.
double LeftOverOf(const tyndall::LightField& light)
{
  double most = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(light.channels); ++c)
  {
    const double all = light.balance.entered[c] + light.balance.emitted[c];
    most = std::max(most, all > 0.0 ? std::abs(light.balance.leftOver[c]) / all : 0.0);
  }
  return most;
}
}

vtkStandardNewMacro(vtkLatticeBoltzmannLighting);

vtkLatticeBoltzmannLighting::vtkLatticeBoltzmannLighting()
{
  const tyndall::LatticeSettings defaults;
  this->Lattice = defaults.directions;
  this->Scheme = static_cast<int>(defaults.scheme);
  this->BlockSize = defaults.blockSize;
  this->StepsPerExchange = defaults.stepsPerExchange;
  this->MaximumOrders = defaults.maximumSteps;
  this->NetFlux = defaults.netFlux;
}

vtkLatticeBoltzmannLighting::~vtkLatticeBoltzmannLighting() = default;

int vtkLatticeBoltzmannLighting::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Note({});
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* image = vtkImageData::GetData(inputs[MEDIUM]);
    const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
    const tyndall::FloatField ior =
      tyndall::ReadChosenCells(this, tyndall::RefractiveIndex, image, "ior", tyndall::Need::Optional, { 1 });
    const tyndall::IlluminationInput shining = this->ReadShining(inputs);
    this->WarnWhereDark(shining.illumination, input.emission.IsThere());
    tyndall::LightField light = tyndall::SolveLatticeBoltzmann(*tyndall::Device::Find(this->GetDevice()), input.medium,
      ior, shining.illumination, SettingsOf(this), tyndall::MonitorOf(this));
    this->Note(light);
    this->WriteSolved(image, std::move(light), outputs);
  });
}

void vtkLatticeBoltzmannLighting::Note(const tyndall::LightField& light)
{
  const bool any = !light.convergence.empty();
  this->Steps = any ? light.convergence.back().iteration : 0;
  this->Residual = any ? light.convergence.back().residual : 0.0;
  this->Seconds = any ? light.convergence.back().seconds : 0.0;
  this->BalanceError = LeftOverOf(light);
  this->DeviceName = light.device;
  this->LeftOut = tyndall::Lines(light.leftOut);
}

void vtkLatticeBoltzmannLighting::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Lattice: " << this->Lattice << "\n";
  os << indent << "Scheme: " << this->Scheme << "\n";
  os << indent << "BlockSize: " << this->BlockSize << "\n";
  os << indent << "StepsPerExchange: " << this->StepsPerExchange << "\n";
  os << indent << "MaximumOrders: " << this->MaximumOrders << "\n";
  os << indent << "NetFlux: " << this->NetFlux << "\n";
  os << indent << "Steps: " << this->Steps << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "BalanceError: " << this->BalanceError << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
