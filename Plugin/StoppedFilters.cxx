#include "StoppedFilters.h"

#include "vtkAlgorithm.h"
#include "vtkLogger.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"

#include <QAbstractButton>
#include <QApplication>
#include <QMainWindow>
#include <QStatusBar>
#include <QString>
#include <QVariant>

namespace
{
/// A widget of ParaView's. Its libraries are not linked, so that the plugin loads in servers without them: widgets are
/// found, and their signals sent, by name.
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

bool IsOnPanel(vtkSMProxy* proxy)
{
  QWidget* const heading = FindWidget("pqExpanderButton", "PropertiesButton");
  return heading && heading->property("text").toString().endsWith("(" + NameOf(proxy) + ")");
}

bool AppliesByItself(vtkSMProxy* proxy)
{
  vtkSMProxy* const settings = proxy->GetSessionProxyManager()->GetProxy("settings", "GeneralSettings");
  return settings && vtkSMPropertyHelper(settings, "AutoApply", true).GetAsInt() != 0;
}

void Say(const QString& text)
{
  vtkLogF(TRACE, "status bar: %s", text.toUtf8().constData());
  for (QWidget* window : QApplication::topLevelWidgets())
  {
    if (auto* main = qobject_cast<QMainWindow*>(window))
    {
      main->statusBar()->showMessage(text);
    }
  }
}
}

void StoppedFilters::Add(vtkSMProxy* proxy)
{
  this->Stopped.emplace_back(proxy);
  this->FollowApply();
  if (AppliesByItself(proxy))
  {
    Say(NameOf(proxy) + ": stopped; runs again when something is changed");
    return;
  }
  Say(NameOf(proxy) + ": stopped; Apply runs it again");
  QWidget* const properties = FindWidget("pqProxyWidget", "ProxyPanel");
  if (properties && IsOnPanel(proxy))
  {
    QMetaObject::invokeMethod(properties, "changeAvailable");
  }
}

void StoppedFilters::FollowApply()
{
  auto* const apply = qobject_cast<QAbstractButton*>(FindWidget("QAbstractButton", "Accept"));
  if (apply && !this->FollowsApply)
  {
    QObject::connect(apply, &QAbstractButton::pressed, apply, [this] { this->RunAgain(); });
    this->FollowsApply = true;
  }
}

void StoppedFilters::RunAgain()
{
  std::vector<vtkWeakPointer<vtkSMProxy>> left;
  for (const vtkWeakPointer<vtkSMProxy>& proxy : this->Stopped)
  {
    if (proxy && IsOnPanel(proxy))
    {
      vtkAlgorithm::SafeDownCast(proxy->GetClientSideObject())->Modified();
      proxy->MarkModified(proxy);
    }
    else if (proxy)
    {
      left.push_back(proxy);
    }
  }
  this->Stopped = left;
}
