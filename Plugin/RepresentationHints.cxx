#include "RepresentationHints.h"

#include "ChangedProperty.h"
#include "RegisteredProxies.h"
#include "ShownOutput.h"
#include "VolumeColors.h"

#include "vtkCallbackCommand.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
// This file calls only inline and virtual functions of vtkSMPVRepresentationProxy, so that the library RemotingViews,
// which needs GLEW, is not linked.
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTransferFunctionProxy.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr double LogarithmicFrom = 100.0; ///< minimum ratio of largest to smallest value for a logarithmic colour map
/// Ratio of lower to upper end of a logarithmic colour map whose array has the smallest value 0.
constexpr double Decades = 1e-4;

void ShowDirectColors(vtkSMProxy* representation)
{
  vtkSMPropertyHelper(representation, "MapScalars").Set(0);
  representation->UpdateVTKObjects();
}

/// Whether representations refer to a colour map, but none of them maps scalars through it.
bool IsLookedUpByNone(vtkSMProxy* map)
{
  vtkNew<vtkCollection> representations;
  map->GetSessionProxyManager()->GetProxies("representations", representations);
  bool isThere = false;
  for (int i = 0; i < representations->GetNumberOfItems(); ++i)
  {
    auto* const representation = vtkSMProxy::SafeDownCast(representations->GetItemAsObject(i));
    if (representation && vtkSMPropertyHelper(representation, "LookupTable", true).GetAsProxy() == map)
    {
      isThere = true;
      if (!representation->GetProperty("MapScalars") ||
        vtkSMPropertyHelper(representation, "MapScalars").GetAsInt() != 0)
      {
        return false;
      }
    }
  }
  return isThere;
}

/// Hides the colour bar of a map that no representation uses: ParaView shows one for every representation that has
/// scalars.
void HideUnusedBar(vtkSMProxy* bar)
{
  vtkSMPropertyHelper isVisible(bar, "Visibility", true);
  vtkSMProxy* const map = vtkSMPropertyHelper(bar, "LookupTable", true).GetAsProxy();
  if (isVisible.GetAsInt() != 0 && map && IsLookedUpByNone(map))
  {
    isVisible.Set(0);
    bar->UpdateVTKObjects();
  }
}

void HideBarAtChange(vtkObject* caller, unsigned long, void*, void* property)
{
  if (IsChangeOf(property, "Visibility"))
  {
    HideUnusedBar(vtkSMProxy::SafeDownCast(caller));
  }
}

void WatchBar(vtkSMProxy* bar)
{
  static vtkNew<vtkCallbackCommand> hide;
  hide->SetCallback(HideBarAtChange);
  bar->AddObserver(vtkCommand::PropertyModifiedEvent, hide);
  HideUnusedBar(bar);
}

/// Rescales a colour map to the array's range, logarithmically if the largest value is at least LogarithmicFrom times
/// the smallest.
/// @param colors  a new colour map, not shown yet
void FitColors(vtkSMProxy* colors, vtkPVArrayInformation* array)
{
  double range[2];
  // Component -1 stands for the magnitude of a vector.
  array->GetComponentRange(array->GetNumberOfComponents() > 1 ? -1 : 0, range);
  const bool spansDecades = range[1] > 0.0 && range[1] >= LogarithmicFrom * range[0];
  if (spansDecades && range[0] <= 0.0)
  {
    range[0] = Decades * range[1];
  }
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colors, range);
  if (spansDecades)
  {
    vtkSMTransferFunctionProxy::MapControlPointsToLogSpace(colors);
    vtkSMPropertyHelper(colors, "UseLogScale").Set(1);
    colors->UpdateVTKObjects();
  }
}

void ColorBy(vtkSMProxy* representation, vtkPVArrayInformation* array)
{
  if (auto* const colored = vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    colored->SetScalarColoring(array->GetName(), vtkDataObject::CELL);
  }
  vtkSMProxy* const colors = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  if (colors && vtkSMPropertyHelper(colors, "ScalarRangeInitialized").GetAsInt() == 0)
  {
    FitColors(colors, array);
  }
}

bool IsLitVolume(const char* type)
{
  return type && std::strcmp(type, "Lit Volume") == 0;
}

