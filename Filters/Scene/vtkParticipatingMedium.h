#ifndef vtkParticipatingMedium_h
#define vtkParticipatingMedium_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkSmartPointer.h"
#include "vtkTyndallModule.h" // for export macro
#include "vtkVolumeProperty.h"

#include <string>
#include <vector>

class vtkPiecewiseFunction;
class vtkScalarsToColors;

namespace tyndall
{
class Domain;
struct Grid;
struct OpticalSize;
class PieceBlocks;
struct VoxelBox;
}

/**
 * @class vtkParticipatingMedium
 * @brief converts a density to a medium that absorbs, scatters and emits light
 *
 * Input: vtkImageData with a cell or point array of one component (SetPointData): the active scalars, or the array
 * selected by SetInputArrayToProcess(0, ...). An input array `g` (1 or 3 components), for example of a mixture, is the
 * mean cosine per voxel; it is copied to the output and takes precedence over MeanCosine.
 *
 * Input 1, optional: vtkTable with the columns `cosine` and `value`, the phase function if PhaseFunction is TABULATED.
 *
 * Output: the input with the cell arrays
 *
 * | array      | components           | unit              |
 * |------------|----------------------|-------------------|
 * | `sigma_a`  | 1, or 3 if coloured  | 1/length          |
 * | `sigma_s`  | 1, or 3 if coloured  | 1/length          |
 * | `emission` | 1 or 3; only if EmissionScale is not 0 | W/(length^3 sr) |
 *
 * and the phase function as field data: `phase_function` (name), `g` (mean cosine; 3 numbers if channels differ), and
 * if needed `phase_second_g`, `phase_first_part`, `phase_cosine`, `phase_value`; and `left_out` (components and arrays
 * that the medium does not need). Lengths are in the dataset's own unit.
 *
 * With the relative density rho = (density - MinimumDensity) / (MaximumDensity - MinimumDensity), at least 0:
 *
 *     sigma_t  = rho ExtinctionScale
 *     sigma_s  = Albedo sigma_t,   sigma_a = (1 - Albedo) sigma_t
 *     emission = rho EmissionScale EmissionColor
 *
 * With LevelSet the array is a signed distance from a surface, negative inside: rho is 1 inside, decreases linearly
 * within one voxel of the surface, and is 0 outside. A level set used as a density would fill the outside of the
 * surface. A warning is issued if field data of vtkVDBReader report that the array is a level set, or if it is negative
 * inside the image and positive on its border.
 *
 * A preset provides measured sigma_s, sigma_a (1/mm at rho = 1) and g of a medium, which replace Albedo and MeanCosine;
 * ExtinctionScale multiplies the coefficients (1: as measured), and LengthUnit or MillimetresPerUnit sets the length of
 * the dataset's unit.
 *
 * With UseTransferFunctions the medium is made of the colours and opacities with which a volume is rendered
 * (numerics.md, section 2.4). With the opacity alpha(s) per unit distance u, the colour c(s) and the shortest spacing
 * h:
 *
 *     sigma_t = ExtinctionScale min(-ln(1 - alpha(s)) / u, 16 / h)
 *
 * and with ColorMeans ALBEDO the albedo is that of a half-space that shows the colour c along its normal in uniform
 * light of radiance 1, at most 0.9999 by similarity; with EMISSION, sigma_s is 0 and emission is sigma_t c, c decoded
 * from sRGB. The coefficients of a voxel are their means over the scalars that are interpolated in it, as vtkVolume
 * interpolates them (a new vtkVolumeProperty takes the nearest scalar instead): between points, empty beyond the
 * outermost ones; between centres of cells, constant beyond. Where scalars are not numbers, or hidden, the medium is
 * empty. Density, preset, albedo and emission properties are then ignored.
 *
 * An optical thickness above 0 but below 0.01, or above 1e6, causes a warning, because it is seldom intended.
 *
 * Cells that are hidden by `vtkGhostType` are empty.
 *
 * @sa vtkLightPropagationMaps
 */
