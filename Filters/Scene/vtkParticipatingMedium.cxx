#include "vtkParticipatingMedium.h"

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Common/PhaseFunctionData.h"
#include "Common/PrintMembers.h"
#include "Device/HostThreads.h"
#include "Light/LeftOut.h"
#include "Medium/OpticalSize.h"
#include "Medium/Presets.h"
#include "Numerics/NumberText.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Scene/VolumeMedium.h"

#include "vtkColorTransferFunction.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace
{
using tyndall::InvalidInput;
using tyndall::IsGrey;
using tyndall::Require;
using tyndall::Rgb;
using tyndall::Text;
using tyndall::Times;

constexpr std::size_t VoxelsOfThread = 16384; ///< smallest number of voxels that one host thread computes

/// Properties of the medium at relative density 1: sigma_s, sigma_a (1/length), emission (W/(length^3 sr)) and mean
/// cosine g, per channel, in the dataset's unit of length.
struct Recipe
{
  Rgb sigma_s;
  Rgb sigma_a;
  Rgb emission;
  Rgb g;
};

bool NotNegative(double value)
{
  return value >= 0.0 && std::isfinite(value);
}

void RequireMeanCosine(const char* property, double g)
{
  Require(std::abs(g) < 1.0, std::string(property) + " is " + Text("%g", g) + "; it must lie between -1 and 1.");
}

/// Values of a column of the table of phase function TABULATED.
/// @throws InvalidInput if the column is missing or has not one number per row
std::vector<double> ColumnOf(vtkTable* table, const char* name)
{
  vtkAbstractArray* const column = table->GetColumnByName(name);
  auto* const numbers = vtkArrayDownCast<vtkDataArray>(column);
  Require(column,
    std::string("PhaseTable has no column '") + name + "'. Its columns: " + tyndall::NamesOf(table->GetRowData()) +
      ". Rename them, or turn angles into cosines, with a Calculator.");
  Require(numbers && numbers->GetNumberOfComponents() == 1,
    std::string("PhaseTable's column '") + name + "' is not of numbers, one a row.");
  std::vector<double> values(static_cast<std::size_t>(numbers->GetNumberOfTuples()));
  for (std::size_t row = 0; row < values.size(); ++row)
  {
    values[row] = numbers->GetComponent(static_cast<vtkIdType>(row), 0);
  }
  return values;
}

/// Description of the phase function that PhaseFunction selects.
/// @param g  mean cosines of the medium, per channel
/// @param table  PhaseTable; null if none is connected
/// @throws InvalidInput if the phase function is invalid
tyndall::PhaseDescription DescriptionOf(vtkParticipatingMedium* filter, const Rgb& g, vtkTable* table)
{
  constexpr const char* names[] = { "isotropic", "henyey_greenstein", "double_henyey_greenstein", "schlick", "rayleigh",
    "tabulated" };
  RequireMeanCosine("SecondMeanCosine", filter->GetSecondMeanCosine());
  tyndall::PhaseDescription description;
  description.name = names[filter->GetPhaseFunction()];
  description.g = g;
  description.secondG.fill(filter->GetSecondMeanCosine());
  description.firstPart.fill(filter->GetFirstPart());
  if (filter->GetPhaseFunction() == vtkParticipatingMedium::TABULATED)
  {
    Require(table,
      "PhaseFunction is tabulated, but there is no PhaseTable: connect a table with the columns 'cosine' and 'value', "
      "for example of a CSV file.");
    description.cosines = ColumnOf(table, "cosine");
    description.values = ColumnOf(table, "value");
  }
  description.Functions(); // throws if the phase function is invalid
  return description;
}

Recipe CustomMedium(vtkParticipatingMedium* filter)
{
  Recipe recipe = {};
  for (int c = 0; c < 3; ++c)
  {
    const double albedo = filter->GetAlbedo()[c];
    Require(albedo >= 0.0 && albedo <= 1.0, "Albedo is " + Text("%g", albedo) + "; it must lie in [0, 1].");
    recipe.sigma_s[c] = albedo * filter->GetExtinctionScale();
    recipe.sigma_a[c] = (1.0 - albedo) * filter->GetExtinctionScale();
  }
  return recipe;
}

struct Unit
{
  const char* name;
  double millimetres;
};
/// Units of length, in the order of LengthUnits from MICROMETRES on.
constexpr std::array<Unit, 5> Units = { { { "um", 1e-3 }, { "mm", 1.0 }, { "cm", 10.0 }, { "m", 1e3 },
  { "km", 1e6 } } };

/// Length of the dataset's unit in millimetres.
double MillimetresOf(vtkParticipatingMedium* filter)
{
  const int unit = filter->GetLengthUnit();
  return unit == vtkParticipatingMedium::AS_GIVEN ? filter->GetMillimetresPerUnit()
                                                  : Units[unit - vtkParticipatingMedium::MICROMETRES].millimetres;
}

/// Edge lengths of a grid as text, in the largest unit of Units in which the longest edge is at least 1.
/// @param millimetres  length of the grid's unit in millimetres
std::string ExtentInWords(const tyndall::Grid& grid, double millimetres)
{
  const double longest = std::max({ grid.Length(0), grid.Length(1), grid.Length(2) }) * millimetres;
  Unit unit = Units.front();
  for (const Unit& larger : Units)
  {
    unit = longest >= larger.millimetres ? larger : unit;
  }
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
  {
    text += (axis > 0 ? " x " : "") + Text("%.4g", grid.Length(axis) * millimetres / unit.millimetres);
  }
  return text + " " + unit.name;
}

Recipe RealMedium(vtkParticipatingMedium* filter)
{
  const tyndall::MediumPreset& preset = tyndall::MediumPresets()[filter->GetPreset() - 1];
  const double factor = MillimetresOf(filter) * filter->GetExtinctionScale();
  return { Times(preset.sigma_s, factor), Times(preset.sigma_a, factor), {}, preset.g };
}

double LargestExtinction(const Recipe& recipe)
{
  double largest = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    largest = std::max(largest, recipe.sigma_s[c] + recipe.sigma_a[c]);
  }
  return largest;
}

