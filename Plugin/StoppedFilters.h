#pragma once

#include "vtkWeakPointer.h"

#include <vector>

class vtkSMProxy;

/// What becomes of filters that the user stopped, in ParaView's window: the status bar says so, Apply is there to be
/// pressed, and pressed runs them again although nothing was changed. Each while its filter is on the panel.
class StoppedFilters
{
public:
  /// To be called when ParaView is not in the middle of an update.
  void Add(vtkSMProxy* proxy);

private:
  void FollowApply();
  void RunAgain();

  std::vector<vtkWeakPointer<vtkSMProxy>> Stopped;
  bool FollowsApply = false;
};
