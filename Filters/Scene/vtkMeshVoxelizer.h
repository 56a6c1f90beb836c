#ifndef vtkMeshVoxelizer_h
#define vtkMeshVoxelizer_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
struct RefractiveMedium;
struct Solid;
}

/**
 * @class vtkMeshVoxelizer
 * @brief turns closed meshes into a medium of voxels, for light that is bent by its refractive index
 *
 * Input, repeatable: vtkPolyData, each closed; polygons and strips are triangulated, points at the same place count as
 * one. Where meshes overlap, the later input is there.
 *
 * Optional cell array `material_id` (whole numbers), or that chosen by SetInputArrayToProcess(0, ...): the material of
 * each cell. The cells of each number must be closed by themselves; where they overlap, the higher number is there.
 * Without it the number of the input, from 0 on, is its material; one that was chosen must be there in one input at
 * least. Materials are added by AddMaterial; those that are not there have the Inside properties.
 *
 * Output: vtkImageData with the cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `occupancy` | 1 | 1 | part of the voxel inside any mesh, the active scalars |
 * | `ior` | 1 | 1 | refractive index n, smoothed |
 * | `ior_gradient` | 3 | 1/length | its gradient by central differences; not where n is constant |
 * | `sigma_a` | 1, or 3 where it has colour | 1/length | absorption coefficient |
 * | `sigma_s` | 1, or 3 where it has colour | 1/length | scattering coefficient |
 * | `g` | 1, or 3 where `sigma_s` or `sigma_a` has colour | 1 | mean cosine, where scattering materials differ in it |
 *
 * and the field data `phase_function`, `g` (mean cosine, where all voxels have one), `left_out` (what the scene did not
 * need) and `device`. Lengths are in the dataset's own unit.
 *
 * A voxel is divided into SupersamplingFactor^3 fine voxels, whose centres are inside a mesh or not, decided in whole
 * numbers:
 * edges and corners count once, a closed mesh never leaks, and the result is the same to the last bit on every run.
 * Where exactly the surface lies between the centres is then added in fractions of fine voxels. A voxel's coefficients
 * and index are the means of its materials. The fine grid is there in slabs of a fixed size.
 *
 * There is one g: where materials that scatter have different ones, it is their mean weighed by sigma_s, and each
 * sigma_s is scaled such that sigma_s (1 - g) stays what it is; `left_out` says so.
 *
 * An open or empty mesh is an error that names the number of boundary edges (edges of an odd number of triangles) and
 * the first; so is one without area. Meshes that intersect themselves, are inverted, have triangles that disagree about
 * which side is outside, or degenerate ones give a warning that says how many and where; inside is what is enclosed an
 * odd number of times.
 *
 * Only what is asked for is voxelised, an extent or a piece, with the voxels round it that the filter reaches: the same
 * values, bit for bit, as of the whole. In a parallel pipeline every rank has the meshes whole and makes its piece;
 * OccupiedVolume, warnings and whether n is constant are those of the whole box. Where one process asks for a part
 * alone, OccupiedVolume and warnings are of that.
 *
 * @sa vtkRefractionOctree vtkPhotonMarcher vtkMediumRayCaster
 * @par Thanks
 * E. Eisemann, X. Decoret: Single-Pass GPU Solid Voxelization for Real-Time Applications, Graphics Interface 2008.
 * M. Pfeuti: Real-time Rendering of Refractive Objects in Participating Media, 2009, section 3.1.2.
 */