/// Mean cosines per channel: ChannelMeanCosines or, if these are empty, MeanCosine.
/// @param ofChannels  ChannelMeanCosines: empty, or the mean cosines of red, green and blue
/// @throws InvalidInput if a mean cosine is outside (-1, 1), or `ofChannels` has another size
Rgb MeanCosines(vtkParticipatingMedium* filter, const std::vector<double>& ofChannels)
{
  Require(ofChannels.empty() || ofChannels.size() == 3,
    "ChannelMeanCosines has " + std::to_string(ofChannels.size()) + (ofChannels.size() == 1 ? " number" : " numbers") +
      "; it must have none, or three for red, green and blue.");
  if (ofChannels.empty())
  {
    RequireMeanCosine("MeanCosine", filter->GetMeanCosine());
    return { filter->GetMeanCosine(), filter->GetMeanCosine(), filter->GetMeanCosine() };
  }
  for (const double g : ofChannels)
  {
    RequireMeanCosine("ChannelMeanCosines", g);
  }
  return { ofChannels[0], ofChannels[1], ofChannels[2] };
}

Recipe RecipeOf(vtkParticipatingMedium* filter, const std::vector<double>& channelMeanCosines)
{
  Require(NotNegative(filter->GetExtinctionScale()),
    "ExtinctionScale is " + Text("%g", filter->GetExtinctionScale()) + "; it must be finite and not negative.");
  const Rgb g = MeanCosines(filter, channelMeanCosines); // read also with a preset, to check the values
  Recipe recipe = filter->GetPreset() == vtkParticipatingMedium::CUSTOM ? CustomMedium(filter) : RealMedium(filter);
  recipe.g = filter->GetPreset() == vtkParticipatingMedium::CUSTOM ? g : recipe.g;
  for (int c = 0; c < 3; ++c)
  {
    recipe.emission[c] = filter->GetEmissionScale() * filter->GetEmissionColor()[c];
    Require(NotNegative(recipe.emission[c]),
      "EmissionScale times EmissionColor is " + Text("%g", recipe.emission[c]) +
        "; it must be finite and not negative.");
  }
  return recipe;
}

