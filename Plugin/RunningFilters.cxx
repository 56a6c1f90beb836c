#include "RunningFilters.h"

#include "StoppedFilters.h"
#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkLogger.h"
#include "vtkNew.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkWeakPointer.h"

#include <QApplication>
#include <QElapsedTimer>
#include <QMouseEvent>
#include <QPointer>
#include <QTimer>
#include <QToolButton>
#include <QWindow>

#include <map>
#include <utility>

namespace
{
QToolButton* FindButton()
{
  for (QWidget* window : QApplication::topLevelWidgets())
  {
    for (QToolButton* button : window->findChildren<QToolButton*>("AbortButton"))
    {
      if (button->parent()->inherits("pqProgressWidget"))
      {
        return button;
      }
    }
  }
  return nullptr;
}

bool IsOver(const QWidget* widget, const QPoint& onScreen)
{
  return widget->isVisible() && widget->rect().contains(widget->mapFromGlobal(onScreen));
}

class RunningFilters : public QObject
{
public:
  explicit RunningFilters(QObject* parent)
    : QObject(parent)
  {
    this->Watcher->SetClientData(this);
    this->Watcher->SetCallback([](vtkObject* caller, unsigned long event, void* self, void*) {
      static_cast<RunningFilters*>(self)->Notice(vtkAlgorithm::SafeDownCast(caller), event);
    });
    vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, this, &RunningFilters::Watch);
  }

private:
  /// Observes the algorithm of a newly registered proxy, if it runs in this process and the proxy has the hint
  /// <StopsOnAbort/> or <FreshResults/>.
  void Watch(vtkObject*, unsigned long, void* data)
  {
    const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
    if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !registered->Proxy)
    {
      return;
    }
    vtkPVXMLElement* hints = registered->Proxy->GetHints();
    const bool stops = hints && hints->FindNestedElementByName("StopsOnAbort");
    if (!stops && !(hints && hints->FindNestedElementByName("FreshResults")))
    {
      return;
    }
    auto* algorithm = vtkAlgorithm::SafeDownCast(registered->Proxy->GetClientSideObject());
    if (algorithm && !algorithm->HasObserver(vtkCommand::EndEvent, this->Watcher))
    {
      if (stops)
      {
        algorithm->AddObserver(vtkCommand::StartEvent, this->Watcher);
        algorithm->AddObserver(vtkCommand::ProgressEvent, this->Watcher);
      }
      algorithm->AddObserver(vtkCommand::EndEvent, this->Watcher);
      this->Proxies[algorithm] = registered->Proxy;
    }
  }

  void Notice(vtkAlgorithm* algorithm, unsigned long event)
  {
    switch (event)
    {
      case vtkCommand::StartEvent: this->Begin(algorithm); break;
      case vtkCommand::ProgressEvent:
        vtkLogF(TRACE, "%s is %.3g done%s%s", algorithm->GetClassName(), algorithm->GetProgress(),
          algorithm->GetProgressText() ? ": " : "", algorithm->GetProgressText() ? algorithm->GetProgressText() : "");
        this->HandleWaitingEvents();
        break;
      default: this->End(algorithm); this->ShowResults(algorithm);
    }
  }

  void Begin(vtkAlgorithm* algorithm)
  {
    if (!this->Button && (this->Button = FindButton()))
    {
      connect(this->Button, &QToolButton::pressed, this, [this] { this->Abort(); });
    }
    if (this->Button)
    {
      this->Running = algorithm;
      this->IsAborted = false;
      this->Button->setEnabled(true);
      const QPoint place = this->Button->mapToGlobal(this->Button->rect().center());
      vtkLogF(TRACE, "%s can be aborted at (%d, %d)", algorithm->GetClassName(), place.x(), place.y());
    }
  }

  void Abort()
  {
    if (this->Running)
    {
      vtkLogF(TRACE, "%s is aborted", this->Running->GetClassName());
      this->Running->AbortExecute = 1; // SetAbortExecute would mark the filter as modified, so that it runs again
      this->Button->setDown(true);
      this->IsAborted = true;
    }
  }

  void End(vtkAlgorithm* algorithm)
  {
    if (this->Running && this->Running == algorithm)
    {
      vtkLogF(TRACE, "%s has ended", this->Running->GetClassName());
      this->Running = nullptr;
      this->Button->setDown(false);
      this->Button->setEnabled(false);
    }
  }

  /// Updates the results on the panel once ParaView has finished the current update.
  void ShowResults(vtkAlgorithm* algorithm)
  {
    const vtkWeakPointer<vtkSMProxy> proxy = this->Proxies[algorithm];
    const bool isAborted = this->Running == nullptr && std::exchange(this->IsAborted, false);
    this->ShowLater(proxy, isAborted, 0);
  }

  void ShowLater(const vtkWeakPointer<vtkSMProxy>& proxy, bool isAborted, int milliseconds)
  {
    QTimer::singleShot(milliseconds, this, [this, proxy, isAborted] {
      // The update is still running other filters, since timers fire between progress events: wait again.
      if (this->Running)
      {
        this->ShowLater(proxy, isAborted, 50);
        return;
      }
      if (proxy)
      {
        proxy->UpdatePropertyInformation();
      }
      if (proxy && isAborted)
      {
        this->Stopped.Add(proxy);
      }
      else if (proxy)
      {
        this->Stopped.Remove(proxy);
      }
    });
  }

  /// Processes pending window events. Called on progress events, because the window is blocked while an algorithm runs
  /// in its process. Timers do not fire, and user input other than pressing the abort button is discarded, so that no
  /// second update starts within the first.
  void HandleWaitingEvents()
  {
    const bool soonAfterTheLast = this->SinceLast.isValid() && this->SinceLast.elapsed() < 50;
    if (!this->Running || this->HandlesEvents || soonAfterTheLast)
    {
      return;
    }
    this->HandlesEvents = true;
    qApp->installEventFilter(this);
    QApplication::processEvents(QEventLoop::ExcludeSocketNotifiers | QEventLoop::X11ExcludeTimers);
    qApp->removeEventFilter(this);
    this->HandlesEvents = false;
    this->SinceLast.start();
  }

  bool eventFilter(QObject* receiver, QEvent* event) override
  {
    switch (event->type())
    {
      case QEvent::MouseButtonPress:
        // The window receives a mouse event before the button does, and ParaView's own event filter would stop the
        // event there.
        if (receiver->isWindowType())
        {
          const QPoint inWindow = static_cast<QMouseEvent*>(event)->pos();
          if (IsOver(this->Button, static_cast<QWindow*>(receiver)->mapToGlobal(inWindow)))
          {
            this->Abort();
          }
        }
        return true;
      case QEvent::MouseButtonRelease:
      case QEvent::MouseButtonDblClick:
      case QEvent::MouseMove:
      case QEvent::Wheel:
      case QEvent::KeyPress:
      case QEvent::KeyRelease:
      case QEvent::Shortcut:
      case QEvent::ShortcutOverride:
      case QEvent::ContextMenu:
      case QEvent::TouchBegin:
      case QEvent::TouchUpdate:
      case QEvent::TouchEnd:
      case QEvent::DragEnter:
      case QEvent::DragMove:
      case QEvent::Drop: return true;
      case QEvent::Close: event->ignore(); return true;
      case QEvent::Paint:
      case QEvent::UpdateRequest: return receiver->inherits("QOpenGLWidget"); // a view must not render during an update
      default: return false;
    }
  }

  std::map<vtkAlgorithm*, vtkWeakPointer<vtkSMProxy>> Proxies;
  QPointer<QToolButton> Button;
  vtkWeakPointer<vtkAlgorithm> Running;
  vtkNew<vtkCallbackCommand> Watcher;
  QElapsedTimer SinceLast;
  StoppedFilters Stopped;
  bool HandlesEvents = false;
  bool IsAborted = false; ///< whether the algorithm Running has been aborted
};
}

void FollowRunningFilters()
{
  if (qobject_cast<QApplication*>(QCoreApplication::instance()))
  {
    new RunningFilters(qApp); // deleted by its parent qApp
  }
}
