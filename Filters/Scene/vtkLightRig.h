#ifndef vtkLightRig_h
#define vtkLightRig_h

#include "PropertyRange.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <memory>
#include <vector>

namespace tyndall
{
struct Light;
}

/**
 * @class vtkLightRig
 * @brief makes the lights of a scene, one vertex per light
 *
 * Input, optional and any number of them: further lights, as a rig or a vtkLightSource makes them.
 * Output 0: vtkPolyData, one vertex at each light's position (directional lights: the origin), with the point arrays
 *
 * | array        | type       | meaning                                                                            |
 * |--------------|------------|------------------------------------------------------------------------------------|
 * | `light_type` | uint8      | 0 directional, 1 point, 2 spot, 3 rectangle                                        |
 * | `direction`  | double x 3 | unit vector in which the light travels; (0, 0, 0) for a point light                |
 * | `power`      | double x 3 | RGB: W, of a directional light W/length^2 through a plane across `direction`       |
 * | `size`       | double x 2 | edges of a rectangle, length; else 0                                               |
 * | `angle`      | double     | full opening angle of a spot, degrees; else 0                                      |
 *
 * The lights come in this order: the sun, directional, point, spot and rectangle lights, each kind in the order in
 * which it was added; then those of the inputs, one after the other. Untouched, the rig is one white sun of 1
 * W/length^2, halfway up.
 *
 * A rectangle shines to one side, that of `direction`. Its first edge is horizontal (across z and `direction`; along x
 * where `direction` is vertical), its second one is across the first and `direction`.
 *
 * Output 1: what the rig's own lights look like in a view (those of inputs are drawn by their sources): vtkPolyData of
 * lines and polygons with point array `color` (bytes of red, green, blue).
 *
 * A direction of length 0, an angle outside [1e-12, 180], a size or power that is negative, or anything that is not
 * finite, is an error that names the light; the outputs are empty then.
 *
 * @sa vtkSun vtkPointLight vtkSpotLight vtkRectangleLight
 */
class TYNDALL_EXPORT vtkLightRig : public vtkPolyDataAlgorithm
{
public:
  static vtkLightRig* New();
  vtkTypeMacro(vtkLightRig, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Values of the array `light_type`.
  enum LightTypes
  {
    DIRECTIONAL = 0,
    POINT = 1,
    SPOT = 2,
    RECTANGLE = 3
  };

  ///@{
  /// Whether the rig has a sun: a directional light that is placed by its angles. Default on.
  tyndallFlagMacro(Sun);
  ///@}

  ///@{
  /// Height of the sun above the x-y plane, degrees. Default 45, valid [-90, 90]; 90 is overhead (+z).
  tyndallRangeMacro(SunElevation, double, -90.0, 90.0);
  ///@}

  ///@{
  /// Where the sun stands, degrees about +z from +x (towards +y). Default 225.
  tyndallRangeMacro(SunAzimuth, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// The sun's irradiance on a plane that faces it, RGB, W/length^2. Default (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(SunPower, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SunPower, double);
  ///@}

  ///@{
  /// Parallel light that travels in direction (dx, dy, dz), of any length, with irradiance (r, g, b), W/length^2, on a
  /// plane across it.
  void AddDirectionalLight(double dx, double dy, double dz, double r, double g, double b);
  void RemoveAllDirectionalLights();
  int GetNumberOfDirectionalLights() const;
  ///@}

  ///@{
  /// A point at (x, y, z) that shines evenly in all directions with power (r, g, b), W.
  void AddPointLight(double x, double y, double z, double r, double g, double b);
  void RemoveAllPointLights();
  int GetNumberOfPointLights() const;
  ///@}

  ///@{
  /// A point at (x, y, z) that shines evenly into a cone about (dx, dy, dz), of any length, with power (r, g, b), W.
  /// `angle` is the cone's full opening, degrees, valid [1e-12, 180].
  void AddSpotLight(
    double x, double y, double z, double dx, double dy, double dz, double r, double g, double b, double angle);
  void RemoveAllSpotLights();
  int GetNumberOfSpotLights() const;
  ///@}

  ///@{
  /// A rectangle about (x, y, z) that shines to the side of (dx, dy, dz), of any length, as a Lambertian emitter with
  /// power (r, g, b), W. `width` and `height` are the lengths of its first and second edge.
  void AddRectangleLight(double x, double y, double z, double dx, double dy, double dz, double r, double g, double b,
    double width, double height);
  void RemoveAllRectangleLights();
  int GetNumberOfRectangleLights() const;
  ///@}

  /// Removes every light that was added. The sun stays as it is set.
  void RemoveAllLights();

  ///@{
  /// The same lights number by number, in the order of the arguments above: the last number of a light adds it. A light
  /// that lacks numbers is an error that says how many it takes. Removing the lights of a kind removes its numbers.
  void AddDirectionalLightNumber(double number);
  void AddPointLightNumber(double number);
  void AddSpotLightNumber(double number);
  void AddRectangleLightNumber(double number);
  ///@}

  ///@{
  /// How output 1 draws: arrows of directional lights, and cones of spots, have their length by ShapeSize (default 1,
  /// valid above 0); arrows point at ShapeCenter (default (0, 0, 0)). Light does not depend on it.
  tyndallRangeMacro(ShapeSize, double, tyndall::AboveZero, tyndall::AnyHigh);
  tyndallSetRange3Macro(ShapeCenter, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(ShapeCenter, double);
  ///@}

protected:
  vtkLightRig();
  ~vtkLightRig() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkLightRig(const vtkLightRig&) = delete;
  void operator=(const vtkLightRig&) = delete;

  bool Sun = true;
  double SunElevation = 45.0;
  double SunAzimuth = 225.0;
  double SunPower[3] = { 1.0, 1.0, 1.0 };
  double ShapeSize = 1.0;
  double ShapeCenter[3] = { 0.0, 0.0, 0.0 };

  void DrawOwn(const std::vector<tyndall::Light>& lights, vtkPolyData* shapes) const;

  struct AddedLights;
  std::unique_ptr<AddedLights> Added;
};

#endif
