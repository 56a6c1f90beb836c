#ifndef vtkLPMPropagate_h
#define vtkLPMPropagate_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkLPMPropagate
 * @brief the first half of one scattering order of light propagation maps, as published: all rays through the medium
 *
 * Rays carry light through the medium along all directions; what they deposit in the voxels is kept apart by direction,
 * in the temporary buffers T of Gruson et al. 2012 (Algorithm 2, Eq. 6). vtkLPMCollect makes the next order's source of
 * them. Chained by hand the two equal vtkLightPropagationMaps with Scheme PUBLISHED, order by order; they are there to
 * look into the method, not to be fast.
 *
 * Input 0, the medium: vtkImageData with cell arrays `sigma_a`, `sigma_s` and perhaps `emission`, as for
 * vtkLightPropagationMaps. Where there is also
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `unscattered` | 6 x 1 or 3, or StoredDirections x 1 or 3 | W/(length^3 sr) | U: scattered but not propagated yet |
 *
 * as vtkLPMCollect makes it, that is what the rays take up, and nothing comes in from outside: a later order. Without
 * it this is order 0: rays bring the light of the boundary and take up `emission`.
 * Input 1, optional: lights as vtkLightRig makes them; only directional ones shine, along the nearest direction.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 *
 * Output: the input with six cell arrays, one for each cube face that light travels towards,
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `T_xmin`, `T_xmax`, ..., `T_zmax` | DirectionsPerFace x 1 or 3 | W/(length sr) | T over sigma_s |
 *
 * channels fastest: component k of grey light is direction k of the face, components 3 k to 3 k + 2 are its red, green
 * and blue. T as in Eq. (6) is sigma_s times that; without the factor it is there in voxels that do not scatter, too.
 * Memory: 6 DirectionsPerFace x 4 bytes per voxel and channel; 64^3 voxels in RGB with 25 directions take 472 MB
 * (GetBytes).
 * Field data: `directions` (6 DirectionsPerFace x 3: where light travels), `map_resolution`, `stored_directions_count`,
 * `scattering_order`.
 *
 * The box is open: maps that start again on the other side of a periodic axis are more than T and U can hold.
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
  /// Directions per face of a cube. Default 25, valid square numbers: 1, 4, 9, 16, 25, ...
  tyndallRangeMacro(DirectionsPerFace, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Rays of a direction per voxel edge. Default 1, valid from 1 on.
  tyndallRangeMacro(MapResolution, int, 1, 16);
  ///@}

  ///@{
  /// Directions of `scattered_radiance`, and, if not 1, of `unscattered`. Default 1 (enough for isotropic scattering),
  /// valid from 1 on.
  tyndallRangeMacro(StoredDirections, int, 1, VTK_INT_MAX);
  ///@}

  ///@{
  /// Diffuse radiance that enters through the faces -x, +x, -y, +y, -z, +z in order 0, W/(length^2 sr). Default 0,
  /// valid [0, infinity).
  tyndallSetRange6Macro(FaceRadiance, double, 0.0, tyndall::LargestFloat);
  vtkGetVector6Macro(FaceRadiance, double);
  ///@}

  ///@{
  /// Radiance from every direction alike in order 0, red, green, blue, added to the environment, W/(length^2 sr).
  /// Default 0, valid [0, infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// What came of the last update: which scattering order it was, memory of the arrays T in bytes.
  vtkGetMacro(Order, int);
  vtkGetMacro(Bytes, double);
  ///@}

protected:
  vtkLPMPropagate();
  ~vtkLPMPropagate() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkLPMPropagate(const vtkLPMPropagate&) = delete;
  void operator=(const vtkLPMPropagate&) = delete;

  std::string Device;
  int DirectionsPerFace;
  int MapResolution;
  int StoredDirections;
  double FaceRadiance[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double SkyColor[3] = { 0.0, 0.0, 0.0 };

  int Order = 0;
  double Bytes = 0.0;
};

#endif
