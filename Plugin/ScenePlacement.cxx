#include "ScenePlacement.h"

#include "RegisteredProxies.h"

#include "vtkBoundingBox.h"
#include "vtkCallbackCommand.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSmartPointer.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkType.h"

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

namespace
{
/// Adds the bounds of a source's volumes to the scene's box, without updating the source. Flat images are pictures and
/// skies, and are skipped.
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

/// Rounds `value`, for display on a panel, to a multiple of 10^(k - digits), where 10^k is the largest power of ten not
/// above `size`.
double Rounded(double value, double size, int digits)
{
  const double unit = std::pow(10.0, digits - std::floor(std::log10(size)));
  return std::round(value * unit) / unit;
}

void Place(vtkSMProperty* property, vtkPVXMLElement* hint, const vtkBoundingBox& box)
{
  double centre[3], offset[3], factor = 1.0, exponent = 1.0;
  box.GetCenter(centre);
  const double length = box.GetDiagonalLength();
  const bool isPlace = hint->GetVectorAttribute("offset", 3, offset) == 3;
  hint->GetScalarAttribute("factor", &factor);
  hint->GetScalarAttribute("exponent", &exponent);
  const double size = factor * std::pow(length, exponent);
  vtkSMPropertyHelper values(property);
  for (unsigned int i = 0; i < values.GetNumberOfElements(); ++i)
  {
    values.Set(i, isPlace ? Rounded(centre[i] + offset[i] * length, length, 2) : Rounded(size, size, 1));
  }
}

/// Properties of a proxy that have the hint <ScenePlacement> and still have their default value, each with its hint.
std::vector<std::pair<vtkSMProperty*, vtkPVXMLElement*>> PropertiesToPlace(vtkSMProxy* proxy)
{
  std::vector<std::pair<vtkSMProperty*, vtkPVXMLElement*>> found;
  auto properties = vtk::TakeSmartPointer(proxy->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    vtkSMProperty* const property = properties->GetProperty();
    vtkPVXMLElement* const hints = property ? property->GetHints() : nullptr;
    vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName("ScenePlacement") : nullptr;
    if (hint && property->IsValueDefault())
    {
      found.emplace_back(property, hint);
    }
  }
  return found;
}

void Notice(vtkObject*, unsigned long, void*, void* data)
{
  const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
  vtkSMProxy* const proxy = registered->Proxy;
  if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !proxy ||
    std::strcmp(registered->GroupName, "sources") != 0 || proxy->GetSessionProxyManager()->GetInLoadXMLState())
  {
    return;
  }
  const auto properties = PropertiesToPlace(proxy);
  const vtkBoundingBox box = properties.empty() ? vtkBoundingBox() : BoxOfScene(proxy->GetSessionProxyManager());
  if (box.IsValid())
  {
    for (const auto& [property, hint] : properties)
    {
      Place(property, hint, box);
    }
    proxy->UpdateVTKObjects();
  }
}
}

void FollowScenePlacement()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
