#ifndef vtkSpotLight_h
#define vtkSpotLight_h

#include "vtkAimedLight.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkSpotLight
 * @brief a point that shines evenly into a cone about the direction to its focal point
 *
 * In a view it is the outline of the cone, as long as the focal point is away.
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
  /// Full opening of the cone, degrees. Default 40, valid (0, 180], at least 1e-12 for a solve.
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