void ColorAtFirstChange(vtkObject* caller, unsigned long, void*, void* property);

vtkCallbackCommand* FirstChange()
{
  static vtkNew<vtkCallbackCommand> command;
  command->SetCallback(ColorAtFirstChange);
  return command;
}

/// When the type of a representation that opened as Lit Volume is first changed, colours the representation by the
/// array of the hint <ColoredBy>. Before that, a colour bar would mislead, because Lit Volume does not use the colour
/// map.
void ColorAtFirstChange(vtkObject* caller, unsigned long, void*, void* property)
{
  auto* const representation = vtkSMProxy::SafeDownCast(caller);
  if (!IsChangeOf(property, "Representation") ||
    IsLitVolume(vtkSMPropertyHelper(representation, "Representation").GetAsString()))
  {
    return;
  }
  representation->RemoveObserver(FirstChange());
  const Shown shown = ShownBy(representation);
  vtkPVXMLElement* const colored = HintFor(shown, "ColoredBy");
  if (vtkPVArrayInformation* const array = colored ? HintedArray(shown, colored) : nullptr)
  {
    ColorBy(representation, array);
  }
}

/// Whether an output has neither a medium's arrays nor a solver's light, so that Lit Volume shows its scalars.
bool HasScalarsAlone(const Shown& shown)
{
  vtkPVDataInformation* const data = shown.source ? shown.source->GetDataInformation(shown.port) : nullptr;
  const char* const ofMedia[] = { "sigma_a", "sigma_s", "fluence" };
  return data && std::none_of(std::begin(ofMedia), std::end(ofMedia), [&](const char* name) {
    return data->GetArrayInformation(name, vtkDataObject::CELL) ||
      data->GetArrayInformation(name, vtkDataObject::POINT);
  });
}

/// If a representation becomes Lit Volume without being coloured, colours it by its first point array, or by its first
/// cell array if it has no point arrays, and rescales the transfer functions to that array's range. ParaView does the
/// same for Volume.
void ColorScalars(vtkSMPVRepresentationProxy* representation)
{
  vtkSMProperty* const chosen = representation->GetProperty("ColorArrayName");
  auto* const arrays = chosen ? chosen->FindDomain<vtkSMArrayListDomain>() : nullptr;
  if (!arrays || arrays->GetNumberOfStrings() == 0 || representation->GetUsingScalarColoring() ||
    !HasScalarsAlone(ShownBy(representation)))
  {
    return;
  }
  unsigned int first = 0;
  while (first < arrays->GetNumberOfStrings() && arrays->GetFieldAssociation(first) != vtkDataObject::POINT)
  {
    ++first;
  }
  first = first < arrays->GetNumberOfStrings() ? first : 0;
  if (representation->SetScalarColoring(arrays->GetString(first), arrays->GetFieldAssociation(first)))
  {
    representation->RescaleTransferFunctionToDataRange(true);
  }
}

void ColorScalarsAtChange(vtkObject* caller, unsigned long, void*, void* property)
{
  auto* const representation = vtkSMPVRepresentationProxy::SafeDownCast(caller);
  if (IsChangeOf(property, "Representation") &&
    IsLitVolume(vtkSMPropertyHelper(representation, "Representation").GetAsString()))
  {
    ColorScalars(representation);
  }
}

/// Makes the given axes logarithmic in line charts that are still empty: the new representation will be shown in one of
/// these charts.
void MakeEmptyChartsLogarithmic(vtkSMSessionProxyManager* manager, const std::vector<const char*>& axes)
{
  vtkNew<vtkCollection> views;
  manager->GetProxies("views", views);
  for (int i = 0; i < views->GetNumberOfItems(); ++i)
  {
    auto* const view = vtkSMProxy::SafeDownCast(views->GetItemAsObject(i));
    if (view && view->GetProperty("LeftAxisLogScale") &&
      vtkSMPropertyHelper(view, "Representations").GetNumberOfElements() == 0)
    {
      for (const char* const axis : axes)
      {
        vtkSMPropertyHelper(view, axis).Set(1);
      }
      view->UpdateVTKObjects();
    }
  }
}

