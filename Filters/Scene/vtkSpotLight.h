#ifndef vtkSpotLight_h
#define vtkSpotLight_h

#include "vtkAimedLight.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkSpotLight
 * @brief a point source that emits uniformly into a cone about the direction to its focal point
 *
 * The shape of the light in a view is the outline of the cone, which extends to the focal point.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkSpotLight : public vtkAimedLight
{
public:
  static vtkSpotLight* New();
  vtkTypeMacro(vtkSpotLight, vtkAimedLight);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Full opening angle of the cone, degrees. Default 40, valid (0, 180]; solvers need at least 1e-12.
  tyndallRangeMacro(Angle, double, tyndall::AboveZero, 180.0);
  ///@}

protected:
  vtkSpotLight();
  ~vtkSpotLight() override;

  tyndall::DrawnLight MakeLight() const override;

  double Angle = 40.0;

private:
  vtkSpotLight(const vtkSpotLight&) = delete;
  void operator=(const vtkSpotLight&) = delete;
};

#endif
