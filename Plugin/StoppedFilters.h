#pragma once

#include "vtkWeakPointer.h"

#include <QAbstractButton>
#include <QPointer>
#include <QString>
#include <QTimer>

#include <vector>

class vtkSMProxy;

/// What becomes of filters that the user stopped, in ParaView's window: the status bar says so, Apply is there to be
/// pressed while such a filter is on the panel, and pressed runs it again although nothing was changed. Until it has
/// run to its end.
class StoppedFilters
{
public:
  /// To be called when ParaView is not in the middle of an update.
  void Add(vtkSMProxy* proxy);
  /// The same for a filter that has run to its end.
  void Remove(vtkSMProxy* proxy);

private:
  void FollowPanel();
  void OfferApply();
  void RunAgain();

  std::vector<vtkWeakPointer<vtkSMProxy>> Stopped;
  QPointer<QAbstractButton> Apply;
  QTimer PanelChanged; ///< when the panel has decided whether Apply is there to be pressed
  QString Said;        ///< last in the status bar
};