/// Relative density of each voxel: max(0, (density - minimum) / (maximum - minimum)), above 1 beyond `maximum`.
/// @throws InvalidInput if the limits are invalid, or a density is not finite
std::vector<float> RelativeDensity(
  const tyndall::FloatField& density, const tyndall::Grid& grid, double minimum, double maximum)
{
  Require(std::isfinite(minimum) && std::isfinite(maximum) && maximum >= minimum,
    "The densities range from MinimumDensity " + Text("%g", minimum) + " to MaximumDensity " + Text("%g", maximum) +
      "; the latter must not be less.");
  const float* values = density.Values();
  std::vector<float> relative(grid.VoxelCount());
  tyndall::InThreads(relative.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
    {
      const double above = values[i] - minimum;
      relative[i] = static_cast<float>(above <= 0.0 ? 0.0 : maximum > minimum ? above / (maximum - minimum) : 1.0);
    }
  });
  const std::size_t first = tyndall::RangesOf(values, relative.size(), 1).firstNotFinite;
  if (first < relative.size())
  {
    throw InvalidInput("The density is " + Text("%g", values[first]) + " in voxel " + tyndall::VoxelName(grid, first) +
      " (the first such voxel); it must be finite.");
  }
  tyndall::RequireFinite(
    "relative density", relative.data(), relative.size(), 1,
    [&](std::size_t voxel) { return "voxel " + tyndall::VoxelName(grid, voxel); },
    "MaximumDensity less MinimumDensity is too small for the densities that there are: raise MaximumDensity.");
  return relative;
}

/// Relative density of each voxel from the signed distance to a level set (FogInside).
/// @throws InvalidInput if a distance is not finite
std::vector<float> FogOfLevelSet(const tyndall::FloatField& distance, const tyndall::Grid& grid)
{
  const float* const values = distance.Values();
  const double voxel = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  tyndall::RequireFinite(
    "distance from the level set", values, grid.VoxelCount(), 1,
    [&](std::size_t at) { return "voxel " + tyndall::VoxelName(grid, at); }, "Repair the level set.");
  std::vector<float> relative(grid.VoxelCount());
  std::transform(
    values, values + relative.size(), relative.begin(), [&](float value) { return tyndall::FogInside(value, voxel); });
  return relative;
}

/// Extreme values of an array, in the image and on its border, by which a level set is recognised.
struct Signs
{
  double lowest = AnyValue, highest = -AnyValue, lowestOnBorder = AnyValue;
  static constexpr double AnyValue = std::numeric_limits<double>::max();
};

/// Extreme values of an array, in the image and on the border of the complete grid.
/// @param box  voxels of the complete grid that the array covers
Signs SignsOf(const float* values, const tyndall::VoxelBox& box, const tyndall::Grid& whole)
{
  Signs signs;
  std::size_t i = 0;
  std::array<int, 3> at;
  const auto isBorder = [&](int axis) {
    const int place = box.first[axis] + at[axis];
    return place == 0 || place == whole.size[axis] - 1;
  };
  for (at[2] = 0; at[2] < box.size[2]; ++at[2])
  {
    for (at[1] = 0; at[1] < box.size[1]; ++at[1])
    {
      const bool rowOnBorder = isBorder(1) || isBorder(2);
      for (at[0] = 0; at[0] < box.size[0]; ++at[0], ++i)
      {
        const double value = values[i];
        signs.lowest = std::min(signs.lowest, value);
        signs.highest = std::max(signs.highest, value);
        signs.lowestOnBorder =
          rowOnBorder || isBorder(0) ? std::min(signs.lowestOnBorder, value) : signs.lowestOnBorder;
      }
    }
  }
  return signs;
}

/// Whether field data of vtkVDBReader report that an array was read from a level set.
bool WasLevelSet(vtkImageData* image, const std::string& array)
{
  auto* const kind =
    vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray(("vdb:" + array + ":class").c_str()));
  return kind && kind->GetNumberOfValues() == 1 && kind->GetValue(0) == "level set";
}

/// Sets the relative density of hidden cells to 0.
void EmptyHidden(vtkImageData* image, std::vector<float>& relative)
{
  const std::vector<unsigned char> hidden = tyndall::HiddenCells(image);
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    relative[i] = hidden[i] ? 0.0f : relative[i];
  }
}

