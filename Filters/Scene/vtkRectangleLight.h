#ifndef vtkRectangleLight_h
#define vtkRectangleLight_h

#include "vtkLightSource.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkRectangleLight
 * @brief a rectangle that emits from one side, as a Lambertian emitter
 *
 * Position is the centre of the rectangle, Direction its normal. The first edge is horizontal (normal to z and to the
 * direction; along x if the direction is vertical), the second edge is normal to the first edge and to the direction.
 * The shape in a view is a rectangle with an arrow on the emitting side.
 *
 * @sa vtkLightSource vtkLightRig
 */
class TYNDALL_EXPORT vtkRectangleLight : public vtkLightSource
{
public:
  static vtkRectangleLight* New();
  vtkTypeMacro(vtkRectangleLight, vtkLightSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Normal of the rectangle on its emitting side, of any length above 0. Default (1, 0, -1).
  tyndallSetRange3Macro(Direction, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /// Lengths of the first and the second edge of the rectangle. Default (0.25, 0.25), valid above 0.
  tyndallSetRange2Macro(Size, double, tyndall::AboveZero, tyndall::AnyHigh);
  vtkGetVector2Macro(Size, double);
  ///@}

protected:
  vtkRectangleLight();
  ~vtkRectangleLight() override;

  tyndall::DrawnLight MakeLight() const override;

  double Direction[3] = { 1.0, 0.0, -1.0 };
  double Size[2] = { 0.25, 0.25 };

private:
  vtkRectangleLight(const vtkRectangleLight&) = delete;
  void operator=(const vtkRectangleLight&) = delete;
};

#endif
