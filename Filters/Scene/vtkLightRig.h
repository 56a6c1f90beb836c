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
 * @brief creates the lights of a scene, one vertex per light
 *
 * Input, optional, any number: further lights from another vtkLightRig or a vtkLightSource.
 * Output 0: vtkPolyData, one vertex at each light's position (directional lights: the origin), with the point arrays
 *
 * | array        | type       | meaning                                                                            |
 * |--------------|------------|------------------------------------------------------------------------------------|
 * | `light_type` | uint8      | 0 directional, 1 point, 2 spot, 3 rectangle                                        |
 * | `direction`  | double x 3 | unit vector in which the light travels; (0, 0, 0) for a point light                |
 * | `power`      | double x 3 | RGB: W; directional lights: W/length^2 on a plane normal to `direction`               |
 * | `size`       | double x 2 | edges of a rectangle, length; else 0                                               |
 * | `angle`      | double     | full opening angle of a spot, degrees; else 0                                      |
 *
 * Order of the lights: the sun, then directional, point, spot and rectangle lights, each type in the order of addition;
 * then the lights of the inputs, in the order of the inputs. By default the rig has one white sun of 1 W/length^2 at an
 * elevation of 45 degrees.
 *
 * A rectangle emits only to the side of `direction`. Its first edge is horizontal (normal to z and `direction`; along x
 * if `direction` is vertical), its second edge is normal to the first and to `direction`.
 *
 * Output 1: shapes of the rig's own lights for a view (lights of inputs are drawn by their sources): vtkPolyData of
 * lines and polygons with point array `color` (red, green, blue as bytes).
 *
 * A direction of length 0, an angle outside [1e-12, 180], a negative size or power, or a value that is not finite is an
 * error that names the light; the outputs are then empty.
 *
 * @sa vtkSun vtkPointLight vtkSpotLight vtkRectangleLight
 */
class TYNDALL_EXPORT vtkLightRig : public vtkPolyDataAlgorithm
{
public:
  static vtkLightRig* New();
  vtkTypeMacro(vtkLightRig, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Types of lights: values of the array `light_type`.
  enum LightTypes
  {
    DIRECTIONAL = 0,
    POINT = 1,
    SPOT = 2,
    RECTANGLE = 3
  };

  ///@{
  /// Whether the rig has a sun: a directional light given by elevation and azimuth. Default on.
  tyndallFlagMacro(Sun);
  ///@}

  ///@{
  /// Elevation of the sun above the x-y plane, degrees. Default 45, valid [-90, 90]; 90 is overhead (+z).
  tyndallRangeMacro(SunElevation, double, -90.0, 90.0);
  ///@}

  ///@{
  /// Azimuth of the sun's position, degrees about +z from +x towards +y. Default 225.
  tyndallRangeMacro(SunAzimuth, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// The sun's irradiance on a plane that faces it, RGB, W/length^2. Default (1, 1, 1), valid [0, infinity).
  tyndallSetRange3Macro(SunPower, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SunPower, double);
  ///@}

  ///@{
  /// Adds a parallel beam that travels in direction (dx, dy, dz), of any length above 0, with irradiance (r, g, b),
  /// W/length^2, on a plane normal to that direction.
  void AddDirectionalLight(double dx, double dy, double dz, double r, double g, double b);
  void RemoveAllDirectionalLights();
  int GetNumberOfDirectionalLights() const;
  ///@}

  ///@{
  /// Adds an isotropic point source at (x, y, z) with power (r, g, b), W.
  void AddPointLight(double x, double y, double z, double r, double g, double b);
  void RemoveAllPointLights();
  int GetNumberOfPointLights() const;
  ///@}

  ///@{
  /// Adds a point source at (x, y, z) that emits uniformly into a cone about (dx, dy, dz), of any length above 0, with
  /// power (r, g, b), W. `angle` is the full opening angle of the cone, degrees, valid [1e-12, 180].
  void AddSpotLight(
    double x, double y, double z, double dx, double dy, double dz, double r, double g, double b, double angle);
  void RemoveAllSpotLights();
  int GetNumberOfSpotLights() const;
  ///@}

  ///@{
  /// Adds a rectangle centred at (x, y, z) that emits to the side of (dx, dy, dz), of any length above 0, as a
  /// Lambertian emitter with power (r, g, b), W. `width` and `height` are the lengths of its first and second edge.
  void AddRectangleLight(double x, double y, double z, double dx, double dy, double dz, double r, double g, double b,
    double width, double height);
  void RemoveAllRectangleLights();
  int GetNumberOfRectangleLights() const;
  ///@}

  /// Removes all lights that were added. The sun is not affected.
  void RemoveAllLights();

  ///@{
  /// Adds a light one number per call: the arguments of AddDirectionalLight, AddPointLight, ... in order; the last one
  /// completes the light. An incomplete light is an error that says how many numbers it needs. Removing the lights of a
  /// type also removes the numbers of an incomplete one.
  void AddDirectionalLightNumber(double number);
  void AddPointLightNumber(double number);
  void AddSpotLightNumber(double number);
  void AddRectangleLightNumber(double number);
  ///@}

  ///@{
  /// Size of the shapes of output 1: ShapeSize is the length of the arrows of directional lights and of the cones of
  /// spot lights (default 1, valid above 0); arrows point at ShapeCenter (default (0, 0, 0)). The emitted light does
  /// not depend on these properties.
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