/// @param leaveOut  whether one component is written if `factor` is grey
void AddProduct(
  vtkImageData* output, const char* name, const std::vector<float>& density, const Rgb& factor, bool leaveOut)
{
  const int components = leaveOut && IsGrey(factor) ? 1 : 3;
  std::vector<float> values(density.size() * components);
  tyndall::InThreads(density.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
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

std::vector<std::string> LeftOutOf(const Recipe& recipe)
{
  std::vector<std::string> words;
  if (IsGrey(recipe.sigma_a) && IsGrey(recipe.sigma_s))
  {
    words.emplace_back(tyndall::left_out::GreyMedium);
  }
  if (recipe.emission == Rgb{})
  {
    words.emplace_back(tyndall::left_out::NoEmission);
  }
  return words;
}

const tyndall::MediumPreset* PresetOf(int preset)
{
  const bool isThere = preset > vtkParticipatingMedium::CUSTOM && preset <= vtkParticipatingMedium::SKIN_2;
  return isThere ? &tyndall::MediumPresets()[preset - 1] : nullptr;
}

/// Adds the arrays of a medium of a density.
/// @return the relative density of each voxel
std::vector<float> AddMediumOfDensity(
  vtkParticipatingMedium* filter, const Recipe& recipe, vtkImageData* input, vtkImageData* output)
{
  const tyndall::FloatField density = tyndall::ReadChosenCells(filter, 0, input, "", tyndall::Need::Required, { 1 });
  const tyndall::Grid grid = tyndall::GridOf(input);
  std::vector<float> relative = filter->GetLevelSet()
    ? FogOfLevelSet(density, grid)
    : RelativeDensity(density, grid, filter->GetMinimumDensity(), filter->GetMaximumDensity());
  EmptyHidden(input, relative);
  const bool leaveOut = filter->GetLeaveOut();
  AddProduct(output, "sigma_a", relative, recipe.sigma_a, leaveOut);
  AddProduct(output, "sigma_s", relative, recipe.sigma_s, leaveOut);
  if (recipe.emission != Rgb{} ||
    (!leaveOut && !tyndall::ReadCells(output, "emission", tyndall::Need::Optional).IsThere()))
  {
    AddProduct(output, "emission", relative, recipe.emission, leaveOut);
  }
  return relative;
}

/// The transfer functions, and what a medium takes of them.
tyndall::VolumeAppearance AppearanceOf(vtkParticipatingMedium* filter, const tyndall::PhaseDescription& phase)
{
  tyndall::VolumeAppearance appearance;
  appearance.property = filter->GetVolumeProperty();
  appearance.colorIsEmission = filter->GetColorMeans() == vtkParticipatingMedium::EMISSION;
  appearance.factor = filter->GetExtinctionScale();
  appearance.vectorMode = filter->GetVectorMode();
  appearance.vectorComponent = filter->GetVectorComponent();
  const std::array<tyndall::PhaseFunction, 3> phases = phase.Functions();
  for (int c = 0; c < 3; ++c)
  {
    appearance.g[c] = phases[c].MeanCosine();
  }
  return appearance;
}

/// Computes the output of this rank from its piece of the input.
/// @return values of voxels to which the extinction is proportional: by recipe.sigma_t, or with transfer functions by 1
std::vector<float> FillMedium(vtkParticipatingMedium* filter, const Recipe& recipe, vtkImageData* input,
  vtkInformationVector* phaseTable, vtkImageData* output)
{
  const tyndall::PhaseDescription phase = DescriptionOf(filter, recipe.g, vtkTable::GetData(phaseTable));
  tyndall::PassOn(input, output);
  tyndall::ForgetChoices(output);
  std::vector<float> relative = filter->GetUseTransferFunctions()
    ? tyndall::AddMediumOfVolume(filter, AppearanceOf(filter, phase), input, output)
    : AddMediumOfDensity(filter, recipe, input, output);
  tyndall::WritePhaseDescription(output, phase);
  const tyndall::FloatField scattering = tyndall::ReadCells(output, "sigma_s", tyndall::Need::Required);
  if (const tyndall::FloatField g = tyndall::ReadMeanCosines(output, scattering); g.IsThere())
  {
    tyndall::ReadPhase(output, g, scattering); // throws if the input's phase function is invalid
  }
  return relative;
}
}

vtkStandardNewMacro(vtkParticipatingMedium);

vtkParticipatingMedium::vtkParticipatingMedium()
{
  this->SetNumberOfInputPorts(2);
}

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

void vtkParticipatingMedium::SetVolumeProperty(vtkVolumeProperty* property)
{
  if (this->VolumeProperty != property)
  {
    this->VolumeProperty = property ? vtk::MakeSmartPointer(property) : vtkSmartPointer<vtkVolumeProperty>::New();
    this->HasFunctions = property != nullptr;
    this->Modified();
  }
}

void vtkParticipatingMedium::SetLookupTable(vtkScalarsToColors* colors)
{
  auto* const function = vtkColorTransferFunction::SafeDownCast(colors);
  if (colors && !function)
  {
    vtkErrorMacro("The colours are a " << colors->GetClassName() << "; they must be a vtkColorTransferFunction.");
    return;
  }
  this->HasFunctions = this->HasFunctions || function;
  this->VolumeProperty->SetColor(function);
}

void vtkParticipatingMedium::SetScalarOpacityFunction(vtkPiecewiseFunction* opacities)
{
  this->HasFunctions = this->HasFunctions || opacities;
  this->VolumeProperty->SetScalarOpacity(opacities);
}

void vtkParticipatingMedium::SetScalarOpacityUnitDistance(double distance)
{
  this->VolumeProperty->SetScalarOpacityUnitDistance(distance);
}

void vtkParticipatingMedium::SetMapScalars(bool independent)
{
  this->VolumeProperty->SetIndependentComponents(independent ? 1 : 0);
}

void vtkParticipatingMedium::SetInterpolateScalars(bool linear)
{
  this->VolumeProperty->SetInterpolationType(linear ? VTK_LINEAR_INTERPOLATION : VTK_NEAREST_INTERPOLATION);
}

vtkMTimeType vtkParticipatingMedium::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->UseTransferFunctions ? std::max(own, this->VolumeProperty->GetMTime()) : own;
}

