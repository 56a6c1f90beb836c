#ifndef vtkVolumeUnitDistance_h
#define vtkVolumeUnitDistance_h

#include "vtkObject.h"
#include "vtkSmartPointer.h"
#include "vtkTyndallRepresentationModule.h" // for export macro

/**
 * @class vtkVolumeUnitDistance
 * @brief sets the unit distance of opacity for a volume that is shown in its own colours
 *
 * ParaView's property Scalar Opacity Unit Distance sets the unit distance of a volume's first component. If a volume
 * has its own red, green, blue and alpha, VTK uses the unit distance of the fourth component
 * (vtkVolumeProperty::SetScalarOpacityUnitDistance(3, d)), which ParaView cannot set. This class sets it for the volume
 * that a composite representation currently shows.
 */
class TYNDALLREPRESENTATION_EXPORT vtkVolumeUnitDistance : public vtkObject
{
public:
  static vtkVolumeUnitDistance* New();
  vtkTypeMacro(vtkVolumeUnitDistance, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Sets the representation whose volume is changed, a vtkCompositeRepresentation. To be called before SetDistance.
  void SetRepresentation(vtkObject* representation);

  /// Sets the unit distance of alpha, a length above 0. No effect for other values, or if the representation does not
  /// show a volume.
  void SetDistance(double distance);

protected:
  vtkVolumeUnitDistance();
  ~vtkVolumeUnitDistance() override;

private:
  vtkVolumeUnitDistance(const vtkVolumeUnitDistance&) = delete;
  void operator=(const vtkVolumeUnitDistance&) = delete;

  vtkSmartPointer<vtkObject> Representation;
};

#endif