class TYNDALL_EXPORT vtkMeshVoxelizer : public vtkImageAlgorithm
{
public:
  static vtkMeshVoxelizer* New();
  vtkTypeMacro(vtkMeshVoxelizer, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Voxels along x, y and z. Default (128, 128, 128), valid from 1 on.
  tyndallSetRange3Macro(SampleDimensions, int, 1, VTK_INT_MAX);
  vtkGetVector3Macro(SampleDimensions, int);
  ///@}

  ///@{
  /// The box, (xmin, xmax, ymin, ymax, zmin, zmax), length. Default all 0: a box of cubic voxels about the meshes, in
  /// its middle, as close as Margin allows.
  tyndallSetRange6Macro(ModelBounds, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector6Macro(ModelBounds, double);
  ///@}

  ///@{
  /// Room on each side of the meshes where ModelBounds are 0, as a part of the longest edge of their bounds; there is
  /// always as much as the filter reaches. Default 0.125, valid [0, infinity).
  tyndallRangeMacro(Margin, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Refractive index n inside the meshes and outside. Default 1.5 (glass) and 1, valid (0, infinity).
  tyndallRangeMacro(InsideIndex, double, tyndall::AboveZero, 1e6);
  tyndallRangeMacro(OutsideIndex, double, tyndall::AboveZero, 1e6);
  ///@}

  ///@{
  /// Scattering coefficients sigma_s, red, green, blue, 1/length, valid [0, infinity). Default (0, 0, 0) inside.
  /// Outside (-1, -1, -1): where all three are below 0, the scattering that suits the box, such that half an optical
  /// length is scattered along its longest edge; see UsedOutsideScattering.
  tyndallSetRange3Macro(InsideScattering, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(InsideScattering, double);
  tyndallSetRange3Macro(OutsideScattering, double, tyndall::AnyLow, tyndall::LargestFloat);
  vtkGetVector3Macro(OutsideScattering, double);
  ///@}

  ///@{
  /// Absorption coefficients sigma_a, red, green, blue, 1/length. Default (0, 0, 0), valid [0, infinity).
  tyndallSetRange3Macro(InsideAbsorption, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(InsideAbsorption, double);
  tyndallSetRange3Macro(OutsideAbsorption, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(OutsideAbsorption, double);
  ///@}

  ///@{
  /// Mean cosine g of the angle by which light is scattered. Default 0, valid (-1, 1).
  tyndallRangeMacro(InsideMeanCosine, double, -1.0, 1.0);
  tyndallRangeMacro(OutsideMeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// A material for the cells of that number instead of the Inside properties: its index n, sigma_s and sigma_a (red,
  /// green, blue, 1/length), and mean cosine g. Of several with the same number the last one counts. AddMaterialNumber
  /// takes the same nine one by one. Materials that are not whole or not valid are an error of the update, used or not.
  void AddMaterial(double number, double n, double scatteringR, double scatteringG, double scatteringB,
    double absorptionR, double absorptionG, double absorptionB, double g);
  void AddMaterialNumber(double number);
  void RemoveAllMaterials();
  int GetNumberOfMaterials() const;
  ///@}

  ///@{
  /// Gradient noise on the index inside: n becomes n + IndexNoise times a smooth random number in [-1, 1]. Default 0,
  /// valid from 0 to less than the index.
  tyndallRangeMacro(IndexNoise, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// The same noise on scattering inside: sigma_s becomes sigma_s (1 + ScatteringNoise noise). Default 0, valid [0, 1].
  tyndallRangeMacro(ScatteringNoise, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Size of the noise's features, length. Default 0: an eighth of the box's longest edge. Valid [0, infinity).
  tyndallRangeMacro(NoiseSize, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Which noise: the same seed makes the same noise. Default 0.
  vtkSetMacro(NoiseSeed, int);
  vtkGetMacro(NoiseSeed, int);
  ///@}

  ///@{
  /// Fine voxels per edge of a voxel. Occupancy has no steps: where the surface lies between their centres counts too.
  /// The factor sets how well it follows edges and bends. Default 4, valid [1, 16].
  tyndallRangeMacro(SupersamplingFactor, int, 1, 16);
  ///@}

  ///@{
  /// Width of the Gaussian that smooths n, voxels; its standard deviation is a sixth of that. Default 9, valid odd
  /// numbers from 1 (not smoothed) to 65.
  tyndallRangeMacro(FilterSize, int, 1, 65);
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// What came of the last update: the volume inside meshes (length^3; with its discretisation), sigma_s outside (red,
  /// green, blue, 1/length), the seconds that it took, the name of the device, and what the scene did not need, one a
  /// line.
  vtkGetMacro(OccupiedVolume, double);
  vtkGetVector3Macro(UsedOutsideScattering, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkMeshVoxelizer();
  ~vtkMeshVoxelizer() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkMeshVoxelizer(const vtkMeshVoxelizer&) = delete;
  void operator=(const vtkMeshVoxelizer&) = delete;

  int SampleDimensions[3] = { 128, 128, 128 };
  double ModelBounds[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double Margin = 0.125;
  double InsideIndex = 1.5;
  double OutsideIndex = 1.0;
  double InsideScattering[3] = { 0.0, 0.0, 0.0 };
  double OutsideScattering[3] = { -1.0, -1.0, -1.0 };
  double InsideAbsorption[3] = { 0.0, 0.0, 0.0 };
  double OutsideAbsorption[3] = { 0.0, 0.0, 0.0 };
  double InsideMeanCosine = 0.0;
  double OutsideMeanCosine = 0.0;
  double IndexNoise = 0.0;
  double ScatteringNoise = 0.0;
  double NoiseSize = 0.0;
  int NoiseSeed = 0;
  int SupersamplingFactor;
  int FilterSize;
  std::string Device;

  std::vector<tyndall::Solid> ReadSolids(vtkInformationVector** inputs);
  void Note(const tyndall::RefractiveMedium& medium, double volume, const std::array<double, 3>& outside);

  struct AddedMaterials;
  const std::unique_ptr<AddedMaterials> Added;

  double OccupiedVolume = 0.0;
  double UsedOutsideScattering[3] = { 0.0, 0.0, 0.0 };
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
