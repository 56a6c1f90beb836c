#include "Common/PhaseFunctionData.h"

#include "Common/ArrayRanges.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Numerics/NumberText.h"

#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Largest accepted difference between field data `g` and the mean cosine of a phase function that determines it.
constexpr double Contradicts = 0.01;

constexpr const char* NameFact = "phase_function";
constexpr const char* GFact = "g";
constexpr const char* SecondFact = "phase_second_g";
constexpr const char* PartFact = "phase_first_part";
constexpr const char* CosineFact = "phase_cosine";
constexpr const char* ValueFact = "phase_value";
constexpr const char* Facts[] = { NameFact, GFact, SecondFact, PartFact, CosineFact, ValueFact };

const char* const Isotropic = "isotropic";
const char* const HenyeyGreenstein = "henyey_greenstein";
const char* const DoubleHenyeyGreenstein = "double_henyey_greenstein";
const char* const Schlick = "schlick";
const char* const Rayleigh = "rayleigh";
const char* const Tabulated = "tabulated";

/// All numbers of the field data array `name`; empty if there is no such array.
std::vector<double> ReadNumbers(vtkDataObject* data, const char* name)
{
  vtkAbstractArray* const found = data->GetFieldData()->GetAbstractArray(name);
  auto* const numbers = vtkArrayDownCast<vtkDataArray>(found);
  if (found && !numbers)
  {
    throw InvalidInput("The field data '" + std::string(name) + "' is text; it must be of numbers.");
  }
  std::vector<double> values;
  for (vtkIdType i = 0; numbers && i < numbers->GetNumberOfValues(); ++i)
  {
    const int components = numbers->GetNumberOfComponents();
    values.push_back(numbers->GetComponent(i / components, static_cast<int>(i % components)));
  }
  return values;
}

Rgb ReadChannels(vtkDataObject* data, const char* name, double missing)
{
  const std::vector<double> values = ReadNumbers(data, name);
  if (values.empty() && !data->GetFieldData()->HasArray(name))
  {
    return { missing, missing, missing };
  }
  if (values.size() != 1 && values.size() != 3)
  {
    throw InvalidInput("The field data '" + std::string(name) + "' has " + std::to_string(values.size()) +
      " numbers; it must have 1, or 3 for red, green, blue.");
  }
  return { values[0], values[values.size() / 2], values.back() };
}

std::string ReadName(vtkDataObject* data)
{
  vtkAbstractArray* const found = data->GetFieldData()->GetAbstractArray(NameFact);
  if (!found)
  {
    return HenyeyGreenstein;
  }
  auto* const text = vtkArrayDownCast<vtkStringArray>(found);
  Require(text && text->GetNumberOfValues() == 1,
    "The field data '" + std::string(NameFact) + "' must be one text, the phase function's name.");
  return text->GetValue(0);
}

void AddChannels(vtkDataObject* data, const char* name, const Rgb& rgb)
{
  AddFact(data, name, IsGrey(rgb) ? std::vector<double>{ rgb[0] } : std::vector<double>(rgb.begin(), rgb.end()),
    IsGrey(rgb) ? 1 : 3);
}

PhaseFunction FunctionOf(const PhaseDescription& description, int channel)
{
  const double g = description.g[channel];
  const std::string& name = description.name;
  return name == HenyeyGreenstein ? PhaseFunction::HenyeyGreenstein(g)
    : name == Schlick             ? PhaseFunction::Schlick(g)
    : name == DoubleHenyeyGreenstein
    ? PhaseFunction::DoubleHenyeyGreenstein(g, description.secondG[channel], description.firstPart[channel])
    : name == Rayleigh  ? PhaseFunction::Rayleigh()
    : name == Tabulated ? PhaseFunction::Tabulated(description.cosines, description.values)
                        : PhaseFunction();
}

bool NeedsG(const std::string& name)
{
  return name == HenyeyGreenstein || name == DoubleHenyeyGreenstein || name == Schlick;
}

void CheckName(const std::string& name)
{
  if (!NeedsG(name) && name != Isotropic && name != Rayleigh && name != Tabulated)
  {
    throw InvalidInput("The field data '" + std::string(NameFact) + "' is '" + name +
      "'; it must be isotropic, henyey_greenstein, double_henyey_greenstein, schlick, rayleigh or tabulated.");
  }
}

void CheckNotContradicted(const PhaseDescription& description, const PhaseFunction& function)
{
  for (const double g : description.g)
  {
    Require(std::abs(g - function.MeanCosine()) <= Contradicts,
      "The field data 'g' is " + Text("%.6g", g) + ", but the phase function '" + description.name +
        "' has the mean cosine " + Text("%.6g", function.MeanCosine()) +
        ". Take g away, or choose another phase function.");
  }
}
}

std::array<PhaseFunction, 3> PhaseDescription::Functions() const
{
  CheckName(this->name);
  std::array<PhaseFunction, 3> functions;
  const bool grey = !NeedsG(this->name) || (IsGrey(this->g) && IsGrey(this->secondG) && IsGrey(this->firstPart));
  functions[0] = functions[1] = functions[2] = PhaseFunction();
  for (int c = 0; c < 3; ++c)
  {
    try
    {
      functions[c] = grey && c > 0 ? functions[0] : FunctionOf(*this, c);
    }
    catch (const InvalidInput& error)
    {
      const std::array<const char*, 3> colours = { "red", "green", "blue" };
      throw InvalidInput(grey ? error.what() : "Of " + std::string(colours[c]) + ": " + error.what());
    }
  }
  return functions;
}

