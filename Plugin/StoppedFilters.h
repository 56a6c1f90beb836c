#pragma once

#include "vtkWeakPointer.h"

#include <QAbstractButton>
#include <QPointer>
#include <QString>
#include <QTimer>

#include <vector>

class vtkSMProxy;

/// The filters that the user has stopped in ParaView's window. Until such a filter has run to its end, the status bar
/// says that it was stopped; while it is on the panel, Apply is enabled and runs it again, although no property has
/// changed.
class StoppedFilters
{
public:
  /// Adds a stopped filter. Not to be called during an update.
  void Add(vtkSMProxy* proxy);
  /// Removes a filter that has run to its end. Not to be called during an update.
  void Remove(vtkSMProxy* proxy);

private:
  void FollowPanel();
  void OfferApply();
  void RunAgain();

  std::vector<vtkWeakPointer<vtkSMProxy>> Stopped;
  QPointer<QAbstractButton> Apply;
  QTimer PanelChanged; ///< fires after the panel has enabled or disabled Apply
  QString Said;        ///< last message shown in the status bar
};