void vtkParticipatingMedium::SetChannelMeanCosines(double red, double green, double blue)
{
  this->ChannelMeanCosines = { red, green, blue };
  this->Modified();
}

void vtkParticipatingMedium::AddChannelMeanCosine(double g)
{
  this->ChannelMeanCosines.push_back(g);
  this->Modified();
}

void vtkParticipatingMedium::RemoveAllChannelMeanCosines()
{
  this->ChannelMeanCosines.clear();
  this->Modified();
}

int vtkParticipatingMedium::GetNumberOfChannelMeanCosines() const
{
  return static_cast<int>(this->ChannelMeanCosines.size());
}

int vtkParticipatingMedium::FillInputPortInformation(int port, vtkInformation* information)
{
  if (port == DENSITY)
  {
    tyndall::TakeImages(information);
    tyndall::ReadsVoxels(information, { "" }, { "g" });
  }
  else
  {
    information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkTable");
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkParticipatingMedium::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int done = this->Superclass::RequestInformation(request, inputs, outputs);
  tyndall::TellVoxels(this, DENSITY, inputs[DENSITY], outputs);
  return done;
}

/// Requests the piece of the density that matches the requested output if each rank requests its own piece; otherwise
/// requests the complete density, whose size PhysicalExtent reports. Transfer functions need the scalars of
/// neighbouring voxels, too, and therefore the complete image.
int vtkParticipatingMedium::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  if (!this->UseTransferFunctions && tyndall::EachAsksForItsPiece(request, outputs))
  {
    tyndall::AskForSame(request, inputs[DENSITY], outputs);
  }
  else
  {
    tyndall::AskForAll(request, inputs[DENSITY], outputs);
  }
  tyndall::AskForAll(request, inputs[PHASE_TABLE], outputs);
  return done;
}

void vtkParticipatingMedium::NoteSize(const tyndall::Grid& grid, const tyndall::OpticalSize& size)
{
  constexpr double thinnest = 0.01;
  constexpr double thickest = 1e6;
  this->PhysicalExtent = ExtentInWords(grid, MillimetresOf(this));
  this->OpticalThickness = size.thickness;
  this->MeanFreePath = size.meanFreePath;
  if (size.thickness > 0.0 && (size.thickness < thinnest || size.thickness > thickest))
  {
    const bool thin = size.thickness < thinnest;
    vtkWarningMacro("The medium's optical thickness is "
      << Text("%g", size.thickness) << " at most, along x, y or z: "
      << (thin ? "hardly any light meets it" : "no light comes deeper than its outermost voxels") << ". Look at "
      << (this->UseTransferFunctions ? "the opacities, ExtinctionScale and ScalarOpacityUnitDistance"
             : this->Preset == CUSTOM
             ? "ExtinctionScale and MaximumDensity"
             : "LengthUnit (the dataset is " + this->PhysicalExtent + " large) and MaximumDensity")
      << ".");
  }
}

