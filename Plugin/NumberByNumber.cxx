#include "NumberByNumber.h"

#include "vtkClientServerInterpreter.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkObjectFactory.h"
#include "vtkSIDoubleVectorProperty.h"

class vtkSINumberByNumberProperty : public vtkSIDoubleVectorProperty
{
public:
  static vtkSINumberByNumberProperty* New();
  vtkTypeMacro(vtkSINumberByNumberProperty, vtkSIDoubleVectorProperty);

protected:
  bool ReadXMLAttributes(vtkSIProxy* proxy, vtkPVXMLElement* element) override
  {
    const bool read = this->Superclass::ReadXMLAttributes(proxy, element);
    this->NumberOfElementsPerCommand = 1;
    return read;
  }
};

vtkStandardNewMacro(vtkSINumberByNumberProperty);

void TeachNumberByNumber()
{
  vtkClientServerInterpreterInitializer::GetGlobalInterpreter()->AddNewInstanceFunction(
    "vtkSINumberByNumberProperty", [](void*) -> vtkObjectBase* { return vtkSINumberByNumberProperty::New(); });
}