class TYNDALL_EXPORT vtkParticipatingMedium : public vtkImageAlgorithm
{
public:
  static vtkParticipatingMedium* New();
  vtkTypeMacro(vtkParticipatingMedium, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Media for SetPreset, with the meaning of relative density rho = 1. GetPresetSource returns the source of the data
  /// of a medium.
  enum Presets
  {
    CUSTOM = 0,
    CLOUD,     ///< rho = 1: 1 g of liquid water per cubic metre, droplets of 10 um
    FOG,       ///< rho = 1: 1 droplet per cubic centimetre
    SMOKE,     ///< rho = 1: 1 g of soot per cubic metre
    SKIM_MILK, ///< rho = 1, from SKIM_MILK to SKIN_2: the medium as measured
    WHOLE_MILK,
    CREAM,
    ESPRESSO,
    KETCHUP,
    MARBLE,
    SKIN_1,
    SKIN_2
  };

  ///@{
  /// Medium whose properties are used, one of Presets. Default CUSTOM: uses Albedo and MeanCosine. PhaseFunction
  /// applies to presets, too; their data are for HENYEY_GREENSTEIN, which is isotropic for g = 0.
  tyndallRangeMacro(Preset, int, CUSTOM, SKIN_2);
  ///@}

  ///@{
  /// Name, meaning of relative density 1, and source of a preset; empty for CUSTOM.
  static const char* GetPresetName(int preset);
  static const char* GetPresetDensity(int preset);
  static const char* GetPresetSource(int preset);
  ///@}

  ///@{
  /// How point arrays are read. 0 (default): each point is the centre of a voxel with its value: n points make n
  /// voxels, the output has cell arrays, and its bounds are half a spacing wider than the input's. 1: points are
  /// averaged to the voxels between them: n points make n - 1 voxels. If a cell array is read as well, the cells are
  /// the voxels and points are averaged; field data `settings_used` then report it.
  tyndallPointDataMacro();
  ///@}

  ///@{
  /// Whether the medium is made of the transfer functions of VolumeProperty, instead of a density. Default off.
  tyndallFlagMacro(UseTransferFunctions);
  ///@}

  ///@{
  /// Colours, opacities, unit distance, components, their weights and interpolation for UseTransferFunctions, as
  /// vtkVolume uses them. Never null; the default is that of a new vtkVolumeProperty. Transfer functions of two
  /// dimensions and gradient opacity are errors; shading is ignored. Null replaces it by a new one.
  void SetVolumeProperty(vtkVolumeProperty* property);
  vtkVolumeProperty* GetVolumeProperty() { return this->VolumeProperty; }
  ///@}

  ///@{
  /// Set VolumeProperty's colours (a vtkColorTransferFunction, else an error), opacities, unit distance (length, above
  /// 0, default 1), whether scalars of several components are independent (MapScalars), and whether scalars are
  /// interpolated linearly.
  void SetLookupTable(vtkScalarsToColors* colors);
  void SetScalarOpacityFunction(vtkPiecewiseFunction* opacities);
  void SetScalarOpacityUnitDistance(double distance);
  void SetMapScalars(bool independent);
  void SetInterpolateScalars(bool linear);
  ///@}

  /// Which scalar independent components have, for SetVectorMode.
  enum VectorModes
  {
    ALL_COMPONENTS = -1, ///< each component has its own transfer functions
    MAGNITUDE = 0,
    COMPONENT = 1, ///< the component VectorComponent
    AS_COLORS = 2  ///< vector mode and component of the colours; those of a new vtkColorTransferFunction: component 0
  };

  ///@{
  /// The scalar of arrays of several components for UseTransferFunctions, one of VectorModes, unless components are
  /// dependent; and the component, from 0. Defaults AS_COLORS, 0.
  tyndallRangeMacro(VectorMode, int, ALL_COMPONENTS, AS_COLORS);
  tyndallRangeMacro(VectorComponent, int, 0, VTK_INT_MAX);
  ///@}

  /// What colours mean, for SetColorMeans.
  enum ColorMeanings
  {
    ALBEDO = 0,  ///< scattered light: the colour of a thick medium in white light
    EMISSION = 1 ///< light that the medium emits, such as a flame or a plasma: the radiance of a thick medium
  };

  ///@{
  /// Meaning of the colours for UseTransferFunctions, one of ColorMeanings. Default ALBEDO.
  tyndallRangeMacro(ColorMeans, int, ALBEDO, EMISSION);
  ///@}

  ///@{
  /// Density that has relative density 0: voxels of this or a smaller density are vacuum. Default 0.
  tyndallRangeMacro(MinimumDensity, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Density that has relative density 1; relative density grows linearly beyond it. Default 1, valid from
  /// MinimumDensity on; if equal to MinimumDensity, every larger density has relative density 1.
  tyndallRangeMacro(MaximumDensity, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Whether the array is a level set: signed distance from a surface in the dataset's unit, negative inside. Default
  /// off. On: the relative density is 1 inside, with a linear ramp of one voxel (its shortest edge) at the surface;
  /// MinimumDensity and MaximumDensity are ignored.
  tyndallFlagMacro(LevelSet);
  ///@}

  ///@{
  /// Extinction coefficient sigma_t at relative density 1, 1/length; with a preset or transfer functions, a factor
  /// of their coefficients. Default 1, valid [0, infinity).
  tyndallRangeMacro(ExtinctionScale, double, 0.0, tyndall::LargestFloat);
  ///@}

  ///@{
  /// Single-scattering albedo sigma_s / sigma_t; red, green, blue. Default (0.9, 0.9, 0.9), valid [0, 1]. Ignored with
  /// a preset.
  tyndallSetRange3Macro(Albedo, double, 0.0, 1.0);
  vtkGetVector3Macro(Albedo, double);
  ///@}

  /// Names of phase functions, for SetPhaseFunction.
  enum PhaseFunctions
  {
    ISOTROPIC = 0,
    HENYEY_GREENSTEIN,
    DOUBLE_HENYEY_GREENSTEIN, ///< FirstPart of the light scatters with MeanCosine, the rest with SecondMeanCosine
    SCHLICK,
    RAYLEIGH, ///< phase function of particles much smaller than the wavelength
    TABULATED ///< phase function from PhaseTable
  };

  ///@{
  /// Phase function of the medium, one of PhaseFunctions. Default HENYEY_GREENSTEIN.
  tyndallRangeMacro(PhaseFunction, int, ISOTROPIC, TABULATED);
  ///@}

  ///@{
  /// Mean cosine g of the scattering angle (HENYEY_GREENSTEIN, SCHLICK; for DOUBLE_HENYEY_GREENSTEIN, of the first
  /// lobe): 0 isotropic, near 1 forward. Default 0, valid (-1, 1). Ignored with a preset, which defines g.
  tyndallRangeMacro(MeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// Mean cosines of red, green and blue, which replace MeanCosine; AddChannelMeanCosine adds one per call. None
  /// (default) or three, valid (-1, 1).
  void SetChannelMeanCosines(double red, double green, double blue);
  void AddChannelMeanCosine(double g);
  void RemoveAllChannelMeanCosines();
  int GetNumberOfChannelMeanCosines() const;
  ///@}

  ///@{
  /// Mean cosine of the second lobe of DOUBLE_HENYEY_GREENSTEIN. Default 0, valid (-1, 1).
  tyndallRangeMacro(SecondMeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// Fraction of the light that the first lobe of DOUBLE_HENYEY_GREENSTEIN scatters. Default 1, valid [0, 1].
  tyndallRangeMacro(FirstPart, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Phase function for PhaseFunction TABULATED: a table with the columns `cosine` (of the scattering angle, from -1 to
  /// 1, ascending or descending) and `value` (not negative, in any unit). Values are interpolated linearly between
  /// rows.
  tyndallInputMacro(PhaseTable, PHASE_TABLE);
  ///@}

  ///@{
  /// Emitted radiance per unit length at relative density 1, W/(length^3 sr); multiplied by EmissionColor. Default 0,
  /// valid [0, infinity).
  tyndallRangeMacro(EmissionScale, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Factors of EmissionScale for red, green and blue. Default (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(EmissionColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(EmissionColor, double);
  ///@}

  /// Units of length, for SetLengthUnit.
  enum LengthUnits
  {
    AS_GIVEN = 0, ///< unit of length of MillimetresPerUnit millimetres
    MICROMETRES,
    MILLIMETRES,
    CENTIMETRES,
    METRES,
    KILOMETRES
  };

  ///@{
  /// The dataset's unit of length, one of LengthUnits; needed for presets. Default AS_GIVEN.
  tyndallRangeMacro(LengthUnit, int, AS_GIVEN, KILOMETRES);
  ///@}

  ///@{
  /// Length of the dataset's unit in millimetres if LengthUnit is AS_GIVEN: 1 for a scan in mm, 1000 for metres.
  /// Default 1, valid (0, infinity).
  tyndallRangeMacro(MillimetresPerUnit, double, tyndall::AboveZero, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Whether a grey medium has arrays of one component, and a medium that does not emit has no array `emission`.
  /// Default on; off: for comparison, three components and an emission of 0.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Size of the complete dataset at the last update, the same on every rank: its edges with their unit of length, such
  /// as "480 x 480 x 240 m"; the largest optical thickness of a row of voxels along x, y or z, dimensionless; and the
  /// mean free path, 1 over the mean extinction of the voxels that are not empty, in the dataset's unit (0 if all are
  /// empty). Optical thickness and mean free path refer to the channel with the largest extinction. The values are 0
  /// and empty before the first update and after an error.
  vtkGetCharFromStdStringMacro(PhysicalExtent);
  vtkGetMacro(OpticalThickness, double);
  vtkGetMacro(MeanFreePath, double);
  ///@}

  ///@{
  /// Results of the last update: run time in seconds, and the arrays or components that the medium does not need, one
  /// per line (also field data `left_out`).
  tyndallSecondsMacro();
  tyndallLeftOutMacro();
  ///@}

  /// Time of the latest modification of this object, or of VolumeProperty if it is used.
  vtkMTimeType GetMTime() override;

protected:
  enum Inputs
  {
    DENSITY = 0,
    PHASE_TABLE = 1
  };

  vtkParticipatingMedium();
  ~vtkParticipatingMedium() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkParticipatingMedium(const vtkParticipatingMedium&) = delete;
  void operator=(const vtkParticipatingMedium&) = delete;

  /// Sets PhysicalExtent, OpticalThickness and MeanFreePath; warns if the optical thickness is above 0 and below 0.01,
  /// or above 1e6.
  void NoteSize(const tyndall::Grid& grid, const tyndall::OpticalSize& size);
  void DoubtLevelSet(const tyndall::Domain& domain, vtkImageData* image, const tyndall::VoxelBox& box);
  void MakeMedium(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkImageData* output);

  bool UseTransferFunctions = false;
  vtkSmartPointer<vtkVolumeProperty> VolumeProperty = vtkSmartPointer<vtkVolumeProperty>::New();
  bool HasFunctions = false; ///< whether VolumeProperty, or any of its functions, has been set
  int VectorMode = AS_COLORS;
  int VectorComponent = 0;
  int ColorMeans = ALBEDO;
  int Preset = CUSTOM;
  int PointData = VOXELS_AROUND_POINTS;
  double MinimumDensity = 0.0;
  double MaximumDensity = 1.0;
  bool LevelSet = false;
  double ExtinctionScale = 1.0;
  double Albedo[3] = { 0.9, 0.9, 0.9 };
  int PhaseFunction = HENYEY_GREENSTEIN;
  double MeanCosine = 0.0;
  std::vector<double> ChannelMeanCosines;
  double SecondMeanCosine = 0.0;
  double FirstPart = 1.0;
  double EmissionScale = 0.0;
  double EmissionColor[3] = { 1.0, 1.0, 1.0 };
  int LengthUnit = AS_GIVEN;
  double MillimetresPerUnit = 1.0;
  bool LeaveOut = true;
  std::string PhysicalExtent;
  double OpticalThickness = 0.0;
  double MeanFreePath = 0.0;
};

#endif
