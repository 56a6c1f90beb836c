#include "RecommendedFilters.h"

#include "ChangedProperty.h"
#include "RegisteredProxies.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkSMInputProperty.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMStringVectorProperty.h"
#include "vtkSMVectorProperty.h"

#include <charconv>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using Proxies = std::vector<vtkSmartPointer<vtkSMProxy>>;

/// A recommended filter and its listed properties.
struct Recommended
{
  std::string filter;
  std::map<std::string, std::string> properties;
};

std::vector<Recommended> FiltersIn(const std::string& text)
{
  std::vector<Recommended> filters;
  std::istringstream words(text);
  bool begins = true;
  for (std::string word; words >> word; begins = word == "|")
  {
    if (begins)
    {
      filters.push_back({ word, {} });
    }
    else if (word != "|")
    {
      const std::size_t equals = word.find('=');
      filters.back().properties[word.substr(0, equals)] = word.substr(equals + 1);
    }
  }
  return filters;
}

/// Sets a property to a listed value (RecommendedFilters.h).
/// @param made the new filters that precede this one in the list, already created
void Set(vtkSMProperty* property, const std::string& value, vtkSMProxy* source, const Proxies& made)
{
  vtkSMPropertyHelper values(property);
  if (value.empty())
  {
    values.RemoveAllValues();
  }
  else if (value[0] == '@')
  {
    property->Copy(source->GetProperty(value.c_str() + 1));
  }
  else if (value[0] == '#')
  {
    values.Set(made.at(std::stoul(value.substr(1)) - 1));
  }
  else
  {
    std::istringstream numbers(value);
    unsigned int i = 0;
    for (std::string text; std::getline(numbers, text, ','); ++i)
    {
      double number = 0.0; // converted independently of the locale
      std::from_chars(text.data(), text.data() + text.size(), number);
      values.Set(i, number);
    }
  }
}

/// Copies the values of a property to the property of the same name of another filter. If the property selects an
/// array, copies only association and name, because the array's index differs between filters.
void Copy(vtkSMProperty* from, vtkSMProperty* to)
{
  constexpr unsigned int ofArray = 5;
  const vtkSMPropertyHelper values(from);
  if (vtkSMStringVectorProperty::SafeDownCast(to) && values.GetNumberOfElements() == ofArray)
  {
    vtkSMPropertyHelper chosen(to);
    chosen.Set(3, values.GetAsString(3));
    chosen.Set(4, values.GetAsString(4));
    return;
  }
  to->Copy(from);
}

/// Whether a property of the recommending filter has the same meaning as the property of the same name of a new filter.
/// It has not if it is a list of settings to compare.
bool IsShared(vtkSMProperty* from, vtkSMProperty* to)
{
  auto* const list = vtkSMVectorProperty::SafeDownCast(from);
  const bool hasValues = vtkSMInputProperty::SafeDownCast(from) || (list && !list->GetRepeatCommand());
  return hasValues && !from->GetInformationOnly() && std::strcmp(from->GetClassName(), to->GetClassName()) == 0;
}

/// Sets the inputs of a new filter or, if `inputs` is false, its other properties.
void SetAll(bool inputs, const Recommended& wanted, vtkSMProxy* filter, vtkSMProxy* source, const Proxies& made)
{
  auto properties = vtk::TakeSmartPointer(filter->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    const std::string name = properties->GetKey();
    vtkSMProperty* const property = properties->GetProperty();
    vtkSMProperty* const same = source->GetProperty(name.c_str());
    if (property->GetInformationOnly() || (vtkSMInputProperty::SafeDownCast(property) != nullptr) != inputs)
    {
      continue;
    }
    const auto listed = wanted.properties.find(name);
    if (listed != wanted.properties.end())
    {
      Set(property, listed->second, source, made);
    }
    else if (name != "EstimateError" && IsShared(same, property))
    {
      Copy(same, property);
    }
  }
  filter->UpdateVTKObjects();
}

/// Creates a filter and registers it as ParaView's menu does.
vtkSmartPointer<vtkSMProxy> Make(const Recommended& wanted, vtkSMProxy* source, const Proxies& made)
{
  auto filter = vtk::TakeSmartPointer(source->GetSessionProxyManager()->NewProxy("filters", wanted.filter.c_str()));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(filter);
  SetAll(true, wanted, filter, source, made);
  controller->PostInitializeProxy(filter);
  SetAll(false, wanted, filter, source, made);
  controller->RegisterPipelineProxy(filter);
  return filter;
}

void Press(vtkObject* caller, unsigned long, void*, void* property)
{
  auto* const source = vtkSMProxy::SafeDownCast(caller);
  vtkPVXMLElement* const hint = HintOf(source, "MakesFilters");
  if (!IsChangeOf(property, hint->GetAttributeOrEmpty("button")))
  {
    return;
  }
  const char* const filters = hint->GetAttributeOrEmpty("filters");
  source->UpdatePropertyInformation(source->GetProperty(filters));
  Proxies made;
  for (const Recommended& wanted : FiltersIn(vtkSMPropertyHelper(source, filters).GetAsString()))
  {
    made.push_back(Make(wanted, source, made));
  }
  if (made.empty())
  {
    vtkErrorWithObjectMacro(source,
      "There is no recommended setting yet: press Apply first. If Recommended is still "
      "empty then, Left Out says why nothing was compared.");
    return;
  }
  if (vtkSMProxySelectionModel* const active = source->GetSessionProxyManager()->GetSelectionModel("ActiveSources"))
  {
    active->SetCurrentProxy(made.back(), vtkSMProxySelectionModel::CLEAR_AND_SELECT);
  }
}

void Notice(vtkObject*, unsigned long, void*, void* data)
{
  static vtkCallbackCommand* const press = CommandOf(Press);
  vtkSMProxy* const proxy = RegisteredProxy(data);
  if (proxy && HintOf(proxy, "MakesFilters"))
  {
    Observe(proxy, vtkCommand::UpdatePropertyEvent, press);
  }
}
}

void FollowRecommendations()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
