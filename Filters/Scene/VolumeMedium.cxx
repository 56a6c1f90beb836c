#include "Scene/VolumeMedium.h"

#include "Common/CellArrays.h"
#include "Common/LightTransportWriting.h"
#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Medium/Grid.h"
#include "vtkParticipatingMedium.h"

#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int AllComponents = -1, Magnitude = -2; ///< besides the numbers of components

/// Component that is the scalar of an array of several, or AllComponents, or Magnitude.
int ScalarOf(const VolumeAppearance& appearance, int components)
{
  vtkVolumeProperty* const property = appearance.property;
  int mode = appearance.vectorMode, component = appearance.vectorComponent;
  if (mode == vtkParticipatingMedium::AS_COLORS)
  {
    vtkColorTransferFunction* const colors = property->GetRGBTransferFunction();
    Require(components == 1 || !property->GetIndependentComponents() ||
        colors->GetVectorMode() != vtkScalarsToColors::RGBCOLORS,
      "The colour map takes the components of the array as colours: choose its magnitude or a component, or switch "
      "MapScalars off for an array of 2 or 4 components.");
    mode = colors->GetVectorMode() == vtkScalarsToColors::MAGNITUDE ? vtkParticipatingMedium::MAGNITUDE
                                                                    : vtkParticipatingMedium::COMPONENT;
    component = std::max(colors->GetVectorComponent(), 0);
  }
  if (components == 1 || !property->GetIndependentComponents() || mode == vtkParticipatingMedium::ALL_COMPONENTS)
  {
    return AllComponents;
  }
  Require(mode == vtkParticipatingMedium::MAGNITUDE || component < components,
    "VectorComponent is " + std::to_string(component) + ", but the array has " + std::to_string(components) +
      " components, counted from 0.");
  return mode == vtkParticipatingMedium::MAGNITUDE ? Magnitude : component;
}

/// Scalars on a lattice, with the memory of their values.
struct VolumeScalars
{
  ScalarLattice lattice;
  std::vector<float> values;

  /// Takes the scalars of an array, by AllComponents, Magnitude or a component. Scalars at hidden sites are NaN.
  void Take(const FloatField& array, int chosen, const std::vector<unsigned char>& hidden)
  {
    const int given = array.Components();
    const int taken = chosen == AllComponents ? given : 1;
    const std::size_t sites = Grid{ this->lattice.size }.VoxelCount();
    this->values.resize(sites * taken);
    InThreads(sites, 65536, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
      {
        const float* const from = array.Values() + i * given;
        float* const to = this->values.data() + i * taken;
        if (!hidden.empty() && hidden[i])
        {
          std::fill_n(to, taken, std::numeric_limits<float>::quiet_NaN());
        }
        else if (chosen == Magnitude)
        {
          *to = static_cast<float>(std::sqrt(std::inner_product(from, from + given, from, 0.0)));
        }
        else
        {
          std::copy_n(from + std::max(chosen, 0), taken, to);
        }
      }
    });
    this->lattice.components = taken;
    this->lattice.values = this->values.data();
  }

  /// Ranges of the finite scalars of each component; [0, 0] if there are none.
  std::vector<ScalarRange> Ranges() const
  {
    constexpr double most = std::numeric_limits<double>::max();
    const std::size_t components = static_cast<std::size_t>(this->lattice.components);
    std::vector<ScalarRange> ranges(components, { most, -most });
    for (std::size_t i = 0; i < this->values.size(); ++i)
    {
      ScalarRange& range = ranges[i % components];
      const double value = this->values[i];
      if (std::isfinite(value))
      {
        range = { std::min(range[0], value), std::max(range[1], value) };
      }
    }
    for (ScalarRange& range : ranges)
    {
      range = range[0] <= range[1] ? range : ScalarRange{};
    }
    return ranges;
  }
};

/// The scalars of an image as a volume interpolates them: between points, or between the centres of cells.
VolumeScalars ScalarsOf(vtkAlgorithm* filter, const VolumeAppearance& appearance, vtkImageData* image)
{
  using Sites = ScalarLattice::Sites;
  vtkDataArray* const array = ChosenArray(filter, 0, image, "");
  const bool areCorners = array && array->GetNumberOfTuples() == image->GetNumberOfPoints();
  const FloatField field =
    areCorners ? FloatField(AsFloats(array)) : ReadChosenCells(filter, 0, image, "", Need::Required, {});
  VolumeScalars scalars;
  scalars.lattice.sites = areCorners ? Sites::Corners
    : AreMadeAroundPoints(image)     ? Sites::CentresWithin
                                     : Sites::Centres;
  scalars.lattice.nearest = appearance.property->GetInterpolationType() == VTK_NEAREST_INTERPOLATION;
  const Grid grid = GridOf(image);
  for (int axis = 0; axis < 3; ++axis)
  {
    scalars.lattice.size[axis] = grid.size[axis] + (areCorners ? 1 : 0);
  }
  scalars.Take(
    field, ScalarOf(appearance, field.Components()), areCorners ? std::vector<unsigned char>() : HiddenCells(image));
  return scalars;
}

/// Values `first` to `first + components - 1` of all values of each voxel.
std::vector<float> PartOf(const std::vector<float>& all, int valueCount, int first, int components)
{
  std::vector<float> part;
  part.reserve(all.size() / valueCount * components);
  for (std::size_t at = first; at < all.size(); at += valueCount)
  {
    part.insert(part.end(), all.begin() + at, all.begin() + at + components);
  }
  return part;
}
}

std::vector<float> AddMediumOfVolume(
  vtkAlgorithm* filter, VolumeAppearance appearance, vtkImageData* input, vtkImageData* output)
{
  const Grid grid = GridOf(input);
  appearance.shortestSpacing = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  const VolumeScalars scalars = ScalarsOf(filter, appearance, input);
  const std::unique_ptr<VolumeCoefficients> coefficients = CoefficientsOf(appearance, scalars.Ranges());
  const int count = coefficients->ValueCount(), channels = coefficients->Channels;
  std::vector<float> means = VoxelMeans(scalars.lattice, grid.size, *coefficients);
  const std::vector<unsigned char> hidden = HiddenCells(input);
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    std::fill_n(means.begin() + i * count, hidden[i] ? count : 0, 0.0f);
  }
  std::vector<float> extinction = PartOf(means, count, 0, 1);
  if (coefficients->IsEmission)
  {
    AddCells(output, "emission", PartOf(means, count, 1, channels), channels);
    AddCells(output, "sigma_a", std::vector<float>(extinction), 1);
    AddCells(output, "sigma_s", std::vector<float>(extinction.size(), 0.0f), 1);
    return extinction;
  }
  std::vector<float> absorption = PartOf(means, count, channels, channels);
  for (std::size_t i = 0; i < extinction.size(); ++i)
  {
    extinction[i] += absorption[i * channels];
  }
  AddCells(output, "sigma_a", std::move(absorption), channels);
  AddCells(output, "sigma_s", PartOf(means, count, 0, channels), channels);
  return extinction;
}
}
