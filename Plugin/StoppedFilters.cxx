#include "StoppedFilters.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkLogger.h"
#include "vtkSMOutputPort.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <QAbstractButton>
#include <QApplication>
#include <QMainWindow>
#include <QStatusBar>
#include <QVariant>

#include <algorithm>

namespace
{
/// Finds a widget of ParaView by its class and object name. ParaView's GUI libraries are not linked, so that the plugin
/// loads in servers without them: widgets and signals are accessed by name.
QWidget* FindWidget(const char* type, const QString& name = {})
{
  for (QWidget* window : QApplication::topLevelWidgets())
  {
    for (QWidget* widget : window->findChildren<QWidget*>(name))
    {
      if (widget->inherits(type) && (name.isEmpty() || widget->isVisible()))
      {
        return widget;
      }
    }
  }
  return nullptr;
}

QString NameOf(vtkSMProxy* proxy)
{
  return proxy->GetSessionProxyManager()->GetProxyName("sources", proxy);
}

/// The Properties panel shows the active source, of which one output port may be what is active.
bool IsOnPanel(vtkSMProxy* proxy)
{
  vtkSMProxySelectionModel* const active = proxy->GetSessionProxyManager()->GetSelectionModel("ActiveSources");
  vtkSMProxy* const current = active ? active->GetCurrentProxy() : nullptr;
  auto* const port = vtkSMOutputPort::SafeDownCast(current);
  return current && (port ? port->GetSourceProxy() : current) == proxy;
}

bool AppliesByItself(vtkSMProxy* proxy)
{
  vtkSMProxy* const settings = proxy->GetSessionProxyManager()->GetProxy("settings", "GeneralSettings");
  return settings && vtkSMPropertyHelper(settings, "AutoApply", true).GetAsInt() != 0;
}

vtkDataObject* OutputOf(vtkSMProxy* proxy)
{
  return vtkAlgorithm::SafeDownCast(proxy->GetClientSideObject())->GetOutputDataObject(0);
}

/// Whether the output of a stopped filter is the light of its previous run.
bool ShowsLight(vtkSMProxy* proxy)
{
  vtkDataObject* const output = OutputOf(proxy);
  return output && output->GetNumberOfElements(vtkDataObject::CELL) > 0;
}

/// Whether the output of a filter is still marked as that of an aborted run.
bool IsStillStopped(vtkSMProxy* proxy)
{
  vtkDataObject* const output = OutputOf(proxy);
  return output && output->GetFieldData()->HasArray("aborted");
}

std::vector<QStatusBar*> StatusBars()
{
  std::vector<QStatusBar*> bars;
  for (QWidget* window : QApplication::topLevelWidgets())
  {
    if (auto* main = qobject_cast<QMainWindow*>(window))
    {
      bars.push_back(main->statusBar());
    }
  }
  return bars;
}

void Say(const QString& text)
{
  vtkLogF(TRACE, "status bar: %s", text.toUtf8().constData());
  for (QStatusBar* bar : StatusBars())
  {
    bar->showMessage(text);
  }
}
}

void StoppedFilters::Add(vtkSMProxy* proxy)
{
  if (std::find(this->Stopped.begin(), this->Stopped.end(), proxy) == this->Stopped.end())
  {
    this->Stopped.emplace_back(proxy);
  }
  this->FollowPanel();
  const bool byItself = AppliesByItself(proxy);
  this->Said = NameOf(proxy) +
    (byItself ? ": stopped; runs again when something is changed" : ": stopped; Apply runs it again") +
    (ShowsLight(proxy) ? ", and until then it shows the light of before" : "");
  Say(this->Said);
  if (!byItself)
  {
    this->OfferApply();
  }
}

void StoppedFilters::Remove(vtkSMProxy* proxy)
{
  const auto found = std::find(this->Stopped.begin(), this->Stopped.end(), proxy);
  if (found == this->Stopped.end() || IsStillStopped(proxy))
  {
    return;
  }
  this->Stopped.erase(found);
  for (QStatusBar* bar : StatusBars())
  {
    if (bar->currentMessage() == this->Said)
    {
      vtkLogF(TRACE, "status bar is cleared");
      bar->clearMessage();
    }
  }
  if (QWidget* const panel = FindWidget("pqPropertiesPanel"))
  {
    QMetaObject::invokeMethod(panel, "updateButtonState");
  }
}

void StoppedFilters::FollowPanel()
{
  QWidget* const panel = FindWidget("pqPropertiesPanel");
  auto* const apply = qobject_cast<QAbstractButton*>(FindWidget("QAbstractButton", "Accept"));
  if (!panel || !apply || this->Apply)
  {
    return;
  }
  this->Apply = apply;
  QObject::connect(apply, &QAbstractButton::pressed, apply, [this] { this->RunAgain(); });
  this->PanelChanged.setSingleShot(true);
  QObject::connect(&this->PanelChanged, &QTimer::timeout, apply, [this] { this->OfferApply(); });
  QObject::connect(panel, SIGNAL(applyEnableStateChanged()), &this->PanelChanged, SLOT(start()));
}

/// Enables the Apply button if a stopped filter is on the panel; ParaView enables it only for changed properties.
void StoppedFilters::OfferApply()
{
  const auto isOffered = [](const vtkWeakPointer<vtkSMProxy>& proxy) {
    return proxy && IsOnPanel(proxy) && !AppliesByItself(proxy);
  };
  if (this->Apply && std::any_of(this->Stopped.begin(), this->Stopped.end(), isOffered))
  {
    this->Apply->setEnabled(true);
    QMetaObject::invokeMethod(this->Apply, "highlight");
  }
}

void StoppedFilters::RunAgain()
{
  for (const vtkWeakPointer<vtkSMProxy>& proxy : this->Stopped)
  {
    if (proxy && IsOnPanel(proxy))
    {
      vtkAlgorithm::SafeDownCast(proxy->GetClientSideObject())->Modified();
      proxy->MarkModified(proxy);
    }
  }
}
