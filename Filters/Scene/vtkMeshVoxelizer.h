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
 * @brief converts closed meshes to a medium of voxels with refractive index, coefficients and mean cosine
 *
 * Input, repeatable: vtkPolyData, each a closed mesh; polygons and strips are triangulated, points at the same position
 * are merged. Where meshes overlap, the later input takes precedence.
 *
 * Optional cell array `material_id` (whole numbers), or the array selected by SetInputArrayToProcess(0, ...): the
 * material of each cell. The cells of each number must form a closed mesh; where closed meshes of one input overlap,
 * the higher number takes precedence. Without the array, an input's material is its index, from 0 on; a selected array
 * must exist in at least one input. AddMaterial defines materials; a number without definition has the Inside
 * properties.
 *
 * Output: vtkImageData with the cell arrays
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `occupancy` | 1 | 1 | fraction of the voxel inside any mesh, the active scalars |
 * | `ior` | 1 | 1 | refractive index n, smoothed |
 * | `ior_gradient` | 3 | 1/length | gradient of n by central differences; missing if n is constant |
 * | `sigma_a` | 1, or 3 if coloured | 1/length | absorption coefficient |
 * | `sigma_s` | 1, or 3 if coloured | 1/length | scattering coefficient |
 * | `g` | 1, or 3 if `sigma_s` or `sigma_a` is coloured | 1 | mean cosine, only if scattering materials differ in it |
 *
 * and the field data `phase_function`, `g` (mean cosine, if all voxels have the same), `left_out` (computations that
 * the scene did not need) and `device`. Lengths are in the unit of the meshes' coordinates.
 *
 * A voxel is divided into SupersamplingFactor^3 fine voxels, whose centres are classified as inside or outside in
 * integer arithmetic: a centre on an edge or corner of a triangle is counted once, a closed mesh never leaks, and the
 * result is bitwise reproducible. The exact position of the surface between the centres is then added in fractions of
 * fine voxels. Coefficients and index of a voxel are the means over its materials. The fine grid is processed in slabs
 * of fixed size, which limits the memory.
 *
 * Each voxel has one g: if its scattering materials differ in g, their mean weighted by sigma_s, and each sigma_s is
 * scaled such that sigma_s (1 - g) is conserved; `left_out` reports it.
 *
 * An open or empty mesh is an error that names the number of boundary edges (edges with an odd number of triangles) and
 * the first of them; a mesh without area is an error as well. Meshes that intersect themselves, are inverted, have
 * triangles of inconsistent orientation, or degenerate triangles cause a warning that reports their number and
 * position; points that are enclosed an odd number of times count as inside.
 *
 * Only the requested extent or piece is voxelised, with a halo for the smoothing filter: values equal those of the
 * complete grid bit for bit. In a parallel pipeline every rank has the complete meshes and makes its piece;
 * OccupiedVolume, warnings and whether n is constant refer to the complete grid. If a single process requests part of
 * the grid, OccupiedVolume and warnings refer to that part.
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
  /// Number of voxels along x, y and z. Default (128, 128, 128), valid from 1 on.
  tyndallSetRange3Macro(SampleDimensions, int, 1, VTK_INT_MAX);
  vtkGetVector3Macro(SampleDimensions, int);
  ///@}

  ///@{
  /// Bounds of the voxel grid, (xmin, xmax, ymin, ymax, zmin, zmax), in units of length. Default all 0: a box of cubic
  /// voxels centred on the meshes, as tight as Margin allows.
  tyndallSetRange6Macro(ModelBounds, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector6Macro(ModelBounds, double);
  ///@}

  ///@{
  /// Margin between the meshes and each face of the box if ModelBounds are 0, as a fraction of the longest edge of the
  /// meshes' bounds; at least half the width of the smoothing filter plus one voxel. Default 0.125, valid [0,
  /// infinity).
  tyndallRangeMacro(Margin, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Refractive index n inside the meshes and outside. Default 1.5 (glass) and 1, valid (0, 1e6].
  tyndallRangeMacro(InsideIndex, double, tyndall::AboveZero, 1e6);
  tyndallRangeMacro(OutsideIndex, double, tyndall::AboveZero, 1e6);
  ///@}

  ///@{
  /// Scattering coefficients sigma_s inside the meshes and outside, red, green, blue, 1/length, valid [0, infinity).
  /// Default inside (0, 0, 0). Default outside (-1, -1, -1): if all three are below 0, sigma_s is chosen such that the
  /// longest edge of the box has a scattering optical thickness of 0.5; see UsedOutsideScattering.
  tyndallSetRange3Macro(InsideScattering, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(InsideScattering, double);
  tyndallSetRange3Macro(OutsideScattering, double, tyndall::AnyLow, tyndall::LargestFloat);
  vtkGetVector3Macro(OutsideScattering, double);
  ///@}

  ///@{
  /// Absorption coefficients sigma_a inside the meshes and outside, red, green, blue, 1/length. Default (0, 0, 0),
  /// valid [0, infinity).
  tyndallSetRange3Macro(InsideAbsorption, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(InsideAbsorption, double);
  tyndallSetRange3Macro(OutsideAbsorption, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(OutsideAbsorption, double);
  ///@}

  ///@{
  /// Mean cosine g of the scattering angle inside the meshes and outside. Default 0, valid (-1, 1).
  tyndallRangeMacro(InsideMeanCosine, double, -1.0, 1.0);
  tyndallRangeMacro(OutsideMeanCosine, double, -1.0, 1.0);
  ///@}

  ///@{
  /// Defines the material of cells with this number, instead of the Inside properties: index n, sigma_s and sigma_a
  /// (red, green, blue, 1/length), and mean cosine g. If a number is defined several times, the last definition
  /// applies. AddMaterialNumber adds the nine arguments of AddMaterial one at a time. Incomplete or invalid materials
  /// cause an error on update, even if no cell has their number.
  void AddMaterial(double number, double n, double scatteringR, double scatteringG, double scatteringB,
    double absorptionR, double absorptionG, double absorptionB, double g);
  void AddMaterialNumber(double number);
  void RemoveAllMaterials();
  int GetNumberOfMaterials() const;
  ///@}

  ///@{
  /// Amplitude of gradient noise on the refractive index n inside the meshes: n becomes n + IndexNoise noise, with a
  /// smooth random field noise in [-1, 1]. Default 0, valid from 0 to less than the index.
  tyndallRangeMacro(IndexNoise, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Amplitude of gradient noise on sigma_s inside the meshes: sigma_s becomes sigma_s (1 + ScatteringNoise noise),
  /// with the noise of IndexNoise. Default 0, valid [0, 1].
  tyndallRangeMacro(ScatteringNoise, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Feature size of the noise (IndexNoise, ScatteringNoise), in units of length. Default 0: an eighth of the box's
  /// longest edge. Valid [0, infinity).
  tyndallRangeMacro(NoiseSize, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Seed of the noise (IndexNoise, ScatteringNoise): the same seed reproduces the same noise. Default 0.
  vtkSetMacro(NoiseSeed, int);
  vtkGetMacro(NoiseSeed, int);
  ///@}

  ///@{
  /// Number of fine voxels per edge of a voxel. Occupancy varies continuously with the position of the surface for any
  /// factor; a larger factor resolves edges and curvature of the surface better. Default 4, valid [1, 16].
  tyndallRangeMacro(SupersamplingFactor, int, 1, 16);
  ///@}

  ///@{
  /// Width of the Gaussian filter that smooths n, in voxels; the standard deviation is a sixth of the width. Default 9,
  /// valid odd numbers from 1 (no smoothing) to 65.
  tyndallRangeMacro(FilterSize, int, 1, 65);
  ///@}

  ///@{
  /// Whether to skip smoothing and gradient of n if n is the same everywhere. Default on; off: for comparison, with the
  /// same n, and a gradient of 0, in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// Results of the last update: the volume inside the meshes (length^3, including the discretisation error), sigma_s
  /// outside (red, green, blue, 1/length), run time in seconds, name of the device, and the computations that the scene
  /// did not need, one per line.
  vtkGetMacro(OccupiedVolume, double);
  vtkGetVector3Macro(UsedOutsideScattering, double);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
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
  bool LeaveOut;
  std::string Device;

  std::vector<tyndall::Solid> ReadSolids(vtkInformationVector** inputs);
  void Note(const tyndall::RefractiveMedium& medium, double volume, const std::array<double, 3>& outside);

  struct AddedMaterials;
  const std::unique_ptr<AddedMaterials> Added;

  double OccupiedVolume = 0.0;
  double UsedOutsideScattering[3] = { 0.0, 0.0, 0.0 };
  std::string DeviceName;
};

#endif
