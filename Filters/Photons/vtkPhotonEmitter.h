#ifndef vtkPhotonEmitter_h
#define vtkPhotonEmitter_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

class vtkPolyData;

/**
 * @class vtkPhotonEmitter
 * @brief photons of lights and of the sky, where they enter a volume
 *
 * Photons are spread over what each light sees of the volume: over the photon plane across a directional light that the
 * volume's outline is, over the solid angle of the faces that a lamp sees, over the directions and the outline for an
 * environment. What would miss the volume is not made; the power of all photons is what reaches it. Photons of a lamp
 * in the volume begin at the lamp.
 *
 * Input 0, the medium: vtkImageData, of which only the box counts. Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it. The index outside is taken as constant.
 * Input 3, optional: where photons are to be dense, as vtkPhotonImportance makes it: vtkImageData of n x n x lights
 * cells, cell array `importance` (1 component, >= 0, of any scale), field data `light` (number of the light of each
 * layer; missing: 0, 1, ...). A light without a layer is spread evenly, and so are all where field data `even` is 1.
 * Where photons are denser each has less power, so that what they add up to is the same.
 *
 * Output: vtkPolyData, a vertex per photon, point data
 *
 * | array       | components | unit | meaning                                                           |
 * |-------------|------------|------|-------------------------------------------------------------------|
 * | `direction` | 3          | 1    | in which it travels; the active vectors                           |
 * | `power`     | 3          | W    | red, green, blue                                                  |
 * | `weight`    | 1          | 1    | its power over what it had if photons were spread evenly          |
 * | `light`     | 1          | 1    | number of its light; -1: the environment or SkyColor              |
 * | `batch`     | 1          | 1    | of which of the independent sets it is, from 0                    |
 *
 * and field data `photon_box`, the bounds of the box that they were made for (6 numbers): vtkPhotonMarcher warns where
 * its medium fills another one.
 *
 * Without lights, environment and SkyColor there are no photons, with a warning. In a parallel pipeline each piece has
 * its part of the photons: one after the other, pieces have all of them in their order. Of the medium each rank then
 * needs a piece only.
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

  /// Number of the input port after those of vtkLitMediumAlgorithm.
  static constexpr int IMPORTANCE_MAP = 3;

  vtkPolyData* GetOutput();

  ///@{
  /// The importance map (vtkImageData) by connection or as data; null: none.
  tyndallInputMacro(ImportanceMap, IMPORTANCE_MAP);
  ///@}

  ///@{
  /// Photons that reach the volume, of all lights together, which share them in proportion to the power with which they
  /// reach it. Default 100000, valid [1, infinity). Spots and rectangles of which a part misses the volume meet it
  /// within a percent.
  tyndallRangeMacro(PhotonCount, vtkIdType, 1, VTK_ID_MAX);
  ///@}

  ///@{
  /// How photons are spread: HAMMERSLEY (default), HALTON, JITTERED, GRID or RANDOM.
  tyndallRangeMacro(Sampler, int, HAMMERSLEY, RANDOM);
  ///@}

  ///@{
  /// Another seed gives other photons, the same seed the same ones. Default 0.
  tyndallRangeMacro(Seed, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Independent sets that the photons are made of, each with its part of all the power: their differences tell
  /// vtkPhotonReconstruction the error of the light. Default 0: two with an importance map (even if that is even), one
  /// without; valid [0, 16].
  tyndallRangeMacro(Batches, int, 0, 16);
  ///@}

  ///@{
  /// How dense photons may become by the importance map, in those spread evenly: what it asks for above that goes to
  /// other places. Default 8, valid [1, infinity).
  tyndallRangeMacro(MaximumDensity, double, 1.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Radiance from every direction alike, red, green, blue, added to the environment, W/(length^2 sr). Default 0, valid
  /// [0, infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// What came of the last update: photons made, their power (W, red, green, blue, as the energy balance of light is by
  /// channel), seconds. Of all ranks where they run it together.
  vtkGetMacro(Photons, vtkIdType);
  vtkGetVector3Macro(Power, double);
  vtkGetMacro(Seconds, double);
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
  double Seconds = 0.0;
};

#endif