/// Sets a property of a chart representation to `value` for the given series. The elements of such a property are name,
/// value, name, value, ...
void SetSeries(
  vtkSMProxy* representation, const char* property, const std::vector<std::string>& series, const char* value)
{
  vtkSMPropertyHelper values(representation, property, true);
  for (const std::string& name : series)
  {
    unsigned int place = 0;
    while (place < values.GetNumberOfElements() && name != values.GetAsString(place))
    {
      place += 2;
    }
    values.Set(place, name.c_str());
    values.Set(place + 1, value);
  }
}

void Plot(vtkSMProxy* representation, vtkPVXMLElement* hint)
{
  std::istringstream names(hint->GetAttributeOrEmpty("y"));
  const std::set<std::string> plotted{ std::istream_iterator<std::string>(names), {} };
  const std::string begin = hint->GetAttributeOrEmpty("y_begin");
  std::vector<std::string> series, others;
  const vtkSMPropertyHelper all(representation, "SeriesVisibility"); // elements: name, 0 or 1, name, ...
  for (unsigned int i = 0; i + 1 < all.GetNumberOfElements(); i += 2)
  {
    const std::string name = all.GetAsString(i);
    const bool isPlotted = plotted.count(name) > 0 || (!begin.empty() && name.compare(0, begin.size(), begin) == 0);
    (isPlotted ? series : others).push_back(name);
  }
  vtkSMPropertyHelper(representation, "UseIndexForXAxis").Set(0);
  vtkSMPropertyHelper(representation, "XArrayName").Set(hint->GetAttributeOrEmpty("x"));
  SetSeries(representation, "SeriesVisibility", series, "1");
  SetSeries(representation, "SeriesVisibility", others, "0");
  std::vector<const char*> axes = { "LeftAxisLogScale" };
  if (std::strcmp(hint->GetAttributeOrEmpty("style"), "points") == 0)
  {
    SetSeries(representation, "SeriesLineStyle", series, "0");
    SetSeries(representation, "SeriesMarkerStyle", series, "4"); // markers are circles
    axes.push_back("BottomAxisLogScale");
  }
  representation->UpdateVTKObjects();
  MakeEmptyChartsLogarithmic(representation->GetSessionProxyManager(), axes);
}

/// Applies the hints to a new representation. Called when the representation is registered: its input is then known,
/// and it has not been shown yet.
void Notice(vtkObject*, unsigned long, void*, void* data)
{
  const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
  vtkSMProxy* const representation = registered->Proxy;
  if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !representation)
  {
    return;
  }
  if (std::strcmp(registered->GroupName, "scalar_bars") == 0)
  {
    WatchBar(representation);
  }
  if (!representation->GetProperty("Input"))
  {
    return;
  }
  const Shown shown = ShownBy(representation);
  const bool hasColors = representation->GetProperty("MapScalars");
  if (hasColors && HintFor(shown, "DirectColors"))
  {
    ShowDirectColors(representation);
  }
  vtkPVXMLElement* const colored = hasColors ? HintFor(shown, "ColoredBy") : nullptr;
  vtkPVXMLElement* const type = HintFor(shown, "RepresentationType");
  if (colored && type && IsLitVolume(type->GetAttributeOrEmpty("type")))
  {
    representation->AddObserver(vtkCommand::PropertyModifiedEvent, FirstChange());
  }
  else if (vtkPVArrayInformation* const array = colored ? HintedArray(shown, colored) : nullptr)
  {
    ColorBy(representation, array);
  }
  if (hasColors && vtkSMPVRepresentationProxy::SafeDownCast(representation))
  {
    static vtkCallbackCommand* const color = CommandOf(ColorScalarsAtChange);
    Observe(representation, vtkCommand::PropertyModifiedEvent, color);
  }
  FollowVolumeColors(representation); // called last, because the colours of this hint override those of other hints
  const bool isLineChart = representation->GetProperty("UseIndexForXAxis") && representation->GetProperty("XArrayName");
  if (vtkPVXMLElement* const plotted = isLineChart ? HintFor(shown, "Plotted") : nullptr)
  {
    Plot(representation, plotted);
  }
}
}

void FollowRepresentationHints()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
