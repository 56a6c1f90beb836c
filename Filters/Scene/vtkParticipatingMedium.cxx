#include "vtkParticipatingMedium.h"

#include "Common/FiniteValues.h"
#include "Common/GhostFlags.h"
#include "Common/LightTransportData.h"
#include "Medium/Presets.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"

#include <cmath>
#include <string>
#include <vector>

namespace
{
using tyndall::InvalidInput;
using tyndall::Require;
using tyndall::Rgb;
using tyndall::Times;

/// The medium at relative density 1, in the dataset's unit.
struct Recipe
{
  Rgb sigma_s;
  Rgb sigma_a;
  Rgb emission;
  double g;
};

bool NotNegative(double value)
{
  return value >= 0.0 && std::isfinite(value);
}

Recipe CustomMedium(vtkParticipatingMedium* filter)
{
  Recipe recipe = {};
  for (int c = 0; c < 3; ++c)
  {
    const double albedo = filter->GetAlbedo()[c];
    Require(albedo >= 0.0 && albedo <= 1.0, "Albedo is " + std::to_string(albedo) + "; it must lie in [0, 1].");
    recipe.sigma_s[c] = albedo * filter->GetExtinctionScale();
    recipe.sigma_a[c] = (1.0 - albedo) * filter->GetExtinctionScale();
  }
  recipe.g = filter->GetMeanCosine();
  Require(std::abs(recipe.g) < 1.0, "MeanCosine is " + std::to_string(recipe.g) + "; it must lie between -1 and 1.");
  return recipe;
}

Recipe RealMedium(vtkParticipatingMedium* filter)
{
  const tyndall::MediumPreset& preset = tyndall::MediumPresets()[filter->GetPreset() - 1];
  const double length = filter->GetMillimetresPerUnit();
  Require(length > 0.0 && std::isfinite(length),
    "MillimetresPerUnit is " + std::to_string(length) + "; it must be a positive number.");
  const double factor = length * filter->GetExtinctionScale();
  return { Times(preset.sigma_s, factor), Times(preset.sigma_a, factor), {}, preset.g };
}

Recipe RecipeOf(vtkParticipatingMedium* filter)
{
  Require(NotNegative(filter->GetExtinctionScale()),
    "ExtinctionScale is " + std::to_string(filter->GetExtinctionScale()) + "; it must be finite and not negative.");
  Recipe recipe = filter->GetPreset() == vtkParticipatingMedium::CUSTOM ? CustomMedium(filter) : RealMedium(filter);
  for (int c = 0; c < 3; ++c)
  {
    recipe.emission[c] = filter->GetEmissionScale() * filter->GetEmissionColor()[c];
    Require(NotNegative(recipe.emission[c]),
      "EmissionScale times EmissionColor is " + std::to_string(recipe.emission[c]) +
        "; it must be finite and not negative.");
  }
  return recipe;
}

/// Relative density of each voxel: 0 at `minimum`, 1 at `maximum`, and on in the same way.
std::vector<float> RelativeDensity(
  const tyndall::FloatField& density, const tyndall::Grid& grid, double minimum, double maximum)
{
  Require(std::isfinite(minimum) && std::isfinite(maximum) && maximum >= minimum,
    "The densities range from MinimumDensity " + std::to_string(minimum) + " to MaximumDensity " +
      std::to_string(maximum) + "; the latter must not be less.");
  const float* values = density.Values();
  std::vector<float> relative(grid.VoxelCount());
  vtkSMPTools::For(0, static_cast<vtkIdType>(relative.size()), [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      const double above = values[i] - minimum;
      relative[i] = static_cast<float>(above <= 0.0 ? 0.0 : maximum > minimum ? above / (maximum - minimum) : 1.0);
    }
  });
  for (std::size_t i = 0; i < relative.size(); ++i)
  {
    if (!std::isfinite(values[i]))
    {
      throw InvalidInput("The density is " + std::to_string(values[i]) + " in voxel " + tyndall::VoxelName(grid, i) +
        " (the first such voxel); it must be finite.");
    }
  }
  tyndall::RequireFinite(
    "relative density", relative.data(), relative.size(), 1,
    [&](std::size_t voxel) { return "voxel " + tyndall::VoxelName(grid, voxel); },
    "MaximumDensity less MinimumDensity is too small for the densities that there are: raise MaximumDensity.");
  return relative;
}

