#ifndef vtkLPMPropagate_h
#define vtkLPMPropagate_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkLPMPropagate
 * @brief propagates all rays through the medium: the first half of one scattering order of the published light
 * propagation maps
 *
 * Rays carry light through the medium along all directions; their deposits in the voxels are stored separately for each
 * direction, in the temporary buffers T of Gruson et al. 2012 (Algorithm 2, Eq. 6). vtkLPMCollect computes the next
 * order's source from T. A chain of the two filters gives the same orders as vtkLightPropagationMaps with Scheme
 * PUBLISHED; they serve to inspect the method and are not fast.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` and optionally `emission`, as for
 * vtkLightPropagationMaps. For a later order it also has
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `unscattered` | 6 x 1 or 3, or StoredDirections x 1 or 3 | W/(length^3 sr) | U: source of this order |
 *
 * as vtkLPMCollect writes it: U is the source along the rays, and there is no incident light. Without `unscattered` the
 * filter propagates order 0: `emission` is the source, and the boundary source is incident.
 * Input 1, optional: lights as vtkLightRig makes them; only directional lights are used, along the nearest direction of
 * the quadrature.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 *
 * Output: the input with six more cell arrays, one per cube face, for the directions that point towards that face,
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `T_xmin`, `T_xmax`, ..., `T_zmax` | DirectionsPerFace x 1 or 3 | W/(length sr) | T / sigma_s |
 *
 * with channels varying fastest: for grey light, component k belongs to direction k of the face; for coloured light,
 * components 3 k to 3 k + 2 are red, green and blue of direction k. T of Eq. (6) is sigma_s times these arrays; without
 * that factor they are defined also in voxels that do not scatter. Memory: 6 DirectionsPerFace x 4 bytes per voxel and
 * channel; 64^3 voxels in RGB with 25 directions take 472 MB (GetBytes). Field data: `directions` (6 DirectionsPerFace
 * unit vectors along which light travels), `map_resolution`, `stored_directions_count`, `scattering_order`.
 *
 * Periodic axes are not supported: T and U do not hold the maps of rays that wrap around.
 *
 * @sa vtkLPMCollect vtkLightPropagationMaps
 * @par Thanks
 * A. Gruson, A. Hakke Patil, R. Cozot, K. Bouatouch, S. Pattanaik: Light Propagation Maps on Parallel Graphics
 * Architectures, EGPGV 2012.
 */
class TYNDALL_EXPORT vtkLPMPropagate : public vtkLitMediumAlgorithm
{
public:
  static vtkLPMPropagate* New();
  vtkTypeMacro(vtkLPMPropagate, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  tyndallDeviceMacro();

  ///@{
  /// Number of directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ...
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of rays of each direction per voxel edge. Default 1, valid [1, 16].
  tyndallRangeMacro(MapResolution, int, 1, 16);
  ///@}

  ///@{
  /// Number of directions for which vtkLPMCollect writes `scattered_radiance` and, if not 1, `unscattered`. Default 1
  /// (enough for isotropic scattering), valid from 1 on.
  tyndallRangeMacro(StoredDirections, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Incident isotropic radiance of order 0 at the faces -x, +x, -y, +y, -z, +z, W/(length^2 sr). Default 0, valid [0,
  /// infinity).
  tyndallSetRange6Macro(FaceRadiance, double, 0.0, tyndall::LargestFloat);
  vtkGetVector6Macro(FaceRadiance, double);
  ///@}

  ///@{
  /// Isotropic incident radiance of order 0, red, green, blue, added to the environment, W/(length^2 sr). Default 0,
  /// valid [0, infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// Whether order 0 of a medium that does not emit is propagated without reading a source. Default on; off: for
  /// comparison, with the same result.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Results of the last update: number of the scattering order, from 0; memory of the output arrays `T_xmin` to
  /// `T_zmax` in bytes; run time in seconds; the computations that the scene did not need, one per line (also field
  /// data `left_out`).
  vtkGetMacro(Order, int);
  vtkGetMacro(Bytes, double);
  tyndallSecondsMacro();
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkLPMPropagate();
  ~vtkLPMPropagate() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkLPMPropagate(const vtkLPMPropagate&) = delete;
  void operator=(const vtkLPMPropagate&) = delete;

  void Propagate(vtkInformationVector** inputs, vtkImageData* output);

  std::string Device;
  int DirectionsPerFace;
  int MapResolution;
  int StoredDirections;
  bool LeaveOut;
  double FaceRadiance[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double SkyColor[3] = { 0.0, 0.0, 0.0 };

  int Order = 0;
  double Bytes = 0.0;
};

#endif
