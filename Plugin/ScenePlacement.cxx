#include "ScenePlacement.h"

#include "vtkBoundingBox.h"
#include "vtkClientServerInterpreter.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkType.h"

#include <cmath>

namespace
{
/// Of what the source has given, without asking it for more; pictures and skies are flat.
void AddVolumesOf(vtkSMSourceProxy* source, vtkBoundingBox& box)
{
  for (unsigned int port = 0; port < source->GetNumberOfOutputPorts(); ++port)
  {
    vtkPVDataInformation* const information = source->GetDataInformation(port);
    if (!information || information->GetDataSetType() != VTK_IMAGE_DATA)
    {
      continue;
    }
    const int* const extent = information->GetExtent();
    if (extent[1] > extent[0] + 1 && extent[3] > extent[2] + 1 && extent[5] > extent[4] + 1)
    {
      box.AddBounds(information->GetBounds());
    }
  }
}

vtkBoundingBox BoxOfScene(vtkSMSessionProxyManager* manager)
{
  vtkBoundingBox box;
  vtkNew<vtkCollection> sources;
  manager->GetProxies("sources", sources);
  for (int i = 0; i < sources->GetNumberOfItems(); ++i)
  {
    auto* const source = vtkSMSourceProxy::SafeDownCast(sources->GetItemAsObject(i));
    if (source && source->GetObjectsCreated() && source->GetOutputPortsCreated())
    {
      AddVolumesOf(source, box);
    }
  }
  return box;
}

/// Numbers to read on a panel.
/// @param digits  behind the first one of `size` that are kept
double Rounded(double value, double size, int digits)
{
  const double unit = std::pow(10.0, digits - std::floor(std::log10(size)));
  return std::round(value * unit) / unit;
}
}

class vtkSMSceneDomain : public vtkSMDomain
{
public:
  static vtkSMSceneDomain* New();
  vtkTypeMacro(vtkSMSceneDomain, vtkSMDomain);

  int SetDefaultValues(vtkSMProperty* property, bool useUnchecked) override
  {
    const vtkBoundingBox box = BoxOfScene(property->GetParent()->GetSessionProxyManager());
    if (!box.IsValid())
    {
      return 0;
    }
    vtkSMPropertyHelper values(property);
    values.SetUseUnchecked(useUnchecked);
    double centre[3];
    box.GetCenter(centre);
    const double length = box.GetDiagonalLength();
    const double size = this->IsPlace ? length : this->Factor * std::pow(length, this->Exponent);
    for (unsigned int i = 0; i < values.GetNumberOfElements(); ++i)
    {
      values.Set(i, this->IsPlace ? Rounded(centre[i] + this->Offset[i] * length, size, 2) : Rounded(size, size, 1));
    }
    return 1;
  }

protected:
  int ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element) override
  {
    this->IsPlace = element->GetVectorAttribute("offset", 3, this->Offset) == 3;
    element->GetScalarAttribute("factor", &this->Factor);
    element->GetScalarAttribute("exponent", &this->Exponent);
    return this->Superclass::ReadXMLAttributes(property, element);
  }

private:
  bool IsPlace = false;
  double Offset[3] = { 0.0, 0.0, 0.0 };
  double Factor = 1.0;
  double Exponent = 1.0;
};

vtkStandardNewMacro(vtkSMSceneDomain);

void TeachScenePlacement()
{
  vtkClientServerInterpreterInitializer::GetGlobalInterpreter()->AddNewInstanceFunction(
    "vtkSMSceneDomain", [](void*) -> vtkObjectBase* { return vtkSMSceneDomain::New(); });
}