PhaseFunction PhaseDescription::KindOfVaryingG() const
{
  CheckName(this->name);
  Require(this->name == HenyeyGreenstein || this->name == Schlick,
    "There are cells 'g', but the phase function '" + this->name +
      "' has no mean cosine that could vary by voxel: choose henyey_greenstein or schlick, or take the array g away.");
  return this->name == Schlick ? PhaseFunction::Schlick(0.0) : PhaseFunction::HenyeyGreenstein(0.0);
}

PhaseDescription ReadPhaseDescription(vtkDataObject* medium)
{
  PhaseDescription description;
  description.name = ReadName(medium);
  description.g = ReadChannels(medium, GFact, 0.0);
  if (description.name == DoubleHenyeyGreenstein)
  {
    description.secondG = ReadChannels(medium, SecondFact, 0.0);
    description.firstPart = ReadChannels(medium, PartFact, 1.0);
  }
  else if (description.name == Tabulated)
  {
    description.cosines = ReadNumbers(medium, CosineFact);
    description.values = ReadNumbers(medium, ValueFact);
  }
  return description;
}

std::string PhaseInWords(vtkDataObject* medium)
{
  constexpr vtkIdType most = 9; // maximum number of values to list in a message
  std::string words;
  for (const char* name : Facts)
  {
    vtkAbstractArray* const fact = medium->GetFieldData()->GetAbstractArray(name);
    if (!fact)
    {
      continue;
    }
    words += (words.empty() ? "" : ", ") + std::string(name);
    std::string values;
    for (vtkIdType i = 0; i < fact->GetNumberOfValues(); ++i)
    {
      values += " " + fact->GetVariantValue(i).ToString();
    }
    words += fact->GetNumberOfValues() <= most ? values
                                               : " of " + std::to_string(fact->GetNumberOfValues()) + " numbers (" +
        std::to_string(std::hash<std::string>()(values) % 1000000) + ")";
  }
  return words.empty() ? "nothing" : words;
}

void WritePhaseDescription(vtkDataObject* medium, const PhaseDescription& description)
{
  for (const char* fact : Facts)
  {
    medium->GetFieldData()->RemoveArray(fact);
  }
  AddFact(medium, NameFact, std::vector<std::string>{ description.name });
  const double known = NeedsG(description.name) ? 0.0 : description.Functions()[0].MeanCosine();
  if (!description.gByVoxel)
  {
    AddChannels(medium, GFact, NeedsG(description.name) ? description.g : Rgb{ known, known, known });
  }
  if (description.name == DoubleHenyeyGreenstein)
  {
    AddChannels(medium, SecondFact, description.secondG);
    AddChannels(medium, PartFact, description.firstPart);
  }
  else if (description.name == Tabulated)
  {
    AddFact(medium, CosineFact, description.cosines);
    AddFact(medium, ValueFact, description.values);
  }
}

FloatField ReadMeanCosines(vtkImageData* image, const Field& sigma_s)
{
  FloatField g = ReadCells(image, GFact, Need::Optional, { 1, 3 });
  std::vector<float> used = WithoutUnusedCosines(g, sigma_s, GridOf(image).VoxelCount());
  return used.empty() ? g : FloatField(ArrayOf<vtkFloatArray>(GFact, std::move(used), g.Components()));
}

PhaseOfMedium ReadPhase(vtkImageData* image, const Field& g, const Field& sigma_s)
{
  const PhaseDescription description = ReadPhaseDescription(image);
  if (g.values)
  {
    const PhaseFunction kind = description.KindOfVaryingG();
    Medium medium;
    medium.grid = GridOf(image);
    medium.phase = PhaseOfMedium(kind, g);
    Check(medium);
    return PhaseByVoxel(kind, g, MeanCosineRange(g, sigma_s, medium.grid.VoxelCount()));
  }
  const std::array<PhaseFunction, 3> functions = description.Functions();
  if (!NeedsG(description.name) && image->GetFieldData()->HasArray(GFact))
  {
    CheckNotContradicted(description, functions[0]);
  }
  return PhaseOfMedium(functions);
}

void AddPhase(InputsKey& key, vtkImageData* medium)
{
  key.Add(medium->GetCellData()->GetArray(GFact));
  key.Add(medium->GetPointData()->GetArray(GFact));
  const PhaseDescription description = ReadPhaseDescription(medium);
  for (const std::vector<double>& values : { std::vector<double>(description.name.begin(), description.name.end()),
         std::vector<double>(description.g.begin(), description.g.end()),
         std::vector<double>(description.secondG.begin(), description.secondG.end()),
         std::vector<double>(description.firstPart.begin(), description.firstPart.end()), description.cosines,
         description.values })
  {
    key.Add({ static_cast<double>(values.size()) });
    key.numbers.insert(key.numbers.end(), values.begin(), values.end());
  }
}
}
