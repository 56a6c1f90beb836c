#ifndef vtkPhotonEmitter_h
#define vtkPhotonEmitter_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

class vtkPolyData;

/**
 * @class vtkPhotonEmitter
 * @brief photons of lights and sky at the points where they enter a volume
 *
 * Start points of photons are distributed for a directional light over the volume's outline on the photon plane, which
 * is perpendicular to the light; for a lamp over the solid angle of the faces that it sees; for an environment over the
 * directions and the outline perpendicular to each direction. Photons that would miss the volume are not emitted; the
 * total power of the photons is the power that reaches the volume. Photons of a lamp inside the volume start at the
 * lamp.
 *
 * Input 0, the medium: vtkImageData, of which only the box is used. Input 1, optional: lights as vtkLightRig makes
 * them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it. The refractive index outside the box is taken
 * as constant.
 * Input 3, optional: an importance map, the relative density of photons, as vtkPhotonImportance makes it: vtkImageData
 * of n x n x lights cells, cell array `importance` (1 component, above 0, of any scale), field data `light` (number of
 * the light of each layer; missing: 0, 1, ...). The photons of a light without a layer are evenly distributed, and so
 * are all photons if field data `even` is 1. The power of a photon is inversely proportional to the density of photons,
 * so that the power density is unchanged.
 *
 * Output: vtkPolyData, one vertex per photon, point data
 *
 * | array       | components | unit | meaning                                                           |
 * |-------------|------------|------|-------------------------------------------------------------------|
 * | `direction` | 3 | 1 | direction of travel; the active vectors |
 * | `power`     | 3          | W    | power of the photon, red, green, blue                             |
 * | `weight` | 1 | 1 | ratio of the photon's power to its power if photons were evenly distributed |
 * | `light`     | 1          | 1    | number of the photon's light; -1: the environment or SkyColor     |
 * | `batch` | 1 | 1 | number of the photon's independent set (see Batches), from 0 |
 *
 * and field data `photon_box`, the bounds of the box that the photons were made for (6 numbers): vtkPhotonMarcher warns
 * if its medium fills another box.
 *
 * Without lights, environment and SkyColor there are no photons, with a warning. In a parallel pipeline each rank emits
 * a part of the photons: the pieces concatenated in order are the serial output. Each rank then needs only its piece of
 * the medium.
 *
 * @sa vtkLightRig vtkEnvironmentReader vtkPhotonImportance vtkPhotonMarcher
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, sections 3.1.4, 3.2.3 and 4.1.
 */
class TYNDALL_EXPORT vtkPhotonEmitter : public vtkLitMediumAlgorithm
{
public:
  static vtkPhotonEmitter* New();
  vtkTypeMacro(vtkPhotonEmitter, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Samplers
  {
    HAMMERSLEY = 0,
    HALTON = 1,
    JITTERED = 2,
    GRID = 3,
    RANDOM = 4
  };

  /// Input port of the importance map; lower numbers are the ports of vtkLitMediumAlgorithm.
  static constexpr int IMPORTANCE_MAP = 3;

  vtkPolyData* GetOutput();

  ///@{
  /// Importance map (vtkImageData) by connection or as data; null: none, photons are evenly distributed.
  tyndallInputMacro(ImportanceMap, IMPORTANCE_MAP);
  ///@}

  ///@{
  /// Number of photons that reach the volume, summed over all lights; the share of each light is proportional to its
  /// power that reaches the volume. Default 100000, valid [1, infinity). If part of the light of a spot or rectangle
  /// misses the volume, the number of photons is met within a percent.
  tyndallRangeMacro(PhotonCount, vtkIdType, 1, VTK_ID_MAX);
  ///@}

  ///@{
  /// Sampler of the photons' start points and directions: HAMMERSLEY (default), HALTON, JITTERED, GRID or RANDOM.
  tyndallRangeMacro(Sampler, int, HAMMERSLEY, RANDOM);
  ///@}

  ///@{
  /// Seed of the random numbers: the same seed reproduces the same photons. Default 0, valid [0, infinity).
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of batches: independent sets of photons, among which the power is divided. vtkPhotonReconstruction
  /// estimates the error of fluence from the differences between batches. Default 0: two with an importance map (also
  /// if its `even` is 1), one without; valid [0, 16].
  tyndallRangeMacro(Batches, int, 0, 16);
  ///@}

  ///@{
  /// Largest density of photons with an importance map, relative to evenly distributed photons; photons in excess of
  /// this limit are redistributed over the rest of the map. Default 8, valid [1, infinity).
  tyndallRangeMacro(MaximumDensity, double, 1.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Isotropic incident radiance, red, green, blue, added to the environment, W/(length^2 sr). Default 0, valid [0,
  /// infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// Results of the last update: number of photons; total power of the photons, red, green, blue, W; run time in
  /// seconds; samples and light sources whose photons would miss the volume, one text per line (also field data
  /// `left_out`). Photons and power are summed over the ranks that run the update together.
  vtkGetMacro(Photons, vtkIdType);
  vtkGetVector3Macro(Power, double);
  tyndallSecondsMacro();
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkPhotonEmitter();
  ~vtkPhotonEmitter() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPhotonEmitter(const vtkPhotonEmitter&) = delete;
  void operator=(const vtkPhotonEmitter&) = delete;

  vtkIdType PhotonCount = 100000;
  int Sampler = HAMMERSLEY;
  int Seed = 0;
  int Batches = 0;
  double MaximumDensity;
  double SkyColor[3] = { 0.0, 0.0, 0.0 };

  vtkIdType Photons = 0;
  double Power[3] = { 0.0, 0.0, 0.0 };
};

#endif