/// Warns if the density looks like a level set. Collective.
/// @param box  voxels of the complete grid that the image covers
void vtkParticipatingMedium::DoubtLevelSet(
  const tyndall::Domain& domain, vtkImageData* image, const tyndall::VoxelBox& box)
{
  constexpr double small = 0.01; // negative values down to minus this fraction of the largest value are noise about 0
  if (this->LevelSet || this->UseTransferFunctions)
  {
    return;
  }
  Signs signs;
  double said = 0.0;
  if (box.VoxelCount() > 0)
  {
    const tyndall::FloatField density = tyndall::ReadChosenCells(this, 0, image, "", tyndall::Need::Required, { 1 });
    signs = SignsOf(density.Values(), box, domain.Whole());
    vtkDataArray* const array = tyndall::ChosenArray(this, 0, image, "");
    said = WasLevelSet(image, array->GetName() ? array->GetName() : "") ? 1.0 : 0.0;
  }
  const std::vector<double> all = domain.Comm().Largest({ -signs.lowest, signs.highest, -signs.lowestOnBorder, said });
  const bool isInside = -all[0] < 0.0 && all[1] > 0.0;
  const bool looksSo = -all[2] > 0.0 && all[0] > small * all[1] && this->MinimumDensity >= 0.0;
  if (isInside && (all[3] > 0.0 || looksSo))
  {
    vtkWarningMacro(
      "The density is negative inside of the image and positive around, as a level set (the distance from a "
      "surface) is. As a density it has no fog inside of the surface, and fog outside. Switch LevelSet on "
      "for fog inside of it, or LevelSetsAsFog of vtkVDBReader.");
  }
}

int vtkParticipatingMedium::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->PhysicalExtent.clear();
  this->OpticalThickness = 0.0;
  this->MeanFreePath = 0.0;
  const bool asksForPiece = !this->UseTransferFunctions && tyndall::EachAsksForItsPiece(request, outputs);
  tyndall::WorkOnSubdomains work;
  work.port = DENSITY;
  work.wholeOnEachRank = true; // each cell depends only on its own density
  work.wantsPieces = [&](vtkInformationVector**) { return asksForPiece; };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    if (pieces.GetDomain().Any(pieces.IsDecomposed() && !asksForPiece))
    {
      return false;
    }
    this->MakeMedium(pieces, inputs, vtkImageData::GetData(outputs));
    return true;
  };
  return tyndall::Guarded(this, request, given, outputs, work);
}

/// Computes the medium of this rank's piece of the density, and sets the properties that report the size of the
/// complete dataset. Collective.
void vtkParticipatingMedium::MakeMedium(
  const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkImageData* output)
{
  vtkImageData* const input = vtkImageData::GetData(inputs[DENSITY]);
  const tyndall::Domain& domain = pieces.GetDomain();
  Recipe recipe;
  std::vector<double> sums;
  domain.Collective([&] {
    Require(!this->UseTransferFunctions || this->HasFunctions,
      "There are no transfer functions: color the input by an array as a Volume before UseTransferFunctions is "
      "switched on, or set LookupTable and ScalarOpacityFunction, or VolumeProperty.");
    recipe = RecipeOf(this, this->ChannelMeanCosines);
    std::vector<float> relative;
    if (pieces.HasOwn() || !pieces.IsDecomposed())
    {
      relative = pieces.OwnOf(input, FillMedium(this, recipe, input, inputs[PHASE_TABLE], output));
    }
    sums = tyndall::OpticalSumsOf(relative.data(), pieces.Own(), domain.Whole());
  });
  const tyndall::VoxelBox all = { { 0, 0, 0 }, domain.Whole().size };
  const bool hasAll = input && input->GetNumberOfCells() == static_cast<vtkIdType>(all.VoxelCount());
  this->DoubtLevelSet(domain, input, hasAll ? all : pieces.Held());
  const double extinction = this->UseTransferFunctions ? 1.0 : LargestExtinction(recipe);
  this->NoteSize(domain.Whole(), tyndall::OpticalSizeOf(domain.Sum(sums), domain.Whole(), extinction));
  pieces.KeepHeld(output);
  const bool leavesOut = this->LeaveOut && !this->UseTransferFunctions;
  tyndall::TellLeftOut(this, output, leavesOut ? LeftOutOf(recipe) : std::vector<std::string>());
}

void vtkParticipatingMedium::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PointData, UseTransferFunctions, VectorMode, VectorComponent, ColorMeans);
  os << indent << "VolumeProperty:\n";
  this->VolumeProperty->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Preset: " << (this->Preset == CUSTOM ? "custom" : GetPresetName(this->Preset)) << "\n";
  tyndallPrintMacro(MinimumDensity, MaximumDensity, LevelSet, ExtinctionScale, Albedo, PhaseFunction, MeanCosine);
  os << indent << "ChannelMeanCosines: " << this->ChannelMeanCosines.size() << " numbers\n";
  tyndallPrintMacro(SecondMeanCosine, FirstPart, EmissionScale, EmissionColor, LengthUnit, LeaveOut, PhysicalExtent,
    OpticalThickness, MeanFreePath, MillimetresPerUnit);
  tyndall::PrintRun(os, indent, this);
}
