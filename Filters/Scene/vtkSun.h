#ifndef vtkSun_h
#define vtkSun_h

#include "vtkAimedLight.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkSun
 * @brief a directional light: parallel light everywhere, in the direction from its position to its focal point
 *
 * By default the sun equals the default sun of vtkLightRig to 1e-5. The shape of the sun in a view is an arrow from its
 * position halfway to the focal point.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkSun : public vtkAimedLight
{
public:
  static vtkSun* New();
  vtkTypeMacro(vtkSun, vtkAimedLight);

protected:
  vtkSun();
  ~vtkSun() override;

  tyndall::DrawnLight MakeLight() const override;

private:
  vtkSun(const vtkSun&) = delete;
  void operator=(const vtkSun&) = delete;
};

#endif