/// Hidden cells have nothing of the medium, wherever MinimumDensity is.
void EmptyHidden(vtkImageData* image, std::vector<float>& relative)
{
  const std::vector<unsigned char> hidden = tyndall::HiddenCells(image);
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    relative[i] = hidden[i] ? 0.0f : relative[i];
  }
}

void AddProduct(vtkImageData* output, const char* name, const std::vector<float>& density, const Rgb& factor)
{
  const int components = factor[0] == factor[1] && factor[1] == factor[2] ? 1 : 3;
  std::vector<float> values(density.size() * components);
  vtkSMPTools::For(0, static_cast<vtkIdType>(density.size()), [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      for (int c = 0; c < components; ++c)
      {
        values[i * components + c] = static_cast<float>(density[i] * factor[c]);
      }
    }
  });
  tyndall::AddCells(output, name, std::move(values), components,
    "Density times scale is more than a float holds (3.4e+38): give ExtinctionScale or EmissionScale less, or "
    "MaximumDensity more.");
}

const tyndall::MediumPreset* PresetOf(int preset)
{
  const bool isThere = preset > vtkParticipatingMedium::CUSTOM && preset <= vtkParticipatingMedium::SKIN_2;
  return isThere ? &tyndall::MediumPresets()[preset - 1] : nullptr;
}
}

vtkStandardNewMacro(vtkParticipatingMedium);

vtkParticipatingMedium::vtkParticipatingMedium() = default;

vtkParticipatingMedium::~vtkParticipatingMedium() = default;

const char* vtkParticipatingMedium::GetPresetName(int preset)
{
  return PresetOf(preset) ? PresetOf(preset)->name : "";
}

const char* vtkParticipatingMedium::GetPresetDensity(int preset)
{
  return PresetOf(preset) ? PresetOf(preset)->densityOne : "";
}

const char* vtkParticipatingMedium::GetPresetSource(int preset)
{
  return PresetOf(preset) ? PresetOf(preset)->source : "";
}

int vtkParticipatingMedium::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* input = vtkImageData::GetData(inputs[0]);
    const Recipe recipe = RecipeOf(this);
    const tyndall::FloatField density = tyndall::ReadChosenCells(this, 0, input, "", tyndall::Need::Required, { 1 });
    std::vector<float> relative =
      RelativeDensity(density, tyndall::GridOf(input), this->MinimumDensity, this->MaximumDensity);

    EmptyHidden(input, relative);

    vtkImageData* output = vtkImageData::GetData(outputs);
    tyndall::PassOn(input, output);
    AddProduct(output, "sigma_a", relative, recipe.sigma_a);
    AddProduct(output, "sigma_s", relative, recipe.sigma_s);
    if (recipe.emission != Rgb{})
    {
      AddProduct(output, "emission", relative, recipe.emission);
    }
    tyndall::AddFact(output, "g", std::vector<double>{ recipe.g });
  });
}

void vtkParticipatingMedium::PrintSelf(ostream& os, vtkIndent indent)
{
  const auto print = [&](const char* name, const double* rgb) {
    os << indent << name << ": " << rgb[0] << " " << rgb[1] << " " << rgb[2] << "\n";
  };
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Preset: " << (this->Preset == CUSTOM ? "custom" : GetPresetName(this->Preset)) << "\n";
  os << indent << "MinimumDensity: " << this->MinimumDensity << "\n";
  os << indent << "MaximumDensity: " << this->MaximumDensity << "\n";
  os << indent << "ExtinctionScale: " << this->ExtinctionScale << "\n";
  print("Albedo", this->Albedo);
  os << indent << "MeanCosine: " << this->MeanCosine << "\n";
  os << indent << "EmissionScale: " << this->EmissionScale << "\n";
  print("EmissionColor", this->EmissionColor);
  os << indent << "MillimetresPerUnit: " << this->MillimetresPerUnit << "\n";
}
